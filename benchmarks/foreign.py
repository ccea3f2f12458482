"""Programs that nobody here wrote, and badly posed ones: this solver beside its peers.

``python -m benchmarks.foreign [--degenerate N] [--pink STEPS] [--maros FOLDER]``. ``--pink``
records the inverse-kinematics programs that Pink builds while four arms follow a circle with the
tip, and solves each arm's sequence in order; "iiwa_dnn, warm" keeps the network's state from one
program to the next. FOLDER is a copy of the public repository qpsolvers/maros_meszaros_qpbenchmark;
of its programs those with at most 1000 variables and 1000 rows are taken, dense.

All run in this process, one after another on each program, through qpsolvers. Solved means that
qpsolvers' three residuals are at most the tolerance; a false claim is an answer called found that
is not solved. The shifted geometric mean (10 s) counts a failure as 10 s. With
OPENBLAS_NUM_THREADS=1 all solvers have one thread.
"""

import argparse
import time
import warnings
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
import qpsolvers
import scipy.sparse as spa
from scipy.io import loadmat

import iiwa_dnn
from benchmarks import programs

ARMS = ("iiwa7", "panda", "ur5", "xarm7")
LARGEST = 1000
FAILED = 10.0
SHIFT = 10.0
OPTIONS = {
    "iiwa_dnn": lambda tol: {"eps_abs": tol},
    "daqp": lambda tol: {"primal_tol": tol, "dual_tol": tol},
    "piqp": lambda tol: {
        "eps_abs": tol,
        "eps_rel": 0.0,
        "check_duality_gap": True,
        "eps_duality_gap_abs": tol,
        "eps_duality_gap_rel": 0.0,
    },
    "clarabel": lambda tol: {"tol_gap_abs": tol, "tol_gap_rel": 0.0, "tol_feas": tol},
    "highs": lambda tol: {
        "primal_feasibility_tolerance": tol,
        "dual_feasibility_tolerance": tol,
        "time_limit": FAILED,
    },
    "proxqp": lambda tol: {"eps_abs": tol, "eps_rel": 0.0, "check_duality_gap": True},
}


def maros(folder: Path) -> Iterator[tuple[str, qpsolvers.Problem]]:
    """The dense programs of the set, double-sided rows as two inequalities, by their names."""
    for path in sorted((folder / "data").glob("*.mat")):
        raw = loadmat(path)
        n = int(raw["n"].item())
        if n > LARGEST:
            continue
        rows = spa.csr_matrix(raw["A"].astype(float))[:-n]
        low, high = (raw[k].ravel().astype(float) for k in "lu")
        low = np.where(low < -9e19, -np.inf, low)
        high = np.where(high > 9e19, np.inf, high)
        equal = high[:-n] - low[:-n] < 1e-10
        sides = [rows[~equal], -rows[~equal]]
        h = np.concatenate([high[:-n][~equal], -low[:-n][~equal]])
        G = spa.vstack(sides, "csr")[h < np.inf].toarray()
        A = rows[equal].toarray()
        if len(G) + len(A) <= LARGEST:
            yield (
                path.stem,
                qpsolvers.Problem(
                    raw["P"].astype(float).toarray(),
                    raw["q"].ravel().astype(float),
                    G if len(G) else None,
                    h[h < np.inf] if len(G) else None,
                    A if len(A) else None,
                    high[:-n][equal] if len(A) else None,
                    low[-n:],
                    high[-n:],
                ),
            )


def recorded(arm: str, steps: int) -> list[tuple[str, qpsolvers.Problem]]:
    """Programs of Pink's differential inverse kinematics along a circle of 0.1 m, every 5 ms."""
    import pink
    from pink.tasks import FrameTask, PostureTask

    robot = iiwa_dnn.load_robot(arm)
    dt = 5e-3
    start = robot.start_posture()
    configuration = pink.Configuration(robot.model, robot.model.createData(), start)
    tip = FrameTask(robot.tip, position_cost=1.0, orientation_cost=1.0)
    posture = PostureTask(cost=1e-3)
    tip.set_target_from_configuration(configuration)
    posture.set_target(start)
    center = tip.transform_target_to_world.copy()
    found = []
    for step in range(steps):
        target = center.copy()
        angle = 2.0 * np.pi * step * dt / 4.0
        target.translation = center.translation + 0.1 * np.array(
            [0, np.sin(angle), np.cos(angle) - 1]
        )
        tip.set_target(target)
        problem = pink.build_ik(configuration, [tip, posture], dt)
        found.append((str(step), problem))
        answer = qpsolvers.solve_problem(problem, "quadprog")
        configuration.integrate_inplace(answer.x / dt, dt)
    return found


def kept(tol: float) -> Callable[[qpsolvers.Problem], qpsolvers.Solution]:
    """Make a solver that begins each program where the last one ended."""
    solver = iiwa_dnn.DNNSolver(tol=tol)
    return lambda problem: solver.solve(iiwa_dnn.QP.from_qpsolvers(problem)).to_qpsolvers(problem)


def measure(
    title: str, problems: list[tuple[str, qpsolvers.Problem]], tol: float, warm: bool = False
) -> None:
    """Print a line for each solver: solved, false claims, times, and the names that failed."""
    if not problems:
        return
    print(f"\n{title}: {len(problems)} programs at {tol:g}")
    solve = {
        name: partial(qpsolvers.solve_problem, solver=name, **options(tol))
        for name, options in OPTIONS.items()
    }
    if warm:
        solve["iiwa_dnn, warm"] = kept(tol)
    times: dict[str, list[float]] = {name: [] for name in solve}
    failed: dict[str, list[str]] = {name: [] for name in solve}
    false = dict.fromkeys(solve, 0)
    for name, problem in problems:
        for solver, call in solve.items():
            start = time.perf_counter()
            solution = None
            try:
                solution = call(problem)
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
    for solver in solve:
        mean = np.exp(np.mean(np.log(np.array(times[solver]) + SHIFT))) - SHIFT
        print(
            f"{solver:14} solved {len(problems) - len(failed[solver]):6}"
            f"  false claims {false[solver]:4}  median {1e3 * np.median(times[solver]):9.3f} ms"
            f"  shifted geometric mean {mean:.3f} s  {', '.join(failed[solver][:12])}"
        )


def main() -> None:
    """Read the options and measure."""
    parser = argparse.ArgumentParser(description=__doc__, prog="benchmarks.foreign")
    parser.add_argument("--degenerate", type=int, default=1000, help="number of programs")
    parser.add_argument("--maros", type=Path, help="folder of the Maros-Meszaros repository")
    parser.add_argument("--pink", type=int, default=0, help="steps of each arm's recording")
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
    for arm in ARMS if given.pink else ():
        measure(f"Pink, {arm}", recorded(arm, given.pink), 1e-9, warm=True)
    if given.maros:
        for tol in (1e-6, 1e-9):
            measure("Maros-Meszaros", list(maros(given.maros)), tol)


if __name__ == "__main__":
    main()
