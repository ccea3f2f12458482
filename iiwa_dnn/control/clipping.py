"""Clipping of a command that noise, a filter or an estimator has altered, to the program's limits.

The network's own answer is within them. A drive that watches its own limits does the same at the
joints' true positions, so that no disturbance breaks a limit.
"""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.fallback import Yielding, nearest_within
from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.qp.layout import qp_views

TOLERANCE = 1e-12
"""A command beyond its bound by no more [rad/s] is clipped and not counted: that is rounding."""

ROW_TOLERANCE = 1e-9
"""Inequality rows that are broken by no more are left alone: the network's own tolerance."""


def clip_command(qp: QP, dq: Vector, yielding: Yielding) -> tuple[Vector, NDArray[np.int8]]:
    """Clip joint velocities to the bounds and inequality rows of a program.

    A velocity that is NaN becomes zero, clipped to the bounds. If an inequality row is broken, the
    nearest velocity within all limits is taken; if there is none, zero, clipped to the bounds.

    Args:
        qp: The program at the joints' true positions; its first variables are the joints.
        dq: Joint velocities [rad/s], (n,).
        yielding: How the network converges.

    Returns:
        The velocities within the limits [rad/s], (n,), and 1 for each joint that was clipped.
    """
    n = dq.size
    lb = qp.lb[:n]
    ub = qp.ub[:n]
    clipped: Vector = np.clip(np.where(np.isnan(dq), 0.0, dq), lb, ub)
    rows = qp.G[:, :n]
    # Rows on slack variables are the scheme's own affair.
    of_joints = ~qp.G[:, n:].any(axis=1)
    if (rows @ clipped > qp.h + ROW_TOLERANCE)[of_joints].any():
        of_limits = QP(np.eye(n), np.zeros(n), G=rows[of_joints], h=qp.h[of_joints], lb=lb, ub=ub)
        views = qp_views(of_limits.data, *of_limits.sizes)
        if not nearest_within(views, clipped, yielding, SolveStats.zeros()):
            clipped = np.clip(np.zeros(n), lb, ub)
    changed = ~(np.abs(dq - clipped) <= TOLERANCE)
    return clipped, changed.astype(np.int8)
