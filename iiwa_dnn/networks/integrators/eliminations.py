r"""Solvers for the linear system of one implicit step of the barrier network.

One step of length :math:`1/\delta` leaves, with weights W of the rows of G and a diagonal B of the
bounds' weights,

.. math::

    \begin{pmatrix} P + B + \varepsilon I & A^T & G^T \\ A & -\delta I & 0 \\ G & 0 & -W^{-1}
    \end{pmatrix} .

`Condensed` eliminates all multipliers and takes a dense Cholesky factor; `Augmented` eliminates
nothing and takes a sparse factor in one order for all steps, which exists for each symmetric
permutation because the matrix is quasidefinite.

Source: R. J. Vanderbei, "Symmetric quasidefinite matrices", SIAM J. Optim. 5 (1995).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

import numpy as np

from iiwa_dnn.qp.layout import Matrix, Vector

SPARSE, DENSITY = 150, 0.04
"""Variables from which on, and share of entries that are not zero up to which, the augmented matrix
is factored sparsely."""


def elimination(P: Matrix, A: Matrix, G: Matrix) -> Condensed | Augmented:
    """Choose the elimination for dense matrices (n, n), (p, n), (m, n) by size and sparsity."""
    rows = len(P) + len(A) + len(G)
    if len(P) >= SPARSE:
        used = np.count_nonzero(P) + 2 * np.count_nonzero(A) + 2 * np.count_nonzero(G)
        if used + rows <= DENSITY * rows**2:
            return Augmented(P, A, G)
    return Condensed(P, A, G)


class _Matrices(ABC):
    """P, A and G, to be scaled before the first factor."""

    matrices: tuple[Any, ...]

    @staticmethod
    @abstractmethod
    def largest(matrix: Any, axis: int) -> Vector:
        """Compute the largest entry of each column (axis 0) or row (axis 1)."""

    @staticmethod
    @abstractmethod
    def scale(matrix: Any, rows: Vector, columns: Vector) -> None:
        """Multiply rows and columns in place."""

    @abstractmethod
    def prepare(self) -> None:
        """Prepare the scaled matrices for the factors."""

    def equilibrate(self, q: Vector) -> tuple[tuple[Vector, Vector, Vector], float]:
        """Scale the matrices in place by Ruiz's iteration; returns the scales and the cost's."""
        P, A, G = self.matrices
        d, f, e = (np.ones(matrix.shape[0]) for matrix in self.matrices)
        for _ in range(10):
            size = np.maximum.reduce([self.largest(matrix, 0) for matrix in self.matrices])
            sizes = size, self.largest(A, 1), self.largest(G, 1)
            x, y, z = (1.0 / np.sqrt(np.where(size > 0.0, size, 1.0)) for size in sizes)
            self.scale(P, x, x)
            self.scale(A, y, x)
            self.scale(G, z, x)
            d, f, e = d * x, f * y, e * z
            if all(np.abs(1.0 - scale).max(initial=0.0) < 1e-2 for scale in (x, y, z)):
                break
        size = max(self.largest(P, 0).mean(), np.abs(q * d).max(), 1e-300)
        self.scale(P, np.full(len(d), 1.0 / size), np.ones(len(d)))
        self.prepare()
        return (d, f, e), 1.0 / size


class Condensed(_Matrices):
    """Cholesky factor of P + B + eps I + A^T A/delta + G^T W G, dense."""

    def __init__(self, *matrices: Matrix) -> None:
        """Copy the matrices, (n, n), (p, n) and (m, n)."""
        self.matrices, self.delta = tuple(matrix.copy() for matrix in matrices), 0.0

    @staticmethod
    def largest(matrix: Matrix, axis: int) -> Vector:  # noqa: D102
        largest: Vector = np.abs(matrix).max(axis=axis, initial=0.0)
        return largest

    @staticmethod
    def scale(matrix: Matrix, rows: Vector, columns: Vector) -> None:  # noqa: D102
        matrix *= rows[:, None] * columns

    def prepare(self) -> None:  # noqa: D102
        self.P, self.A, self.G = self.matrices
        self.gram = self.A.T @ self.A

    def factor(self, w: Vector, box: Vector, delta: float) -> bool:
        """Factor for weights w (m,) and box (n,); False if it is not positive definite."""
        from scipy.linalg.lapack import dpotrf

        if delta != self.delta:
            self.base, self.delta = self.P + self.gram / delta, delta
        rows = np.sqrt(w)[:, None] * self.G
        K = rows.T @ rows
        K += self.base
        K.flat[:: len(K) + 1] += box
        self.w = w
        self.L, info = dpotrf(K.T, lower=1, overwrite_a=1, clean=0)
        return bool(info == 0)

    def solve(self, rx: Vector, ry: Vector, rg: Vector) -> tuple[Vector, Vector, Vector]:
        """Solve for dx (n,), dy (p,) and the multipliers of G (m,) with this right-hand side."""
        from scipy.linalg.lapack import dpotrs

        right = rx + self.A.T @ (ry / self.delta) + self.G.T @ (self.w * rg)
        dx, _ = dpotrs(self.L, right, lower=1)
        return dx, (self.A @ dx - ry) / self.delta, self.w * (self.G @ dx - rg)


class Augmented(_Matrices):
    """Sparse LU factor of the whole matrix, pivots on the diagonal."""

    def __init__(self, *matrices: Matrix) -> None:
        """Take the entries of the matrices, (n, n), (p, n) and (m, n), that are not zero."""
        from scipy.sparse import coo_matrix

        self.matrices = tuple(coo_matrix(matrix) for matrix in matrices)

    @staticmethod
    def largest(matrix: Any, axis: int) -> Vector:  # noqa: D102
        sizes = np.zeros(matrix.shape[1 - axis])
        np.maximum.at(sizes, matrix.row if axis else matrix.col, np.abs(matrix.data))
        return sizes

    @staticmethod
    def scale(matrix: Any, rows: Vector, columns: Vector) -> None:  # noqa: D102
        matrix.data *= rows[matrix.row] * columns[matrix.col]

    def prepare(self) -> None:
        """Put the scaled matrices together, in an order that leaves few entries to fill in."""
        import scipy.sparse as spa

        P, A, G = self.matrices = tuple(matrix.tocsr() for matrix in self.matrices)
        self.sizes, self.diagonal = (P.shape[0], A.shape[0]), P.diagonal()
        ones = [spa.eye(matrix.shape[0]) for matrix in (P, A, G)]
        K = spa.bmat([[P + ones[0], A.T, G.T], [A, -ones[1], None], [G, None, -ones[2]]], "csc")
        self.order = np.argsort(self._lu(K, "MMD_AT_PLUS_A").perm_c)
        self.K = K[self.order][:, self.order].tocsc()
        self.K.sort_indices()
        columns = np.repeat(np.arange(len(self.order)), np.diff(self.K.indptr))
        self.places = np.flatnonzero(self.K.indices == columns)

    def factor(self, w: Vector, box: Vector, delta: float) -> bool:
        """Factor for weights w (m,) and box (n,); False if a pivot is zero."""
        p = self.sizes[1]
        diagonal = np.concatenate([self.diagonal + box, np.full(p, -delta), -1.0 / w])
        self.K.data[self.places] = diagonal[self.order]
        try:
            self.lu = self._lu(self.K, "NATURAL")
        except RuntimeError:
            return False
        return True

    def solve(self, rx: Vector, ry: Vector, rg: Vector) -> tuple[Vector, Vector, Vector]:
        """Solve for dx (n,), dy (p,) and the multipliers of G (m,) with this right-hand side."""
        n, p = self.sizes
        found = np.empty(len(self.order))
        found[self.order] = self.lu.solve(np.concatenate([rx, ry, rg])[self.order])
        return found[:n], found[n : n + p], found[n + p :]

    @staticmethod
    def _lu(K: Any, order: str) -> Any:
        from scipy.sparse.linalg import splu

        return splu(K, order, diag_pivot_thresh=0.0, options={"SymmetricMode": True})
