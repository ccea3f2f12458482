"""Limits: bounds and inequality rows that no policy ever relaxes."""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.step import StepViews


@compiled
def joint_limits(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds to those of `JointLimits`, whose constants these are."""
    dof = step.q.size
    gain = min(constants[0], step.rate)
    for i in range(dof):
        lower = constants[1 + i]
        upper = constants[1 + dof + i]
        fastest = constants[1 + 2 * dof + i]
        lb[i] = max(lb[i], min(max(gain * (lower - step.q[i]), -fastest), fastest))
        ub[i] = min(ub[i], min(max(gain * (upper - step.q[i]), -fastest), fastest))


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
    fast as it may.

    Source: equation (6) of the paper.

    Attributes:
        gain: The paper's kappa [1/s], above 0.
    """

    kernel = staticmethod(joint_limits)
    gain: float = 20.0

    def __post_init__(self) -> None:
        checks.positive("gain", self.gain)

    def constants(self, robot: Robot) -> Vector:
        """Return the gain and the rows of `Robot.limits`, (1 + 3 n,)."""
        return np.concatenate([[self.gain], robot.limits.ravel()])
