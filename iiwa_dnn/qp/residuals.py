r"""Residuals of a primal-dual point, all zero exactly at a KKT point, and their tolerances.

**The rule of acceptance.** An entry r of a residual, whose terms have the sum s of absolute values,
is small enough if

.. math::

    |r| \le \max(\varepsilon_{abs}\, w,\; \varepsilon_{rel}\, s,\; 4 \cdot 10^{-15}\, n\, s) ,

the last being rounding. The weight w is 1, but that of a slight row, or of a variable with slight
coefficients alone, is its largest coefficient if that is below `SLIGHT`: of such a row any x at all
would be within an absolute tolerance. A slight cost counts as scaled to 1 by its largest entry, and
with it the dual residuals and the gap.
"""

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.dense import ROUNDING, add_row, is_convex, largest_entry, row_dot
from iiwa_dnn.qp.layout import Matrix, QPViews, Triple, Vector, copied, larger, qp_views

SLIGHT = 1e-3
"""Largest coefficient of a row, a column or the cost below which it is slight."""


@compiled
def point_residuals(qp: QPViews, point: Vector) -> Triple:
    """Compute ``(primal, dual, gap)`` of [x | y | z | z_box], as qpsolvers defines them."""
    n = qp.q.size
    p = qp.b.size
    at_z = n + p
    at_box = at_z + qp.h.size
    primal = 0.0
    dual = 0.0
    gap = 0.0
    gradient = np.empty(n)
    for i in range(n):
        x = point[i]
        multiplier = point[at_box + i]
        primal = larger(primal, x - qp.ub[i])
        primal = larger(primal, qp.lb[i] - x)
        value = qp.q[i] + row_dot(qp.P, i, point)
        gap += x * value
        gradient[i] = value + multiplier
        bound = qp.ub[i] if multiplier > 0.0 else qp.lb[i]
        if multiplier != 0.0 and abs(bound) < np.inf:
            gap += bound * multiplier
    for j in range(p):
        y = point[n + j]
        primal = larger(primal, abs(row_dot(qp.A, j, point) - qp.b[j]))
        gap += qp.b[j] * y
        add_row(gradient, y, qp.A, j)
    for j in range(qp.h.size):
        z = point[at_z + j]
        primal = larger(primal, row_dot(qp.G, j, point) - qp.h[j])
        if z != 0.0:
            gap += qp.h[j] * z
            add_row(gradient, z, qp.G, j)
    for i in range(n):
        dual = larger(dual, abs(gradient[i]))
    return primal, dual, abs(gap)


@compiled
def residuals_of(data: Vector, n: int, m: int, p: int, point: Vector) -> Triple:
    """Compute `point_residuals` of a point (2n + m + p,), for a program's flat array, `QP.data`."""
    return point_residuals(qp_views(data, n, m, p), point)


@compiled
def kkt_point(qp: QPViews, s: Vector, point: Vector) -> Triple:
    """Write the point [x | y | z | z_box] of a state [x | y | z | ...] into `point`.

    x is put inside its bounds, and z is made nonnegative, and zero where a row has no limit. z_box
    is the part of x minus the gradient P x + q + A^T y + G^T z that the projection on the bounds
    cuts off: at an equilibrium u - l and the part of the multiplier that the primal projection
    carries.

    Returns:
        ``(primal, dual, gap)`` of the point as it is handed out.
    """
    n = qp.q.size
    p = qp.b.size
    m = qp.h.size
    at_z = n + p
    at_box = at_z + m
    for i in range(n):
        point[i] = min(max(s[i], qp.lb[i]), qp.ub[i])
    copied(point[n:], s[n:at_z])
    for j in range(m):
        point[at_z + j] = max(s[at_z + j], 0.0) if qp.h[j] < np.inf else 0.0
    descent = point[at_box:]
    for i in range(n):
        descent[i] = -qp.q[i] - row_dot(qp.P, i, point)
    for j in range(p):
        add_row(descent, -point[n + j], qp.A, j)
    for j in range(m):
        if point[at_z + j] != 0.0:
            add_row(descent, -point[at_z + j], qp.G, j)
    for i in range(n):
        # The distance to the bound first: at a bound it is zero, and the sum is not rounded.
        above = point[i] - qp.ub[i] + descent[i]
        below = point[i] - qp.lb[i] + descent[i]
        descent[i] = max(above, 0.0) + min(below, 0.0)
    return point_residuals(qp, point)


@compiled
def within(primal: float, dual: float, gap: float, tol: float) -> bool:
    """Check that no residual is above the tolerance, and none NaN."""
    return primal <= tol and dual <= tol and gap <= tol


@compiled
def weight_of(largest: float) -> float:
    """Return the weight of an absolute tolerance: the largest coefficient, 1 from `SLIGHT` on."""
    return largest if largest < SLIGHT else 1.0


@compiled
def cost_size(qp: QPViews) -> float:
    """Compute the largest absolute entry of P and q; NaN if one is NaN."""
    return larger(largest_entry(qp.P.reshape(qp.P.size)), largest_entry(qp.q))


@compiled
def product_terms(rows: Matrix, j: int, x: Vector, is_column: bool) -> Triple:
    """Multiply row or column j of a matrix (k, n) by the first entries of x.

    Returns:
        The product, the sum of its absolute terms, and the largest absolute entry.
    """
    value = 0.0
    size = 0.0
    largest = 0.0
    for k in range(rows.shape[0] if is_column else rows.shape[1]):
        entry = rows[k, j] if is_column else rows[j, k]
        value += entry * x[k]
        size += abs(entry * x[k])
        largest = larger(largest, abs(entry))
    return value, size, largest


@compiled
def is_accepted(
    data: Vector,
    n: int,
    m: int,
    p: int,
    point: Vector,
    eps_abs: float,
    eps_rel: float,
) -> bool:
    """Check a point (2n + m + p,) by the rule of acceptance, and that `QP.data` is convex."""
    qp = qp_views(data, n, m, p)
    return is_small_enough(qp, point, eps_abs, eps_rel) and is_convex(qp.P, np.empty((n, n)))


@compiled
def is_small_enough(qp: QPViews, point: Vector, eps_abs: float, eps_rel: float) -> bool:
    """Check a point [x | y | z | z_box] by the rule of acceptance, entry by entry."""
    n = qp.q.size
    p = qp.b.size
    relative = max(eps_rel, ROUNDING * n)
    gap = 0.0
    size = 0.0
    for j in range(p + qp.h.size):
        limit = qp.b[j] if j < p else qp.h[j - p]
        if limit < np.inf:
            value, of_row, largest = product_terms(
                qp.A if j < p else qp.G, j if j < p else j - p, point, False
            )
            excess = abs(value - limit) if j < p else value - limit
            if not excess <= max(eps_abs * weight_of(largest), relative * (of_row + abs(limit))):
                return False
            gap += limit * point[n + j]
            size += abs(limit * point[n + j])
    for i in range(n):
        nearest = min(max(point[i], qp.lb[i]), qp.ub[i])
        allowed = max(eps_abs, relative * (abs(point[i]) + abs(nearest)))
        if not abs(point[i] - nearest) <= allowed:
            return False
    return _cost_is_small_enough(qp, point, eps_abs, relative, gap, size)


@compiled
def _cost_is_small_enough(
    qp: QPViews, point: Vector, eps_abs: float, relative: float, gap: float, size: float
) -> bool:
    """Check the dual residual and the gap of a point by the rule of acceptance.

    `gap` and `size` are what the rows contribute to the gap and to the sum of its absolute terms.
    """
    n = qp.q.size
    at_z = n + qp.b.size
    at_box = at_z + qp.h.size
    cost = cost_size(qp)
    weight = weight_of(cost) if cost > 0.0 else 1.0
    for i in range(n):
        multiplier = point[at_box + i]
        bound = qp.ub[i] if multiplier > 0.0 else qp.lb[i]
        term = bound * multiplier if multiplier != 0.0 and abs(bound) < np.inf else 0.0
        value, of_P, largest = product_terms(qp.P, i, point, False)
        in_A, of_A, largest_A = product_terms(qp.A, i, point[n:], True)
        in_G, of_G, largest_G = product_terms(qp.G, i, point[at_z:], True)
        value += qp.q[i]
        of_P += abs(qp.q[i])
        gap += point[i] * value + term
        size += abs(point[i]) * of_P + abs(term)
        largest = max(max(largest, abs(qp.q[i])) / weight, max(largest_A, largest_G))
        allowed = max(
            eps_abs * weight * weight_of(largest), relative * (of_P + of_A + of_G + abs(multiplier))
        )
        if not abs(value + in_A + in_G + multiplier) <= allowed:
            return False
    return abs(gap) <= max(eps_abs * weight, relative * size)
