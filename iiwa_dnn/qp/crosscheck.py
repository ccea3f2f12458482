"""Cross-check of an answer by an established solver for the same program, or by a proof.

A reference gets the program, in units near 1, and nothing of the network's state, and is believed
only where its own KKT residual is small. If the one that was asked has no such answer, a second one
is asked, and the agreement says which of both judged. "proof" stands among the references for
`iiwa_dnn.qp.proof`, which asks no other solver.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.qp.agreement import (
    Agreement,
    feasibility_gaps,
    normalised,
    objective_gaps,
    solution_gap,
    stacked,
)
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.proof import prove_point
from iiwa_dnn.qp.reference_solvers import reference_solver

PROOF = "proof"
"""Name of the proof among the references."""

SECOND = {"proxqp": "osqp", PROOF: None}
"""Solvers that are asked where another one has no answer; "proxqp" for all others."""


_Verdicts = tuple[Matrix, Vector, Vector, NDArray[np.int64]]
"""Of N points and one reference: steps in x away from its answers (N, n), and solution gaps,
residuals and judges of `Agreement`, (N,)."""


@dataclass(frozen=True)
class CrossCheck:
    """References, and the tolerances of an agreement.

    Attributes:
        solvers: Names of the references: solvers that qpsolvers finds installed, and ``"proof"``;
            none switches the check off.
        tolerance: Largest gap that counts as agreement, in x [rad/s], objective and feasibility.
        reference_tolerance: Largest KKT residual at which a reference is believed; rounding is
            forgiven as by `QP.accepts`, and the residual then counts as this tolerance.
    """

    solvers: tuple[str, ...] = ("proxqp",)
    tolerance: float = 1e-6
    reference_tolerance: float = 1e-8

    def __post_init__(self) -> None:
        """Check the names and the tolerances; raises InvalidInputError naming the argument."""
        for name in checks.offers("solvers", self.solvers, "__iter__"):
            if name not in ("proxqp", "osqp", PROOF):
                checks.one_of("solvers", name, references())
        checks.positive("tolerance", self.tolerance)
        checks.positive("reference_tolerance", self.reference_tolerance)

    def settings(self) -> dict[str, Any]:
        """Return references and tolerances, as values that JSON can hold."""
        return {
            "solvers": list(self.solvers),
            "second": [SECOND.get(name, "proxqp") for name in self.solvers],
            "tolerance": self.tolerance,
            "reference_tolerance": self.reference_tolerance,
        }

    def check(self, qp: QP, answer: Vector) -> Agreement:
        """Ask every reference for the solution of `qp` and compare, N = 1.

        Args:
            qp: The program, n variables.
            answer: The answer to be judged: x (n,), or `Solution.point` (2 n + m + p,), whose
                multipliers a proof begins with.
        """
        n, m, p = qp.sizes
        point = np.asarray(answer)
        check_size("answer", point, n if point.size == n else 2 * n + m + p)
        return self.check_block(qp.data[np.newaxis], qp.sizes, point[np.newaxis])

    def check_block(self, programs: Matrix, sizes: Sizes, answers: Matrix) -> Agreement:
        """Ask every reference for the solutions of N programs of one shape and compare.

        Args:
            programs: One `QP.data` a row.
            sizes: Their `QP.sizes`.
            answers: The answers to be judged: x (N, n), or points (N, 2 n + m + p).

        Returns:
            Gaps, residuals and judges, one row a program and one column a reference.
        """
        n, m, p = sizes
        points = np.zeros((len(answers), 2 * n + m + p))
        points[:, : answers.shape[1]] = answers
        judge = np.empty((len(points), len(self.solvers)), dtype=np.int8)
        solution = np.empty(judge.shape)
        residual = np.empty(judge.shape)
        steps = np.empty((*judge.shape, n))
        scaled = normalised(programs, sizes)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # OSQP's, of dense matrices
            for k, name in enumerate(self.solvers):
                steps[:, k], solution[:, k], residual[:, k], judge[:, k] = (
                    _prove(programs, sizes, points)
                    if name == PROOF
                    else self._compare(name, scaled, sizes, points)
                )
        block = stacked(programs, sizes)
        objective = objective_gaps(block, points[:, :n], steps)
        feasibility = np.where(judge.T < 0, np.nan, feasibility_gaps(block, points[:, :n])).T
        return Agreement(solution, objective, feasibility, residual, judge)

    def _compare(self, name: str, programs: Matrix, sizes: Sizes, points: Matrix) -> _Verdicts:
        """Compare x of points (N, 2 n + m + p) with the answers of a solver.

        Where the solver has no answer that is believed, the second one of `SECOND` is asked.
        """
        n = sizes[0]
        qps = [QP.from_data(program, sizes) for program in programs]
        references = np.full_like(points, np.nan)
        residuals = np.full(len(points), np.inf)
        judge = np.full(len(points), -1)
        block = stacked(programs, sizes)
        # A solver may take minutes over one NaN, and OSQP has words of its own for crossed bounds.
        wrong = np.isnan(programs).any(axis=1) | (block.lb > block.ub).any(axis=1)
        for code, solver in enumerate((name, SECOND.get(name) or "proxqp")):
            left = np.flatnonzero(~wrong & (judge < 0))
            solve = reference_solver(solver, sizes) if left.size else None
            for i in left:
                reference, residuals[i] = self._ask(solve, qps[i])
                if residuals[i] <= self.reference_tolerance:
                    references[i] = reference
                    judge[i] = code
        steps = points[:, :n] - references[:, :n]
        gaps = np.abs(steps).max(axis=1, initial=0.0)
        for i in np.flatnonzero(gaps > self.tolerance):
            gaps[i] = solution_gap(qps[i], references[i], points[i, :n], self.tolerance)
        return steps, gaps, residuals, judge

    def _ask(self, solve: Any, qp: QP) -> tuple[Vector, float]:
        """Solve a program by a reference; return its point and its largest residual.

        Without an answer the residual is inf; if it is rounding, it counts as the tolerance.
        """
        try:
            point = solve(qp)
        except Exception:  # whatever a reference raises, it has no answer
            return qp.data[:0], np.inf
        if np.isnan(point[0]):
            return point, np.inf
        residual = qp.residuals(point).largest
        tolerance = self.reference_tolerance
        if tolerance < residual < np.inf and qp.accepts(point, tolerance):
            residual = tolerance
        return point, residual


def references() -> list[str]:
    """List the names of references: solvers that qpsolvers finds installed, and the proof."""
    import qpsolvers  # with scipy.sparse, 0.2 s that not every run needs

    return [name for name in qpsolvers.available_solvers if name != "iiwa_dnn"] + [PROOF]


def _prove(programs: Matrix, sizes: Sizes, points: Matrix) -> _Verdicts:
    """Bound the distances of points (N, 2 n + m + p) from their solutions, by `prove_point`.

    The steps returned are those within each bound that change the objective most, to first order.
    """
    qps = [QP.from_data(program, sizes) for program in programs]
    bounds = np.array([prove_point(*pair).bound for pair in zip(qps, points, strict=True)])
    is_proven = bounds < np.inf
    block = stacked(programs, sizes)
    gradients = (block.P @ points[:, : sizes[0], np.newaxis])[..., 0] + block.q
    steps = np.copysign(bounds[:, np.newaxis], gradients)
    return steps, bounds, np.where(is_proven, 0.0, np.inf), is_proven - 1
