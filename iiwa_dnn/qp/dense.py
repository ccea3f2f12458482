"""Compiled linear algebra on small dense matrices.

Of a symmetric matrix the lower half is read and written.
"""

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.layout import Matrix, Vector, larger

ROUNDING = 1e-5
"""Asymmetry and negative eigenvalues of P that pass as rounding, relative to its largest entry: a
matrix that was computed in single precision has them. The answer is a KKT point of P as it is."""


@compiled
def dot(a: Vector, at_a: int, b: Vector, n: int) -> float:
    """Sum a[at_a + i] b[i] over i < n, the arrays being of any size."""
    start = at_a
    value = 0.0
    for i in range(n):
        value += a[start + i] * b[i]
    return value


@compiled
def row_dot(rows: Matrix, j: int, x: Vector) -> float:
    """Compute the product of row j of a matrix (k, n) and the first n entries of x."""
    row = j
    value = 0.0
    for k in range(rows.shape[1]):
        value += rows[row, k] * x[k]
    return value


@compiled
def add_row(out: Vector, factor: float, rows: Matrix, j: int) -> None:
    """Add a multiple of row j of a matrix (k, n) to the first n entries of `out`."""
    row = j
    for k in range(rows.shape[1]):
        out[k] += factor * rows[row, k]


@compiled
def rows_dot(rows: Matrix, x: Vector, out: Vector, start: int) -> None:
    """Write the product of a matrix (k, n) and the first n entries of x into `out` from `start`."""
    first = start
    for j in range(rows.shape[0]):
        value = 0.0
        for k in range(rows.shape[1]):
            value += rows[j, k] * x[k]
        out[first + j] = value


@compiled
def add_outer(out: Matrix, factor: float, rows: Matrix, j: int) -> None:
    """Add factor v v^T to the lower half of `out` (n, n), v being row j of a matrix (k, n)."""
    row = j
    for i in range(rows.shape[1]):
        scaled = factor * rows[row, i]
        for k in range(i + 1):
            out[i, k] += scaled * rows[row, k]


@compiled
def cholesky_factor(K: Matrix) -> bool:
    """Overwrite the lower half of K (n, n) by its Cholesky factor, with inverted diagonal.

    Returns:
        False if K is not positive definite to working precision; its content is then meaningless.
    """
    size = K.shape[0]
    for j in range(size):
        value = 0.0
        for k in range(j):
            value += K[j, k] * K[j, k]
        pivot = K[j, j] - value
        if not pivot > 0.0:
            return False
        inverse = 1.0 / np.sqrt(pivot)  # a division costs many products
        K[j, j] = inverse
        i = j + 1
        while i + 3 < size:  # four rows at once: fewer loads for each product
            value = 0.0
            second = 0.0
            third = 0.0
            fourth = 0.0
            for k in range(j):
                factor = K[j, k]
                value += K[i, k] * factor
                second += K[i + 1, k] * factor
                third += K[i + 2, k] * factor
                fourth += K[i + 3, k] * factor
            K[i, j] = (K[i, j] - value) * inverse
            K[i + 1, j] = (K[i + 1, j] - second) * inverse
            K[i + 2, j] = (K[i + 2, j] - third) * inverse
            K[i + 3, j] = (K[i + 3, j] - fourth) * inverse
            i += 4
        while i < size:
            value = 0.0
            for k in range(j):
                value += K[i, k] * K[j, k]
            K[i, j] = (K[i, j] - value) * inverse
            i += 1
    return True


@compiled
def factor_solve(K: Matrix, rhs: Vector, out: Vector) -> None:
    """Solve with the factor that `cholesky_factor` left in K (n, n), into the first n of `out`."""
    size = K.shape[0]
    for i in range(size):
        value = 0.0
        for k in range(i):
            value += K[i, k] * out[k]
        out[i] = (rhs[i] - value) * K[i, i]
    for back in range(size):
        row = size - 1 - back
        value = out[row] * K[row, row]
        out[row] = value
        for k in range(row):
            out[k] -= value * K[row, k]


@compiled
def extreme_eigenvalues(K: Matrix) -> tuple[float, float]:
    """Compute the smallest and the largest eigenvalue of K (n, n), which is overwritten.

    Cyclic Jacobi rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", section 8.5) on
    both halves of K: for seven joints one call of LAPACK costs more than all of them.
    """
    n = K.shape[0]
    for _ in range(50):
        off = 0.0
        size = 0.0
        for i in range(n):
            size += K[i, i] * K[i, i]
            for k in range(i):
                off += K[i, k] * K[i, k]
        # Second order: an off-diagonal of eps moves an eigenvalue by eps^2 over their distance.
        if not off > 1e-26 * (size + off):
            break
        for i in range(1, n):
            for k in range(i):
                if K[i, k] != 0.0:
                    _rotate(K, i, k)
    smallest = K[0, 0]
    largest = K[0, 0]
    for i in range(1, n):
        smallest = min(smallest, K[i, i])
        largest = larger(largest, K[i, i])
    return smallest, largest


@compiled
def _rotate(K: Matrix, i: int, k: int) -> None:
    """Make the entries (i, k) and (k, i) of a symmetric matrix zero by a Jacobi rotation."""
    below = K[i, k]
    theta = 0.5 * (K[i, i] - K[k, k]) / below
    t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
    if theta < 0.0:
        t = -t
    c = 1.0 / np.sqrt(t * t + 1.0)
    s = t * c
    K[i, i] += t * below
    K[k, k] -= t * below
    K[i, k] = 0.0
    K[k, i] = 0.0
    for j in range(K.shape[0]):
        if j != i and j != k:
            one = K[k, j]
            other = K[i, j]
            K[k, j] = c * one - s * other
            K[j, k] = K[k, j]
            K[i, j] = s * one + c * other
            K[j, i] = K[i, j]


@compiled
def is_convex(P: Matrix, K: Matrix) -> bool:
    """Check that P (n, n) is symmetric and positive semidefinite to `ROUNDING` of its scale.

    K (n, n) is scratch.
    """
    size = P.shape[0]
    scale = 0.0
    asymmetry = 0.0
    for i in range(size):  # of a matrix that is positive semidefinite, the largest are here
        scale = larger(scale, P[i, i])
    for i in range(size):
        for k in range(i):
            asymmetry = larger(asymmetry, abs(P[i, k] - P[k, i]))
            K[i, k] = P[i, k]
        K[i, i] = P[i, i] + ROUNDING * scale
    if scale == 0.0:  # no cost matrix at all, or none that is semidefinite
        for i in range(size):
            for k in range(size):
                asymmetry = larger(asymmetry, abs(P[i, k]))
        return asymmetry == 0.0
    return asymmetry <= ROUNDING * scale and cholesky_factor(K)


@compiled
def all_finite(data: Vector, start: int, end: int) -> bool:
    """Check that data[start:end] of (k,) is finite: NaN and infinity times zero are NaN."""
    total = 0.0
    for k in range(start, end):
        total += data[k] * 0.0
    return total == 0.0
