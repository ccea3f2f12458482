"""A second start, in units in which no row of the program stands out.

The rows of A and G are divided by their largest entries, and the cost by its own. For the network
that is another time constant for each multiplier; its equilibria are the same.
"""

import numpy as np

from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.implicit import settle_program
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP

STRICTER = 1e-4
"""Tolerance in scaled units over that in the program's own, where the residuals grow."""


def settle_scaled(
    qp: QP, state: Vector, point: Vector, tol: float, budget: int, before: Settled
) -> Settled:
    """Settle a program from zero in scaled units, then in its own.

    The state is (3 n + m + p,), the point (2 n + m + p,); systems and time of the progress `before`
    are added.
    """
    n, m, p = qp.sizes
    rows = np.vstack([qp.A, qp.G])
    sizes = np.abs(rows).max(axis=1, initial=0.0)
    sizes[sizes == 0.0] = 1.0
    rows /= sizes[:, np.newaxis]
    limits = np.concatenate([qp.b, qp.h]) / sizes
    cost = max(np.abs(qp.P).max(), np.abs(qp.q).max(), 1e-300)
    scaled = QP(qp.P / cost, qp.q / cost, rows[p:], limits[p:], rows[:p], limits[:p], qp.lb, qp.ub)
    state[:] = 0.0
    first = settle_program(scaled, state, point, STRICTER * tol / max(1.0, cost), budget)
    state[n:] *= cost
    state[n : n + m + p] /= sizes
    second = settle_program(qp, state, point, tol, budget - first[0])
    systems = before[0] + first[0] + second[0]
    return systems, before[1] + first[1] + second[1], *second[2:]
