"""``physics``: the arm draws in physics, with disturbances, pictures and a video."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from iiwa_dnn.app.command_line import progress_bar, run_command, save_settings
from iiwa_dnn.app.settings import PhysicsSettings
from iiwa_dnn.app.track import CHECKS, limited, report_run, start_posture
from iiwa_dnn.files import prepare_folder
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Heart
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.pictures import frame_times, import_encoder, save_moments, save_video
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.report import save_run
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.robot.offscreen import opengl_library
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation.disturbances import Disturbances, Push
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant
from iiwa_dnn.simulation.runner import Simulation


def simulate_physics(arguments: Sequence[str] | None = None, prog: str = "simulate_physics") -> int:
    """Draw the heart in physics, check every step, write the run with pictures and a video.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        prog: What the command is called in messages.

    Returns:
        The exit code: 0 done, 1 a check or a limit failed, 2 bad input or something is missing.
    """
    return run_command(PhysicsSettings, prog, _physics, arguments)


def _physics(settings: PhysicsSettings) -> int:
    robot, simulation = _simulation(settings)
    if settings.pictures or settings.video:
        opengl_library()
    if settings.video:
        import_encoder()
    folder = prepare_folder(settings.out)
    with progress_bar(simulation.steps, "step", settings.quiet) as bar:
        record = simulation.run(bar.update)

    def moments(record: Record, folder: Path) -> list[Path]:
        return save_moments(robot, record, folder) if settings.pictures else []

    metrics = save_run(record, folder, plots=settings.plots, more=moments)
    save_settings(settings, folder)
    if settings.video:
        with progress_bar(len(frame_times(record)), "frame", settings.quiet) as bar:
            save_video(robot, record, folder / "video.mp4", bar.update)
    return report_run(metrics, failures(record), folder, settings.quiet, settings.verbose)


def _disturbances(options: PhysicsSettings) -> Disturbances:
    """What is asked for by name, else what ``--disturb`` means, else nothing."""
    push = None
    if options.push is not None:
        push = Push(options.push, options.push_at, options.push_for)
    base = Disturbances.typical() if options.disturb else Disturbances()
    names = ("mass_error", "friction", "encoder_noise", "encoder_bits", "delay")
    asked = {name: getattr(options, name) for name in names}
    chosen = {k: getattr(base, k) if value is None else value for k, value in asked.items()}
    return Disturbances(**chosen, push=push)


def _simulation(options: PhysicsSettings) -> tuple[Robot, Simulation]:
    """The run that the options ask for, every argument checked and nothing written."""
    robot = load_robot(options.robot, tip=options.tip)
    is_papers = robot.name == "iiwa7"
    q0 = np.array(options.q0) if options.q0 else start_posture(robot, is_papers)
    robot = limited(robot, options.joint_limit, is_papers)
    return robot, Simulation(
        robot,
        DoubleIndicator(weight=options.weight, orientation=options.orientation),
        Heart(scale=options.scale).anchored(Configuration(robot, q0)),
        q0,
        dt=options.dt,
        plant=MujocoPlant(_disturbances(options), timestep=options.physics_dt),
        duration=options.duration,
        seed=options.seed,
        check=CrossCheck(CHECKS[options.check], options.tolerance),
    )
