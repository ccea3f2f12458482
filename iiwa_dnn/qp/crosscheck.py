"""Cross-check of an answer: the same program, put to an established solver.

The reference gets the program through qpsolvers, and nothing of the network's state. Its own
residuals are judged before it is believed.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, field
from io import StringIO
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP
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


class Agreement(NamedTuple):
    """Gaps between answers to N programs and k reference solvers; NaN where a reference failed.

    Attributes:
        solution_gap: Largest difference in x, (N, k); joint velocities in [rad/s].
        objective_gap: Absolute difference in the objective, (N, k).
        reference_residual: Largest KKT residual of each reference, (N, k); inf without an answer.
    """

    solution_gap: Matrix
    objective_gap: Matrix
    reference_residual: Matrix

    @classmethod
    def joined(cls, parts: Sequence[Agreement], solvers: int) -> Agreement:
        """Concatenate the agreements of several blocks, for k = `solvers`."""
        nothing = [np.empty((0, solvers))]
        return cls(*(np.concatenate(nothing + [part[i] for part in parts]) for i in range(3)))

    def worst_of(self, group: int) -> Agreement:
        """Take the largest of each `group` of consecutive programs, as for the stages of a step."""
        steps = len(self.solution_gap) // group
        k = self.solution_gap.shape[1]
        return Agreement(*(array.reshape(steps, group, k).max(axis=1) for array in self))


@dataclass(frozen=True)
class CrossCheck:
    """Reference solvers, and the tolerances of an agreement.

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
        names: Any = self.solvers
        if not isinstance(names, tuple | list):
            raise InvalidInputError("solvers", f"must be a tuple of names, not {names!r}", names)
        for name in names:
            checks.one_of("solvers", name, tuple(self._options))
        for name in ("tolerance", "reference_tolerance"):
            checks.positive(name, getattr(self, name))

    def check(self, qp: QP, x: Vector) -> Agreement:
        """Ask every reference for one program's solution and compare; N = 1.

        Args:
            qp: The program, n variables.
            x: The answer to be judged, (n,).
        """
        return self.check_block(qp.data[np.newaxis], qp.sizes, np.asarray(x)[np.newaxis])

    def check_block(
        self, programs: Matrix, sizes: Sizes, x: Matrix, by_cost: bool = False
    ) -> Agreement:
        """Ask every reference for the solutions of N programs of one shape and compare.

        Args:
            programs: One `QP.data` a row.
            sizes: Their `QP.sizes`.
            x: The answers to be judged, (N, n).
            by_cost: Measure the gap in x in the norm of P. Where it is above the tolerance and x is
                not unique, since no cost acts along all directions, that is done anyhow.

        Returns:
            Gaps and residuals, one row a program and one column a reference.
        """
        n = sizes[0]
        if not self.solvers:
            nothing = np.empty((len(x), 0))
            return Agreement(nothing, nothing, nothing)
        points, residuals = self._answers(self.solvers, programs, sizes)
        for i, j in np.argwhere(~(residuals <= self.reference_tolerance)):
            # ProxQP calls one in some thousand programs infeasible that are not.
            others = [name for name in self._options if name != self.solvers[j]]
            point, residual = self._answers(others[:1], programs[i : i + 1], sizes)
            if (residual <= self.reference_tolerance).any():
                points[i, j] = point[0, 0]
                residuals[i, j] = residual[0, 0]
        believed = (residuals <= self.reference_tolerance)[..., np.newaxis]
        references = np.where(believed, points, np.nan)[..., :n]
        step = x[:, np.newaxis] - references
        cost = programs[:, : n * n].reshape(len(x), n, n)
        linear = programs[:, n * n : n * (n + 1)]
        # As a difference of points: subtracting two objectives would cancel.
        curved = np.einsum("ijk,ikl,ijl->ij", step, cost, x[:, np.newaxis] + references) / 2.0
        objective_gap = np.abs(curved + np.einsum("ijk,ik->ij", step, linear))
        gap = np.abs(step).max(axis=2)
        loose = np.full(len(x), by_cost)
        for i in np.flatnonzero((gap > self.tolerance).any(axis=1)):
            qp = QP.from_data(programs[i], sizes)
            curvatures = np.linalg.eigvalsh(qp.P + qp.A.T @ qp.A)
            loose[i] |= bool(curvatures[0] <= _FLAT * curvatures[-1])
        in_cost = np.sqrt(np.maximum(np.einsum("ijk,ikl,ijl->ij", step, cost, step), 0.0))
        gap = np.where(loose[:, np.newaxis], in_cost, gap)
        return Agreement(gap, objective_gap, residuals)

    def _answers(
        self, solvers: Sequence[str], programs: Matrix, sizes: Sizes
    ) -> tuple[NDArray[np.float64], Matrix]:
        """Ask k solvers for the points of N programs, (N, k, size), and judge them, (N, k)."""
        n, m, p = sizes
        points = np.full((len(programs), len(solvers), 2 * n + m + p), np.nan)
        residuals = np.empty(points.shape[:2])
        # Solvers may take minutes over one NaN.
        askable = ~np.isnan(programs).any(axis=1)
        with warnings.catch_warnings(), redirect_stdout(StringIO()):
            # They speak of dense matrices for OSQP, and of programs that are not solved, as the
            # residual does; OSQP prints, too. Once a block: for each program it would take a tenth
            # of ProxQP's time.
            warnings.simplefilter("ignore", UserWarning)
            for i in np.flatnonzero(askable):
                problem = QP.from_data(programs[i], sizes).to_qpsolvers()
                for j, name in enumerate(solvers):
                    reference = self._solve(name, problem)
                    if reference is not None and reference.x is not None:
                        _copy_point(reference, sizes, points[i, j])
        largest_residuals(np.ascontiguousarray(programs), n, m, p, points, residuals)
        return points, residuals

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

    def _solve(self, name: str, problem: qpsolvers.Problem) -> qpsolvers.Solution | None:
        """Ask one reference; returns None where it has no solution."""
        import qpsolvers

        try:
            solution = qpsolvers.solve_problem(problem, solver=name, **self._options[name])
        except Exception:  # whatever a reference raises, it has no answer
            return None
        return solution if solution.found else None


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
