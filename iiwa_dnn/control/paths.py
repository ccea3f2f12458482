"""The references of a control loop, one for each frame that tasks track."""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from pinocchio import log3

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp import Matrix
from iiwa_dnn.references import Reference, Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.collision import unwatched_links
from iiwa_dnn.schemes import OrientationTask, PoseTask, Scheme
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.limits import TipSpeedLimit, largest_gain
from iiwa_dnn.schemes.program import LimitNames, StepProgram
from iiwa_dnn.schemes.tasks import GainTask

References = Reference | Mapping[str, Reference]

FAR = 0.05
TURNED = 0.2
"""Distance [m] and angle [rad] of a first target from which on a warning is given."""
PLACES = 200
"""Places of a path at which it is looked at."""
SLOWEST = 0.1
"""Control period above which a warning is given [s]."""


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


def doubts(program: StepProgram, start: Configuration, dt: float, mode: str) -> Iterator[str]:
    """State for what reasons a loop is most likely not the wanted one.

    Args:
        program: The program of its steps.
        start: Where it begins.
        dt: Control period [s].
        mode: ``"converged"`` or ``"continuous"``.
    """
    robot = program.robot
    if problem := robot.outside(start.q):
        yield f"the start posture {problem}"
    for coupling in LimitNames(program, dt).conditions(start.q, program.least):
        yield f"{coupling} at the start: they come to it within the limits"
    yield from _doubts_of_tasks(program, dt)
    if dt > SLOWEST:
        yield f"a control period of {dt:g} s is long: the arm follows each command blindly"
    limits = program.scheme.limits
    if program.rate_limits is None and any(isinstance(limit, TipSpeedLimit) for limit in limits):
        yield "TipSpeedLimit holds beside AccelerationLimits alone: a command may be above it"
    lagging = [type(limit).__name__ for limit in limits if limit.row_count(robot)]
    if mode == "continuous" and lagging:
        yield (
            f"in continuous mode the rows of {', '.join(lagging)} hold where the network has "
            "settled, not on its way: only bounds of the joints are kept at every step"
        )
    if program.constants_of(CollisionAvoidance) and (links := unwatched_links(robot)):
        yield unwatched(links)


def _doubts_of_tasks(program: StepProgram, dt: float) -> Iterator[str]:
    """State that hard tasks have too many rows, or a gain too high for the limits at dt [s]."""
    variables = program.sizes[0]
    # The paper's four rows of an orientation have rank 3; couplings of joints hold always.
    tasks = [task for task in program.tasks if task.row_weight > 0.0]
    blocks = sum(getattr(task, "form", "") == "block" for task in tasks)
    rows = sum(task.row_count(program.robot) for task in tasks) - blocks
    if rows > variables:
        yield (
            f"{variables} joints cannot fulfil the {rows} rows of the tasks; orientation='none' "
            "leaves the orientation free"
        )
    gains = [min(task.gain, 1.0 / dt) for task in tasks if isinstance(task, GainTask)]
    if program.rate_limits is None or not gains:
        return
    largest = largest_gain(program.rate_limits.numbers(program.robot), 1.0 / dt)
    if max(gains) > largest * (1.0 + 1e-9):
        yield (
            f"a gain of {max(gains):.3g} 1/s is above {largest:.3g} 1/s, up to which a loop with "
            f"these limits on acceleration and jerk is stable at {dt:g} s a step (docs/limits.md)"
        )


def near_pairs(program: StepProgram, start: Configuration, t: float) -> Iterator[str]:
    """State which pairs are nearer than their distance where a loop begins, at time t [s]."""
    parts = [part for part in program.scheme.limits if isinstance(part, CollisionAvoidance)]
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
    distances = np.linalg.norm(path.sample(np.linspace(0.0, end, PLACES)).position, axis=1)
    return max(0.0, float(distances.max()) - robot.reach)


def far_targets(
    scheme: Scheme,
    frames: Sequence[str],
    start: Configuration,
    targets: Matrix,
) -> Iterator[str]:
    """State which first targets are far from their frames in a configuration.

    Args:
        scheme: The scheme, of which only an orientation task looks at angles.
        frames: Names of the frames of the targets.
        start: The configuration.
        targets: The targets, (k, 18).
    """
    turns = any(isinstance(task, OrientationTask | PoseTask) for task in scheme.tasks)
    for name, data in zip(frames, targets, strict=True):
        frame = start.frame(name)
        target = Target.from_data(data)
        distance = float(np.linalg.norm(target.position - frame.position))
        angle = turns * float(np.linalg.norm(log3(target.rotation @ frame.rotation.T)))
        if distance > FAR or angle > TURNED:
            yield (
                f"the reference begins {distance:.3g} m and {angle:.3f} rad from {name}; start at "
                "iiwa_dnn.solve_pose(robot, reference.at(0.0)).q, or use reference.anchored(start)"
            )
