"""Limits: bounds and inequality rows that no policy ever relaxes."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Checks, Limit
from iiwa_dnn.schemes.step import StepViews


@compiled
def joint_limits(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds to those of `JointLimits`, whose constants these are."""
    dof = step.q.size
    gain = min(constants[0], step.rate)
    limits = constants[1:].reshape(5, dof)
    for i in range(dof):
        above = limits[1, i] - step.q[i]
        below = step.q[i] - limits[0, i]
        fastest = limits[2, i]
        up = min(fastest, ramp_speed(above, limits[3, i], limits[4, i]))
        down = min(fastest, ramp_speed(below, limits[3, i], limits[4, i]))
        lb[i] = max(lb[i], min(max(-gain * below, -down), up))
        ub[i] = min(ub[i], min(max(gain * above, -down), up))


@compiled
def ramp_speed(distance: float, offset: float, deceleration: float) -> float:
    """Compute the speed that a ramp allows at a distance from a position limit [rad/s].

    Args:
        distance: The distance [rad].
        offset: Offset of the ramp [rad/s].
        deceleration: Deceleration along the ramp [rad/s^2]; inf for a joint without one.
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
    fast as it may. Where the robot has ramps (`Robot.ramps`), as a Franka arm has, its velocity
    limit shrinks to :math:`\sqrt{2 D d} - o` at a distance d from the position limit.

    Source: equation (6) of the paper; the ramps are `getUpperJointVelocityLimits` in
    src/joint_velocity_limits.cpp of libfranka.

    Attributes:
        gain: The paper's kappa [1/s], above 0.
    """

    kernel = staticmethod(joint_limits)
    _checks: ClassVar[Checks] = {"gain": checks.positive}
    gain: float = 20.0

    def constants(self, robot: Robot) -> Vector:
        """Return the gain and the first rows of `Robot.limits`, and `Robot.ramps`, (1 + 5 n,)."""
        return np.concatenate([[self.gain], robot.limits[:3].ravel(), robot.ramps.ravel()])
