"""Compiled pieces that stand for well-known ones, against closed forms and scipy."""

import numpy as np
import pinocchio as pin
import pytest
import scipy.linalg

from helpers_simulation import block_map
from iiwa_dnn.references.rotations import rotation_log
from iiwa_dnn.schemes.tasks import project_on_range


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
