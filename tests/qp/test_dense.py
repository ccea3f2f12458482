"""Compiled linear algebra and residuals, against numpy's and qpsolvers'."""

import numpy as np

from iiwa_dnn.qp import dense


def test_cholesky_is_numpys_and_refuses_what_is_not_definite() -> None:
    rng = np.random.default_rng(1)
    for n in (1, 2, 3, 4, 5, 7, 8, 16, 30, 51):
        root = rng.standard_normal((n, n))
        matrix, rhs, out = root @ root.T + np.eye(n), rng.standard_normal(n), np.empty(n)
        factor = matrix.copy()
        assert dense.cholesky_factor(factor)
        dense.factor_solve(factor, rhs, out)
        np.testing.assert_allclose(out, np.linalg.solve(matrix, rhs), rtol=1e-8, atol=1e-11)
        dense.times(matrix, rhs, out)
        assert [dense.row_dot(matrix, j, rhs) for j in range(n)] == out.tolist()
        assert dense.is_convex(matrix, np.full((n, n), np.nan))
        matrix[-1, -1] = -1.0
        assert not dense.cholesky_factor(matrix.copy())
        assert not dense.is_convex(matrix, np.full((n, n), np.nan))


def test_extreme_eigenvalues_are_numpys() -> None:
    rng = np.random.default_rng(3)
    for n in (1, 2, 7, 20):
        root = rng.standard_normal((n, n))
        matrix = root + root.T
        expected = np.linalg.eigvalsh(matrix)
        smallest, largest = dense.extreme_eigenvalues(matrix.copy())
        np.testing.assert_allclose([smallest, largest], expected[[0, -1]], rtol=0, atol=1e-12 * n)
