"""What the scripts share: arguments, messages and exit codes.

Exit code 0: done, and every check agreed. 1: a step disagreed, was not solved, or broke a limit.
2: bad input, one line on standard error. 130 and 143: ended by Ctrl-C, by SIGTERM.
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from tqdm import tqdm

from iiwa_dnn import checks
from iiwa_dnn.configuration import Configuration
from iiwa_dnn.controller import MODES
from iiwa_dnn.crosscheck import CrossCheck
from iiwa_dnn.exceptions import IiwaDnnError, InvalidInputError, NoSolutionError
from iiwa_dnn.experiments import paper
from iiwa_dnn.files import prepare_folder
from iiwa_dnn.interrupts import ended_by_signals
from iiwa_dnn.metrics import failures
from iiwa_dnn.policies import POLICIES
from iiwa_dnn.qp import Vector
from iiwa_dnn.references import Heart
from iiwa_dnn.report import save_run, summary
from iiwa_dnn.robot import Robot, load_robot
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.schemes.orientation import ORIENTATIONS
from iiwa_dnn.simulation import MOTIONS, NOISE_ENTRIES, Simulation

PAPER_START = paper.START
PAPER_LIMIT = paper.JOINT_LIMIT

CHECKS = {"proxqp": ("proxqp",), "osqp": ("osqp",), "both": ("proxqp", "osqp"), "none": ()}


class Parser(argparse.ArgumentParser):
    """Says what is wrong with an argument in one line, and exits with code 2."""

    def __init__(self, **options: Any) -> None:
        """Take "-1e-3" for a number, as Python itself does from 3.14 on."""
        super().__init__(**options)
        self._negative_number_matcher = re.compile(r"^-(\d|\.\d)")

    def error(self, message: str) -> NoReturn:  # noqa: D102
        # argparse would print the whole usage first; the promise is one clear line.
        self.exit(2, f"{self.prog}: error: {message} (--help lists the options)\n")


@ended_by_signals()
def track_heart(arguments: Sequence[str] | None = None) -> int:
    """Draw the heart, check every step, write the run; the script of the same name.

    Args:
        arguments: Command line without the program's name; None takes the process's own.

    Returns:
        The exit code.
    """
    parser = _track_parser()
    options = parser.parse_args(arguments)
    try:
        simulation = _simulation(options)
        folder = prepare_folder(options.out)
        bar = tqdm(
            total=simulation.steps,
            unit="step",
            unit_scale=True,
            dynamic_ncols=True,
            # None: no bar where standard error is not a terminal.
            disable=True if options.quiet else None,
        )
        with bar:
            record = simulation.run(bar.update)
        metrics = save_run(record, folder, plots=options.plots)
    except NoSolutionError as error:
        print(f"{parser.prog}: error: {error}", file=sys.stderr)
        return 1
    except IiwaDnnError as error:
        # One line, whatever stands in a file's name.
        print(f"{parser.prog}: error: {' '.join(str(error).split())}", file=sys.stderr)
        return 2
    reasons = failures(record)
    if not options.quiet:
        print(summary(metrics, reasons))
        print(f"written to {folder}")
    elif reasons:
        print("\n".join(reasons), file=sys.stderr)
    return 1 if reasons else 0


def _track_parser() -> argparse.ArgumentParser:
    parser = Parser(
        prog="track_heart",
        description="Draw the paper's heart with a robot arm; the network solves every step's "
        "quadratic program and other solvers check it. Defaults: the paper's experiment.",
        epilog="Exit code 0: all checks agreed; 1: a step did not, or broke a limit; 2: bad input.",
    )
    add = parser.add_argument
    add("--robot", default="iiwa7", metavar="NAME|URDF", help="robot (%(default)s)")
    add("--tip", metavar="FRAME", help="frame that draws (the end of the chain)")
    add("--lock", nargs="+", default=(), metavar="JOINT", help="joints to hold still")
    add("--q0", nargs="+", type=float, metavar="RAD", help="start (the paper's for iiwa7)")
    add("--mode", choices=MODES, default="converged", help="network (%(default)s)")
    add("--weight", type=float, default=0.2, metavar="XI", help="xi in [0, 1] (%(default)s)")
    add("--orientation", choices=ORIENTATIONS, default="so3", help="rows (%(default)s)")
    add("--kinetic", choices=("identity", "inertia"), default="identity", help="G (%(default)s)")
    add(
        "--joint-limit",
        metavar="RAD|datasheet",
        help="position limit of every joint (2.5 for iiwa7, the URDF's for others)",
    )
    add(
        "--speed",
        type=float,
        default=1.0,
        metavar="FRACTION",
        help="velocity limits as a share of the data sheet's (%(default)s)",
    )
    add("--policy", choices=POLICIES, default="slow", help="without a solution (%(default)s)")
    add("--dt", type=float, default=1e-4, metavar="S", help="control period (%(default)s)")
    add("--duration", type=float, default=10.0, metavar="S", help="length (%(default)s)")
    add("--scale", type=float, default=3.45e-3, metavar="M", help="heart's a (%(default)s)")
    add("--motion", choices=tuple(MOTIONS), default="euler", help="integration (%(default)s)")
    add("--noise", type=float, default=0.0, metavar="RAD/S", help="std. deviation (%(default)s)")
    add(
        "--noise-at",
        choices=NOISE_ENTRIES,
        default="velocity",
        help="where it enters; at measurement, --noise is in rad (%(default)s)",
    )
    add("--filter-window", type=int, default=1, metavar="N", help="moving average (%(default)s)")
    add(
        "--gain",
        type=float,
        default=10.2,
        metavar="1/S",
        help="feedback of position and orientation (%(default)s)",
    )
    add(
        "--integral-gain",
        type=float,
        default=0.0,
        metavar="1/S^2",
        help="feedback of the error's integral (%(default)s)",
    )
    add("--seed", type=int, default=0, help="of the noise (%(default)s)")
    add("--check", choices=tuple(CHECKS), default="proxqp", help="reference (%(default)s)")
    add("--tolerance", type=float, default=1e-6, metavar="RAD/S", help="gap (%(default)s)")
    add("--out", type=Path, default=Path("runs/heart"), metavar="DIR", help="(%(default)s)")
    add("--no-plots", dest="plots", action="store_false", help="write no figures")
    add("--quiet", action="store_true", help="no progress bar and no summary")
    return parser


def _simulation(options: argparse.Namespace) -> Simulation:
    """The run that the options ask for, every argument checked and nothing written."""
    robot = load_robot(options.robot, tip=options.tip, locked=options.lock)
    is_papers = robot.name == "iiwa7"
    q0 = start_posture(robot, is_papers) if options.q0 is None else np.array(options.q0)
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
    """Where to start when nobody says: the paper's posture, or the middle of each joint's range."""
    if is_papers and robot.dof == len(PAPER_START):
        return np.array(PAPER_START)
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
