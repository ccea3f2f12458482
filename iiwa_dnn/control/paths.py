"""References of a controller by tracked frame, and warnings before its first step."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from typing import Any

import numpy as np
from pinocchio import log3

from iiwa_dnn import checks
from iiwa_dnn.control.command import SINGULAR
from iiwa_dnn.errors import IiwaDnnError, InvalidInputError, warn_caller
from iiwa_dnn.naming import unguarded, unwatched
from iiwa_dnn.qp import Matrix
from iiwa_dnn.references import Reference
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.collision import TOO_NEAR, collision_model, unwatched_links
from iiwa_dnn.robot.meetings import CLEARANCE
from iiwa_dnn.robot.obstacles import names_of
from iiwa_dnn.robot.robot import model_limits
from iiwa_dnn.schemes import Limit, OrientationTask, PoseTask, Scheme, TorqueLimits
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.joint_limits import largest_gain
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.schemes.tasks import GainTask

References = Reference | Mapping[str, Reference]

FAR = 0.05
"""Distance of a first target from its frame above which a warning is given [m]."""
TURNED = 0.2
"""Angle of a first target from its frame above which a warning is given [rad]."""
SAMPLES = 200
"""Number of samples of a path in the test of its reach."""
SLOWEST = 0.1
"""Control period above which a warning is given [s]."""
FAR_ABOVE = 10.0
"""Ratio of a limit to that of the robot's file, or of a tool to the arm, above which a warning is
given."""
FURTHEST = 1.0
REMOTE = 150.0
OUTSTRETCHED = 3.0
"""Least distance, way to an obstacle and way to a payload's center above which a warning is given
[m]."""
LONGEST = {"timeout": 10.0, "delay": 1.0}
"""Times of a shield above which a warning is given [s]."""
DOUBLINGS = 16
"""Number of samples in the rank test: the path 1, 2, 4, ... control periods after its start."""
NEAR = 0.02
"""Largest change of position [m] and rotation entries of the samples that the rank test keeps."""
MISSING = 0.2
"""Relative residual of a task velocity above which the rank test gives a warning."""
ZERO = 1e-3
"""Singular values below this part of the largest count as zero in the rank test."""


def by_frame(reference: References | None, tip: str) -> Mapping[str, Reference]:
    """Return references by frame name; a single reference is that of frame `tip`, None gives {}.

    Raises:
        InvalidInputError: A value is not a `Reference`.
    """
    one = not isinstance(reference, Mapping) and reference is not None
    given: Any = {tip: reference} if one else reference or {}
    return {name: checks.instance("reference", path, Reference) for name, path in given.items()}


def paths_of(reference: References | None, tip: str, frames: Sequence[str]) -> dict[str, Reference]:
    """Return the reference of each tracked frame, in the order of `frames`.

    A single reference is that of frame `tip`.

    Raises:
        InvalidInputError: A tracked frame has no reference, or a frame that is not tracked has one.
    """
    given = by_frame(reference, tip)
    for name in {*frames} ^ {*given}:
        problem = "is missing for" if name in frames else "is given, but no task tracks"
        hint = "; give one, or a target to each step" if name in frames else ""
        raise InvalidInputError("reference", f"{problem} frame {name!r}{hint}", sorted(given))
    return {name: given[name] for name in frames}


def setup_warnings(
    program: ProgramLayout, start: Configuration, t: float, dt: float, mode: str
) -> Iterator[str]:
    """Yield warnings of settings or a start configuration that are most likely wrong.

    Args:
        program: Layout of the programs of a controller.
        start: Configuration at its first step.
        t: Time of the first step [s].
        dt: Control period [s].
        mode: ``"converged"`` or ``"continuous"``.
    """
    robot = program.robot
    for limit in program.limits:
        limit.check_start(robot, start.q)
    if problem := robot.outside(start.q):
        yield f"the start posture {problem}"
    yield from _unit_warnings(program)
    for coupling in LimitNames(program).conditions(start.q, program.least):
        yield f"{coupling} at the start: they come to it within the limits"
    yield from _gain_warnings(program, dt)
    if robot.payload is not None and not program.places_of(TorqueLimits):
        yield (
            f"the arm carries {robot.payload.words}, and no TorqueLimits are among its limits: it "
            "may be commanded more than its motors have"
        )
    if dt > SLOWEST:
        yield f"a control period of {dt:g} s is long: the arm follows each command blindly"
    limits = program.limits
    lagging = [type(limit).__name__ for limit in limits if limit.row_count(robot)]
    if mode == "continuous" and lagging:
        yield (
            f"in continuous mode the rows of {', '.join(lagging)} hold where the network has "
            "converged, not on its way: only bounds of the joints are kept at every step"
        )
    if program.places_of(CollisionAvoidance) and (links := unwatched_links(robot)):
        yield unwatched(links)
    yield from pair_warnings(program, start, t)


def warn_of_bodies(robot: Robot, limits: Sequence[Limit], warned: set[str]) -> None:
    """Warn of what watched distances assume of a robot's tools, or do not watch of them.

    Args:
        robot: The robot.
        limits: Limits of a controller or a shield.
        warned: Warnings that were given, to which those given now are added.
    """
    for message in _body_warnings(robot, limits):
        if message not in warned:
            warned.add(message)
            warn_caller(message)


def _body_warnings(robot: Robot, limits: Sequence[Limit]) -> Iterator[str]:
    parts = [part for part in limits if isinstance(part, CollisionAvoidance)]
    for part in parts:
        yield from (tool.assumption for tool in robot.tools if tool.assumption)
        unwatched_pairs: Sequence[tuple[str, str, str]] = ()
        with suppress(IiwaDnnError):  # a step raises it, with its reason
            unwatched_pairs = collision_model(robot).left_out
            if pairs := part.unguarded(robot):
                yield unguarded(pairs)
        for first, second, reason in unwatched_pairs:
            if part.self_collision and reason == TOO_NEAR:
                yield (
                    f"nothing keeps {second} and {first} apart: in every posture they are within "
                    f"{CLEARANCE:g} m of each other"
                )


def _unit_warnings(program: ProgramLayout) -> Iterator[str]:
    """Yield a warning for each length or limit that is most likely in mm or degrees."""
    robot = program.robot
    lower, upper, velocity = model_limits(robot.model)
    sizes = {"position": np.maximum(abs(lower), abs(upper)), "velocity": velocity}
    own = {"position": np.abs(robot.limits[:2]).max(axis=0), "velocity": robot.dq_max}
    for word, size in sizes.items():
        with np.errstate(invalid="ignore"):  # inf / inf
            ratio = np.where(np.isfinite(own[word]), own[word] / size, 0.0)
        i = int(np.argmax(ratio))
        if ratio[i] > FAR_ABOVE:
            unit = "mm" if i in robot.slides else "degrees"
            yield (
                f"joint {i + 1} has a {word} limit of {own[word][i]:g}, the robot's file "
                f"{size[i]:g}: is it in {unit}?"
            )
    tip = float(np.linalg.norm(robot.model.frames[robot.tip_id].placement.translation))
    if tip > max(FAR_ABOVE * float(robot.lengths.sum()), 1.0):
        yield f"the tip is {tip:g} m from its joint: is the tool in mm?"
    avoidances = [part for part in program.limits if isinstance(part, CollisionAvoidance)]
    lengths = [("a distance", part.distance, FURTHEST) for part in avoidances]
    names = [name for part in avoidances for name in names_of(part.obstacles)]
    obstacles = [each for part in avoidances for each in part.obstacles]
    for name, each in zip(names, obstacles, strict=True):
        lengths.append((f"the way to {name}", float(np.linalg.norm(each.box.center)), REMOTE))
    if robot.payload is not None:
        center = float(np.linalg.norm(robot.payload.center, axis=1).max())
        lengths.append(("the way to the payload's center", center, OUTSTRETCHED))
    for what, length, most in lengths:
        if length > most:
            yield f"{what} of {length:g} m is long: is it in mm?"


def long_times(times: Mapping[str, float]) -> Iterator[str]:
    """Yield a warning for each time [s], by its name, that is most likely in ms."""
    for name, time in times.items():
        if LONGEST[name] < time < math.inf:
            yield f"a {name} of {time:g} s is long: is it in ms?"


def _gain_warnings(program: ProgramLayout, dt: float) -> Iterator[str]:
    """Yield a warning if a task's gain is unstable with the rate limits at a period of dt [s]."""
    if not program.joint_limits.rated:
        return
    gains = [min(task.gain, 1.0 / dt) for task in program.tasks if isinstance(task, GainTask)]
    largest = largest_gain(program.joint_limits, 1.0 / dt)
    if max(gains, default=0.0) > largest * (1.0 + 1e-9):
        yield (
            f"a gain of {max(gains):.3g} 1/s is above {largest:.3g} 1/s, up to which a loop with "
            f"these limits on acceleration and jerk is stable at {dt:g} s a step (docs/limits.md)"
        )


def rank_warnings(
    program: ProgramLayout,
    start: Configuration,
    t: float,
    dt: float,
    sample: Callable[[float], Matrix],
) -> Iterator[str]:
    """Yield a warning if no joint velocity at the start fulfils the hard tasks.

    The task velocities are those of the path's samples near its start; bounds and inequality rows
    are ignored.

    Args:
        program: Layout of the programs of a controller.
        start: Configuration at its first step.
        t: Time of the first step [s].
        dt: Control period [s].
        sample: Function of a time [s] that returns the targets of k frames, (k, 18).
    """
    rest = np.zeros(start.q.size)
    targets = np.array([sample(t), *(sample(t + dt * 2.0**k) for k in range(DOUBLINGS))])
    near = np.abs(targets - targets[0])[..., :12].max(axis=(1, 2)) <= NEAR
    qps = [program.qp_at(start.q, rest, rest, each, dt) for each in targets[near]]
    A = qps[0].A
    b = np.transpose([qp.b for qp in qps])
    x, _, rank, _ = np.linalg.lstsq(A, b, rcond=ZERO)
    missing = np.linalg.norm(b - A @ x, axis=0)
    if (missing > MISSING * np.linalg.norm(b, axis=0) + 1e-6).any():  # that is rounding
        few = "orientation='none', or a PositionTask alone, leaves the orientation free"
        yield (
            f"{A.shape[1]} joints cannot fulfil the {len(A)} rows of the tasks, whose rank at the "
            f"start is {rank}: {SINGULAR if rank < min(A.shape) else few}"
        )


def pair_warnings(program: ProgramLayout, start: Configuration, t: float) -> Iterator[str]:
    """Yield a warning for each watched pair that is too near in a configuration at time t [s]."""
    parts = [part for part in program.limits if isinstance(part, CollisionAvoidance)]
    for part in parts:
        scene = part.scene(program.robot)
        distances = scene.distances(start.q[np.newaxis], np.array([t]))[0]
        for names, distance in zip(scene.pairs, distances, strict=True):
            if distance < 0.99 * part.distance:
                yield (
                    f"{' and '.join(names)} are {distance:.3g} m apart at the start, not "
                    f"{part.distance:g} m: until they are, they come no nearer than they begin"
                )


def beyond_reach(reference: References | None, robot: Robot) -> float:
    """Compute how far the tip's path exceeds the robot's reach [m]; 0 if it does not."""
    path = by_frame(reference, robot.tip).get(robot.tip)
    if path is None:
        return 0.0
    end = path.duration if math.isfinite(path.duration) else 0.0
    distances = np.linalg.norm(path.sample(np.linspace(0.0, end, SAMPLES)).position, axis=1)
    return max(0.0, float(distances.max()) - robot.reach)


def target_warnings(
    scheme: Scheme,
    frames: Sequence[str],
    start: Configuration,
    targets: Matrix,
) -> Iterator[str]:
    """Yield a warning for each frame that starts far from its first target.

    Args:
        scheme: The scheme; angles are compared only if it has an orientation or pose task.
        frames: Names of the k tracked frames.
        start: Configuration at the first step.
        targets: First targets of the frames, `Target.data`, (k, 18).
    """
    turns = any(isinstance(task, OrientationTask | PoseTask) for task in scheme.tasks)
    for name, data in zip(frames, targets, strict=True):
        frame = start.frame(name)
        distance = np.linalg.norm(data[:3] - frame.position)
        angle = turns * np.linalg.norm(log3(data[3:12].reshape(3, 3) @ frame.rotation.T))
        if distance > FAR or angle > TURNED:
            yield (
                f"the reference begins {distance:.3g} m and {angle:.3f} rad from {name}; start at "
                "iiwa_dnn.solve_pose(robot, reference.at(0.0)).q, or use reference.anchored(start)"
            )
