"""A second cold start, in coordinates in which no row and no column stands out.

With x = D x', rows scaled by E and the cost by c, the program is settled in coordinates in which
the largest entry of each row and column of P, A and G is near one. For the network that is another
time constant for each state; its equilibria are the same.

Source: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
RAL-TR-2001-034.
"""

import numpy as np

from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler, settle_program
from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import point_of_state, within

STRICTER = 1e-2
"""Least tolerance in these coordinates over that in the program's own: residuals grow on the way
back."""
POLISHING = 50
"""Linear systems for each stricter tolerance: it begins beside the answer, and takes a few unless
rounding keeps it from its end."""


def settle_equilibrated(
    qp: QP, state: Vector, point: Vector, tol: float, max_systems: int
) -> Settled:
    """Settle `state` (3n + m + p,) from a cold start; arguments as `Integrator.settle`'s.

    The tolerance in these coordinates becomes stricter until the program's own is reached: one that
    is lost in rounding from the beginning would let the state wander away from its answer again.
    """
    scaled, units, cost = equilibrate(qp)
    inner = np.zeros(state.size)
    least = STRICTER * tol * min(1.0, cost)
    strict = tol
    systems = 0
    time = 0.0
    budget = max_systems
    while True:
        taken, passed, *_ = settle_program(
            scaled, inner, point, strict, budget, ImplicitEuler.long_step
        )
        systems += taken
        time += passed
        state[:] = inner * units
        residuals = point_of_state(qp.data, *qp.sizes, state, point)
        if within(*residuals, tol) or strict <= least or systems >= max_systems:
            return systems, time, *residuals
        strict *= 0.1
        budget = min(POLISHING, max_systems - systems)


def equilibrate(qp: QP) -> tuple[QP, Vector, float]:
    """Scale a program until the largest entry of each row and column of P, A and G is near one.

    Returns:
        The scaled program; the units of its state in the program's own, (3n + m + p,); and the
        scale of the cost.
    """
    P = qp.P.copy()
    A = qp.A.copy()
    G = np.where(np.isfinite(qp.h)[:, None], qp.G, 0.0)
    d = np.ones(qp.q.size)
    e = np.ones(qp.h.size)
    f = np.ones(qp.b.size)
    for _ in range(10):
        columns = _inverse_roots(np.vstack([P, A, G]), 0)
        equalities = _inverse_roots(A, 1)
        inequalities = _inverse_roots(G, 1)
        P *= columns[:, None] * columns
        A *= equalities[:, None] * columns
        G *= inequalities[:, None] * columns
        d *= columns
        e *= inequalities
        f *= equalities
        if np.abs(1.0 - np.concatenate([columns, equalities, inequalities])).max() < 1e-2:
            break
    c = 1.0 / max(np.abs(P).max(axis=0).mean(), np.abs(qp.q * d).max(), 1e-300)
    scaled = QP(c * P, c * qp.q * d, G, qp.h * e, A, qp.b * f, qp.lb / d, qp.ub / d)
    units = np.concatenate([d, f / c, e / c, 1.0 / (d * c), 1.0 / (d * c)])
    return scaled, units, c


def _inverse_roots(matrix: Matrix, axis: int) -> Vector:
    """Compute one over the root of the largest entry of each column (axis 0) or row (axis 1)."""
    sizes = np.abs(matrix).max(axis=axis, initial=0.0)
    roots: Vector = 1.0 / np.sqrt(np.where(sizes > 0.0, sizes, 1.0))
    return roots
