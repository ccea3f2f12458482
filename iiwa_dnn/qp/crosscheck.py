"""Cross-check of an answer by an established solver for the same program, or by a proof.

A reference gets the program, in units near 1, and nothing of the network's state, and is believed
only where its own KKT residual is small. If the one that was asked has no such answer, a second one
is asked. A proof judges instead (`iiwa_dnn.qp.proof`) where neither is believed, where an answer
disagrees, and where the program is so flat that a point with the reference's residual may be far
from the solution. It begins with the reference's point; one that begins with the answer may clear
it, never blame. Where nothing is proven, as of programs with several solutions, a reference that is
not at the same point judges only if its residual says that it is near one; it does not blame if
some variable's own curvature may be rounding. The agreement names the judge, or nobody.

"proof" stands among the references for a proof of the answer itself, which asks no solver.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import IiwaDnnError, InvalidInputError
from iiwa_dnn.qp.agreement import (
    NOISE,
    Agreement,
    curvatures,
    feasibility_gaps,
    normalised,
    objective_gaps,
    stacked,
    unique_step,
)
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.proof import NOT_CONVEX, enclose_solution, prove_point, touching_point
from iiwa_dnn.qp.reference_solvers import reference_solver

PROOF = "proof"
"""Name of the proof among the references."""

SECOND = {"proxqp": "osqp", PROOF: None}
"""Solvers that are asked where another one has no answer; "proxqp" for all others."""

NOBODY = -1
"""Code of the judge where an answer is neither agreed with nor blamed."""

MARGIN = 3.0
"""Error of a reference that its residual lets expect, in units of that residual over an eigenvalue
of `iiwa_dnn.qp.agreement`."""

BY_PROOF = 2
"""Code of the judge where a proof judged in the place of a solver."""

_Verdicts = tuple[Matrix, Vector, Vector, NDArray[np.int64]]
"""Of N points and one reference: steps in x away from the solutions (N, n), and solution gaps,
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

        Raises:
            MissingDependencyError: A reference that is asked cannot be imported.
            InvalidInputError: A reference returns an array of a wrong size.
        """
        n, m, p = sizes
        points = np.zeros((len(answers), 2 * n + m + p))
        points[:, : answers.shape[1]] = answers
        judge = np.empty((len(points), len(self.solvers)), dtype=np.int8)
        solution, residual = np.empty((2, *judge.shape))
        steps = np.empty((*judge.shape, n))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # OSQP's, of dense matrices
            for k, name in enumerate(self.solvers):
                steps[:, k], solution[:, k], residual[:, k], judge[:, k] = (
                    _prove(programs, sizes, points)
                    if name == PROOF
                    else self._compare(name, programs, sizes, points)
                )
        block = stacked(programs, sizes)
        objective = objective_gaps(block, points[:, :n], steps)
        feasibility = np.where(judge.T < 0, np.nan, feasibility_gaps(block, points[:, :n])).T
        return Agreement(solution, objective, feasibility, residual, judge)

    def _compare(self, name: str, programs: Matrix, sizes: Sizes, points: Matrix) -> _Verdicts:
        """Compare x of points (N, 2 n + m + p) with the answers of a solver.

        Where that is not enough for a verdict, a proof is asked.
        """
        x = points[:, : sizes[0]]
        scaled, factors = normalised(programs, sizes)
        references = np.full_like(points, np.nan)
        residuals, judge = self._ask(name, scaled, sizes, references)
        steps = x - factors * references[:, : sizes[0]]
        steps[judge < 0] = np.nan
        gaps = np.abs(steps).max(axis=1, initial=0.0)
        of_cost = objective_gaps(stacked(programs, sizes), x, steps[:, np.newaxis])[:, 0]
        is_far = np.maximum(gaps, of_cost) > self.tolerance
        errors = MARGIN * residuals * factors.max(axis=1, initial=0.0)
        agrees = (judge >= 0) & ~is_far
        curved = np.linalg.eigvalsh(stacked(scaled[agrees], sizes).P).min(axis=1, initial=np.inf)
        agrees[agrees] = curved * self.tolerance > errors[agrees]
        root = curvatures(stacked(programs, sizes))
        faint = np.any((root > 0.0) & (root <= NOISE), axis=1)  # rounding, or other units
        for i in np.flatnonzero(~agrees):
            qp = QP.from_data(scaled[i], sizes)
            center, radius, _, reason = enclose_solution(qp, references[i])
            step = x[i] - factors[i] * center
            off = (factors[i] * radius).max()
            if not _decides(step, off, reason, self.tolerance):
                # A solution beside the answer clears it, whatever others there are.
                own = touching_point(qp, x[i] / factors[i])
                center, radius, _, own_reason = enclose_solution(qp, own)
                own_step = x[i] - factors[i] * center
                own_off = (factors[i] * radius).max()
                if own_reason != NOT_CONVEX and np.abs(own_step).max() + own_off < self.tolerance:
                    step = own_step
                    off = own_off
                    reason = own_reason
            if _decides(step, off, reason, self.tolerance):
                steps[i] = step
                gaps[i] = np.abs(step).max()
                residuals[i] = 0.0
                judge[i] = BY_PROOF
            elif judge[i] >= 0:
                unique, least = unique_step(qp, references[i], step / factors[i])
                steps[i] = step
                gaps[i] = np.abs(factors[i] * unique).max()
                # Of variables in other units, none is free for sure.
                is_sure = not faint[i] if gaps[i] > self.tolerance else (factors[i] == 1.0).all()
                if is_far[i] and not (min(off, errors[i] / least) < self.tolerance and is_sure):
                    steps[i] = gaps[i] = np.nan
                    residuals[i] = np.inf
                    judge[i] = NOBODY
        return steps, gaps, residuals, judge

    def _ask(
        self, name: str, programs: Matrix, sizes: Sizes, points: Matrix
    ) -> tuple[Vector, NDArray[np.int64]]:
        """Solve N normalised programs by a solver and, where it is not believed, by the second.

        The answers are written to points, (N, 2 n + m + p).

        Returns:
            Their residuals, and the judge, (N,).
        """
        residuals = np.full(len(points), np.inf)
        judge = np.full(len(points), NOBODY)
        block = stacked(programs, sizes)
        # A solver may take minutes over one NaN, and OSQP has words of its own for crossed bounds.
        wrong = np.isnan(programs).any(axis=1) | (block.lb > block.ub).any(axis=1)
        for code, solver in enumerate((name, SECOND.get(name) or "proxqp")):
            left = np.flatnonzero(~wrong & (judge < 0))
            solve = reference_solver(solver, sizes) if left.size else None
            for i in left:
                qp = QP.from_data(programs[i], sizes)
                points[i], residuals[i] = _answer(solver, solve, qp)
                tolerance = self.reference_tolerance
                if residuals[i] <= tolerance or qp.accepts(points[i], tolerance):
                    residuals[i] = min(residuals[i], tolerance)
                    judge[i] = code
        return residuals, judge


def _decides(step: Vector, radius: float, reason: str, tolerance: float) -> bool:
    """Test whether an enclosure of a solution says on which side of a tolerance an answer is."""
    return reason != NOT_CONVEX and radius < abs(float(np.abs(step).max()) - tolerance)


def references() -> list[str]:
    """List the names of references: solvers that qpsolvers finds installed, and the proof."""
    import qpsolvers  # with scipy.sparse, 0.2 s that not every run needs

    return [name for name in qpsolvers.available_solvers if name != "iiwa_dnn"] + [PROOF]


def _answer(name: str, solve: Any, qp: QP) -> tuple[Vector, float]:
    """Solve a program by a reference; return its point and its largest residual.

    Without an answer the residual is inf.

    Raises:
        InvalidInputError: The solver returns an array of another size than the program's.
    """
    try:
        point = solve(qp)
    except IiwaDnnError as error:
        raise InvalidInputError(f"answer of {name}", str(error), error) from error
    except Exception:  # whatever a reference raises, it has no answer
        return np.full(1, np.nan), np.inf
    return point, np.inf if np.isnan(point[0]) else qp.residuals(point).largest


def _prove(programs: Matrix, sizes: Sizes, points: Matrix) -> _Verdicts:
    """Bound the distances of points (N, 2 n + m + p) from their solutions, by `prove_point`.

    The steps returned are those within each bound that change the objective most, to first order.
    """
    pairs = zip(programs, points, strict=True)
    bounds = np.array([prove_point(QP.from_data(data, sizes), own).bound for data, own in pairs])
    block = stacked(programs, sizes)
    gradients = (block.P @ points[:, : sizes[0], np.newaxis])[..., 0] + block.q
    steps = np.copysign(bounds[:, np.newaxis], gradients)
    return steps, bounds, np.where(bounds < np.inf, 0.0, np.inf), (bounds < np.inf) - 1
