"""Cross-check of an answer: the same program, put to an established solver, or a proof.

A reference gets the program through qpsolvers, and nothing of the network's state. Its own
residuals are judged before it is believed. "proof" stands among the references for
`iiwa_dnn.qp.proof`, which asks no other solver.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from dataclasses import dataclass, field
from io import StringIO
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.proof import prove_block
from iiwa_dnn.qp.residuals import largest_residuals

if TYPE_CHECKING:
    import qpsolvers

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
        # Ten are enough for a program that has a solution; on one that has none, as the paper's
        # rows once the tool lags, the default of 10,000 takes 0.1 s a program.
        "max_iter": 50,
    },
    "osqp": {
        "eps_abs": 1e-9,
        "eps_rel": 0.0,
        "polishing": True,
        "max_iter": 10_000,
        "raise_error": False,
    },
}
_FLAT = 1e-10
"""Curvature of cost and task rows, by the largest, below which x is not unique along it."""

SOLVERS = tuple(_SOLVER_OPTIONS)

PROOF = "proof"
"""Name of the proof among the references."""


class Agreement(NamedTuple):
    """Gaps between answers to N programs and k reference solvers; NaN where a reference failed.

    Attributes:
        solution_gap: Largest difference in x, (N, k); joint velocities in [rad/s].
        objective_gap: Absolute difference in the objective, (N, k).
        reference_residual: Largest KKT residual of each reference, (N, k); inf without an answer.

    Of a proof, the gap is the bound of `Proof` and the residual is 0; without a bound, both are
    inf.
    """

    solution_gap: Matrix
    objective_gap: Matrix
    reference_residual: Matrix

    @classmethod
    def joined(cls, parts: Sequence[Agreement], solvers: int) -> Agreement:
        """Concatenate the agreements of several blocks, for k = `solvers`."""
        nothing = [np.empty((0, solvers))]
        return cls(*(np.concatenate(nothing + [part[i] for part in parts]) for i in range(3)))

    @classmethod
    def beside(cls, columns: Sequence[tuple[Vector, Vector, Vector]], count: int) -> Agreement:
        """Put the gaps and residuals (N,) of each reference side by side, for N = `count`."""
        nothing = [np.empty((count, 0))]
        return cls(*(np.column_stack(nothing + [each[i] for each in columns]) for i in range(3)))

    def worst_of(self, group: int) -> Agreement:
        """Take the largest of each `group` of consecutive programs, as for the stages of a step."""
        steps = len(self.solution_gap) // group
        k = self.solution_gap.shape[1]
        return Agreement(*(array.reshape(steps, group, k).max(axis=1) for array in self))


@dataclass(frozen=True)
class CrossCheck:
    """Reference solvers, and the tolerances of an agreement.

    Attributes:
        solvers: Names of the references, out of ``SOLVERS`` and ``"proof"``; none switches the
            check off.
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
        names: Any = self.solvers
        if not isinstance(names, tuple | list):
            raise InvalidInputError("solvers", f"must be a tuple of names, not {names!r}", names)
        for name in names:
            checks.one_of("solvers", name, (*self._options, PROOF))
        for name in ("tolerance", "reference_tolerance"):
            checks.positive(name, getattr(self, name))

    @property
    def asks_solvers(self) -> bool:
        """Test whether a solver is asked, which takes long enough for a process of its own."""
        return bool(set(self.solvers) - {PROOF})

    def check(self, qp: QP, answer: Vector) -> Agreement:
        """Ask every reference for one program's solution and compare; N = 1.

        Args:
            qp: The program, n variables.
            answer: The answer to be judged: x (n,), or `Solution.point` (2 n + m + p,), whose
                multipliers a proof begins with.
        """
        return self.check_block(qp.data[np.newaxis], qp.sizes, np.asarray(answer)[np.newaxis])

    def check_block(
        self, programs: Matrix, sizes: Sizes, answers: Matrix, by_cost: bool = False
    ) -> Agreement:
        """Ask every reference for the solutions of N programs of one shape and compare.

        Args:
            programs: One `QP.data` a row.
            sizes: Their `QP.sizes`.
            answers: The answers to be judged: x (N, n), or points (N, 2 n + m + p).
            by_cost: Measure the gap in x in the norm of P. Where it is above the tolerance and x is
                not unique, since no cost acts along all directions, that is done anyhow. Such a
                program has no proof, and is left out: all of it is NaN.

        Returns:
            Gaps and residuals, one row a program and one column a reference.
        """
        columns = []
        for name in self.solvers:
            if name == PROOF:
                columns.append(_proven(programs, sizes, answers, by_cost))
            else:
                x = answers[:, : sizes[0]]
                columns.append(self._compared(name, programs, sizes, x, by_cost))
        return Agreement.beside(columns, len(answers))

    def _compared(
        self, name: str, programs: Matrix, sizes: Sizes, x: Matrix, by_cost: bool
    ) -> tuple[Vector, Vector, Vector]:
        """Compare answers x (N, n) with those of one reference: gaps and residuals, (N,)."""
        n = sizes[0]
        points, residuals = self._answers(name, programs, sizes)
        for i in np.flatnonzero(~(residuals <= self.reference_tolerance)):
            # ProxQP calls one in some thousand programs infeasible that are not.
            others = [other for other in self._options if other != name]
            for other in others[:1]:
                point, residual = self._answers(other, programs[i : i + 1], sizes)
                if residual[0] <= self.reference_tolerance:
                    points[i] = point[0]
                    residuals[i] = residual[0]
        believed = (residuals <= self.reference_tolerance)[:, np.newaxis]
        references = np.where(believed, points, np.nan)[:, :n]
        step = x - references
        cost = programs[:, : n * n].reshape(len(x), n, n)
        linear = programs[:, n * n : n * (n + 1)]
        # As a difference of points: subtracting two objectives would cancel.
        curved = np.einsum("ij,ijk,ik->i", step, cost, x + references) / 2.0
        objective_gap = np.abs(curved + np.einsum("ij,ij->i", step, linear))
        gap = np.abs(step).max(axis=1)
        loose = np.full(len(x), by_cost)
        for i in np.flatnonzero(gap > self.tolerance):
            qp = QP.from_data(programs[i], sizes)
            curvatures = np.linalg.eigvalsh(qp.P + qp.A.T @ qp.A)
            loose[i] |= bool(curvatures[0] <= _FLAT * curvatures[-1])
        in_cost = np.sqrt(np.maximum(np.einsum("ij,ijk,ik->i", step, cost, step), 0.0))
        return np.where(loose, in_cost, gap), objective_gap, residuals

    def _answers(self, name: str, programs: Matrix, sizes: Sizes) -> tuple[Matrix, Vector]:
        """Ask a solver for the points of N programs, (N, size), and judge them, (N,)."""
        n, m, p = sizes
        points = np.full((len(programs), 1, 2 * n + m + p), np.nan)
        residuals = np.empty((len(programs), 1))
        # Solvers may take minutes over one NaN.
        askable = ~np.isnan(programs).any(axis=1)
        with _silence():
            for i in np.flatnonzero(askable):
                problem = QP.from_data(programs[i], sizes).to_qpsolvers()
                reference = self._solve(name, problem)
                if reference is not None and reference.found and reference.x is not None:
                    _copy_point(reference, sizes, points[i, 0])
        largest_residuals(np.ascontiguousarray(programs), n, m, p, points, residuals)
        return points[:, 0], residuals[:, 0]

    def options(self, name: str) -> dict[str, Any]:
        """Return a copy of the options with which qpsolvers asks the reference of this name."""
        return dict(self._options[name])

    def settings(self) -> dict[str, Any]:
        """Return solvers and tolerances, as values that JSON can hold."""
        return {
            "solvers": list(self.solvers),
            "tolerance": self.tolerance,
            "reference_tolerance": self.reference_tolerance,
        }

    def status(self, name: str, qp: QP) -> str:
        """Ask the reference of this name for a program's solution; return its status in words."""
        with _silence():
            solution = self._solve(name, qp.to_qpsolvers())
        if solution is None:
            return "refused"
        info = solution.extras.get("info")
        status = getattr(info, "status", "solved" if solution.found else "not solved")
        words = str(getattr(status, "name", status)).lower().replace("_", " ")
        return words.removeprefix(f"{name} ")

    def _solve(self, name: str, problem: qpsolvers.Problem) -> qpsolvers.Solution | None:
        """Ask one reference; returns None where it refuses the problem."""
        import qpsolvers

        try:
            return qpsolvers.solve_problem(problem, solver=name, **self._options[name])
        except Exception:  # whatever a reference raises, it has no answer
            return None


@contextmanager
def _silence() -> Iterator[None]:
    """Keep the references' warnings and prints back.

    They speak of dense matrices for OSQP, and of programs that are not solved, as the residual
    does; OSQP prints, too. Once a block: for each program it would take a tenth of ProxQP's time.
    """
    with warnings.catch_warnings(), redirect_stdout(StringIO()):
        warnings.simplefilter("ignore", UserWarning)
        yield


def _proven(
    programs: Matrix, sizes: Sizes, answers: Matrix, by_cost: bool
) -> tuple[Vector, Vector, Vector]:
    """Prove answers (N, n) or (N, 2 n + m + p): bounds, nothing on the objective, residuals."""
    n, m, p = sizes
    count = len(answers)
    bounds = np.full(count, np.nan)
    if by_cost:
        return bounds, bounds, bounds
    points = np.zeros((count, 2 * n + m + p))
    points[:, : answers.shape[1]] = answers
    reasons = np.empty(count, dtype=np.int64)
    active = np.empty((count, n + m), dtype=np.int64)
    prove_block(np.ascontiguousarray(programs), n, m, points, bounds, reasons, active)
    return bounds, np.full(count, np.nan), np.where(bounds < np.inf, 0.0, np.inf)


def _copy_point(solution: qpsolvers.Solution, sizes: Sizes, point: Vector) -> None:
    """Write a solution into `point`, laid out as `Solution.point`; absent multipliers are zero."""
    n, m, p = sizes
    point[n:] = 0.0
    point[:n] = solution.x
    if p and solution.y is not None:
        point[n : n + p] = solution.y
    if m and solution.z is not None:
        point[n + p : n + p + m] = solution.z
    if solution.z_box is not None and len(solution.z_box) == n:
        point[n + p + m :] = solution.z_box
