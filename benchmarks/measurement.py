"""Times and residuals of all peers on a stream, of a batch, and on programs without a solution."""

import gc
import os
from collections.abc import Callable, Sequence
from time import perf_counter
from typing import Any

import numpy as np
from proxsuite import proxqp

from benchmarks import programs
from benchmarks.peers import TOL, Peer
from benchmarks.streams import Stream
from iiwa_dnn.networks.batch import solve_batch
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.program import QP, Vector
from iiwa_dnn.qp.solution import Status

FAILED = 1e-8
"""An answer whose largest residual is above this has failed, whatever its solver says."""
CHUNK = 50
"""Programs that one peer solves before the next has its turn, so that noise falls on all alike."""

CALLS = 5
"""Calls of `solve_batch`, of which the median counts; ProxQP's slices are many calls already."""

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


def measure_batch(given: Sequence[QP], count: int, slice_size: int = 5000) -> list[Row]:
    """`solve_batch` beside ProxQP's BatchQP with solve_in_parallel, on the same programs and cores.

    Args:
        given: Programs of one shape, taken in turn.
        count: How many programs to solve.
        slice_size: Programs in one BatchQP, which is heavy on memory; the times are added up. Every
            tenth of its answers is judged.

    Returns:
        For each of both the time per program [µs] of solving alone and with what comes before it,
        that is handing the programs over. `solve_batch` does both at once.
    """
    n, m, p = given[0].sizes
    if m:
        raise ValueError("the batch is measured on programs without inequality rows")
    names = ("P", "q", "A", "b", "lb", "ub")
    stacks: dict[str, Any] = {name: np.stack([getattr(qp, name) for qp in given]) for name in names}
    solve_batch(**stacks)  # compiles
    threads = os.cpu_count() or 1
    eye = np.eye(n)
    seconds = {"filled": 0.0, "solved": 0.0}
    picked = np.arange(count) % len(given)
    everything: dict[str, Any] = {name: stack[picked] for name, stack in stacks.items()}
    calls = []
    for _ in range(CALLS):
        start = perf_counter()
        batch = solve_batch(**everything, tol=TOL)
        calls.append(perf_counter() - start)
    ours = float(np.median(calls))
    worst = 0.0
    failed = 0
    for begin in range(0, count, slice_size):
        picked = np.arange(begin, min(begin + slice_size, count)) % len(given)
        arrays = {name: stack[picked] for name, stack in stacks.items()}
        start = perf_counter()
        qps = proxqp.dense.BatchQP(picked.size)
        for k in range(picked.size):
            qp = qps.init_qp_in_place(n, p, n)
            qp.settings.eps_abs = TOL
            qp.settings.eps_rel = 0.0
            qp.init(
                arrays["P"][k],
                arrays["q"][k],
                arrays["A"][k],
                arrays["b"][k],
                eye,
                arrays["lb"][k],
                arrays["ub"][k],
            )
        seconds["filled"] += perf_counter() - start
        start = perf_counter()
        proxqp.dense.solve_in_parallel(qps, threads)
        seconds["solved"] += perf_counter() - start
        for k in range(0, picked.size, 10):
            results = qps.get(k).results
            residual = given[picked[k]].residuals(results.x, results.y, None, results.z).largest
            worst = max(worst, residual)
            failed = failed + 10 * (not residual <= FAILED)
    scale = 1e6 / count
    return [
        {
            "solver": "iiwa_dnn solve_batch",
            "solve_us": scale * ours,
            "total_us": scale * ours,
            "worst_residual": float(batch.residuals.max()),
            "failed": int((~batch.found).sum()),
        },
        {
            "solver": "ProxQP BatchQP",
            "solve_us": scale * seconds["solved"],
            "total_us": scale * (seconds["solved"] + seconds["filled"]),
            "worst_residual": worst,
            "failed": failed,
        },
    ]


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
