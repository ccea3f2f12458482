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

A multiplier is known to the rounding of its slack times h. So within a step the slacks are changed
along with x, and are not computed anew from it: gradient and multipliers then agree to their own
rounding, and what the slacks lack is left to the next step.

Source: R. T. Rockafellar, "Augmented Lagrangians and applications of the proximal point algorithm
in convex programming", Math. Oper. Res. 1 (1976), for the same step of the plain saddle-point flow,
which is his method of multipliers.
"""

from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.networks.projection import add_transposed, rows_times, write_slacks
from iiwa_dnn.qp.dense import (
    add_multiple,
    add_outer,
    cholesky_factor,
    dot,
    factor_solve,
    largest_entry,
    times,
    weighted_sum,
)
from iiwa_dnn.qp.layout import Matrix, QPViews, Vector, copied

SLOPE = 0.5
"""Slope at which a line search may end, relative to that at its start."""


class Condensed(NamedTuple):
    """Condensed matrix of a program with R = p + m + 2n rows [A; G; I; -I], and scratch.

    Attributes:
        active: 1 for each row that is active, as equalities are, else 0, (R,).
        counted: 1 for each row of [A; G] whose product is in `gram`, (p + m,).
        gram: Products of the counted rows, (n, n).
        K: Upper half of the condensed matrix, or its factor, (n, n).
        values: Values of all rows, (R,).
        spans: Where the entries of the rows of G are (`write_spans`), (2m,).
    """

    active: Vector
    counted: Vector
    gram: Matrix
    K: Matrix
    values: Vector
    spans: Vector


@compiled
def build_condensed(qp: QPViews, step: float, matrix: Condensed) -> None:
    """Write the condensed matrix of the active set for a step [rho] into `matrix.K`."""
    n = qp.q.size
    first = matrix.counted.size
    p = qp.b.size
    m = qp.h.size
    for j in range(p):
        _count_row(matrix, j, qp.A[j], 0)
    for j in range(m):
        begin = int(matrix.spans[j])
        _count_row(matrix, p + j, qp.G[j, begin : int(matrix.spans[m + j])], begin)
    for i in range(n):
        weighted_sum(qp.P[i, i:], step, matrix.gram[i, i:], matrix.K[i, i:])
        bounds = matrix.active[first + i] + matrix.active[first + n + i]
        matrix.K[i, i] += 1.0 / step + step * bounds


@compiled
def _count_row(matrix: Condensed, j: int, row: Vector, start: int) -> None:
    """Add the product of row j of [A; G] to `gram` if it became active; subtract it if it left.

    Its entries (k,) stand at `start`. Few rows change between two steps.
    """
    change = matrix.active[j] - matrix.counted[j]
    if change != 0.0:
        add_outer(matrix.gram, change, row, start)
        matrix.counted[j] += change


@compiled
def linear_step(
    qp: QPViews,
    s: Vector,
    rates: Vector,
    step: float,
    matrix: Condensed,
    is_factored: bool,
    new: Vector,
) -> bool:
    """Write the state after a linearly implicit step [rho] into `new`, like `s` (3n + m + p,).

    `rates` and `matrix.active` are those at s. If `is_factored`, `matrix.K` holds the factor.

    Returns:
        False if K is not positive definite to working precision; `new` is then meaningless.
    """
    n = qp.q.size
    active = matrix.active
    values = matrix.values
    if not is_factored:
        build_condensed(qp, step, matrix)
        if not cholesky_factor(matrix.K):
            return False
    # The changes of the multipliers while x stays, and what they leave of its rates.
    decay = step / (1.0 + step)
    copied(values, rates[:n])
    for k in range(active.size):
        new[n + k] = rates[n + k] * (step if active[k] != 0.0 else decay)
    add_transposed(qp, matrix.spans, -1.0, new, values)
    factor_solve(matrix.K, values, new)
    rows_times(qp, matrix.spans, new, values)
    for k in range(active.size):
        new[n + k] += step * active[k] * values[k]
    add_multiple(new, 1.0, s)
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
    """Solve new = s + step F(new) for `new` (3n + m + p,).

    The iteration starts at s, and first goes towards the x that `new` holds before, if that is
    downhill. After at least one linear solve, it stops as soon as the gradient of the step's own
    minimisation is at most `tol` or lost in rounding; at the latest after `max_newton` of them.

    Returns:
        Linear solves; minus their number if the last matrix was not positive definite to working
        precision.
    """
    n = qp.q.size
    cost = np.empty(n)
    curved = np.empty(n)
    direction = np.empty(n)
    descent = np.empty(n)
    slacks = np.empty(matrix.values.size)
    weighted_sum(new[:n], -1.0, s[:n], direction)
    copied(new, s)
    times(qp.P, new, cost)
    add_multiple(cost, 1.0, qp.q)
    write_slacks(qp, matrix.spans, new, slacks)
    _multipliers(qp, s, step, slacks, new, matrix.active)
    size = _descent(qp, matrix.spans, cost, new, descent)
    is_known = dot(0.0, direction, descent) > 0.0
    taken = 0
    while taken < max_newton:
        if not is_known:
            build_condensed(qp, step, matrix)
            taken += 1
            if not cholesky_factor(matrix.K):
                return -taken
            factor_solve(matrix.K, descent, direction)
        is_known = False
        rows_times(qp, matrix.spans, direction, matrix.values)
        times(qp.P, direction, curved)
        add_multiple(curved, 1.0 / step, direction)
        length = _line_search(
            s[n:],
            step,
            qp.b.size,
            slacks,
            matrix.values,
            dot(0.0, direction, descent),
            dot(0.0, direction, cost),
            dot(0.0, direction, curved),
        )
        add_multiple(new, length, direction)
        add_multiple(cost, length, curved)
        add_multiple(slacks, length, matrix.values)
        changed = _multipliers(qp, s, step, slacks, new, matrix.active)
        last = size
        size = _descent(qp, matrix.spans, cost, new, descent)
        if taken > 0 and (not size > tol or (changed == 0 and size > 0.5 * last)):
            break
    return taken


@compiled
def _multipliers(
    qp: QPViews, s: Vector, step: float, slacks: Vector, new: Vector, active: Vector
) -> int:
    """Write the multipliers after a step to an x with these slacks; mark the active rows.

    Returns:
        Number of rows that became active or ceased to be.
    """
    n = qp.q.size
    p = qp.b.size
    keep = 1.0 / (1.0 + step)
    changed = 0
    for k in range(active.size):  # no branch: several at once
        moving = s[n + k] + step * slacks[k]
        kept = s[n + k] * keep
        is_active = k < p or moving > kept
        now = 1.0 if is_active else 0.0
        changed += 1 if now != active[k] else 0
        active[k] = now
        new[n + k] = moving if is_active else kept
    return changed


@compiled
def _descent(qp: QPViews, spans: Vector, cost: Vector, new: Vector, descent: Vector) -> float:
    """Write minus the gradient (n,) of the function that a step minimizes at `new`.

    `cost` (n,) is the gradient without the rows' part.

    Returns:
        The largest absolute entry.
    """
    for i in range(qp.q.size):
        descent[i] = -cost[i]
    add_transposed(qp, spans, -1.0, new, descent)
    return largest_entry(descent)


@compiled
def _line_search(
    multipliers: Vector,
    step: float,
    p: int,
    slacks: Vector,
    change: Vector,
    fall: float,
    rate: float,
    curvature: float,
) -> float:
    """Minimize the function of a step along a direction that is downhill, to `SLOPE`.

    The derivative along the direction is continuous, increasing and piecewise linear, so a Newton
    iteration kept inside a bracket ends at the root.

    Args:
        multipliers: Multipliers at the start of the step, (p + m + 2n,).
        step: Length of the step [rho].
        p: Number of equality rows, the first ones.
        slacks: Slacks of the rows, (p + m + 2n,).
        change: Rates of the slacks, [A; G; I; -I] direction, (p + m + 2n,).
        fall: Minus the slope at the start.
        rate: Slope of the cost at the start.
        curvature: Curvature of the cost along the direction.

    Returns:
        The step length.
    """
    low = 0.0
    high = np.inf
    length = 1.0
    for _ in range(50):
        slope, second = _slope(multipliers, step, p, slacks, change, length)
        slope += rate + length * curvature
        second += curvature
        if abs(slope) <= SLOPE * fall:
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
    multipliers: Vector, step: float, p: int, slacks: Vector, change: Vector, length: float
) -> tuple[float, float]:
    """Sum the rows' part of slope and curvature of a step's function at a step length."""
    keep = 1.0 / (1.0 + step)
    slope = 0.0
    second = 0.0
    for k in range(slacks.size):
        rate = change[k]
        moving = multipliers[k] + step * (slacks[k] + length * rate)
        kept = multipliers[k] * keep
        is_active = k < p or moving > kept  # no branch: several rows at once
        slope += (moving if is_active else kept) * rate
        second += step * rate * rate if is_active else 0.0
    return slope, second
