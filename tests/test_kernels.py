"""Compiled pieces that stand for well-known ones, against Pinocchio's and numpy's."""

import numpy as np
import pinocchio as pin
import pytest
import scipy.linalg

from helpers_simulation import block_map
from iiwa_dnn.references.rotations import rotation_log
from iiwa_dnn.schemes.tasks import project_on_range


@pytest.mark.parametrize("angle", [0.0, 1e-14, 1e-8, 1e-3, 1.0, 2.5, np.pi - 1e-3, np.pi - 1e-7])
def test_rotation_log_is_pinocchios(angle: float) -> None:
    rng = np.random.default_rng(0)
    axes = [*np.eye(3), *-np.eye(3), *rng.standard_normal((50, 3))]
    for axis in axes:
        vector = angle * axis / np.linalg.norm(axis)
        result = np.empty(3)
        rotation_log(pin.exp3(vector), result)
        # Near a half turn the angle is known from the matrix to 1e-8 only, by anyone.
        np.testing.assert_allclose(result, vector, rtol=0, atol=1e-13 if angle < 3.0 else 1e-8)
        np.testing.assert_allclose(result, pin.log3(pin.exp3(vector)), rtol=0, atol=1e-7)


def test_rotation_log_of_a_half_turn() -> None:
    for axis in np.eye(3):
        result = np.empty(3)
        rotation_log(2.0 * np.outer(axis, axis) - np.eye(3), result)
        np.testing.assert_allclose(np.abs(result), np.pi * axis, rtol=0, atol=1e-12)


@pytest.mark.parametrize("tilt", [0.0, 1e-12, 1e-7, 1e-3, 1.0, 2.0, np.pi - 1e-3, np.pi])
def test_projection_on_the_range_of_the_blocks_rows_is_scipys(tilt: float) -> None:
    rng = np.random.default_rng(0)
    for yaw, spin in rng.uniform(-np.pi, np.pi, (50, 2)):
        rotation = pin.utils.rotate("z", yaw) @ pin.utils.rotate("y", tilt)
        rotation = rotation @ pin.utils.rotate("z", spin)
        vector = rng.standard_normal(4)
        basis = scipy.linalg.orth(block_map(rotation), rcond=1e-9)
        expected = basis @ (basis.T @ vector)
        project_on_range(np.append(rotation.T, np.zeros(3)), vector)
        np.testing.assert_allclose(vector, expected, rtol=0, atol=1e-8)
