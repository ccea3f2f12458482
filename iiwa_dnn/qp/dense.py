"""Compiled linear algebra on small dense matrices.

Of a symmetric matrix the upper half is read and written, row by row, since the entries of a row lie
next to each other in memory.
"""

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.layout import Matrix, Vector, larger

ASYMMETRY = 1e-5
"""Difference of P_ij and P_ji that passes, relative to sqrt(P_ii P_jj), which no entry of a
semidefinite matrix exceeds: a matrix that was computed in single precision has it. The symmetric
part of P is what the program means."""
ROUNDING = 4e-15
"""Negative eigenvalues of P that pass as rounding, relative to n times its largest entry. They are
those of a product J^T J in double precision; of single precision they are refused. A residual of n
variables passes as rounding at n times as much, relative to the sum of its absolute terms."""

LONG = 16
"""Terms of a product from which on it is summed in `PARTS`; those of one arm are fewer."""
PARTS = 4
"""Sums, of each fourth term, that a processor forms at once; rows that one pass takes off."""


@compiled
def dot(start: float, a: Vector, b: Vector) -> float:
    """Add the product of a vector (k,) and the first k entries of another one to a number."""
    if a.size >= LONG:
        return _long_dot(start, a, b)
    value = start
    for k in range(a.size):
        value += a[k] * b[k]
    return value


@compiled
def _long_dot(start: float, a: Vector, b: Vector) -> float:
    """Compute `dot` in `PARTS` sums, which are added at last."""
    one = start
    two = 0.0
    three = 0.0
    four = 0.0
    for part in range(a.size // PARTS):
        i = PARTS * part
        one += a[i] * b[i]
        two += a[i + 1] * b[i + 1]
        three += a[i + 2] * b[i + 2]
        four += a[i + 3] * b[i + 3]
    value = (one + two) + (three + four)
    for k in range(a.size - a.size % PARTS, a.size):
        value += a[k] * b[k]
    return value


@compiled
def largest_entry(values: Vector) -> float:
    """Return the largest absolute value of an array (k,); NaN if one is NaN."""
    largest = 0.0
    for i in range(values.size):
        largest = larger(largest, abs(values[i]))
    return largest


@compiled
def row_dot(rows: Matrix, j: int, x: Vector) -> float:
    """Compute the product of row j of a matrix (k, n) and the first n entries of x."""
    return dot(0.0, rows[j], x[: rows.shape[1]])


@compiled
def times(rows: Matrix, x: Vector, out: Vector) -> None:
    """Write the product of a matrix (k, n) and the first n entries of x into k entries of `out`."""
    for j in range(rows.shape[0]):
        out[j] = row_dot(rows, j, x)


@compiled
def add_multiple(out: Vector, factor: float, values: Vector) -> None:
    """Add a multiple of a vector (k,) to the first k entries of `out`."""
    for k in range(values.size):
        out[k] += factor * values[k]


@compiled
def add_row(out: Vector, factor: float, rows: Matrix, j: int) -> None:
    """Add a multiple of row j of a matrix (k, n) to the first n entries of `out`."""
    add_multiple(out, factor, rows[j])


@compiled
def weighted_sum(a: Vector, factor: float, b: Vector, out: Vector) -> None:
    """Write the sum of a vector (k,) and a multiple of another one into `out` (k,)."""
    for k in range(a.size):
        out[k] = a[k] + factor * b[k]


@compiled
def add_outer(out: Matrix, factor: float, row: Vector, start: int) -> None:
    """Add factor v v^T to the upper half of `out` (n, n).

    The entries of v are 0 but for a row (k,) that stands at `start`.
    """
    for i in range(row.size):
        add_multiple(out[start + i, start + i :], factor * row[i], row[i:])


@compiled
def cholesky_factor(K: Matrix) -> bool:
    """Overwrite the upper half of K (n, n) by R with K = R^T R, its diagonal inverted.

    Returns:
        False if K is not positive definite to working precision; its content is then meaningless.
    """
    size = K.shape[0]
    for i in range(size):
        for part in range(i // PARTS):
            j = PARTS * part
            one = K[j, i]
            two = K[j + 1, i]
            three = K[j + 2, i]
            four = K[j + 3, i]
            for k in range(i, size):
                K[i, k] = K[i, k] - one * K[j, k] - two * K[j + 1, k]
                K[i, k] = K[i, k] - three * K[j + 2, k] - four * K[j + 3, k]
        for last in range(i - i % PARTS, i):
            factor = K[last, i]
            for k in range(i, size):
                K[i, k] -= factor * K[last, k]
        if not K[i, i] > 0.0:
            return False
        K[i, i] = 1.0 / np.sqrt(K[i, i])  # a division costs many products
        for k in range(i + 1, size):
            K[i, k] *= K[i, i]
    return True


@compiled
def factor_solve(K: Matrix, rhs: Vector, out: Vector) -> None:
    """Solve with the factor that `cholesky_factor` left in K (n, n), into the first n of `out`."""
    size = K.shape[0]
    for i in range(size):
        out[i] = rhs[i]
    for i in range(size):
        out[i] *= K[i, i]
        for k in range(i + 1, size):
            out[k] -= out[i] * K[i, k]
    for back in range(size):
        row = size - 1 - back
        value = dot(-out[row], K[row, row + 1 :], out[row + 1 : size])
        out[row] = (0.0 - value) * K[row, row]


@compiled
def extreme_eigenvalues(K: Matrix) -> tuple[float, float]:
    """Compute the smallest and the largest eigenvalue of K (n, n), which is overwritten.

    Cyclic Jacobi rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", section 8.5) on
    both halves of K: for seven joints one call of LAPACK costs more than all of them.
    """
    n = K.shape[0]
    for _ in range(20):
        for i in range(1, n):
            for k in range(i):
                # An entry of that size moves an eigenvalue in second order.
                if abs(K[i, k]) > 1e-13 * (abs(K[i, i]) + abs(K[k, k])):
                    _rotate(K, i, k)
    smallest = np.inf
    largest = -np.inf
    for i in range(n):
        smallest = min(smallest, K[i, i])
        largest = larger(largest, K[i, i])
    return smallest, largest


@compiled
def _rotate(K: Matrix, i: int, k: int) -> None:
    """Make the entries (i, k) and (k, i) of a symmetric matrix zero by a Jacobi rotation."""
    theta = 0.5 * (K[i, i] - K[k, k]) / K[i, k]
    t = np.copysign(1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0)), theta)
    c = 1.0 / np.sqrt(t * t + 1.0)
    s = t * c
    for j in range(K.shape[0]):
        one = K[j, k]
        K[j, k] = c * one - s * K[j, i]
        K[j, i] = s * one + c * K[j, i]
    for j in range(K.shape[0]):
        one = K[k, j]
        K[k, j] = c * one - s * K[i, j]
        K[i, j] = s * one + c * K[i, j]


@compiled
def is_symmetric(P: Matrix, largest: float) -> bool:
    """Check that P (n, n) is symmetric, up to `ASYMMETRY` and rounding.

    Each pair of entries may differ by `ASYMMETRY` sqrt(P_ii P_jj) plus n `ROUNDING` times the
    largest absolute entry of P, which is given.
    """
    rounding = ROUNDING * P.shape[0] * largest
    for i in range(P.shape[0]):
        for k in range(i):
            asymmetry = abs(P[i, k] - P[k, i])
            if not asymmetry <= rounding:  # rarely: roots cost much
                size = np.sqrt(max(P[i, i], 0.0)) * np.sqrt(max(P[k, k], 0.0))
                if not asymmetry <= ASYMMETRY * size + rounding:
                    return False
    return True


@compiled
def symmetrize(P: Matrix) -> None:
    """Replace P (n, n) by its symmetric part if `is_symmetric`; leave any other P as it is."""
    if is_symmetric(P, largest_entry(P.reshape(P.size))):
        for i in range(P.shape[0]):
            for k in range(i):
                if P[i, k] != P[k, i]:
                    P[i, k] = 0.5 * P[i, k] + 0.5 * P[k, i]
                    P[k, i] = P[i, k]


@compiled
def is_convex(P: Matrix, K: Matrix) -> bool:
    """Check that P (n, n) `is_symmetric` and positive semidefinite, up to rounding.

    Eigenvalues of the symmetric part of P may be below zero by n `ROUNDING` times its largest
    absolute entry. K (n, n) is scratch.
    """
    largest = largest_entry(P.reshape(P.size))
    for i in range(P.shape[0]):
        for k in range(i, P.shape[0]):
            K[i, k] = 0.5 * (P[i, k] + P[k, i])
    for i in range(P.shape[0]):
        K[i, i] += ROUNDING * P.shape[0] * largest + 1e-300
    return is_symmetric(P, largest) and cholesky_factor(K)


@compiled
def all_finite(data: Vector, start: int, end: int) -> bool:
    """Check that the entries data[start:end] of an array (k,) are finite."""
    wrong = 0
    for k in range(start, end):  # no branch: several at once
        wrong += 0 if abs(data[k]) < np.inf else 1
    return wrong == 0
