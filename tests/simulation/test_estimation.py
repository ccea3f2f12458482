"""The Kalman filter against a batch least-squares solution, and against the noise it is for."""

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import driven, heart, paper_robot, paper_start
from iiwa_dnn.simulation.estimation import JointEstimator, NoiseModel

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


def test_with_late_drives_the_estimate_is_where_the_next_command_begins() -> None:
    """Exact readings of a joint whose drive carries out what it got three periods ago."""
    dt = 1e-3
    commands = np.random.default_rng(2).standard_normal((50, 2))
    q = np.cumsum(np.vstack([np.zeros((4, 2)), dt * commands]), axis=0)
    estimator = JointEstimator(NoiseModel(velocity=1e-6, measurement=1e-6, delay_periods=3), dt)
    for k in range(40):
        expected = estimator.update(q[k])
        np.testing.assert_allclose(expected, q[k + 3], rtol=0, atol=1e-14)
        estimator.predict(commands[k])


def shaken(estimator: JointEstimator | None) -> tuple[np.ndarray, float, float]:
    """Drive an arm with noisy encoders whose drives are one period late, from rest for 0.6 s.

    Returns 1 for each command that is ok, 2 if it is limited; the last speed; and the delay.
    """
    robot = paper_robot().with_limits(acceleration=10.0, jerk=100.0)
    limits = (d.AccelerationLimits(), d.JerkLimits())
    scheme = d.DoubleIndicator(position_gain=9.5, orientation_gain=9.5, extra_limits=limits)
    controller = d.Controller(robot, scheme, d.FixedPose().anchored(paper_start()), dt=2e-3)
    q = np.array(PAPER_Q0)
    late = np.zeros(7)
    said = []
    for k in range(300):
        seen = q + 1e-4 * np.random.default_rng(k).standard_normal(7)
        if estimator is not None:
            seen = estimator.update(seen)
        command = controller.step(seen, (k + 1) * 2e-3)
        if estimator is not None:
            estimator.predict(command.dq)
        said.append(command.ok or 2 * command.limited)
        q = q + 2e-3 * late
        late = command.dq
    return np.array(said), float(np.abs(late).max()), controller.path_lag


def test_a_loop_with_an_estimator_leaves_an_arm_at_rest_alone() -> None:
    model = NoiseModel(velocity=1e-3, measurement=1e-4, delay_periods=1)
    banged, speed, delay = shaken(None)
    estimator = JointEstimator(model, 2e-3)
    calm, slow, little = shaken(estimator)
    assert (banged == 2).all()  # never all that is asked, and never more than limited
    assert (calm == 1).mean() > 0.9
    assert slow < 0.2 * speed
    assert little < 0.1 * delay
    assert not estimator.bias.any()  # its model has none


def test_a_command_against_a_velocity_limit_is_not_limited_but_cannot() -> None:
    robot = paper_robot().with_limits(velocity=0.02, acceleration=10.0, jerk=1000.0)
    limits = (d.AccelerationLimits(), d.JerkLimits())
    controller = d.Controller(robot, d.DoubleIndicator(extra_limits=limits), heart(), dt=1e-3)
    first, *_, last = driven(controller, PAPER_Q0, 300)[1]
    assert (first.ok, first.limited) == (True, False)
    assert (last.ok, last.limited) == (False, False)
    assert "velocity limit" in repr(last)
