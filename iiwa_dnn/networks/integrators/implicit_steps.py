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

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.networks.projection import add_transposed, rows_times, write_slacks
from iiwa_dnn.qp.dense import add_outer, cholesky_factor, factor_solve, times
from iiwa_dnn.qp.layout import Matrix, QPViews, Vector, copied, larger

SLOPE = 0.3
"""Slope at which a line search may end, relative to that at its start."""


class Condensed(NamedTuple):
    """Condensed matrix of a program with R = p + m + 2n rows [A; G; I; -I], and scratch.

    Attributes:
        active: 1 for each row that is active, as equalities are, else 0, (R,).
        counted: 1 for each row of [A; G] whose product is in `gram`, (p + m,).
        gram: Products of the counted rows, (n, n).
        K: Upper half of the condensed matrix, or its factor, (n, n).
        values: Values of all rows, (R,).
    """

    active: Vector
    counted: Vector
    gram: Matrix
    K: Matrix
    values: Vector


@compiled
def build_condensed(qp: QPViews, step: float, matrix: Condensed) -> None:
    """Write the condensed matrix of the active set for a step [rho] into `matrix.K`."""
    n = qp.q.size
    first = matrix.counted.size
    _count_rows(matrix, qp.A, 0)
    _count_rows(matrix, qp.G, qp.b.size)
    for i in range(n):
        for k in range(i, n):
            matrix.K[i, k] = qp.P[i, k] + step * matrix.gram[i, k]
        bounds = matrix.active[first + i] + matrix.active[first + n + i]
        matrix.K[i, i] += 1.0 / step + step * bounds


@compiled
def _count_rows(matrix: Condensed, rows: Matrix, first: int) -> None:
    """Add the products of rows (k, n) that became active to `gram`; subtract those that left.

    `first` is the index of the first row in `active`. Few rows change between two steps.
    """
    for j in range(rows.shape[0]):
        change = matrix.active[first + j] - matrix.counted[first + j]
        if change != 0.0:
            add_outer(matrix.gram, change, rows, j)
            matrix.counted[first + j] += change


@compiled
def linear_step(
    qp: QPViews, s: Vector, rates: Vector, step: float, matrix: Condensed, new: Vector
) -> bool:
    """Write the state after a linearly implicit step [rho] into `new`, like `s` (3n + m + p,).

    `rates` and `matrix.active` are those at s.

    Returns:
        False if K is not positive definite to working precision; `new` is then meaningless.
    """
    n = qp.q.size
    active = matrix.active
    values = matrix.values
    build_condensed(qp, step, matrix)
    if not cholesky_factor(matrix.K):
        return False
    # The changes of the multipliers while x stays, and what they leave of its rates.
    decay = step / (1.0 + step)
    for i in range(n):
        values[i] = rates[i]
    for k in range(active.size):
        new[n + k] = rates[n + k] * (step if active[k] != 0.0 else decay)
    add_transposed(qp, -1.0, new, values)
    factor_solve(matrix.K, values, new)
    rows_times(qp, new, values)
    for k in range(active.size):
        new[n + k] += step * active[k] * values[k]
    for k in range(s.size):
        new[k] += s[k]
    return True


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

    After at least one round, it stops as soon as the gradient of the step's own minimisation is at
    most `tol` or lost in rounding; at the latest after `max_newton` rounds.

    Returns:
        Newton iterations; minus their number if the last matrix was not positive definite to
        working precision.
    """
    n = qp.q.size
    descent = np.empty(n)
    direction = np.empty(n)
    slacks = np.empty(matrix.values.size)
    copied(new, s)
    # A slack is known to its rounding, and its multiplier to `step` times that.
    largest = 1.0
    for i in range(n):
        largest = max(largest, abs(new[i]))
    floor = 1e-15 * step * largest
    write_slacks(qp, new, slacks)
    taken = 0
    while taken < max_newton:
        _multipliers(qp, s, step, slacks, new, matrix.active)
        size = _descent(qp, s, step, new, descent)
        if taken > 0 and not size > max(tol, floor):
            break
        build_condensed(qp, step, matrix)
        taken += 1
        if not cholesky_factor(matrix.K):
            return -taken
        factor_solve(matrix.K, descent, direction)
        rows_times(qp, direction, matrix.values)
        length = _line_search(qp, s, step, slacks, matrix.values, direction, descent)
        for i in range(n):
            new[i] += length * direction[i]
        for k in range(slacks.size):
            slacks[k] += length * matrix.values[k]
    # Once more from x itself: long steps would magnify the rounding of the updates.
    write_slacks(qp, new, slacks)
    _multipliers(qp, s, step, slacks, new, matrix.active)
    return taken


@compiled
def _multipliers(
    qp: QPViews, s: Vector, step: float, slacks: Vector, new: Vector, active: Vector
) -> None:
    """Write the multipliers after a step to an x with these slacks; mark the active rows."""
    n = qp.q.size
    p = qp.b.size
    keep = 1.0 / (1.0 + step)
    for k in range(active.size):  # no branch: several at once
        moving = s[n + k] + step * slacks[k]
        kept = s[n + k] * keep
        is_active = k < p or moving > kept
        active[k] = 1.0 if is_active else 0.0
        new[n + k] = moving if is_active else kept


@compiled
def _descent(qp: QPViews, s: Vector, step: float, new: Vector, descent: Vector) -> float:
    """Write minus the gradient (n,) of the function that a step minimizes at `new`.

    Returns:
        The largest absolute entry.
    """
    size = 0.0
    times(qp.P, new, descent)
    for i in range(qp.q.size):
        descent[i] = -(descent[i] + (qp.q[i] + (new[i] - s[i]) / step))
    add_transposed(qp, -1.0, new, descent)
    for i in range(qp.q.size):
        size = larger(size, abs(descent[i]))
    return size


@compiled
def _line_search(
    qp: QPViews,
    s: Vector,
    step: float,
    slacks: Vector,
    change: Vector,
    direction: Vector,
    descent: Vector,
) -> float:
    """Minimize the function of a step along the Newton `direction` (n,), to `SLOPE`.

    The derivative along the direction is continuous, increasing and piecewise linear, so a Newton
    iteration kept inside a bracket ends at the root. `change` is [A; G; I; -I] direction, and
    `descent` minus the gradient at the start.

    Returns:
        The step length.
    """
    n = qp.q.size
    p = qp.b.size
    start = 0.0
    shortest = 0.0
    for i in range(n):
        start -= descent[i] * direction[i]
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
    """Sum the inequalities' part of slope and curvature of a step's function at a step length."""
    keep = 1.0 / (1.0 + step)
    slope = 0.0
    second = 0.0
    for k in range(p, slacks.size):
        rate = change[k]
        moving = s[n + k] + step * (slacks[k] + length * rate)
        kept = s[n + k] * keep
        is_active = moving > kept  # no branch: several rows at once
        slope += (moving if is_active else kept) * rate
        second += step * rate * rate if is_active else 0.0
    return slope, second
