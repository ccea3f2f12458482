"""One problem, solved from a cold start."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from iiwa_dnn import checks
from iiwa_dnn.networks.integrators import ImplicitEuler
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import SOLVE

if TYPE_CHECKING:
    import qpsolvers


def solve_problem(
    problem: qpsolvers.Problem | QP,
    tol: float = 1e-9,
    solver: DNNSolver | None = None,
    sharpen: bool = False,
    eps_rel: float = 0.0,
    max_iter: int = 1000,
) -> qpsolvers.Solution:
    """Solve one convex quadratic program with a dynamic neural network, from a cold start.

    Args:
        problem: Dense or sparse; n variables, p equalities, m inequalities, bounds.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        solver: Network and integrator to use; the default integrates the paper's network
            implicitly. Its state is reset first, and its own settings replace `tol`, `eps_rel` and
            `max_iter`.
        sharpen: Take a few more steps down to rounding, for about a third more time.
        eps_rel: Tolerance on each entry of a residual, relative to the sum of its absolute terms.
        max_iter: Largest number of linear solves.

    Returns:
        The solution with x (n,), y (p,), z (m,), z_box (n,), obj, and in `extras` the status,
        the iterations, the residuals and the network time in units of rho. `found` is False
        where there is none within the tolerance.

    Raises:
        InvalidInputError: The problem is malformed or not convex, or a setting is out of range; the
            message names the argument.
    """
    if isinstance(problem, QP):
        qp = QP(*problem.views)
        problem = problem.to_qpsolvers()
    else:
        qp = QP.from_qpsolvers(problem)
    qp.check_numbers()
    if solver is None:
        solver = default_solver(
            checks.positive("tol", tol),
            checks.not_negative("eps_rel", eps_rel),
            checks.integer("max_iter", max_iter, 1),
        )
    solution = checks.instance("solver", solver, DNNSolver).solve_cold(qp, sharpen)
    if not solution.found:
        qp.check_values()  # an answer that was found belongs to a convex program
    return solution.to_qpsolvers(problem)


@lru_cache
def default_solver(tol: float, eps_rel: float, max_iter: int) -> DNNSolver:
    """Return the solver with these settings, made once: checks of settings take time."""
    return DNNSolver(tol=tol, eps_rel=eps_rel, solve_integrator=ImplicitEuler(max_steps=max_iter))


SOLVE.append(solve_problem)
