"""Where the numbers of a program lie, and a maximum that keeps a NaN."""

from __future__ import annotations

import numpy as np
from numba import njit

# numba makes a float of a signed and an unsigned integer: the constant has to be unsigned too.
ONE = np.uint64(1)


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def offsets(n, m, p):
    """``(at_q, at_G, at_A, at_lb)``: where the parts of `QP.data` begin."""
    at_q = n * n
    at_G = at_q + n
    at_A = at_G + m * n + m
    return at_q, at_G, at_A, at_A + p * n + p


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def larger(largest, value):
    """The larger of two; unlike with max(), a NaN once seen stays."""
    return value if value > largest or value != value else largest
