"""Cross-check of an answer by an established solver for the same program, or by a proof.

A reference gets the program, in units near 1, and nothing of the network's state, and is believed
only where its own KKT residual is small. If the one that was asked has no such answer, a second one
is asked. A proof judges instead (`iiwa_dnn.qp.proof`) where neither is believed, where an answer
disagrees, and where the program is so flat that a point with the reference's residual may be far
from the solution. Where nothing is proven, as of programs with several solutions, a reference
blames only if its residual says that it is near one. The agreement names the judge, or nobody.

"proof" stands among the references for a proof of the answer itself, which asks no solver.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import IiwaDnnError, InvalidInputError
from iiwa_dnn.qp.agreement import (
    Agreement,
    feasibility_gaps,
    normalised,
    objective_gaps,
    polished,
    stacked,
    unique_steps,
)
from iiwa_dnn.qp.layout import Matrix, QPViews, Sizes, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.proof import enclose_solution, prove_point
from iiwa_dnn.qp.reference_solvers import reference_solver

PROOF = "proof"
"""Name of the proof among the references."""

SECOND = {"proxqp": "osqp", PROOF: None}
"""Solvers that are asked where another one has no answer; "proxqp" for all others."""

NOBODY = -1
"""Code of the judge where an answer is neither agreed with nor blamed."""

MARGIN = 10.0
"""Error of a reference that its residual lets expect, in units of that residual over an eigenvalue
of `iiwa_dnn.qp.agreement`."""

BY_PROOF = 2
"""Code of the judge where a proof judged in the place of a solver."""

_Verdicts = tuple[Matrix, Vector, Vector, NDArray[np.int64]]
"""Of N points and one reference: steps in x away from the solutions (N, n), and solution gaps,
residuals and judges of `Agreement`, (N,)."""


class _Block(NamedTuple):
    """N programs of one shape, and the answers to be judged.

    Attributes:
        sizes: `QP.sizes` of the programs.
        programs: One `QP.data` a row.
        normalised: The programs in units near 1.
        factors: Factors from their variables to those of the programs, (N, n).
        points: Answers [x | y | z | z_box], (N, 2 n + m + p); multipliers may be 0.
    """

    sizes: Sizes
    programs: Matrix
    normalised: Matrix
    factors: Matrix
    points: Matrix

    @property
    def x(self) -> Matrix:
        """The answers without multipliers, (N, n)."""
        return self.points[:, : self.sizes[0]]

    def steps(self, references: Matrix) -> Matrix:
        """Compute the differences of x and points of the normalised programs, (N, n)."""
        return self.x - self.factors * references[:, : self.sizes[0]]

    def part(self, rows: NDArray[np.intp]) -> _Block:
        """Return the block of some of the programs, by their indices (k,)."""
        return _Block(self.sizes, *(array[rows] for array in self[1:]))


class _Opinion(NamedTuple):
    """Opinion of a reference on N answers.

    Attributes:
        points: Its points, believed or not, (N, 2 n + m + p); NaN without one.
        residuals: Their residuals, (N,).
        judge: 0 where the first solver that was asked is believed, 1 where the next one is, else
            `NOBODY`, (N,).
        gaps: Solution gaps; NaN where no solver is believed, (N,).
        verdicts: 1 where the answer agrees, -1 where it does not, 0 where that is not decided,
            (N,).
    """

    points: Matrix
    residuals: Vector
    judge: NDArray[np.int64]
    gaps: Vector
    verdicts: NDArray[np.int64]


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
        solution = np.empty(judge.shape)
        residual = np.empty(judge.shape)
        steps = np.empty((*judge.shape, n))
        block = _Block(sizes, programs, *normalised(programs, sizes), points)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # OSQP's, of dense matrices
            for k, name in enumerate(self.solvers):
                steps[:, k], solution[:, k], residual[:, k], judge[:, k] = (
                    _prove(block) if name == PROOF else self._compare(name, block)
                )
        views = stacked(programs, sizes)
        objective = objective_gaps(views, block.x, steps)
        feasibility = np.where(judge.T < 0, np.nan, feasibility_gaps(views, block.x)).T
        return Agreement(solution, objective, feasibility, residual, judge)

    def _compare(self, name: str, block: _Block) -> _Verdicts:
        """Compare answers with those of a solver and, where it does not agree, ask for a proof."""
        second = SECOND.get(name) or "proxqp"
        points, residuals, judge, gaps, verdicts = self._ask((name, second), block)
        steps = np.where(judge[:, np.newaxis] < 0, np.nan, block.steps(points))
        unsettled = _are_sound(block.normalised, block.sizes) & np.isfinite(block.x).all(axis=1)
        for i in np.flatnonzero(unsettled & (verdicts < 1)):
            step = self._proven_step(block, points, i)
            if step is not None:
                steps[i] = step
                gaps[i] = np.abs(step).max()
                residuals[i] = 0.0
                judge[i] = BY_PROOF
        left = np.flatnonzero(unsettled & (verdicts == 0) & (judge < BY_PROOF))
        # Of two that found the same point, neither is doubted.
        part = block.part(left)
        views = stacked(part.programs, part.sizes)
        objective = objective_gaps(views, part.x, steps[left, np.newaxis])[:, 0]
        farthest = np.maximum(np.abs(steps[left]).max(axis=1, initial=0.0), objective)
        left = left[~(farthest <= self.tolerance)]
        steps[left] = np.nan
        gaps[left] = np.nan
        residuals[left] = np.where(judge[left] < 0, residuals[left], np.inf)
        judge[left] = NOBODY
        return steps, gaps, residuals, judge

    def _ask(self, solvers: tuple[str, ...], block: _Block) -> _Opinion:
        """Compare answers with those of a solver and, where it is not believed, of the next one."""
        points = np.full_like(block.points, np.nan)
        residuals = np.full(len(points), np.inf)
        judge = np.full(len(points), NOBODY)
        # A solver may take minutes over one NaN, and OSQP has words of its own for crossed bounds.
        is_sound = _are_sound(block.normalised, block.sizes)
        for code, name in enumerate(solvers):
            left = np.flatnonzero(is_sound & (judge < 0))
            solve = reference_solver(name, block.sizes) if left.size else None
            for i in left:
                qp = QP.from_data(block.normalised[i], block.sizes)
                points[i], residuals[i] = self._answer(name, solve, qp)
                if residuals[i] <= self.reference_tolerance:
                    judge[i] = code
        gaps = np.full(len(points), np.nan)
        verdicts = np.zeros_like(judge)
        believed = np.flatnonzero(judge >= 0)
        gaps[believed], verdicts[believed] = self._weigh(
            block.part(believed), points[believed], residuals[believed]
        )
        doubted = believed[verdicts[believed] < 1]
        part = block.part(doubted)
        for i, point in zip(
            doubted, polished(stacked(part.normalised, part.sizes), points[doubted]), strict=True
        ):
            residual = QP.from_data(block.normalised[i], block.sizes).residuals(point).largest
            if residual < residuals[i]:
                points[i] = point
                residuals[i] = residual
        gaps[doubted], verdicts[doubted] = self._weigh(part, points[doubted], residuals[doubted])
        return _Opinion(points, residuals, judge, gaps, verdicts)

    def _weigh(
        self, block: _Block, references: Matrix, residuals: Vector
    ) -> tuple[Vector, NDArray[np.int64]]:
        """Compare answers with points of a reference (N, 2 n + m + p) that are believed.

        Returns:
            Gaps and verdicts of `_Opinion`, (N,).
        """
        steps = block.steps(references)
        gaps = np.abs(steps).max(axis=1, initial=0.0)
        programs = stacked(block.programs, block.sizes)
        fits = objective_gaps(programs, block.x, steps[:, np.newaxis])[:, 0] <= self.tolerance
        scaled = stacked(block.normalised, block.sizes)
        accuracy = MARGIN * residuals * block.factors.max(axis=1, initial=0.0) / self.tolerance
        is_decided = np.linalg.eigvalsh(scaled.P).min(axis=1, initial=np.inf) >= accuracy
        left = np.flatnonzero(~(is_decided & fits & (gaps <= self.tolerance)))
        factors = block.factors[left]
        unique, is_decided[left] = unique_steps(
            QPViews(*(field[left] for field in scaled)),
            references[left],
            steps[left] / factors,
            accuracy[left],
        )
        gaps[left] = np.abs(factors * unique).max(axis=1, initial=0.0)
        agrees = fits & (gaps <= self.tolerance)
        # Of variables in other units the objective says nothing that the reference is sure of.
        is_decided &= agrees | (gaps > self.tolerance) | (block.factors == 1.0).all(axis=1)
        return gaps, np.where(is_decided, np.where(agrees, 1, -1), 0)

    def _proven_step(self, block: _Block, references: Matrix, i: int) -> Vector | None:
        """Return the step of answer i away from the solution, (n,), if a proof decides about it.

        The active sets to begin with are those of the reference (N, 2 n + m + p) and of the answer.
        """
        qp = QP.from_data(block.normalised[i], block.sizes)
        factors = block.factors[i]
        own = np.concatenate([block.x[i] / factors, block.points[i, factors.size :]])
        for start in (references[i], own):
            center, radius, _, _ = enclose_solution(qp, start)
            step: Vector = block.x[i] - factors * center
            if (factors * radius).max() < abs(np.abs(step).max() - self.tolerance):
                return step
        return None

    def _answer(self, name: str, solve: Any, qp: QP) -> tuple[Vector, float]:
        """Solve a program by a reference; return its point and its largest residual.

        Without an answer the residual is inf; if it is rounding, it counts as the tolerance.

        Raises:
            InvalidInputError: The solver returns an array of another size than the program's.
        """
        n, m, p = qp.sizes
        try:
            point = solve(qp)
        except IiwaDnnError as error:
            raise InvalidInputError(f"answer of {name}", str(error), error) from error
        except Exception:  # whatever a reference raises, it has no answer
            return np.full(2 * n + m + p, np.nan), np.inf
        check_size(f"answer of {name}", point, 2 * n + m + p)
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


def _are_sound(programs: Matrix, sizes: Sizes) -> NDArray[np.bool_]:
    """Test which of N programs, one `QP.data` a row, have neither NaN nor crossed bounds, (N,)."""
    block = stacked(programs, sizes)
    return np.asarray(~(np.isnan(programs).any(axis=1) | (block.lb > block.ub).any(axis=1)))


def _prove(block: _Block) -> _Verdicts:
    """Bound the distances of answers from their solutions, by `prove_point`.

    The steps returned are those within each bound that change the objective most, to first order.
    """
    qps = [QP.from_data(program, block.sizes) for program in block.programs]
    bounds = np.array([prove_point(*pair).bound for pair in zip(qps, block.points, strict=True)])
    is_proven = bounds < np.inf
    views = stacked(block.programs, block.sizes)
    gradients = (views.P @ block.x[:, :, np.newaxis])[..., 0] + views.q
    steps = np.copysign(bounds[:, np.newaxis], gradients)
    return steps, bounds, np.where(is_proven, 0.0, np.inf), is_proven - 1
