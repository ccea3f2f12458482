r"""The quadratic program.

Fields and multipliers are named as in qpsolvers:

.. math::

    \min_x \tfrac12 x^T P x + q^T x \quad \text{s.t.} \quad
    G x \le h, \; A x = b, \; lb \le x \le ub

with multipliers ``z`` for ``G``, ``y`` for ``A``, and ``z_box`` for the bounds (positive at ``ub``,
negative at ``lb``).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import is_masked
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.dense import all_finite, is_convex, is_symmetric, symmetrize
from iiwa_dnn.qp.layout import (
    Matrix,
    QPViews,
    Sizes,
    Vector,
    check_size,
    copied,
    data_size,
    offsets,
    qp_views,
)
from iiwa_dnn.qp.residuals import is_accepted, residuals_of
from iiwa_dnn.qp.solution import Residuals

if TYPE_CHECKING:
    import qpsolvers

__all__ = ["FIELDS", "QP", "Matrix", "Vector"]

_FLOAT = np.dtype(np.float64)

FIELDS = ("P", "q", "G", "h", "A", "b", "lb", "ub")
"""Names of the eight arrays, in the order of `QP.data` and of qpsolvers."""


@lru_cache
def field_slices(sizes: Sizes) -> list[tuple[slice, tuple[int, ...]]]:
    """Return slice and shape of each field in `QP.data`."""
    n, m, p = sizes
    shapes: list[tuple[int, ...]] = [(n, n), (n,), (m, n), (m,), (p, n), (p,), (n,), (n,)]
    ends = np.cumsum([0, *map(math.prod, shapes)]).tolist()
    return [(slice(*ends[k : k + 2]), shape) for k, shape in enumerate(shapes)]


@lru_cache
def absent_fields(n: int) -> list[NDArray[np.float64]]:
    """Return an empty array, or infinite bounds (n,), for each field that is left out."""
    no_rows = np.empty((0, n))
    nothing = np.empty(0)
    free = np.full(n, np.inf)
    return [nothing, nothing, no_rows, nothing, no_rows, nothing, -free, free]


class _Field:
    """A field of a `QP`: a view of its part of `data`."""

    def __init__(self, name: str) -> None:
        self._index = FIELDS.index(name)

    def __get__(self, qp: QP, owner: type[QP]) -> NDArray[np.float64]:
        part, shape = field_slices(qp.sizes)[self._index]
        return qp.data[part].reshape(shape)


class QP:
    """A convex quadratic program with dense arrays that are always there.

    A part that is left out becomes an array without rows (``G``, ``A``) or infinite bounds, so that
    ``G @ x <= h`` can be written without asking first.

    All numbers lie in one array, ``data = [P | q | G | h | A | b | lb | ub]``, of which the fields
    are views: a program is copied, handed to another process or stacked with others as one row.

    Attributes:
        data: All numbers, row by row, of size n n + n + m n + m + p n + p + 2n.
        sizes: ``(n, m, p)``: variables, inequality rows, equality rows.
        P: Cost matrix, symmetric positive semidefinite, (n, n).
        q: Cost vector, (n,).
        G: Inequality rows, (m, n).
        h: Inequality right-hand side, (m,).
        A: Equality rows, (p, n). They may be linearly dependent.
        b: Equality right-hand side, (p,).
        lb: Lower bounds, (n,), -inf where there is none.
        ub: Upper bounds, (n,), +inf where there is none.
    """

    __slots__ = ("data", "sizes")

    data: Vector
    sizes: Sizes
    P = _Field("P")
    q = _Field("q")
    G = _Field("G")
    h = _Field("h")
    A = _Field("A")
    b = _Field("b")
    lb = _Field("lb")
    ub = _Field("ub")

    def __init__(
        self,
        P: ArrayLike,
        q: ArrayLike,
        G: ArrayLike | None = None,
        h: ArrayLike | None = None,
        A: ArrayLike | None = None,
        b: ArrayLike | None = None,
        lb: ArrayLike | None = None,
        ub: ArrayLike | None = None,
    ) -> None:
        """Copy the arrays as dense float64; shapes are checked here, values by `check_values`.

        P is replaced by its symmetric part where the two differ by no more than `check_values`
        allows: the part decides the answer, its residuals, and whether the program is convex.

        Raises:
            InvalidInputError: An array has the wrong shape; the message names it.
        """
        n = q.size if type(q) is np.ndarray else np.size(q)
        arguments = (P, q, G, h, A, b, lb, ub)
        arrays = [
            absent
            if argument is None
            else argument  # at once: a call costs more than the rest
            if type(argument) is np.ndarray and argument.dtype is _FLOAT
            else real_array(name, argument)
            for name, argument, absent in zip(FIELDS, arguments, absent_fields(n), strict=True)
        ]
        self.sizes = n, arrays[3].size, arrays[5].size
        self.data = np.empty(data_size(*self.sizes))
        try:
            is_packed = pack(QPViews(*arrays), self.data)
        except TypeError:  # an array has gaps, or stands for a matrix of one row
            is_packed = False
        if not is_packed:
            self.sizes = _check_shapes(arguments, arrays)
            self.data = np.concatenate(arrays, axis=None)
            symmetrize(self.P)

    @classmethod
    def from_data(cls, data: Vector, sizes: Sizes) -> QP:
        """Make a program over an existing `data` array (size,), which is not copied.

        Raises:
            InvalidInputError: The array's size is not that of such a program.
        """
        check_size("data", data, data_size(*sizes))
        qp = cls.__new__(cls)
        qp.data = data
        qp.sizes = sizes
        return qp

    @classmethod
    def from_qpsolvers(cls, problem: qpsolvers.Problem) -> QP:
        """Convert a qpsolvers problem, dense or sparse.

        Raises:
            InvalidInputError: An array has the wrong shape; the message names it. Or `problem` is
                not a problem of qpsolvers.
        """
        if not hasattr(problem, "unpack"):
            given = f"must be a qpsolvers.Problem or an iiwa_dnn.QP, not {problem!r:.80}"
            raise InvalidInputError("problem", given, problem)
        return cls(*problem.unpack())

    def __repr__(self) -> str:
        n, m, p = self.sizes
        bounds = int(np.isfinite(self.lb).sum() + np.isfinite(self.ub).sum())
        return f"<QP of {n} variables: {m} inequalities, {p} equalities, {bounds} bounds>"

    def to_qpsolvers(self) -> qpsolvers.Problem:
        """Convert to a problem of qpsolvers; parts without rows are left out, as it expects."""
        import qpsolvers  # with scipy.sparse, 0.2 s that not every run needs

        _, m, p = self.sizes
        bounded = self.lb.max() > -np.inf or self.ub.min() < np.inf
        return qpsolvers.Problem(
            self.P,
            self.q,
            self.G if m else None,
            self.h if m else None,
            self.A if p else None,
            self.b if p else None,
            self.lb if bounded else None,
            self.ub if bounded else None,
        )

    @property
    def views(self) -> QPViews:
        """The fields, as compiled code takes them."""
        fields = field_slices(self.sizes)
        return QPViews(*[self.data[part].reshape(shape) for part, shape in fields])

    def residuals(self, point: Vector) -> Residuals:
        """Compute qpsolvers' residuals of a point ``[x | y | z | z_box]``, (2 n + m + p,)."""
        n, m, p = self.sizes
        check_size("point", point, 2 * n + m + p)
        return Residuals(*residuals_of(self.data, n, m, p, point))

    def accepts(self, point: Vector, eps_abs: float = 1e-9, eps_rel: float = 0.0) -> bool:
        """Check that a point ``[x | y | z | z_box]``, (2 n + m + p,), is an answer.

        The program is convex, and each entry of the residuals is at most its tolerance: `eps_abs`,
        `eps_rel` times the sum of its absolute terms, or rounding (`iiwa_dnn.qp.residuals`).
        """
        n, m, p = self.sizes
        check_size("point", point, 2 * n + m + p)
        return is_accepted(self.data, n, m, p, point, eps_abs, eps_rel)

    def check_values(self) -> None:
        """Check the numbers, and that the program is convex.

        Raises:
            InvalidInputError: As `check_numbers`; or P is not symmetric, each pair of entries to
                1e-5 sqrt(P_ii P_jj) and 4e-15 n times the largest entry, or its symmetric part is
                not positive semidefinite to the latter.
        """
        self.check_numbers()
        if is_convex(self.P, np.empty_like(self.P)):
            return
        if not is_symmetric(self.P, float(np.abs(self.P).max())):
            raise InvalidInputError("P", "is not symmetric")
        smallest = float(np.linalg.eigvalsh(0.5 * (self.P + self.P.T))[0])
        raise InvalidInputError(
            "P", f"is not positive semidefinite: eigenvalue {smallest:.3g}, problem not convex"
        )

    def check_numbers(self) -> None:
        """Check the values, but not that the program is convex.

        Raises:
            InvalidInputError: A value is NaN, a coefficient is infinite, or a lower bound exceeds
                its upper bound. The message names the argument.
        """
        if has_numbers(self.data, *self.sizes):
            return
        limitless = {"h": np.inf, "lb": -np.inf, "ub": np.inf}
        for name in FIELDS:
            value = getattr(self, name)
            wrong = value[~(np.isfinite(value) | (value == limitless.get(name, np.nan)))]
            if wrong.size:
                raise InvalidInputError(name, f"has a value that is {wrong[0]}")
        for i in np.flatnonzero(self.lb > self.ub):
            raise InvalidInputError("lb", f"exceeds ub at {i}: {self.lb[i]:g} > {self.ub[i]:g}")


@compiled
def pack(fields: QPViews, data: Vector) -> bool:
    """Copy the fields of a program into its flat array (size,), and `symmetrize` P there.

    Returns:
        False if their shapes do not fit one another.
    """
    n = fields.q.size
    m = fields.h.size
    p = fields.b.size
    are_rows = fields.P.shape[0] == n and fields.G.shape[0] == m and fields.A.shape[0] == p
    are_columns = fields.P.shape[1] == n and fields.G.shape[1] == n and fields.A.shape[1] == n
    are_bounds = fields.lb.size == n and fields.ub.size == n
    if n == 0 or not (are_rows and are_columns and are_bounds):
        return False
    qp = qp_views(data, n, m, p)
    copied(data, fields.P.reshape(n * n))
    copied(qp.q, fields.q)
    copied(qp.G.reshape(m * n), fields.G.reshape(m * n))
    copied(qp.h, fields.h)
    copied(qp.A.reshape(p * n), fields.A.reshape(p * n))
    copied(qp.b, fields.b)
    copied(qp.lb, fields.lb)
    copied(qp.ub, fields.ub)
    symmetrize(qp.P)
    return True


@compiled
def has_numbers(data: Vector, n: int, m: int, p: int) -> bool:
    """Check that `QP.check_numbers` would find nothing, in one pass over the numbers."""
    _, _, at_A, at_lb = offsets(n, m, p)
    fits = all_finite(data, 0, at_A - m) and all_finite(data, at_A, at_lb)
    qp = qp_views(data, n, m, p)
    for j in range(m):
        fits = fits and qp.h[j] > -np.inf
    for i in range(n):
        fits = fits and qp.lb[i] <= qp.ub[i] and qp.lb[i] < np.inf and qp.ub[i] > -np.inf
    return fits


def _check_shapes(given: Sequence[object], arrays: Sequence[NDArray[np.float64]]) -> Sizes:
    """Count n, m and p, a vector being one row; raise InvalidInputError where shapes disagree."""
    n = arrays[1].size
    if n == 0:
        raise InvalidInputError("q", "is empty", given[1])
    _, m, p = (_rows(name, array, n) for name, array in zip("PGA", arrays[:5:2], strict=True))
    for name, array, (_, shape) in zip(FIELDS, arrays, field_slices((n, m, p)), strict=True):
        if array.size != math.prod(shape):
            raise InvalidInputError(
                name, f"has shape {array.shape}, not {shape}; q has {n} entries"
            )
    return n, m, p


def real_array(name: str, value: Any) -> NDArray[np.float64]:
    """Convert an argument, dense or sparse, to a dense array of floats of its own shape."""
    if hasattr(value, "toarray"):  # scipy's sparse matrices
        value = value.toarray()
    try:
        if np.iscomplexobj(value) or is_masked(value):
            raise TypeError("complex or masked numbers")
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(name, f"is not an array of numbers ({error})", value) from None


def _rows(name: str, array: NDArray[np.float64], n: int) -> int:
    """Count the rows of n columns; a vector is one row."""
    rows = np.atleast_2d(array)
    if rows.ndim != 2 or rows.shape[1] != n:
        raise InvalidInputError(name, f"has shape {array.shape}, but q has {n} entries", array)
    return len(rows)
