r"""Policies for a step whose program has no solution, or one that the network did not find.

A program without a solution asks for a task velocity b that no joint velocity within the limits
gives. Every policy that goes on replaces b by one that can be had and leaves bounds and inequality
rows alone, so no limit is ever relaxed, and the check gets a program of the usual shape:

``slow``
    :math:`b' = s\,b` with the largest feasible :math:`s \in [0, 1]`, the solution of the linear
    program :math:`\max s` subject to :math:`A \dot q = s\,b`, the bounds and
    :math:`G \dot q \le h`. Feedforward and feedback are slowed alike, and the reference's clock has
    to advance by s dt: then the arm goes along the same path, later. If not even standing still
    is feasible, since a joint outside its limits has to come back or an obstacle comes near, the
    task yields as with ``relax``. So it does in a singular pose, in which the arm would stay for
    good; the clock creeps on by a tenth, until the path leads out of it.
``relax``.
``relax``
    :math:`b' = A \dot q'` with :math:`\dot q'` the point within the limits that violates the task
    rows least, :math:`\min \|A \dot q' - b\|_W`, damped, and the objective is to be near it: a
    wish to come back to the home posture would shake an arm that is stretched. The clock runs on.
``stop``
    No velocity; the run ends.
``raise``
    A `NoSolutionError` with the program inside.

The multipliers of the first two problems name the bounds and rows that stand in the way. If the
limits contradict each other, so that no velocity is within all of them, the arm stops. A program
that has a solution which the network missed is answered by the reference solver, whatever the
policy.

With limits on acceleration or jerk, ``slow`` and ``relax`` approach the task's velocity as
`iiwa_dnn.control.yielding` says, the clock of ``slow`` by the share of it that is reached, and
``stop`` brakes until the arm stands.

Sources: J. M. Hollerbach, "Dynamic scaling of manipulator trajectories", Journal of Dynamic
Systems, Measurement, and Control 106 (1984); for velocity limits, F. Flacco, A. De Luca, O. Khatib,
"Control of redundant robots under hard joint constraints", IEEE Trans. Robotics 31 (2015).
"""

from enum import IntEnum
from typing import Literal, NamedTuple

import numpy as np

from iiwa_dnn.control.reach import Reach, Sides, ask_reference, largest_fraction, least_violation
from iiwa_dnn.control.yielding import CREEP, Yielding
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Solution, Status, Vector

Policy = Literal["slow", "relax", "stop", "raise"]
POLICIES: tuple[Policy, ...] = ("slow", "relax", "stop", "raise")

_FEASIBLE = 1.0 - 1e-9  # the linear program's own tolerance is 1e-10

SINGULAR = 0.05
"""Below it a pose counts as singular: what the tip moves for each unit of joint velocity [m/rad].
There the joints would race for next to nothing; ``slow`` goes slower in proportion."""

REST = 1e-3
"""A fraction below it, in a singular pose, is none: the task yields, and the clock creeps on."""

# At the very edge of what is feasible the multipliers may grow without bound; seen at one step in
# 150 of random ones, where a little less has room enough.
_SHARES = (1.0, 0.99, 0.9)


class Action(IntEnum):
    """Action at a step in place of the network's answer; its code in a record."""

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
    EULER = 5
    """A later stage of midpoint or RK4 had no solution: an Euler step was taken."""


class Resolution(NamedTuple):
    """Decision of a policy at one step.

    Attributes:
        action: What was done.
        qp: The program that was answered: the step's own, or the one with b replaced.
        solution: The answer to it. One that nothing settled has its large residuals.
        fraction: By which share of a control period the reference's clock advances, in [0, 1].
        sides: Bounds that stood in the way, (n,): 1 upper, -1 lower, 0 neither.
        rows: Inequality rows that stood in the way, (m,): 1 or 0.
    """

    action: Action
    qp: QP
    solution: Solution
    fraction: float
    sides: Sides
    rows: Sides


def resolve(
    qp: QP,
    failed: Solution,
    policy: Policy,
    solver: DNNSolver,
    weights: Vector | None = None,
    yielding: Yielding | None = None,
) -> Resolution:
    """Decide what to do at a step that the network did not solve.

    Args:
        qp: The step's program: n variables, m inequality rows, p task rows.
        failed: The network's last word on it.
        policy: One of ``POLICIES``.
        solver: The network, for the program with another b; its tolerance holds for all answers.
        weights: `StepProgram.row_weights`, (p,); None weighs all task rows alike.
        yielding: Answers where there are limits on acceleration or jerk; then ``slow`` and
            ``relax`` take its command, and differ in the clock alone.

    Returns:
        The decision. Its joint velocity is inside the bounds of `qp`, but for ``stop``'s zero
        where no acceleration or jerk is limited.

    Raises:
        NoSolutionError: The policy is ``raise`` and the program has no solution; it carries the
            program.
    """
    if np.isnan(qp.data).any() or not np.isfinite(qp.b).all():
        return stopped(qp, failed, yielding=yielding)
    if yielding is not None and policy in ("slow", "relax"):
        return _yielded(qp, failed, policy, solver, yielding)
    largest = largest_fraction(qp)
    if largest.fraction >= _FEASIBLE:
        fallback = _fallback(qp, solver.tol)
        if fallback is not None:
            return fallback
    if policy == "raise":
        message = "no joint velocity inside the bounds fulfils the task"
        problem = qp.to_qpsolvers()
        raise NoSolutionError(message, problem, failed.to_qpsolvers(problem))
    if policy == "stop":
        return stopped(qp, failed, largest, yielding)
    scales = policy == "slow" and not np.isnan(largest.fraction)
    slower = _slower(qp, solver, largest) if scales else None
    return slower or _relaxed(qp, failed, largest, weights, scales)


def _yielded(
    qp: QP, failed: Solution, policy: Policy, solver: DNNSolver, yielding: Yielding
) -> Resolution:
    """Decide where there are limits on acceleration or jerk."""
    missed = failed.status is Status.NOT_SETTLED
    fallback = _fallback(qp, solver.tol) if missed else None
    return fallback or gave_way(qp, policy, yielding.answer(qp).reach)


def _relaxed(
    qp: QP, failed: Solution, largest: Reach, weights: Vector | None, creeps: bool
) -> Resolution:
    """Decide for the least violation of the tasks; the clock runs on, or creeps."""
    relaxed = least_violation(qp, weights)
    if relaxed is None:
        return stopped(qp, failed, largest)
    if creeps:
        return _settled(Action.SLOW, qp, relaxed._replace(fraction=CREEP))
    return _settled(Action.RELAX, qp, relaxed)


def _fallback(qp: QP, tol: float) -> Resolution | None:
    """Decide for the reference solver's answer, if it has one."""
    reference = ask_reference(qp, tol)
    if reference is None:
        return None
    n, m, _ = qp.sizes
    none = (np.zeros(n, np.int8), np.zeros(m, np.int8))
    return Resolution(Action.FALLBACK, qp, reference, 1.0, *none)


def _slower(qp: QP, solver: DNNSolver, largest: Reach) -> Resolution | None:
    """Decide for a part of the task velocity; None in a singular pose, which would hold the arm."""
    factor = _brake(qp, largest)
    fraction = factor * largest.fraction
    if fraction < REST and factor < 1.0:
        return None
    slower = largest._replace(fraction=fraction, dq=factor * largest.dq)
    if not slower.dq.any() and _rest_is_allowed(qp):
        return _settled(Action.SLOW, qp, slower)
    return _slowed(qp, solver, slower)


def gave_way(qp: QP, policy: Policy, reach: Reach) -> Resolution:
    """Decide for the command of a `Yielding`; with ``relax`` the clock runs on."""
    if policy == "slow":
        return _settled(Action.SLOW, qp, reach)
    return _settled(Action.RELAX, qp, reach._replace(fraction=1.0))


def _slowed(qp: QP, solver: DNNSolver, reach: Reach) -> Resolution:
    """Answer the program with the share of b that `reach` gives."""
    for share in _SHARES if _rest_is_allowed(qp) else _SHARES[:1]:
        slower = reach._replace(fraction=share * reach.fraction, dq=share * reach.dq)
        attainable = QP.from_data(qp.data.copy(), qp.sizes)
        # Not s b: this right-hand side has a solution to the last bit.
        attainable.b[:] = qp.A @ slower.dq
        solution: Solution | None = solver.solve(attainable)
        if solution is not None and not solution.found:
            solution = ask_reference(attainable, solver.tol)
        if solution is not None:
            return Resolution(Action.SLOW, attainable, solution, *slower[:1], *slower[2:])
    # On the edge, where nobody finds the multipliers: the linear program's own point will do.
    residuals = attainable.residuals(slower.dq, None, None, None)
    point = np.concatenate([slower.dq, np.zeros(qp.sizes[0] + qp.sizes[1] + qp.sizes[2])])
    unsettled = Solution(point, qp.sizes, Status.NOT_SETTLED, 0, 0.0, *residuals)
    return Resolution(Action.SLOW, attainable, unsettled, *slower[:1], *slower[2:])


def _brake(qp: QP, reach: Reach) -> float:
    """Compute the share of a velocity to take where joints race and the tip hardly moves."""
    tip = np.linalg.norm(qp.A @ reach.dq)
    joints = np.linalg.norm(reach.dq)
    if tip >= SINGULAR * joints or not _rest_is_allowed(qp):
        return 1.0
    return float(tip / (SINGULAR * joints))


def _rest_is_allowed(qp: QP) -> bool:
    return bool((qp.lb <= 0.0).all() and (qp.ub >= 0.0).all() and (qp.h >= 0.0).all())


def _settled(action: Action, qp: QP, reach: Reach) -> Resolution:
    """A velocity that is decided already, as the solution of a program of the usual shape.

    The program asks for what it gives, and among that for what is nearest to it.
    """
    decided = QP.from_data(qp.data.copy(), qp.sizes)
    decided.b[:] = qp.A @ reach.dq
    decided.q[:] = -(qp.P @ reach.dq)
    n, m, p = qp.sizes
    point = np.concatenate([reach.dq, np.zeros(n + m + p)])
    residuals = decided.residuals(reach.dq, None, None, None)
    answer = Solution(point, qp.sizes, Status.SOLVED, 0, 0.0, *residuals)
    return Resolution(action, decided, answer, reach.fraction, reach.sides, reach.rows)


def stopped(
    qp: QP, failed: Solution, reach: Reach | None = None, yielding: Yielding | None = None
) -> Resolution:
    """Decide for no velocity, with the residuals of the answer that was not to be had.

    Args:
        qp: The step's program, n variables.
        failed: The network's last word on it.
        reach: What stood in the way, where that is known.
        yielding: Brakes as quickly as the limits on acceleration and jerk allow, where there are.
    """
    still = failed._replace(point=np.zeros_like(failed.point))
    if yielding is not None:
        braked = yielding.brake(qp)
        still.point[: braked.size] = braked
    n, m, _ = qp.sizes
    sides = np.zeros(n, np.int8) if reach is None else reach.sides
    rows = np.zeros(m, np.int8) if reach is None else reach.rows
    return Resolution(Action.STOP, qp, still, 0.0, sides, rows)
