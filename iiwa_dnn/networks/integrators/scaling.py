"""Equilibrated units of a program, and a steeper cost.

The variables and the rows of A and G get factors with which all rows of the KKT matrix have a size
near 1, and the cost gets one too. For the network that is another time constant for each entry of
its state; its equilibria are the same. The factors are powers of two, so that no number is rounded:
residuals are the same but for units.

An implicit step of length h [rho] leaves the fraction 1 / (1 + h c) of an error along which the
cost has the curvature c, so that a steeper cost converges sooner where it is nearly flat.
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.certificates import certified, find_certificate
from iiwa_dnn.qp.dense import largest_entry
from iiwa_dnn.qp.layout import Matrix, Vector, qp_views
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import SLIGHT, cost_size
from iiwa_dnn.qp.solution import Status

LARGE = 1e3
"""Largest coefficient of a row above which a program is scaled first, curvature above which steps
are longer, and largest entry of a cost in scaled units, at first."""
STRICTER = 1e-4
"""Tolerance in scaled units over that in the program's own, where the residuals grow."""
SQRT2 = math.sqrt(2.0)
STEEP = 1e5
"""Largest entry of a cost that was made steep."""
ROUNDS = 10
"""Rounds of balancing; each takes the square root of what is left."""


@compiled
def is_ordinary(data: Vector, n: int, m: int, p: int) -> bool:
    """Check that each row of `QP.data` has a largest entry from `SLIGHT` to `LARGE`.

    A row of zeros that holds is ordinary too. The cost has a largest entry from `SLIGHT` on, or
    none but zeros; P is symmetric to the bit.
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
    cost = cost_size(qp)
    return cost >= SLIGHT or cost == 0.0


@compiled
def _is_ordinary_size(largest: float, holds: bool) -> bool:
    """Check the largest entry of a row, which `holds` where that is zero."""
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
        """Search for a certificate in scaled units, and judge it on the program as it was given.

        `point` is that of the given program, (2 n + m + p,).
        """
        status, certificate = find_certificate(self.qp, point / self.of_point)
        if certificate is not None:
            x, multipliers = np.split(self.of_point, [given.q.size])
            certificate = certificate * (x if certificate.size == x.size else multipliers)
            status = certified(given, certificate)
        return status, certificate


def scaled(qp: QP, largest: float, rounds: int = ROUNDS) -> Scaling:
    """Scale a program so that the rows of its KKT matrix have largest entries near 1.

    Args:
        qp: The program.
        largest: Largest entry of the scaled cost, to the nearest power of two. A large one
            converges sooner where the cost is nearly flat, a small one where active rows are nearly
            dependent.
        rounds: Rounds of balancing; 0 scales the cost alone.
    """
    n, m, p = qp.sizes
    views = qp.views
    kkt = np.zeros((n + p + m, n + p + m))
    kkt[:n, :n] = views.P / (cost_size(views) or 1.0)
    kkt[n : n + p, :n] = views.A
    kkt[n + p :, :n] = views.G
    units = np.ones(n + p + m)
    balance(kkt, np.concatenate([np.zeros(n), views.b, views.h]), rounds, units)
    of_x = units[:n]
    of_A = units[n : n + p]
    of_G = units[n + p :]
    bounds = 1.0 / of_x
    factors = (np.outer(of_x, of_x), of_x, np.outer(of_G, of_x), of_G, np.outer(of_A, of_x), of_A)
    data = qp.data * np.concatenate([*factors, bounds, bounds], axis=None)
    cost = data[: n * n + n]
    of_cost = power_of_two(largest_entry(cost) / largest)
    cost /= of_cost
    of_state = np.concatenate([of_x, of_cost * units[n:], of_cost * bounds, of_cost * bounds])
    of_tolerance = STRICTER * min(1.0, 1.0 / of_cost) if rounds else 1.0 / of_cost
    return Scaling(QP.from_data(data, qp.sizes), of_state, of_tolerance)


@compiled
def balance(kkt: Matrix, limits: Vector, rounds: int, units: Vector) -> None:
    """Balance a symmetric matrix: rows and columns in the units found have entries of at most 1.

    A row of zeros gets the unit with which its limit is 1: if it cannot hold, its multiplier is
    seen to grow. Units are rounded to powers of two.

    Args:
        kkt: The matrix, whose lower half is read, (k, k).
        limits: Limits of the rows, (k,).
        rounds: Rounds, each of which takes the square root of what is left.
        units: Units, (k,), ones at first, overwritten.

    Source: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
    Rutherford Appleton Laboratory, RAL-TR-2001-034.
    """
    sizes = np.empty(units.size)
    for _ in range(rounds):
        sizes[:] = 0.0
        for i in range(units.size):
            for k in range(i + 1):
                if kkt[i, k] != 0.0:
                    sizes[i] = max(sizes[i], abs(kkt[i, k]) * units[k])
                    sizes[k] = max(sizes[k], abs(kkt[i, k]) * units[i])
        for i in range(units.size):
            size = units[i] * sizes[i]
            limit = abs(limits[i])
            if size > 0.0:
                units[i] /= np.sqrt(size)
            elif limit > 0.0 and limit < np.inf:
                units[i] = 1.0 / limit
    for i in range(units.size):
        units[i] = power_of_two(units[i])


@compiled
def power_of_two(size: float) -> float:
    """Return the power of two nearest to a size in the logarithm; 1 if it is 0."""
    power = 1.0
    while power * SQRT2 < size:
        power *= 2.0
    while size > 0.0 and power > size * SQRT2:
        power *= 0.5
    return power
