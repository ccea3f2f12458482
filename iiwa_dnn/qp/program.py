r"""The quadratic program.

Fields and multipliers are named as in qpsolvers:

.. math::

    \min_x \tfrac12 x^T P x + q^T x \quad \text{s.t.} \quad
    G x \le h, \; A x = b, \; lb \le x \le ub

with multipliers ``z`` for ``G``, ``y`` for ``A``, and ``z_box`` for the bounds (positive at ``ub``,
negative at ``lb``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.residuals import point_residuals
from iiwa_dnn.qp.solution import Residuals

if TYPE_CHECKING:
    import qpsolvers

__all__ = ["QP", "Matrix", "Vector"]


def _numbers(name: str, value: Any) -> NDArray[np.float64]:
    """A dense array of floats."""
    if hasattr(value, "toarray"):  # scipy's sparse matrices
        value = value.toarray()
    try:
        return np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(name, f"is not an array of numbers ({error})", value) from None


def _matrix(name: str, value: Any, columns: int) -> Matrix:
    """A matrix with `columns` columns, without rows where there is none."""
    if value is None:
        return np.zeros((0, columns))
    matrix = _numbers(name, value)
    if matrix.ndim == 1 and matrix.size == columns:
        matrix = matrix.reshape(1, columns)
    if matrix.ndim != 2 or matrix.shape[1] != columns:
        raise InvalidInputError(name, f"has shape {matrix.shape}, not (rows, {columns})", value)
    return matrix


def _vector(name: str, value: Any, size: int, default: float) -> Vector:
    """A vector of length `size`, filled with `default` where there is none."""
    if value is None:
        return np.full(size, default)
    vector = _numbers(name, value)
    if vector.size != size:
        raise InvalidInputError(name, f"has shape {vector.shape}, not ({size},)", value)
    return vector.reshape(size)


class QP:
    """A convex quadratic program with dense arrays that are always there.

    What is left out becomes an array without rows (``G``, ``A``) or infinite bounds, so that
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
    sizes: tuple[int, int, int]

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

        Raises:
            InvalidInputError: An array has the wrong shape; the message names it.
        """
        linear = _numbers("q", q).reshape(-1)
        n = linear.size
        if n == 0:
            raise InvalidInputError("q", "is empty", q)
        for one, other, left, right in ((G, h, "G", "h"), (A, b, "A", "b")):
            if (one is None) != (other is None):
                missing, given = (left, right) if one is None else (right, left)
                raise InvalidInputError(missing, f"is missing though {given} is given")
        cost = _matrix("P", P, n)
        if cost.shape[0] != n:
            raise InvalidInputError("P", f"has shape {cost.shape}, not ({n}, {n})", P)
        inequalities, equalities = _matrix("G", G, n), _matrix("A", A, n)
        m, p = inequalities.shape[0], equalities.shape[0]
        self.sizes = (n, m, p)
        self.data = np.concatenate(
            [
                cost.ravel(),
                linear,
                inequalities.ravel(),
                _vector("h", h, m, 0.0),
                equalities.ravel(),
                _vector("b", b, p, 0.0),
                _vector("lb", lb, n, -np.inf),
                _vector("ub", ub, n, np.inf),
            ]
        )

    @classmethod
    def from_data(cls, data: Vector, sizes: tuple[int, int, int]) -> QP:
        """A program over an existing `data` array, which is neither copied nor checked."""
        qp = cls.__new__(cls)
        qp.data, qp.sizes = data, sizes
        return qp

    @property
    def P(self) -> Matrix:  # noqa: D102, N802 - described in the class, as are the next
        n, _, _ = self.sizes
        return self.data[: n * n].reshape(n, n)

    @property
    def q(self) -> Vector:  # noqa: D102
        n, _, _ = self.sizes
        return self.data[n * n : n * n + n]

    @property
    def G(self) -> Matrix:  # noqa: D102, N802
        n, m, _ = self.sizes
        start = n * n + n
        return self.data[start : start + m * n].reshape(m, n)

    @property
    def h(self) -> Vector:  # noqa: D102
        n, m, _ = self.sizes
        start = n * n + n + m * n
        return self.data[start : start + m]

    @property
    def A(self) -> Matrix:  # noqa: D102, N802
        n, m, p = self.sizes
        start = (n + m) * (n + 1)
        return self.data[start : start + p * n].reshape(p, n)

    @property
    def b(self) -> Vector:  # noqa: D102
        n, _, p = self.sizes
        stop = self.data.size - 2 * n
        return self.data[stop - p : stop]

    @property
    def lb(self) -> Vector:  # noqa: D102
        n, _, _ = self.sizes
        return self.data[-2 * n : -n]

    @property
    def ub(self) -> Vector:  # noqa: D102
        n, _, _ = self.sizes
        return self.data[-n:]

    @classmethod
    def from_qpsolvers(cls, problem: qpsolvers.Problem) -> QP:
        """Convert a qpsolvers problem, dense or sparse.

        Raises:
            InvalidInputError: An array has the wrong shape; the message names it.
        """
        return cls(*problem.unpack())

    def to_qpsolvers(self) -> qpsolvers.Problem:
        """The same problem for qpsolvers; parts without rows are left out, as it expects."""
        import qpsolvers  # with scipy.sparse, 0.2 s that not every run needs

        _, m, p = self.sizes
        lb, ub = self.lb, self.ub
        bounded = lb.max() > -np.inf or ub.min() < np.inf
        return qpsolvers.Problem(
            self.P,
            self.q,
            self.G if m else None,
            self.h if m else None,
            self.A if p else None,
            self.b if p else None,
            lb if bounded else None,
            ub if bounded else None,
        )

    def arrays(self) -> tuple[Matrix, Vector, Matrix, Vector, Matrix, Vector, Vector, Vector]:
        """``(P, q, G, h, A, b, lb, ub)``, the order that the compiled kernels take."""
        return self.P, self.q, self.G, self.h, self.A, self.b, self.lb, self.ub

    def bounds_as_inequalities(self) -> tuple[Matrix, Vector]:
        """The paper's Omega and chi: bounds written as inequality rows.

        Returns:
            ``([I; -I], [ub; -lb])`` of shapes (2n, n) and (2n,). The paper prints chi with
            ``lb``, which has the wrong sign (docs/errata.md).
        """
        eye = np.eye(self.q.size)
        return np.vstack([eye, -eye]), np.concatenate([self.ub, -self.lb])

    def residuals(
        self, x: Vector, y: Vector | None, z: Vector | None, z_box: Vector | None
    ) -> Residuals:
        """Qpsolvers' residuals of a primal-dual point, by its formulas and without its checks.

        Args:
            x: Primal point, (n,).
            y: Multipliers of the equalities, (p,).
            z: Multipliers of the inequalities, (m,).
            z_box: Multipliers of the bounds, (n,).
        """
        n, m, p = self.sizes
        point, at = np.zeros(2 * n + m + p), 0
        for part, size in ((x, n), (y, p), (z, m), (z_box, n)):
            if part is not None:
                point[at : at + size] = part
            at += size
        return Residuals(*point_residuals(self.data, n, m, p, point))

    def check_values(self) -> None:
        """Check what no convex solver could make sense of.

        Raises:
            InvalidInputError: A value is NaN, a coefficient is infinite, P is not symmetric or
                not positive semidefinite, or a lower bound exceeds its upper bound. The message
                names the argument.
        """
        for name in ("P", "q", "G", "A", "b"):
            if not np.isfinite(getattr(self, name)).all():
                raise InvalidInputError(name, "has a value that is not finite")
        for name, forbidden in (("h", -np.inf), ("lb", np.inf), ("ub", -np.inf)):
            value = getattr(self, name)
            if np.isnan(value).any() or (value == forbidden).any():
                raise InvalidInputError(name, f"has a value that is NaN or {forbidden}")
        crossed = np.flatnonzero(self.lb > self.ub)
        if crossed.size:
            i = int(crossed[0])
            raise InvalidInputError("lb", f"exceeds ub at {i}: {self.lb[i]:g} > {self.ub[i]:g}")
        scale = max(float(np.abs(self.P).max()), np.finfo(float).tiny)
        if np.abs(self.P - self.P.T).max() > 1e-10 * scale:
            raise InvalidInputError("P", "is not symmetric")
        smallest = float(np.linalg.eigvalsh(self.P)[0])
        if smallest < -1e-10 * scale:
            raise InvalidInputError(
                "P", f"is not positive semidefinite: eigenvalue {smallest:.3g}, problem not convex"
            )
