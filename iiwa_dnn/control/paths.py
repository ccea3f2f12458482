"""References of a control loop by frame, and start-up diagnostics."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from pinocchio import log3

from iiwa_dnn import checks
from iiwa_dnn.control.command import SINGULAR
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp import Matrix
from iiwa_dnn.references import Reference
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.collision import unwatched_links
from iiwa_dnn.schemes import OrientationTask, PoseTask, Scheme
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.layout import ProgramLayout
from iiwa_dnn.schemes.names import LimitNames
from iiwa_dnn.schemes.rate_limits import largest_gain
from iiwa_dnn.schemes.tasks import GainTask
from iiwa_dnn.schemes.tip_speed import TipSpeedLimit

References = Reference | Mapping[str, Reference]

FAR = 0.05
TURNED = 0.2
"""Distance [m] and angle [rad] of a first target above which a warning is given."""
SAMPLES = 200
"""Number of samples of a path."""
DOUBLINGS = 16
"""Number of samples of a path's start: a control period ahead, two, four, ..."""
NEAR = 0.02
"""Distance [m] and change of the entries of a rotation in which a path is nearly straight."""
MISSING = 0.2
"""Relative residual of a task velocity that such a curvature does not explain."""
ZERO = 1e-3
"""Ratio of singular values below which they count as zero."""


def by_frame(reference: References | None, tip: str) -> Mapping[str, Reference]:
    """Return references by frame name: one alone is the tip's; none where there is none.

    Raises:
        InvalidInputError: One of them is no reference.
    """
    one = not isinstance(reference, Mapping) and reference is not None
    given: Any = {tip: reference} if one else reference or {}
    return {name: checks.instance("reference", path, Reference) for name, path in given.items()}


def paths_of(reference: References | None, tip: str, frames: Sequence[str]) -> dict[str, Reference]:
    """Return the reference of each frame, in their order.

    Raises:
        InvalidInputError: One of the frames has no reference, or another one has.
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
    """Report settings of a loop, or a place where it begins, that are most likely wrong.

    Args:
        program: The program of its steps.
        start: Where it begins.
        t: Time at which it begins [s].
        dt: Control period [s].
        mode: ``"converged"`` or ``"continuous"``.
    """
    robot = program.robot
    if problem := robot.outside(start.q):
        yield f"the start posture {problem}"
    for coupling in LimitNames(program).conditions(start.q, program.least):
        yield f"{coupling} at the start: they come to it within the limits"
    yield from _gain_warnings(program, dt)
    limits = program.limits
    if program.rate_limits is None and any(isinstance(limit, TipSpeedLimit) for limit in limits):
        yield "TipSpeedLimit holds beside AccelerationLimits alone: a command may be above it"
    lagging = [type(limit).__name__ for limit in limits if limit.row_count(robot)]
    if mode == "continuous" and lagging:
        yield (
            f"in continuous mode the rows of {', '.join(lagging)} hold where the network has "
            "converged, not on its way: only bounds of the joints are kept at every step"
        )
    if program.places_of(CollisionAvoidance) and (links := unwatched_links(robot)):
        yield unwatched(links)
    yield from pair_warnings(program, start, t)


def _gain_warnings(program: ProgramLayout, dt: float) -> Iterator[str]:
    """Report a gain that is too high for the limits on acceleration and jerk at dt [s]."""
    if program.rate_limits is None:
        return
    gains = [min(task.gain, 1.0 / dt) for task in program.tasks if isinstance(task, GainTask)]
    largest = largest_gain(program.rate_limits.constants(program.robot), 1.0 / dt)
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
    """Report hard tasks that no joint velocity at the start fulfils.

    The path is looked at as long as it is near to where it begins.

    Args:
        program: The program of its steps.
        start: Where a loop begins.
        t: Time at which it begins [s].
        dt: Control period [s].
        sample: Returns the targets of a time [s], (k, 18).
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
    """Report pairs that are nearer than their distance where a loop begins, at time t [s]."""
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
    """Compute how far the tip's path leads beyond the robot's reach [m], 0 if it does not."""
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
    """Report first targets that are far from their frames in a configuration.

    Args:
        scheme: The scheme, of which only an orientation task looks at angles.
        frames: Names of the frames of the targets.
        start: The configuration.
        targets: The targets, (k, 18).
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
