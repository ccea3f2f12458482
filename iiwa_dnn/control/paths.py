"""The references of a control loop, one for each frame that tasks track."""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from pinocchio import log3

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp import Matrix
from iiwa_dnn.references import Reference, Target
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes import OrientationTask, PoseTask, Scheme
from iiwa_dnn.schemes.collisions import unwatched_by
from iiwa_dnn.schemes.limits import largest_gain
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.program import StepProgram
from iiwa_dnn.schemes.tasks import GainTask

References = Reference | Mapping[str, Reference]

FAR = 0.05
TURNED = 0.2
"""Distance [m] and angle [rad] of a first target from which on a warning is given."""


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
    if reference is None:
        raise InvalidInputError("reference", "is missing: give one, or a target to each step")
    given = by_frame(reference, tip)
    wrong = [name for name in frames if name not in given]
    if wrong or (wrong := [name for name in given if name not in frames]):
        problem = "is missing for" if wrong[0] in frames else "is given, but no task tracks"
        raise InvalidInputError("reference", f"{problem} frame {wrong[0]!r}")
    return {name: given[name] for name in frames}


def warn_if_outside(start: Configuration, stacklevel: int) -> None:
    """Warn where a motion begins outside the joint limits."""
    if problem := start.robot.outside(start.q):
        warnings.warn(f"the start posture {problem}", stacklevel=stacklevel + 1)


def warn_if_too_few(program: StepProgram, stacklevel: int) -> None:
    """Warn where hard tasks have more independent rows than there are variables."""
    variables = program.sizes[0]
    # The paper's four rows of an orientation have rank 3; couplings of joints hold always.
    tasks = [task for task in program.tasks if task.row_weight > 0.0]
    counts = [task.row_count(program.robot) for task in tasks]
    rows = sum(counts) - sum(getattr(task, "form", "") == "block" for task in tasks)
    if rows > variables:
        names = ", ".join(type(task).__name__ for task in tasks)
        turning = any(isinstance(task, _TURNING) for task in tasks)
        message = f"{variables} joints cannot fulfil the {rows} rows of {names}"
        if turning:
            message = f"{variables} joints cannot hold a pose: orientation='none' leaves it free"
        warnings.warn(message, stacklevel=stacklevel + 1)


def warn_if_unstable(program: StepProgram, dt: float, stacklevel: int) -> None:
    """Warn where a gain is too high for the acceleration and jerk limits at a period dt [s]."""
    if program.rate_limits is None:
        return
    robot = program.robot
    rate = 1.0 / dt
    largest = largest_gain(program.rate_limits.constants(robot), rate)
    gain = 0.0
    for block in program.blocks:
        if isinstance(block.part, GainTask) and block.part.row_weight > 0.0:
            gain = max(gain, min(block.part.gain, rate))
    if gain > largest * (1.0 + 1e-9):
        message = (
            f"a gain of {gain:.3g} 1/s is above {largest:.3g} 1/s, up to which a loop with these "
            f"limits on acceleration and jerk is stable at {dt:g} s a step (docs/limits.md)"
        )
        warnings.warn(message, stacklevel=stacklevel + 1)


def warn_if_lagging(program: StepProgram, mode: str, stacklevel: int) -> None:
    """Warn where a network that lags behind cannot keep a limit: only bounds hold on its way."""
    limits = [block.part for block in program.blocks if isinstance(block.part, Limit)]
    names = [type(limit).__name__ for limit in limits if limit.row_count(program.robot)]
    if mode == "continuous" and names:
        message = (
            f"in continuous mode the rows of {', '.join(names)} hold where the network has "
            "settled, not on its way: only bounds of the joints are kept at every step"
        )
        warnings.warn(message, stacklevel=stacklevel + 1)


def warn_if_unwatched(scheme: object, robot: Robot, stacklevel: int) -> None:
    """Warn where a scheme avoids collisions, but links have no collision geometry."""
    if links := unwatched_by(scheme, robot):
        warnings.warn(unwatched(links), stacklevel=stacklevel + 1)


def warn_if_far(
    scheme: Scheme,
    references: Mapping[str, Reference],
    start: Configuration,
    targets: Matrix,
    stacklevel: int,
    refuses: bool = False,
) -> None:
    """Warn where first targets are far from their frames in a configuration.

    Args:
        scheme: The scheme, of which only an orientation task looks at angles.
        references: References by frame name, in the order of the targets.
        start: The configuration.
        targets: The targets, (k, 18).
        stacklevel: As of `warnings.warn`.
        refuses: Whether a path of poses that begins elsewhere is refused.

    Raises:
        InvalidInputError: Such a path does.
    """
    turns = any(isinstance(task, _TURNING) for task in getattr(scheme, "tasks", ()))
    for (name, reference), data in zip(references.items(), targets, strict=True):
        frame = start.frame(name)
        target = Target.from_data(data)
        distance = float(np.linalg.norm(target.position - frame.position))
        angle = turns * float(np.linalg.norm(log3(target.rotation @ frame.rotation.T)))
        if distance <= FAR and angle <= TURNED:
            continue
        where = "tip" if name == start.robot.tip else f"frame {name}"
        turned = f", turned by {angle:.3g} rad" if angle > TURNED else ""
        message = f"begins {distance:.3g} m from the {where}{turned}"
        if getattr(reference, "quaternions", None) is None:
            advice = "reference.anchored(configuration) begins there"
        else:
            advice = "start at iiwa_dnn.solve_pose(robot, reference.at(0.0)).q"
            if refuses:
                problem = f"{message}; {advice}, or pass far_start=True to go there first"
                raise InvalidInputError("reference", problem, reference)
        warnings.warn(f"the reference {message}; {advice}", stacklevel=stacklevel)


_TURNING = (OrientationTask, PoseTask)
