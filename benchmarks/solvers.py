"""The network as a QP solver beside its peers: programs of control steps, and random ones.

The clock of the thread runs over the Python call, so no other process counts, and each peer has
the program in its own layout before. They take turns, so that noise of the machine falls on all
alike. The same residuals judge all answers.
"""

import gc
from collections.abc import Callable, Iterator
from time import thread_time
from typing import Any, NamedTuple

import numpy as np

import iiwa_dnn
from benchmarks.peers import OUTSIDE, PEERS, Outside, Peer
from benchmarks.report import show
from iiwa_dnn.qp import QP
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot
from tests.programs import degenerate, heavy_task, repeated_rows, rows_for_bounds, strictly_convex

FAILED = 1e-8
"""An answer whose largest residual is above this has failed, whatever its solver says."""

CHUNK = 50
"""Programs that one peer solves before the next has its turn."""

_COLUMNS = {
    "solver": "{name}",
    "median µs": "{median:.2f}",
    "p99 µs": "{p99:.1f}",
    "worst residual": "{worst:.1e}",
    "failed": "{failed} of {programs}",
}


class Stream(NamedTuple):
    """Programs of one shape, under a title; ``warm`` solvers start from their last answer."""

    name: str
    programs: list[QP]
    warm: bool


def heart(count: int, dt: float, scale: float) -> list[QP]:
    """Return the programs of consecutive control steps, dt [s] apart, of a heart of a scale [m]."""
    robot = paper_robot()
    reference = iiwa_dnn.Heart(scale).anchored(iiwa_dnn.Configuration(robot, paper.START))
    scheme = iiwa_dnn.DoubleIndicator(orientation="so3", home=paper.START)
    options = {"dt": dt, "duration": count * dt, "check": iiwa_dnn.CrossCheck(())}
    record = iiwa_dnn.simulate(robot, scheme, reference, paper.START, **options)
    return [
        scheme.build_qp(iiwa_dnn.Configuration(robot, q), reference.at(float(t)))
        for q, t in zip(record.q[:count], record.t[:count], strict=True)
    ]


def drifting(count: int) -> list[QP]:
    """Return programs of 7 variables, 3 equalities and 3 to 5 active bounds that vary slowly.

    Smooth signals are cut off at the bounds: what is left is x, what was cut is the multiplier.
    """
    rng = np.random.default_rng([8, 0])
    root = rng.standard_normal((7, 7))
    P = root @ root.T / 7.0 + 0.3 * np.eye(7)
    centre = np.array([1.8, -1.8, 1.8, 1.0, -1.0, 0.0, 0.0])
    swing = np.array([0.5, 0.5, 0.5, 0.5, 0.5, 0.8, 0.8])
    phase = rng.uniform(0.0, 2.0 * np.pi, (2, 7))
    rate = rng.uniform(0.004, 0.012, (2, 7))
    rows = rng.standard_normal((2, 3, 7))
    slow = rng.uniform(0.002, 0.006, 3)
    programs = []
    for k in range(count):
        signal = centre + swing * 0.5 * np.sin(rate * k + phase).sum(axis=0)
        x = np.clip(signal, -1.0, 1.0)
        A = rows[0] + 0.3 * np.sin(slow * k)[:, np.newaxis] * rows[1]
        q = -(P @ x + A.T @ np.sin(slow * k + 1.0) + (signal - x))
        programs.append(QP(P, q, A=A, b=A @ x, lb=np.full(7, -1.0), ub=np.ones(7)))
    return programs


def streams(steps: int) -> Iterator[Stream]:
    """Make the streams; of random programs there is one for ten steps."""
    idle = f"The first {steps} control steps of the heart, 1e-4 s apart, limits idle"
    yield Stream(idle, heart(steps, 1e-4, 3.45e-3), True)
    limit = f"A heart of scale 0.008 in {steps} steps: joint 1 lies at its limit for a third of it"
    yield Stream(limit, heart(steps, 10.0 / steps, 8e-3), True)
    yield Stream("Drifting programs, 7 variables, 3 to 5 bounds active", drifting(steps), True)
    for n in (7, 14, 30, 50):
        made = [
            strictly_convex(np.random.default_rng([9, 0, n, k]), n, 1e4, False)[0]
            for k in range(steps // 10)
        ]
        yield Stream(f"Random programs of {n} variables, each from a cold start", made, False)


def moving(n: int, active: int, count: int) -> list[QP]:
    """Return programs of n variables, n rows and wide bounds, of which some rows are active.

    A signal is a row's multiplier while it is positive, and minus its slack else. A tenth of the
    rows, at least one, goes to and fro.
    """
    rng = np.random.default_rng([10, 0, n, active])
    root = rng.standard_normal((n, n))
    P = root @ root.T / n + 0.1 * np.eye(n)
    G = rng.standard_normal((n, n))
    centre = np.where(np.arange(n) < active, 0.6, -0.6)
    centre[rng.permutation(n)[: max(1, n // 10)]] = 0.0
    phase = rng.uniform(0.0, 2.0 * np.pi, (2, n))
    programs = []
    for k in range(count):
        x = np.sin(0.01 * k + phase[0])
        signal = centre + 0.3 * np.sin(0.02 * k + phase[1])
        q = -(P @ x + G.T @ np.maximum(signal, 0.0))
        h = G @ x + np.maximum(-signal, 0.0)
        programs.append(QP(P, q, G, h, lb=np.full(n, -2.0), ub=np.full(n, 2.0)))
    return programs


def report_sizes(count: int) -> None:
    """Print a table by variables and active rows: through qpsolvers, and from a warm start."""
    for warm in (False, True):
        names = [peer.name for peer in PEERS[:4]] if warm else [*OUTSIDE]
        columns = {name: f"{{{name}}}" for name in names}
        how = "from the last answer" if warm else "through qpsolvers, each from a cold start"
        title = f"Rows active and idle, {count} programs a line, {how}: median, p99 [µs]"
        show(title, {"variables": "{n}", "active rows": "{active}", **columns}, sized(count, warm))


def sized(count: int, warm: bool) -> Iterator[dict[str, Any]]:
    """Measure programs of each size, and with few active rows and many."""
    for n in (4, 7, 14, 18, 33, 50, 100):
        for active in (max(1, n // 16), n // 2):
            yield {"n": n, "active": active, **cells(moving(n, active, count), warm)}


def cells(programs: list[QP], warm: bool) -> dict[str, str]:
    """Measure programs; return median, p99 and number of failures by the name of the solver."""
    peers = [peer(True) for peer in PEERS[:4]] if warm else [Outside(name) for name in OUTSIDE]
    return {
        row["name"]: "{median:.0f}, {p99:.0f}".format_map(row)
        + f" ({row['failed']} failed)" * (row["failed"] > 0)
        for row in measure(Stream("", programs, warm), peers)
    }


KINDS: dict[str, Callable[[np.random.Generator, int], QP]] = {
    "random": lambda rng, n: strictly_convex(rng, n, 1e4, False)[0],
    "bounds as rows, twice": lambda rng, n: pink_rows(rng, n),
    "repeated rows": lambda rng, n: repeated_rows(rng, n)[0],
    "degenerate": degenerate,
    "weights to 1e9": lambda rng, n: heavy_task(rng, n)[0],
}
"""Programs by their kind, of n variables."""


def pink_rows(rng: np.random.Generator, n: int) -> QP:
    """Return a program as Pink writes it: two limits of each joint, as rows of plus and minus one.

    The cost is that of three tasks of six rows each and a damping.
    """
    J = rng.standard_normal((min(n, 18), n))
    P = J.T @ J + 0.01 * np.eye(n)
    x = rng.standard_normal(n)
    push = np.where(rng.random(n) < 0.25, rng.standard_normal(n), 0.0)
    lb = np.where(push < 0.0, x, x - rng.exponential(size=n))
    ub = np.where(push > 0.0, x, x + rng.exponential(size=n))
    one = rows_for_bounds(QP(P, -(P @ x + push), lb=lb, ub=ub))
    wider = one.h + rng.exponential(size=2 * n)
    return QP(P, one.q, np.vstack([one.G, one.G]), np.concatenate([one.h, wider]))


def report_kinds(count: int) -> None:
    """Print a table by kind and variables: through qpsolvers, each from a cold start."""
    title = f"Programs of each kind, {count} a line, each from a cold start: median, p99 [µs]"
    columns = {name: f"{{{name}}}" for name in OUTSIDE}
    rows = (
        {"kind": kind, "n": n, **cells(made(kind, n, count), False)}
        for kind in KINDS
        for n in (7, 14, 24, 33, 40)
    )
    show(title, {"programs": "{kind}", "variables": "{n}", **columns}, rows)


def made(kind: str, n: int, count: int) -> list[QP]:
    """Make seeded programs of a kind, of n variables."""
    return [KINDS[kind](np.random.default_rng([11, 0, n, k]), n) for k in range(count)]


def measure(stream: Stream, peers: list[Peer]) -> list[dict[str, Any]]:
    """Solve a stream with each peer, taking turns; return a row for each."""
    times = np.empty((len(peers), len(stream.programs)))
    residuals = np.empty(times.shape)
    for begin in range(0, len(stream.programs), CHUNK):
        chunk = stream.programs[begin : begin + CHUNK]
        turn = begin // CHUNK % len(peers)
        for i in [*range(turn, len(peers)), *range(turn)]:
            converted = [peers[i].convert(qp) for qp in chunk]
            gc.disable()
            for k, (qp, given) in enumerate(zip(chunk, converted, strict=True), begin):
                times[i, k], residuals[i, k] = solve_once(peers[i], qp, given)
            gc.enable()
    rows = []
    for peer, taken, found in zip(peers, 1e6 * times[:, 1:], residuals, strict=True):
        median, p99 = np.quantile(taken, [0.5, 0.99])
        worst = found[found <= FAILED].max(initial=0.0)
        row = {"name": peer.name, "median": median, "p99": p99, "worst": worst}
        rows.append(row | {"failed": int((found > FAILED).sum()), "programs": found.size})
    return rows


def solve_once(peer: Peer, qp: QP, given: Any) -> tuple[float, float]:
    """Return the time of a solve [s], and the largest residual of its answer; inf without one."""
    start = thread_time()
    answer = peer.solve(given)
    seconds = thread_time() - start
    x, *multipliers = peer.point(qp, answer)
    if x is None:
        return seconds, np.inf
    sizes = np.array(qp.sizes)[[2, 1, 0]]
    rest = [
        np.zeros(k) if y is None or not y.size else y
        for y, k in zip(multipliers, sizes, strict=True)
    ]
    point = np.concatenate([x, *rest])
    largest = qp.residuals(point).largest
    if qp.accepts(point, FAILED):  # beside weights of 1e9 residuals of 1e-6 are rounding
        return seconds, min(largest, FAILED)
    return seconds, largest if np.isfinite(largest) else np.inf


def report(steps: int) -> None:
    """Print a table for each stream."""
    for stream in streams(steps):
        show(stream.name, _COLUMNS, measure(stream, [peer(stream.warm) for peer in PEERS]))
    report_sizes(max(20, steps // 50))
    report_kinds(max(20, steps // 50))
