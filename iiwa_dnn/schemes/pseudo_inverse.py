r"""The baseline that the paper argues against: the pseudo-inverse of the task's rows.

.. math::  \dot q = A^{+} b = \arg\min \tfrac12 \|\dot q\|^2 \quad \text{s.t.} \quad A \dot q = b

It knows no limits and does not draw the posture back, so it drifts on closed paths.

Source: D. E. Whitney, "Resolved motion rate control of manipulators and human prostheses", IEEE
Transactions on Man-Machine Systems 10 (1969).
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp import Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes.base import Scheme
from iiwa_dnn.schemes.costs import KineticEnergy
from iiwa_dnn.schemes.double_indicator import tip_tasks
from iiwa_dnn.schemes.parts import Tracking
from iiwa_dnn.schemes.tasks import ORIENTATIONS, Orientation

RANK_TOLERANCE = 1e-10
"""Singular values below this share of the largest count as zero: the block's rows are dependent."""


@dataclass(frozen=True)
class PseudoInverse(Scheme):
    """Least joint velocity that fulfils the task, without limits.

    Attributes:
        position_gain: Feedback gain [1/s].
        orientation_gain: Feedback gain [1/s].
        orientation: ``"so3"``, ``"block"`` or ``"none"``.
        tracking: ``"paper"``, or ``"next"``: rows towards the next target.
        next_gain: Gain of ``"next"`` [1/s]; None stands for 1 / dt.
    """

    position_gain: float = 10.2
    orientation_gain: float = 10.2
    orientation: Orientation = "so3"
    tracking: Tracking = "paper"
    next_gain: float | None = None

    def __post_init__(self) -> None:
        checks.one_of("orientation", self.orientation, ORIENTATIONS)
        self._compose([KineticEnergy()], tip_tasks(self), [])

    def velocity(self, conf: Configuration, target: Target) -> Vector:
        """Compute the closed form A^+ b [rad/s], (n,), by numpy's singular value decomposition."""
        qp = self.build_qp(conf, target)
        velocity: Vector = np.linalg.pinv(qp.A, rcond=RANK_TOLERANCE) @ qp.b
        return velocity

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return {"name": "pseudo-inverse", **asdict(self)}
