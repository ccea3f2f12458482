r"""Backward Euler step of the projection network without its primal projection, compiled.

Of one step of length h (in units of rho) the multipliers' lines can be solved for, with
:math:`\Omega = [G; I; -I]` and :math:`\chi = [h; ub; -lb]`:

.. math::

    y^+ = y + h (A x^+ - b), \qquad
    \mu^+ = \max\Bigl(\frac{\mu}{1+h},\; \mu + h\,(\Omega x^+ - \chi)\Bigr)

and both are increasing in :math:`x^+`. The line that is left, :math:`(x^+ - x)/h + P x^+ + q +
A^T y^+ + \Omega^T \mu^+ = 0`, is therefore the stationarity of a strongly convex, piecewise
quadratic function, for every h. It has one minimiser, and a semismooth Newton iteration with an
exact line search reaches it. A bare Newton iteration on the KKT conditions can cycle when many
bounds are active; this one cannot.

Source: R. T. Rockafellar, "Augmented Lagrangians and applications of the proximal point algorithm
in convex programming", Math. Oper. Res. 1 (1976), for the same step of the plain saddle-point flow,
which is his method of multipliers.
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn.networks.integrators.linear_step import condensed_matrix
from iiwa_dnn.qp.dense import add_scaled, cholesky_factor, dot, factor_solve
from iiwa_dnn.qp.layout import Vector, compiled, larger, offsets


@compiled
def backward_euler(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, new: Vector, tol: float,
    max_newton: int, counted: Vector, gram: Vector, K: Vector,
) -> int:  # fmt: skip
    """Solve new = s + step F(new) for `new` (3n + m + p,), the iteration starting at new[:n].

    The iteration stops where the gradient is at most `tol` or lost in rounding, or after
    `max_newton` rounds. See `condensed_matrix` for `counted` (m,), `gram` and K (n n,).

    Returns:
        Newton iterations, or -1 where a matrix was not positive definite to working precision.
    """
    rows = p + m + 2 * n
    gradient, direction = np.empty(n), np.empty(n)
    slacks, change, active = np.empty(rows), np.empty(rows), np.empty(m + 2 * n)
    _slacks(data, n, m, p, new, slacks)
    # A slack is known to its rounding, and its multiplier to `step` times that.
    largest = 1.0
    for i in range(n):
        largest = max(largest, abs(new[i]))
    floor = 1e-15 * step * largest
    taken = max_newton
    for iteration in range(max_newton):
        _multipliers(n, m, p, s, step, slacks, new, active)
        size = _gradient(data, n, m, p, s, step, new, gradient)
        if not size > max(tol, floor):
            taken = iteration
            break
        condensed_matrix(data, n, m, p, step, active, counted, gram, K)
        if not cholesky_factor(K, n):
            return -1
        factor_solve(K, n, gradient, direction)
        for i in range(n):
            direction[i] = -direction[i]
        _rows_times(data, n, m, p, direction, change)
        length = _line_search(data, n, m, p, s, step, slacks, change, direction, gradient)
        for i in range(n):
            new[i] += length * direction[i]
        for k in range(rows):
            slacks[k] += length * change[k]
    # Once more from x itself: long steps would magnify the rounding of the updates.
    _slacks(data, n, m, p, new, slacks)
    _multipliers(n, m, p, s, step, slacks, new, active)
    return taken


@compiled
def _rows_times(data: Vector, n: int, m: int, p: int, x: Vector, values: Vector) -> None:
    """Write [A; G; I; -I] x into `values` (p + m + 2n)."""
    _, at_G, at_A, _ = offsets(n, m, p)
    for j in range(p):
        values[j] = dot(data, at_A + j * n, x, n)
    for j in range(m):
        values[p + j] = dot(data, at_G + j * n, x, n)
    for i in range(n):
        values[p + m + i] = x[i]
        values[p + m + n + i] = -x[i]


@compiled
def _slacks(data: Vector, n: int, m: int, p: int, x: Vector, slacks: Vector) -> None:
    """Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n)."""
    _, at_G, _, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    _rows_times(data, n, m, p, x, slacks)
    for j in range(p):
        slacks[j] -= data[at_b + j]
    for j in range(m):
        slacks[p + j] -= data[at_h + j]
    for i in range(n):
        slacks[p + m + i] -= data[at_ub + i]
        slacks[p + m + n + i] += data[at_lb + i]


@compiled
def _multipliers(
    n: int, m: int, p: int, s: Vector, step: float, slacks: Vector, new: Vector, active: Vector
) -> None:
    """Write the multipliers after a step to x with these slacks into `new`, and which follow it."""
    keep = 1.0 / (1.0 + step)
    for j in range(p):
        new[n + j] = s[n + j] + step * slacks[j]
    for k in range(p, p + m + 2 * n):
        old = s[n + k]
        moving = old + step * slacks[k]
        is_active = moving > old * keep
        active[k - p] = is_active
        new[n + k] = moving if is_active else old * keep


@compiled
def _gradient(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, new: Vector, gradient: Vector
) -> float:
    """Write the gradient of the step's convex function; returns its largest entry."""
    at_q, at_G, at_A, _ = offsets(n, m, p)
    at_z, at_u = n + p, n + p + m
    for i in range(n):
        value = data[at_q + i] + new[at_u + i] - new[at_u + n + i]
        gradient[i] = value + (new[i] - s[i]) / step
    for k in range(n):  # P is symmetric
        add_scaled(gradient, new[k], data, k * n, n)
    for j in range(p):
        add_scaled(gradient, new[n + j], data, at_A + j * n, n)
    for j in range(m):
        if new[at_z + j] != 0.0:
            add_scaled(gradient, new[at_z + j], data, at_G + j * n, n)
    size = 0.0
    for i in range(n):
        size = larger(size, abs(gradient[i]))
    return size


@compiled
def _line_search(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, slacks: Vector, change: Vector,
    direction: Vector, gradient: Vector,
) -> float:  # fmt: skip
    """Minimise the step's convex function along `direction`.

    Its derivative is continuous, increasing and piecewise linear, so a Newton iteration kept
    inside a bracket ends at the root. `change` is [A; G; I; -I] direction.
    """
    keep = 1.0 / (1.0 + step)
    start, curvature = 0.0, 0.0
    for i in range(n):
        start += gradient[i] * direction[i]
        value = direction[i] / step + dot(data, i * n, direction, n)
        curvature += value * direction[i]
    for j in range(p):
        curvature += step * change[j] * change[j]
    constant = start
    for k in range(p, p + m + 2 * n):
        old = s[n + k]
        constant -= max(old * keep, old + step * slacks[k]) * change[k]
    low, high, length = 0.0, np.inf, 1.0
    for _ in range(50):
        slope = constant + length * curvature
        second = curvature
        for k in range(p, p + m + 2 * n):
            old = s[n + k]
            moving = old + step * (slacks[k] + length * change[k])
            if moving > old * keep:
                slope += moving * change[k]
                second += step * change[k] * change[k]
            else:
                slope += old * keep * change[k]
        if abs(slope) <= 1e-3 * abs(start):
            break
        if slope > 0.0:
            high = length
        else:
            low = length
        length -= slope / second
        if not low < length < high:
            length = 0.5 * (low + high) if high < np.inf else 2.0 * low
    return length
