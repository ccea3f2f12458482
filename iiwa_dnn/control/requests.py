"""Requests of a shield: their kinds, the tasks that answer them, and the cut of a twist."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.control.controller import EXCEEDED
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import cholesky_factor, factor_solve
from iiwa_dnn.qp.layout import QPViews
from iiwa_dnn.references.rotations import triple
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.schemes import PoseTask, Task
from iiwa_dnn.schemes.limits import MotionConstants
from iiwa_dnn.schemes.step import (
    TARGET_SIZE,
    FrameConstants,
    StepViews,
    point_rate,
    write_spin,
    write_velocity,
)

DAMPING = 0.02
"""Lambda of a twist's program [m/rad]: near a singular pose the joints do not race."""

SIDEWAYS = 10.0
"""Weight of the motion beside a twist: where a twist cannot be had, the frame stays rather than
slides."""

SHORT = 0.02
"""Part of a twist that may be missing where the damping alone keeps it from being fulfilled."""

CUT = 100.0
"""Velocity to which a larger request is cut, in units of the largest one that joints can do."""

FASTEST = 1e4
"""Largest velocity of a joint that has no velocity limit [rad/s], for the cut."""

TWIST = 6
"""Numbers of a twist."""

ARGUMENTS = ("", "dq", "twist", "position")
"""Arguments of a step by the `Request` that they are."""

REASONS = (
    "",
    "no request",
    "request timed out",
    "request not finite",
    "halted",
    "q not finite",
    "resynchronised to measured positions",
    "request cut",
    EXCEEDED,
    "singular posture",
)
"""Words of each `Reason`."""


class Request(IntEnum):
    """Kinds of a request."""

    NONE = 0
    VELOCITY = 1
    TWIST = 2
    POSITION = 3


class Reason(IntEnum):
    """Reasons beside limits for another command than the request: those to rest come first."""

    NONE = 0
    NO_REQUEST = 1
    TIMED_OUT = 2
    NOT_FINITE = 3
    HALTED = 4
    Q_NOT_FINITE = 5
    RESYNCHRONISED = 6
    CUT = 7
    PERIOD_EXCEEDED = 8
    SINGULAR = 9


class JointsConstants(Record):
    """Number of the first joint of a `JointVelocityTask`, from 0."""

    first: int


@compiled
def velocity_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A = I and b = w for some joints; the target (18,) begins with their velocities w."""
    first = JointsConstants.of(constants).first
    for i in range(b.size):
        A[i, first + i] = 1.0
        b[i] = target.numbers[i]


@dataclass(frozen=True)
class JointVelocityTask(Task):
    """Velocities of some joints, a row each, which a step's target holds in place of a pose.

    Attributes:
        frame: The frame whose target it is.
        first: The first of the joints, of which a target holds 18.
    """

    kernel = staticmethod(velocity_rows)
    weight = 1.0
    frame: str
    first: int = 0

    def row_count(self, robot: Robot) -> int:
        """Return the number of the joints."""
        return min(TARGET_SIZE, robot.dof - self.first)

    def constants(self, robot: Robot) -> Vector:
        """Return `JointsConstants`."""
        return JointsConstants.make(first=self.first)


@compiled
def twist_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A = W J and b = W v = v; W leaves v as it is and weighs what is beside it."""
    own = FrameConstants.of(constants[: FrameConstants.width()])
    base = Placement.of(step.placements[own.relative_to])
    point = triple(Placement.of(step.placements[own.frame]).position)
    for i in range(3):
        axis = triple(base.axes[i])
        write_velocity(step, own, point, axis, A[i])
        write_spin(step, own, axis, A[3 + i])
        b[i] = target.linear_velocity[i]
        b[3 + i] = target.angular_velocity[i]
    square = 0.0
    for k in range(b.size):
        square += b[k] * b[k]
    for i in range(A.shape[1]):
        along = 0.0
        for k in range(b.size):
            along += A[k, i] * b[k]
        fraction = (1.0 - SIDEWAYS) * along / square if square > 0.0 else 0.0
        for k in range(b.size):
            A[k, i] = SIDEWAYS * A[k, i] + fraction * b[k]


@dataclass(frozen=True, kw_only=True)
class TwistTask(PoseTask):
    """Linear and angular velocity of a frame, which a step's target holds."""

    kernel = staticmethod(twist_rows)


@compiled
def cut_twist(
    twist: Vector, jacobian: Matrix, placement: Placement, support: Vector, limits: MotionConstants
) -> bool:
    """Cut a twist (6,) in place to `CUT` times what the joints can do.

    Args:
        twist: The twist of a frame.
        jacobian: `Kinematics.jacobian`, (n, 6).
        placement: The frame's.
        support: 1 for the joints that move it, (n,).
        limits: Limits of the joints.

    Returns:
        Whether it was larger.
    """
    n = support.size
    size = 0.0
    for i in range(TWIST):
        size = max(size, abs(twist[i]))
    if size <= CUT:
        return False
    point = triple(placement.position)
    most = 1.0
    for i in range(TWIST):
        total = 0.0
        for j in range(n):
            linear = point_rate(jacobian, j, point)
            angular = triple(Twist.of(jacobian[j]).angular)
            rate = linear[i % 3] if i < 3 else angular[i % 3]
            total += abs(support[j] * rate) * min(limits.velocity[j], FASTEST)
        most = max(most, total)
    if size <= CUT * most:
        return False
    for i in range(TWIST):
        twist[i] *= CUT * most / size
    return True


@compiled
def falls_short(qp: QPViews, target: TargetData) -> bool:
    """Test whether the damping alone keeps a target's twist from being fulfilled by `SHORT` of it.

    |W (J x - v)|^2 at the least of the cost of a twist's program, whose P is (W J)^T W J +
    DAMPING^2 I.
    """
    n = qp.q.size
    K = qp.P.copy()
    x = np.zeros(n)
    if cholesky_factor(K):
        factor_solve(K, qp.q, x)
    square = 0.0
    for i in range(target.linear_velocity.size):
        square += target.linear_velocity[i] * target.linear_velocity[i]
    for i in range(target.angular_velocity.size):
        square += target.angular_velocity[i] * target.angular_velocity[i]
    missing = square
    for i in range(n):
        missing -= x[i] * (qp.q[i] + DAMPING * DAMPING * x[i])
    return missing > SHORT * SHORT * square
