"""Times and residuals of all peers on a stream, and on programs without a solution."""

import gc
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.peers import TOL, Peer
from benchmarks.streams import Stream
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.program import QP, Vector
from iiwa_dnn.qp.solution import Status
from tests import programs

FAILED = 1e-8
"""An answer whose largest residual is above this has failed, whatever its solver says."""
CHUNK = 50
"""Programs that one peer solves before the next has its turn, so that noise falls on all alike."""

Row = dict[str, Any]


def measure_stream(
    stream: Stream, peers: Sequence[type[Peer]], progress: Callable[[], object] = lambda: None
) -> list[Row]:
    """Solve a stream with each peer, taking turns.

    Args:
        stream: The programs.
        peers: The solvers; each gets an instance of its own.
        progress: Called after each chunk of each peer.

    Returns:
        For each peer its median and 99th percentile [µs], its worst residual among the answers that
        did not fail, and how many failed.
    """
    made = [peer(stream.warm) for peer in peers]
    times = np.empty((len(made), len(stream.programs)))
    residuals = np.full(times.shape, np.inf)
    for begin in range(0, len(stream.programs), CHUNK):
        chunk = stream.programs[begin : begin + CHUNK]
        turn = begin // CHUNK % len(made)
        for i in [*range(turn, len(made)), *range(turn)]:
            peer = made[i]
            converted = [peer.convert(qp) for qp in chunk]
            gc.disable()
            for k, (qp, given) in enumerate(zip(chunk, converted, strict=True), begin):
                times[i, k], residuals[i, k] = _solve_once(peer, qp, given)
            gc.enable()
            progress()
    return [
        {"solver": peer.name, **_summary(times[i], residuals[i])} for i, peer in enumerate(made)
    ]


def _solve_once(peer: Peer, qp: QP, given: Any) -> tuple[float, float]:
    """Seconds of one solve, and the largest residual of its answer; inf where there is none."""
    start = perf_counter()
    try:
        answer = peer.solve(given)
    except (ValueError, RuntimeError):  # quadprog's way of saying that it found none
        peer.ready = False
        return perf_counter() - start, np.inf
    seconds = perf_counter() - start
    x, *multipliers = peer.point(qp, answer)
    if x is None:
        return seconds, np.inf
    largest = qp.residuals(x, *multipliers).largest
    return seconds, largest if np.isfinite(largest) else np.inf


def _summary(times: Vector, residuals: Vector) -> Row:
    # The first program compiles, allocates, and warms nothing up yet.
    counted = 1e6 * times[1:] if times.size > 1 else 1e6 * times
    good = residuals <= FAILED
    return {
        "median_us": float(np.median(counted)),
        "p99_us": float(np.quantile(counted, 0.99)),
        "worst_residual": float(residuals[good].max()) if good.any() else None,
        "failed": int((~good).sum()),
        "programs": int(residuals.size),
    }


def measure_known(solvable: int, infeasible: int, unbounded: int) -> list[Row]:
    """This package's solver on programs that are known by construction.

    Returns:
        For each kind how many were recognised, and the times [ms] of it; for the solvable ones the
        largest error of x too.
    """
    solved = {Status.SOLVED}
    none_feasible = {Status.PRIMAL_INFEASIBLE, Status.NONE_FEASIBLE_NEAR}
    none_optimal = {Status.UNBOUNDED, Status.NONE_OPTIMAL_NEAR}
    kinds: list[tuple[str, int, Callable[[np.random.Generator], Any], set[Status]]] = [
        ("strictly convex, condition up to 1e6", solvable, programs.strictly_convex, solved),
        ("infeasible", infeasible, programs.infeasible, none_feasible),
        ("unbounded", unbounded, programs.unbounded, none_optimal),
    ]
    solver = DNNSolver(tol=TOL)
    rows = []
    for seed, (name, count, make, wanted) in enumerate(kinds, 1):
        solver.reset()
        warm_up = make(np.random.default_rng([seed, count]))
        solver.solve(warm_up[0] if isinstance(warm_up, tuple) else warm_up)
        times = []
        right = 0
        error = 0.0
        for k in range(count):
            made = make(np.random.default_rng([min(seed, 2), k]))
            qp = made[0] if isinstance(made, tuple) else made
            solver.reset()
            start = perf_counter()
            solution = solver.solve(qp)
            times.append(1e3 * (perf_counter() - start))
            right += solution.status in wanted
            if isinstance(made, tuple):
                error = max(error, float(np.abs(solution.x - made[1]).max()))
        rows.append(
            {
                "kind": name,
                "programs": count,
                "recognised": right,
                "median_ms": float(np.median(times)),
                "largest_ms": float(np.max(times)),
                "largest_error": error if make is programs.strictly_convex else None,
            }
        )
    return rows
