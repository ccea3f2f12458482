"""Clipping of a command that noise, a filter or an estimator has altered, to the program's limits.

The network's own answer is within them. A drive that watches its own limits does the same at the
joints' true positions, so that no disturbance breaks a limit.
"""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Vector

TOLERANCE = 1e-12
"""A command beyond its bound by no more [rad/s] is clipped and not counted: that is rounding."""

ROW_TOLERANCE = 1e-9
"""Inequality rows that are broken by no more are left alone: the network's own tolerance."""


def clip_command(qp: QP, dq: Vector, solver: DNNSolver) -> tuple[Vector, NDArray[np.int8]]:
    """Clip joint velocities to the bounds and inequality rows of a program.

    A velocity that is no number becomes the bound nearest to rest. Beyond an inequality row the
    nearest velocity within all limits is taken, the solution of a quadratic program.

    Args:
        qp: The program at the joints' true positions; its first variables are the joints.
        dq: Joint velocities [rad/s], (n,).
        solver: The network for that program, its warm start kept from call to call.

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
        nearest = QP(np.eye(n), -clipped, G=rows[of_joints], h=qp.h[of_joints], lb=lb, ub=ub)
        solution = solver.solve(nearest)
        clipped = solution.x if solution.found else np.clip(np.zeros(n), lb, ub)
    changed = ~(np.abs(dq - clipped) <= TOLERANCE)
    return clipped, changed.astype(np.int8)
