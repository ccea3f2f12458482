"""Position and velocity limits of the joints, position-dependent velocity limits among them."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.step import StepViews


class PositionConstants(Record):
    """Constants of `JointLimits` for n joints, as its kernel reads them.

    Attributes:
        gain: kappa [1/s].
        lower: Lower position limits [rad], (n,).
        upper: Upper position limits [rad], (n,).
        velocity: Velocity limits [rad/s], (n,).
        offset: Offsets o of the position-dependent velocity limits [rad/s], (n,).
        slope: Decelerations D of these limits [rad/s^2], (n,); inf for a joint without one.
    """

    gain: float
    lower: Vector = part()
    upper: Vector = part()
    velocity: Vector = part()
    offset: Vector = part()
    slope: Vector = part()


@compiled
def joint_limits(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds lb and ub (n,) [rad/s] to those of `JointLimits`.

    `constants` are a `PositionConstants`. Writes lb, ub, step.lower_kind and step.upper_kind; G and
    h have no rows.
    """
    dof = step.q.size
    limits = PositionConstants.of(constants)
    gain = min(limits.gain, step.rate)
    for i in range(dof):
        above = limits.upper[i] - step.q[i]
        below = step.q[i] - limits.lower[i]
        fastest = limits.velocity[i]
        up = min(fastest, position_dependent_speed(above, limits.offset[i], limits.slope[i]))
        down = min(fastest, position_dependent_speed(below, limits.offset[i], limits.slope[i]))
        lower = min(max(-gain * below, -down), up)
        upper = min(max(gain * above, -down), up)
        step.lower_kind[i] = _speed_kind(-lower, down, fastest)
        step.upper_kind[i] = _speed_kind(upper, up, fastest)
        lb[i] = max(lb[i], lower)
        ub[i] = min(ub[i], upper)


@compiled
def _speed_kind(bound: float, speed: float, fastest: float) -> int:
    """Tell which limit sets a joint's bound towards one side, its `LimitKind`.

    Args:
        bound: The bound [rad/s], positive towards that side: ub, or -lb.
        speed: Velocity limit towards that side at the joint's position [rad/s].
        fastest: Velocity limit far from the position limits [rad/s].
    """
    if bound < speed:
        return LimitKind.POSITION
    return LimitKind.POSITION_DEPENDENT_VELOCITY if speed < fastest else LimitKind.VELOCITY


@compiled
def position_dependent_speed(distance: float, offset: float, deceleration: float) -> float:
    """Compute a joint's velocity limit [rad/s] at a distance from its position limit.

    Args:
        distance: The distance d [rad].
        offset: Offset o [rad/s].
        deceleration: Deceleration D [rad/s^2]; inf for a joint without such a limit.

    Returns:
        sqrt(2 D d) - o, at least 0; inf for a joint without such a limit.
    """
    if not deceleration < np.inf:
        return np.inf
    return max(math.sqrt(2.0 * deceleration * max(distance, 0.0)) - offset, 0.0)


@dataclass(frozen=True, kw_only=True)
class JointLimits(Limit):
    r"""Joint velocity bounds that keep the joint positions inside their limits.

    .. math::

        lb = \max(-\dot q_{max},\; \kappa\,(q_{lower} - q)), \qquad
        ub = \min(\dot q_{max},\; \kappa\,(q_{upper} - q))

    A joint may approach its limit no faster than exponentially with rate :math:`\kappa`, so in
    steps of dt it never passes it as long as :math:`\kappa\,dt \le 1`; a larger :math:`\kappa` is
    cut to 1 / dt. Outside a limit the formula can ask for more than the velocity limit allows and
    then has lb > ub: both bounds are clipped to the velocity limit, so that the arm comes back as
    fast as it may. Where the robot has such limits (`Robot.position_dependent_velocity`), as a
    Franka arm has, its velocity limit shrinks to :math:`\sqrt{2 D d} - o` at a distance d from the
    position limit.

    Source: equation (6) of the paper; the position-dependent limits are
    `getUpperJointVelocityLimits` in src/joint_velocity_limits.cpp of libfranka.

    Attributes:
        gain: The paper's kappa [1/s], above 0.
    """

    kernel = staticmethod(joint_limits)
    rows_suffice = True
    _checks: ClassVar[checks.Checks] = {"gain": checks.positive}
    gain: float = 20.0

    def constants(self, robot: Robot) -> Vector:
        """Return the `PositionConstants` of a robot."""
        lower, upper, velocity = robot.limits[:3]
        offset, slope = robot.position_dependent_velocity
        return PositionConstants.make(
            gain=self.gain,
            lower=lower,
            upper=upper,
            velocity=velocity,
            offset=offset,
            slope=slope,
        )
