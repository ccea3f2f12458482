"""Many small programs of one shape at once, over all cores."""

import os
from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import released
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler, settle
from iiwa_dnn.qp.dense import is_convex
from iiwa_dnn.qp.layout import IntVector, Matrix, Sizes, Vector, field_shapes, qp_views
from iiwa_dnn.qp.program import FIELDS, absent_fields, real_array, require_pairs

CHUNK = 128
"""Programs that one thread solves before it takes the next ones."""


class BatchSolution(NamedTuple):
    """The answers to k programs, each with the evidence for it.

    Attributes:
        x: Primal points, (k, n). Only those that were found are answers.
        y: Multipliers of the equalities, (k, p).
        z: Multipliers of the inequalities, (k, m).
        z_box: Multipliers of the bounds, (k, n).
        found: True where every residual is at most the tolerance, (k,).
        residuals: Primal residual, dual residual and duality gap, (k, 3); inf where the cost is not
            convex.
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

    The programs are shared out over all cores. A program with a wrong value spoils no other: it is
    not found. No second start and no certificate are tried:
    `DNNSolver` does that for those that were not found.

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
        InvalidInputError: An array has the wrong shape. The message names the argument.
    """
    checks.positive("tol", tol)
    programs, sizes = _stacked((P, q, G, h, A, b, lb, ub))
    n, m, p = sizes
    count = len(programs)
    points = np.full((count, 2 * n + m + p), np.nan)
    residuals = np.full((count, 3), np.inf)
    systems = np.zeros(count, dtype=np.int64)
    constants = np.array([tol, ImplicitEuler().max_steps])

    def settle_chunk(first: int) -> None:
        rows = slice(first, first + CHUNK)
        _settle_rows(programs[rows], sizes, constants, points[rows], residuals[rows], systems[rows])

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(settle_chunk, range(0, count, CHUNK)))
    x, y, z, z_box = np.split(points, [n, n + p, n + p + m], axis=1)
    found = np.all(residuals <= tol, axis=1)
    return BatchSolution(x, y, z, z_box, found, residuals, systems)


def _stacked(arguments: tuple[ArrayLike | None, ...]) -> tuple[Matrix, Sizes]:
    """Stack the programs, one `QP.data` a row, (k, size); returns their sizes too."""
    require_pairs(arguments)
    q = real_array("q", arguments[1])
    if q.ndim == 0 or q.size == 0:
        raise InvalidInputError("q", "is empty", arguments[1])
    n = q.shape[-1]
    arrays = [
        absent if value is None else real_array(name, value)
        for name, value, absent in zip(FIELDS, arguments, absent_fields(n), strict=True)
    ]
    sizes = n, arrays[3].shape[-1], arrays[5].shape[-1]
    shapes = field_shapes(sizes)
    counts = {a.shape[0] for a, shape in zip(arrays, shapes, strict=True) if a.ndim > len(shape)}
    count = max(counts, default=1)
    fields = []
    for name, array, shape in zip(FIELDS, arrays, shapes, strict=True):
        if array.shape not in (shape, (count, *shape)):
            problem = f"has shape {array.shape}, not {shape} or {(count, *shape)}"
            raise InvalidInputError(name, problem)
        fields.append(np.broadcast_to(array, (count, *shape)).reshape(count, -1))
    return np.hstack(fields), sizes


@released
def _settle_rows(
    programs: Matrix,
    sizes: Sizes,
    constants: Vector,
    points: Matrix,
    residuals: Matrix,
    systems: IntVector,
) -> None:
    """Settle programs, one `QP.data` a row, each from a cold start, those whose cost is convex.

    The constants are those of `settle`; points (k, 2n + m + p), residuals (k, 3) and linear systems
    (k,) are written.
    """
    n, m, p = sizes
    K = np.empty((n, n))
    for k in range(programs.shape[0]):
        qp = qp_views(programs[k], n, m, p)
        if is_convex(qp.P, K):
            state = np.zeros(3 * n + m + p)
            count, _, primal, dual, gap = settle(qp, 0, constants, state, points[k])
            residuals[k, 0] = primal
            residuals[k, 1] = dual
            residuals[k, 2] = gap
            systems[k] = count
