r"""Proof of an answer: a rigorous bound on its distance from the exact solution of the program.

The active set of the answer gives a square linear system. With an approximate inverse R of its
matrix K and a guess :math:`\tilde u`,

.. math::

    u - \tilde u = R (r - K \tilde u) + (I - R K)(u - \tilde u) ,

so that for row sums :math:`\alpha_i` of :math:`|I - R K|` below one, :math:`\alpha = \max_i
\alpha_i`, :math:`\rho \ge |r - K \tilde u|` and :math:`\beta = |R| \rho`

.. math::

    |u_i - \tilde u_i| \le \beta_i + \alpha_i \, \max_k \beta_k / (1 - \alpha) .

Where all other rows and bounds hold at every point of this enclosure and the multipliers of the
active ones have the right sign, its exact solution is the program's, for its cost is convex. Where
a multiplier's interval reaches :math:`\varepsilon_j` beyond zero, it is the exact solution of a
program with another cost vector, :math:`\|\Delta q\|_1 \le \sum_j \varepsilon_j \|C_j\|_1`, and the
program's own is within :math:`\|\Delta q\| / \sigma` of it, for a curvature :math:`\sigma` along
the equality rows: a Cholesky factor of :math:`P + \varrho A^T A - s I` that runs to its end shows
it.

Rounding is counted by the standard model, for which it makes no difference in which order a sum is
taken and whether a product and a sum are rounded once or twice. docs/proof.md has the theorem.

Sources: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken",
Computing 4 (1969); S. M. Rump, "Verification methods: rigorous results using floating-point
arithmetic", Acta Numerica 19 (2010), and "Verification of positive definiteness", BIT Numerical
Mathematics 46 (2006).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.qp.certificates import certified, products
from iiwa_dnn.qp.layout import IntVector, Matrix, Vector, check_size
from iiwa_dnn.qp.program import QP, real_array
from iiwa_dnn.qp.solution import Solution, Status

if TYPE_CHECKING:
    import qpsolvers

Mask = NDArray[np.bool_]

ROUNDS = 5
"""Number of active sets that are tried, each from the signs of the one before."""

REFINEMENTS = 6
"""Steps by which the solution of a linear system is refined: of a matrix with the condition 1e13
each gains three digits."""

_ROUNDING = 2.0**-53
_TINY = 1e-290
"""Bound on the underflow of a sum."""
_SLIGHT = 1e-6
"""Multiplier of a row of length 1, relative to the largest, up to which it is not active at the
beginning."""
_TOUCH = 1e-9
"""Slack of a row up to which a point touches it, relative to its limit and its length."""
_FRACTION = 0.9
"""Fraction of the smallest eigenvalue that is shown as the curvature."""

WEAK = "a multiplier may be zero: the bound is that of the curvature, the active set is not proven"
FLAT = "a multiplier may be zero, and no curvature of the cost is shown along the equality rows"
DEPENDENT = "the KKT system of the active rows is singular, or nearly so"
UNDECIDED = "the sign of an inactive row's slack is not decided"
NOT_CONVEX = "the cost is not shown to be convex"
FAR = "the answer is not finite"
NO_ANSWER = "there is no answer, and no proof of that; iiwa_dnn.solve_problem looks for one"


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
    the program count as exact. Where an answer has a certificate, as a field or among its extras,
    it is judged, all rounding counted, and what it proves is the reason.

    Args:
        qp: The program, also as qpsolvers has it.
        solution: The answer of any solver, with its multipliers.

    Returns:
        The bound, the proven active set, and the reason if something is not proven.

    Raises:
        InvalidInputError: `qp` is no program, has a value that is NaN or crossed bounds, or the
            answer is none of a program of these sizes.
    """
    if not isinstance(qp, QP):
        qp = QP.from_qpsolvers(qp)
    qp.check_numbers()
    checks.offers("solution", solution, "x")
    nothing = np.zeros(sum(qp.sizes[:2]), dtype=np.int64)
    in_extras = getattr(solution, "extras", {}).get("certificate")
    certificate: Any = getattr(solution, "certificate", in_extras)
    if certificate is not None:
        status = certified(qp, real_array("certificate", certificate))
        if status is not Status.NOT_CONVERGED:
            return Proof(np.inf, nothing, f"proven: {status.value}")
    claimed = isinstance(solution, Solution) or getattr(solution, "found", True)
    if solution.x is None or not claimed:
        return Proof(np.inf, nothing, NO_ANSWER)
    return prove_point(qp, point_of(solution, qp))


def point_of(solution: Any, qp: QP) -> Vector:
    """Return ``[x | y | z | z_box]`` of an answer, (2 n + m + p,); absent parts are 0, x NaN.

    Raises:
        InvalidInputError: The answer has a part of another size than the program's.
    """
    n, m, p = qp.sizes
    parts = []
    for name, size in (("x", n), ("y", p), ("z", m), ("z_box", n)):
        part: Any = getattr(solution, name, None)
        given = part is not None and (name == "x" or np.size(part))
        default = np.nan if name == "x" else 0.0
        parts.append(check_size(name, np.asarray(part) if given else np.full(size, default), size))
    return np.concatenate(parts)


class _Rows:
    """All rows of a program as ``rows x <= limits``, the first ones equalities.

    Attributes:
        rows: ``[A; G; I; -I]``, (k, n).
        limits: ``[b; h; ub; -lb]``, (k,).
        equal: Rows that hold as equations: those of A, and upper bounds that are lower ones too.
        usable: Rows that limit anything: a lower bound that is an upper one is counted there.
        unit: Bound on the relative rounding of all sums, (k + n + 16) 2^-53.
        S: Symmetric part of P, (n, n).
        S_error: Bound on the rounding of S; 0 where P is symmetric, (n, n).
    """

    def __init__(self, qp: QP) -> None:
        n, m, p = qp.sizes
        eye = np.eye(n)
        self.rows = np.vstack([qp.A, qp.G, eye, -eye])
        self.limits = np.concatenate([qp.b, qp.h, qp.ub, -qp.lb])
        fixed = qp.lb == qp.ub
        self.equal = np.concatenate([np.ones(p, bool), np.zeros(m, bool), fixed, np.zeros(n, bool)])
        self.usable = self.limits != np.inf
        self.usable[p + m + n :] &= ~fixed
        self.unit = (self.limits.size + n + 16) * _ROUNDING
        self.S = 0.5 * (qp.P + qp.P.T)
        self.S_error = np.where(qp.P == qp.P.T, 0.0, self.unit * np.abs(self.S))


@np.errstate(all="ignore")
def prove_point(qp: QP, point: Vector) -> Proof:
    """Bound the distance of a point ``[x | y | z | z_box]``, (2 n + m + p,), from the solution."""
    center, radius, active, reason = enclose_solution(qp, point)
    bound = (1.0 + 4.0 * _ROUNDING) * float((np.abs(point[: center.size] - center) + radius).max())
    if bound < np.inf and reason != NOT_CONVEX:
        return Proof(bound, active, reason)
    return Proof(np.inf, active, FAR if reason in ("", WEAK) else reason)


@np.errstate(all="ignore")
def enclose_solution(qp: QP, point: Vector) -> tuple[Vector, Vector, IntVector, str]:
    """Enclose the solution, starting with the active set of a point ``[x | y | z | z_box]``.

    Args:
        qp: The program, of n variables, m inequality and p equality rows.
        point: The point, (2 n + m + p,); nothing about it is trusted.

    Returns:
        Center of a box around the solution and the largest distance of each entry from it, inf
        where nothing was proven, (n,) each; and the active set and the reason of `Proof`. If that
        is `NOT_CONVEX`, the box holds the one KKT point with that active set.
    """
    n, m, p = qp.sizes
    rows = _Rows(qp)
    center = point[:n]
    multipliers = np.concatenate([point[n:], -point[n + p + m :]])
    force = multipliers * np.linalg.norm(rows.rows, axis=1)
    active = rows.equal | (
        rows.usable
        & (multipliers > rows.limits - rows.rows @ center)
        & (force > _SLIGHT * force.max())
    )
    active[p + m + n :] &= ~active[p + m : p + m + n]
    radius: Vector = np.full(n, np.inf)
    reason = UNDECIDED
    for attempt in range(ROUNDS):
        kept = _independent(rows, active)
        u, error = _enclose(rows, qp.q, kept)
        if not np.isfinite(error).all():
            reason = DEPENDENT
            break
        slack = _least_slack(rows, u[:n], error[:n])
        joins = rows.usable & ~active & ~(slack >= 0.0)
        uncertain = np.where(rows.equal[kept], -np.inf, error[n:] - u[n:])
        leaving = kept[uncertain > 2.0 * error[n:]]
        if not joins.any() and (not leaving.size or attempt == ROUNDS - 1):
            missing = np.maximum(uncertain, 0.0) @ np.abs(rows.rows[kept]).sum(axis=1)
            moved, reason = _moved(qp, rows, float(missing), bool((uncertain >= 0.0).any()))
            reason = reason or (WEAK if (slack[rows.usable & ~active] == 0.0).any() else "")
            center = u[:n]
            radius = (1.0 + rows.unit) * (error[:n] + moved)
            break
        active = active | joins
        active[leaving] = False
    upper, lower = np.split(active[p + m :].astype(np.int64), 2)
    return center, radius, np.concatenate([upper - lower, active[p : p + m]]), reason


@np.errstate(all="ignore")
def touching_point(qp: QP, x: Vector) -> Vector:
    """Return x (n,) with multipliers, (2 n + m + p,): of least squares, of what it touches.

    Of an x that is not finite they are 0.
    """
    n, m, p = qp.sizes
    if not np.isfinite(x).all():
        return np.concatenate([x, np.zeros(p + m + n)])
    rows = _Rows(qp)
    slack = np.abs(rows.limits - rows.rows @ x)
    length = np.linalg.norm(rows.rows, axis=1)
    touched = np.flatnonzero(
        rows.equal | (rows.usable & (slack <= _TOUCH * (np.abs(rows.limits) + length)))
    )
    multipliers = np.zeros(len(rows.rows))
    multipliers[touched] = np.linalg.pinv(rows.rows[touched].T) @ -(rows.S @ x + qp.q)
    upper, lower = np.split(multipliers[p + m :], 2)
    return np.concatenate([x, multipliers[: p + m], upper - lower])


def _independent(rows: _Rows, active: Mask) -> NDArray[np.intp]:
    """List the active rows, without those that say 0 = 0 or repeat another one to the last bit."""
    lines = np.column_stack([rows.rows, rows.limits])
    used = np.flatnonzero(active & np.any(lines != 0.0, axis=1))
    _, first = np.unique(lines[used], axis=0, return_index=True)
    return np.asarray(used[np.sort(first)])


def _least_slack(rows: _Rows, x: Vector, error: Vector) -> Vector:
    """Bound the slack of each row (k,) at all points within an error of x, (n,) both, from below.

    It is 0 if the slack of x is exactly 0, and the error too.
    """
    slack, rounding = products(np.column_stack([rows.limits, -rows.rows]), np.append(1.0, x))
    reach = np.abs(rows.rows) @ error + rounding
    return slack - (1.0 + rows.unit) * (reach + rows.unit * np.abs(slack) * (reach > 0.0))


def _enclose(rows: _Rows, q: Vector, kept: NDArray[np.intp]) -> tuple[Vector, Vector]:
    """Solve [[S, C^T], [C, 0]] u = [-q; d] and bound the error of each unknown.

    Args:
        rows: The rows of the program.
        q: Cost vector, (n,).
        kept: Indices of the active rows C, (k,).

    Returns:
        Center and radii, (n + k,) both; radii are not finite if it is not shown that there is
        exactly one solution.
    """
    C = rows.rows[kept]
    K = np.block([[rows.S, C.T], [C, np.zeros((len(C), len(C)))]])
    r = np.concatenate([-q, rows.limits[kept]])
    try:
        R = np.linalg.inv(K)
    except np.linalg.LinAlgError:
        return r, np.full(r.size, np.inf)
    u = R @ r
    system = np.column_stack([r, -K])
    residual, rounding = products(system, np.append(1.0, u))
    for _ in range(REFINEMENTS):
        u = u + R @ residual
        residual, rounding = products(system, np.append(1.0, u))
    size = np.abs(R)
    defect = np.abs(np.eye(r.size) - R @ K).sum(axis=1)
    alpha = (1.0 + rows.unit) * (defect + rows.unit * (1.0 + size @ np.abs(K).sum(axis=1)) + _TINY)
    largest = float(alpha.max())
    rho = np.abs(residual) + rounding
    rho[: q.size] += rows.S_error @ np.abs(u[: q.size])
    rho = (1.0 + rows.unit) * rho + _TINY * rho.any()
    beta = (1.0 + rows.unit) * (size @ rho + _TINY * rho.any())
    error = (1.0 + rows.unit) * (beta + alpha * beta.max() / (1.0 - largest))
    return u, error if largest < 0.5 else np.full(r.size, np.inf)


def _moved(qp: QP, rows: _Rows, missing: float, weak: bool) -> tuple[float, str]:
    """Bound the distance between the solutions with the active set and of the program.

    Args:
        qp: The program.
        rows: Its rows.
        missing: Bound on the change of the cost vector that gives all multipliers the right sign.
        weak: Whether a multiplier may be zero, so that `missing` counts.

    Returns:
        The bound, inf if nothing is shown, and the reason; 0 and no reason if they are the same.
    """
    curvature = _curvature(rows.S, qp.A, rows.unit, _FRACTION if weak else 0.0)
    if not curvature > 0.0:
        return (np.inf, FLAT) if weak else (0.0, NOT_CONVEX)
    return (1.0 + 2.0 * rows.unit) * (missing + weak * _TINY) / curvature, WEAK if weak else ""


def _curvature(S: Matrix, A: Matrix, unit: float, fraction: float) -> float:
    r"""Bound the curvature of the cost along the steps that keep the equality rows.

    Args:
        S: Symmetric part of P, (n, n).
        A: Equality rows, (p, n).
        unit: Bound on the relative rounding of a sum.
        fraction: Fraction of the smallest eigenvalue to be shown; 0 asks for semidefiniteness
            alone, to which a variable does no harm that is neither in the cost nor, where A^T A is
            added, in an equality row.

    Returns:
        sigma with :math:`d^T P d \ge \sigma \|d\|^2` where A d = 0; negative if none is shown.
    """
    trace = float(np.trace(S))
    squares = float((A * A).sum())
    added = [(trace / squares, np.vstack([S, A]))] if squares > 0.0 else []
    for weight, taking_part in [(0.0, S), *added]:
        empty = (fraction == 0.0) & ~np.any(taking_part != 0.0, axis=0)
        filling = np.where(empty, trace + (trace == 0.0), 0.0)
        M = S + weight * (A.T @ A) + np.diag(filling)
        size = np.abs(S).sum() + weight * (np.abs(A).sum(axis=1) ** 2).sum() + filling.sum()
        loss = 2.0 * unit * float(size) + (1.0 + weight) * _TINY
        shift = 2.0 * loss
        try:
            if fraction > 0.0:
                shift = max(shift, fraction * float(np.linalg.eigvalsh(M)[0]))
            np.linalg.cholesky(M - shift * np.eye(len(S)))
            return (1.0 - unit) * (shift - loss)
        except np.linalg.LinAlgError:
            continue
    return -1.0
