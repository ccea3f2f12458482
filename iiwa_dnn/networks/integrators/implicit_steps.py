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
quadratic function, for every h. It has one minimiser, and a semismooth Newton iteration with a line
search reaches it; its matrix is K again. A bare Newton iteration on the KKT conditions can cycle
when many bounds are active; this one cannot.

Source: R. T. Rockafellar, "Augmented Lagrangians and applications of the proximal point algorithm
in convex programming", Math. Oper. Res. 1 (1976), for the same step of the plain saddle-point flow,
which is his method of multipliers.
"""

from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled, inlined
from iiwa_dnn.qp.dense import (
    add_outer,
    add_row,
    cholesky_factor,
    factor_solve,
    row_dot,
    rows_dot,
)
from iiwa_dnn.qp.layout import Matrix, QPViews, Vector, larger

SLOPE = 0.3
"""Slope at which a line search may end, relative to that at its start."""


class Condensed(NamedTuple):
    """Condensed matrix of a program, and scratch of the steps that solve with it.

    Attributes:
        active: 1 for each inequality of [G; I; -I] that is active, else 0, (m + 2n,).
        counted: 1 for each row of G whose product is in `gram`, (m,).
        gram: A^T A and the products of the counted rows, (n, n).
        K: Lower half of the condensed matrix, or its factor, (n, n).
        values: Values of all rows [A; G; I; -I], (p + m + 2n,).
    """

    active: Vector
    counted: Vector
    gram: Matrix
    K: Matrix
    values: Vector


@compiled
def condensed_size(qp: QPViews) -> int:
    """Count the numbers of a `Condensed`."""
    n = qp.q.size
    m = qp.h.size
    return 2 * n * n + 2 * m + 2 * n + qp.b.size + m + 2 * n


@inlined
def condensed(qp: QPViews, work: Vector) -> Condensed:
    """Lay the arrays of a program out in `work` (condensed_size,), with A^T A in `gram`."""
    n = qp.q.size
    m = qp.h.size
    at_K = n * n
    at_counted = 2 * n * n
    at_active = at_counted + m
    at_values = at_active + m + 2 * n
    matrix = Condensed(
        work[at_active:at_values],
        work[at_counted:at_active],
        work[:at_K].reshape(n, n),
        work[at_K:at_counted].reshape(n, n),
        work[at_values:],
    )
    for k in range(at_K):
        work[k] = 0.0
    for j in range(m):
        matrix.counted[j] = 0.0
    for j in range(qp.b.size):
        add_outer(matrix.gram, 1.0, qp.A, j)
    return matrix


@compiled
def build_condensed(qp: QPViews, step: float, matrix: Condensed) -> None:
    """Write the condensed matrix of the active set for a step [rho] into `matrix.K`.

    Between two steps few rows become active or cease to be, so `gram` is kept from call to call.
    """
    n = qp.q.size
    m = qp.h.size
    for j in range(m):
        if matrix.active[j] != matrix.counted[j]:
            add_outer(matrix.gram, matrix.active[j] - matrix.counted[j], qp.G, j)
            matrix.counted[j] = matrix.active[j]
    for i in range(n):
        for k in range(i + 1):
            matrix.K[i, k] = qp.P[i, k] + step * matrix.gram[i, k]
    for i in range(n):
        bounds = matrix.active[m + i] + matrix.active[m + n + i]
        matrix.K[i, i] += 1.0 / step + step * bounds


@inlined
def linear_step(
    qp: QPViews, s: Vector, rates: Vector, step: float, matrix: Condensed, new: Vector
) -> bool:
    """Write the state after a linearly implicit step [rho] into `new`, like `s` (3n + m + p,).

    `rates` and `matrix.active` are those at s.

    Returns:
        False if K is not positive definite to working precision; `new` is then meaningless.
    """
    n = qp.q.size
    p = qp.b.size
    active = matrix.active
    values = matrix.values
    build_condensed(qp, step, matrix)
    if not cholesky_factor(matrix.K):
        return False
    # The changes of the multipliers while x stays, and what they leave of its rates.
    decay = step / (1.0 + step)
    for i in range(n):
        values[i] = rates[i]
    for j in range(p):
        new[n + j] = step * rates[n + j]
    for k in range(active.size):
        new[n + p + k] = rates[n + p + k] * (step if active[k] != 0.0 else decay)
    add_transposed(qp, -1.0, new, values)
    factor_solve(matrix.K, values, new)
    rows_times(qp, new, values)
    for j in range(p):
        new[n + j] += step * values[j]
    for k in range(active.size):
        new[n + p + k] += step * active[k] * values[p + k]
    for k in range(s.size):
        new[k] += s[k]
    return True


@compiled
def rows_times(qp: QPViews, x: Vector, values: Vector) -> None:
    """Write [A; G; I; -I] x into `values`, of size p + m + 2n."""
    n = qp.q.size
    p = qp.b.size
    first = p + qp.h.size
    for j in range(p):
        values[j] = row_dot(qp.A, j, x)
    rows_dot(qp.G, x, values, p)
    for i in range(n):
        values[first + i] = x[i]
        values[first + n + i] = -x[i]


@compiled
def add_transposed(qp: QPViews, factor: float, s: Vector, out: Vector) -> None:
    """Add factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,)."""
    n = qp.q.size
    p = qp.b.size
    at_z = n + p
    at_u = at_z + qp.h.size
    for i in range(n):
        out[i] += factor * (s[at_u + i] - s[at_u + n + i])
    for j in range(p):
        add_row(out, factor * s[n + j], qp.A, j)
    for j in range(qp.h.size):
        if s[at_z + j] != 0.0:
            add_row(out, factor * s[at_z + j], qp.G, j)


@compiled
def copy_into(out: Vector, values: Vector) -> None:
    """Copy all values (k,) into the first entries of `out`."""
    for k in range(values.size):
        out[k] = values[k]


@compiled
def backward_euler(
    qp: QPViews,
    s: Vector,
    step: float,
    new: Vector,
    tol: float,
    max_newton: int,
    matrix: Condensed,
) -> int:
    """Solve new = s + step F(new) for `new` (3n + m + p,), the iteration starting at s.

    The iteration stops after its first round if the gradient is at most `tol` or lost in rounding,
    and after `max_newton` rounds.

    Returns:
        Newton iterations, or -1 if a matrix was not positive definite to working precision.
    """
    n = qp.q.size
    rows = matrix.values.size
    gradient = np.empty(n)
    direction = np.empty(n)
    slacks = np.empty(rows)
    copy_into(new, s)
    _slacks(qp, new, slacks)
    # A slack is known to its rounding, and its multiplier to `step` times that.
    largest = 1.0
    for i in range(n):
        largest = max(largest, abs(new[i]))
    floor = 1e-15 * step * largest
    taken = max_newton
    for iteration in range(max_newton):
        _multipliers(qp, s, step, slacks, new, matrix.active)
        size = _gradient(qp, s, step, new, gradient)
        if iteration > 0 and not size > max(tol, floor):
            taken = iteration
            break
        build_condensed(qp, step, matrix)
        if not cholesky_factor(matrix.K):
            return -1
        factor_solve(matrix.K, gradient, direction)
        for i in range(n):
            direction[i] = -direction[i]
        rows_times(qp, direction, matrix.values)
        length = _line_search(qp, s, step, slacks, matrix.values, direction, gradient)
        for i in range(n):
            new[i] += length * direction[i]
        for k in range(rows):
            slacks[k] += length * matrix.values[k]
    # Once more from x itself: long steps would magnify the rounding of the updates.
    _slacks(qp, new, slacks)
    _multipliers(qp, s, step, slacks, new, matrix.active)
    return taken


@compiled
def _slacks(qp: QPViews, x: Vector, slacks: Vector) -> None:
    """Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n)."""
    n = qp.q.size
    p = qp.b.size
    first = p + qp.h.size
    rows_times(qp, x, slacks)
    for j in range(p):
        slacks[j] -= qp.b[j]
    for j in range(qp.h.size):
        slacks[p + j] -= qp.h[j]
    for i in range(n):
        slacks[first + i] -= qp.ub[i]
        slacks[first + n + i] += qp.lb[i]


@compiled
def _multipliers(
    qp: QPViews, s: Vector, step: float, slacks: Vector, new: Vector, active: Vector
) -> None:
    """Write the multipliers after a step to x with these slacks, and mark those that are active."""
    n = qp.q.size
    p = qp.b.size
    keep = 1.0 / (1.0 + step)
    for j in range(p):
        new[n + j] = s[n + j] + step * slacks[j]
    shift = n + p
    rows = p
    for k in range(active.size):  # no branch: several at once
        old = s[shift + k]
        moving = old + step * slacks[rows + k]
        kept = old * keep
        is_active = moving > kept
        active[k] = 1.0 if is_active else 0.0
        new[shift + k] = moving if is_active else kept


@compiled
def _gradient(qp: QPViews, s: Vector, step: float, new: Vector, gradient: Vector) -> float:
    """Write the gradient of the step's convex function; returns its largest entry."""
    rows_dot(qp.P, new, gradient, 0)
    for i in range(qp.q.size):
        gradient[i] += qp.q[i] + (new[i] - s[i]) / step
    add_transposed(qp, 1.0, new, gradient)
    size = 0.0
    for i in range(qp.q.size):
        size = larger(size, abs(gradient[i]))
    return size


@compiled
def _line_search(
    qp: QPViews,
    s: Vector,
    step: float,
    slacks: Vector,
    change: Vector,
    direction: Vector,
    gradient: Vector,
) -> float:
    """Minimize the step's convex function along the Newton `direction`, to `SLOPE`.

    Its derivative is continuous, increasing and piecewise linear, so a Newton iteration kept
    inside a bracket ends at the root. `change` is [A; G; I; -I] direction.
    """
    n = qp.q.size
    p = qp.b.size
    start = 0.0
    shortest = 0.0
    for i in range(n):
        start += gradient[i] * direction[i]
        shortest += direction[i] * direction[i]
    # direction^T K direction is -start: that is the curvature where the active rows stay active.
    slope, second = _slope(n, p, s, step, slacks, change, 0.0)
    constant = start - slope
    curvature = max(-start - second, shortest / step)
    low = 0.0
    high = np.inf
    length = 1.0
    for _ in range(50):
        slope, second = _slope(n, p, s, step, slacks, change, length)
        slope = slope + constant + length * curvature
        second += curvature
        if abs(slope) <= SLOPE * abs(start):
            break
        if slope > 0.0:
            high = length
        else:
            low = length
        length -= slope / second
        if not low < length < high:
            length = 0.5 * (low + high) if high < np.inf else 2.0 * low
    return length


@compiled
def _slope(
    n: int, p: int, s: Vector, step: float, slacks: Vector, change: Vector, length: float
) -> tuple[float, float]:
    """Sum slope and curvature of the inequalities' part of the step's function at a length."""
    keep = 1.0 / (1.0 + step)
    slope = 0.0
    second = 0.0
    shift = n
    for k in range(p, slacks.size):
        old = s[shift + k]
        rate = change[k]
        moving = old + step * (slacks[k] + length * rate)
        kept = old * keep
        is_active = moving > kept  # no branch: several rows at once
        slope += (moving if is_active else kept) * rate
        second += step * rate * rate if is_active else 0.0
    return slope, second
