"""Residuals of a primal-dual point, all zero exactly at a KKT point; compiled."""

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.dense import add_row, row_dot
from iiwa_dnn.qp.layout import QPViews, Triple, Vector, copied, larger, qp_views


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
def point_of_state(data: Vector, n: int, m: int, p: int, s: Vector, point: Vector) -> Triple:
    """Write the `kkt_point` (2n + m + p,) of a state, for a program's flat array, `QP.data`."""
    return kkt_point(qp_views(data, n, m, p), s, point)


@compiled
def within(primal: float, dual: float, gap: float, tol: float) -> bool:
    """Check that no residual is above the tolerance, and none NaN."""
    return primal <= tol and dual <= tol and gap <= tol
