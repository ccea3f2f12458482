r"""Fallback programs, which have a solution where a step's nominal program has none.

Each is the nominal program (P, q, G, h, A, b, lb, ub) with a stated change, and is handed out,
recorded and checked as it was answered (docs/robustness.md builds both from `Scheme.build_qp`).

The **scaled program** asks for a fraction of the task velocity, the limits and the cost as they
are:

.. math::

    \min_x \; \tfrac12 x^T P x + q^T x \quad \text{with} \quad
    A x = s\,b, \quad G x \le h, \quad lb \le x \le ub .

The largest feasible s is the scaling factor. It is found with one more variable, the speed
:math:`\sigma` along :math:`b / \beta`, :math:`\beta = \|b\|_\infty`: with the cost
:math:`-\sigma` plus w times the step's own, and :math:`0 \le \sigma \le \beta`.

The **relaxed program** moves the task into the cost, with the weights W of its rows,

.. math::

    \min_x \; \tfrac12 \|W (A x - b)\|^2 + \tfrac12 \lambda^2 \|x - v_0\|^2
        + \tfrac12 \varepsilon\, x^T P x \quad \text{with} \quad
    G x \le h', \quad lb \le x \le ub ,

damped by :math:`\lambda` towards a slow drift :math:`v_0` along -q. Its task rows are zero, so that
the sizes stay. A scheme without a task keeps its cost. A row that asks for motion, h < 0, asks
for :math:`h' = \tau h` with the largest feasible :math:`\tau \le 1`, found as s is.

Rows of joints that follow others have the weight 0: they are limits, and both programs keep them.
Where the joints are off their relation and the way back is too quick, it is :math:`\tau` of it.

Sources: O. L. Mangasarian, R. R. Meyer, "Nonlinear perturbation of linear programs", SIAM J.
Control and Optimization 17 (1979), for the exactness of the factors; Y. Nakamura, H. Hanafusa,
"Inverse kinematic solutions with singularity robustness for robot manipulator control", J. Dynamic
Systems, Measurement, and Control 108 (1986), for the damping.
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.networks.integrators.base import SolveStats
from iiwa_dnn.networks.integrators.implicit import solve_within
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry, row_dot
from iiwa_dnn.qp.layout import IntVector, QPViews, Sizes, copied, data_size, qp_views
from iiwa_dnn.qp.residuals import cost_size, within
from iiwa_dnn.schemes.program import add_soft
from iiwa_dnn.schemes.rate_limits import MotionConstants

MAX_LINEAR_SOLVES = 60
"""Linear solves after which a program counts as one without a solution."""

PENALTY = 1e-5
"""w, for a cost whose largest entry is one."""

FEASIBLE = 1.0 - 1e-9
"""Factor from which on the whole task counts as feasible."""

ALMOST = 0.999
"""Fraction of the largest factor that is used: at the boundary of the feasible set the multipliers
may be unbounded."""

RETREAT = 1e-7
"""Lower bound on the tolerance of the search for tau: if a link's end can hardly retreat, its row
is nearly
zero, and full accuracy would exceed the budget of linear solves."""

DAMPING = 0.05
"""Lambda of the relaxed program [m/rad]."""

BLEND = 1e-4
"""Epsilon: weight of the scheme's own cost in the relaxed program."""

DRIFT = 0.02
"""Largest joint speed [rad/s] of the drift towards the posture that the cost prefers. Without it an
arm pulled beyond its reach rests exactly stretched, and leaves that posture too late."""

FASTEST = 10.0
"""Task velocity [m/s] to which a larger one is cut in the relaxed program: no arm is so quick."""

REACHED = 1e-9
"""Difference of two velocities that is rounding [rad/s], or of a row's right-hand side from 0."""

LIMITING = 1e-4
"""Multiplier, relative to the largest, above which a bound or row counts as limiting."""


class Yielding(NamedTuple):
    """Constants of the fallback programs of a scheme.

    Attributes:
        weights: Weight of each task row, (p,); 0 for a row that is a limit.
        limits: Acceleration and jerk limits; of no joints where there are none.
        tolerance: Tolerance of the answers.
        rates: Block of these limits; -1: there is none.
        scenes: Blocks of the scenes that braking keeps away from, (scenes,).
        cubic: Whether the jerk of a joint is limited.
        coupled: Whether joints follow others.
        alike: Whether the network of the steps is that of the fallback programs.
    """

    weights: Vector
    limits: MotionConstants
    tolerance: float
    rates: int
    scenes: IntVector
    cubic: bool
    coupled: bool
    alike: bool


def fallback_size(sizes: Sizes) -> int:
    """Return the size of the network states of a step's fallback programs.

    They are of the search of the scaling factor, which has one variable more, and of the program
    that is answered.
    """
    n, m, p = sizes
    return (3 * n + 3 + m + p) + (3 * n + m + p)


@compiled
def solve_warm(qp: QPViews, tol: float, state: Vector, point: Vector, stats: SolveStats) -> bool:
    """Solve the program by the network from its last state or, if need be, from a cold start.

    Args:
        qp: The program.
        tol: Tolerance.
        state: Its state, (size,), advanced; where it does not converge, cold again.
        point: The point that the state stands for, (2 n + m + p,), overwritten.
        stats: Statistics of the step's answer: the linear solves are added, the time is
            overwritten.

    Returns:
        Whether the point is the program's solution.
    """
    for _ in range(2):
        linear_solves, time, primal, dual, gap = solve_within(
            qp, tol, MAX_LINEAR_SOLVES, state, point
        )
        stats.iterations += linear_solves
        stats.time = time
        if within(primal, dual, gap, tol):
            return True
        state[:] = 0.0
    return False


@compiled
def largest_factor(
    qp: QPViews, yielding: Yielding, state: Vector, point: Vector, stats: SolveStats, retreats: bool
) -> float:
    """Compute the largest factor of the task, or of the retreat, that the limits allow.

    Args:
        qp: The step's program, of n variables, m inequality and p equality rows.
        yielding: Which rows are the task's, and how the network converges.
        state: State of the network that solves it, (3 n + 3 + m + p,), advanced.
        point: Point of the program with the factor as the last variable, (2 n + 2 + m + p,),
            overwritten.
        stats: Statistics of the step's answer, as of `solve_warm`.
        retreats: Whether the factor is that of what limits ask for, negative right-hand sides h and
            those of joints that follow others, without the task; else it is the scaling factor of
            the task.

    Returns:
        1, or `ALMOST` the factor in [0, 1]; -1 if not even 0 is feasible, or the network does not
        converge.
    """
    n = qp.q.size
    data = np.zeros(data_size(n + 1, qp.h.size, qp.b.size))
    wider = qp_views(data, n + 1, qp.h.size, qp.b.size)
    _copy_cost(qp, wider)
    _copy_limits(qp, wider)
    longest = _longest_asked(qp, yielding.weights, retreats)
    wider.q[n] = -1.0
    wider.ub[n] = longest
    for j in range(qp.h.size):
        if retreats and qp.h[j] < 0.0:
            wider.G[j, n] = -qp.h[j] / longest
            wider.h[j] = 0.0
    for j in range(qp.b.size):
        if yielding.weights[j] == 0.0 or not retreats:
            copied(wider.A[j], qp.A[j])
        if (yielding.weights[j] == 0.0) == retreats:
            wider.A[j, n] = -qp.b[j] / longest
        elif not retreats:
            wider.b[j] = qp.b[j]
    tol = max(yielding.tolerance, RETREAT) if retreats else yielding.tolerance
    if not solve_warm(wider, tol, state, point, stats):
        return -1.0
    factor: float = max(point[n] / longest, 0.0)
    return 1.0 if factor >= FEASIBLE else ALMOST * factor


@compiled
def _longest_asked(qp: QPViews, weights: Vector, retreats: bool) -> float:
    """Return the largest velocity that tasks, or limits, ask for; 1 if there is none.

    In this unit the factor's column is near one, though a retreat may be of a nanometre.
    """
    longest = 0.0
    for j in range(qp.b.size):
        if not retreats or weights[j] == 0.0:
            longest = max(longest, abs(qp.b[j]))
    for j in range(qp.h.size):
        longest = max(longest, -qp.h[j]) if retreats else longest
    return longest if longest > 0.0 else 1.0


@compiled
def _copy_cost(qp: QPViews, other: QPViews) -> None:
    """Write w times the cost into a program that has more variables."""
    n = qp.q.size
    weight = PENALTY / max(cost_size(qp), PENALTY)
    for i in range(n):
        other.q[i] = weight * qp.q[i]
        for k in range(n):
            other.P[i, k] = weight * qp.P[i, k]


@compiled
def _copy_limits(qp: QPViews, other: QPViews) -> None:
    """Write bounds and inequality rows into a program that may have more variables."""
    copied(other.lb, qp.lb)
    copied(other.ub, qp.ub)
    copied(other.h, qp.h)
    for j in range(qp.h.size):
        copied(other.G[j], qp.G[j])


@compiled
def scale_task(qp: QPViews, weights: Vector, factor: float) -> None:
    """Turn a step's program, with task rows of some weights (p,), into the scaled one."""
    for j in range(qp.b.size):
        if weights[j] > 0.0:
            qp.b[j] *= factor


@compiled
def relax_task(qp: QPViews, weights: Vector, retreat: float) -> None:
    """Turn a step's program, with weights (p,) of its rows, into the relaxed one.

    Its tau is `retreat`, for rows h < 0 and those of joints that follow others.
    """
    n = qp.q.size
    shrink = FASTEST / max(FASTEST, largest_entry(qp.b))
    drift = DRIFT / max(largest_entry(qp.q), 1.0)
    for i in range(n if largest_entry(weights) > 0.0 else 0):  # else the cost is what is asked for
        qp.q[i] *= DAMPING * DAMPING * drift
        for k in range(n):
            qp.P[i, k] *= BLEND
        qp.P[i, i] += DAMPING * DAMPING
    for j in range(qp.b.size):
        if weights[j] > 0.0:
            qp.b[j] *= shrink
            add_soft(qp.P, qp.q, qp.A[j : j + 1], qp.b[j : j + 1], weights[j] * weights[j])
            qp.A[j, :] = 0.0
            qp.b[j] = 0.0
        else:
            qp.b[j] *= retreat
    for j in range(qp.h.size):
        if qp.h[j] < 0.0:
            qp.h[j] *= retreat


@compiled
def note_limiting(point: Vector, n: int, m: int, extra: int, limiting: Vector) -> None:
    """Note which bounds and rows limit a program.

    Args:
        point: Its solution, ``[x | y | z | z_box]`` with `extra` more variables than n.
        n: Number of the step's variables.
        m: Number of inequality rows.
        extra: Number of further variables.
        limiting: For each variable the sign of its bound's multiplier, and for each row 1 where its
            multiplier counts, (n + m,), overwritten.
    """
    start = point.size - n - extra - m
    multipliers = point[start : start + m + n]
    least = LIMITING * largest_entry(multipliers)
    for i in range(n + m):
        value = multipliers[m + i if i < n else i - n]
        limiting[i] = math.copysign(1.0, value) if abs(value) > least else 0.0


@compiled
def nearest_within(qp: QPViews, x: Vector, yielding: Yielding, stats: SolveStats) -> bool:
    """Project x (n,) on the bounds of a program and, if that violates rows, on its rows too.

    The rows of joints that follow others hold as well, if the bounds allow it. The statistics are
    those of `solve_warm`.

    Returns:
        False if the inequality rows contradict the bounds: x is then within the bounds.
    """
    if yielding.coupled and _move_within(qp, x, yielding, stats, qp.b.size):
        return True
    outside = 0
    for i in range(x.size):
        x[i] = min(max(x[i], qp.lb[i]), qp.ub[i])
    for j in range(qp.h.size):
        outside += row_dot(qp.G, j, x) > qp.h[j]
    return outside == 0 or _move_within(qp, x, yielding, stats, 0)


@compiled
def _move_within(
    qp: QPViews, x: Vector, yielding: Yielding, stats: SolveStats, equalities: int
) -> bool:
    """Project x (n,) on bounds and rows, and on the limits among the first equalities."""
    n = x.size
    m = qp.h.size
    data = np.zeros(data_size(n, m, equalities))
    nearest = qp_views(data, n, m, equalities)
    for i in range(n):
        nearest.P[i, i] = 1.0
        nearest.q[i] = -x[i]
    for j in range(equalities):
        if yielding.weights[j] == 0.0:
            copied(nearest.A[j], qp.A[j])
            nearest.b[j] = _rate_within(qp, j, x)
    _copy_limits(qp, nearest)
    point = np.empty(2 * n + m + equalities)
    state = np.zeros(3 * n + m + equalities)
    found = solve_warm(nearest, yielding.tolerance, state, point, stats)
    # Bounds that are off by rounding may contradict the equalities: as near as they allow, then.
    if found or (equalities > 0 and all_finite(point, 0, n)):
        copied(x, point[:n])
    return found


@compiled
def _rate_within(qp: QPViews, j: int, x: Vector) -> float:
    """Return the right-hand side of equality row j; if no bound admits it, the rate of x (n,)."""
    lowest = 0.0
    highest = 0.0
    for i in range(x.size):
        if qp.A[j, i] != 0.0:
            lowest += min(qp.A[j, i] * qp.lb[i], qp.A[j, i] * qp.ub[i])
            highest += max(qp.A[j, i] * qp.lb[i], qp.A[j, i] * qp.ub[i])
    rate = float(qp.b[j])
    if not lowest - REACHED <= rate <= highest + REACHED:
        rate = min(max(row_dot(qp.A, j, x), lowest), highest)
    return rate


@compiled
def attained(b: Vector, A: Matrix, weights: Vector, x: Vector) -> float:
    """Compute the fraction of a task velocity b (p,) that joint velocities x (n,) give."""
    asked = 0.0
    given = 0.0
    for j in range(b.size):
        rhs = weights[j] * weights[j] * b[j]
        asked += rhs * b[j]
        given += rhs * row_dot(A, j, x)
    return min(given / asked, 1.0) if asked > 0.0 else 1.0
