"""Answers to the programs of a loop that its compiled step does not give."""

import numpy as np

from iiwa_dnn.control.plan import Plan
from iiwa_dnn.control.policies import Policy, Resolution, gave_way, resolve, stopped
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Solution


def answer(
    plan: Plan, qp: QP, solver: DNNSolver, policy: Policy, duration: float
) -> tuple[Solution, Resolution | None]:
    """Answer a program by the network or, where it has no answer, by the policy.

    Args:
        plan: The loop's plan, which knows whether the arm brakes or its task yields.
        qp: The step's program.
        solver: The network.
        policy: One of ``POLICIES``.
        duration: Time that the network advances [s]; 0: it settles.

    Returns:
        The answer, and the policy's decision if there was one.

    Raises:
        NoSolutionError: There is no solution and the policy is ``raise``.
    """
    decision = _decided(plan, qp, policy)
    if decision is None:
        found = solver.solve(qp) if duration == 0.0 else solver.advance(qp, duration)
        if found.status is plan.expected:
            return found, None
        if duration > 0.0:  # it is no longer a number
            decision = stopped(qp, found, yielding=plan.yielding)
        else:
            decision = resolve(qp, found, policy, solver, plan.row_weights, plan.yielding)
            plan.stick(True)
    return decision.solution, decision


def _decided(plan: Plan, qp: QP, policy: Policy) -> Resolution | None:
    """Decide without the network: while the arm brakes, and while the task still yields."""
    yielding, halted = plan.yielding, plan.halted
    if halted is not None:
        braking = stopped(qp, halted.solution, yielding=yielding)
        return braking._replace(sides=halted.sides, rows=halted.rows)
    if yielding is None or not plan.stuck or policy not in ("slow", "relax"):
        return None
    if not np.isfinite(qp.b).all():
        return None
    reach, fits = yielding.answer(qp)
    # Where the program may have a solution again, the network is asked.
    plan.stick(not fits)
    return None if fits else gave_way(qp, policy, reach)
