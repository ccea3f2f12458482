"""Compiled dense linear algebra for programs that are larger than a robot's.

For seven variables the plain loops of the other modules are quickest. From about twenty on it pays
to let the compiler use vector instructions, which it does where it can see that no index is
negative: hence the unsigned ones. A matrix is one flat array, row by row, of which the upper half
is used.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.kernels.layout import ONE

FOUR = np.uint64(4)


# reassoc: a sum may be taken in several lanes. It has no say in comparisons, so a NaN stays a NaN.
@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def dot(a, at_a, b, at_b, n):
    """The sum of a[at_a + i] b[at_b + i] over i < n."""
    start, other = np.uint64(at_a), np.uint64(at_b)
    value = 0.0
    for i in range(np.uint64(n)):
        value += a[start + i] * b[other + i]
    return value


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def add_scaled(out, at_out, factor, a, at_a, n):
    """Add factor a[at_a + i] to out[at_out + i] for i < n."""
    start, other = np.uint64(at_out), np.uint64(at_a)
    for i in range(np.uint64(n)):
        out[start + i] += factor * a[other + i]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def add_outer(out, factor, a, at_a, n):
    """Add factor v v^T to the upper half of `out`, v being a[at_a : at_a + n]."""
    size, start = np.uint64(n), np.uint64(at_a)
    for i in range(size):
        scaled = factor * a[start + i]
        row = i * size
        for k in range(i, size):
            out[row + k] += scaled * a[start + k]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def add_multiple(out, a, factor, b, n):
    """Write the upper half of a + factor b into that of `out`."""
    size = np.uint64(n)
    for i in range(size):
        row = i * size
        for k in range(i, size):
            out[row + k] = a[row + k] + factor * b[row + k]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def solve_upper(K, n, rhs, out):
    """Solve K out = rhs; K's upper half is overwritten by its Cholesky factor.

    Four pivots at a time, so that each pass over the rest of the matrix does the work of four.

    Returns:
        False if K is not positive definite to working precision; `out` is then meaningless.
    """
    size = np.uint64(n)
    for block in range((size + FOUR - ONE) // FOUR):
        first = block * FOUR
        last = first + FOUR
        full = last <= size
        if not full:
            last = size
        for i in range(first, last):
            row = i * size
            pivot = K[row + i]
            if not pivot > 0.0:
                return False
            inverse = 1.0 / np.sqrt(pivot)
            K[row + i] = inverse  # the inverse: a division costs many products
            for k in range(i + ONE, size):
                K[row + k] *= inverse
            for j in range(i + ONE, last):
                factor = K[row + j]
                other = j * size
                for k in range(j, size):
                    K[other + k] -= factor * K[row + k]
        if full:
            row1 = first * size
            row2, row3, row4 = row1 + size, row1 + size + size, row1 + size + size + size
            for i in range(last, size):
                f1, f2, f3, f4 = K[row1 + i], K[row2 + i], K[row3 + i], K[row4 + i]
                row = i * size
                for k in range(i, size):
                    K[row + k] -= (
                        f1 * K[row1 + k] + f2 * K[row2 + k] + f3 * K[row3 + k] + f4 * K[row4 + k]
                    )
    for i in range(size):
        out[i] = rhs[i]
    for i in range(size):
        row = i * size
        value = out[i] * K[row + i]
        out[i] = value
        for k in range(i + ONE, size):
            out[k] -= value * K[row + k]
    for back in range(size):
        at = size - ONE - back
        row = at * size
        out[at] = (out[at] - dot(K, row + at + ONE, out, at + ONE, back)) * K[row + at]
    return True
