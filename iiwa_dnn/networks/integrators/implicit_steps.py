r"""Implicit steps of the projection network without its primal projection, compiled.

**The linearly implicit step** :math:`(I/h - F'(s))\,(s^+ - s) = F(s)` of length h [rho] is linear
on the active set at s. Its multipliers are eliminated, which leaves n equations for the change of x
with the condensed matrix

.. math::

    K = P + I/h + h\,(A^T A + C^T C),

C being the active rows of :math:`\Omega = [G; I; -I]`.

**The backward Euler step.** Its multipliers' lines can be solved for, with :math:`\chi = [h; ub;
-lb]`:

.. math::

    y^+ = y + h (A x^+ - b), \qquad
    \mu^+ = \max\Bigl(\frac{\mu}{1+h},\; \mu + h\,(\Omega x^+ - \chi)\Bigr)

and both are increasing in :math:`x^+`. The line that is left, :math:`(x^+ - x)/h + P x^+ + q +
A^T y^+ + \Omega^T \mu^+ = 0`, is therefore the stationarity of a strongly convex, piecewise
quadratic function, for every h. It has one minimiser, and a semismooth Newton iteration whose line
search becomes exact in the end reaches it; its matrix is K again. A bare Newton iteration on the
KKT conditions can cycle when many bounds are active; this one cannot.

Source: R. T. Rockafellar, "Augmented Lagrangians and applications of the proximal point algorithm
in convex programming", Math. Oper. Res. 1 (1976), for the same step of the plain saddle-point flow,
which is his method of multipliers.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.qp.dense import (
    SUMS,
    add_outer,
    add_scaled,
    cholesky_factor,
    dot,
    factor_solve,
    rows_dot,
)
from iiwa_dnn.qp.layout import ONE, Vector, compiled, larger, offsets

LOOSE, EXACT, LOOSE_NEWTON = 0.3, 1e-3, 20
"""Slope at which a line search may end, relative to that at its start; in the first iterations,
which need no more, and after so many of them."""


@compiled
def linear_step(
    data: Vector, n: int, m: int, p: int, s: Vector, rates: Vector, active: Vector, step: float,
    factored: bool, counted: Vector, gram: Vector, K: Vector, rhs: Vector, new: Vector,
) -> bool:  # fmt: skip
    """Write the state after a linearly implicit step into `new`, like `s` of size 3n + m + p.

    `rates` and `active` are those of `field` at s. With `factored`, K holds the factor that the
    last call left, for the same step and active set. K, `rhs` and the others are scratch of the
    sizes that `condensed_matrix` states, `rhs` of size p + m + 2n.

    Returns:
        False if K is not positive definite to working precision; `new` is then meaningless.
    """
    if not factored:
        condensed_matrix(data, n, m, p, step, active, counted, gram, K)
        if not cholesky_factor(K, n):
            return False
    # The changes of the multipliers for an x that stands still, and what they leave of its rates.
    decay = step / (1.0 + step)
    for i in range(n):
        rhs[i] = rates[i]
    for j in range(p):
        new[n + j] = step * rates[n + j]
    for k in range(m + 2 * n):
        new[n + p + k] = rates[n + p + k] * (step if active[k] != 0.0 else decay)
    add_transposed(data, n, m, p, -1.0, new, rhs)
    factor_solve(K, n, rhs, new)
    rows_times(data, n, m, p, new, rhs)
    for j in range(p):
        new[n + j] += step * rhs[j]
    for k in range(m + 2 * n):
        new[n + p + k] += step * active[k] * rhs[p + k]
    for k in range(s.size):
        new[k] += s[k]
    return True


@compiled
def begin_gram(data: Vector, n: int, m: int, p: int, counted: Vector, gram: Vector) -> None:
    """Write A^T A into `gram` (n n,); no row of G is counted in it, so `counted` (m,) is zero."""
    _, _, at_A, _ = offsets(n, m, p)
    for j in range(m):
        counted[j] = 0.0
    for k in range(n * n):
        gram[k] = 0.0
    for j in range(p):
        add_outer(gram, 1.0, data, at_A + j * n, n)


@compiled
def condensed_matrix(
    data: Vector, n: int, m: int, p: int, step: float, active: Vector, counted: Vector,
    gram: Vector, K: Vector,
) -> None:  # fmt: skip
    """Write the lower half of the condensed matrix of an active set (m + 2n,) into K (n n,).

    `gram` (n n,), A^T A and the products of the rows of G in `counted` (m,), is kept from call to
    call: between two steps few rows become active or cease to be.
    """
    _, at_G, _, _ = offsets(n, m, p)
    for j in range(m):
        if active[j] != counted[j]:
            add_outer(gram, active[j] - counted[j], data, at_G + j * n, n)
            counted[j] = active[j]
    size = np.uint64(n)
    for i in range(size):
        for k in range(i + ONE):
            K[i * size + k] = data[i * size + k] + step * gram[i * size + k]
    for i in range(n):
        K[i * n + i] += 1.0 / step + step * (active[m + i] + active[m + n + i])


@compiled
def rows_times(data: Vector, n: int, m: int, p: int, x: Vector, values: Vector) -> None:
    """Write [A; G; I; -I] x into `values`, of size p + m + 2n."""
    _, at_G, at_A, _ = offsets(n, m, p)
    for j in range(p):
        values[j] = dot(data, at_A + j * n, x, n)
    if m > 0:
        rows_dot(data, at_G, m, n, x, values, p)
    for i in range(n):
        values[p + m + i] = x[i]
        values[p + m + n + i] = -x[i]


@compiled
def add_transposed(
    data: Vector, n: int, m: int, p: int, factor: float, s: Vector, out: Vector
) -> None:
    """Add factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,)."""
    _, at_G, at_A, _ = offsets(n, m, p)
    at_z, at_u = n + p, n + p + m
    for i in range(n):
        out[i] += factor * (s[at_u + i] - s[at_u + n + i])
    for j in range(p):
        add_scaled(out, factor * s[n + j], data, at_A + j * n, n)
    for j in range(m):
        if s[at_z + j] != 0.0:
            add_scaled(out, factor * s[at_z + j], data, at_G + j * n, n)


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
        rows_times(data, n, m, p, direction, change)
        length = _line_search(
            data, n, m, p, s, step, slacks, change, direction, gradient,
            LOOSE if iteration < LOOSE_NEWTON else EXACT,
        )  # fmt: skip
        for i in range(n):
            new[i] += length * direction[i]
        for k in range(rows):
            slacks[k] += length * change[k]
    # Once more from x itself: long steps would magnify the rounding of the updates.
    _slacks(data, n, m, p, new, slacks)
    _multipliers(n, m, p, s, step, slacks, new, active)
    return taken


@compiled
def _slacks(data: Vector, n: int, m: int, p: int, x: Vector, slacks: Vector) -> None:
    """Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n)."""
    _, at_G, _, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    rows_times(data, n, m, p, x, slacks)
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
    shift, rows = np.uint64(n + p), np.uint64(p)
    for k in range(np.uint64(m + 2 * n)):  # no branch: several at once
        old = s[shift + k]
        moving, kept = old + step * slacks[rows + k], old * keep
        is_active = moving > kept
        active[k] = 1.0 if is_active else 0.0
        new[shift + k] = moving if is_active else kept


@compiled
def _gradient(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, new: Vector, gradient: Vector
) -> float:
    """Write the gradient of the step's convex function; returns its largest entry."""
    rows_dot(data, 0, n, n, new, gradient, 0)
    for i in range(n):
        gradient[i] += data[n * n + i] + (new[i] - s[i]) / step
    add_transposed(data, n, m, p, 1.0, new, gradient)
    size = 0.0
    for i in range(n):
        size = larger(size, abs(gradient[i]))
    return size


@compiled
def _line_search(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, slacks: Vector, change: Vector,
    direction: Vector, gradient: Vector, accuracy: float,
) -> float:  # fmt: skip
    """Minimise the step's convex function along the Newton `direction`, to a part of its slope.

    Its derivative is continuous, increasing and piecewise linear, so a Newton iteration kept
    inside a bracket ends at the root. `change` is [A; G; I; -I] direction.
    """
    start, shortest = 0.0, 0.0
    for i in range(n):
        start += gradient[i] * direction[i]
        shortest += direction[i] * direction[i]
    # direction^T K direction is -start: that is the curvature where the active rows stay active.
    slope, second = _slope(n, m, p, s, step, slacks, change, 0.0)
    constant, curvature = start - slope, max(-start - second, shortest / step)
    low, high, length = 0.0, np.inf, 1.0
    for _ in range(50):
        slope, second = _slope(n, m, p, s, step, slacks, change, length)
        slope, second = slope + constant + length * curvature, second + curvature
        if abs(slope) <= accuracy * abs(start):
            break
        if slope > 0.0:
            high = length
        else:
            low = length
        length -= slope / second
        if not low < length < high:
            length = 0.5 * (low + high) if high < np.inf else 2.0 * low
    return length


@njit(cache=True, error_model="numpy", fastmath=SUMS)
def _slope(
    n: int, m: int, p: int, s: Vector, step: float, slacks: Vector, change: Vector, length: float
) -> tuple[float, float]:
    """Sum slope and curvature of the inequalities' part of the step's function at a length."""
    keep, slope, second = 1.0 / (1.0 + step), 0.0, 0.0
    shift = np.uint64(n)
    for k in range(np.uint64(p), np.uint64(p + m + 2 * n)):
        old, rate = s[shift + k], change[k]
        moving, kept = old + step * (slacks[k] + length * rate), old * keep
        is_active = moving > kept  # no branch: several rows at once
        slope += (moving if is_active else kept) * rate
        second += step * rate * rate if is_active else 0.0
    return slope, second
