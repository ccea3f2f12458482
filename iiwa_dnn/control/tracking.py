"""Step of a controller as a kernel over the memory of an arm, for exported C.

Kinematics are those of `write_kinematics`, periods are constant, targets are given or those of the
compiled paths. At the desk `Controller.step` calls `take_step` after Pinocchio's kinematics.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.control.command import log_of
from iiwa_dnn.control.cycle import INVALID, is_valid, sample_targets, take_step
from iiwa_dnn.control.plan import ControlPlan
from iiwa_dnn.control.policies import ProgramKind
from iiwa_dnn.control.state import MotionState, count_as_sent
from iiwa_dnn.control.stopping import brake_blindly
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.robot.kinematics_kernel import ModelTables, write_kinematics
from iiwa_dnn.schemes.program import ProgramArrays


class TrackingSizes(NamedTuple):
    """Sizes of the parts of `TrackingState`, in the order of their names there."""

    log: int
    motion: int
    network: int
    fallback: int


class TrackingState(Record):
    """State of a controller's arm between steps, with the log of the last step.

    Attributes:
        log: Log of the last step.
        motion: `MotionState`.
        network: State of the network.
        fallback: States of the networks of fallback programs.
    """

    log: Vector = part("log")
    motion: Vector = part("motion")
    network: Vector = part("network")
    fallback: Vector = part("fallback")


class TrackingPlan(NamedTuple):
    """Layout of the steps of a controller's arms.

    Attributes:
        robot: Tables of the robot, n joints.
        step: Layout of the control step; none is sampled by it.
        sizes: Sizes of `TrackingState`.
    """

    robot: ModelTables
    step: ControlPlan
    sizes: TrackingSizes


@compiled
def tracking_state(plan: TrackingPlan, memory: Vector) -> TrackingState:
    """View the memory (k,) of an arm as its state."""
    sizes = plan.sizes
    return TrackingState.of(memory, sizes.log, sizes.motion, sizes.network, sizes.fallback)


@compiled
def tracking_motion(plan: TrackingPlan, memory: Vector) -> MotionState:
    """View the state of an arm's motion."""
    arm = tracking_state(plan, memory)
    sizes = plan.step.arrays.sizes
    return MotionState.of(arm.motion, sizes.joints, sizes.pairs)


@compiled
def send_tracking(
    plan: TrackingPlan, memory: Vector, dq: Vector, period: float, fraction: float
) -> None:
    """Count a velocity as sent, in place of a step's command.

    Args:
        plan: Layout of the step.
        memory: The arm's memory, (k,).
        dq: The velocity [rad/s], (n,).
        period: Time for which it is held [s].
        fraction: Fraction of the period by which the reference's clock went on.
    """
    motion = tracking_motion(plan, memory)
    count_as_sent(motion, dq, period)
    motion.path_lag += period * (1.0 - fraction)


@compiled
def sample_tracking(plan: TrackingPlan, memory: Vector, t: float, targets: Matrix) -> None:
    """Sample the targets (frames, 18) of the paths at time t [s], less the delay of their clock."""
    motion = tracking_motion(plan, memory)
    sample_targets(plan.step.paths, t - motion.path_lag, plan.step.timing.dt, targets)


@compiled
def brake_tracking(plan: TrackingPlan, memory: Vector) -> None:
    """Take the next command of the motion to rest, in place of a step that is refused."""
    motion = tracking_motion(plan, memory)
    arm = tracking_state(plan, memory)
    log = log_of(arm.log, plan.step.arrays.sizes)
    dt = plan.step.timing.dt
    brake_blindly(motion, plan.step.yielding.limits, plan.step.yielding.cubic)
    motion.path_lag += dt
    log.fraction = 0.0
    log.kind = ProgramKind.STOPPED
    for i in range(motion.last.size):
        log.dq[i] = motion.last[i]
        log.next_q[i] += dt * motion.last[i]


@compiled
def step_tracking(plan: TrackingPlan, memory: Vector, q: Vector, t: float, targets: Vector) -> int:
    """Take a step of a controller; its command is then that in the log.

    Args:
        plan: Layout of the step.
        memory: The arm's memory, (k,), overwritten.
        q: Measured joint positions [rad], (n,).
        t: Time [s].
        targets: Targets of the tracked frames, (18 frames,); or none: those of the paths.

    Returns:
        The `Action` that was taken; `INVALID`, with the memory unchanged, if an argument is not
        finite, or if there are neither targets nor paths.
    """
    arm = tracking_state(plan, memory)
    base = plan.step.arrays
    log = log_of(arm.log, base.sizes)
    if not is_valid(t, q, targets, 0) or targets.size + len(plan.step.paths.table) == 0:
        return INVALID
    if targets.size > 0:
        copied(log.targets.reshape(targets.size), targets)
    else:
        sample_tracking(plan, memory, t, log.targets)
    arrays = ProgramArrays(
        base.sizes,
        base.table,
        base.constants,
        np.empty((base.sizes.joints, 6)),
        np.empty((base.placements.shape[0], 12)),
        base.support,
        np.empty((base.inertia.shape[0], base.inertia.shape[1])),
        base.tip,
    )
    write_kinematics(plan.robot, q, arrays.jacobian, arrays.placements, arrays.inertia)
    step = ControlPlan(
        arrays,
        plan.step.network,
        plan.step.paths,
        plan.step.yielding,
        arm.fallback,
        plan.step.policy,
        False,
        plan.step.timing,
    )
    following = np.empty(arm.motion.size)
    action = take_step(arm.log, step, q, arm.motion, following, arm.network, t)
    if action != INVALID:
        copied(arm.motion, following)
    return action
