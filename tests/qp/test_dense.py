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
        factor = matrix.copy()
        assert dense.cholesky_factor(factor)
        dense.factor_solve(factor, rhs, out)
        np.testing.assert_allclose(out, np.linalg.solve(matrix, rhs), rtol=1e-8, atol=1e-11)
        matrix[-1, -1] = -1.0
        assert not dense.cholesky_factor(matrix.copy())


def test_the_larger_of_two_keeps_a_nan() -> None:
    assert larger(1.0, 2.0) == 2.0
    assert larger(2.0, 1.0) == 2.0
    assert np.isnan(larger(np.nan, 1.0))
    assert np.isnan(larger(1.0, np.nan))


def test_products_are_numpys() -> None:
    rng = np.random.default_rng(2)
    for n in (1, 2, 3, 4, 5, 7, 8, 16, 30, 51):
        matrix, vector = rng.standard_normal((n, n)), rng.standard_normal(n)
        assert dense.row_dot(matrix, n - 1, vector) == pytest.approx(matrix[-1] @ vector)
        out = np.full(n + 3, 9.0)
        dense.rows_dot(matrix, vector, out, 2)
        np.testing.assert_allclose(out[2 : n + 2], matrix @ vector, rtol=1e-12, atol=1e-13)
        assert out[0] == out[1] == out[-1] == 9.0
        total = vector.copy()
        dense.add_row(total, -2.0, matrix, n - 1)
        np.testing.assert_allclose(total, vector - 2.0 * matrix[-1], rtol=1e-12, atol=1e-13)
        result = matrix.copy()
        dense.add_outer(result, -2.0, np.stack([np.ones(n), vector]), 1)
        expected = np.tril(matrix - 2.0 * np.outer(vector, vector)) + np.triu(matrix, 1)
        np.testing.assert_allclose(result, expected, rtol=1e-12, atol=1e-13)


def test_extreme_eigenvalues_are_numpys() -> None:
    rng = np.random.default_rng(3)
    for n in (1, 2, 7, 20):
        root = rng.standard_normal((n, n))
        matrix = root + root.T
        expected = np.linalg.eigvalsh(matrix)
        smallest, largest = dense.extreme_eigenvalues(matrix.copy())
        np.testing.assert_allclose([smallest, largest], expected[[0, -1]], rtol=0, atol=1e-12 * n)


def test_what_is_not_finite_is_seen_wherever_it_stands() -> None:
    values = np.random.default_rng(4).standard_normal(37)
    assert dense.all_finite(values, 0, 37)
    for bad in (np.nan, np.inf, -np.inf):
        for place in (0, 20, 36):
            spoilt = values.copy()
            spoilt[place] = bad
            assert not dense.all_finite(spoilt, 0, 37)
            assert not dense.all_finite(spoilt, place, place + 1)


def test_a_convex_cost_is_symmetric_and_positive_semidefinite() -> None:
    root = np.random.default_rng(5).standard_normal((5, 3))
    for matrix, convex in (
        (root @ root.T, True),
        (1e-9 * root @ root.T, True),
        (np.zeros((3, 3)), True),
        (np.array([[0.0, 1.0], [1.0, 0.0]]), False),
        (np.array([[1.0, 1e-7], [0.0, 1.0]]), True),
        (np.array([[1.0, 1e-3], [0.0, 1.0]]), False),
        (np.array([[1.0, np.nan], [0.0, 1.0]]), False),
        (np.diag([1.0, -1e-6]), True),
        (np.diag([1.0, -1e-4]), False),
        (-np.eye(2), False),
    ):
        n = len(matrix)
        assert dense.is_convex(matrix, np.empty((n, n))) is convex
