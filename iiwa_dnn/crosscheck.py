"""The same program, asked of an established solver, and how far its answer is from ours.

The reference gets P, q, A, b, lb and ub (and G, h where there are any) through qpsolvers, and
nothing of the network's state. Its own residuals are looked at before it is believed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import qpsolvers
import scipy.sparse as spa

from iiwa_dnn.exceptions import InvalidInputError
from iiwa_dnn.qp import QP, Vector

# Tight enough that a gap of 1e-6 rad/s says something about the network and not about the
# reference. OSQP at its defaults (1e-3) would not do; polishing takes it to machine precision.
_SOLVER_OPTIONS: dict[str, dict[str, Any]] = {
    "proxqp": {
        "backend": "dense",
        "eps_abs": 1e-10,
        "eps_rel": 0.0,
        # Off by default, and the gap of an answer called solved was then seen at 1e-4.
        "check_duality_gap": True,
        "eps_duality_gap_abs": 1e-9,
    },
    "osqp": {
        "eps_abs": 1e-9,
        "eps_rel": 0.0,
        "polishing": True,
        "max_iter": 50_000,
        "raise_error": False,
    },
}
SOLVERS = tuple(_SOLVER_OPTIONS)


@dataclass(frozen=True)
class Agreement:
    """What k reference solvers say of one answer; NaN gaps where a reference failed.

    Attributes:
        solution_gap: Largest difference in x, (k,); joint velocities in [rad/s].
        objective_gap: Absolute difference in the objective, (k,).
        reference_residual: Largest KKT residual of each reference, (k,); inf without an answer.
    """

    solution_gap: Vector
    objective_gap: Vector
    reference_residual: Vector

    @classmethod
    def worst(cls, agreements: list[Agreement]) -> Agreement:
        """The largest gaps and residuals of several, as for the stages of one control step."""
        if len(agreements) == 1:
            return agreements[0]
        return cls(
            np.maximum.reduce([a.solution_gap for a in agreements]),
            np.maximum.reduce([a.objective_gap for a in agreements]),
            np.maximum.reduce([a.reference_residual for a in agreements]),
        )


@dataclass(frozen=True)
class CrossCheck:
    """Reference solvers and what counts as agreement.

    Attributes:
        solvers: Names of the references, out of ``SOLVERS``; none switches the check off.
        tolerance: Largest gap in x that counts as agreement [rad/s].
        reference_tolerance: Largest KKT residual at which a reference is believed.
    """

    solvers: tuple[str, ...] = ("proxqp",)
    tolerance: float = 1e-6
    reference_tolerance: float = 1e-8
    _options: dict[str, dict[str, Any]] = field(
        default_factory=lambda: _SOLVER_OPTIONS, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        """Check the names and the tolerances; raises InvalidInputError naming the argument."""
        for name in self.solvers:
            if name not in SOLVERS:
                known = ", ".join(SOLVERS)
                raise InvalidInputError("solvers", f"{name!r} is not one of {known}", name)
        for name in ("tolerance", "reference_tolerance"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0):
                raise InvalidInputError(name, f"must be a positive number, not {value}", value)

    def check(self, qp: QP, x: Vector) -> Agreement:
        """Ask every reference for the program's solution and compare.

        Args:
            qp: The program, n variables.
            x: The answer to be judged, (n,).

        Returns:
            Gaps and residuals, one entry per reference.
        """
        count = len(self.solvers)
        solution_gap, objective_gap = np.full(count, np.nan), np.full(count, np.nan)
        residual = np.full(count, np.inf)
        problem = qp.to_qpsolvers()
        for i, name in enumerate(self.solvers):
            reference = self._solve(name, problem)
            if reference is None or reference.x is None:
                continue
            residual[i] = max(
                reference.primal_residual(), reference.dual_residual(), reference.duality_gap()
            )
            if residual[i] <= self.reference_tolerance:
                best = reference.x
                solution_gap[i] = np.abs(x - best).max()
                # As a difference of points: subtracting two objectives would cancel.
                step = x - best
                objective_gap[i] = abs(step @ (qp.P @ (x + best)) / 2.0 + qp.q @ step)
        return Agreement(solution_gap, objective_gap, residual)

    def settings(self) -> dict[str, Any]:
        """What the record says of the check."""
        return {
            "solvers": list(self.solvers),
            "tolerance": self.tolerance,
            "reference_tolerance": self.reference_tolerance,
        }

    def _solve(self, name: str, problem: qpsolvers.Problem) -> qpsolvers.Solution | None:
        """The reference's solution, or None where it has none."""
        if name == "osqp":  # takes sparse matrices only, and qpsolvers warns when it converts
            problem = qpsolvers.Problem(
                spa.csc_matrix(problem.P),
                problem.q,
                None if problem.G is None else spa.csc_matrix(problem.G),
                problem.h,
                None if problem.A is None else spa.csc_matrix(problem.A),
                problem.b,
                problem.lb,
                problem.ub,
            )
        try:
            solution = qpsolvers.solve_problem(problem, solver=name, **self._options[name])
        except qpsolvers.exceptions.QPError:
            return None
        return solution if solution.found else None
