"""Many small programs of one shape at once, over all cores."""

import math
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators import barrier
from iiwa_dnn.networks.integrators.implicit import SETTLE, ImplicitEuler, settle_implicit
from iiwa_dnn.networks.integrators.side_by_side import LANES, ROUNDS, free_steps
from iiwa_dnn.qp.dense import is_convex
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector, compiled, released
from iiwa_dnn.qp.program import FIELDS, QP, numbers, require_pairs
from iiwa_dnn.qp.residuals import point_residuals, within

CHUNK = 128
"""Programs that one thread solves before it takes the next ones."""

SMALL = 32
"""Variables up to which first steps are taken side by side."""

BARRIER = 50
"""Budget of linear systems, on top, of a program that starts again through the barrier."""

_enter = SETTLE.enter
_AXES = {name: 2 if name in "PGA" else 1 for name in FIELDS}


class BatchSolution(NamedTuple):
    """The answers to k programs, each with the evidence for it.

    Attributes:
        x: Primal points, (k, n). Only those that were found are answers.
        y: Multipliers of the equalities, (k, p).
        z: Multipliers of the inequalities, (k, m).
        z_box: Multipliers of the bounds, (k, n).
        found: True where every residual is at most the tolerance, (k,).
        residuals: Primal residual, dual residual and duality gap, (k, 3).
        iterations: Linear systems solved, (k,).
        faults: Errors of programs that are not convex quadratic programs, by index.
            Their points are NaN.
    """

    x: Matrix
    y: Matrix
    z: Matrix
    z_box: Matrix
    found: NDArray[np.bool_]
    residuals: Matrix
    iterations: NDArray[np.int64]
    faults: dict[int, InvalidInputError]


def solve_batch(
    P: ArrayLike,
    q: ArrayLike,
    G: ArrayLike | None = None,
    h: ArrayLike | None = None,
    A: ArrayLike | None = None,
    b: ArrayLike | None = None,
    lb: ArrayLike | None = None,
    ub: ArrayLike | None = None,
    tol: float = 1e-9,
) -> BatchSolution:
    """Solve k programs with the paper's network, integrated implicitly, each from a cold start.

    The programs are shared out over all cores (`NUMBA_NUM_THREADS` limits them). Each answer
    depends on its own program alone, and a program with a wrong value spoils no other: it is not
    found, and `faults` names its argument. At most 1000 linear systems are solved for each; what is
    not settled starts once more through the barrier (about 10 ms a program). No certificate is
    looked for: `DNNSolver` does that for those that were not found.

    Args:
        P: Cost matrices, (k, n, n), or (n, n) for one that all share. The same holds for the
            others: without its leading axis an array is shared by all programs.
        q: Cost vectors, (k, n) or (n,).
        G: Inequality rows, (k, m, n) or (m, n).
        h: Their right-hand sides, (k, m) or (m,).
        A: Equality rows, (k, p, n) or (p, n).
        b: Their right-hand sides, (k, p) or (p,).
        lb: Lower bounds, (k, n) or (n,).
        ub: Upper bounds, (k, n) or (n,).
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.

    Raises:
        InvalidInputError: An array has the wrong shape, or one that all programs share has a value
            that spoils them all (`QP.check_values`). The message names the argument.
    """
    checks.positive("tol", tol)
    given = zip(FIELDS, (P, q, G, h, A, b, lb, ub), strict=True)
    arrays = {name: numbers(name, value) for name, value in given if value is not None}
    require_pairs([arrays.get(name) for name in FIELDS])
    parts, (n, m, p), count = _stacked(arrays)
    points, residuals = np.full((count, 2 * n + m + p), np.nan), np.empty((count, 3))
    iterations = np.zeros(count, dtype=np.int64)
    _settle_all(parts, (n, m, p), tol, points, residuals, iterations)
    unsolved = np.flatnonzero(~np.all(residuals <= tol, axis=1))
    faults = _faults(parts, (n, m, p), unsolved)
    for k in unsolved.tolist():
        if k not in faults and iterations[k]:
            qp, state, point = (
                _member(parts, (n, m, p), k),
                np.zeros(3 * n + m + p),
                points[k].copy(),
            )
            systems, _, *again = barrier.settle(qp, state, point, tol, BARRIER)
            iterations[k] += systems
            if max(again) < residuals[k].max():
                points[k], residuals[k] = point, again
    found = np.all(residuals <= tol, axis=1)
    if len(faults) == count and arrays[faults[0].argument].ndim == _AXES[faults[0].argument]:
        raise faults[0]
    for k in faults:
        points[k], residuals[k], iterations[k] = np.nan, np.inf, 0
    x, y, z, z_box = np.split(points, [n, n + p, n + p + m], axis=1)
    return BatchSolution(x, y, z, z_box, found, residuals, iterations, faults)


def _stacked(arrays: dict[str, NDArray[np.float64]]) -> tuple[list[Matrix], Sizes, int]:
    """Check the shapes; returns the eight parts with a row for each program or one for all."""
    n = arrays["q"].shape[-1] if "q" in arrays and arrays["q"].ndim else 0
    if n == 0:
        raise InvalidInputError("q", "is empty")
    if "P" not in arrays:
        raise InvalidInputError("P", "is missing")
    # Rows decide on m and p, so that a right-hand side that does not fit is the one named.
    m, p = (arrays[k].shape[-2] if k in arrays and arrays[k].ndim > 1 else 0 for k in "GA")
    shapes = ((n, n), (n,), (m, n), (m,), (p, n), (p,), (n,), (n,))
    unbounded = {"lb": np.full(n, -np.inf), "ub": np.full(n, np.inf)}
    parts: list[Matrix] = []
    count, counted_by = 1, ""
    for name, shape in zip(FIELDS, shapes, strict=True):
        array = arrays.get(name, unbounded.get(name, np.empty(shape)))
        leading = array.shape[: array.ndim - len(shape)]
        if array.shape != (*leading, *shape) or len(leading) > 1:
            problem = f"has shape {array.shape}, not {shape} with or without a leading axis"
            raise InvalidInputError(name, problem)
        if leading == (0,):
            raise InvalidInputError(name, "holds no program")
        if leading and counted_by and leading != (count,):
            problem = f"holds {leading[0]} programs, but {counted_by} holds {count}"
            raise InvalidInputError(name, problem)
        if leading:
            count, counted_by = leading[0], name
        # Writable, since numba compiles each kind anew.
        flat: Matrix = np.require(array, requirements=("C", "W"))
        parts.append(flat.reshape(math.prod(leading), math.prod(shape)))
    return parts, (n, m, p), count


def _member(parts: list[Matrix], sizes: Sizes, k: int) -> QP:
    """Copy program k."""
    data = np.concatenate([part[k if len(part) > 1 else 0] for part in parts])
    return QP.from_data(data, sizes)


def _faults(
    parts: list[Matrix], sizes: Sizes, unsolved: NDArray[np.intp]
) -> dict[int, InvalidInputError]:
    """Check the values of the programs that were not solved; returns the errors by number."""
    faults = {}
    for k in unsolved.tolist():
        try:
            _member(parts, sizes, k).check_values()
        except InvalidInputError as error:
            faults[k] = error
    return faults


def _settle_all(
    parts: list[Matrix], sizes: Sizes, tol: float, points: Matrix,
    residuals: Matrix, iterations: NDArray[np.int64],
) -> None:  # fmt: skip
    """Settle one program for each row of `points`, over all cores."""
    settler, count, address = ImplicitEuler(), len(points), SETTLE.address(settle_implicit)

    def settle(first: int) -> None:
        _settle_rows(
            first, min(first + CHUNK, count), tuple(parts), sizes, tol, settler.max_steps,
            settler.long_step, points, residuals, iterations, address,
        )  # fmt: skip

    # Not numba's own threads: those end the process where two callers use them at once.
    threads: int = numba.config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(settle, range(0, count, CHUNK)))


@released
def _settle_rows(
    first: int, last: int, parts: tuple[Matrix, ...], sizes: Sizes, tol: float,
    max_systems: int, long_step: float, points: Matrix, residuals: Matrix,
    iterations: NDArray[np.int64], address: int,
) -> None:  # fmt: skip
    """Settle the programs from `first` up to `last`, each from a cold start.

    A part has one row, which all programs share, or one for each program. The residuals are
    infinite where the cost is not convex. First steps of small programs are taken side by side.
    """
    n, m, p = sizes
    size, beside, convex = (n + m + p) * (n + 1) + 2 * n, n <= SMALL, False
    block, lanes, K = np.empty((LANES, size)), np.empty(size * LANES), np.empty(n * n)
    state, point = np.empty(3 * n + m + p), np.empty(2 * n + m + p)
    steps: Vector = np.empty(0)
    for start in range(first, last, LANES):
        count = min(LANES, last - start)
        for k in range(count):
            _gather(parts, start + k, block[k])
        if beside:
            steps = _free_points(block, count, n, m, p, long_step, lanes)
        for k in range(count):
            row, data = start + k, block[k]
            for i in range(3):
                residuals[row, i] = np.inf
            if row == first or parts[0].shape[0] > 1:
                convex = is_convex(data, n, K)
            if not convex:
                continue
            systems, primal, dual, gap = ROUNDS, np.inf, np.inf, np.inf
            for i in range(point.size):
                point[i] = steps[i * LANES + k] if beside and i < n + p else 0.0
            if beside:
                primal, dual, gap = point_residuals(data, n, m, p, point)
            if not within(primal, dual, gap, tol):
                for i in range(state.size):
                    state[i] = 0.0
                systems, _, primal, dual, gap = _enter(
                    address, data, n, m, p, state, point, tol, max_systems, long_step
                )
            for i in range(point.size):
                points[row, i] = point[i]
            iterations[row] = systems
            residuals[row, 0], residuals[row, 1], residuals[row, 2] = primal, dual, gap


@compiled
def _gather(parts: tuple[Matrix, ...], row: int, data: Vector) -> None:
    """Write the parts of a program one after another into `data`."""
    at = 0
    for part in parts:
        source = row if part.shape[0] > 1 else 0
        for i in range(part.shape[1]):
            data[at + i] = part[source, i]
        at += part.shape[1]


@compiled
def _free_points(
    block: Matrix, count: int, n: int, m: int, p: int, step: float, lanes: Vector
) -> Vector:
    """Return x and y, ((n + p) LANES,), of the programs of a block after steps without limits."""
    for i in range(block.shape[1]):
        for k in range(LANES):
            lanes[i * LANES + k] = block[min(k, count - 1), i]
    result = np.empty((n + p) * LANES)
    free_steps(lanes, n, m, p, step, result[: n * LANES], result[n * LANES :])
    return result
