"""The numbers of a program in one flat array, and helpers for compiled code on such arrays.

Compiled code takes a quadratic program as `QP.data` with its sizes n, m, p, and reads it in place:

    P[i, k]  data[i n + k]          G[j, i]  data[at_G + j n + i]     lb[i]  data[at_lb + i]
    q[i]     data[at_q + i]         A[j, i]  data[at_A + j n + i]     ub[i]  data[at_lb + n + i]
    h[j]     data[at_G + m n + j]   b[j]     data[at_lb - p + j]

Its loops are plain on purpose: for seven joints a BLAS call costs more than its work, and so does a
view of an array, since numba counts its references.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np
from numba import njit, types
from numpy.typing import NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.compiling import MATRIX, VECTOR, borrowed

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Sizes = tuple[int, int, int]
Triple = tuple[float, float, float]
Function = TypeVar("Function", bound=Callable[..., Any])

# numba makes a float of a signed and an unsigned integer: the constant has to be unsigned too.
ONE = np.uint64(1)

_OPTIONS: dict[str, Any] = {
    "cache": True,
    "error_model": "numpy",
    "fastmath": {"contract"},
    "no_cfunc_wrapper": True,
}


def compiled(function: Function) -> Function:
    """Compile a function with numba at its first call, and keep the code on disk."""
    return cast(Function, njit(**_OPTIONS)(function))


def inlined(function: Function) -> Function:
    """Compile a function as `compiled`, into each one that calls it.

    For functions that make views, and those that a step calls most often: a program's views are
    some sixty numbers, which take as long to hand on as a few rows. Callers compile longer.
    """
    return cast(Function, njit(**_OPTIONS, forceinline=True)(function))


def released(function: Function) -> Function:
    """Compile a function as `compiled`; Python's other threads go on while it is called."""
    return cast(Function, njit(**_OPTIONS, nogil=True)(function))


def check_size(argument: str, array: Vector, size: int) -> None:
    """Raise InvalidInputError unless an array is flat and of this size: compiled code trusts it."""
    if array.size != size or array.ndim != 1:
        raise InvalidInputError(argument, f"has shape {array.shape}, not ({size},)", array)


@compiled
def offsets(n: int, m: int, p: int) -> tuple[int, int, int, int]:
    """Compute ``(at_q, at_G, at_A, at_lb)``, the beginnings of the parts of `QP.data`."""
    at_q = n * n
    at_G = at_q + n
    at_A = at_G + m * n + m
    return at_q, at_G, at_A, at_A + p * n + p


@lru_cache
def field_shapes(sizes: Sizes) -> list[tuple[int, ...]]:
    """Return the shape of each of the eight fields of a program, in their order."""
    n, m, p = sizes
    return [(n, n), (n,), (m, n), (m,), (p, n), (p,), (n,), (n,)]


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


QP_VIEWS = types.BaseTuple.from_types(
    (MATRIX, VECTOR, MATRIX, VECTOR, MATRIX, VECTOR, VECTOR, VECTOR), QPViews
)
"""numba's type of `QPViews`, for a `Signature`."""


@inlined
def qp_views(data: Vector, n: int, m: int, p: int) -> QPViews:
    """Make the views of a program's flat array, `QP.data` (size,), which has to outlive them."""
    data = borrowed(data)
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_h = at_G + m * n
    at_b = at_A + p * n
    return QPViews(
        data[:at_q].reshape(n, n),
        data[at_q:at_G],
        data[at_G:at_h].reshape(m, n),
        data[at_h:at_A],
        data[at_A:at_b].reshape(p, n),
        data[at_b:at_lb],
        data[at_lb : at_lb + n],
        data[at_lb + n : at_lb + 2 * n],
    )


@inlined
def borrowed_views(qp: QPViews) -> QPViews:
    """Return the views of a program without counting who uses them."""
    return QPViews(
        borrowed(qp.P),
        borrowed(qp.q),
        borrowed(qp.G),
        borrowed(qp.h),
        borrowed(qp.A),
        borrowed(qp.b),
        borrowed(qp.lb),
        borrowed(qp.ub),
    )


@compiled
def larger(largest: float, value: float) -> float:
    """Return the larger of two numbers; unlike with max(), a NaN once seen stays."""
    return value if value > largest or value != value else largest
