r"""Relaxed programs, which have a solution where a step's own program has none.

The **scaled program** keeps the direction of the task. With one more variable, the speed
:math:`\sigma` along the direction :math:`\hat b = b / \beta`, :math:`\beta = \|b\|_\infty`,

.. math::

    \min_{x,\,\sigma} \; -\sigma + w \, \tfrac12 (x - x_0)^T P (x - x_0) \quad \text{with} \quad
    A x = \sigma \hat b, \quad 0 \le \sigma \le \beta, \quad G x \le h, \quad lb \le x \le ub,

and the scaling factor is :math:`s = \sigma / \beta`. Further passes start from the point of
the last one, :math:`x_0`, which takes off what the cost has held back (docs/robustness.md).

The **softened program** moves the violation of the task into the cost,

.. math::

    \min_{x} \; \tfrac12 \|W (A x - b)\|^2 + \tfrac12 \lambda^2 \|x - v_0\|^2
        + \tfrac12 \varepsilon\, x^T P x + \varepsilon'\, q^T x, \quad
    \lambda^2 = \Lambda^2 \max\bigl(0, 1 - (\sigma_1 / \sigma_0)^2\bigr)

with :math:`\sigma_1` the smallest singular value of W A: away from singular poses its solution is
the task's velocity, near them it is damped, towards a slow drift :math:`v_0` along -q. A direction
of singular value s is short of its velocity by the share :math:`\mu / (\mu + s^2)` at most, with
:math:`\mu = \lambda^2 + \varepsilon p` and p the curvature of P there, and the joints' speed is at
most :math:`\|W b\| / (2 \lambda)` and that of the drift. The nearest velocity that fulfils all of
the task within the limits is taken in its place if it is no quicker than the strongest damping
would let it be: an arm that has to gather speed would otherwise follow the other one, and its task
would never be fulfilled.

Rows of joints that follow others are limits: both programs keep them as they are.

Sources: O. L. Mangasarian, R. R. Meyer, "Nonlinear perturbation of linear programs", SIAM J.
Control and Optimization 17 (1979), for the exactness of the scaling factor; Y. Nakamura,
H. Hanafusa, "Inverse kinematic solutions with singularity robustness for robot manipulator
control", J. Dynamic Systems, Measurement, and Control 108 (1986), for the damping.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from iiwa_dnn.networks.integrators.base import ANSWER, TOLERANCE, enter_answer
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler, settle
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.compiling import VECTOR, Signature, outlived
from iiwa_dnn.qp.dense import cholesky_factor, extreme_eigenvalues, factor_solve, row_dot
from iiwa_dnn.qp.layout import QP_VIEWS, QPViews, compiled, qp_views
from iiwa_dnn.qp.residuals import within
from iiwa_dnn.schemes.collisions import CollisionAvoidance
from iiwa_dnn.schemes.program import StepProgram

BUDGET = 60
"""Linear systems after which a relaxed program counts as one without a solution."""

PENALTY = 1e-5
"""w, for a cost whose largest entry is one."""

MAX_PASSES = 4
"""Passes after the first one; one that changes nothing has the linear program's solution."""

BLOCKING = 1e-5
"""Multiplier, relative to the largest, above which a bound or row stands in the way."""

DAMPING = 0.05
NEAR = 0.05
"""Lambda [m/rad] and sigma_0 [m/rad] of the damping near singular poses."""

BLEND = 1e-4
WISH = 0.1
"""Epsilon: weight of the scheme's own cost beside the task, and the share of the task's gradient in
the joints that can follow it that the cost's own gradient may reach."""

DRIFT = 0.02
"""Speed at most [rad/s] that damping leaves, towards the posture that the cost wishes for. Damped
to rest, an arm pulled beyond its reach ends up exactly stretched, and finds back too late."""

FULL = 0.1
"""Task velocity [m/s] below which the drift of the damping is less, so that a target is reached."""

FASTEST = 1e3
"""Task velocity [m/s] to which a larger one is cut: no arm is so quick."""

RETREAT = 0.9
"""Largest part of what the bounds let a row be that it may ask for where the task yields."""

STAGNANT = 10.0
"""Residual, in tolerances, up to which the scaled program counts as settled: where rows nearly
depend on each other it may stay above one. What is asked for then is what its solution gives."""

TRIES = 3
"""Parts that are tried, down to none, where several rows ask for more than all can have."""

SHORT = 0.1
"""Share of the task velocity up to which it may be missing if a point that gives all is sought."""

REACHED = 1e-9
"""Residual of the task rows below which a point counts as on them."""


class Yielding(NamedTuple):
    """Constants with which the relaxed programs of a scheme are written and answered.

    Attributes:
        weights: Weight of each task row, (p,); 0 for a row that is a limit.
        elastic: 1 for each inequality row that is followed as far as the joints can, (m,).
        limits: Constants of the acceleration and jerk limits, `MotionLimits.constants`, (6 dof,);
            empty where there are none.
        settings: Constants with which the network settles, ``[tol, budget, long step]``, (3,).
        scenes: Beginning and end, among the constants of all parts, of those of each scene that
            braking keeps away from, (scenes, 2); none without acceleration limits.
        dt: Control period [s].
        answer: Address of the function that settles the network, `ANSWER`.
        factor: Address of `largest_factor`.
        violation: Address of `least_violation`.
        approach: Address of `yielding.approach`; 0 without acceleration limits.
        stop: Address of `stopping.stopping_time`; 0 without scenes.
    """

    weights: Vector
    elastic: Vector
    limits: Vector
    settings: Vector
    scenes: NDArray[np.int64]
    dt: float
    answer: int
    factor: int = 0
    violation: int = 0
    approach: int = 0
    stop: int = 0


_PAIRS = types.Array(types.int64, 2, "C")
YIELDING = types.BaseTuple.from_types(
    (VECTOR, VECTOR, VECTOR, VECTOR, _PAIRS, types.float64, *5 * [types.int64]), Yielding
)
"""numba's type of `Yielding`, for a `Signature`."""

FACTOR = Signature(types.float64, QP_VIEWS, YIELDING, VECTOR)
VIOLATION = Signature(types.boolean, QP_VIEWS, YIELDING, VECTOR, VECTOR)
"""Types of `largest_factor` and `least_violation`, which are compiled once for all who ask."""

enter_factor = FACTOR.enter
enter_violation = VIOLATION.enter


def make_yielding(program: StepProgram, tol: float, dt: float) -> Yielding:
    """Prepare for a scheme that is laid out for a robot, a tolerance and a control period [s]."""
    limits: Vector = np.zeros(0)
    scenes: list[tuple[int, int]] = []
    if program.rate_limits is not None:
        limits = program.rate_limits.constants(program.robot)
        scenes = program.constants_of(CollisionAvoidance)
    return Yielding(
        program.row_weights,
        program.elastic,
        limits,
        np.array([tol, BUDGET, ImplicitEuler().long_step]),
        np.array(scenes, dtype=np.int64).reshape(-1, 2),
        dt,
        ANSWER.address(settle),
        FACTOR.address(largest_factor),
        VIOLATION.address(least_violation),
    )


@compiled
def settled(
    qp: QPViews, yielding: Yielding, state: Vector, point: Vector, tolerances: float
) -> bool:
    """Settle the network on a program from a state (size,); test whether it has a solution.

    Its residuals may be as large as some `tolerances`.
    """
    settings = yielding.settings
    _, _, primal, dual, gap = enter_answer(yielding.answer, qp, 0, settings, state, point)
    return within(primal, dual, gap, tolerances * settings[TOLERANCE])


@compiled
def largest_factor(qp: QPViews, yielding: Yielding, point: Vector) -> float:
    """Compute the largest scaling factor of the task that the limits allow, in [0, 1].

    Args:
        qp: The step's program, of n variables, m inequality and p equality rows.
        yielding: Which rows are the task's, and how the network settles.
        point: The scaled program's solution, (size,) = (2 n + 2 + m + p,), overwritten.

    Returns:
        The factor; NaN where not even 0 is feasible, or the network does not settle.
    """
    n = qp.q.size
    m = qp.h.size
    p = qp.b.size
    size = n + 1
    data = np.zeros(data_size(size, m, p))
    scaled = qp_views(data, size, m, p)
    longest = _write_scaled(qp, yielding.weights, scaled)
    state = np.zeros(3 * size + m + p)
    if not settled(scaled, yielding, state, point, STAGNANT):
        return np.nan
    for _ in range(MAX_PASSES):
        before = point[n]
        for i in range(n):
            scaled.q[i] = -row_dot(scaled.P, i, point)
        if not settled(scaled, yielding, state, point, STAGNANT):
            return np.nan
        if abs(point[n] - before) <= 0.1 * REACHED:
            break
    outlived(data)
    factor: float = point[n] / longest
    return min(max(factor, 0.0), 1.0)


@compiled
def data_size(n: int, m: int, p: int) -> int:
    """Count the numbers of a program, `QP.data`.

    Views do not keep such an array: the function that makes it says when they are `outlived`.
    """
    return (n + m + p) * (n + 1) + 2 * n


@compiled
def _write_scaled(qp: QPViews, weights: Vector, scaled: QPViews) -> float:
    """Write the scaled program of a step's program; return the task's largest entry."""
    n = qp.q.size
    longest = 0.0
    for j in range(qp.b.size):
        if weights[j] > 0.0:
            longest = max(longest, abs(qp.b[j]))
    if longest == 0.0:
        longest = 1.0
    weight = PENALTY / _largest_entry(qp)
    for i in range(n):
        scaled.q[i] = weight * qp.q[i]
        scaled.lb[i] = qp.lb[i]
        scaled.ub[i] = qp.ub[i]
        for k in range(n):
            scaled.P[i, k] = weight * qp.P[i, k]
    scaled.q[n] = -1.0
    scaled.ub[n] = longest
    _copy_rows(qp, scaled)
    for j in range(qp.b.size):
        for i in range(n):
            scaled.A[j, i] = qp.A[j, i]
        if weights[j] > 0.0:
            scaled.A[j, n] = -qp.b[j] / longest
        else:
            scaled.b[j] = qp.b[j]
    return longest


@compiled
def _largest_entry(qp: QPViews) -> float:
    """Compute the largest entry of a program's cost; 1 if there is none."""
    largest = 0.0
    for i in range(qp.q.size):
        largest = max(largest, abs(qp.q[i]))
        for k in range(qp.q.size):
            largest = max(largest, abs(qp.P[i, k]))
    return largest if largest > 0.0 else 1.0


@compiled
def _copy_rows(qp: QPViews, other: QPViews) -> None:
    """Copy the inequality rows into a program that may have more variables."""
    for j in range(qp.h.size):
        other.h[j] = qp.h[j]
        for i in range(qp.q.size):
            other.G[j, i] = qp.G[j, i]


@compiled
def note_blocking(point: Vector, n: int, m: int, extra: int, blocking: Vector) -> None:
    """Note which bounds and rows stand in the way of a relaxed program.

    Args:
        point: Its solution, ``[x | y | z | z_box]`` with `extra` more variables than n.
        n: Number of the step's variables.
        m: Number of inequality rows.
        extra: Number of further variables.
        blocking: For each variable the sign of its bound's multiplier, and for each row 1 where its
            multiplier counts, (n + m,), overwritten.
    """
    at_box = point.size - n - extra
    at_rows = at_box - m
    largest = 0.0
    for i in range(n + m):
        largest = max(largest, abs(point[at_box + i if i < n else at_rows + i - n]))
    least = BLOCKING * largest
    for i in range(n + m):
        value = point[at_box + i if i < n else at_rows + i - n]
        blocking[i] = 0.0
        if abs(value) > least:
            blocking[i] = 1.0 if value > 0.0 else -1.0


@compiled
def least_violation(qp: QPViews, yielding: Yielding, q: Vector, point: Vector) -> bool:
    """Solve the softened program of a step; where the task can be had, move onto its rows.

    Args:
        qp: The step's program, of n variables, m inequality and p equality rows.
        yielding: Weights and limits; with acceleration limits, velocity and position limits alone
            bound the joints.
        q: Joint positions [rad], (dof,).
        point: Its solution, ``[x | z | z_box]``, (2 n + m,), or with the multipliers y of rows that
            are limits; overwritten.

    Returns:
        Whether there is a solution.
    """
    n = qp.q.size
    m = qp.h.size
    held = held_rows(yielding.weights)
    data = np.zeros(data_size(n, m, held))
    soft = qp_views(data, n, m, held)
    damping = _write_softened(qp, yielding, q, soft)
    if not _settled_in_retreat(qp, yielding, soft, point):
        return False
    # Neither the scheme's own cost nor damping may bend a task that can be had: all is wanted.
    exact = point[:n].copy()
    fastest = _damped_speed(qp.b, yielding.weights) if damping > 0.0 else np.inf
    if _fulfil(qp, soft, yielding, exact) and _length(exact) <= fastest:
        for i in range(n):
            point[i] = exact[i]
    outlived(data)
    return True


@compiled
def _fulfil(qp: QPViews, soft: QPViews, yielding: Yielding, x: Vector) -> bool:
    """Move x (n,), near a solution, to the nearest point that fulfils a task within soft limits.

    Returns:
        False if there is none, or x does not give nearly all of the task.
    """
    asked = 0.0
    missing = 0.0
    for j in range(qp.b.size):
        asked += (yielding.weights[j] * qp.b[j]) ** 2
        missing += (yielding.weights[j] * (row_dot(qp.A, j, x) - qp.b[j])) ** 2
    if not on_rows(qp, x):
        return False
    if inside(soft, x):
        return True
    return missing <= SHORT * SHORT * asked and _move_within(soft, qp, qp.b.size, x, yielding)


@compiled
def _damped_speed(b: Vector, weights: Vector) -> float:
    """Compute the joints' speed that the strongest damping allows for a task velocity b (p,)."""
    asked = 0.0
    for j in range(b.size):
        asked += (weights[j] * b[j]) ** 2
    return math.sqrt(asked) / (2.0 * DAMPING)


@compiled
def _settled_in_retreat(qp: QPViews, yielding: Yielding, soft: QPViews, point: Vector) -> bool:
    """Settle the softened program, its elastic rows asking for as much as can be had together."""
    state = np.zeros(3 * qp.q.size + qp.h.size + soft.b.size)
    for tried in range(TRIES):
        share = RETREAT * (1.0 - tried / (TRIES - 1.0))
        asks = _limit_retreat(qp, yielding, soft, share)
        for i in range(state.size):
            state[i] = 0.0
        if settled(soft, yielding, state, point, 1.0):
            return True
        if not asks:
            return False
    return False


@compiled
def _limit_retreat(qp: QPViews, yielding: Yielding, soft: QPViews, share: float) -> bool:
    """Let elastic rows ask for a share of what the bounds let them be; tell if any asks for it."""
    asks = False
    for j in range(qp.h.size):
        if yielding.elastic[j] > 0.0:
            lowest = _lowest(soft, j)
            soft.h[j] = max(qp.h[j], share * lowest if lowest < 0.0 else lowest)
            if soft.h[j] < 0.0:
                asks = True
    return asks


@compiled
def held_rows(weights: Vector) -> int:
    """Count the equality rows that are limits, by the weights (p,) of all rows."""
    count = 0
    for j in range(weights.size):
        if weights[j] == 0.0:
            count += 1
    return count


@compiled
def _write_softened(qp: QPViews, yielding: Yielding, q: Vector, soft: QPViews) -> float:
    """Write the softened program but for elastic rows; return the damping's square, lambda."""
    n = qp.q.size
    weights = yielding.weights
    damping = _damping(qp.A, weights)
    shrink = _shrink(qp.b)
    pull = np.zeros(n)
    asked = 0.0
    held = 0
    for j in range(qp.b.size):
        rhs = weights[j] * weights[j] * qp.b[j] * shrink
        asked += rhs * qp.b[j] * shrink
        for i in range(n):
            pull[i] += rhs * qp.A[j, i]
            for k in range(n):
                soft.P[i, k] += weights[j] * weights[j] * qp.A[j, i] * qp.A[j, k]
        if weights[j] == 0.0:
            soft.b[held] = qp.b[j]
            for i in range(n):
                soft.A[held, i] = qp.A[j, i]
            held += 1
    _write_bounds(qp, yielding.limits, q, soft)
    wish = _wish(qp.q, pull, soft, q.size) if damping == 0.0 else 0.0
    drift = DRIFT * min(1.0, math.sqrt(asked) / FULL) / max(_length(qp.q), 1.0)
    for i in range(n):
        for k in range(n):
            soft.P[i, k] += BLEND * qp.P[i, k]
        soft.P[i, i] += damping
        soft.q[i] = wish * qp.q[i] + damping * drift * qp.q[i] - pull[i]
    _copy_rows(qp, soft)
    return damping


@compiled
def _shrink(b: Vector) -> float:
    """Compute the factor of task velocities b (p,) beside which rounding would hide the bounds."""
    fastest = 0.0
    for j in range(b.size):
        fastest = max(fastest, abs(b[j]))
    return FASTEST / fastest if fastest > FASTEST else 1.0


@compiled
def _lowest(qp: QPViews, j: int) -> float:
    """Compute the least value that the bounds let inequality row j have."""
    lowest = 0.0
    for i in range(qp.q.size):
        entry = qp.G[j, i]
        if entry != 0.0:
            lowest += entry * (qp.lb[i] if entry > 0.0 else qp.ub[i])
    return lowest


@compiled
def _damping(A: Matrix, weights: Vector) -> float:
    """Compute the square of the damping for task rows A (p, n), which grows near singular poses."""
    p = weights.size - held_rows(weights)
    if p == 0:
        return 0.0
    gram = np.empty((p, p))
    row = 0
    for j in range(weights.size):
        if weights[j] == 0.0:
            continue
        column = 0
        for k in range(weights.size):
            if weights[k] > 0.0:
                gram[row, column] = weights[j] * weights[k] * row_dot(A, j, A[k])
                column += 1
        row += 1
    smallest, _ = extreme_eigenvalues(gram)
    return DAMPING * DAMPING * max(0.0, 1.0 - smallest / (NEAR * NEAR))


@compiled
def _write_bounds(qp: QPViews, limits: Vector, q: Vector, soft: QPViews) -> None:
    """Write the bounds of the variables: without acceleration limits those of the step."""
    dof = q.size
    for i in range(qp.q.size):
        soft.lb[i] = qp.lb[i]
        soft.ub[i] = qp.ub[i]
        if limits.size > 0 and i < dof:
            fastest = limits[2 * dof + i]
            soft.lb[i] = min(max(POSITION_GAIN * (limits[i] - q[i]), -fastest), fastest)
            soft.ub[i] = min(max(POSITION_GAIN * (limits[dof + i] - q[i]), -fastest), fastest)


POSITION_GAIN = 20.0
"""Rate at which the wanted velocity falls towards a position limit [1/s]."""


@compiled
def _wish(gradient: Vector, pull: Vector, soft: QPViews, dof: int) -> float:
    """Compute the factor of the cost's own gradient (n,) beside the task's pull (n,).

    A wish for another posture may not outweigh the task, or it would hold the tip away from its
    target where joints at their limits leave the task little.
    """
    wished = _length(gradient[:dof])
    if wished == 0.0:
        return BLEND
    free = 0.0
    for i in range(dof):
        free += min(max(pull[i], soft.lb[i]), soft.ub[i]) ** 2
    return min(BLEND, WISH * math.sqrt(free) / wished)


@compiled
def _length(values: Vector) -> float:
    """Compute the Euclidean norm of values (k,)."""
    total = 0.0
    for i in range(values.size):
        total += values[i] * values[i]
    return math.sqrt(total)


@compiled
def on_rows(qp: QPViews, x: Vector) -> bool:
    """Move x (n,) to the nearest point on the equality rows; return False where that fails."""
    p = qp.b.size
    if p == 0:
        return True
    gram = np.empty((p, p))
    missing = np.empty(p)
    multiplier = np.empty(p)
    for j in range(p):
        missing[j] = qp.b[j] - row_dot(qp.A, j, x)
        for k in range(p):
            gram[j, k] = row_dot(qp.A, j, qp.A[k])
        gram[j, j] += 1e-13
    if not cholesky_factor(gram):
        return False
    factor_solve(gram, missing, multiplier)
    worst = 0.0
    for j in range(p):
        for i in range(x.size):
            x[i] += qp.A[j, i] * multiplier[j]
    for j in range(p):
        worst = max(worst, abs(row_dot(qp.A, j, x) - qp.b[j]))
    return worst <= REACHED


@compiled
def inside(qp: QPViews, x: Vector) -> bool:
    """Test whether x (n,) is within the bounds and inequality rows of a program."""
    outside = 0
    for i in range(x.size):
        outside += x[i] < qp.lb[i] or x[i] > qp.ub[i]
    for j in range(qp.h.size):
        outside += row_dot(qp.G, j, x) > qp.h[j]
    return outside == 0


@compiled
def nearest_within(qp: QPViews, x: Vector, yielding: Yielding) -> bool:
    """Move x (n,) to the nearest point within the bounds and inequality rows of a program.

    Returns:
        False if the rows contradict the bounds: x is then the nearest point within the bounds.
    """
    if inside(qp, x):
        return True
    if _move_within(qp, qp, 0, x, yielding):
        return True
    for i in range(x.size):
        x[i] = min(max(x[i], qp.lb[i]), qp.ub[i])
    return False


@compiled
def _move_within(limits: QPViews, task: QPViews, p: int, x: Vector, yielding: Yielding) -> bool:
    """Move x (n,) to the nearest point within bounds and inequality rows, if they allow any.

    The point is on the first `p` of a task's rows too.
    """
    n = x.size
    m = limits.h.size
    data = np.zeros(data_size(n, m, p))
    nearest = qp_views(data, n, m, p)
    for i in range(n):
        nearest.P[i, i] = 1.0
        nearest.q[i] = -x[i]
        nearest.lb[i] = limits.lb[i]
        nearest.ub[i] = limits.ub[i]
    _copy_rows(limits, nearest)
    for j in range(p):
        nearest.b[j] = task.b[j]
        for i in range(n):
            nearest.A[j, i] = task.A[j, i]
    point = np.empty(2 * n + m + p)
    state = np.zeros(3 * n + m + p)
    found = settled(nearest, yielding, state, point, 1.0)
    outlived(data)
    if found:
        for i in range(n):
            x[i] = point[i]
    return found
