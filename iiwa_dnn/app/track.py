"""``track``: an arm draws a path; and the parts that all commands with an arm share."""

import sys
import warnings
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.app.command_line import progress_bar, tell
from iiwa_dnn.app.folders import claim_folder, save_settings
from iiwa_dnn.app.options import Check, TrackOptions
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.references import (
    Circle,
    Cone,
    Heart,
    Line,
    Lissajous,
    OnSurface,
    Reference,
    Target,
    Tilting,
    Waypoints,
)
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import rotation_angle
from iiwa_dnn.results.record import Record
from iiwa_dnn.results.report import save_run, settings_lines, summary
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.schemes import (
    AccelerationLimits,
    CollisionAvoidance,
    DoubleIndicator,
    JerkLimits,
    Limit,
    Scheme,
)
from iiwa_dnn.simulation import Plant, Simulation
from iiwa_dnn.studies import paper

CHECKS: dict[Check, tuple[str, ...]] = {
    "proxqp": ("proxqp",),
    "osqp": ("osqp",),
    "both": ("proxqp", "osqp"),
    "none": (),
}

# Of each path its own options, and the way from the options to it.
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
    "plane-heart": (
        ("scale", "normal", "period"),
        lambda o: OnSurface(Heart(o.scale, o.period), None, o.normal or None),
    ),
    "sphere-heart": (
        ("scale", "sphere", "normal", "period"),
        lambda o: OnSurface(Heart(o.scale, o.period), o.sphere, o.normal or None),
    ),
}
_CSV = (("tool_speed",), lambda o: Waypoints.from_csv(o.reference, speed=o.tool_speed))

_HERE = 1e-3, 1e-2
"""Distance [m] and angle [rad] up to which a path of poses begins where the tip is."""

_REST = 1e-6
"""Joint velocity [rad/s] below which an arm has come to rest."""

# Options that are arguments of a simulation under the same name.
_HANDED_ON = (
    "dt", "duration", "mode", "motion", "noise", "noise_at", "filter_window", "integral_gain",
    "policy", "seed",
)  # fmt: skip

# Options that have no effect, and beside which other ones they would have one.
_IDLE: dict[str, tuple[Callable[[Any], bool], str]] = {
    "next_gain": (lambda o: o.tracking != "next", "--tracking next"),
    "gain": (lambda o: o.tracking == "next", "--tracking paper; beside next it is --next-gain"),
    "noise_at": (lambda o: o.noise == 0.0, "--noise"),
    "tolerance": (lambda o: o.check == "none", "--check proxqp, osqp or both"),
    "push_at": (lambda o: o.push is None, "--push"),
    "push_for": (lambda o: o.push is None, "--push"),
}

More = Callable[[Record, Path], list[Path]]
Last = Callable[[Record, Path], None] | None


def run(options: TrackOptions) -> int:
    """Draw the path, check every step, write the run, and return the exit code."""
    return draw(options, simulation(options, *arm(options)))


def simulation(
    options: TrackOptions, robot: Robot, q0: Vector, plant: Plant | None = None
) -> Simulation:
    """Return the run that the options ask for from q0 (n,) [rad], checked and nothing written."""
    for name, (idle, beside) in _IDLE.items():
        value, default = (getattr(o, name, None) for o in (options, type(options)))
        if value != default and idle(options):
            flag = f"--{name.replace('_', '-')}"
            raise InvalidInputError(flag, f"has no effect but beside {beside}", value)
    scheme: Scheme = DoubleIndicator(
        weight=options.weight,
        position_gain=options.gain,
        orientation_gain=options.gain,
        orientation=options.orientation,
        kinetic=options.kinetic,
        extra_limits=motion_limits(options),
        tracking=options.tracking,
        next_gain=options.next_gain,
    )
    if options.obstacles is not None:
        avoidance = CollisionAvoidance.from_toml(options.obstacles)
        scheme = Scheme(scheme.costs, scheme.tasks, [*scheme.limits, avoidance])
    reference, start, elsewhere = path(options), Configuration(robot, q0), False
    further = [name for name in options.frames if name != robot.tip]
    own = {name: reference.anchored(start.frame(name)) for name in further}
    if getattr(reference, "quaternions", None) is None:
        reference = reference.anchored(start)
    else:
        elsewhere = tell_if_elsewhere(reference, start, scheme)
    if own:
        tasks: Any = scheme.tasks
        others = [replace(task, frame=name) for name in own for task in tasks]
        scheme = Scheme(scheme.costs, [*tasks, *others], scheme.limits)
    references = {robot.tip: reference, **own} if own else reference
    check = CrossCheck(CHECKS[options.check], options.tolerance)
    asked = {name: getattr(options, name) for name in _HANDED_ON}
    with warnings.catch_warnings():
        # What the summary says, and what is said already.
        warnings.filterwarnings("ignore", "" if elsewhere else "the start posture", UserWarning)
        return Simulation(robot, scheme, references, q0, plant=plant, check=check, **asked)


def motion_limits(options: TrackOptions) -> tuple[Limit, ...]:
    """Return the limits on acceleration and jerk that the options name.

    Raises:
        InvalidInputError: A limit is neither a positive number nor ``robot``.
    """
    limits: list[Limit] = []
    for kind in (AccelerationLimits, JerkLimits):
        value = getattr(options, kind.quantity)
        if value is None:
            continue
        try:
            limits.append(kind(None if value == "robot" else float(value)))
        except (ValueError, InvalidInputError) as error:
            option = f"--{kind.quantity.replace('_', '-')}"
            problem = f"must be a number above 0 or 'robot', not {value!r}"
            raise InvalidInputError(option, problem, value) from error
    return tuple(limits)


def tell_if_elsewhere(reference: Reference, start: Configuration, scheme: Scheme) -> bool:
    """Say where a path of poses in the base frame begins elsewhere than the tip, and return it."""
    first = reference.at(0.0)
    distance = float(np.linalg.norm(first.position - start.position))
    angle = float(rotation_angle(start.rotation, first.rotation))
    if not (elsewhere := distance > _HERE[0] or angle > _HERE[1]):
        return False
    away = f"{distance:.3g} m and {angle:.3g} rad from the tip"
    there = f"{np.round(first.position, 4).tolist()} m"
    q = _posture_at(first, start, scheme)
    found = "no way there was found from here"
    if q is not None:
        posture = " ".join(f"{value:.6f}" for value in q)
        found = f"to begin there, with another --out or --overwrite: --q0 {posture}"
    print(f"the path begins {away}, at {there}; {found}", file=sys.stderr)
    return elsewhere


def _posture_at(target: Target, start: Configuration, scheme: Scheme) -> Vector | None:
    """Let the controller take the tip to a target; the posture (n,) [rad] there, or None."""
    q, dt = start.q.copy(), 0.02
    controller = Controller(start.robot, scheme, dt=dt)
    for k in range(1000):
        dq = controller.step(q, k * dt, target).dq
        q = q + dt * dq
        if np.abs(dq).max() < _REST:
            break
    there = Configuration(start.robot, q)
    near = float(np.linalg.norm(there.position - target.position)) < _HERE[0]
    return q if near and rotation_angle(there.rotation, target.rotation) < _HERE[1] else None


def draw(
    options: TrackOptions, simulation: Simulation, more: More | None = None, last: Last = None
) -> int:
    """Carry out a run, write it into its folder and print its summary; return the exit code.

    `more` draws more figures into the folder and returns their files, `last` writes more files
    after the report.
    """
    folder = claim_folder(options)
    with progress_bar(simulation.steps, "step", options.quiet) as bar:
        record = simulation.run(bar.update)
    save_settings(options, folder)
    if not options.quiet and sys.stderr.isatty():
        print(f"writing report and figures to {folder}", file=sys.stderr)
    metrics = save_run(record, folder, plots=options.plots, more=more)
    if last is not None:
        last(record, folder)
    reasons = failures(record)
    if not options.quiet:
        shown = [settings_lines(metrics)] if options.verbose else []
        tell(options, *shown, summary(metrics, reasons), f"written to {folder}")
    elif reasons:
        print("\n".join(reasons), file=sys.stderr)
    return 1 if reasons else 0


def path(options: TrackOptions) -> Reference:
    """Return the path that the options name, before it is anchored.

    Raises:
        NotFoundError: There is no path of this name.
        FileError: The CSV file cannot be read, or holds no path.
        InvalidInputError: An option is out of range, or is given and another path's.
    """
    name = options.reference
    if name not in _PATHS and not name.lower().endswith(".csv"):
        raise NotFoundError("path", name, (*_PATHS, "FILE.csv"))
    own, make = _PATHS.get(name, _CSV)
    for other in sorted({*_CSV[0]}.union(*(options for options, _ in _PATHS.values()))):
        value, flag = getattr(options, other), f"--{other.replace('_', '-')}"
        if other not in own and value != getattr(TrackOptions, other):
            raise InvalidInputError(flag, f"is no option of the path {name!r}", value)
    return make(options)


def arm(options: TrackOptions) -> tuple[Robot, Vector]:
    """Return the robot with its limits, and its start posture [rad], (n,)."""
    robot = load_robot(
        options.robot, tip=options.tip, locked=options.lock, tool=options.tool or None
    )
    q0 = np.array(options.q0) if options.q0 else robot.start_posture()
    speed = checks.positive("speed", options.speed) * robot.dq_max
    robot = limited(robot, options.joint_limit).with_limits(velocity=speed)
    q0 = checks.finite_array("--q0", q0, (robot.dof,))
    if options.q0 and (problem := robot.outside(q0)):
        raise InvalidInputError("--q0", problem, options.q0)
    return robot, q0


def limited(robot: Robot, limit: str | None = None) -> Robot:
    """Return the robot with a position limit of every joint [rad], or the data sheet's limits.

    Raises:
        InvalidInputError: The limit is neither a positive angle nor ``datasheet``.
    """
    if limit is None:
        limit = str(paper.JOINT_LIMIT) if robot.name == "iiwa7" else "datasheet"
    if limit == "datasheet":
        return robot
    try:
        value = float(limit)
    except ValueError:
        value = 0.0
    if not value > 0.0:
        problem = f"must be a positive angle [rad] or 'datasheet', not {limit!r}"
        raise InvalidInputError("--joint-limit", problem, limit)
    return robot.with_limits(lower=-value, upper=value)
