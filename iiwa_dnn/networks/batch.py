"""Many small programs of one shape at once, over all cores."""

from concurrent.futures import ThreadPoolExecutor
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators.base import ANSWER, enter_answer
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler, settle
from iiwa_dnn.qp.dense import is_convex
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector, field_shapes, qp_views, released
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

    The programs are shared out over all cores (`NUMBA_NUM_THREADS` limits them). A program with a
    wrong value spoils no other: it is not found. No second start and no certificate are tried:
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
    points = np.full((len(programs), 2 * n + m + p), np.nan)
    figures = np.full((len(programs), 4), np.inf)
    constants = np.array([tol, ImplicitEuler().max_steps])
    address = ANSWER.address(settle)

    def settle_chunk(first: int) -> None:
        rows = slice(first, first + CHUNK)
        _settle_rows(programs[rows], sizes, address, constants, points[rows], figures[rows])

    # Not numba's own threads: those end the process if two callers use them at once.
    threads: int = numba.config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(settle_chunk, range(0, len(programs), CHUNK)))
    x, y, z, z_box = np.split(points, [n, n + p, n + p + m], axis=1)
    residuals = figures[:, :3]
    systems = np.where(figures[:, 3] < np.inf, figures[:, 3], 0.0).astype(np.int64)
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
    rows: Matrix, sizes: Sizes, address: int, constants: Vector, points: Matrix, figures: Matrix
) -> None:
    """Settle programs, one `QP.data` a row, each from a cold start.

    Point and ``[primal, dual, gap, linear systems]`` of those whose cost is convex are written.
    """
    n, m, p = sizes
    K = np.empty((n, n))
    for k in range(rows.shape[0]):
        qp = qp_views(rows[k], n, m, p)
        if is_convex(qp.P, K):
            state = np.zeros(3 * n + m + p)
            systems, _, primal, dual, gap = enter_answer(
                address, qp, 0, constants, state, points[k]
            )
            figures[k, 0] = primal
            figures[k, 1] = dual
            figures[k, 2] = gap
            figures[k, 3] = systems
