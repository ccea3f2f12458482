"""``track``: the heart drawn, and what the commands that run an arm share.

Exit code 0: done, and every check agreed. 1: a step disagreed, was not solved, or broke a limit.
2: bad input, one line on standard error. 130 and 143: ended by Ctrl-C, by SIGTERM.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import list_files, progress_bar, run_command, save_settings
from iiwa_dnn.app.settings import Check, TrackSettings
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import prepare_folder
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.references import Heart
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.report import save_run, settings_lines, summary
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import Simulation
from iiwa_dnn.studies import paper

PAPER_START = paper.START
PAPER_LIMIT = paper.JOINT_LIMIT

CHECKS: dict[Check, tuple[str, ...]] = {
    "proxqp": ("proxqp",),
    "osqp": ("osqp",),
    "both": ("proxqp", "osqp"),
    "none": (),
}


def track_heart(arguments: Sequence[str] | None = None, prog: str = "track_heart") -> int:
    """Draw the heart, check every step, write the run; the script of the same name.

    Args:
        arguments: Command line without the program's name; None takes the process's own.
        prog: What the command is called in messages.

    Returns:
        The exit code.
    """
    return run_command(TrackSettings, prog, _track, arguments)


def _track(settings: TrackSettings) -> int:
    simulation = _simulation(settings)
    folder = prepare_folder(settings.out)
    with progress_bar(simulation.steps, "step", settings.quiet) as bar:
        record = simulation.run(bar.update)
    metrics = save_run(record, folder, plots=settings.plots)
    save_settings(settings, folder)
    return report_run(metrics, failures(record), folder, settings.quiet, settings.verbose)


def report_run(
    metrics: Mapping[str, Any], reasons: Sequence[str], folder: Path, quiet: bool, verbose: bool
) -> int:
    """Say how a run went: all of it, or with `quiet` only why it failed.

    Args:
        metrics: As in metrics.json.
        reasons: Why it failed (`iiwa_dnn.results.failures.failures`).
        folder: Where it was written.
        quiet: Print no summary; the reasons go to standard error.
        verbose: Name the settings and the files too.

    Returns:
        The exit code, 1 where there is a reason.
    """
    if not quiet:
        if verbose:
            print(settings_lines(metrics))
        print(summary(metrics, reasons))
        print(f"written to {folder}")
        if verbose:
            list_files(folder)
    elif reasons:
        print("\n".join(reasons), file=sys.stderr)
    return 1 if reasons else 0


def _simulation(options: TrackSettings) -> Simulation:
    """The run that the options ask for, every argument checked and nothing written."""
    robot = load_robot(options.robot, tip=options.tip, locked=options.lock)
    is_papers = robot.name == "iiwa7"
    q0 = np.array(options.q0) if options.q0 else start_posture(robot, is_papers)
    robot = limited(robot, options.joint_limit, is_papers)
    robot = robot.with_limits(velocity=checks.positive("speed", options.speed) * robot.dq_max)
    start = Configuration(robot, q0)
    return Simulation(
        robot,
        DoubleIndicator(
            weight=options.weight,
            position_gain=options.gain,
            orientation_gain=options.gain,
            orientation=options.orientation,
            kinetic=options.kinetic,
        ),
        Heart(scale=options.scale).anchored(start),
        q0,
        dt=options.dt,
        duration=options.duration,
        mode=options.mode,
        motion=options.motion,
        noise=options.noise,
        noise_at=options.noise_at,
        filter_window=options.filter_window,
        integral_gain=options.integral_gain,
        policy=options.policy,
        seed=options.seed,
        check=CrossCheck(CHECKS[options.check], options.tolerance),
    )


def start_posture(robot: Robot, is_papers: bool) -> Vector:
    """Where to start [rad], (n,): the posture known for the robot, or the middle of each range."""
    known = PAPER_START if is_papers else ARMS[robot.name].start if robot.name in ARMS else ()
    if robot.dof == len(known):
        return np.array(known)
    middle = 0.5 * (robot.q_lower + robot.q_upper)
    return np.where(np.isfinite(middle), middle, 0.0)


def limited(robot: Robot, limit: str | None, is_papers: bool) -> Robot:
    """The robot with the position limits that were asked for."""
    if limit is None:
        limit = str(PAPER_LIMIT) if is_papers else "datasheet"
    if limit == "datasheet":
        return robot
    try:
        value = float(limit)
    except ValueError:
        raise InvalidInputError(
            "--joint-limit", f"must be an angle in rad or 'datasheet', not {limit!r}", limit
        ) from None
    if not value > 0:
        raise InvalidInputError("--joint-limit", f"must be a positive angle, not {limit}", limit)
    return robot.with_limits(lower=-value, upper=value)
