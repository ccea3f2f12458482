r"""The baseline that the paper argues against: the pseudo-inverse of the task's rows.

.. math::  \dot q = A^{+} b = \arg\min \tfrac12 \|\dot q\|^2 \quad \text{s.t.} \quad A \dot q = b

It knows no limits and does not draw the posture back, so it drifts on closed paths.

Source: D. E. Whitney, "Resolved motion rate control of manipulators and human prostheses", IEEE
Transactions on Man-Machine Systems 10 (1969).
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.qp.program import QP, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes.base import VelocityProgram
from iiwa_dnn.schemes.orientation import ORIENTATIONS, Orientation

RANK_TOLERANCE = 1e-10
"""Singular values below this share of the largest count as zero: the block's rows are dependent."""


@dataclass(frozen=True)
class PseudoInverse:
    """Least joint velocity that fulfils the task, without limits.

    Attributes:
        position_gain: Feedback gain [1/s].
        orientation_gain: Feedback gain [1/s].
        orientation: ``"so3"``, ``"block"`` or ``"none"``.
    """

    position_gain: float = 10.2
    orientation_gain: float = 10.2
    orientation: Orientation = "so3"

    def __post_init__(self) -> None:
        """Check every parameter; raises InvalidInputError naming it."""
        checks.not_negative("position_gain", self.position_gain)
        checks.not_negative("orientation_gain", self.orientation_gain)
        checks.one_of("orientation", self.orientation, ORIENTATIONS)

    @property
    def limit_gain(self) -> None:
        """None: it knows no limits."""
        return None

    def anchored(self, conf: Configuration) -> PseudoInverse:
        """The scheme itself: it has no posture to come back to."""
        return self

    def build_qp(self, conf: Configuration, target: Target) -> QP:
        """The least-norm problem as a QP in n variables, without bounds."""
        return self.program(conf.robot).build(conf, target)

    def program(self, robot: Robot) -> VelocityProgram:
        """What of the program does not change along a run; the limits are infinite."""
        n = robot.dof
        limits = np.stack([np.full(n, -np.inf), np.full(n, np.inf), np.full(n, np.inf)])
        weights = [1.0, 0.0, self.position_gain, self.orientation_gain, 1.0]
        return VelocityProgram.of(self.orientation, weights, limits, np.zeros(n))

    def velocity(self, conf: Configuration, target: Target) -> Vector:
        """The closed form A^+ b [rad/s], (n,), through numpy's singular value decomposition."""
        qp = self.build_qp(conf, target)
        velocity: Vector = np.linalg.pinv(qp.A, rcond=RANK_TOLERANCE) @ qp.b
        return velocity

    def kinetic_index(self, conf: Configuration, dq: ArrayLike) -> float:
        """The squared norm [rad^2/s^2] of a joint velocity (n,) [rad/s]."""
        velocity = np.asarray(dq, dtype=np.float64)
        return float(velocity @ velocity)

    def settings(self) -> dict[str, Any]:
        """Name and parameters, as values that JSON can hold."""
        return {"name": "pseudo-inverse", **asdict(self)}
