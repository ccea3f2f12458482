r"""Equality rows that hold or track the tool's orientation, in two forms.

``block``, the paper's: with :math:`r = [R_{11}, R_{12}, R_{21}, R_{22}]`,

.. math::  J' \dot q = \dot r_d - \nu (r - r_d), \qquad J' = W(R)\, J_\omega

where W follows from :math:`\dot R = [\omega]_\times R`. These four rows have rank three at most,
and where the tool's axis is vertical they lose the two tilts (docs/errata.md).

``so3``: with the angular velocity rows themselves,

.. math::  J_\omega \dot q = \omega_d + \nu \log(R_d R^T)

three rows in the world's axes that lose nothing at any orientation.

Sources: equations (3)-(5) of the paper; for ``so3``, F. Bullo and R. M. Murray, "Proportional
derivative (PD) control on the Euclidean group", European Control Conference 1995.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
import pinocchio as pin

from iiwa_dnn.configuration import Configuration
from iiwa_dnn.exceptions import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references import Target

Orientation = Literal["so3", "block", "none"]
ORIENTATIONS: tuple[Orientation, ...] = ("so3", "block", "none")


def check_orientation(value: str) -> None:
    """Raise InvalidInputError unless `value` is one of ``ORIENTATIONS``."""
    if value not in ORIENTATIONS:
        choices = ", ".join(ORIENTATIONS)
        raise InvalidInputError("orientation", f"must be one of {choices}, not {value!r}", value)


def block_vector(rotation: Matrix) -> Vector:
    """The paper's r: the upper left 2x2 block of a rotation, row by row, (4,)."""
    return rotation[:2, :2].reshape(4)


def block_map(rotation: Matrix) -> Matrix:
    """W(R) of shape (4, 3): the rate of `block_vector` is W(R) times the angular velocity."""
    R = rotation
    return np.array(
        [
            [0.0, R[2, 0], -R[1, 0]],
            [0.0, R[2, 1], -R[1, 1]],
            [-R[2, 0], 0.0, R[0, 0]],
            [-R[2, 1], 0.0, R[0, 1]],
        ]
    )


def orientation_rows(
    mode: Orientation, conf: Configuration, target: Target, gain: float
) -> tuple[Matrix, Vector]:
    """Rows and right-hand side of the orientation task.

    Args:
        mode: ``"so3"``, ``"block"`` or ``"none"``.
        conf: Where the robot is, n joints.
        target: Where it should be.
        gain: Feedback gain nu [1/s].

    Returns:
        ``(rows, rhs)`` of shapes (k, n) and (k,) with k = 3, 4 or 0.
    """
    angular = conf.jacobian[3:]
    if mode == "so3":
        error = pin.log3(target.rotation @ conf.rotation.T)
        return angular, target.angular_velocity + gain * error
    if mode == "block":
        rows = block_map(conf.rotation) @ angular
        desired = block_map(target.rotation) @ target.angular_velocity
        error = block_vector(target.rotation) - block_vector(conf.rotation)
        return rows, desired + gain * error
    return angular[:0], np.zeros(0)
