"""Compiled linear algebra and residuals, against numpy's and qpsolvers'."""

import numpy as np
import pytest

from iiwa_dnn.qp import dense
from iiwa_dnn.qp.layout import larger


def test_cholesky_is_numpys_and_refuses_what_is_not_definite() -> None:
    rng = np.random.default_rng(1)
    for n in (1, 2, 3, 4, 5, 7, 8, 16, 30, 51):
        root = rng.standard_normal((n, n))
        matrix, rhs, out = root @ root.T + np.eye(n), rng.standard_normal(n), np.empty(n)
        factor = matrix.ravel().copy()
        assert dense.cholesky_factor(factor, n)
        dense.factor_solve(factor, n, rhs, out)
        np.testing.assert_allclose(out, np.linalg.solve(matrix, rhs), rtol=1e-8, atol=1e-11)
        matrix[-1, -1] = -1.0
        assert not dense.cholesky_factor(matrix.ravel().copy(), n)


def test_the_larger_of_two_keeps_a_nan() -> None:
    assert larger(1.0, 2.0) == 2.0
    assert larger(2.0, 1.0) == 2.0
    assert np.isnan(larger(np.nan, 1.0))
    assert np.isnan(larger(1.0, np.nan))


def test_products_are_numpys() -> None:
    rng = np.random.default_rng(2)
    for n in (1, 2, 3, 4, 5, 7, 8, 16, 30, 51):
        matrix, vector = rng.standard_normal((n, n)), rng.standard_normal(n)
        flat = matrix.ravel().copy()
        assert dense.dot(flat, n * (n - 1), vector, n) == pytest.approx(matrix[-1] @ vector)
        total = vector.copy()
        dense.add_scaled(total, -2.0, flat, n * (n - 1), n)
        np.testing.assert_allclose(total, vector - 2.0 * matrix[-1], rtol=1e-12, atol=1e-13)
        dense.add_outer(flat, -2.0, np.concatenate([[9.0], vector]), 1, n)
        expected = np.tril(matrix - 2.0 * np.outer(vector, vector)) + np.triu(matrix, 1)
        np.testing.assert_allclose(flat.reshape(n, n), expected, rtol=1e-12, atol=1e-13)


def test_extreme_eigenvalues_are_numpys() -> None:
    rng = np.random.default_rng(3)
    for n in (1, 2, 7, 20):
        root = rng.standard_normal((n, n))
        matrix = root + root.T
        expected = np.linalg.eigvalsh(matrix)
        smallest, largest = dense.extreme_eigenvalues(matrix.ravel().copy(), n)
        np.testing.assert_allclose([smallest, largest], expected[[0, -1]], rtol=0, atol=1e-12 * n)
