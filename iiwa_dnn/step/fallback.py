r"""Fallback programs: changes of a step's nominal program that relax its task, not its limits.

Both start from the nominal program (P, q, G, h, A, b, lb, ub). `Command.qp` and the record hold the
changed program, in which the answer is checked (docs/robustness.md builds both programs from
`Scheme.build_qp`).

The **scaled program** scales the task velocity b by s and keeps the limits and the cost:

.. math::

    \min_x \; \tfrac12 x^T P x + q^T x \quad \text{with} \quad
    A x = s\,b, \quad G x \le h, \quad lb \le x \le ub .

The largest feasible s in [0, 1] is the scaling factor. It is computed by a program with one more
variable, the speed :math:`\sigma = s \beta` with :math:`\beta = \|b\|_\infty`, whose cost is
:math:`-\sigma` plus w times the nominal cost, for :math:`0 \le \sigma \le \beta`.

The **relaxed program** moves the task into the cost, with the weights W of its rows,

.. math::

    \min_x \; \tfrac12 \|W (A x - b)\|^2 + \tfrac12 \lambda^2 \|x - v_0\|^2
        + \tfrac12 \varepsilon\, x^T P x \quad \text{with} \quad
    G x \le h', \quad lb \le x \le ub ,

damped by :math:`\lambda` towards a slow drift :math:`v_0` along -q. Its task rows are set to zero,
so that the sizes stay. A scheme without a task keeps its cost. If the limits contradict each other,
a retreat is scaled: an inequality row with h < 0, which zero velocity breaks, gets
:math:`h' = \tau h` with the largest feasible :math:`\tau \le 1`, computed as s is; else h' = h.

Equality rows of coupled joints (`JointCouplingTask`) have the weight 0. They are limits, which both
programs keep; the relaxed program scales their right-hand sides by :math:`\tau` too.

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
from iiwa_dnn.qp.layout import IntVector, QPViews, copied, data_size, qp_views
from iiwa_dnn.qp.residuals import cost_size, is_small_enough, within
from iiwa_dnn.schemes.program import add_soft

MAX_LINEAR_SOLVES = 60
"""Linear solves after which a program counts as one without a solution."""

FALLBACK_BUDGET = 240
"""Largest number of linear solves of a step for all of its fallback programs together. Beyond it
none has a solution, and the arm brakes."""

PENALTY = 1e-5
"""Weight w of the nominal cost in the search of a factor, if its largest entry is one."""

FEASIBLE = 1.0 - 1e-9
"""Factor above which the unscaled task counts as feasible."""

ALMOST = 0.999
"""Part of the largest feasible factor that is used: multipliers may be unbounded at the largest."""

RETREAT = 1e-7
"""Lower bound on the tolerance of the search for tau: if a link can hardly retreat, its row is
nearly zero, and full accuracy would exceed the budget of linear solves."""

DAMPING = 0.05
"""Lambda of the relaxed program [m/rad]."""

BLEND = 1e-4
"""Epsilon: weight of the nominal cost in the relaxed program."""

DRIFT = 0.02
"""Largest speed of the drift v_0 down the gradient of the cost [rad/s]. Without the drift, an arm
pulled beyond its reach stays fully stretched, and leaves that posture too late."""

FASTEST = 10.0
"""Largest task velocity in the relaxed program [m/s]; a larger one is scaled down to it."""

REACHED = 1e-9
"""Difference of joint velocities, or of rates of equality rows, that is rounding [rad/s]."""

LIMITING = 1e-4
"""Multiplier, relative to the largest, above which a bound or row counts as limiting."""


class Yielding(NamedTuple):
    """Constants of the fallback programs and stopping motions of a scheme.

    Attributes:
        weights: Weight of each equality row, (p,); 0 for a row of coupled joints.
        tolerance: Tolerance of the residuals of an answer.
        rests: Indices of the limits that have a word on a motion to rest, (k,).
        lengthens: For each of them 1 if a longer motion may keep it, else 0, (k,).
        verifies: Whether the rows of one of them do not suffice: a command is then given only if
            all of them agree with its motion to rest.
        coupled: Whether joints are coupled by a hard `JointCouplingTask`.
        alike: Whether the network of the nominal program is compiled, as for fallback programs.
    """

    weights: Vector
    tolerance: float
    rests: IntVector
    lengthens: Vector
    verifies: bool
    coupled: bool
    alike: bool


@compiled
def solve_warm(qp: QPViews, tol: float, state: Vector, point: Vector, stats: SolveStats) -> bool:
    """Solve a program by the network from a given state and, if that fails, from zeros.

    Args:
        qp: The program, of n variables, m inequality and p equality rows.
        tol: Tolerance of the residuals.
        state: State of the network, (3 n + m + p,), overwritten by the converged one, or by zeros
            if both tries fail.
        point: Primal-dual point [x | y | z | z_box], (2 n + m + p,), overwritten.
        stats: Statistics of a step: linear solves are added to `iterations`, up to
            `FALLBACK_BUDGET`, and `time` is overwritten.

    Returns:
        True if the residuals of `point` are within the tolerance, or above it by rounding alone.
    """
    is_cold = largest_entry(state) == 0.0
    for _ in range(1 if is_cold else 2):
        budget = min(MAX_LINEAR_SOLVES, FALLBACK_BUDGET - int(stats.iterations))
        linear_solves, time, primal, dual, gap = solve_within(qp, tol, budget, state, point)
        stats.iterations += linear_solves
        stats.time = time
        if within(primal, dual, gap, tol) or is_small_enough(qp, point, tol, 0.0):
            return True
        state[:] = 0.0
    return False


@compiled
def largest_factor(
    qp: QPViews, yielding: Yielding, state: Vector, point: Vector, stats: SolveStats, retreats: bool
) -> float:
    """Compute the largest feasible scaling factor s of the task, or tau of a retreat.

    Args:
        qp: The nominal program, of n variables, m inequality and p equality rows.
        yielding: Weights of the task rows, and the tolerance.
        state: State of the network, (3 n + 3 + m + p,), overwritten as in `solve_warm`.
        point: Primal-dual point of the program with one more variable, the last of x,
            (2 n + 2 + m + p,), overwritten.
        stats: Statistics of a step, updated as in `solve_warm`.
        retreats: If True, compute tau, by which negative entries of h and the right-hand sides of
            coupled joints are scaled, without the task rows; if False, compute s.

    Returns:
        1.0 if the factor is 1 up to rounding, else `ALMOST` times the factor; -1.0 if 0 is
        infeasible, or the network does not converge.
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
    """Return the largest right-hand side that a factor scales, as the unit of the added variable.

    It is the largest |b_j| for the scaling factor; for a retreat the largest -h_j and |b_j| of
    rows with the weight 0, of `weights` (p,). If none is above 0, it is 1.
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
    """Write the cost of a program times w / max(its largest entry, w) into `other`.

    The first n entries of other.q and other.P are overwritten; `other` has more variables.
    """
    n = qp.q.size
    weight = PENALTY / max(cost_size(qp), PENALTY)
    for i in range(n):
        other.q[i] = weight * qp.q[i]
        for k in range(n):
            other.P[i, k] = weight * qp.P[i, k]


@compiled
def _copy_limits(qp: QPViews, other: QPViews) -> None:
    """Copy bounds and inequality rows into `other`, which may have more variables.

    The first n entries of other.lb, other.ub and the rows of other.G are overwritten, and other.h.
    """
    copied(other.lb, qp.lb)
    copied(other.ub, qp.ub)
    copied(other.h, qp.h)
    for j in range(qp.h.size):
        copied(other.G[j], qp.G[j])


@compiled
def scale_task(qp: QPViews, weights: Vector, factor: float) -> None:
    """Multiply the entries of qp.b with a positive weight, of `weights` (p,), by a factor."""
    for j in range(qp.b.size):
        if weights[j] > 0.0:
            qp.b[j] *= factor


@compiled
def relax_task(qp: QPViews, weights: Vector, retreat: float) -> None:
    """Turn a nominal program into the relaxed program of this module, in place.

    Args:
        qp: The program, of p equality rows; P, q, h, A and b are overwritten.
        weights: Weights of the equality rows, (p,); 0 for a row of coupled joints.
        retreat: Factor tau of negative entries of h and of the right-hand sides of coupled joints.
    """
    n = qp.q.size
    shrink = FASTEST / max(FASTEST, largest_entry(qp.b))
    drift = DRIFT / max(largest_entry(qp.q), 1.0)
    for i in range(n if largest_entry(weights) > 0.0 else 0):  # without a task the cost stays
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
def hold_distances(qp: QPViews) -> None:
    """Ask for no retreat in a relaxed program: distances must not shrink. Writes h and b."""
    qp.b[:] = 0.0  # of coupled joints; the task is in the cost
    for j in range(qp.h.size):
        qp.h[j] = max(qp.h[j], 0.0)


@compiled
def note_limiting(point: Vector, n: int, m: int, extra: int, limiting: Vector) -> None:
    """Find the bounds and inequality rows whose multipliers are not negligible.

    A multiplier counts if it is above `LIMITING` times the largest of all.

    Args:
        point: Solution [x | y | z | z_box] of a program with n + extra variables, m inequality and
            p equality rows, (2 n + 2 extra + m + p,).
        n: Number of variables of the nominal program.
        m: Number of inequality rows.
        extra: Number of variables after the first n; their bounds are ignored.
        limiting: For each of n variables the sign 1 or -1 of its bound's multiplier if that counts,
            else 0; then for each row 1 if its multiplier counts, else 0, (n + m,), overwritten.
    """
    start = point.size - n - extra - m
    multipliers = point[start : start + m + n]
    least = LIMITING * largest_entry(multipliers)
    for i in range(n + m):
        value = multipliers[m + i if i < n else i - n]
        limiting[i] = math.copysign(1.0, value) if abs(value) > least else 0.0


@compiled
def nearest_within(qp: QPViews, x: Vector, yielding: Yielding, stats: SolveStats) -> bool:
    """Project x on the bounds of a program and, if that violates inequality rows, on these too.

    Rows of coupled joints, the equality rows of weight 0, are kept as well if the other limits
    allow it; rows of tasks do not count.

    Args:
        qp: The program.
        x: Velocities, (n,), overwritten by the projection.
        yielding: Weights, which tell the rows of coupled joints, and the tolerance.
        stats: Statistics of a step, updated as in `solve_warm`.

    Returns:
        False if no point within bounds and inequality rows was found.
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
    """Project x (n,) on bounds, inequality rows and rows of coupled joints, and overwrite it.

    Only the first `equalities` equality rows are looked at. `stats` is updated as in `solve_warm`.

    Returns:
        True if the projection converged. If it did not, x stays, or with equality rows is the last
        finite iterate.
    """
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
    # Bounds with rounding errors may contradict the equalities; the last iterate is then used.
    if found or (equalities > 0 and all_finite(point, 0, n)):
        copied(x, point[:n])
    return found


@compiled
def _rate_within(qp: QPViews, j: int, x: Vector) -> float:
    """Return b_j, or if the bounds do not admit A_j x = b_j, the rate A_j x of the given x (n,).

    The rate is clipped to the values that A_j takes within the bounds.
    """
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
    """Compute the fraction of a task velocity b (p,) that joint velocities x (n,) reach.

    It is b^T W^2 A x / (b^T W^2 b), at most 1, with A (p, n) and W = diag(weights); 1 if W b = 0.
    """
    asked = 0.0
    given = 0.0
    for j in range(b.size):
        rhs = weights[j] * weights[j] * b[j]
        asked += rhs * b[j]
        given += rhs * row_dot(A, j, x)
    return min(given / asked, 1.0) if asked > 0.0 else 1.0
