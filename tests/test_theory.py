"""The statements of docs/theory.md that are marked (T)."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot, paper_start, run
from iiwa_dnn.results.metrics import position_error

Array = NDArray[np.float64]
RHO, DELTA = 9e-5, 10.2
SO3 = d.DoubleIndicator(orientation="so3", home=PAPER_Q0)
UNPROJECTED = d.ProjectionNetwork(primal_projection=False)
PAGE = (Path(__file__).parents[1] / "docs" / "theory.md").read_text(encoding="utf-8")


def euler(network: d.Network, qp: d.QP, state: Any, step: float, count: int) -> Iterator[Array]:
    """The states after so many steps of Euler's method."""
    state = np.array(state, dtype=float)
    rates = network.flow(qp).rates
    for _ in range(count):
        state = state + step * rates(state)
        yield state


def equilibrium(qp: d.QP) -> Array:
    """The KKT point as a state of the paper's network."""
    found = d.DNNSolver(tol=1e-12).solve(qp)
    upper, lower = np.maximum(found.z_box, 0.0), np.maximum(-found.z_box, 0.0)
    return np.concatenate([found.x, found.y, found.z, upper, lower])


@pytest.mark.parametrize("far", [10.0, 100.0, 200.0])
def test_settling_takes_as_long_as_the_multiplier_is_far_away(far: float) -> None:
    """P = A = 1, |x| <= 1: no exponential rate holds from everywhere, it would be log D."""
    qp = d.QP([[1.0]], [0.0], A=[[1.0]], b=[0.0], lb=[-1.0], ub=[1.0])
    states = euler(d.ProjectionNetwork(), qp, [0.0, -far, 0.0, 0.0], 2e-3, round(500 * (far + 40)))
    away = [np.linalg.norm(state) > 1e-6 for state in states]
    assert 2e-3 * np.flatnonzero(away)[-1] == pytest.approx(far + 27.0, abs=0.5)


@pytest.mark.parametrize("weight", [0.2, 0.9])
def test_the_lag_of_a_continuous_run_follows_from_a_converged_one(weight: float) -> None:
    scheme, duration = d.DoubleIndicator(weight, orientation="so3", home=PAPER_Q0), 0.6
    lagging = run(scheme, dt=1e-4, mode="continuous", duration=duration)
    settled = run(scheme, dt=5e-3, duration=duration, motion="midpoint")
    y = []
    for q, t in zip(settled.q, settled.t, strict=True):
        qp = scheme.build_qp(d.Configuration(paper_robot(), q), heart().at(t))
        y.append(d.DNNSolver().solve(qp).y[:3])
    expected = np.zeros((len(y), 3))
    for k, rate in enumerate(np.gradient(y, settled.t, axis=0)[1:]):
        still = RHO * rate / DELTA
        expected[k + 1] = still + (expected[k] - still) * np.exp(-DELTA * 5e-3)
    found = position_error(lagging)[:: round(5e-3 / 1e-4)]
    assert np.linalg.norm(found[-1]) > 1e-6
    assert np.abs(found - expected).max() < 0.04 * np.linalg.norm(found, axis=1).max()


def test_the_mean_square_that_noise_leaves() -> None:
    sigma, dt = 0.01, 4e-3
    target = d.Circle(radius=1e-9, period=10.0).anchored(paper_start())  # at rest
    errors = [
        position_error(run(SO3, target, dt=dt, duration=8.0, noise=sigma, seed=seed))[125:]
        for seed in range(4)
    ]
    square = np.sum(paper_start().jacobian[:3] ** 2)
    expected = square / 3.0 * sigma**2 * dt / (2.0 * DELTA)
    # 30 s at 10 rad/s in three axes: some 450 independent samples of a square, 7 %.
    assert np.mean(np.concatenate(errors) ** 2) == pytest.approx(expected, rel=0.2)


class Straight(d.Reference):
    """A straight line at constant velocity."""

    name = "straight"
    period = 2.0

    def move(self, t: float, target: Array) -> None:
        target[:3] += t * np.array([0.02, 0.03, -0.01])
        target[12:15] = [0.02, 0.03, -0.01]


@pytest.mark.parametrize("window", [1, 10])
def test_the_lag_is_the_delay_times_the_joints_acceleration_over_the_gain(window: int) -> None:
    """Also on a straight line at constant velocity, whose target has no acceleration.

    Ten samples are late by four and a half steps, Euler's method by half a step of its own.
    """
    dt = 1e-3
    path = Straight().anchored(paper_start())
    record = run(SO3, path, duration=2.0, filter_window=window)
    assert record.settings["reference"] == {"name": "straight"}  # which is no dataclass
    acceleration = np.gradient(record.dq, dt, axis=0)
    delay = 0.5 * window * dt
    for k in range(1000, record.steps, 250):
        moved = d.Configuration(paper_robot(), record.q[k]).jacobian[:3] @ acceleration[k]
        error = np.linalg.norm(position_error(record)[k])
        assert error == pytest.approx(delay * np.linalg.norm(moved) / DELTA, rel=0.05)


@pytest.mark.parametrize(("step", "settles"), [(0.95, False), (0.8, False), (0.5, True)])
def test_across_active_sets_a_step_within_the_linear_bound_may_grow(
    step: float, settles: bool
) -> None:
    qp = d.QP([[1.0]], [-10.0], lb=[-1.0], ub=[1.0])
    *_, state = euler(UNPROJECTED, qp, np.zeros(UNPROJECTED.state_size(qp)), step, 1000)
    assert bool(abs(state[0] - 1.0) < 1e-9) is settles
    assert settles or np.abs(state).max() > 1e20


def test_a_state_that_is_no_number_ends_what_is_advanced() -> None:
    """Its point is clipped to the bounds, and once went on as an answer of the continuous mode."""
    qp = d.QP([[1.0]], [-10.0], lb=[-1.0], ub=[1.0])
    network = d.ProjectionNetwork(rho=1e-3, primal_projection=False)
    solver = d.DNNSolver(network, advance_integrator=d.ExplicitEuler(substeps=1))
    statuses = [solver.advance(qp, 1e-2).status for _ in range(600)]
    assert statuses[0] is d.Status.ADVANCED
    assert d.Status.NOT_FINITE in statuses


def test_a_multiplier_that_is_not_active_limits_the_step_too() -> None:
    """P = 0.1 alone would allow 2 / 0.1: a passive multiplier, at rate one, grows from 2 on."""
    qp = d.QP([[0.1]], [0.0], lb=[-1.0], ub=[1.0])
    network = d.ProjectionNetwork()
    start = np.array([0.0, 0.01, 0.0])
    assert network.stable_step(qp, start) == 2.0
    for step, grows in ((1.9, False), (2.1, True)):
        *_, state = euler(network, qp, start, step, 100)
        assert bool(np.abs(state).max() > start.max()) is grows
    assert r"h < \min(2/\max(\pi_{\max}, 1), \pi_{\min}/s_{\max})" in PAGE


def test_a_clipped_joint_takes_its_column_out_and_an_active_multiplier_adds_a_row() -> None:
    rng = np.random.default_rng(0)
    A = rng.standard_normal((2, 4))
    ends = {"lb": -np.ones(4), "ub": np.ones(4)}
    qp = d.QP(np.eye(4), [-10.0, 0.0, 0.0, 0.0], A=A, b=np.zeros(2), **ends)
    rest = equilibrium(qp)
    assert np.flatnonzero(rest[6:]).tolist() == [0]  # the first joint, at its upper bound
    rest[6:] *= 0.5  # the projection carries the other half

    def eigenvalues(rows: Array) -> Array:
        m, n = rows.shape
        matrix = np.block([[-np.eye(n), -rows.T], [rows, np.zeros((m, m))]])
        return np.linalg.eigvals(matrix)

    for project, rows in ((True, A[:, 1:]), (False, np.vstack([A, np.eye(4)[:1]]))):
        network = d.ProjectionNetwork(primal_projection=project)
        found = np.linalg.eigvals(network.flow(qp).derivative(rest))
        expected = eigenvalues(rows)
        for value in expected:
            assert np.abs(found - value).min() < 1e-6
        others = [value for value in found if np.abs(expected - value).min() > 1e-6]
        np.testing.assert_allclose(others, 0.0 if project else -1.0, atol=1e-6)
