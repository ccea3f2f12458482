"""The numbers of a program in one flat array, and helpers for compiled code on such arrays.

Compiled code takes a quadratic program as `QP.data` with its sizes n, m, p, and reads it in place:

    P[i, k]  data[i n + k]          G[j, i]  data[at_G + j n + i]     lb[i]  data[at_lb + i]
    q[i]     data[at_q + i]         A[j, i]  data[at_A + j n + i]     ub[i]  data[at_lb + n + i]
    h[j]     data[at_G + m n + j]   b[j]     data[at_lb - p + j]

Its loops are plain on purpose: for seven joints a BLAS call costs more than its work.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
IntVector = NDArray[np.int64]
IntMatrix = NDArray[np.int64]
Sizes = tuple[int, int, int]
Triple = tuple[float, float, float]


def check_size(argument: str, array: Vector, size: int) -> Vector:
    """Return a flat array of this size; refuse any other, since compiled code trusts it."""
    if array.size != size or array.ndim != 1:
        raise InvalidInputError(argument, f"has shape {array.shape}, not ({size},)", array)
    return array


@compiled
def data_size(n: int, m: int, p: int) -> int:
    """Count the numbers of a program, `QP.data`."""
    return (n + m + p) * (n + 1) + 2 * n


@compiled
def offsets(n: int, m: int, p: int) -> tuple[int, int, int, int]:
    """Compute ``(at_q, at_G, at_A, at_lb)``, the beginnings of the parts of `QP.data`."""
    at_q = n * n
    at_G = at_q + n
    at_A = at_G + m * n + m
    return at_q, at_G, at_A, at_A + p * n + p


class QPViews(NamedTuple):
    """The eight parts of a program of n variables, m inequality and p equality rows, as views.

    Attributes:
        P: Cost matrix, (n, n).
        q: Cost vector, (n,).
        G: Inequality rows, (m, n).
        h: Inequality right-hand side, (m,).
        A: Equality rows, (p, n).
        b: Equality right-hand side, (p,).
        lb: Lower bounds, (n,).
        ub: Upper bounds, (n,).
    """

    P: Matrix
    q: Vector
    G: Matrix
    h: Vector
    A: Matrix
    b: Vector
    lb: Vector
    ub: Vector


@compiled
def qp_views(data: Vector, n: int, m: int, p: int) -> QPViews:
    """Make the views of a program's flat array, `QP.data` (size,), which has to outlive them."""
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_h = at_G + m * n
    at_b = at_A + p * n
    at_ub = at_lb + n
    return QPViews(
        data[:at_q].reshape(n, n),
        data[at_q:at_G],
        data[at_G:at_h].reshape(m, n),
        data[at_h:at_A],
        data[at_A:at_b].reshape(p, n),
        data[at_b:at_lb],
        data[at_lb:at_ub],
        data[at_ub : at_ub + n],
    )


@compiled
def copied(out: Vector, values: Vector) -> None:
    """Write values (k,) into the first k of `out`."""
    for k in range(values.size):
        out[k] = values[k]


@compiled
def larger(largest: float, value: float) -> float:
    """Return the larger of two numbers; unlike with max(), a NaN once seen stays."""
    return value if value > largest or value != value else largest
