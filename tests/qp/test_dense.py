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
        matrix[-1, -1] = -1.0
        assert not dense.cholesky_factor(matrix.copy())


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
