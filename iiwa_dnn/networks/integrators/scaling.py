"""A second start, in coordinates in which no row and no column of the program stands out.

With x = D x', rows scaled by E and the cost by c, the program is settled in coordinates in which
the largest entry of each row and column of P, A and G is near one. For the network that is another
time constant for each state; its equilibria are the same.

Source: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
RAL-TR-2001-034.
"""

import numpy as np

from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.implicit import settle_program
from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.program import QP

STRICTER = 1e-3
"""Tolerance in scaled coordinates over that in the program's own, where the residuals grow."""


def settle_scaled(
    qp: QP, state: Vector, point: Vector, tol: float, budget: int, before: Settled
) -> Settled:
    """Settle a program from zero in scaled coordinates, then in its own.

    The state is (3 n + m + p,), the point (2 n + m + p,); systems and time of the progress `before`
    are added.
    """
    scaled, units, cost = equilibrate(qp)
    state[:] = 0.0
    first = settle_program(scaled, state, point, STRICTER * tol * min(1.0, cost), budget)
    state *= units
    second = settle_program(qp, state, point, tol, budget - first[0])
    systems = before[0] + first[0] + second[0]
    return systems, before[1] + first[1] + second[1], *second[2:]


def equilibrate(qp: QP) -> tuple[QP, Vector, float]:
    """Scale a program until the largest entry of each row and column of P, A and G is near one.

    Returns:
        The scaled program; the units of its state in the program's own, (3n + m + p,); and the
        scale of the cost.
    """
    n, m, p = qp.sizes
    finite = np.isfinite(qp.h)[:, np.newaxis]
    rows = np.vstack([qp.P, qp.A, np.where(finite, qp.G, 0.0)])
    d = np.ones(n)
    e = np.ones(p + m)
    for _ in range(10):
        columns = _inverse_roots(rows, 0)
        lines = np.concatenate([columns, _inverse_roots(rows[n:], 1)])
        rows *= lines[:, np.newaxis] * columns
        d *= columns
        e *= lines[n:]
    c = 1.0 / max(np.abs(rows[:n]).max(axis=0).mean(), np.abs(qp.q * d).max(), 1e-300)
    scaled = QP(
        c * rows[:n],
        c * qp.q * d,
        qp.G * d * e[p:, np.newaxis],
        qp.h * e[p:],
        rows[n : n + p],
        qp.b * e[:p],
        qp.lb / d,
        qp.ub / d,
    )
    of_bounds = 1.0 / (d * c)
    return scaled, np.concatenate([d, e / c, of_bounds, of_bounds]), c


def _inverse_roots(matrix: Matrix, axis: int) -> Vector:
    """Compute one over the root of the largest entry of each column (axis 0) or row (axis 1)."""
    sizes = np.abs(matrix).max(axis=axis, initial=0.0)
    roots: Vector = 1.0 / np.sqrt(np.where(sizes > 0.0, sizes, 1.0))
    return roots
