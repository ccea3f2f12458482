"""The reach of a task: how much of it the limits of a program allow, and what stands in the way."""

from typing import Any, NamedTuple

import numpy as np
import qpsolvers
from numpy.typing import NDArray

from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector

DAMPING = 0.01
"""Of ``relax``, by the violation [m/s]: what joint velocities cost, [(m/rad)^2 / (m/s)]. It bounds
the rate at which a singular pose is approached, whatever is asked for."""

DRIFT = 0.02
"""Speed at most [rad/s] that damping leaves, towards the posture that the cost wishes for. Damped
to rest, an arm pulled beyond its reach ends up exactly stretched, and finds back too late."""

_TIGHT = 1e-11
"""Tolerance on the residuals of the least squares."""

_LINEAR = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
_QUADRATIC: dict[str, Any] = {
    "backend": "dense",
    "eps_abs": 1e-10,
    "eps_rel": 0.0,
    "max_iter": 1000,
}

Sides = NDArray[np.int8]


class Reach(NamedTuple):
    """Largest part of a program's task that the limits allow.

    Attributes:
        fraction: Largest feasible share of b, in [0, 1]; NaN where not even 0 is feasible.
        dq: A point within the limits that gives it, (n,); joint velocities in [rad/s].
        sides: Bounds that stop it, (n,): 1 upper, -1 lower, 0 neither.
        rows: Inequality rows that stop it, (m,): 1 or 0.
    """

    fraction: float
    dq: Vector
    sides: Sides
    rows: Sides


def largest_fraction(qp: QP) -> Reach:
    """Compute the largest share of the task velocity that the limits allow, by a linear program.

    Args:
        qp: A program, finite but for its bounds and h.

    Returns:
        The share, a joint velocity that gives it, and what stops it from being larger.
    """
    n, m, _ = qp.sizes
    # In units of b's largest entry: b may be a thousand times what the arm can do.
    scale = float(np.abs(qp.b).max(initial=0.0)) or 1.0
    found = _program(qp, scale)
    if feasible := found.status == 0:
        dq: Vector = np.clip(found.x[:n], qp.lb, qp.ub)
        fraction = min(float(found.x[n]) / scale, 1.0)
    else:
        dq = np.clip(np.zeros(n), qp.lb, qp.ub)
        fraction = np.nan
        found = _program(qp, scale, elastic=True)
    if not feasible and found.status != 0:
        return Reach(fraction, dq, (qp.lb > qp.ub).astype(np.int8), np.zeros(m, np.int8))
    push = -(found.lower.marginals[:n] + found.upper.marginals[:n])
    rows = np.zeros(m)
    rows[np.isfinite(qp.h)] = -found.ineqlin.marginals
    return Reach(fraction, dq, _sides(push), _sides(rows))


def _program(qp: QP, scale: float, elastic: bool = False) -> Any:
    """Solve the linear program of `largest_fraction`, b in units of `scale`.

    The elastic one has a solution unless bounds cross: all rows may be violated, as little as
    possible. Its multipliers name those that contradict each other.
    """
    from scipy.optimize import linprog  # its 0.2 s are for the runs that need it

    n = qp.sizes[0]
    limited = np.isfinite(qp.h)
    p = qp.sizes[2]
    k = int(limited.sum())
    free = elastic * (k + 2 * p)
    above = np.eye(k, free)
    off = np.eye(p, free, k) - np.eye(p, free, k + p)
    return linprog(
        np.concatenate([np.zeros(n), [elastic - 1.0], np.ones(free)]),
        A_ub=np.column_stack([qp.G[limited], np.zeros(k), -above]),
        b_ub=qp.h[limited],
        A_eq=np.column_stack([qp.A, -qp.b / scale, off]),
        b_eq=np.zeros(p),
        bounds=[*zip(qp.lb, qp.ub, strict=True), (0.0, scale), *[(0.0, np.inf)] * free],
        method="highs-ds",
        options=_LINEAR,
    )


def least_violation(
    qp: QP, weights: Vector | None = None, damping: float | None = None
) -> Reach | None:
    """Compute the point within the limits that violates the task rows least, weighted and damped.

    Undamped, an arm that is pulled beyond its reach would swing over the singular pose and back at
    every step; so the squared point is added, times ``DAMPING`` and the violation that is left
    without it. A violation that vanishes leaves no damping.

    Args:
        qp: A program, finite but for its bounds and h.
        weights: Weight of each task row, (p,); None weighs all alike.
        damping: Factor of the squared point; None: as said above.

    Returns:
        Fraction 1, since the clock runs on; the point; the bounds and rows that stand in the way.
        None where no point is within the limits.
    """
    n = qp.sizes[0]
    weights = np.ones(qp.b.size) if weights is None else weights
    rows = weights[:, np.newaxis] * qp.A
    rhs = weights * qp.b
    if damping is None:
        closest = _least_squares(rows, rhs, qp)
        if closest is None:
            return None
        damping = DAMPING * float(np.linalg.norm(rhs - rows @ closest.x))
    rows = np.vstack([rows, np.sqrt(damping) * np.eye(n)])
    drift = qp.q * (-DRIFT / max(float(np.linalg.norm(qp.q)), 1.0))
    rhs = np.append(rhs, np.sqrt(damping) * drift)
    found = _least_squares(rows, rhs, qp)
    if found is None:
        return None
    return Reach(1.0, found.x, _sides(found.z_box), _sides(found.z))


def _least_squares(rows: Matrix, rhs: Vector, qp: QP) -> Solution | None:
    """The point within the limits of `qp` with the least |rows x - rhs|; None where there is none.

    First by the active-set method of P. B. Stark and R. L. Parker, "Bounded-variable
    least-squares" (1995), in scipy, which does not square the condition of the rows. Where that
    point is beyond an inequality row, by the network, or ProxQP where the network does not settle.
    """
    from scipy.optimize import lsq_linear  # its 0.2 s are for the runs that need it

    if (qp.lb > qp.ub).any():
        return None
    n, m, _ = qp.sizes
    x: Vector = np.clip(np.zeros(n), qp.lb, qp.ub)
    free = qp.lb < qp.ub  # a joint far outside its limits has one velocity left
    if free.any():
        bounds = (qp.lb[free], qp.ub[free])
        wanted = rhs - rows[:, ~free] @ x[~free]
        # By default it stops after n changes of its active set, which is too few.
        found = lsq_linear(rows[:, free], wanted, bounds, "bvls", tol=1e-14, max_iter=1000)
        x[free] = np.clip(found.x, *bounds)
    if (qp.G @ x <= qp.h).all():
        push = rows.T @ (rhs - rows @ x)
        slack = np.where(push > 0.0, qp.ub - x, x - qp.lb)
        at_bound = slack <= 1e-12 * (1.0 + np.abs(x))
        point = np.concatenate([x, np.zeros(m), np.where(at_bound, push, 0.0)])
        return Solution(point, (n, m, 0), Status.SOLVED, 0, 0.0, 0.0, 0.0, 0.0)
    program = QP(rows.T @ rows, -rows.T @ rhs, G=qp.G, h=qp.h, lb=qp.lb, ub=qp.ub)
    solution = DNNSolver(tol=_TIGHT).solve(program)
    return solution if solution.found else ask_reference(program, 1e3 * _TIGHT)


def ask_reference(qp: QP, tol: float) -> Solution | None:
    """ProxQP's solution; None where it has none whose every residual is at most `tol`."""
    try:
        answer = qpsolvers.solve_problem(qp.to_qpsolvers(), solver="proxqp", **_QUADRATIC)
    except Exception:  # whatever it raises, it has no answer
        return None
    if not answer.found or answer.x is None:
        return None
    n, m, p = qp.sizes
    x = np.clip(answer.x, qp.lb, qp.ub)
    residuals = qp.residuals(x, answer.y, answer.z, answer.z_box)
    if not residuals.largest <= tol:
        return None
    parts = ((x, n), (answer.y, p), (answer.z, m), (answer.z_box, n))
    point = np.concatenate([np.zeros(k) if part is None else part for part, k in parts])
    return Solution(point, qp.sizes, Status.SOLVED, 0, 0.0, *residuals)


def _sides(push: Vector) -> Sides:
    """Signs of the multipliers that are more than rounding."""
    largest = float(np.abs(push).max(initial=0.0))
    return np.where(np.abs(push) > 1e-9 * largest, np.sign(push), 0.0).astype(np.int8)
