r"""Equality rows that hold or track the tool's orientation, in two forms.

``block``, the paper's: with :math:`r = [R_{11}, R_{12}, R_{21}, R_{22}]`,

.. math::  J' \dot q = \dot r_d - \nu (r - r_d), \qquad J' = W(R)\, J_\omega

where W follows from :math:`\dot R = [\omega]_\times R`. These four rows have rank three at most,
and where the tool's axis is vertical they lose the two tilts (docs/errata.md). Off the path the
four contradict each other, at second order in the error: no velocity fulfils them all, and the
program would have no solution. The right-hand side is therefore projected on the range of W, which
gives the rows their least-squares meaning and changes nothing at first order.

``so3``: with the angular velocity rows themselves,

.. math::  J_\omega \dot q = \omega_d + \nu \log(R_d R^T)

three rows in the world's axes that lose nothing at any orientation.

Sources: equations (3)-(5) of the paper; for ``so3``, F. Bullo and R. M. Murray, "Proportional
derivative (PD) control on the Euclidean group", European Control Conference 1995.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from iiwa_dnn import kernels
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot.configuration import Configuration

Orientation = Literal["so3", "block", "none"]
ORIENTATIONS: tuple[Orientation, ...] = ("so3", "block", "none")
ROW_COUNT: dict[Orientation, int] = {"so3": 3, "block": 4, "none": 0}
MODE_INDEX: dict[Orientation, int] = {"none": 0, "so3": 1, "block": 2}
"""What the kernels call a form."""


def block_vector(rotation: Matrix) -> Vector:
    """The paper's r: the upper left 2x2 block of a rotation, row by row, (4,)."""
    return rotation[:2, :2].reshape(4)


def block_map(rotation: Matrix) -> Matrix:
    """W(R) of shape (4, 3): the rate of `block_vector` is W(R) times the angular velocity."""
    result = np.empty((4, 3))
    kernels.block_map(np.ascontiguousarray(rotation, dtype=np.float64), result)
    return result


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
    _, pose, jacobian = conf.arrays
    count = ROW_COUNT[mode]
    rows, rhs = np.empty((count, jacobian.shape[1])), np.empty(count)
    kernels.orientation_rows(MODE_INDEX[mode], pose, jacobian, target.data, gain, rows, rhs)
    return rows, rhs
