r"""The paper's scheme: minimum kinetic energy and cyclic motion, blended by one weight.

.. math::

    \min_{\dot q} \; \tfrac12 \bigl(\xi\,\dot q^T G(q)\,\dot q
        + (1-\xi)\,\|\dot q + m\,(q - q_0)\|^2\bigr)

subject to the position rows, the orientation rows and the velocity bounds. Expanded, and without
its constant, that is a quadratic program with

.. math::

    P = \xi\,G(q) + (1-\xi)\,I, \qquad q_{\text{QP}} = (1-\xi)\,m\,(q - q_0).

With G = I, as in the paper, P = I whatever the weight, which then acts through the linear term
alone. Source: equations (6) and (7) of the paper.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import QP, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes.base import VelocityProgram
from iiwa_dnn.schemes.orientation import ORIENTATIONS, Orientation

Kinetic = Literal["identity", "inertia"]
KINETICS: tuple[Kinetic, ...] = ("identity", "inertia")


@dataclass(frozen=True)
class DoubleIndicator:
    """Minimum kinetic energy blended with cyclic motion generation.

    Attributes:
        weight: The paper's xi in [0, 1]; 1 is minimum kinetic energy, 0 cyclic motion.
        drift_gain: The paper's m [1/s], how strongly the posture is drawn back.
        position_gain: The paper's delta [1/s].
        orientation_gain: The paper's nu as a feedback gain [1/s].
        limit_gain: The paper's kappa [1/s], for the bounds near a joint limit.
        orientation: ``"so3"``, ``"block"`` (the paper's) or ``"none"``.
        kinetic: G(q): ``"identity"`` (the paper's) or ``"inertia"``, the joint-space inertia
            matrix, which makes the index twice the true kinetic energy [J].
        home: Posture q_0 to come back to [rad], (n,). None stands for wherever the robot is;
            `simulate` anchors it at the start of the run.
    """

    weight: float = 0.2
    drift_gain: float = 10.2
    position_gain: float = 10.2
    orientation_gain: float = 10.2
    limit_gain: float = 20.0
    orientation: Orientation = "so3"
    kinetic: Kinetic = "identity"
    home: tuple[float, ...] | None = None
    _home: Vector | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check every parameter; raises InvalidInputError naming it."""
        if checks.not_negative("weight", self.weight) > 1.0:
            raise InvalidInputError("weight", f"must be in [0, 1], not {self.weight}", self.weight)
        for name in ("drift_gain", "position_gain", "orientation_gain"):
            checks.not_negative(name, getattr(self, name))
        checks.positive("limit_gain", self.limit_gain)
        checks.one_of("orientation", self.orientation, ORIENTATIONS)
        checks.one_of("kinetic", self.kinetic, KINETICS)
        if self.home is not None:
            home = checks.finite_array("home", self.home, (-1,)).copy()
            object.__setattr__(self, "home", tuple(home.tolist()))
            object.__setattr__(self, "_home", home)

    def anchored(self, conf: Configuration) -> DoubleIndicator:
        """The same scheme with `conf` as home, unless it has a home already."""
        return self if self.home is not None else replace(self, home=tuple(conf.q.tolist()))

    def build_qp(self, conf: Configuration, target: Target) -> QP:
        """The program of this instant; its solution is the joint velocity [rad/s].

        Args:
            conf: Where the robot is, n joints.
            target: Where it should be.

        Returns:
            A QP in n variables with 3 position rows and 3 (so3), 4 (block) or 0 orientation rows.

        Raises:
            InvalidInputError: `home` has another length than the robot has joints.
        """
        return self.program(conf.robot).build(conf, target)

    def program(self, robot: Robot) -> VelocityProgram:
        """What of the program does not change along a run.

        Args:
            robot: The robot, n joints.

        Raises:
            InvalidInputError: `home` has another length than the robot has joints.
        """
        home, drift_gain = self._home, self.drift_gain
        if home is None:  # wherever the robot is: nothing draws it anywhere
            home, drift_gain = np.zeros(robot.dof), 0.0
        elif home.size != robot.dof:
            raise InvalidInputError("home", f"has {home.size} values for {robot.dof} joints")
        weights = [self.weight, drift_gain, self.position_gain, self.orientation_gain]
        return VelocityProgram.of(
            self.orientation,
            [*weights, self.limit_gain],
            robot.limits,
            home,
            self.kinetic == "inertia",
        )

    def kinetic_index(self, conf: Configuration, dq: ArrayLike) -> float:
        """dq^T G(q) dq: [rad^2/s^2] with G = I, [J] (twice the energy) with the inertia."""
        velocity = np.asarray(dq, dtype=np.float64)
        if self.kinetic == "identity":
            return float(velocity @ velocity)
        return float(velocity @ conf.inertia @ velocity)

    def settings(self) -> dict[str, Any]:
        """Name and parameters, as values that JSON can hold."""
        parameters = {field.name: getattr(self, field.name) for field in fields(self) if field.init}
        return {"name": "double-indicator", **parameters}
