"""Margins, stopping time and frames of an arm, asked between its steps."""

from __future__ import annotations

import numpy as np

from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import largest_entry
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.robot.kinematics_kernel import write_kinematics
from iiwa_dnn.schemes.joint_limits import (
    motion_constants,
)
from iiwa_dnn.schemes.program import block_constants
from iiwa_dnn.schemes.scene import scene_views, write_distances
from iiwa_dnn.schemes.separation import (
    nearest_body,
    separation_views,
)
from iiwa_dnn.schemes.torque import torque_margin
from iiwa_dnn.step.bodies import (
    grow_older,
    write_bodies,
)
from iiwa_dnn.step.memory import ArmPlan, arm_state, motion_of, place_obstacles
from iiwa_dnn.step.requests import (
    TWIST,
    RequestConstants,
    twist_rows,
)
from iiwa_dnn.step.stopping import least_periods


@compiled
def separation_of(plan: ArmPlan, memory: Vector) -> Vector3:
    """Find the nearest link and body, as `nearest_body`, where an arm's last command starts from.

    Without bodies of bounded speed the separation is inf; of an arm that has not begun, NaN.
    """
    arm = arm_state(plan, memory)
    if plan.separation < 0 or not arm.has_begun:
        return np.inf if arm.has_begun else np.nan, 0.0, 0.0
    base = plan.step.arrays
    q = motion_of(plan, arm).q
    jacobian = np.empty((q.size, 6))
    placements = np.empty((base.placements.shape[0], 12))
    write_kinematics(plan.robot, q, jacobian, placements, base.inertia)
    constants = block_constants(base, plan.separation).copy()
    write_bodies(constants, arm.bodies, arm.seen.age)
    grow_older(separation_views(constants).bodies, -arm.period)
    head = separation_views(constants).head
    head.age -= arm.period
    return nearest_body(constants, placements)


@compiled
def margin_of(plan: ArmPlan, memory: Vector) -> tuple[float, float]:
    """Compute the `Margin` of an arm at the joint positions that its last command starts from.

    Of an arm that has not begun it is NaN.
    """
    arm = arm_state(plan, memory)
    if not arm.has_begun:
        return np.nan, np.nan
    q = motion_of(plan, arm).q
    limits = motion_constants(plan.step.arrays)
    joint = np.inf
    for i in range(q.size):
        joint = min(joint, min(q[i] - limits.lower[i], limits.upper[i] - q[i]))
    distance = np.inf
    if plan.scene >= 0:
        base = plan.step.arrays
        jacobian = np.empty((q.size, 6))
        placements = np.empty((base.placements.shape[0], 12))
        write_kinematics(plan.robot, q, jacobian, placements, base.inertia)
        constants = block_constants(base, plan.scene).copy()
        place_obstacles(plan, arm, arm.time - arm.period, constants)
        scene = scene_views(constants)
        distances = np.empty(len(scene.pairs))
        write_distances(constants, placements, distances)
        for k in range(distances.size):
            distance = min(distance, distances[k] - scene.head.least)
    return joint, distance


@compiled
def frame_at(plan: ArmPlan, q: Vector, placement: Vector, jacobian: Matrix) -> None:
    """Write where the frame of a shield's twists is at joint positions, and its Jacobian.

    Args:
        plan: Layout of the step.
        q: Joint positions, (n,).
        placement: `Placement` of the frame, (12,), overwritten.
        jacobian: Its linear over angular rows, (6, n), overwritten.
    """
    base = plan.step.arrays
    twists = np.empty((q.size, TWIST))
    placements = np.empty((base.placements.shape[0], placement.size))
    write_kinematics(plan.robot, q, twists, placements, base.inertia)
    frame = RequestConstants.of(block_constants(base, plan.request)).frame
    copied(placement, placements[frame])
    twist_rows(twists, placements, base.support, frame, jacobian)


@compiled
def torque_of(plan: ArmPlan, memory: Vector) -> float:
    """Compute the `torque_margin` of an arm's last command; inf without limits of torques.

    Of an arm that has not begun it is NaN.
    """
    arm = arm_state(plan, memory)
    if plan.torque < 0 or not arm.has_begun:
        return np.inf if arm.has_begun else np.nan
    motion = motion_of(plan, arm)
    constants = block_constants(plan.step.arrays, plan.torque)
    return torque_margin(constants, motion.q, motion.before, motion.last, arm.period)


@compiled
def stopping_time_of(plan: ArmPlan, memory: Vector) -> float:
    """Compute the time of the stopping motion from an arm's last command [s].

    It is that of the stored motion; where none is stored, joints alone decide how long it takes.
    """
    arm = arm_state(plan, memory)
    motion = motion_of(plan, arm)
    dt = motion.spacing
    periods = motion.stopping_periods
    if periods == 0.0:
        limits = motion_constants(plan.step.arrays)
        periods = least_periods(motion.last, motion.before, limits, dt, False)
    return dt * max(periods, 1.0 if largest_entry(motion.last) > 0.0 else 0.0)
