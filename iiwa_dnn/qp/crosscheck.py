"""Cross-check of an answer: the same program, put to an established solver, or a proof.

A reference gets the program, in units near 1, and nothing of the network's state, and is believed
only where its own KKT residual is small. If the one that was asked has no such answer, a second one
is asked, and the agreement says which of both judged. "proof" stands among the references for
`iiwa_dnn.qp.proof`, which asks no other solver. `CheckPool` is the check behind a running loop.
"""

from __future__ import annotations

import os
import warnings
from concurrent.futures import Future
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.processes import end_with
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
from iiwa_dnn.qp.proof import point_of, prove_point

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

PROOF = "proof"
"""Name of the proof among the references."""

SECOND = {"proxqp": "osqp", PROOF: None}
"""Solvers that are asked where another one has no answer; "proxqp" for all others."""

_WORTH_A_PROCESS = 10_000
"""Programs from which on a worker's start, about a second, is repaid."""

_AHEAD = 2
"""Blocks that a worker has before it: one in work, one waiting. More would only take memory."""


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
        scaled = normalised(programs, sizes)
        judge = np.empty((len(points), len(self.solvers)), dtype=np.int8)
        gaps = np.empty((2, *judge.shape))
        steps = np.empty((*judge.shape, n))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", UserWarning)  # OSQP's, of dense matrices
            for i, k in np.ndindex(judge.shape):
                name = self.solvers[k]
                qp = QP.from_data((programs if name == PROOF else scaled)[i], sizes)
                steps[i, k], *gaps[:, i, k], judge[i, k] = self._compared(name, qp, points[i])
        block = stacked(programs, sizes)
        objective = objective_gaps(block, points[:, :n], steps)
        feasibility = np.where(judge.T < 0, np.nan, feasibility_gaps(block, points[:, :n])).T
        return Agreement(gaps[0], objective, feasibility, gaps[1], judge)

    def _compared(self, name: str, qp: QP, point: Vector) -> tuple[Vector, float, float, int]:
        """Compare x of a point (2 n + m + p,) with a solver's.

        Returns:
            The step in x away from the solver's (n,), and the solution gap, the residual and the
            judge of `Agreement`.
        """
        if name == PROOF:
            return _proven(qp, point)
        n = qp.sizes[0]
        for judge, solver in enumerate((name, SECOND.get(name) or "proxqp")):
            reference, residual = _answer(solver, qp)
            tolerance = self.reference_tolerance
            if tolerance < residual < np.inf and qp.accepts(reference, tolerance):
                residual = tolerance  # what is above it is rounding
            if residual <= tolerance:
                step = point[:n] - reference[:n]
                gap = solution_gap(qp, reference, residual, step, self.tolerance)
                return step, gap, residual, judge
        return np.full(n, np.nan), np.nan, residual, -1


def references() -> list[str]:
    """List the names of references: solvers that qpsolvers finds installed, and the proof."""
    import qpsolvers  # with scipy.sparse, 0.2 s that not every run needs

    return [name for name in qpsolvers.available_solvers if name != "iiwa_dnn"] + [PROOF]


def _answer(name: str, qp: QP) -> tuple[Vector, float]:
    """Ask a solver for the point of a program, (2 n + m + p,), and compute its largest residual.

    The residual is inf without an answer.
    """
    # A solver may take minutes over one NaN, and OSQP has words of its own for crossed bounds.
    if not (np.isnan(qp.data).any() or (qp.lb > qp.ub).any()):
        with suppress(Exception):  # whatever a reference raises, it has no answer
            point = ask(name, qp)
            if not np.isnan(point[0]):
                return point, qp.residuals(point).largest
    return np.empty(0), np.inf


def ask(name: str, qp: QP) -> Vector:
    """Ask a solver for the point of a program, (2 n + m + p,); NaN where it finds none."""
    if name == "proxqp":
        return _ask_proxqp(qp)
    import qpsolvers

    solution = qpsolvers.solve_problem(qp.to_qpsolvers(), name, **OPTIONS.get(name, {}))
    point = point_of(solution, qp)
    return point if solution.found else np.full_like(point, np.nan)


def _ask_proxqp(qp: QP) -> Vector:
    """Ask ProxQP, by its own interface: qpsolvers does not hand all of its settings on."""
    from proxsuite import proxqp

    n, m, p = qp.sizes
    solver = proxqp.dense.QP(n, p, m, True)
    for setting, value in OPTIONS["proxqp"].items():
        setattr(solver.settings, setting, value)
    solver.init(qp.P, qp.q, qp.A, qp.b, qp.G, None, qp.h, qp.lb, qp.ub)
    solver.solve()
    results = solver.results
    point = np.concatenate([results.x, results.y, results.z])
    return point if results.info.status == proxqp.PROXQP_SOLVED else np.full_like(point, np.nan)


def _proven(qp: QP, point: Vector) -> tuple[Vector, float, float, int]:
    """Prove a point (2 n + m + p,); returns as `CrossCheck._compared`.

    Of all steps within the bound it is the one that changes the objective most, to first order.
    """
    bound = prove_point(qp, point).bound
    proven = bound < np.inf
    step = np.copysign(bound, qp.P @ point[: qp.sizes[0]] + qp.q)
    return step, bound, 0.0 if proven else np.inf, 0 if proven else -1


class CheckPool:
    """Judges blocks of programs while others are still being made.

    A block goes to a worker process that has room for it; where none has, the caller's own process
    judges it at once.

    Attributes:
        check: The references and the tolerances.
        workers: Processes beside the caller's.
    """

    def __init__(self, check: CrossCheck, programs: int, workers: int | None = None) -> None:
        """Start the workers.

        Args:
            check: The references and the tolerances.
            programs: Number of programs that will come in all.
            workers: Processes beside the caller's; None takes the cores that are free, or none
                where so few programs would not repay them.
        """
        import loky  # with its processes' machinery, which not every run needs

        if workers is None:
            worth = programs >= _WORTH_A_PROCESS and set(check.solvers) - {PROOF}
            workers = loky.cpu_count() - 1 if worth else 0
        self.check = check
        self.workers = workers
        # Not the standard library's pool: that one runs the caller's script once more in every
        # worker, so a script without a __main__ guard would start itself again.
        self._executor = None
        if workers:
            self._executor = loky.get_reusable_executor(
                workers, timeout=60, initializer=end_with, initargs=(os.getpid(),)
            )
        nothing = np.empty((0, 0))
        self._verdicts: list[Agreement | Future[Agreement]] = [
            check.check_block(nothing, (0, 0, 0), nothing)
        ]

    def submit(self, programs: Matrix, sizes: Sizes, answers: Matrix) -> None:
        """Take the next block: N programs of one shape, and the answers to be judged.

        The arguments are those of `CrossCheck.check_block`.
        """
        ahead = sum(isinstance(own, Future) and not own.done() for own in self._verdicts)
        if self._executor is not None and ahead < _AHEAD * self.workers:
            future = self._executor.submit(self.check.check_block, programs, sizes, answers)
            self._verdicts.append(future)
        else:
            self._verdicts.append(self.check.check_block(programs, sizes, answers))

    def finish(self) -> Agreement:
        """Wait for every block and return the verdicts in the order of the programs."""
        verdicts = [own.result() if isinstance(own, Future) else own for own in self._verdicts]
        return Agreement(*map(np.concatenate, zip(*verdicts, strict=True)))
