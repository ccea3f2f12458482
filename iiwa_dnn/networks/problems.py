"""One problem, solved from a cold start."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.certificates import certified
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import SOLVE, Solution, Status

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
    solver = DNNSolver(tol=tol) if solver is None else solver
    checks.instance("solver", solver, DNNSolver).reset()
    return solve_cost_of_any_size(solver, qp, sharpen).to_qpsolvers(problem)


def solve_cost_of_any_size(solver: DNNSolver, qp: QP, sharpen: bool = False) -> Solution:
    """Solve a program whose values were checked, a slight cost scaled to 1.

    Of a slight cost, any x at all would be within an absolute tolerance on the residuals.
    """
    n = qp.sizes[0]
    scaled = QP.from_data(qp.data.copy(), qp.sizes)
    cost = scaled.data[: n * n + n]
    largest = float(np.abs(cost).max())
    scale = largest if 0.0 < largest < _SLIGHT else 1.0
    cost /= scale
    solution = solver.solve(scaled)
    if sharpen:
        solution = solver.sharpen(scaled, solution)
    # What was shown of multipliers was shown of the scaled ones.
    if solution.certificate is not None and certified(qp, solution.certificate) != solution.status:
        solution = solution._replace(status=Status.NOT_SETTLED, certificate=None)
    solution.point[n:] *= scale
    return solution._replace(dual=solution.dual * scale, gap=solution.gap * scale)


SOLVE.append(solve_problem)
