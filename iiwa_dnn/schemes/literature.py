r"""Schemes of the literature beside the paper's, each composed of parts.

All hold the tip's position and orientation and keep the joint limits; they differ in the cost.
"""

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.base import Scheme
from iiwa_dnn.schemes.costs import (
    CyclicMotion,
    JointAcceleration,
    JointTorque,
    KineticEnergy,
    WeightedCost,
)
from iiwa_dnn.schemes.limits import JointLimits
from iiwa_dnn.schemes.parts import Limit, Task
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


def minimum_velocity_norm(gain: float = 10.2) -> Scheme:
    """Compose the scheme of least joint velocity norm.

    Source: D. E. Whitney, "Resolved motion rate control of manipulators and human prostheses", IEEE
    Trans. Man-Machine Systems 10 (1969).
    """
    return Scheme([KineticEnergy()], _tasks(gain), [JointLimits()])


def repetitive_motion(gain: float = 10.2, drift_gain: float = 10.2) -> Scheme:
    """Compose the scheme that comes back to its first posture after each lap.

    Source: Y. Zhang et al., "Repetitive motion planning of PA10 robot arm subject to joint physical
    limits and using LVI-based primal-dual neural network", Mechatronics 18 (2008).
    """
    return Scheme([CyclicMotion(gain=drift_gain)], _tasks(gain), [JointLimits()])


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
    return Scheme(costs, _tasks(gain), [JointLimits(), SpeedsBelowSlack(robot)], slack=1)


def minimum_acceleration_norm(gain: float = 10.2, damping: float = 1e-3) -> Scheme:
    """Compose the scheme of least change of velocity, damped so that no motion goes on for ever.

    Source: that of `JointAcceleration`.
    """
    costs = [JointAcceleration(), KineticEnergy(weight=damping)]
    return Scheme(costs, _tasks(gain), [JointLimits()])


def minimum_torque(gain: float = 10.2, weight: float = 10.0, damping: float = 5.0) -> Scheme:
    """Compose the scheme of least joint torque norm.

    Source: that of `JointAcceleration`, of which one with a weight [(N m s^2)^2] and a damping
    [1/s] keeps the joints from racing.
    """
    costs = [JointTorque(), JointAcceleration(weight=weight, damping=damping)]
    return Scheme(costs, _tasks(gain), [JointLimits()])


def _tasks(gain: float) -> list[Task]:
    return [PositionTask(gain=gain), OrientationTask(gain=gain)]
