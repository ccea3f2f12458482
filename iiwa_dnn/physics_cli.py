"""The script that lets the arm draw in physics: arguments, disturbances, pictures, exit codes."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from iiwa_dnn.cli import CHECKS, Parser, limited, start_posture
from iiwa_dnn.configuration import Configuration
from iiwa_dnn.crosscheck import CrossCheck
from iiwa_dnn.exceptions import IiwaDnnError
from iiwa_dnn.files import prepare_folder
from iiwa_dnn.interrupts import ended_by_signals
from iiwa_dnn.metrics import failures
from iiwa_dnn.offscreen import opengl_library
from iiwa_dnn.pictures import frame_times, import_encoder, save_moments, save_video
from iiwa_dnn.record import Record
from iiwa_dnn.references import Heart
from iiwa_dnn.report import save_run, summary
from iiwa_dnn.robot import Robot, load_robot
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.schemes.orientation import ORIENTATIONS
from iiwa_dnn.simulation.disturbances import (
    DELAY,
    ENCODER_BITS,
    ENCODER_NOISE,
    FRICTION,
    MASS_ERROR,
    Disturbances,
    Push,
)
from iiwa_dnn.simulation.physics import PhysicsSimulation


@ended_by_signals()
def simulate_physics(arguments: Sequence[str] | None = None) -> int:
    """Draw the heart in physics, check every step, write the run with pictures and a video.

    Args:
        arguments: Command line without the program's name; None takes the process's own.

    Returns:
        The exit code: 0 done, 1 a check or a limit failed, 2 bad input or something is missing.
    """
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        robot, simulation = _simulation(options)
        if options.pictures or options.video:
            opengl_library()
        if options.video:
            import_encoder()
        folder = prepare_folder(options.out)
        with _bar(options, simulation.steps, "step") as bar:
            record = simulation.run(bar.update)

        def moments(record: Record, folder: Path) -> list[Path]:
            return save_moments(robot, record, folder) if options.pictures else []

        metrics = save_run(record, folder, plots=options.plots, more=moments)
        if options.video:
            with _bar(options, len(frame_times(record)), "frame") as bar:
                save_video(robot, record, folder / "video.mp4", bar.update)
    except IiwaDnnError as error:
        print(f"{parser.prog}: error: {error}", file=sys.stderr)
        return 2
    reasons = failures(record)
    if not options.quiet:
        print(summary(metrics, reasons))
        print(f"written to {folder}")
    elif reasons:
        print("\n".join(reasons), file=sys.stderr)
    return 1 if reasons else 0


def _bar(options: argparse.Namespace, total: int, unit: str) -> Any:
    # None: no bar where standard error is not a terminal.
    hidden = True if options.quiet else None
    return tqdm(total=total, unit=unit, dynamic_ncols=True, disable=hidden)


def _parser() -> Parser:
    parser = Parser(
        prog="simulate_physics",
        description="Draw the paper's heart with an arm that has masses and motors, in MuJoCo: the "
        "network's velocities, a torque loop under them, every step checked.",
        epilog="Exit code 0: all checks agreed; 1: a step did not, or broke a limit; 2: bad input, "
        "or a package is missing.",
    )
    add = parser.add_argument
    add("--robot", default="iiwa7", metavar="NAME|URDF", help="robot (%(default)s)")
    add("--tip", metavar="FRAME", help="frame that draws (the end of the chain)")
    add("--q0", nargs="+", type=float, metavar="RAD", help="start (the paper's for iiwa7)")
    add("--weight", type=float, default=0.2, metavar="XI", help="xi in [0, 1] (%(default)s)")
    add("--orientation", choices=ORIENTATIONS, default="so3", help="rows (%(default)s)")
    add(
        "--joint-limit",
        metavar="RAD|datasheet",
        help="position limit of every joint (2.5 for iiwa7, the URDF's for others)",
    )
    add("--dt", type=float, default=1e-3, metavar="S", help="control period (%(default)s)")
    add("--physics-dt", type=float, default=2.5e-4, metavar="S", help="at most 1e-3 (%(default)s)")
    add("--duration", type=float, default=10.0, metavar="S", help="length (%(default)s)")
    add("--scale", type=float, default=3.45e-3, metavar="M", help="heart's a (%(default)s)")
    add("--seed", type=int, default=0, help="of mass errors and encoder noise (%(default)s)")
    add("--check", choices=tuple(CHECKS), default="proxqp", help="reference (%(default)s)")
    add("--tolerance", type=float, default=1e-6, metavar="RAD/S", help="gap (%(default)s)")
    add("--out", type=Path, default=Path("runs/physics"), metavar="DIR", help="(%(default)s)")
    add("--no-plots", dest="plots", action="store_false", help="draw no curves")
    add("--no-pictures", dest="pictures", action="store_false", help="draw no arm")
    add("--no-video", dest="video", action="store_false", help="make no video")
    add("--quiet", action="store_true", help="no progress bar and no summary")
    _add_disturbances(parser)
    return parser


def _add_disturbances(parser: Parser) -> None:
    group = parser.add_argument_group(
        "disturbances", "none by default; --disturb: all but the push"
    )
    add = group.add_argument
    add("--disturb", action="store_true", help="those with a size in brackets, at that size")
    add("--mass-error", type=float, metavar="SHARE", help=f"of each link, +- ({MASS_ERROR:g})")
    add("--friction", type=float, metavar="SHARE", help=f"of the torque limit ({FRICTION:g})")
    add("--encoder-noise", type=float, metavar="RAD", help=f"std. dev. ({ENCODER_NOISE:g})")
    add("--encoder-bits", type=int, metavar="N", help=f"a turn has 2^N ({ENCODER_BITS})")
    add("--delay", type=int, metavar="N", help=f"control periods, of a command ({DELAY})")
    add(
        "--push",
        nargs=3,
        type=float,
        metavar=("FX", "FY", "FZ"),
        help="force on the tip, in the world's axes [N]",
    )
    add("--push-at", type=float, default=5.0, metavar="S", help="when (%(default)s)")
    add("--push-for", type=float, default=0.2, metavar="S", help="how long (%(default)s)")


def _disturbances(options: argparse.Namespace) -> Disturbances:
    """What is asked for by name, else what ``--disturb`` means, else nothing."""
    push = None
    if options.push is not None:
        push = Push(tuple(options.push), options.push_at, options.push_for)
    base = Disturbances.typical() if options.disturb else Disturbances()
    names = ("mass_error", "friction", "encoder_noise", "encoder_bits", "delay")
    asked = {name: getattr(options, name) for name in names}
    chosen = {k: getattr(base, k) if value is None else value for k, value in asked.items()}
    return Disturbances(**chosen, push=push)


def _simulation(options: argparse.Namespace) -> tuple[Robot, PhysicsSimulation]:
    """The run that the options ask for, every argument checked and nothing written."""
    robot = load_robot(options.robot, tip=options.tip)
    is_papers = robot.name == "iiwa7"
    q0 = start_posture(robot, is_papers) if options.q0 is None else np.array(options.q0)
    robot = limited(robot, options.joint_limit, is_papers)
    return robot, PhysicsSimulation(
        robot,
        DoubleIndicator(weight=options.weight, orientation=options.orientation),
        Heart(scale=options.scale).anchored(Configuration(robot, q0)),
        q0,
        dt=options.dt,
        timestep=options.physics_dt,
        duration=options.duration,
        disturbances=_disturbances(options),
        seed=options.seed,
        check=CrossCheck(CHECKS[options.check], options.tolerance),
    )
