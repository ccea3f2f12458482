r"""What to do at a step whose program has no solution, or one that the network did not find.

A program without a solution asks for a task velocity b that no joint velocity inside the bounds
gives. Every policy that goes on replaces b by one that can be had and leaves rows and bounds
alone, so joint and velocity limits are never relaxed, and the check gets a program of the usual
shape:

``slow``
    :math:`b' = s\,b` with the largest feasible :math:`s \in [0, 1]`, the solution of the linear
    program :math:`\max s` subject to :math:`A \dot q = s\,b` and the bounds. Feedforward and
    feedback are slowed alike, and the reference's clock has to advance by s dt: then the arm goes
    along the same path, later. Where not even standing still is feasible, since a joint outside its
    limits has to come back, the task yields as with ``relax``.
``relax``
    :math:`b' = A \dot q'` with :math:`\dot q'` the point inside the bounds that violates the task
    rows least, :math:`\min \|A \dot q' - b\|_W`, damped, and the objective is to be near it: a
    wish to come back to the home posture would shake an arm that is stretched. The clock runs on.
``stop``
    No velocity; the run ends.
``raise``
    A `NoSolutionError` with the program inside.

The multipliers of the first two problems name the bounds that stand in the way. A program that has
a solution which the network missed is answered by the reference solver, whatever the policy.

Source: slowing down along the path is dynamic scaling, J. M. Hollerbach, "Dynamic scaling of
manipulator trajectories", Journal of Dynamic Systems, Measurement, and Control 106 (1984); for
velocity limits, F. Flacco, A. De Luca, O. Khatib, "Control of redundant robots under hard joint
constraints", IEEE Transactions on Robotics 31 (2015).
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any, Literal, NamedTuple

import numpy as np
import qpsolvers
from numpy.typing import NDArray

from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector

Policy = Literal["slow", "relax", "stop", "raise"]
POLICIES: tuple[Policy, ...] = ("slow", "relax", "stop", "raise")

ROTATION_LENGTH = 0.1
"""What an orientation row counts beside a position row when the task yields [m]: a missing
1 rad/s weighs like a missing 0.1 m/s."""

_FEASIBLE = 1.0 - 1e-9  # the linear program's own tolerance is 1e-10
SINGULAR = 0.05
"""Below it a pose counts as singular: what the tip moves for each unit of joint velocity [m/rad].
There the joints would race for next to nothing, and over the singular pose and back at every step;
``slow`` goes slower in proportion, so that the arm comes to rest there."""

REST = 1e-3
"""A fraction below it, in a singular pose, is none: the arm stands still."""

DAMPING = 0.01
"""Of ``relax``, by the violation [m/s]: what joint velocities cost, [(m/rad)^2 / (m/s)]. It bounds
the rate at which a singular pose is approached, whatever is asked for."""

_PENALTY = 1e5

# At the very edge of what is feasible the multipliers may grow without bound; seen at one step in
# 150 of random ones, where a little less has room enough.
_SHARES = (1.0, 0.99, 0.9)
_LINEAR = {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10}
_QUADRATIC: dict[str, Any] = {
    "backend": "dense",
    "eps_abs": 1e-10,
    "eps_rel": 0.0,
    "max_iter": 1000,
}

Sides = NDArray[np.int8]


class Action(IntEnum):
    """What was done at a step in place of the network's answer; the code in a record."""

    NONE = 0
    """The network's answer was taken."""
    FALLBACK = 1
    """The network did not settle; the reference solver's answer to the same program was taken."""
    SLOW = 2
    """A part of the task velocity."""
    RELAX = 3
    """The task rows hold as far as they can."""
    STOP = 4
    """No velocity."""


class Reach(NamedTuple):
    """How far the bounds let a program's task go.

    Attributes:
        fraction: Largest feasible share of b, in [0, 1]; NaN where not even 0 is feasible.
        dq: A joint velocity [rad/s] inside the bounds that gives it, (n,).
        sides: Which bounds stop it, (n,): 1 upper, -1 lower, 0 neither.
    """

    fraction: float
    dq: Vector
    sides: Sides


class Resolution(NamedTuple):
    """What a policy decided at one step.

    Attributes:
        action: What was done.
        qp: The program that was answered: the step's own, or the one with b replaced.
        solution: The answer to it. One that nothing settled has its large residuals.
        fraction: By which share of a control period the reference's clock advances, in [0, 1].
        sides: Which bounds stood in the way, (n,): 1 upper, -1 lower, 0 neither.
    """

    action: Action
    qp: QP
    solution: Solution
    fraction: float
    sides: Sides


def resolve(qp: QP, failed: Solution, policy: Policy, solver: DNNSolver) -> Resolution:
    """Decide what to do at a step that the network did not solve.

    Args:
        qp: The step's program, without inequality rows: n variables, p task rows of which the
            first three are the position's.
        failed: The network's last word on it.
        policy: One of ``POLICIES``.
        solver: The network, for the program with another b; its tolerance holds for all answers.

    Returns:
        The decision. Its joint velocity is inside the bounds of `qp`, but for ``stop``'s zero.

    Raises:
        NoSolutionError: The policy is ``raise`` and the program has no solution; it carries the
            program.
    """
    if np.isnan(qp.data).any() or not np.isfinite(qp.b).all():
        return stopped(qp, failed)
    reach = largest_fraction(qp)
    if reach.fraction >= _FEASIBLE:
        reference = ask_reference(qp, solver.tol)
        if reference is not None:
            return Resolution(Action.FALLBACK, qp, reference, 1.0, np.zeros_like(reach.sides))
    if policy == "raise":
        message = "no joint velocity inside the bounds fulfils the task"
        problem = qp.to_qpsolvers()
        raise NoSolutionError(message, problem, failed.to_qpsolvers(problem))
    if policy == "stop":
        return stopped(qp, failed, reach.sides)
    if policy == "slow" and not np.isnan(reach.fraction):
        reach = _braked(qp, reach)
        if not reach.dq.any() and _rest_is_allowed(qp):
            return _settled(Action.SLOW, qp, reach.dq, 0.0, reach.sides)
        return _slowed(qp, solver, reach)
    reach = least_violation(qp)
    return _settled(Action.RELAX, qp, reach.dq, 1.0, reach.sides)


def largest_fraction(qp: QP) -> Reach:
    """The largest share of the task velocity that the bounds allow, by a linear program.

    Args:
        qp: A program without inequality rows, finite but for its bounds.

    Returns:
        The share, a joint velocity that gives it, and what stops it from being larger.
    """
    from scipy.optimize import linprog  # its 0.2 s are for the runs that need it

    n, _, p = qp.sizes
    # In units of b's largest entry: b may be a thousand times what the arm can do.
    scale = float(np.abs(qp.b).max(initial=0.0)) or 1.0
    found = linprog(
        np.append(np.zeros(n), -1.0),
        A_eq=np.column_stack([qp.A, -qp.b / scale]) if p else None,
        b_eq=np.zeros(p) if p else None,
        bounds=np.vstack([np.column_stack([qp.lb, qp.ub]), [0.0, scale]]),
        method="highs-ds",
        options=_LINEAR,
    )
    if found.x is None or found.status != 0:
        return Reach(np.nan, np.clip(np.zeros(n), qp.lb, qp.ub), np.zeros(n, np.int8))
    push = -(found.lower.marginals[:n] + found.upper.marginals[:n])
    dq: Vector = np.clip(found.x[:n], qp.lb, qp.ub)
    return Reach(min(float(found.x[n]) / scale, 1.0), dq, _sides(push))


def least_violation(qp: QP, damping: float | None = None) -> Reach:
    """The joint velocity inside the bounds that violates the task rows least, weighted and damped.

    Orientation rows count `ROTATION_LENGTH` beside the position's 1. Undamped, an arm that is
    pulled beyond its reach would swing over the singular pose and back at every step; so the
    squared joint velocity is added, times ``DAMPING`` and the violation that is left without it.
    A violation that vanishes leaves no damping.

    Args:
        qp: A program without inequality rows, finite but for its bounds.
        damping: The factor of the squared joint velocity; None: as said above.

    Returns:
        Fraction 1, since the clock runs on; the velocity; the bounds that stand in the way.
    """
    weights = np.full(qp.b.size, ROTATION_LENGTH)
    weights[:3] = 1.0
    rows, rhs = weights[:, np.newaxis] * qp.A, weights * qp.b
    if damping is None:
        left = float(np.linalg.norm(rhs - rows @ _bounded_least_squares(rows, rhs, qp)))
        damping = DAMPING * left
    n = qp.sizes[0]
    rows = np.vstack([rows, np.sqrt(damping) * np.eye(n)])
    rhs = np.append(rhs, np.zeros(n))
    dq = _bounded_least_squares(rows, rhs, qp)
    push = rows.T @ (rhs - rows @ dq)
    slack = np.where(push > 0.0, qp.ub - dq, dq - qp.lb)
    at_bound = slack <= 1e-12 * (1.0 + np.abs(dq))
    return Reach(1.0, dq, _sides(np.where(at_bound, push, 0.0)))


def _bounded_least_squares(rows: Matrix, rhs: Vector, qp: QP) -> Vector:
    """The point inside the bounds of `qp` with the least |rows x - rhs|.

    By the active-set method of P. B. Stark and R. L. Parker, "Bounded-variable least-squares"
    (1995), in scipy.
    """
    from scipy.optimize import lsq_linear

    dq: Vector = np.clip(np.zeros(qp.sizes[0]), qp.lb, qp.ub)
    free = qp.lb < qp.ub  # a joint far outside its limits has one velocity left
    if free.any():
        bounds = (qp.lb[free], qp.ub[free])
        wanted = rhs - rows[:, ~free] @ dq[~free]
        # By default it stops after n changes of its active set, which is too few.
        found = lsq_linear(rows[:, free], wanted, bounds, "bvls", tol=1e-14, max_iter=1000)
        dq[free] = np.clip(found.x, *bounds)
    return dq


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


def _slowed(qp: QP, solver: DNNSolver, reach: Reach) -> Resolution:
    """The answer to the program with the share of b that `reach` gives."""
    n, _, p = qp.sizes
    for share in _SHARES if _rest_is_allowed(qp) else _SHARES[:1]:
        fraction, dq = share * reach.fraction, share * reach.dq
        attainable = QP.from_data(qp.data.copy(), qp.sizes)
        # Not s b: this right-hand side has a solution to the last bit.
        attainable.b[:] = qp.A @ dq
        solution = solver.solve(attainable)
        if solution.found:
            return Resolution(Action.SLOW, attainable, solution, fraction, reach.sides)
        reference = ask_reference(attainable, solver.tol)
        if reference is not None:
            return Resolution(Action.SLOW, attainable, reference, fraction, reach.sides)
    dq = _nearly(attainable)
    residuals = attainable.residuals(dq, None, None, None)
    point = np.concatenate([dq, np.zeros(p + n)])
    unsettled = Solution(point, qp.sizes, Status.NOT_SETTLED, 0, 0.0, *residuals)
    return Resolution(Action.SLOW, attainable, unsettled, fraction, reach.sides)


def _braked(qp: QP, reach: Reach) -> Reach:
    """Less of a velocity for which the joints race and the tip hardly moves; see ``SINGULAR``."""
    tip, joints = np.linalg.norm(qp.A @ reach.dq), np.linalg.norm(reach.dq)
    if tip >= SINGULAR * joints or not _rest_is_allowed(qp):
        return reach
    share = float(tip / (SINGULAR * joints))
    if share * reach.fraction < REST:
        share = 0.0
    return Reach(share * reach.fraction, share * reach.dq, reach.sides)


def _rest_is_allowed(qp: QP) -> bool:
    return bool((qp.lb <= 0.0).all() and (qp.ub >= 0.0).all())


def _settled(action: Action, qp: QP, dq: Vector, fraction: float, sides: Sides) -> Resolution:
    """A velocity that is decided already, as the solution of a program of the usual shape.

    The program asks for what dq gives, and among that for what is nearest to dq.
    """
    decided = QP.from_data(qp.data.copy(), qp.sizes)
    decided.b[:] = qp.A @ dq
    decided.q[:] = -(qp.P @ dq)
    n, m, p = qp.sizes
    point = np.concatenate([dq, np.zeros(n + m + p)])
    residuals = decided.residuals(dq, None, None, None)
    answer = Solution(point, qp.sizes, Status.SOLVED, 0, 0.0, *residuals)
    return Resolution(action, decided, answer, fraction, sides)


def _nearly(qp: QP) -> Vector:
    """The best point by the objective that fulfils the task nearly.

    For programs on the edge, whose multipliers nobody finds: the task rows become a penalty.
    """
    # 0.5 x'P x + q'x = 0.5 |L'x + w|^2 with P = L L' and L w = q; P may be singular by a hair.
    factor = np.linalg.cholesky(qp.P + 1e-12 * np.eye(qp.sizes[0]))
    rows = np.vstack([factor.T, _PENALTY * qp.A])
    rhs = np.append(-np.linalg.solve(factor, qp.q), _PENALTY * qp.b)
    return _bounded_least_squares(rows, rhs, qp)


def stopped(qp: QP, failed: Solution, sides: Sides | None = None) -> Resolution:
    """No velocity, with the residuals of the answer that was not to be had.

    Args:
        qp: The step's program, n variables.
        failed: The network's last word on it.
        sides: Which bounds stood in the way, (n,), where that is known.
    """
    still = failed._replace(point=np.zeros_like(failed.point))
    sides = np.zeros(qp.sizes[0], np.int8) if sides is None else sides
    return Resolution(Action.STOP, qp, still, 0.0, sides)


def _sides(push: Vector) -> Sides:
    """Signs of the multipliers that are more than rounding."""
    largest = float(np.abs(push).max(initial=0.0))
    return np.where(np.abs(push) > 1e-9 * largest, np.sign(push), 0.0).astype(np.int8)
