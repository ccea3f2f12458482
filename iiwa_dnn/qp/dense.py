"""Compiled linear algebra on small dense matrices.

A matrix is one flat array, row by row; of a symmetric one the lower half is read and written.
Indices are unsigned because numba compares signed ones with zero, which keeps the compiler from
using vector instructions.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.qp.layout import ONE, Vector, compiled, larger

ROUNDING = 1e-5
"""Asymmetry and negative eigenvalues of P that pass as rounding, relative to its largest entry: a
matrix that was computed in single precision has them. The answer is a KKT point of P as given."""

TWO, THREE, FOUR = np.uint64(2), np.uint64(3), np.uint64(4)

# reassoc lets a sum run in several lanes. Comparisons are left alone, so a NaN stays a NaN.
SUMS = {"contract", "reassoc"}


@njit(cache=True, error_model="numpy", fastmath=SUMS)
def dot(a: Vector, at_a: int, b: Vector, n: int) -> float:
    """Sum a[at_a + i] b[i] over i < n, the arrays being of any size."""
    start = np.uint64(at_a)
    value = 0.0
    for i in range(np.uint64(n)):
        value += a[start + i] * b[i]
    return value


@compiled
def add_scaled(out: Vector, factor: float, a: Vector, at_a: int, n: int) -> None:
    """Add factor a[at_a + i] to out[i] for i < n, the arrays being of any size."""
    start = np.uint64(at_a)
    for i in range(np.uint64(n)):
        out[i] += factor * a[start + i]


@njit(cache=True, error_model="numpy", fastmath=SUMS)
def rows_dot(data: Vector, at: int, rows: int, n: int, x: Vector, out: Vector, at_out: int) -> None:
    """Write the products of so many rows (n,) of `data` from `at` on with x[:n] into `out`."""
    size, a, j = np.uint64(n), np.uint64(at), np.uint64(at_out)
    end = j + np.uint64(rows)
    while j + THREE < end:  # four rows at once: fewer loads for each product
        b, c, d = a + size, a + TWO * size, a + THREE * size
        first, second, third, fourth = 0.0, 0.0, 0.0, 0.0
        for k in range(size):
            factor = x[k]
            first += data[a + k] * factor
            second += data[b + k] * factor
            third += data[c + k] * factor
            fourth += data[d + k] * factor
        out[j], out[j + ONE], out[j + TWO], out[j + THREE] = first, second, third, fourth
        a, j = d + size, j + FOUR
    while j < end:
        first = 0.0
        for k in range(size):
            first += data[a + k] * x[k]
        out[j] = first
        a, j = a + size, j + ONE


@compiled
def add_outer(out: Vector, factor: float, a: Vector, at_a: int, n: int) -> None:
    """Add factor v v^T to the lower half of `out` (n n,), v being a[at_a : at_a + n]."""
    size, start = np.uint64(n), np.uint64(at_a)
    for i in range(size):
        scaled = factor * a[start + i]
        row = i * size
        for k in range(i + ONE):
            out[row + k] += scaled * a[start + k]


@njit(cache=True, error_model="numpy", fastmath=SUMS)
def cholesky_factor(K: Vector, n: int) -> bool:
    """Overwrite the lower half of K (n n,) by its Cholesky factor, with inverted diagonal.

    Returns:
        False if K is not positive definite to working precision; its content is then meaningless.
    """
    size = np.uint64(n)
    for j in range(size):
        row = j * size
        value = 0.0
        for k in range(j):
            value += K[row + k] * K[row + k]
        pivot = K[row + j] - value
        if not pivot > 0.0:
            return False
        inverse = 1.0 / np.sqrt(pivot)  # a division costs many products
        K[row + j] = inverse
        at = row + size
        while at + THREE * size < size * size:  # four rows at once: fewer loads for each product
            b, c, d = at + size, at + TWO * size, at + THREE * size
            value, second, third, fourth = 0.0, 0.0, 0.0, 0.0
            for k in range(j):
                factor = K[row + k]
                value += K[at + k] * factor
                second += K[b + k] * factor
                third += K[c + k] * factor
                fourth += K[d + k] * factor
            K[at + j] = (K[at + j] - value) * inverse
            K[b + j] = (K[b + j] - second) * inverse
            K[c + j] = (K[c + j] - third) * inverse
            K[d + j] = (K[d + j] - fourth) * inverse
            at = d + size
        while at < size * size:
            value = 0.0
            for k in range(j):
                value += K[at + k] * K[row + k]
            K[at + j] = (K[at + j] - value) * inverse
            at += size
    return True


@njit(cache=True, error_model="numpy", fastmath=SUMS)
def factor_solve(K: Vector, n: int, rhs: Vector, out: Vector) -> None:
    """Solve with the factor that `cholesky_factor` left in K (n n,), into the first n of `out`."""
    size = np.uint64(n)
    for i in range(size):
        row = i * size
        value = 0.0
        for k in range(i):
            value += K[row + k] * out[k]
        out[i] = (rhs[i] - value) * K[row + i]
    for back in range(size):
        at = size - ONE - back
        row = at * size
        value = out[at] * K[row + at]
        out[at] = value
        for k in range(at):
            out[k] -= value * K[row + k]


@compiled
def extreme_eigenvalues(K: Vector, n: int) -> tuple[float, float]:
    """Compute the smallest and the largest eigenvalue of K (n n,), which is overwritten.

    Cyclic Jacobi rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", section 8.5) on
    both halves of K: for seven joints one call of LAPACK costs more than all of them.
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


@compiled
def is_convex(data: Vector, n: int, K: Vector) -> bool:
    """Tell whether P is symmetric and positive semidefinite to `ROUNDING` of its scale.

    Args:
        data: Numbers that begin with P, of size n n or more.
        n: Number of variables.
        K: Scratch, (n n,).
    """
    size, scale, asymmetry = np.uint64(n), 0.0, 0.0
    for i in range(size):  # of a matrix that is positive semidefinite, the largest are here
        scale = larger(scale, data[i * size + i])
    for i in range(size):
        row = i * size
        for k in range(i):
            asymmetry = larger(asymmetry, abs(data[row + k] - data[k * size + i]))
            K[row + k] = data[row + k]
        K[row + i] = data[row + i] + ROUNDING * scale
    if scale == 0.0:  # no cost matrix at all, or none that is semidefinite
        for k in range(size * size):
            asymmetry = larger(asymmetry, abs(data[k]))
        return asymmetry == 0.0
    return asymmetry <= ROUNDING * scale and cholesky_factor(K, n)


@njit(cache=True, error_model="numpy", fastmath=SUMS)
def all_finite(data: Vector, start: int, end: int) -> bool:
    """Tell whether data[start:end] of (k,) is finite: NaN and infinity times zero are NaN."""
    total = 0.0
    for k in range(np.uint64(start), np.uint64(end)):
        total += data[k] * 0.0
    return total == 0.0
