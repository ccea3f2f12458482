"""One problem, solved from a cold start."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.backend import provide
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Solution

if TYPE_CHECKING:
    import qpsolvers

_SLIGHT = 1e-6
"""Largest entry of a cost below which it is scaled."""


def solve_problem(
    problem: qpsolvers.Problem | QP,
    tol: float = 1e-9,
    solver: DNNSolver | None = None,
    sharpen: bool = False,
) -> qpsolvers.Solution:
    """Solve one convex quadratic program with a dynamic neural network, from a cold start.

    Args:
        problem: Dense or sparse; n variables, p equalities, m inequalities, bounds.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        solver: Network and integrator to use; the default integrates the paper's network
            implicitly. Its state is reset first and its own tolerance replaces `tol`.
        sharpen: Take a few more steps down to rounding, for about a third more time
            (`DNNSolver.sharpen`).

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
    if solver is None:
        solver = DNNSolver(tol=tol)
    else:
        checks.instance("solver", solver, DNNSolver).reset()
    if qp.data.item(0) < _SLIGHT:  # P[0, 0] tells most programs apart without a look at the others
        return _at_unit_cost(qp, solver, sharpen).to_qpsolvers(problem)
    return _solve(qp, solver, sharpen).to_qpsolvers(problem)


def _solve(qp: QP, solver: DNNSolver, sharpen: bool) -> Solution:
    solution = solver.solve(qp)
    return solver.sharpen(qp, solution) if sharpen else solution


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
