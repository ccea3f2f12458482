"""Residuals of a primal-dual point, all zero exactly at a KKT point; compiled."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp.dense import dot
from iiwa_dnn.qp.layout import Matrix, Triple, Vector, compiled, larger, offsets


@compiled
def point_residuals(data: Vector, n: int, m: int, p: int, point: Vector) -> Triple:
    """Compute ``(primal, dual, gap)`` of [x | y | z | z_box], as qpsolvers defines them."""
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    at_z, at_box = n + p, n + p + m
    primal, dual, gap = 0.0, 0.0, 0.0
    for j in range(p):
        primal = larger(primal, abs(dot(data, at_A + j * n, point, n) - data[at_b + j]))
        gap += data[at_b + j] * point[n + j]
    for j in range(m):
        primal = larger(primal, dot(data, at_G + j * n, point, n) - data[at_h + j])
        if point[at_z + j] != 0.0:
            gap += data[at_h + j] * point[at_z + j]
    for i in range(n):
        x, lb, ub, multiplier = point[i], data[at_lb + i], data[at_ub + i], point[at_box + i]
        primal = larger(primal, x - ub)
        primal = larger(primal, lb - x)
        value = data[at_q + i] + dot(data, i * n, point, n)
        gap += x * value
        value += multiplier
        for j in range(p):
            value += data[at_A + j * n + i] * point[n + j]
        for j in range(m):
            value += data[at_G + j * n + i] * point[at_z + j]
        dual = larger(dual, abs(value))
        if multiplier > 0.0 and ub < np.inf:
            gap += ub * multiplier
        elif multiplier < 0.0 and lb > -np.inf:
            gap += lb * multiplier
    return primal, dual, abs(gap)


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
    for i in range(n):
        fall = -data[at_q + i] - dot(data, i * n, point, n)
        for j in range(p):
            fall -= data[at_A + j * n + i] * point[n + j]
        for j in range(m):
            fall -= data[at_G + j * n + i] * point[at_z + j]
        # The distance to the bound first: at a bound it is zero, and the rest is not rounded.
        above = point[i] - data[at_ub + i] + fall
        below = point[i] - data[at_lb + i] + fall
        point[at_z + m + i] = above if above > 0.0 else (below if below < 0.0 else 0.0)
    return point_residuals(data, n, m, p, point)


@compiled
def within(primal: float, dual: float, gap: float, tol: float) -> bool:
    """Tell whether no residual is above the tolerance, and none NaN."""
    return primal <= tol and dual <= tol and gap <= tol
