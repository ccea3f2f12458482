"""Compiled linear algebra on dense matrices of up to some hundred rows.

A matrix is one flat array, row by row. For seven variables the plain loops of `cholesky_factor` are
quickest. From about twenty on it pays to let the compiler use vector instructions, which it does
where it can see that no index is negative: hence the unsigned ones in the others, which use the
upper half of a symmetric matrix.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.qp.layout import ONE, Vector, compiled, larger

Index = int | np.uint64
FOUR = np.uint64(4)


@compiled
def cholesky_factor(K: Vector, n: int) -> bool:
    """Overwrite K's lower half (row stride n) by its Cholesky factor, with inverted diagonal.

    Returns:
        False if K is not positive definite to working precision; its content is then meaningless.
    """
    for i in range(n):
        for j in range(i):
            value = K[i * n + j]
            for k in range(j):
                value -= K[i * n + k] * K[j * n + k]
            K[i * n + j] = value * K[j * n + j]
        value = K[i * n + i]
        for k in range(i):
            value -= K[i * n + k] * K[i * n + k]
        if not value > 0.0:
            return False
        K[i * n + i] = 1.0 / np.sqrt(value)  # the inverse: a division costs many products
    return True


@compiled
def factor_solve(K: Vector, n: int, rhs: Vector, out: Vector) -> None:
    """Solve with the factor of `cholesky_factor` in K (n n,), for the first n entries of `out`."""
    for i in range(n):
        value = rhs[i]
        for k in range(i):
            value -= K[i * n + k] * out[k]
        out[i] = value * K[i * n + i]
    for i in range(n - 1, -1, -1):
        value = out[i]
        for k in range(i + 1, n):
            value -= K[k * n + i] * out[k]
        out[i] = value * K[i * n + i]


# reassoc: a sum may be taken in several lanes. It has no say in comparisons, so a NaN stays a NaN.
@njit(cache=True, error_model="numpy", fastmath={"contract", "reassoc"})
def dot(a: Vector, at_a: Index, b: Vector, at_b: Index, n: Index) -> float:
    """Sum a[at_a + i] b[at_b + i] over i < n, the arrays being of any size."""
    start, other = np.uint64(at_a), np.uint64(at_b)
    value = 0.0
    for i in range(np.uint64(n)):
        value += a[start + i] * b[other + i]
    return value


@compiled
def add_scaled(out: Vector, at_out: int, factor: float, a: Vector, at_a: int, n: int) -> None:
    """Add factor a[at_a + i] to out[at_out + i] for i < n, the arrays being of any size."""
    start, other = np.uint64(at_out), np.uint64(at_a)
    for i in range(np.uint64(n)):
        out[start + i] += factor * a[other + i]


@compiled
def add_outer(out: Vector, factor: float, a: Vector, at_a: int, n: int) -> None:
    """Add factor v v^T to the upper half of `out` (n n,), v being a[at_a : at_a + n]."""
    size, start = np.uint64(n), np.uint64(at_a)
    for i in range(size):
        scaled = factor * a[start + i]
        row = i * size
        for k in range(i, size):
            out[row + k] += scaled * a[start + k]


@compiled
def add_multiple(out: Vector, a: Vector, factor: float, b: Vector, n: int) -> None:
    """Write the upper half of a + factor b into that of `out`, all (n n,)."""
    size = np.uint64(n)
    for i in range(size):
        row = i * size
        for k in range(i, size):
            out[row + k] = a[row + k] + factor * b[row + k]


@compiled
def solve_upper(K: Vector, n: int, rhs: Vector, out: Vector) -> bool:
    """Solve K out = rhs (n,); K's upper half is overwritten by its Cholesky factor.

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


@compiled
def extreme_eigenvalues(K: Vector, n: int) -> tuple[float, float]:
    """Smallest and largest eigenvalue of the symmetric K (n n), which is overwritten.

    Cyclic Jacobi rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", section 8.5): a
    call of LAPACK costs more than all of them for seven joints.
    """
    for _ in range(50):
        off, size = 0.0, 0.0
        for i in range(n):
            size += K[i * n + i] * K[i * n + i]
            for k in range(i):
                off += K[i * n + k] * K[i * n + k]
        # Second order: an off-diagonal of eps moves an eigenvalue by eps^2 over their distance.
        if not off > 1e-26 * (size + off):
            break
        for i in range(1, n):
            for k in range(i):
                below = K[i * n + k]
                if below == 0.0:
                    continue
                theta = 0.5 * (K[i * n + i] - K[k * n + k]) / below
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
                if theta < 0.0:
                    t = -t
                c = 1.0 / np.sqrt(t * t + 1.0)
                s = t * c
                K[i * n + i] += t * below
                K[k * n + k] -= t * below
                K[i * n + k] = K[k * n + i] = 0.0
                for j in range(n):
                    if j != i and j != k:
                        one, other = K[k * n + j], K[i * n + j]
                        K[k * n + j] = K[j * n + k] = c * one - s * other
                        K[i * n + j] = K[j * n + i] = s * one + c * other
    smallest, largest = K[0], K[0]
    for i in range(1, n):
        smallest, largest = min(smallest, K[i * n + i]), larger(largest, K[i * n + i])
    return smallest, largest
