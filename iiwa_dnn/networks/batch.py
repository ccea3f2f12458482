"""Many small programs of one shape at once, over all cores."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.kernels import batch as kernels_batch
from iiwa_dnn.networks.integrators import ImplicitEuler
from iiwa_dnn.qp.program import Matrix, Vector

_NAMES = ("P", "q", "G", "h", "A", "b", "lb", "ub")
_FAULTS = {
    kernels_batch.NOT_FINITE: "has a value that is not finite",
    kernels_batch.ASYMMETRIC: "is not symmetric",
    kernels_batch.INDEFINITE: "is not positive semidefinite, problem not convex",
    kernels_batch.CROSSED: "exceeds ub",
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
    settle: Any = kernels_batch.settle_batch
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
