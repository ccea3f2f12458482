"""Established QP solvers: the settings at which they are asked, and their primal-dual points."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from iiwa_dnn.errors import MissingDependencyError, import_extra
from iiwa_dnn.qp.layout import Sizes, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.proof import point_of

OPTIONS: dict[str, dict[str, Any]] = {
    # Tight enough that a gap of 1e-6 rad/s says something about the network and not about the
    # reference. ProxQP's own tolerance of infeasibility, 1e-4, called 3 of 10 feasible programs
    # infeasible whose bounds are 1e-3 apart; qpsolvers does not hand that option on.
    "proxqp": {
        "eps_abs": 1e-10,
        "eps_rel": 0.0,
        "check_duality_gap": True,
        "eps_duality_gap_abs": 1e-9,
        "eps_primal_inf": 0.0,
        "eps_dual_inf": 0.0,
        "max_iter": 100,
    },
    "osqp": {
        "eps_abs": 1e-9,
        "eps_rel": 0.0,
        "polishing": True,
        "max_iter": 10_000,
        "raise_error": False,
    },
    "clarabel": {"tol_feas": 1e-10, "tol_gap_abs": 1e-10, "tol_gap_rel": 0.0},
    "daqp": {"primal_tol": 1e-10, "dual_tol": 1e-10},
    "highs": {"primal_feasibility_tolerance": 1e-10, "dual_feasibility_tolerance": 1e-10},
    "piqp": {"eps_abs": 1e-10, "eps_rel": 0.0, "check_duality_gap": True},
}
"""Settings of ProxQP and keyword arguments of qpsolvers; a solver without any has its defaults."""


NEAR = 1e-4
"""Largest KKT residual at which the last point of a solver that gave up is still an answer: its
residual says how much it is worth, and a proof may begin with its active set."""


def reference_solver(name: str, sizes: Sizes) -> Callable[[QP], Vector]:
    """Make a function that solves programs of these `QP.sizes` with a solver.

    Args:
        name: ProxQP, or a solver of qpsolvers.
        sizes: Sizes of the programs.

    Returns:
        The point [x | y | z | z_box] of a program, (2 n + m + p,), NaN without an answer. What the
        solver raises is passed on.

    Raises:
        MissingDependencyError: The solver cannot be imported.
    """
    if name == "proxqp":
        return ProxQP(sizes)
    import qpsolvers  # with scipy.sparse, 0.2 s that not every run needs

    if name not in qpsolvers.available_solvers:
        raise MissingDependencyError(f"the solver {name}", f"pip install 'qpsolvers[{name}]'")
    return partial(_solve, qpsolvers.solve_problem, name)


def _solve(solve_problem: Callable[..., Any], name: str, qp: QP) -> Vector:
    """Solve a program with a solver of qpsolvers; return its point (2 n + m + p,), or NaN."""
    solution = solve_problem(qp.to_qpsolvers(), name, **OPTIONS.get(name, {}))
    return _answer(qp, point_of(solution, qp), solution.found)


def _answer(qp: QP, point: Vector, is_found: bool | None) -> Vector:
    """Return a solver's last point, or NaN if the solver has not found it and it is not near."""
    is_near = is_found or qp.residuals(point).largest <= NEAR
    return point if is_near else np.full_like(point, np.nan)


class ProxQP:
    """ProxQP by its own interface: qpsolvers does not hand all of its settings on.

    One workspace serves all programs of one shape. `init` clears it, so each starts cold.

    Attributes:
        solver: The workspace, `proxsuite.proxqp.dense.QP`.
    """

    def __init__(self, sizes: Sizes) -> None:
        """Allocate the workspace for programs of these sizes (n, m, p)."""
        n, m, p = sizes
        proxqp = import_extra("proxsuite", "pip install proxsuite").proxqp
        self.solver = proxqp.dense.QP(n, p, m, True)
        for setting, value in OPTIONS["proxqp"].items():
            setattr(self.solver.settings, setting, value)

    def __call__(self, qp: QP) -> Vector:
        """Solve a program for its point (2 n + m + p,)."""
        solver = self.solver
        solver.init(qp.P, qp.q, qp.A, qp.b, qp.G, None, qp.h, qp.lb, qp.ub)
        solver.solve()
        results = solver.results
        point = np.concatenate([results.x, results.y, results.z])
        return _answer(qp, point, results.info.status.name == "PROXQP_SOLVED")
