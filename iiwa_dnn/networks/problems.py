"""One problem, solved from a cold start."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.backend import provide
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Solution, Status

if TYPE_CHECKING:
    import qpsolvers

_SLIGHT = 1e-6
"""Largest entry of a cost below which it is scaled."""


def solve_problem(
    problem: qpsolvers.Problem | QP,
    tol: float = 1e-9,
    solver: DNNSolver | None = None,
    sharpen: bool = False,
    eps_rel: float = 0.0,
) -> qpsolvers.Solution:
    """Solve one convex quadratic program with a dynamic neural network, from a cold start.

    Args:
        problem: Dense or sparse; n variables, p equalities, m inequalities, bounds.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        solver: Network and integrator to use; the default integrates the paper's network
            implicitly. Its state is reset first and its own tolerance replaces `tol`.
        sharpen: Take a few more steps down to rounding, for about a third more time
            (`DNNSolver.sharpen`).
        eps_rel: Tolerance relative to the largest term of each residual. The network goes on to
            `tol` as far as rounding lets it; its last point is a solution, too, if each residual is
            at most ``tol`` plus `eps_rel` times that term.

    Returns:
        The solution with x (n,), y (p,), z (m,), z_box (n,), obj, and in `extras` the status,
        the iterations, the residuals and the network time in units of rho. `found` is False
        where there is none within the tolerance.

    Raises:
        InvalidInputError: The problem is malformed or not convex; the message names the argument.
    """
    if isinstance(problem, QP):
        qp = problem
        problem = problem.to_qpsolvers()
    else:
        qp = QP.from_qpsolvers(problem)
    qp.check_values()
    checks.not_negative("eps_rel", eps_rel)
    if solver is None:
        solver = DNNSolver(tol=tol)
    else:
        checks.instance("solver", solver, DNNSolver).reset()
    if qp.data.item(0) < _SLIGHT:  # P[0, 0] tells most programs apart without a look at the others
        solution = _at_unit_cost(qp, solver, sharpen)
    else:
        solution = _solve(qp, solver, sharpen)
    if solution.status is Status.NOT_SETTLED and eps_rel > 0.0:
        tolerances = solver.tol + eps_rel * _largest_terms(qp, solution)
        if (np.array(solution.residuals) <= tolerances).all():
            solution = solution._replace(status=Status.SOLVED)
    return solution.to_qpsolvers(problem)


def _solve(qp: QP, solver: DNNSolver, sharpen: bool) -> Solution:
    solution = solver.solve(qp)
    return solver.sharpen(qp, solution) if sharpen else solution


def _largest_terms(qp: QP, solution: Solution) -> Vector:
    """Compute the largest terms of primal residual, dual residual and gap, (3,)."""
    x = solution.x
    y = solution.y
    curved = qp.P @ x
    primal = [x, qp.A @ x, qp.b, qp.G @ x]
    dual = [curved, qp.q, qp.A.T @ y, qp.G.T @ solution.z, solution.z_box]
    gap = [[x @ curved, qp.q @ x, qp.b @ y]]
    return np.array([np.abs(np.concatenate(terms)).max() for terms in (primal, dual, gap)])


def _at_unit_cost(qp: QP, solver: DNNSolver, sharpen: bool) -> Solution:
    """Solve a program; one with a slight cost with the cost divided by its largest entry.

    Any x at all would be within an absolute tolerance on the residuals.
    """
    n = qp.sizes[0]
    largest = float(np.abs(qp.data[: n * n + n]).max())
    if not 0.0 < largest < _SLIGHT:
        return _solve(qp, solver, sharpen)
    data = qp.data.copy()
    data[: n * n + n] /= largest
    solution = _solve(QP.from_data(data, qp.sizes), solver, sharpen)
    point = solution.point.copy()
    point[n:] *= largest
    dual = solution.dual * largest
    return solution._replace(point=point, dual=dual, gap=solution.gap * largest)


provide(solve_problem)
