"""Disturbances: what they do, seen from outside, and what is refused."""

import numpy as np
import pytest

from iiwa_dnn.simulation.disturbances import Disturbances, Encoder


def test_every_mass_is_off_by_as_much_and_the_seed_says_which_way():
    typical = Disturbances.typical()
    drawn = [typical.mass_factors(7, seed) for seed in range(20)]
    assert all(np.allclose(np.abs(factors - 1.0), 0.1) for factors in drawn)
    np.testing.assert_array_equal(drawn[4], typical.mass_factors(7, 4))
    assert len({tuple(factors) for factors in drawn}) > 10
    np.testing.assert_array_equal(Disturbances().mass_factors(7, seed=3), np.ones(7))


def test_encoder_noise_and_rounding():
    step = Encoder(0.0, 18, seed=0).step
    assert step == pytest.approx(2.0 * np.pi / 262144)
    q = np.linspace(0.3, 0.30001, 7)
    rounded = Encoder(0.0, 18, seed=0)(q)
    np.testing.assert_allclose(rounded / step, np.round(rounded / step), atol=1e-9)
    assert 0.0 < np.abs(rounded - q).max() <= 0.5 * step
    noisy = Encoder(1e-3, 0, seed=0)
    readings = np.array([noisy(q) for _ in range(3000)]) - q
    assert readings.std() == pytest.approx(1e-3, rel=0.03)
    assert abs(readings.mean()) < 3e-5
    np.testing.assert_array_equal(Encoder(1e-3, 18, 5)(q), Encoder(1e-3, 18, 5)(q))
