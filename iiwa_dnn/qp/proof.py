r"""Proof of an answer: a rigorous bound on its distance from the exact solution of the program.

The active set of the answer gives a square linear system, whose exact solution
`iiwa_dnn.qp.enclosure` encloses. Where all other rows and bounds hold at every point of the
enclosure and the multipliers of the active ones have the right sign, that exact solution is the
program's, for its cost is convex (`iiwa_dnn.qp.curvature`). Where a multiplier's interval reaches
:math:`\varepsilon_j` beyond zero, it is the exact solution :math:`u` of a program with another
cost vector, :math:`\|\Delta q\|_1 \le \sum_j \varepsilon_j \|C_j\|_1`, and the program's own is
within :math:`\|\Delta q\| / \sigma` of it, for a curvature :math:`\sigma` along the equality rows.

docs/proof.md has the theorem, with all roundings.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.certificates import infeasibility_radius
from iiwa_dnn.qp.curvature import least_curvature
from iiwa_dnn.qp.enclosure import IntVector, enclose, evaluate, symmetric_part, unit_of
from iiwa_dnn.qp.layout import Matrix, QPViews, Vector, compiled, larger, qp_views
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Solution

if TYPE_CHECKING:
    import qpsolvers

ROUNDS = 5
"""Active sets that are tried, each out of the signs of the one before."""

PROVEN, WEAK, FLAT, DEPENDENT, UNDECIDED, NOT_CONVEX, CROSSED, FAR, INFEASIBLE = range(9)

REASONS = (
    "",
    "a multiplier may be zero: the bound is that of the curvature, the active set is not proven",
    "a multiplier may be zero, and no curvature of the cost is shown along the equality rows",
    "the active rows are linearly dependent, or nearly so",
    "the sign of an inactive row's slack is not decided",
    "the cost is not shown to be convex",
    "a lower bound exceeds its upper bound, or is no number",
    "the answer is not finite",
    "proven: no point satisfies the constraints",
)
"""Reasons by their number; the first two come with a finite bound."""

NO_ANSWER = (
    "the solver found no answer, and handed over no certificate that there is none; "
    "iiwa_dnn.solve_problem looks for one, which is proven in place of an answer"
)
"""Reason of another solver's solution that is marked as not found, where its x is not proven."""


class Proof(NamedTuple):
    """A rigorous bound on the distance of an answer from the exact solution.

    Attributes:
        bound: Largest distance of any entry of x from that of the exact solution, in the unit of x;
            inf where nothing was proven.
        active: Proven active set, (n + m,): for each variable 1 if its upper bound is active, -1
            if its lower one is, else 0, and for each inequality row 1 or 0. Where there is a
            reason, it is the last one that was tried.
        reason: Reason why the active set or the bound is not proven; empty if both are.
    """

    bound: float
    active: IntVector
    reason: str


def prove(qp: QP | qpsolvers.Problem, solution: Solution | qpsolvers.Solution) -> Proof:
    """Bound the distance of an answer from the program's exact solution, with all roundings.

    Nothing about the answer is trusted: its multipliers name the active set to begin with. That
    there is exactly one solution is a part of the proof where the bound is finite. The numbers of
    the program count as exact. Where an answer has a certificate instead, as a field or among its
    extras, the reason says whether it proves that there is none; it needs no x then.
    Nor does another solver's answer that is marked as not found.

    Args:
        qp: The program, also as qpsolvers has it.
        solution: The answer of any solver, with its multipliers.

    Returns:
        The bound, the proven active set, and the reason if something is not proven.

    Raises:
        InvalidInputError: `qp` is no program, or the answer is none of a program of these sizes.
    """
    if not isinstance(qp, QP):
        qp = QP.from_qpsolvers(qp)
    n, m, p = qp.sizes
    active = np.zeros((1, n + m), dtype=np.int64)
    extras: Any = getattr(solution, "extras", None) or {}
    certificate: Any = getattr(solution, "certificate", extras.get("certificate"))
    is_farkas = certificate is not None and np.size(certificate) == n + m + p
    if is_farkas and infeasibility_radius(qp, np.asarray(certificate)[: m + p]) == np.inf:
        return Proof(np.inf, active[0], REASONS[INFEASIBLE])
    if "last_x" in extras:
        return Proof(np.inf, active[0], f"there is no answer: {extras['status']}")
    unsolved = not (isinstance(solution, Solution) or getattr(solution, "found", True))
    if unsolved and solution.x is None:
        return Proof(np.inf, active[0], NO_ANSWER)
    point = point_of(solution, qp)
    bound = np.empty(1)
    reason = np.empty(1, dtype=np.int64)
    prove_block(qp.data[np.newaxis], n, m, point[np.newaxis], bound, reason, active)
    words = NO_ANSWER if unsolved and bound[0] == np.inf else REASONS[reason[0]]
    return Proof(float(bound[0]), active[0], words)


def point_of(solution: Any, qp: QP) -> Vector:
    """Return ``[x | y | z | z_box]`` of an answer, (2 n + m + p,); absent multipliers are zero.

    Raises:
        InvalidInputError: The answer has no x, or a part of another size than the program's.
    """
    n, m, p = qp.sizes
    point = np.zeros(2 * n + m + p)
    start = 0
    for name, size in (("x", n), ("y", p), ("z", m), ("z_box", n)):
        part = getattr(solution, name, None)
        if part is not None and np.size(part):
            if np.size(part) != size:
                problem = f"has {np.size(part)} entries in {name}, not {size}"
                raise InvalidInputError("solution", problem, solution)
            point[start : start + size] = part
        elif name == "x":
            raise InvalidInputError("solution", f"has no x: {type(solution).__name__}", solution)
        start += size
    return point


@compiled
def prove_block(
    programs: Matrix,
    n: int,
    m: int,
    points: Matrix,
    bounds: Vector,
    reasons: IntVector,
    active: NDArray[np.int64],
) -> None:
    """Prove N answers of programs with n variables and m inequality rows.

    Args:
        programs: A `QP.data` in each row, (N, size).
        n: Number of variables.
        m: Number of inequality rows.
        points: The answers ``[x | y | z | z_box]``, (N, 2 n + m + p).
        bounds: Bound of each answer, (N,), overwritten.
        reasons: Number of its reason in `REASONS`, (N,), overwritten.
        active: Its active set, (N, n + m), overwritten.
    """
    for k in range(bounds.size):
        qp = qp_views(programs[k], n, m, points.shape[1] - 2 * n - m)
        bounds[k], reasons[k] = prove_point(qp, points[k], active[k])


@compiled
def prove_point(qp: QPViews, point: Vector, active: IntVector) -> tuple[float, int]:
    """Bound the distance of a point from the exact solution.

    Args:
        qp: The program.
        point: ``[x | y | z | z_box]``, (2 n + m + p,).
        active: The active set as in `Proof`, (n + m,), overwritten.

    Returns:
        The bound, inf where none is proven, and the number of the reason in `REASONS`.
    """
    S = np.empty((qp.q.size, qp.q.size))
    u = np.empty(qp.q.size + qp.b.size + qp.h.size)
    error = np.empty(qp.q.size + qp.b.size + qp.h.size)
    following = np.empty(qp.q.size + qp.h.size, np.int64)
    symmetric_part(qp.P, S)
    _guess(qp, point, active)
    for attempt in range(ROUNDS):
        _begin(qp, point, active, u)
        if not enclose(qp, S, active, u, error):
            return np.inf, DEPENDENT
        left, opened, weak, missing = _judge(qp, S, u, error, active, following)
        if left < 0:
            return np.inf, CROSSED
        if opened == 0 and (left == 0 or attempt == ROUNDS - 1):
            return _distance(qp, S, point, u, error, weak, missing)
        for k in range(active.size):
            active[k] = following[k]
    return np.inf, UNDECIDED


@compiled
def _guess(qp: QPViews, point: Vector, active: IntVector) -> None:
    """Write the active set of a point (2 n + m + p,): multipliers that are above their slacks."""
    n = qp.q.size
    p = qp.b.size
    m = qp.h.size
    for i in range(n):
        multiplier = point[n + p + m + i]
        active[i] = 0
        if qp.lb[i] == qp.ub[i] or multiplier > qp.ub[i] - point[i]:
            active[i] = 1
        elif -multiplier > point[i] - qp.lb[i]:
            active[i] = -1
    for j in range(m):
        slack = qp.h[j]
        for i in range(n):
            slack -= qp.G[j, i] * point[i]
        active[n + j] = 1 if point[n + p + j] > slack else 0


@compiled
def _begin(qp: QPViews, point: Vector, active: IntVector, u: Vector) -> None:
    """Write a first ``[x | y | z]``, (n + p + m,): the point with the active bounds in it."""
    n = qp.q.size
    p = qp.b.size
    for k in range(u.size):
        u[k] = point[k]
    for i in range(n):
        if active[i] > 0:
            u[i] = qp.ub[i]
        elif active[i] < 0:
            u[i] = qp.lb[i]
    for j in range(qp.h.size):
        if active[n + j] == 0:
            u[n + p + j] = 0.0


Signs = tuple[int, int, int, float]
"""How many multipliers are negative; how many slacks are not shown to be positive; how many
multipliers are not; and by how much in all, times the absolute values of their rows."""


@compiled
def _judge(
    qp: QPViews, S: Matrix, u: Vector, error: Vector, active: IntVector, following: IntVector
) -> Signs:
    """Look at the signs of all slacks and multipliers over an enclosure.

    Args:
        qp: The program.
        S: Symmetric part of P, (n, n).
        u: Center of the enclosure, ``[x | y | z]`` of size n + p + m.
        error: Its radii, likewise.
        active: The active set, (n + m,).
        following: The active set that the signs ask for, (n + m,), overwritten.

    Returns:
        The signs; the first number is -1 if two bounds cross.
    """
    unit = unit_of(qp)
    spread = np.empty(u.size)
    value = np.empty(u.size)
    reach = np.empty(u.size)
    for k in range(u.size):
        spread[k] = unit * abs(u[k]) + error[k]
    evaluate(qp, S, u, spread, value, reach)
    for k in range(active.size):
        following[k] = active[k]
    left, opened, weak, missing = _judge_bounds(qp, u, error, value, reach, following)
    if left < 0:
        return left, opened, weak, missing
    released, added, doubtful, lacking = _judge_rows(qp, u, error, value, reach, following)
    missing = (1.0 + unit) * (missing + lacking)
    return left + released, opened + added, weak + doubtful, missing


@compiled
def _judge_rows(
    qp: QPViews, u: Vector, error: Vector, value: Vector, reach: Vector, following: IntVector
) -> Signs:
    """Look at the signs of the rows' slacks and multipliers, as `_judge` does at all.

    All vectors are those of `_judge`, (n + p + m,), and `following` (n + m,) is updated.
    """
    left = 0
    opened = 0
    weak = 0
    missing = 0.0
    n = qp.q.size
    p = qp.b.size
    for j in range(qp.h.size):
        at = n + p + j
        if following[n + j] != 0 and error[at] == 0.0 and u[at] >= 0.0:
            continue  # it repeats another active row, and keeps the multiplier that it came with
        if following[n + j] != 0:
            sign = _sign(u[at], error[at])
            if sign <= 0:
                weak += 1
                missing += larger(0.0, error[at] - u[at]) * _length(qp.G, j)
            if sign < 0:
                left += 1
                following[n + j] = 0
        elif qp.h[j] < np.inf and not value[at] + reach[at] < 0.0:
            opened += 1
            following[n + j] = 1
    return left, opened, weak, missing


@compiled
def _judge_bounds(
    qp: QPViews, u: Vector, error: Vector, value: Vector, reach: Vector, following: IntVector
) -> Signs:
    """Look at the signs of the bounds' slacks and multipliers, as `_judge` does at all.

    All vectors begin with the n variables, (size,).
    """
    left = 0
    opened = 0
    weak = 0
    missing = 0.0
    for i in range(qp.q.size):
        side = following[i]
        if not qp.lb[i] <= qp.ub[i]:
            return -1, opened, weak, missing
        if side == 0:
            if not u[i] + error[i] < qp.ub[i]:
                following[i] = 1
                opened += 1
            elif not u[i] - error[i] > qp.lb[i]:
                following[i] = -1
                opened += 1
        elif qp.lb[i] < qp.ub[i]:
            multiplier = -side * value[i]
            sign = _sign(multiplier, reach[i])
            if sign <= 0:
                weak += 1
                missing += larger(0.0, reach[i] - multiplier)
            if sign < 0:
                left += 1
                following[i] = 0
    return left, opened, weak, missing


@compiled
def _sign(center: float, radius: float) -> int:
    """Return the sign of all numbers of an interval; 0 if they have none in common."""
    if center - radius > 0.0:
        return 1
    return -1 if center + radius < 0.0 else 0


@compiled
def _length(rows: Matrix, j: int) -> float:
    """Add up the absolute values of row j of a matrix (k, n)."""
    total = 0.0
    for i in range(rows.shape[1]):
        total += abs(rows[j, i])
    return total


@compiled
def _distance(
    qp: QPViews,
    S: Matrix,
    point: Vector,
    u: Vector,
    error: Vector,
    weak: int,
    missing: float,
) -> tuple[float, int]:
    """Bound the distance of a point from the solution, as `prove_point` returns it.

    S is (n, n), the others begin with the n variables, (size,).
    """
    curvature = least_curvature(qp, S, weak > 0)
    if not curvature >= 0.0:
        return np.inf, NOT_CONVEX
    unit = unit_of(qp)
    largest = 0.0
    for i in range(qp.q.size):
        largest = larger(largest, (1.0 + unit) * (abs(point[i] - u[i]) + error[i]))
    reason = PROVEN
    if weak > 0:
        if not curvature > 0.0:
            return np.inf, FLAT
        reason = WEAK
        largest = (1.0 + unit) * (largest + missing / curvature)
    if not largest < np.inf:
        return np.inf, FAR
    return largest, reason
