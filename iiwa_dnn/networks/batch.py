"""Many small programs of one shape at once, over all cores."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit, prange
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators import ImplicitEuler
from iiwa_dnn.networks.integrators.implicit import settle_implicit
from iiwa_dnn.qp.dense import cholesky_factor
from iiwa_dnn.qp.layout import Matrix, Vector, compiled, offsets

CHUNK = 128
"""Programs that one thread solves before it takes the next ones."""

SOUND, NOT_FINITE, ASYMMETRIC, INDEFINITE, CROSSED = 0, 1, 2, 3, 4
"""Faults of a program, as `QP.check_values` sees them."""

_NAMES = ("P", "q", "G", "h", "A", "b", "lb", "ub")
_FAULTS = {
    NOT_FINITE: "has a value that is not finite",
    ASYMMETRIC: "is not symmetric",
    INDEFINITE: "is not positive semidefinite, problem not convex",
    CROSSED: "exceeds ub",
}


class BatchSolution(NamedTuple):
    """The answers to k programs, each with the evidence for it.

    Attributes:
        x: Primal points, (k, n). Only those that were found are answers.
        y: Multipliers of the equalities, (k, p).
        z: Multipliers of the inequalities, (k, m).
        z_box: Multipliers of the bounds, (k, n).
        found: Whether every residual is at most the tolerance, (k,).
        residuals: Primal residual, dual residual and duality gap, (k, 3).
        iterations: Linear systems solved, (k,).
    """

    x: Matrix
    y: Matrix
    z: Matrix
    z_box: Matrix
    found: NDArray[np.bool_]
    residuals: Matrix
    iterations: NDArray[np.int64]


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

    The programs are shared out over all cores (numba's threads; `NUMBA_NUM_THREADS` limits them).
    Each answer depends on its own program alone. At most 1000 linear systems are solved for each,
    and no certificate is looked for: `DNNSolver` does that for those that were not found.

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
        InvalidInputError: An array has the wrong shape or a wrong value, a P is not symmetric or
            not positive semidefinite, or a lower bound exceeds its upper bound. The message names
            the argument and the program.
    """
    checks.positive("tol", tol)
    arrays = {
        name: _numbers(name, value)
        for name, value in zip(_NAMES, (P, q, G, h, A, b, lb, ub), strict=True)
        if value is not None
    }
    for left, right in (("G", "h"), ("A", "b")):
        if (left in arrays) != (right in arrays):
            missing, given = (left, right) if right in arrays else (right, left)
            raise InvalidInputError(missing, f"is missing though {given} is given")
    n = arrays["q"].shape[-1] if arrays["q"].ndim else 0
    if n == 0:
        raise InvalidInputError("q", "is empty", q)
    m, p = (arrays[name].shape[-1] if name in arrays and arrays[name].ndim else 0 for name in "hb")
    shapes = {
        "P": (n, n), "q": (n,), "G": (m, n), "h": (m,), "A": (p, n), "b": (p,),
        "lb": (n,), "ub": (n,),
    }  # fmt: skip
    arrays.setdefault("lb", np.full(n, -np.inf))
    arrays.setdefault("ub", np.full(n, np.inf))
    count = _count(arrays, shapes)
    rows = [
        _as_rows(arrays.get(name, np.zeros(shapes[name])), len(shapes[name])) for name in _NAMES
    ]
    points, residuals = np.full((count, 2 * n + m + p), np.nan), np.full((count, 3), np.inf)
    iterations, faults = np.zeros(count, dtype=np.int64), np.zeros((count, 2), dtype=np.int64)
    settler = ImplicitEuler()
    settle: Any = _settle_batch
    settle(
        *rows, n, m, p, tol, settler.max_steps, settler.long_step,
        points, residuals, iterations, faults,
    )  # fmt: skip
    wrong = np.flatnonzero(faults[:, 0])
    if wrong.size:
        kind, argument = faults[wrong[0]].tolist()
        raise InvalidInputError(_NAMES[argument], f"{_FAULTS[kind]}, in program {wrong[0]}")
    return BatchSolution(
        x=points[:, :n],
        y=points[:, n : n + p],
        z=points[:, n + p : n + p + m],
        z_box=points[:, n + p + m :],
        found=np.all(residuals <= tol, axis=1),
        residuals=residuals,
        iterations=iterations,
    )


def _numbers(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """An array of floats."""
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(name, f"is not an array of numbers ({error})", value) from None


def _count(arrays: dict[str, NDArray[np.float64]], shapes: dict[str, tuple[int, ...]]) -> int:
    """How many programs there are; every array has its own shape, that number in front or not."""
    count, counted_by = 1, ""
    for name, array in arrays.items():
        shape = shapes[name]
        leading = array.ndim == len(shape) + 1
        if array.shape[1 if leading else 0 :] != shape:
            raise InvalidInputError(
                name, f"has shape {array.shape}, not {shape} with or without a leading axis"
            )
        if not leading:
            continue
        if array.shape[0] == 0:
            raise InvalidInputError(name, "holds no program")
        if counted_by and array.shape[0] != count:
            raise InvalidInputError(
                name, f"holds {array.shape[0]} programs, but {counted_by} holds {count}"
            )
        count, counted_by = array.shape[0], name
    return count


def _as_rows(array: NDArray[np.float64], axes: int) -> Matrix:
    """One row for each program, or one for all; writable, since numba compiles each kind anew."""
    rows = array.shape[0] if array.ndim > axes else 1
    flat: Vector = np.ascontiguousarray(array).reshape(rows, array.size // rows)
    return flat if flat.flags.writeable else flat.copy()


@compiled
def _all_finite(data: Vector, begin: int, end: int) -> bool:
    """Whether no entry from `begin` up to `end` is infinite or NaN."""
    bad = False
    for i in range(np.uint64(begin), np.uint64(end)):
        bad |= data[i] - data[i] != 0.0
    return not bad


@compiled
def _not_finite(data: Vector, n: int, m: int, p: int) -> int:
    """Index of the first argument of P q G h A b lb ub with a value it may not have, or -1."""
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    if not _all_finite(data, 0, at_q):
        return 0
    if not _all_finite(data, at_q, at_G):
        return 1
    if not _all_finite(data, at_G, at_G + m * n):
        return 2
    if not _all_finite(data, at_A, at_lb - p):
        return 4
    if not _all_finite(data, at_lb - p, at_lb):
        return 5
    for j in range(at_G + m * n, at_A):
        if not data[j] > -np.inf:
            return 3
    for i in range(at_lb, at_lb + n):
        if not data[i] < np.inf:
            return 6
        if not data[i + n] > -np.inf:
            return 7
    return -1


@compiled
def _fault_of_cost(data: Vector, n: int, K: Vector) -> int:
    """What is wrong with P, which is finite."""
    scale = 0.0
    for i in range(n * n):
        scale = max(scale, abs(data[i]))
    for i in range(n):
        for k in range(i):
            if abs(data[i * n + k] - data[k * n + i]) > 1e-10 * scale:
                return ASYMMETRIC
    # Positive semidefinite to 1e-10 of its scale: P plus that much of the identity has a factor.
    for i in range(n * n):
        K[i] = data[i]
    for i in range(n):
        K[i * n + i] += 1e-10 * scale
    return SOUND if scale == 0.0 or cholesky_factor(K, n) else INDEFINITE


@njit(cache=True, parallel=True, error_model="numpy", fastmath={"contract"})
def _settle_batch(
    P: Matrix, q: Matrix, G: Matrix, h: Matrix, A: Matrix, b: Matrix, lb: Matrix, ub: Matrix,
    n: int, m: int, p: int, tol: float, max_systems: int, long_step: float,
    points: Matrix, residuals: Matrix, iterations: NDArray[np.int64], faults: NDArray[np.int64],
) -> None:  # fmt: skip
    """Settle one program for each row of `points`, each from a cold start.

    An input has one row, which all programs share, or one for each program.
    """
    count = points.shape[0]
    parts = n * n + n + m * n + m + p * n + p + 2 * n
    for chunk in prange((count + CHUNK - 1) // CHUNK):
        data, K = np.full(parts, np.nan), np.empty(n * n)
        state = np.empty(3 * n + m + p)
        for row in range(chunk * CHUNK, min((chunk + 1) * CHUNK, count)):
            source = row if P.shape[0] > 1 else 0
            fresh = False
            for i in range(n * n):
                fresh |= data[i] != P[source, i]
                data[i] = P[source, i]
            at = n * n
            for part in (q, G, h, A, b, lb, ub):
                source = row if part.shape[0] > 1 else 0
                for i in range(part.shape[1]):
                    data[at + i] = part[source, i]
                at += part.shape[1]
            argument, kind = _not_finite(data, n, m, p), SOUND
            if argument >= 0:
                kind = NOT_FINITE
            elif fresh:
                argument, kind = 0, _fault_of_cost(data, n, K)
            for i in range(parts - 2 * n, parts - n):
                if kind == SOUND and data[i] > data[i + n]:
                    argument, kind = 6, CROSSED
            faults[row, 0], faults[row, 1] = kind, argument
            if kind != SOUND:
                data[0] = np.nan  # the next one is looked at anew
                continue
            state[:] = 0.0
            systems, _, primal, dual, gap = settle_implicit(
                data, n, m, p, state, points[row], tol, max_systems, long_step
            )
            iterations[row] = systems
            residuals[row, 0], residuals[row, 1], residuals[row, 2] = primal, dual, gap
