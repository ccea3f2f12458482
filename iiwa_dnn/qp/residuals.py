"""Residuals of a primal-dual point, all zero exactly at a KKT point; compiled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp.dense import add_scaled, dot
from iiwa_dnn.qp.layout import Matrix, Triple, Vector, compiled, larger, offsets

LONG = 64
"""Variables from which on the gap, a long sum, is computed accurately."""


@compiled
def point_residuals(data: Vector, n: int, m: int, p: int, point: Vector) -> Triple:
    """Compute ``(primal, dual, gap)`` of [x | y | z | z_box], as qpsolvers defines them."""
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    at_z, at_box = n + p, n + p + m
    primal, dual, gap, gradient = 0.0, 0.0, 0.0, np.empty(n)
    for i in range(n):
        x, lb, ub, multiplier = point[i], data[at_lb + i], data[at_ub + i], point[at_box + i]
        primal = larger(primal, x - ub)
        primal = larger(primal, lb - x)
        value = data[at_q + i] + dot(data, i * n, point, n)
        gap += x * value
        gradient[i] = value + multiplier
        if multiplier > 0.0 and ub < np.inf:
            gap += ub * multiplier
        elif multiplier < 0.0 and lb > -np.inf:
            gap += lb * multiplier
    for j in range(p):
        row, y = at_A + j * n, point[n + j]
        primal = larger(primal, abs(dot(data, row, point, n) - data[at_b + j]))
        gap += data[at_b + j] * y
        add_scaled(gradient, y, data, row, n)
    for j in range(m):
        row, z = at_G + j * n, point[at_z + j]
        primal = larger(primal, dot(data, row, point, n) - data[at_h + j])
        if z != 0.0:
            gap += data[at_h + j] * z
            add_scaled(gradient, z, data, row, n)
    for i in range(n):
        dual = larger(dual, abs(gradient[i]))
    return primal, dual, abs(gap if n < LONG else accurate_gap(data, n, m, p, point))


@compiled
def _add_product(total: float, rest: float, a: float, b: float) -> tuple[float, float]:
    """Add a b to a sum; the roundings of product and sum go to `rest`.

    Source: T. Ogita, S. M. Rump, S. Oishi, "Accurate sum and dot product", SIAM J. Sci. Comput. 26
    (2005).
    """
    value, far, wide = a * b, 134217729.0 * a, 134217729.0 * b
    a_high, b_high = far - (far - a), wide - (wide - b)
    a_low, b_low = a - a_high, b - b_high
    lost = a_low * b_low - (((value - a_high * b_high) - a_low * b_high) - a_high * b_low)
    new = total + value
    part = new - total
    return new, rest + (((total - (new - part)) + (value - part)) + lost)


@compiled
def accurate_gap(data: Vector, n: int, m: int, p: int, point: Vector) -> float:
    """Compute the duality gap of [x | y | z | z_box] with its sign, as if in twice the digits."""
    at_q, at_G, _, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    gap, rest = 0.0, 0.0
    for i in range(n):
        row, row_rest, x, multiplier = data[at_q + i], 0.0, point[i], point[n + p + m + i]
        for k in range(n):
            if data[i * n + k] != 0.0:
                row, row_rest = _add_product(row, row_rest, data[i * n + k], point[k])
        gap, rest = _add_product(gap, rest + row_rest * x, row, x)
        end = data[at_ub + i] if multiplier > 0.0 else data[at_lb + i]
        if abs(end) < np.inf:
            gap, rest = _add_product(gap, rest, end, multiplier)
    for j in range(p):
        gap, rest = _add_product(gap, rest, data[at_b + j], point[n + j])
    for j in range(m):
        if point[n + p + j] != 0.0:
            gap, rest = _add_product(gap, rest, data[at_h + j], point[n + p + j])
    return gap + rest


@compiled
def largest_residuals(
    programs: Matrix, n: int, m: int, p: int, points: NDArray[np.float64], out: Matrix
) -> None:
    """Write the largest residual of each point (N, k, size) into `out` (N, k).

    It is infinite where the first entry of a point is NaN, which stands for no point.
    """
    count, k, _ = points.shape
    for i in range(count):
        for j in range(k):
            out[i, j] = np.inf
            if points[i, j, 0] == points[i, j, 0]:
                primal, dual, gap = point_residuals(programs[i], n, m, p, points[i, j])
                out[i, j] = larger(larger(primal, dual), gap)


@compiled
def kkt_point(data: Vector, n: int, m: int, p: int, s: Vector, point: Vector) -> Triple:
    """Write the point [x | y | z | z_box] of a state [x | y | z | ...] into `point`.

    x is put inside its bounds and z made nonnegative. z_box is the part of x minus the gradient
    P x + q + A^T y + G^T z that the projection on the bounds cuts off: at an equilibrium u - l and
    the part of the multiplier that the primal projection carries.

    Returns:
        ``(primal, dual, gap)`` of the point as it is handed out.
    """
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_ub, at_z = at_lb + n, n + p
    for i in range(n):
        point[i] = min(max(s[i], data[at_lb + i]), data[at_ub + i])
    for j in range(p):
        point[n + j] = s[n + j]
    for j in range(m):
        point[at_z + j] = max(s[at_z + j], 0.0)
    falls = point[at_z + m :]
    for i in range(n):
        falls[i] = -data[at_q + i] - dot(data, i * n, point, n)
    for j in range(p):
        add_scaled(falls, -point[n + j], data, at_A + j * n, n)
    for j in range(m):
        if point[at_z + j] != 0.0:
            add_scaled(falls, -point[at_z + j], data, at_G + j * n, n)
    for i in range(n):
        fall = falls[i]
        # The distance to the bound first: at a bound it is zero, and the rest is not rounded.
        above = point[i] - data[at_ub + i] + fall
        below = point[i] - data[at_lb + i] + fall
        falls[i] = above if above > 0.0 else (below if below < 0.0 else 0.0)
    return point_residuals(data, n, m, p, point)


@compiled
def within(primal: float, dual: float, gap: float, tol: float) -> bool:
    """Tell whether no residual is above the tolerance, and none NaN."""
    return primal <= tol and dual <= tol and gap <= tol
