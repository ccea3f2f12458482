"""Limits: bounds and inequality rows that no policy ever relaxes."""

from dataclasses import dataclass, field

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Limit

JOINT_LIMITS = 20


@dataclass(frozen=True)
class JointLimits(Limit):
    r"""Joint velocity bounds that keep the joint positions inside their limits.

    .. math::

        lb = \max(-\dot q_{max},\; \kappa\,(q_{lower} - q)), \qquad
        ub = \min(\dot q_{max},\; \kappa\,(q_{upper} - q))

    A joint may approach its limit no faster than exponentially with rate :math:`\kappa`, so in
    steps of dt it never passes it as long as :math:`\kappa\,dt \le 1`; a larger :math:`\kappa` is
    cut to 1 / dt. Outside a limit the formula can ask for more than the velocity limit allows and
    then has lb > ub: both bounds are clipped to the velocity limit, so that the arm comes back as
    fast as it may.

    Source: equation (6) of the paper.

    Attributes:
        gain: The paper's kappa [1/s], above 0.
    """

    gain: float = 20.0
    kind: int = field(default=JOINT_LIMITS, init=False, repr=False)

    def __post_init__(self) -> None:
        checks.positive("limit_gain", self.gain)

    def numbers(self, robot: Robot) -> Vector:
        """Return the gain and the rows of `Robot.limits`, (1 + 3 n,)."""
        return np.concatenate([[self.gain], robot.limits.ravel()])


@compiled
def joint_limits(
    data: Vector, at_lb: int, n: int, dof: int, numbers: Vector, at: int, q: Vector, rate: float
) -> None:
    """Intersect the bounds with those of joint positions q (dof,); `rate` is 1 / dt [1/s]."""
    gain = min(numbers[at], rate)
    for i in range(dof):
        lower, upper = numbers[at + 1 + i], numbers[at + 1 + dof + i]
        fastest = numbers[at + 1 + 2 * dof + i]
        lb, ub = at_lb + i, at_lb + n + i
        data[lb] = max(data[lb], min(max(gain * (lower - q[i]), -fastest), fastest))
        data[ub] = min(data[ub], min(max(gain * (upper - q[i]), -fastest), fastest))
