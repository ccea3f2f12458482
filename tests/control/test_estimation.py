"""The Kalman filter against a batch least-squares solution, and against the noise it is for."""

from __future__ import annotations

import numpy as np
import pytest

from iiwa_dnn.control.estimation import JointEstimator, NoiseModel
from iiwa_dnn.errors import InvalidInputError

DT = 1e-3


def readings(model: NoiseModel, steps: int, bias: float, seed: int) -> tuple[np.ndarray, ...]:
    """True angles, readings and commands of two joints."""
    rng = np.random.default_rng(seed)
    command = 0.3 * np.sin(0.01 * np.arange(steps))[:, None] * np.array([1.0, -0.5])
    velocity = command + bias + model.velocity * rng.standard_normal((steps, 2))
    q = np.vstack([[0.4, -1.0], [0.4, -1.0] + DT * np.cumsum(velocity, axis=0)])
    return q, q + model.measurement * rng.standard_normal(q.shape), command


def batch(model: NoiseModel, z: np.ndarray, u: np.ndarray) -> tuple[float, float]:
    """Angle and bias after the last reading: all equations at once, by weighted least squares."""
    steps = len(u)
    size = 2 * (steps + 1)  # q_0, d_0, q_1, d_1, ...
    rows, rhs = [], []

    def add(entries: dict[int, float], value: float, sigma: float) -> None:
        row = np.zeros(size)
        for i, entry in entries.items():
            row[i] = entry
        rows.append(row / sigma)
        rhs.append(value / sigma)

    add({1: 1.0}, 0.0, model.bias)
    for k in range(steps + 1):
        add({2 * k: 1.0}, z[k], model.measurement)
    for k in range(steps):
        step = {2 * k + 2: 1.0, 2 * k: -1.0, 2 * k + 1: -DT}
        add(step, DT * u[k], DT * model.velocity)
        add({2 * k + 3: 1.0, 2 * k + 1: -1.0}, 0.0, np.sqrt(DT) * model.bias_walk)
    state = np.linalg.lstsq(np.array(rows), np.array(rhs), rcond=None)[0]
    return float(state[-2]), float(state[-1])


def test_it_is_the_least_squares_estimate() -> None:
    model = NoiseModel(velocity=0.05, measurement=1e-4, bias_walk=0.02, bias=0.1)
    _, z, u = readings(model, 40, bias=0.05, seed=1)
    estimator = JointEstimator(model, DT)
    for k in range(41):
        q = estimator.update(z[k])
        if k < 40:
            estimator.predict(u[k])
    for joint in range(2):
        expected = batch(model, z[:, joint], u[:, joint])
        assert q[joint] == pytest.approx(expected[0], rel=1e-9)
        assert estimator.bias[joint] == pytest.approx(expected[1], rel=1e-6)


def test_it_is_nearer_to_the_truth_than_the_reading_and_finds_the_bias() -> None:
    model = NoiseModel(velocity=0.01, measurement=1e-4, bias_walk=1e-3)
    q, z, u = readings(model, 4000, bias=0.02, seed=2)
    estimator = JointEstimator(model, DT)
    estimates = []
    for k in range(4000):
        estimates.append(estimator.update(z[k]))
        estimator.predict(u[k])
    error, raw = np.array(estimates)[500:] - q[500:-1], (z - q)[500:-1]
    assert (error**2).mean() < 0.1 * (raw**2).mean()
    np.testing.assert_allclose(estimator.bias, 0.02, rtol=0.05)


def test_without_a_bias_walk_there_is_no_bias() -> None:
    model = NoiseModel(velocity=0.01, measurement=1e-4)
    _, z, u = readings(model, 200, bias=0.5, seed=3)
    estimator = JointEstimator(model, DT)
    for k in range(200):
        estimator.update(z[k])
        estimator.predict(u[k])
    np.testing.assert_array_equal(estimator.bias, np.zeros(2))
    estimator.reset()
    np.testing.assert_array_equal(estimator.update(z[7]), z[7])


@pytest.mark.parametrize(
    ("numbers", "name"),
    [
        ({"measurement": 0.0}, "measurement"),
        ({"velocity": -1.0}, "velocity"),
        ({"bias_walk": np.nan}, "bias_walk"),
        ({"bias": np.inf}, "bias"),
    ],
)
def test_bad_numbers_are_named(numbers: dict[str, float], name: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{name}\b"):
        NoiseModel(**numbers)
