r"""Schemes of the literature with the largest joint speed in the cost, by a slack variable.

They hold the tip's position and orientation and keep the joint limits.
"""

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.base import Scheme
from iiwa_dnn.schemes.costs import KineticEnergy, WeightedCost
from iiwa_dnn.schemes.limits import JointLimits
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.step import Step
from iiwa_dnn.schemes.tasks import OrientationTask, PositionTask

SMALLEST = 1e-3
"""Weight of the squared velocity norm beside the largest speed, which alone leaves joints free."""


class LargestSpeed(WeightedCost):
    r"""Square of the largest joint speed, the scheme's last (slack) variable s: w s^2 / 2."""

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n + 1, n + 1) and q (n + 1,) of a scheme with one slack variable."""
        P = np.zeros((step.q.size + 1, step.q.size + 1))
        P[-1, -1] = self.weight
        return P, np.zeros(len(P))


class SpeedsBelowSlack(Limit):
    r"""Rows :math:`\pm \dot q_i - s \le 0` for the last (slack) variable s of an arm's scheme."""

    def __init__(self, robot: Robot) -> None:
        """State the rows for a robot with n joints: 2 n."""
        self.rows = 2 * robot.dof
        eye = np.eye(robot.dof)
        self._G = np.hstack([np.vstack([eye, -eye]), -np.ones((self.rows, 1))])

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (2 n, n + 1) and h (2 n,)."""
        return self._G, np.zeros(self.rows)


def infinity_norm(robot: Robot, gain: float = 10.2) -> Scheme:
    """Compose the scheme of least largest joint speed, by a slack variable.

    Source: Y. Zhang, J. Wang, Y. Xu, "A dual neural network for bi-criteria kinematic control of
    redundant manipulators", IEEE Trans. Robotics and Automation 18 (2002).
    """
    return bi_criteria(robot, 0.0, gain)


def bi_criteria(robot: Robot, weight: float = 0.5, gain: float = 10.2) -> Scheme:
    """Compose the scheme between least velocity norm (weight 1) and least largest speed (0).

    Source: as `infinity_norm`.

    Raises:
        InvalidInputError: The weight is not in [0, 1].
    """
    if checks.not_negative("weight", weight) > 1.0:
        raise InvalidInputError("weight", f"must be in [0, 1], not {weight}", weight)
    costs = [KineticEnergy(weight=max(weight, SMALLEST)), LargestSpeed(weight=1.0 - weight)]
    tasks = [PositionTask(gain=gain), OrientationTask(gain=gain)]
    return Scheme(costs, tasks, [JointLimits(), SpeedsBelowSlack(robot)], slack=1)
