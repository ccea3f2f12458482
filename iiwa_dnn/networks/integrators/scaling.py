"""Equilibrated units of a program, and a steeper cost.

The variables and the rows of A and G get factors with which all rows of the KKT matrix have a size
near 1, and the cost gets one too. For the network that is another time constant for each entry of
its state; its equilibria are the same. The factors are powers of two, so that no number is rounded:
residuals are the same but for units.

An implicit step of length h [rho] leaves the fraction 1 / (1 + h c) of an error along which the
cost has the curvature c, so that a steeper cost converges sooner where it is nearly flat.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.certificates import certified, find_certificate
from iiwa_dnn.qp.dense import largest_entry
from iiwa_dnn.qp.layout import Matrix, Vector, qp_views
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import SLIGHT, cost_size
from iiwa_dnn.qp.solution import Status

LARGE = 1e3
"""Largest coefficient of a row or the cost above which a program is scaled first; the largest entry
of a cost in scaled units, at first."""
STRICTER = 1e-4
"""Tolerance in scaled units over that in the program's own, where the residuals grow."""
STEEP = 1e5
"""Largest entry of a cost that was made steep."""
ROUNDS = 10
"""Rounds of balancing; each takes the square root of what is left."""


@compiled
def is_ordinary(data: Vector, n: int, m: int, p: int) -> bool:
    """Check that the cost and each row of `QP.data` has a largest entry from `SLIGHT` to `LARGE`.

    A cost of zeros is ordinary, and so is a row of zeros that holds. P is symmetric to the bit.
    """
    qp = qp_views(data, n, m, p)
    for j in range(p):
        if not _is_ordinary_size(largest_entry(qp.A[j]), qp.b[j] == 0.0):
            return False
    for j in range(m):
        if not _is_ordinary_size(largest_entry(qp.G[j]), qp.h[j] >= 0.0):
            return False
    for i in range(n):
        for k in range(i):
            if qp.P[i, k] != qp.P[k, i]:
                return False
    return _is_ordinary_size(cost_size(qp), True)


@compiled
def _is_ordinary_size(largest: float, holds: bool) -> bool:
    """Check the largest entry of a row or the cost, which `holds` where that is zero."""
    return SLIGHT <= largest <= LARGE or (largest == 0.0 and holds)


class Scaling(NamedTuple):
    """A program in other units.

    Attributes:
        qp: The program in these units.
        of_state: Units of the entries of a state, ``[x | y | z | u | l]`` (3 n + m + p,); those of
            a point come first.
        of_tolerance: Tolerance in these units, relative to that of the program as it was given.
    """

    qp: QP
    of_state: Vector
    of_tolerance: float

    @property
    def of_point(self) -> Vector:
        """Units of the entries of a point ``[x | y | z | z_box]``, (2 n + m + p,)."""
        n, m, p = self.qp.sizes
        return self.of_state[: 2 * n + m + p]

    def find_certificate(self, given: QP, point: Vector) -> tuple[Status, Vector | None]:
        """Look for a certificate of the program as it was given, and its point."""
        status, certificate = find_certificate(self.qp, point / self.of_point)
        if certificate is not None:
            x, multipliers = np.split(self.of_point, [given.q.size])
            certificate = certificate * (x if certificate.size == x.size else multipliers)
            status = certified(given, certificate)
        return status, certificate


@np.errstate(over="ignore", invalid="ignore", divide="ignore")
def balanced(qp: QP, largest: float) -> Scaling:
    """Scale a program so that the rows of its KKT matrix have a size near 1.

    The largest entry of the cost is given. A large one converges sooner where the cost is nearly
    flat, a small one where active rows are nearly dependent.
    """
    n, m, p = qp.sizes
    rows = np.vstack([qp.A, qp.G])
    limits = np.concatenate([qp.b, qp.h])
    cost = cost_size(qp.views) or 1.0
    matrix = np.block([[qp.P / cost, rows.T], [rows, np.zeros((m + p, m + p))]])
    of_x, of_rows = np.split(factors(matrix), [n])
    # A row of zeros gets a limit near 1: if it cannot hold, its multiplier is seen to grow.
    of_rows = np.where(rows.any(axis=1) | ~np.isfinite(limits), of_rows, _power(1.0 / limits))
    size = np.abs(np.vstack([qp.P * np.outer(of_x, of_x), qp.q * of_x])).max()
    of_cost = _power(size / largest)
    of_A, of_G = np.split(of_rows, [p])
    scaled = QP(
        qp.P * np.outer(of_x, of_x) / of_cost,
        qp.q * of_x / of_cost,
        qp.G * np.outer(of_G, of_x),
        qp.h * of_G,
        qp.A * np.outer(of_A, of_x),
        qp.b * of_A,
        qp.lb / of_x,
        qp.ub / of_x,
    )
    of_box = of_cost / of_x
    of_state = np.concatenate([of_x, of_cost * of_rows, of_box, of_box])
    return Scaling(scaled, of_state, STRICTER * min(1.0, 1.0 / of_cost))


def steep(qp: QP) -> Scaling:
    """Scale the cost of a program so that its largest entry is near `STEEP`."""
    n, m, p = qp.sizes
    scaled = QP.from_data(qp.data.copy(), qp.sizes)
    cost = scaled.data[: n * n + n]
    of_cost = 2.0 ** round(math.log2(np.abs(cost).max(initial=1e-300) / STEEP))
    cost /= of_cost
    of_state = np.ones(3 * n + m + p)
    of_state[n:] = of_cost
    return Scaling(scaled, of_state, 1.0 / of_cost)


def _power(size: Any) -> Any:
    """Return the nearest power of two of a number or of each entry, 1 of a zero."""
    return np.exp2(np.round(np.log2(np.where(size == 0.0, 1.0, np.abs(size)))))


def factors(matrix: Matrix) -> Vector:
    """Return factors of rows and columns of a symmetric matrix that bring each to a size near 1.

    They are powers of two.

    Source: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
    Rutherford Appleton Laboratory, RAL-TR-2001-034.
    """
    units = np.ones(len(matrix))
    for _ in range(ROUNDS):
        sizes = units * np.abs(matrix * units).max(axis=1)
        units /= np.sqrt(np.where(sizes > 0.0, sizes, 1.0))
    return np.asarray(_power(units))
