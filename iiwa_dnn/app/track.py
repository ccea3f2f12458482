"""``track``: an arm draws a path; also the functions that all commands with an arm use."""

import sys
import warnings
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import flag_of, print_lines, progress_bar
from iiwa_dnn.app.folders import claim_folder, save_settings
from iiwa_dnn.app.options import Check, TrackOptions
from iiwa_dnn.control.paths import References
from iiwa_dnn.control.posing import solve_pose
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.references import (
    Circle,
    Cone,
    Heart,
    Line,
    Lissajous,
    Reference,
    Tilting,
    Waypoints,
)
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import rotation_angle
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.report import save_run, settings_lines, summary
from iiwa_dnn.results.table import save_csv
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.schemes import (
    AccelerationLimits,
    CollisionAvoidance,
    DoubleIndicator,
    JerkLimits,
    Limit,
    Scheme,
    TipSpeedLimit,
)
from iiwa_dnn.schemes.collisions import avoidance_of, unwatched_by
from iiwa_dnn.simulation import Plant, count_steps, simulate
from iiwa_dnn.studies import paper

CHECKS: dict[Check, tuple[str, ...]] = {
    "proxqp": ("proxqp",),
    "osqp": ("osqp",),
    "both": ("proxqp", "osqp"),
    "proof": ("proof",),
    "none": (),
}

# The options of each path, and the function that makes the path from all options.
_PATHS: dict[str, tuple[tuple[str, ...], Callable[[Any], Reference]]] = {
    "heart": (("scale", "period"), lambda o: Heart(o.scale, o.period)),
    "circle": (("radius", "period"), lambda o: Circle(o.radius, o.period)),
    "line": (("offset", "period"), lambda o: Line(o.offset, o.period)),
    "lissajous": (("amplitudes", "period"), lambda o: Lissajous(o.amplitudes, period=o.period)),
    "cone": (("angle", "period"), lambda o: Cone(o.angle, o.period)),
    "tilting-circle": (
        ("radius", "angle", "period"),
        lambda o: Tilting(Circle(o.radius, o.period), o.angle),
    ),
    "FILE.csv": (
        ("tool_speed", "stretch"),
        lambda o: Waypoints.from_csv(o.reference, speed=o.tool_speed, stretch=o.stretch),
    ),
}

_NEAR_POSITION = 1e-3
"""Distance [m] up to which a path of poses begins at the tip."""

_NEAR_ANGLE = 1e-2
"""Angle [rad] up to which a path of poses begins at the tip."""

# Options that are arguments of a simulation under the same name.
_ARGUMENTS = (
    "dt",
    "duration",
    "mode",
    "motion",
    "noise",
    "noise_at",
    "filter_window",
    "policy",
    "seed",
)

# Options without effect under a condition, and the option that they need.
_IDLE: dict[str, tuple[Callable[[Any], bool], str]] = {
    "next_gain": (lambda o: o.tracking != "next", "--tracking next"),
    "gain": (lambda o: o.tracking == "next", "--tracking paper; beside next it is --next-gain"),
    "tip_speed_limit": (lambda o: o.acceleration_limit is None, "--acceleration-limit"),
    "noise_at": (lambda o: o.noise == 0.0, "--noise"),
    "tolerance": (lambda o: o.check == "none", "--check proxqp, osqp, both or proof"),
    "push_at": (lambda o: not o.push, "--push"),
    "push_for": (lambda o: not o.push, "--push"),
}


class Drawing(NamedTuple):
    """A run and its number of steps."""

    run: partial[Record]
    steps: int


More = Callable[[Record, Path], list[Path]]
Last = Callable[[Record, Path], None] | None


def run(options: TrackOptions) -> int:
    """Draw the path, check every step, write the run, and return the exit code."""
    return draw(options, simulation(options, *arm(options)))


def beyond_data_sheet(options: TrackOptions, q: Matrix) -> str:
    """State by how much the paper's limits let joint positions (k, n) [rad] leave the data sheet's.

    Empty if they do not, or if limits were asked for.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # it is the robot of the run, which is printed already
        sheet = load_options(options)
    if options.joint_limit is not None or limited(sheet) is sheet:
        return ""
    problem = sheet.outside(q.max(axis=0)) or sheet.outside(q.min(axis=0))
    if not problem:
        return ""
    return (
        f"by the data sheet joint positions {problem}; the paper's limits are wider: for a real "
        "arm take --joint-limit datasheet"
    )


def simulation(
    options: TrackOptions, robot: Robot, q0: Vector, plant: Plant | None = None
) -> Drawing:
    """Return the run that the options describe from q0 (n,) [rad]; no file is written."""
    for name, (is_idle, needed) in _IDLE.items():
        if hasattr(options, name) and is_idle(options):
            refuse_set(options, name, f"has no effect but beside {needed}")
    scheme = scheme_of(options)
    start = Configuration(robot, q0)
    reference = path(options)
    other_frames = [name for name in options.frames if name != robot.tip]
    others = {name: reference.anchored(start.frame(name)) for name in other_frames}
    if getattr(reference, "quaternions", None) is None:
        reference = reference.anchored(start)
    else:
        print_if_elsewhere(reference, start, scheme)
    if others:
        tasks: Any = scheme.tasks
        further = [replace(task, frame=name) for name in others for task in tasks]
        scheme = Scheme(scheme.costs, [*tasks, *further], scheme.limits)
    arguments = {name: getattr(options, name) for name in _ARGUMENTS}
    print_if_unwatched(scheme, robot)
    paths: References = {robot.tip: reference, **others} if others else reference
    run = partial(
        simulate,
        robot,
        scheme,
        paths,
        q0,
        plant=plant,
        check=CrossCheck(CHECKS[options.check], options.tolerance),
        far_start=True,
        **arguments,
    )
    return Drawing(run, count_steps(paths, options.dt, options.duration))


def scheme_of(options: TrackOptions) -> Scheme:
    """Return the scheme that the options describe, for one frame."""
    scheme = DoubleIndicator(
        weight=options.weight,
        position_gain=options.gain,
        orientation_gain=options.gain,
        orientation=options.orientation,
        kinetic=options.kinetic,
        extra_limits=motion_limits(options),
        tracking=options.tracking,
        next_gain=options.next_gain,
    )
    if options.obstacles is None:
        return scheme
    avoidance = CollisionAvoidance.from_toml(options.obstacles)
    return Scheme(scheme.costs, scheme.tasks, [*scheme.limits, avoidance])


def motion_limits(options: TrackOptions) -> tuple[Limit, ...]:
    """Return the limits on acceleration, jerk and the tip's speed that the options describe.

    Raises:
        InvalidInputError: A limit is neither a positive number nor ``robot``.
    """
    limits: list[Limit] = [
        kind(_number_or_word(kind.quantity, getattr(options, kind.quantity), "robot"))
        for kind in (AccelerationLimits, JerkLimits)
        if getattr(options, kind.quantity) is not None
    ]
    if options.tip_speed_limit is not None:
        limits.append(TipSpeedLimit(options.tip_speed_limit))
    return tuple(limits)


def print_if_elsewhere(reference: Reference, start: Configuration, scheme: Scheme) -> None:
    """Print where a path of poses begins if not at the tip, and a posture to start it from."""
    target = reference.at(0.0)
    distance = np.linalg.norm(target.position - start.position)
    angle = rotation_angle(start.rotation, target.rotation)
    if distance <= _NEAR_POSITION and angle <= _NEAR_ANGLE:
        return
    answer = solve_pose(start.robot, target, start.q, obstacles=avoidance_of(scheme) or ())
    advice = f"no posture was found there: {answer}"
    if answer.q is not None:
        posture = " ".join(f"{value:.6f}" for value in answer.q)
        advice = f"to start there, run again with --overwrite --q0 {posture}"
    turned = f", turned by {angle:.3g} rad" if angle > _NEAR_ANGLE else ""
    print(
        f"the path begins at {np.round(target.position, 4).tolist()} m, {distance:.3g} m from the "
        f"tip{turned}: the arm goes there first; {advice}",
        file=sys.stderr,
    )


def print_if_unwatched(scheme: Scheme, robot: Robot) -> None:
    """Print which links a scheme that avoids collisions does not watch."""
    if links := unwatched_by(scheme, robot):
        print(unwatched(links), file=sys.stderr)


def refuse_set(options: TrackOptions, name: str, problem: str) -> None:
    """Raise an InvalidInputError if an option differs from its default."""
    value = getattr(options, name)
    if value != getattr(type(options), name):
        raise InvalidInputError(flag_of(name), problem, value)


def draw(
    options: TrackOptions, simulation: Drawing, more: More | None = None, last: Last = None
) -> int:
    """Carry out a run, write it into its folder and print its summary; return the exit code.

    Args:
        options: Options of the run.
        simulation: The run.
        more: Function that draws further figures into the folder and returns their files.
        last: Function that writes further files after the report.
    """
    folder = options.out
    with progress_bar(simulation.steps, "step", options.quiet) as bar:

        def go_on(steps: int) -> None:
            if steps == 0:
                claim_folder(options)
            bar.update(steps)

        record = _carry_out(simulation, go_on)
    save_settings(options, folder)
    if not options.quiet and sys.stderr.isatty():
        print(f"writing report and figures to {folder}", file=sys.stderr)
    metrics = save_run(record, folder, plots=options.plots, more=more)
    if options.csv:
        save_csv(record, folder / "record.csv")
    if last is not None:
        last(record, folder)
    reasons = failures(record)
    if not options.quiet:
        if beyond := beyond_data_sheet(options, record.q):
            print(beyond, file=sys.stderr)
        shown = [settings_lines(metrics)] if options.verbose else []
        print_lines(options, *shown, summary(metrics, reasons), f"written to {folder}")
    elif reasons:
        print("\n".join(reasons), file=sys.stderr)
    return 1 if reasons else 0


def _carry_out(drawing: Drawing, progress: Callable[[int], object]) -> Record:
    """Carry out a run; print of its warnings what no summary says."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", UserWarning)
        record = drawing.run(progress=progress)
    # The summary says that the start is outside, other lines speak of the path and of links.
    for warning in caught:
        if "cannot hold a pose" in str(warning.message):
            line = f"{record.dof} joints cannot hold a pose: --orientation none"
            print(line, file=sys.stderr)
    return record


def path(options: TrackOptions) -> Reference:
    """Return the path that the options describe, before it is anchored.

    Raises:
        NotFoundError: There is no path of this name.
        FileError: The CSV file cannot be read, or holds no path.
        InvalidInputError: An option is out of range, or is set and another path's.
    """
    name = options.reference
    kind = "FILE.csv" if name.lower().endswith(".csv") else name
    if kind not in _PATHS:
        raise NotFoundError("path", name, _PATHS)
    own, make = _PATHS[kind]
    for names, _ in _PATHS.values():
        for other in set(names) - set(own):
            refuse_set(options, other, f"is no option of the path {name!r}")
    return make(options)


def load_options(options: TrackOptions) -> Robot:
    """Return the robot that the options name."""
    return load_robot(
        options.robot,
        tip=options.tip,
        locked=options.lock,
        tool=options.tool or None,
        frames=options.frames,
    )


def arm(options: TrackOptions) -> tuple[Robot, Vector]:
    """Return the robot with its limits, and its start posture [rad], (n,)."""
    robot = load_options(options)
    q0 = robot.start_posture()
    if not options.q0 and not robot.has_known_start:
        line = f"no start posture is known of {robot.name!r}: its joints begin near the middle"
        print(f"{line} of their ranges; --q0 chooses another", file=sys.stderr)
    speed = checks.positive("speed", options.speed) * robot.dq_max
    robot = limited(robot, options.joint_limit).with_limits(velocity=speed)
    if not options.q0:
        return robot, q0
    q0 = checks.finite_array("--q0", options.q0, (robot.dof,))
    problem = robot.outside(q0)
    if problem:
        raise InvalidInputError("--q0", problem, options.q0)
    return robot, q0


def limited(robot: Robot, limit: str | None = None) -> Robot:
    """Return the robot with a position limit of every joint [rad], or the data sheet's limits.

    Raises:
        InvalidInputError: The limit is neither a positive angle nor ``datasheet``.
    """
    if limit is None:
        limit = str(paper.JOINT_LIMIT) if robot.name == "iiwa7" else "datasheet"
    angle = _number_or_word("joint_limit", limit, "datasheet")
    return robot if angle is None else robot.with_limits(lower=-angle, upper=angle)


def _number_or_word(option: str, text: str, word: str) -> float | None:
    """Return the positive number that an option holds, or None if it holds a word."""
    if text == word:
        return None
    try:
        return checks.positive(flag_of(option), float(text))
    except ValueError as error:
        problem = f"must be a number above 0 or {word!r}, not {text!r}"
        raise InvalidInputError(flag_of(option), problem, text) from error
