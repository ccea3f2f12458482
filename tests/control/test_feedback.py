"""The chosen gain against the stationary variance of its recursion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import solve_discrete_lyapunov

from iiwa_dnn.control.feedback import ROUGHNESS, noise_gain
from iiwa_dnn.errors import InvalidInputError


def variance(gain: float, velocity: float, measurement: float, dt: float) -> float:
    """Stationary variance of the error, by a Lyapunov equation."""
    transition = np.array([[1.0 - gain * dt]])
    drive = np.array([[(dt * velocity) ** 2 + (gain * dt * measurement) ** 2]])
    return float(solve_discrete_lyapunov(transition, drive)[0, 0])


@pytest.mark.parametrize(
    ("velocity", "measurement", "dt"),
    [(0.01, 1e-4, 1e-4), (0.01, 1e-3, 1e-2), (1.0, 1e-3, 1e-3), (0.01, 1e-12, 1e-3)],
)
def test_no_other_gain_has_less_error(velocity: float, measurement: float, dt: float) -> None:
    best = noise_gain(velocity, measurement, dt, roughness=1.0)
    least = variance(best, velocity, measurement, dt)
    others = np.geomspace(0.01 * best, min(100.0 * best, 1.99 / dt), 400)
    assert all(variance(gain, velocity, measurement, dt) >= least * (1 - 1e-9) for gain in others)
    assert variance(0.5 * best, velocity, measurement, dt) > 1.05 * least


def test_an_exact_measurement_is_fed_back_as_far_as_the_roughness_allows() -> None:
    assert noise_gain(0.01, 0.0, 1e-4) == pytest.approx(ROUGHNESS / 1e-4)
    assert noise_gain(0.01, 0.0, 1e-4, roughness=1.0) == pytest.approx(1e4)
    assert noise_gain(0.0, 1e-3, 1e-4) == 0.0


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ((-1.0, 0.0, 1e-3), "velocity_noise"),
        ((0.01, np.nan, 1e-3), "measurement_noise"),
        ((0.01, 0.0, 0.0), "dt"),
        ((0.01, 0.0, 1e-3, 1.5), "roughness"),
        ((0.01, 0.0, 1e-3, 0.0), "roughness"),
    ],
)
def test_a_bad_number_is_named(arguments: tuple[float, ...], name: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{name}\b"):
        noise_gain(*arguments)
