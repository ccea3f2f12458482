"""``track``, ``physics`` and ``export``: a run, or its controller, from options and tables."""

import sys
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from tqdm import tqdm

from iiwa_dnn import (
    Controller,
    InvalidInputError,
    Record,
    Shield,
    export as exports,
    failures,
    simulate,
)
from iiwa_dnn.app.command_line import check_folder, write_settings
from iiwa_dnn.app.settings import Arguments, Tables, build, read_tables
from iiwa_dnn.app.words import ExportWords, RunWords
from iiwa_dnn.errors import RunInterrupted
from iiwa_dnn.results.pictures import save_pictures
from iiwa_dnn.results.plots import CAPTIONS
from iiwa_dnn.results.report import save_run, summary
from iiwa_dnn.robot.mujoco_model import prepare_renderer
from iiwa_dnn.robot.robot import Robot, model_limits
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.joint_limits import RateLimits
from iiwa_dnn.studies.paper import published

OUTPUTS = (
    "report.md",
    "video.mp4",
    *(f"{name}{suffix}" for name in CAPTIONS for suffix in (".png", ".pdf")),
)
"""Files of a run that another one in its folder may not write."""


def track(options: RunWords) -> int:
    """Draw a path with a robot arm, every step checked; by default the paper's heart.

    All further settings are arguments of the Python classes, given by --config or --set.
    Exit code 0: within limits and, unless continuous, solved and in agreement; 1: not so; 2: bad
    input.
    """
    tables, arguments = _read(options)
    usual = Path("runs") / Path(tables["reference"]["name"]).stem
    folder = options.out or (usual if options.config is None else options.config.parent)
    draw_more = None
    if options.plots and tables["plant"]["name"] == "mujoco":
        prepare_renderer()  # what it needs is asked for before the run
        draw_more = partial(save_pictures, arguments.robot)
    claim = partial(check_folder, folder, tables, options.overwrite)
    record, interrupt = _simulate(arguments, claim, options.quiet)
    for name in OUTPUTS:  # those of an earlier run
        (folder / name).unlink(missing_ok=True)
    write_settings(folder, tables)
    plots = options.plots and interrupt is None
    metrics = save_run(record, folder, plots, draw_more, published(record.settings))
    reasons = failures(metrics)
    if not options.quiet:
        print(summary(metrics), f"written to {folder}", sep="\n")
    elif reasons:
        print(*reasons, sep="\n", file=sys.stderr)
    if interrupt is not None:
        raise interrupt
    return 1 if reasons else 0


def _read(options: Any) -> tuple[Tables, Arguments]:
    """Read the tables and the arguments of a command; if it is quiet, warnings are not shown."""
    if options.quiet:
        warnings.simplefilter("ignore", UserWarning)
    tables = read_tables(options)
    return tables, build(tables)


def _simulate(
    arguments: Arguments, claim: Callable[[], None], quiet: bool
) -> tuple[Record, RunInterrupted | None]:
    """Simulate beside a progress bar; return the record, and the interrupt that cut it short.

    The folder is claimed once all arguments are found to be right.
    """
    steps = arguments.settings.steps(arguments.reference)
    # Hidden if standard error is no terminal.
    with tqdm(total=steps, unit="step", disable=quiet or None) as bar:

        def proceed(done: int) -> None:
            if done == 0:
                claim()
            bar.update(done)

        try:
            return simulate(*arguments, progress=proceed), None
        except RunInterrupted as interrupt:
            return interrupt.record, interrupt


def physics(options: RunWords) -> int:
    """Draw a path with an arm that has masses and motors, in MuJoCo, with pictures and a video."""
    usual = Path("runs") / "physics" if options.config is None else None
    return track(replace(options, plant=options.plant or "mujoco", out=options.out or usual))


def _shield(arguments: Arguments) -> Shield:
    """Make a shield with the robot, obstacles, rate limits and period of the settings."""
    avoidance = avoidance_of(arguments.scheme)
    return Shield(_limited(arguments), dt=arguments.settings.dt, obstacles=avoidance)


def _controller(arguments: Arguments) -> Controller:
    """Make the controller of a run; raises InvalidInputError if its velocities are filtered."""
    run = arguments.settings
    if run.filter_window > 1:
        raise InvalidInputError("filter_window", "is no part of a controller and is not exported")
    kept = {name: getattr(run, name) for name in ("dt", "mode", "policy", "solver")}
    return Controller(arguments.robot, arguments.scheme, arguments.reference, **kept)


def _limited(arguments: Arguments) -> Robot:
    """Return the robot with the rate limits of the settings, which a shield keeps."""
    robot = arguments.robot
    rates: dict[str, Any] = {"acceleration": np.inf, "jerk": np.inf}
    for limit in arguments.scheme.limits:
        if isinstance(limit, RateLimits):
            rates[limit.quantity] = limit.of(robot)
    return robot.with_limits(**rates)


def _warn_of_range(robot: Robot) -> None:
    """Warn if position limits lie beyond those of the robot's model."""
    lower, upper, _ = model_limits(robot.model)
    if (robot.q_lower < lower).any() or (robot.q_upper > upper).any():
        line = "position limits lie beyond the robot's own"
        print(f"{line}; for a real arm take --joint-limit datasheet", file=sys.stderr)


def export(options: ExportWords) -> int:
    """Write the controller of a run as C99: one file without dependencies, and its tests.

    With ``--tables FILE`` the tables of a shield of its robot, among its obstacles, which armstep
    loads; with ``--controller`` those of the controller.
    """
    tables, arguments = _read(options)
    is_shield = options.tables is not None and not options.controller
    made = _shield(arguments) if is_shield else _controller(arguments)
    if options.tables is None:
        folder = options.out or Path("controller")
        check_folder(folder, tables, options.overwrite)
        exports.c99(made, folder, arguments.q0, overwrite=True)
        write_settings(folder, tables)
        said = f"{folder}; to test it: make -C {folder}"
    else:
        exports.tables(made, options.tables, q0=arguments.q0)
        said = f"{options.tables}; to test it: python -m armstep check {options.tables}"
    unlimited = tables["limits"].get("acceleration") == "none"
    if is_shield:
        unlimited = not np.isfinite(made.robot.ddq_max).all()
    else:
        _warn_of_range(made.robot)
    if unlimited:
        line = "accelerations are not limited; for a real arm take --acceleration-limit robot"
        print(line, file=sys.stderr)
    if not options.quiet:
        print(f"written to {said}")
    return 0
