r"""The schemes of the atlas, and the parts that only they use.

Sources: Y. Zhang, J. Wang, Y. Xia, "A dual neural network for redundancy resolution of
kinematically redundant manipulators subject to joint limits and joint velocity limits", IEEE
Transactions on Neural Networks 14 (2003); Y. Zhang, J. Wang, Y. Xu, "A dual neural network for
bi-criteria kinematic control of redundant manipulators", IEEE Transactions on Robotics and
Automation 18 (2002) (the largest velocity); T. Yoshikawa, "Manipulability of robotic mechanisms",
International Journal of Robotics Research 4 (1985).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.schemes import (
    Cost,
    CyclicMotion,
    DoubleIndicator,
    JointLimits,
    KineticEnergy,
    Limit,
    OrientationTask,
    PositionTask,
    PseudoInverse,
    Scheme,
    Step,
)
from iiwa_dnn.studies.paper import START


@dataclass(frozen=True)
class PeakVelocity(Limit):
    r"""Rows that make the last variable s the largest joint velocity: :math:`\pm\dot q_i \le s`."""

    joints: int = 7
    rows: int = field(default=14, init=False)

    def inequalities(self, step: Step) -> tuple[Matrix, Vector]:
        """Return G (2 joints, n) and h (2 joints,)."""
        eye = np.eye(self.joints)
        G = np.hstack([np.vstack([eye, -eye]), -np.ones((2 * self.joints, 1))])
        return G, np.zeros(2 * self.joints)


@dataclass(frozen=True)
class PeakCost(Cost):
    r"""The cost :math:`\tfrac12 s^2` of the last variable."""

    joints: int = 7

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n) and q (n,)."""
        P = np.zeros((self.joints + 1, self.joints + 1))
        P[-1, -1] = 1.0
        return P, np.zeros(self.joints + 1)


@dataclass(frozen=True)
class Manipulability(Cost):
    r"""The cost :math:`\tfrac12\|\dot q - k\,\nabla\sqrt{\det J J^T}\|^2`, J the rows of position.

    Attributes:
        gain: k, in rad/s for a gradient of 1 m^3/rad.
    """

    gain: float = 2.0

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n) and q (n,)."""
        gradient = manipulability_gradient(step.frame().jacobian)
        return np.eye(gradient.size), -self.gain * gradient


def manipulability_gradient(jacobian: Matrix) -> Vector:
    """Compute the gradient (n,) of the manipulability of revolute joints from their J (6, n)."""
    linear, angular = jacobian[:3], jacobian[3:]
    gram = linear @ linear.T
    n, inverse = linear.shape[1], np.linalg.pinv(gram)
    first, last = np.minimum.outer(range(n), range(n)), np.maximum.outer(range(n), range(n))
    # Column j of J changes with joint i by the turn of the earlier joint of the two.
    change = np.cross(angular.T[first], linear.T[last])  # (i, j, 3)
    slope = np.einsum("ijk,kl,lj->i", change, inverse, linear)
    gradient: Vector = np.sqrt(max(float(np.linalg.det(gram)), 0.0)) * slope
    return gradient


def _tracking(*costs: Cost, slack: int = 0, rows: tuple[Limit, ...] = ()) -> Scheme:
    return Scheme(costs, [PositionTask(), OrientationTask()], [JointLimits(), *rows], slack)


SCHEMES: dict[str, Callable[[], Scheme]] = {
    "double indicator": lambda: DoubleIndicator(home=START),
    "double indicator, block rows": lambda: DoubleIndicator(orientation="block", home=START),
    "double indicator, position only": lambda: DoubleIndicator(orientation="none", home=START),
    "minimum velocity": lambda: _tracking(KineticEnergy()),
    "minimum kinetic energy": lambda: _tracking(KineticEnergy(kinetic="inertia")),
    "cyclic motion": lambda: _tracking(CyclicMotion(home=START)),
    "infinity norm": lambda: _tracking(
        KineticEnergy(0.01), PeakCost(), slack=1, rows=(PeakVelocity(),)
    ),
    "bi-criteria": lambda: _tracking(
        KineticEnergy(0.5), PeakCost(), slack=1, rows=(PeakVelocity(),)
    ),
    "manipulability": lambda: _tracking(Manipulability()),
    "soft rotation": lambda: Scheme(
        [KineticEnergy(0.01)], [PositionTask(), OrientationTask(weight=1.0)], [JointLimits()]
    ),
    "pseudo-inverse": PseudoInverse,
}
"""Schemes by name; the first is the default."""
