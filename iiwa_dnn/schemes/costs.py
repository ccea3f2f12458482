r"""Costs: terms of the objective that a scheme minimises, each with a weight w."""

from dataclasses import dataclass, replace
from functools import partial
from typing import ClassVar, Literal, get_args

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.parts import Cost
from iiwa_dnn.schemes.step import Step, StepViews

Kinetic = Literal["identity", "inertia"]


@dataclass(frozen=True, kw_only=True)
class WeightedCost(Cost):
    """Base of costs with one weight.

    Attributes:
        weight: w, at least 0.
    """

    _checks: ClassVar[checks.Checks] = {"weight": checks.not_negative}
    weight: float = 1.0


class KineticConstants(Record):
    """Constants of `KineticEnergy`: its weight, and whether G is the inertia matrix."""

    weight: float
    is_inertia: bool


@compiled
def add_kinetic_energy(step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Add w G(q) to P (n, n), for `KineticEnergy`. Writes P; q stays."""
    own = KineticConstants.of(constants)
    for i in range(step.q.size):
        if own.is_inertia:
            for j in range(step.q.size):
                P[i, j] += own.weight * step.inertia[i, j]
        else:
            P[i, i] += own.weight


@dataclass(frozen=True, kw_only=True)
class KineticEnergy(WeightedCost):
    r"""Cost of the kinetic energy (MKE, minimum kinetic energy).

    .. math::  \tfrac12 w\,\dot q^T G(q)\,\dot q, \qquad P \mathrel{+}= w\,G(q)

    Source: equation (6) of the paper.

    Attributes:
        weight: w, at least 0.
        kinetic: G(q): ``"identity"`` (the paper's) or ``"inertia"``, the joint-space inertia
            matrix, which makes the cost w times the true kinetic energy [J].
    """

    kernel = staticmethod(add_kinetic_energy)
    _checks: ClassVar[checks.Checks] = {
        "kinetic": partial(checks.one_of, choices=get_args(Kinetic))
    }
    kinetic: Kinetic = "identity"

    def constants(self, robot: Robot) -> Vector:
        """Return `KineticConstants`."""
        return KineticConstants.make(weight=self.weight, is_inertia=self.kinetic == "inertia")


class CyclicConstants(Record):
    """Constants of `CyclicMotion`: its weight, gain m [1/s] and home [rad], (n,)."""

    weight: float
    gain: float
    home: Vector = part()


@compiled
def add_cyclic_motion(step: StepViews, constants: Vector, P: Matrix, q: Vector) -> None:
    """Add w I to P (n, n) and w m (q - home) to q (n,), for `CyclicMotion`. Writes P and q."""
    own = CyclicConstants.of(constants)
    for i in range(step.q.size):
        P[i, i] += own.weight
        q[i] += own.weight * own.gain * (step.q[i] - own.home[i])


@dataclass(frozen=True, kw_only=True)
class CyclicMotion(WeightedCost):
    r"""Cost that draws the posture back to a home posture (CMG, cyclic motion generation).

    .. math::  \tfrac12 w\,\|\dot q + m\,(q - q_0)\|^2, \qquad
        P \mathrel{+}= w I, \quad q_{\text{QP}} \mathrel{+}= w\,m\,(q - q_0)

    Source: equation (6) of the paper.

    Attributes:
        weight: w, at least 0.
        gain: The paper's m [1/s], at least 0.
        home: Posture q_0 [rad], (n,). None: in `Scheme.build_qp` the posture of its argument, in
            `simulate` and `Controller` the one in which they begin.
    """

    kernel = staticmethod(add_cyclic_motion)
    _checks: ClassVar[checks.Checks] = {
        "gain": checks.not_negative,
        "home": lambda name, home: tuple(checks.finite_array(name, home, (-1,)).tolist()),
    }
    gain: float = 10.2
    home: tuple[float, ...] | None = None

    def anchored(self, conf: Configuration) -> "CyclicMotion":
        """Return the cost with the posture `conf` as `home`, or the cost itself if it has one."""
        return self if self.home is not None else replace(self, home=tuple(conf.q.tolist()))

    def constants(self, robot: Robot) -> Vector:
        """Return `CyclicConstants`.

        Raises:
            InvalidInputError: `home` has another length than the robot has joints.
        """
        home = (0.0,) * robot.dof if self.home is None else self.home
        if len(home) != robot.dof:
            raise InvalidInputError("home", f"has {len(home)} values for {robot.dof} joints")
        return CyclicConstants.make(weight=self.weight, gain=self.gain, home=home)


@dataclass(frozen=True, kw_only=True)
class Manipulability(WeightedCost):
    r"""Cost of the loss of manipulability: it moves the arm away from singular postures.

    .. math::  -w\,\nabla \mu(q)^T \dot q, \qquad \mu = \sqrt{\det J J^T}, \qquad
        \partial_i \mu = \mu\,\mathrm{tr}\bigl((J J^T)^{-1} \,\partial_i J\, J^T\bigr)

    for the Jacobian J of a frame at the end of a serial chain, whose derivative has a closed form.
    The term is linear, so that another cost has to bound the velocity.

    Source: T. Yoshikawa, "Manipulability of robotic mechanisms", Int. J. Robotics Research 4
    (1985).

    Attributes:
        weight: w, at least 0.
        frame: Name of the frame; None stands for the robot's tip.
    """

    frame: str | None = None

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n), zero, and q (n,)."""
        J = step.frame(self.frame).jacobian
        n = J.shape[1]
        gram = J @ J.T
        measure = np.sqrt(max(np.linalg.det(gram), 0.0))
        if measure == 0.0:
            return np.zeros((n, n)), np.zeros(n)
        linear = J[:3].T
        angular = J[3:].T
        # About a fixed point, which the measure does not depend on, a joint i moves the axis of
        # each joint j after it, and no other: d column j / d q_i, (i, j, row).
        turned = np.cross(angular[:, np.newaxis], linear) + np.cross(linear[:, np.newaxis], angular)
        change = np.concatenate([turned, np.cross(angular[:, np.newaxis], angular)], axis=2)
        moved = np.einsum("ijr,rj->ij", change, np.linalg.solve(gram, J))
        return np.zeros((n, n)), -self.weight * measure * np.triu(moved).sum(axis=1)
