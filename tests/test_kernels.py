"""Compiled pieces that stand for well-known ones, against Pinocchio's and numpy's."""

import numpy as np
import pinocchio as pin
import pytest
import scipy.linalg

from iiwa_dnn.qp import dense
from iiwa_dnn.qp.layout import larger
from iiwa_dnn.schemes import tasks


@pytest.mark.parametrize("angle", [0.0, 1e-14, 1e-8, 1e-3, 1.0, 2.5, np.pi - 1e-3, np.pi - 1e-7])
def test_rotation_log_is_pinocchios(angle: float) -> None:
    rng = np.random.default_rng(0)
    axes = [*np.eye(3), *-np.eye(3), *rng.standard_normal((50, 3))]
    for axis in axes:
        vector = angle * axis / np.linalg.norm(axis)
        result = np.empty(3)
        tasks.rotation_log(pin.exp3(vector), result)
        # Near a half turn the angle is known from the matrix to 1e-8 only, by anyone.
        np.testing.assert_allclose(result, vector, rtol=0, atol=1e-13 if angle < 3.0 else 1e-8)
        np.testing.assert_allclose(result, pin.log3(pin.exp3(vector)), rtol=0, atol=1e-7)


def test_rotation_log_of_a_half_turn() -> None:
    for axis in np.eye(3):
        result = np.empty(3)
        tasks.rotation_log(2.0 * np.outer(axis, axis) - np.eye(3), result)
        np.testing.assert_allclose(np.abs(result), np.pi * axis, rtol=0, atol=1e-12)


@pytest.mark.parametrize("rank", [0, 1, 2, 3])
def test_projection_on_the_range_is_numpys(rank: int) -> None:
    rng = np.random.default_rng(rank)
    for _ in range(50):
        columns = rng.standard_normal((4, rank)) @ rng.standard_normal((rank, 3))
        vector = rng.standard_normal(4)
        basis = scipy.linalg.orth(columns, rcond=1e-9) if rank else np.zeros((4, 1))
        expected = basis @ (basis.T @ vector)
        tasks.project_on_range(columns, vector)
        np.testing.assert_allclose(vector, expected, rtol=0, atol=1e-10)


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
