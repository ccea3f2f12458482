"""Programs that nobody here wrote, and badly posed ones: this solver beside its peers.

``python -m benchmarks.foreign [--degenerate N] [--maros FOLDER]``. FOLDER is a copy of the public
repository qpsolvers/maros_meszaros_qpbenchmark; of its programs those with at most 1000 variables
and 1000 rows are taken, dense. All run in this process, one after another on each program, through
qpsolvers. Solved means that qpsolvers' three residuals are at most the tolerance; a false claim is
an answer called found that is not solved. The shifted geometric mean (10 s) counts a failure as
10 s. With OPENBLAS_NUM_THREADS=1 all solvers have one thread.
"""

from __future__ import annotations

import argparse
import time
import warnings
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import qpsolvers
import scipy.sparse as spa
from scipy.io import loadmat

import iiwa_dnn
from benchmarks import programs

LARGEST, FAILED, SHIFT = 1000, 10.0, 10.0
OPTIONS = {
    "iiwa_dnn": lambda tol: {"eps_abs": tol},
    "daqp": lambda tol: {"primal_tol": tol, "dual_tol": tol},
    "piqp": lambda tol: {
        "eps_abs": tol, "eps_rel": 0.0, "check_duality_gap": True,
        "eps_duality_gap_abs": tol, "eps_duality_gap_rel": 0.0,
    },
    "clarabel": lambda tol: {"tol_gap_abs": tol, "tol_gap_rel": 0.0, "tol_feas": tol},
    "highs": lambda tol: {"primal_feasibility_tolerance": tol, "dual_feasibility_tolerance": tol},
    "proxqp": lambda tol: {"eps_abs": tol, "eps_rel": 0.0, "check_duality_gap": True},
}  # fmt: skip


def maros(folder: Path) -> Iterator[tuple[str, qpsolvers.Problem]]:
    """The dense programs of the set, double-sided rows as two inequalities, by their names."""
    for path in sorted((folder / "data").glob("*.mat")):
        raw = loadmat(path)
        n = int(raw["n"].item())
        if n > LARGEST:
            continue
        rows = spa.csr_matrix(raw["A"].astype(float))[:-n]
        low, high = (raw[k].ravel().astype(float) for k in "lu")
        low, high = np.where(low < -9e19, -np.inf, low), np.where(high > 9e19, np.inf, high)
        equal = high[:-n] - low[:-n] < 1e-10
        sides = [rows[~equal], -rows[~equal]]
        h = np.concatenate([high[:-n][~equal], -low[:-n][~equal]])
        G, A = spa.vstack(sides, "csr")[h < np.inf].toarray(), rows[equal].toarray()
        if len(G) + len(A) <= LARGEST:
            yield path.stem, qpsolvers.Problem(
                raw["P"].astype(float).toarray(), raw["q"].ravel().astype(float),
                G if len(G) else None, h[h < np.inf] if len(G) else None,
                A if len(A) else None, high[:-n][equal] if len(A) else None,
                low[-n:], high[-n:],
            )  # fmt: skip


def measure(title: str, problems: list[tuple[str, qpsolvers.Problem]], tol: float) -> None:
    """Print a line for each solver: solved, false claims, times, and the names that failed."""
    print(f"\n{title}: {len(problems)} programs at {tol:g}")
    times: dict[str, list[float]] = {name: [] for name in OPTIONS}
    failed: dict[str, list[str]] = {name: [] for name in OPTIONS}
    false = dict.fromkeys(OPTIONS, 0)
    for name, problem in problems:
        for solver, options in OPTIONS.items():
            start, solution = time.perf_counter(), None
            try:
                solution = qpsolvers.solve_problem(problem, solver, **options(tol))
            except Exception as error:
                reason = type(error).__name__
            else:
                reason = "residuals"
            took = time.perf_counter() - start
            solved = solution is not None and solution.is_optimal(tol)
            false[solver] += bool(solution is not None and solution.found and not solved)
            times[solver].append(took if solved else FAILED)
            if not solved:
                failed[solver].append(f"{name} ({reason})")
    for solver in OPTIONS:
        mean = np.exp(np.mean(np.log(np.array(times[solver]) + SHIFT))) - SHIFT
        print(
            f"{solver:10} solved {len(problems) - len(failed[solver]):6}"
            f"  false claims {false[solver]:4}  median {1e3 * np.median(times[solver]):9.3f} ms"
            f"  shifted geometric mean {mean:.3f} s  {', '.join(failed[solver][:12])}"
        )


def main() -> None:
    """Read the options and measure."""
    parser = argparse.ArgumentParser(description=__doc__, prog="benchmarks.foreign")
    parser.add_argument("--degenerate", type=int, default=1000, help="number of programs")
    parser.add_argument("--maros", type=Path, help="folder of the Maros-Meszaros repository")
    given = parser.parse_args()
    iiwa_dnn.qp.register()
    for solver in set(OPTIONS) - set(qpsolvers.available_solvers):
        del OPTIONS[solver]
    warnings.simplefilter("ignore")
    seeds = [np.random.default_rng([7, i]) for i in range(given.degenerate)]
    vertices = [(str(i), programs.degenerate(rng)) for i, rng in enumerate(seeds)]
    measure("degenerate vertices", [(i, qp.to_qpsolvers()) for i, qp in vertices], 1e-9)
    for kind in programs.SCALINGS:
        rngs = [np.random.default_rng([8, i]) for i in range(40)]
        qps = [programs.badly_scaled(rng, kind) for rng in rngs]
        measure(kind, [(str(i), qp.to_qpsolvers()) for i, qp in enumerate(qps)], 1e-6)
    if given.maros:
        for tol in (1e-6, 1e-9):
            measure("Maros-Meszaros", list(maros(given.maros)), tol)


if __name__ == "__main__":
    main()
