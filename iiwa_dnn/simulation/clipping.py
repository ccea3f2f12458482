"""Clipping of an altered command to the limits of a program.

Noise, a filter or an estimator may move a command out of the limits that the network's answer
keeps. A simulated drive clips it to the limits at the joints' true positions.
"""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.qp.layout import qp_views
from iiwa_dnn.step.fallback import Yielding, nearest_within

TOLERANCE = 1e-12
"""Change of a velocity up to which a joint does not count as clipped [rad/s]: rounding."""

ROW_TOLERANCE = 1e-9
"""Violation of an inequality row that is tolerated, as by the network."""


def clip_command(qp: QP, dq: Vector, yielding: Yielding) -> tuple[Vector, NDArray[np.int8]]:
    """Clip joint velocities to the bounds and inequality rows of a program.

    A velocity that is NaN counts as zero. If the velocities clipped to the bounds break an
    inequality row, they are projected on bounds and rows; if no velocity keeps both, the result is
    zero, clipped to the bounds. Rows with slack variables are ignored.

    Args:
        qp: The program at the joints' true positions; its first n variables are the joints'.
        dq: Joint velocities [rad/s], (n,).
        yielding: Tolerance of the projection, and whether joints are coupled.

    Returns:
        The clipped velocities [rad/s], (n,), and for each joint 1 if it was changed, else 0, (n,).
    """
    n = dq.size
    lb = qp.lb[:n]
    ub = qp.ub[:n]
    clipped: Vector = np.clip(np.where(np.isnan(dq), 0.0, dq), lb, ub)
    rows = qp.G[:, :n]
    # Rows with slack variables are soft.
    of_joints = ~qp.G[:, n:].any(axis=1)
    if (rows @ clipped > qp.h + ROW_TOLERANCE)[of_joints].any():
        of_limits = QP(np.eye(n), np.zeros(n), G=rows[of_joints], h=qp.h[of_joints], lb=lb, ub=ub)
        views = qp_views(of_limits.data, *of_limits.sizes)
        if not nearest_within(views, clipped, yielding, SolveStats.zeros()):
            clipped = np.clip(np.zeros(n), lb, ub)
    changed = ~(np.abs(dq - clipped) <= TOLERANCE)
    return clipped, changed.astype(np.int8)
