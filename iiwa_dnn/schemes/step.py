"""One instant of a control loop, as the parts of a scheme read it: from Python, and in kernels."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3, read_only
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.errors import NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.references.rotations import combined, cross, dot, scaled, triple
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.configuration import FrameState
from iiwa_dnn.robot.kinematics import Kinematics, Placement, Twist

TARGET_SIZE = 18
"""Length of `Target.data`."""


class StepViews(NamedTuple):
    """One instant of a control loop of n joints, as the kernels of parts read it.

    The kernels of limits write `least`, `lower_kind`, `upper_kind` and `row_pair`; all else is read
    only.

    Attributes:
        t: Time [s].
        rate: Inverse of the control period [1/s]; inf outside of a loop.
        q: Joint positions [rad], (n,).
        last: Last command [rad/s], (n,).
        before: Command before the last one [rad/s], (n,).
        jacobian: Joint Jacobian, `Kinematics.jacobian`, (n, 6).
        placements: Frame placements by frame index, `Kinematics.placements`, (frames, 12).
        support: 1 where a joint moves a frame, else 0, `Robot.support`, (frames, n).
        inertia: Joint-space inertia matrix [kg m^2], (n, n), current if a cost needs it.
        targets: Targets of the tracked frames, `Target.data` each, (k, 18).
        least: Distance that each watched pair has to keep [m], (pairs,), updated by
            `CollisionAvoidance` (`collisions.kept_distance`).
        lower_kind: `LimitKind` of each joint's lower bound, (n,). Where a kernel tightens a bound
            and writes no kind, the bound goes by the name of its limit.
        upper_kind: The same for the upper bounds, (n,).
        row_pair: Number from 1 of the watched pair that each inequality row belongs to, where that
            changes from step to step, else 0, (m,).
        velocity_limits: Velocity limits of the joints [rad/s], (n,).
        acceleration_limits: Their acceleration limits [rad/s^2], (n,); inf for none.
    """

    t: float
    rate: float
    q: Vector
    last: Vector
    before: Vector
    jacobian: Matrix
    placements: Matrix
    support: Matrix
    inertia: Matrix
    targets: Matrix
    least: Vector
    lower_kind: Vector
    upper_kind: Vector
    row_pair: Vector
    velocity_limits: Vector
    acceleration_limits: Vector


class Step:
    """One instant of a control loop, as parts written in numpy read it.

    Attributes:
        robot: The robot, n joints.
        t: Time [s].
        dt: Control period [s]; inf outside of a loop.
        q: Joint positions [rad], (n,).
        dq: Last command [rad/s], (n,).
    """

    __slots__ = ("_kinematics", "_targets", "dq", "dt", "q", "robot", "t")

    def __init__(
        self,
        robot: Robot,
        q: ArrayLike,
        targets: Target | Mapping[str, Target] | None = None,
        dt: float = np.inf,
        t: float = 0.0,
        dq: ArrayLike | None = None,
        kinematics: Kinematics | None = None,
    ) -> None:
        """Make the instant, for example to test a part of one's own.

        Args:
            robot: The robot, n joints.
            q: Joint positions [rad], (n,).
            targets: Target of the tip, or targets by frame name.
            dt: Control period [s]; inf outside of a loop.
            t: Time [s].
            dq: Last command [rad/s], (n,); None: zero.
            kinematics: Kinematics of the robot, computed at `q`; None: they are computed here.

        Raises:
            InvalidInputError: `q` or `dq` has a wrong shape or is not finite.
        """
        shape = (robot.dof,)
        self.robot = robot
        self.t = t
        self.dt = dt
        self.q = checks.joint_positions("q", q, shape[0])
        self.dq = checks.finite_array("dq", np.zeros(shape) if dq is None else dq, shape)
        self._targets = {robot.tip: targets} if isinstance(targets, Target) else targets or {}
        if kinematics is None:
            kinematics = Kinematics(robot, robot.frame_names)
            kinematics.update(self.q)
        self._kinematics = kinematics

    def frame(self, name: str | None = None) -> FrameState:
        """Return pose and Jacobian of a frame of the robot; None stands for the tip.

        Raises:
            NotFoundError: The robot has no frame of that name.
        """
        return FrameState(*self._kinematics.frame(self.robot.tip if name is None else name))

    def target(self, name: str | None = None) -> Target:
        """Return the target of a frame; None stands for the tip.

        Raises:
            NotFoundError: There is no target of that frame, as no task tracks it.
        """
        frame = self.robot.tip if name is None else name
        if frame not in self._targets:
            raise NotFoundError("target of frame", frame, self._targets)
        return self._targets[frame]

    @property
    def inertia(self) -> Matrix:
        """Joint-space inertia matrix [kg m^2], (n, n)."""
        return read_only(np.array(Configuration(self.robot, self.q).inertia))


class FrameConstants(Record):
    """First constants of each task of a frame.

    Attributes:
        frame: Index of the frame.
        gain: Rate at which the error decays [1/s].
        relative_to: Index of the base frame, relative to which the frame moves; 0: the world.
    """

    frame: int
    gain: float
    relative_to: int


@compiled
def axis_at(placement: Placement, axis: Vector3) -> Vector3:
    """Rotate a vector (3,) from the coordinates of a placed frame into the world's."""
    x = scaled(axis[0], triple(placement.axes[0]))
    y = triple(placement.axes[1])
    return combined(1.0, x, 1.0, combined(axis[1], y, axis[2], triple(placement.axes[2])))


@compiled
def seen_from(placement: Placement, v: Vector3) -> Vector3:
    """Rotate a vector (3,) from the world's coordinates into those of a placed frame."""
    x = dot(triple(placement.axes[0]), v)
    y = dot(triple(placement.axes[1]), v)
    return x, y, dot(triple(placement.axes[2]), v)


@compiled
def point_rate(jacobian: Matrix, j: int, point: Vector3) -> Vector3:
    """Compute the velocity (3,) of a point p (3,) [m] for each unit of velocity of joint j [m/rad].

    It is v + w x p, with the joint's twist: v of the world's origin, and w.
    """
    twist = Twist.of(jacobian[j])
    return combined(1.0, triple(twist.linear), 1.0, cross(triple(twist.angular), point))


@compiled
def rate_along(jacobian: Matrix, j: int, point: Vector3, normal: Vector3) -> float:
    """Compute the velocity of a point (3,) [m] along a normal (3,) for joint j alone [m/rad]."""
    return dot(normal, point_rate(jacobian, j, point))


@compiled
def write_velocity(
    step: StepViews, own: FrameConstants, point: Vector3, axis: Vector3, row: Vector
) -> None:
    """Write the Jacobian row (n,) of a point's velocity along an axis, relative to the base frame.

    Args:
        step: The instant.
        own: Frame that carries the point, and its base frame.
        point: The point in the world [m], (3,).
        axis: The axis in the world, (3,).
        row: The row, (n,), or longer, overwritten.
    """
    for j in range(step.q.size):
        sign = step.support[own.frame, j] - step.support[own.relative_to, j]
        row[j] = sign * rate_along(step.jacobian, j, point, axis)


@compiled
def write_spin(step: StepViews, own: FrameConstants, axis: Vector3, row: Vector) -> None:
    """Write the Jacobian row (n,) of a frame's rate about an axis (3,), relative to its base frame.

    Writes row, of which only the first n numbers if it is longer.
    """
    for j in range(step.q.size):
        sign = step.support[own.frame, j] - step.support[own.relative_to, j]
        row[j] = sign * dot(axis, triple(Twist.of(step.jacobian[j]).angular))
