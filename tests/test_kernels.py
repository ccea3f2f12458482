"""A compiled piece that stands for a well-known one, against scipy."""

import numpy as np
import pinocchio as pin
import pytest
import scipy.linalg

from helpers_simulation import block_map
from iiwa_dnn.schemes.tasks import project_on_range


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
