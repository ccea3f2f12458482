"""Many small programs of one shape at once, over all cores."""

import math
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators.base import ANSWER, enter_answer
from iiwa_dnn.networks.integrators.equilibration import settle_equilibrated
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler, settle
from iiwa_dnn.qp.dense import is_convex
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector, field_shapes, qp_views, released
from iiwa_dnn.qp.program import FIELDS, QP, absent_fields, real_array, require_pairs

CHUNK = 128
"""Programs that one thread solves before it takes the next ones."""

AGAIN = 100
"""Budget of linear systems, on top, of a program that starts again in other coordinates."""


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


@dataclass(frozen=True)
class _Stack:
    """Programs of one shape, field by field.

    Attributes:
        fields: One row for each program, or one that all share, of each field's numbers.
        sizes: ``(n, m, p)``.
        count: Number of programs.
    """

    fields: list[Matrix]
    sizes: Sizes
    count: int

    def rows(self, first: int, last: int) -> Matrix:
        """Copy the programs from `first` up to `last`, one `QP.data` a row."""
        return np.hstack(
            [
                np.broadcast_to(
                    field if len(field) == 1 else field[first:last],
                    (last - first, field.shape[1]),
                )
                for field in self.fields
            ]
        )

    def program(self, k: int) -> QP:
        """Copy program k."""
        return QP.from_data(self.rows(k, k + 1)[0], self.sizes)


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
    not settled starts once more in other coordinates (about 1 ms a program). No certificate is
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
    arguments = zip(FIELDS, (P, q, G, h, A, b, lb, ub), strict=True)
    arrays = {name: real_array(name, value) for name, value in arguments if value is not None}
    require_pairs([arrays.get(name) for name in FIELDS])
    stack = _stacked(arrays)
    n, m, p = stack.sizes
    points = np.full((stack.count, 2 * n + m + p), np.nan)
    figures = np.full((stack.count, 4), np.inf)
    _settle_all(stack, tol, points, figures)
    residuals = figures[:, :3]
    iterations = figures[:, 3]
    faults = {}
    for k in np.flatnonzero(~np.all(residuals <= tol, axis=1)).tolist():
        qp = stack.program(k)
        try:
            qp.check_values()
        except InvalidInputError as error:
            faults[k] = error
            points[k] = np.nan
            figures[k] = (np.inf, np.inf, np.inf, 0.0)
            continue
        point = points[k].copy()
        systems, _, *again = settle_equilibrated(qp, np.zeros(3 * n + m + p), point, tol, AGAIN)
        iterations[k] += systems
        if max(again) < residuals[k].max():
            points[k] = point
            residuals[k] = again
    if len(faults) == stack.count:
        field = FIELDS.index(faults[0].argument)
        if len(stack.fields[field]) == 1:  # shared by all
            raise faults[0]
    x, y, z, z_box = np.split(points, [n, n + p, n + p + m], axis=1)
    found = np.all(residuals <= tol, axis=1)
    return BatchSolution(x, y, z, z_box, found, residuals, iterations.astype(np.int64), faults)


def _stacked(arrays: dict[str, NDArray[np.float64]]) -> _Stack:
    """Check the shapes and count the programs; raises InvalidInputError naming the argument."""
    sizes = _sizes(arrays)
    fields: list[Matrix] = []
    counts = {}
    shapes = field_shapes(sizes)
    for name, shape, absent in zip(FIELDS, shapes, absent_fields(sizes[0]), strict=True):
        array = arrays.get(name, absent)
        leading = array.shape[: array.ndim - len(shape)]
        if array.shape != (*leading, *shape) or len(leading) > 1:
            problem = f"has shape {array.shape}, not {shape} with or without a leading axis"
            raise InvalidInputError(name, problem)
        if leading:
            counts[name] = leading[0]
        fields.append(array.reshape(math.prod(leading), math.prod(shape)))
    return _Stack(fields, sizes, _common_count(counts))


def _sizes(arrays: dict[str, NDArray[np.float64]]) -> Sizes:
    """Read (n, m, p) off q and the rows; raises InvalidInputError if P or q is not there."""
    if "q" not in arrays or arrays["q"].ndim == 0 or arrays["q"].shape[-1] == 0:
        raise InvalidInputError("q", "is empty")
    if "P" not in arrays:
        raise InvalidInputError("P", "is missing")
    # Rows decide on m and p, so that a right-hand side that does not fit is the one named.
    m, p = (arrays[k].shape[-2] if k in arrays and arrays[k].ndim > 1 else 0 for k in "GA")
    return arrays["q"].shape[-1], m, p


def _common_count(counts: dict[str, int]) -> int:
    """Return the number of programs on which the stacked arguments agree, 1 if none is stacked."""
    first, count = next(iter(counts.items()), ("", 1))
    for name, other in counts.items():
        if other == 0:
            raise InvalidInputError(name, "holds no program")
        if other != count:
            raise InvalidInputError(name, f"holds {other} programs, but {first} holds {count}")
    return count


def _settle_all(stack: _Stack, tol: float, points: Matrix, figures: Matrix) -> None:
    """Settle every program, over all cores."""
    settler = ImplicitEuler()
    constants = np.array([tol, settler.max_steps, settler.long_step])
    address = ANSWER.address(settle)
    shared_cost = len(stack.fields[0]) == 1

    def settle_chunk(first: int) -> None:
        rows = stack.rows(first, min(first + CHUNK, stack.count))
        last = first + len(rows)
        answers = points[first:last]
        _settle_rows(
            rows, stack.sizes, shared_cost, address, constants, answers, figures[first:last]
        )

    # Not numba's own threads: those end the process if two callers use them at once.
    threads: int = numba.config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(settle_chunk, range(0, stack.count, CHUNK)))


@released
def _settle_rows(
    rows: Matrix,
    sizes: Sizes,
    shared_cost: bool,
    address: int,
    constants: Vector,
    points: Matrix,
    figures: Matrix,
) -> None:
    """Settle programs, one `QP.data` a row, each from a cold start.

    Point and ``[primal, dual, gap, linear systems]`` of those whose cost is convex are written.
    """
    n, m, p = sizes
    K = np.empty((n, n))
    state = np.empty(3 * n + m + p)
    convex = False
    for k in range(rows.shape[0]):
        qp = qp_views(rows[k], n, m, p)
        if k == 0 or not shared_cost:
            convex = is_convex(qp.P, K)
        if not convex:
            continue
        for i in range(state.size):
            state[i] = 0.0
        systems, _, primal, dual, gap = enter_answer(address, qp, 0, constants, state, points[k])
        figures[k, 0] = primal
        figures[k, 1] = dual
        figures[k, 2] = gap
        figures[k, 3] = systems
