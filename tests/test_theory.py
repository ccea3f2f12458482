"""The statements of docs/theory.md that are marked (T)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from helpers_qp import bounds_as_rows, known_qp, network_rates
from helpers_simulation import heart, paper_robot, paper_start, run
from iiwa_dnn.networks.primal_dual import SHARE
from iiwa_dnn.results.metrics import position_error
from iiwa_dnn.studies.paper import MAX_ERROR

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


@pytest.mark.parametrize("active", [0, 2, 5])
def test_trajectories_never_come_apart(active: int) -> None:
    rng = np.random.default_rng(active)
    worst = -np.inf
    for _ in range(300):
        qp, _ = known_qp(rng, 5, 3, active, dependent=True)
        root = rng.standard_normal((5, 5))
        P = 0.501 * np.eye(5) + root @ root.T  # above I/2
        qp = d.QP(P, qp.q, A=qp.A, b=qp.b, lb=qp.lb, ub=qp.ub)
        size = UNPROJECTED.state_size(qp)
        # Near each other as well as far apart, and multipliers of either sign.
        one = 3.0 * rng.standard_normal(size)
        step = 10.0 ** rng.uniform(-3, 1) * rng.standard_normal(size)
        approach = step @ (UNPROJECTED.rates(qp, one + step) - UNPROJECTED.rates(qp, one))
        bound = -step[:5] @ (qp.P - 0.5 * np.eye(5)) @ step[:5]
        worst = max(worst, (approach - bound) / (step @ step))
    assert worst < 1e-10


def test_below_a_half_they_may() -> None:
    # One variable, one bound: P = 0.05 and the worst slope that the proof allows for.
    qp = d.QP([[0.05]], [0.0], lb=[-1.0], ub=[0.0])
    step = np.array([1.0, -0.5, 0.5])
    rest = np.array([-0.5, 0.0, 0.0])
    approach = step @ (UNPROJECTED.rates(qp, rest + step) - UNPROJECTED.rates(qp, rest))
    assert approach > 0.4


def variational(qp: d.QP) -> tuple[Array, Array]:
    """H and c of T(u) = H u + c for u = [x, y, z, u, l], the bounds as rows."""
    n = qp.q.size
    rows = np.vstack([qp.A, qp.G, np.eye(n), -np.eye(n)])
    none = np.zeros((len(rows), len(rows)))
    constant = np.concatenate([qp.q, qp.b, qp.h, qp.ub, -qp.lb])
    return np.block([[qp.P, rows.T], [-rows, none]]), constant


def equilibrium(qp: d.QP) -> Array:
    """The KKT point as a state of the paper's network."""
    found = d.DNNSolver(tol=1e-12).solve(qp)
    upper, lower = np.maximum(found.z_box, 0.0), np.maximum(-found.z_box, 0.0)
    return np.concatenate([found.x, found.y, found.z, upper, lower])


@pytest.mark.parametrize("dependent", [False, True], ids=["independent", "dependent"])
@pytest.mark.parametrize("network", [d.ProjectionNetwork(), d.OneLayerNetwork(corrected=False)])
def test_with_the_primal_projection_there_is_a_lyapunov_function(
    network: d.Network, dependent: bool
) -> None:
    """rho dV/dt <= -|x - r_x|_P^2 - |x - x*|_P^2 and V >= |u - u*|^2 / 2, anywhere in K."""
    rng = np.random.default_rng(3)
    for case in range(20):
        qp, _ = known_qp(rng, 5, 3, case % 6, dependent=dependent, inequalities=case % 4)
        size = network.state_size(qp)  # the one-layer network has no multipliers of bounds
        H, constant = (array[..., :size] for array in variational(qp))
        H = H[:size]
        if isinstance(network, d.OneLayerNetwork):
            alpha = SHARE / np.linalg.norm(H, 2)
            H, constant = alpha * H, alpha * constant
        rest = equilibrium(qp)[:size]
        lower = np.concatenate([qp.lb, np.full(3, -np.inf), np.zeros(size - 8)])
        upper = np.concatenate([qp.ub, np.full(size - 5, np.inf)])

        def distance(u: Array, qp: d.QP = qp, H: Array = H, c: Array = constant,
                     rest: Array = rest) -> float:  # fmt: skip
            moved = network.rates(qp, u)  # r - u
            gap = -(H @ u + c) @ moved - 0.5 * moved @ moved
            return float(gap + 0.5 * np.sum((u - rest) ** 2))

        for spread in 10.0 ** rng.uniform(-2.0, 2.0, 50):
            state = np.clip(rest + spread * rng.standard_normal(size), lower, upper)
            moved = network.rates(qp, state)
            gradient = H @ state + constant - H.T @ moved + moved + state - rest
            rate = gradient @ moved
            scale = 1.0 + np.sum((state - rest) ** 2) * (1.0 + np.linalg.norm(H, 2)) ** 3
            ahead, behind = (distance(state + step * moved) for step in (1e-5, -1e-5))
            assert rate == pytest.approx((ahead - behind) / 2e-5, abs=1e-4 * scale)
            parts = np.stack([moved[:5], state[:5] - rest[:5]])
            assert rate <= -np.sum(parts @ H[:5, :5] * parts) + 1e-9 * scale
            assert distance(state) >= 0.5 * np.sum((state - rest) ** 2) - 1e-9 * scale


@pytest.mark.parametrize("far", [10.0, 100.0, 200.0])
def test_settling_takes_as_long_as_the_multiplier_is_far_away(far: float) -> None:
    """P = A = 1, |x| <= 1: no exponential rate holds from everywhere, it would be log D."""
    qp = d.QP([[1.0]], [0.0], A=[[1.0]], b=[0.0], lb=[-1.0], ub=[1.0])
    states = euler(d.ProjectionNetwork(), qp, [0.0, -far, 0.0, 0.0], 0.01, round(100 * (far + 40)))
    away = [np.linalg.norm(state) > 1e-6 for state in states]
    assert 0.01 * np.flatnonzero(away)[-1] == pytest.approx(far + 28.0, abs=1.0)


@pytest.mark.parametrize("gain", [10.2, 1000.0])
def test_on_so3_a_gain_below_one_over_the_period_turns_the_error(gain: float) -> None:
    """e+ = (1 - gain dt) (e + dt/2 w x e) to second order: nothing is left at gain = 1 / dt."""
    dt = 1e-3
    rng = np.random.default_rng(5)
    for _ in range(20):
        error, speed = 1e-3 * rng.standard_normal(3), rng.standard_normal(3)
        turned = Rotation.from_rotvec(error)
        ahead = Rotation.from_rotvec(dt * speed) * turned
        rows = ahead.as_rotvec() / dt - (1.0 / dt - gain) * error
        left = (ahead * Rotation.from_rotvec(dt * rows).inv()).as_rotvec()
        expected = (1.0 - gain * dt) * (error + 0.5 * dt * np.cross(speed, error))
        np.testing.assert_allclose(left, expected, atol=2e-9 * np.linalg.norm(speed) ** 2)
        if gain < 1.0 / dt:
            assert np.abs(left - (1.0 - gain * dt) * error).max() > 1e-8


def test_without_cost_the_flow_circles() -> None:
    rng = np.random.default_rng(0)
    qp = d.QP(np.zeros((4, 4)), np.zeros(4), A=rng.standard_normal((4, 4)), b=np.zeros(4))
    for state in rng.standard_normal((20, d.ProjectionNetwork().state_size(qp))):
        state[8:] = 0.0  # the multipliers of bounds that are not there
        rates = UNPROJECTED.rates(qp, state)
        assert state @ rates == pytest.approx(0.0, abs=1e-12), "at constant distance"
        assert np.linalg.norm(rates) > 0.1


@pytest.mark.parametrize("weight", [0.2, 0.9])
def test_the_lag_of_a_continuous_run_follows_from_a_settled_one(weight: float) -> None:
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


@pytest.mark.parametrize("step", [0.1, 50.0])
def test_a_backward_euler_step_minimises_a_strongly_convex_function(step: float) -> None:
    rng = np.random.default_rng(7)
    for _ in range(5):
        qp, _ = known_qp(rng, 4, 2, 2)
        qp = d.QP(np.zeros((4, 4)), qp.q, A=qp.A, b=qp.b, lb=qp.lb, ub=qp.ub)  # even so
        state = rng.standard_normal(UNPROJECTED.state_size(qp))
        x, y, mu = state[:4], state[4:6], state[6:]
        omega, chi = bounds_as_rows(qp)

        def function(new: Array, qp: d.QP = qp, x: Array = x, y: Array = y, mu: Array = mu,
                     omega: Array = omega, chi: Array = chi) -> float:  # fmt: skip
            w = omega @ new - chi
            slope = mu / (1.0 + step)  # up to -slope, where the other one of phi begins
            phi = slope * w + 0.5 * step * np.maximum(w + slope, 0.0) ** 2
            distance = np.sum((new - x) ** 2) + np.sum((y + step * (qp.A @ new - qp.b)) ** 2)
            return float(distance / (2.0 * step) + qp.q @ new + phi.sum())

        # Strongly convex along any chord, with modulus 1/h.
        for a, b in rng.standard_normal((50, 2, 4)):
            sag = 0.5 * (function(a) + function(b)) - function(0.5 * (a + b))
            assert sag >= np.sum((a - b) ** 2) / (8.0 * step) - 1e-9
        new = state.copy()
        d.ImplicitEuler(step=step).advance(UNPROJECTED, qp, new, step)
        residual = new - state - step * network_rates(qp, new, False)
        assert np.abs(residual).max() < 1e-7 * max(1.0, step)
        best = minimize(function, x, method="BFGS", options={"gtol": 1e-9})
        assert function(new[:4]) <= best.fun + 1e-9
        np.testing.assert_allclose(new[:4], best.x, atol=1e-4)


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
    solvers = [d.DNNSolver(network, follower=d.ExplicitEuler(substeps=1)) for _ in range(2)]
    # The same within a control step: a posture far away, which the joints cannot reach at once.
    costs = [d.KineticEnergy(), d.CyclicMotion(home=(0.0,) * 7)]
    free = d.Scheme(costs, [], [d.JointLimits()])
    options = {"dt": 1e-2, "mode": "continuous", "solver": solvers[1]}
    controller = d.Controller(paper_robot(), free, **options)
    target = d.Target(paper_start().position, paper_start().rotation)
    for advance in (
        lambda k: solvers[0].advance(qp, 1e-2),
        lambda k: controller.step(PAPER_Q0, 1e-2 * k, target).solution,
    ):
        statuses = [advance(k).status for k in range(600)]
        assert statuses[0] is d.Status.ADVANCED
        assert d.Status.NOT_FINITE in statuses


def test_the_prediction_is_as_far_from_the_papers_first_row_as_is_said() -> None:
    predicted = [1e-5 * float(each) for each in re.findall(r"xi = 0\.\d: ([\d.]+)e-5 m", PAGE)]
    shares = np.abs(1.0 - np.array(predicted) / MAX_ERROR)
    assert np.sort((100.0 * shares).round()).tolist() == [1.0, 1.0, 15.0, 25.0, 27.0, 56.0, 58.0]


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
