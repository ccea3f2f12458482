"""Settling in other units: a second start in which nothing stands out, and a steeper cost.

The variables and the rows of A and G get factors with which all rows of the KKT matrix have a size
near 1, and the cost is divided by its largest entry. For the network that is another time constant
for each entry of its state; its equilibria are the same.

An implicit step of length h [rho] leaves the fraction 1 / (1 + h c) of an error along which the
cost has the curvature c, so that a steeper cost settles sooner where it is nearly flat.
"""

import numpy as np

from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.implicit import settle_program
from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.program import QP

STRICTER = 1e-4
"""Tolerance in scaled units over that in the program's own, where the residuals grow."""
ROUNDS = 10
"""Rounds of balancing; each takes the square root of what is left."""
STEEP = 1e5
"""Largest entry of a cost that was made steep."""


@np.errstate(over="ignore", invalid="ignore")
def settle_scaled(
    qp: QP, state: Vector, point: Vector, tol: float, budget: int, before: Settled
) -> Settled:
    """Settle a program from zero in scaled units, then in its own.

    The state is (3 n + m + p,), the point (2 n + m + p,); systems and time of the progress `before`
    are added.
    """
    n, m, p = qp.sizes
    rows = np.vstack([qp.A, qp.G])
    units = balanced(np.block([[qp.P, rows.T], [rows, np.zeros((m + p, m + p))]]))
    own, of_rows = np.split(units, [n])
    rows = of_rows[:, np.newaxis] * rows * own
    limits = of_rows * np.concatenate([qp.b, qp.h])
    P = own[:, np.newaxis] * qp.P * own
    q = own * qp.q
    cost = max(np.abs(P).max(), np.abs(q).max(), 1e-300)
    scaled = QP(
        P / cost, q / cost, rows[p:], limits[p:], rows[:p], limits[:p], qp.lb / own, qp.ub / own
    )
    state[:] = 0.0
    first = settle_program(scaled, state, point, STRICTER * tol / max(1.0, cost), budget)
    state[n:] *= cost
    state *= np.concatenate([own, of_rows, 1.0 / own, 1.0 / own])
    second = settle_program(qp, state, point, tol, budget - first[0])
    return before[0] + first[0] + second[0], before[1] + first[1] + second[1], *second[2:]


def balanced(matrix: Matrix) -> Vector:
    """Return factors of rows and columns of a symmetric matrix that bring each to a size near 1.

    Source: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
    Rutherford Appleton Laboratory, RAL-TR-2001-034.
    """
    units = np.ones(len(matrix))
    for _ in range(ROUNDS):
        sizes = units * np.abs(matrix * units).max(axis=1)
        units /= np.sqrt(np.where(sizes > 0.0, sizes, 1.0))
    return units


def settle_steep(qp: QP, state: Vector, point: Vector, tol: float, budget: int) -> Settled:
    """Settle a program from a state (3 n + m + p,), its cost scaled to `STEEP`.

    The tolerance and what is returned are in the program's own units, the point (2 n + m + p,) too.
    """
    n = qp.sizes[0]
    cost = slice(n * n + n)
    scale = STEEP / max(float(np.abs(qp.data[cost]).max()), 1e-300)
    steep = QP.from_data(qp.data.copy(), qp.sizes)
    steep.data[cost] *= scale
    state[n:] *= scale
    settled = settle_program(steep, state, point, scale * tol, budget)
    state[n:] /= scale
    point[n:] /= scale
    return *settled[:2], *qp.residuals(point)
