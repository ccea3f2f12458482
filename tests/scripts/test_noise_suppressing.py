"""The third paper's programs: their claims, and each slip in docs/noise_suppressing.md."""

import numpy as np
import pytest
from scipy.linalg import solve_discrete_lyapunov

from iiwa_dnn import QP
from iiwa_dnn.networks import Network, NoiseSuppressingNetwork, ZeroingNetwork
from iiwa_dnn.networks.tracking import EULER
from scripts.noise_suppressing import GAIN, NOISE, Arm, Rates, dual, program, run, suppressing

STILL = QP(np.diag([1.0, 2.0]), [0.3, -0.2], A=[[1.0, 2.0]], b=[0.4])
SHARE = 0.4


def test_the_position_keeps_the_noise_over_both_gains() -> None:
    """5e-6 m along each axis and 5e-6 rad in the joint that no row moves, for ever."""
    _, q, errors = run(suppressing, NOISE, 0.1)
    left = NOISE / GAIN**2
    np.testing.assert_allclose(errors[1:], np.sqrt(3.0) * left, rtol=1e-5)
    assert q[-1, 5] - q[0, 5] == pytest.approx(left, rel=1e-4)


def test_without_position_feedback_an_error_stays() -> None:
    def pushed(arm: Arm, noise: float) -> tuple[np.ndarray, Rates]:
        state, rates = suppressing(arm, noise)
        return state + 1e-4 * np.eye(state.size)[0], rates

    _, _, errors = run(pushed, 0.0, 0.1)
    assert errors[0] > 5e-5
    np.testing.assert_allclose(errors, errors[0], rtol=1e-3)


def test_the_dual_networks_noise_is_a_thousand_times_the_others() -> None:
    """The program adds 5 inside of the bracket that gamma multiplies."""
    arm = Arm()
    state, plain = dual(arm, 0.0)
    shown = dual(arm, GAIN * NOISE)[1](0.0, state) - plain(0.0, state)
    np.testing.assert_allclose(shown[6:], GAIN * NOISE)
    ends = [run(dual, noise, 0.1)[2][-1] for noise in (0.0, NOISE, GAIN * NOISE)]
    assert ends[0] < ends[1] < 3.0 * ends[0]
    assert ends[2] > 1000.0 * ends[0]


def test_the_program_has_three_equalities_and_twelve_inequalities() -> None:
    """Their comments have the numbers the other way round."""
    qp, _ = program(Arm(), Arm().start, np.zeros(6), 0.3)
    assert qp.b.size == 3
    assert np.isfinite(np.concatenate([qp.lb, qp.ub])).sum() == 12


def test_the_curve_with_the_rate_of_b_is_not_the_residual() -> None:
    """Where the rows hold, A x - db/dt of `error_model.m` is far from zero."""
    qp, rate = program(Arm(), Arm().start, np.zeros(6), 0.3)
    x = np.linalg.lstsq(qp.A, qp.b, rcond=None)[0]
    assert np.abs(qp.A @ x - qp.b).max() < 1e-15
    assert np.abs(qp.A @ x - rate.b).max() > 0.01


def settled(network: ZeroingNetwork, qp: QP) -> np.ndarray:
    """The state of a network at rest, from zero."""
    state = network.initial_state(qp)
    rates = network.flow(qp).rates
    for _ in range(4000):
        state = state + 2e-3 * rates(state)
    return state


def test_a_kkt_point_of_an_indefinite_program_is_followed_and_no_minimum() -> None:
    """The Hessian of the small program has the entries -2 t and -20; here t = 1."""
    qp = QP(np.diag([-2.0, -20.0]), [1.0, 0.0], A=[[1.0, 1.0]], b=[1.0])
    x = settled(NoiseSuppressingNetwork(integral=30.0, proportional=20.0), qp)[:2]
    along = np.array([1.0, -1.0])
    assert np.abs(qp.A @ x - qp.b).max() < 1e-9
    assert abs(along @ (qp.P @ x + qp.q)) < 1e-9
    costs = [0.5 * v @ qp.P @ v + qp.q @ v for v in (x - 0.1 * along, x, x + 0.1 * along)]
    assert max(costs) == costs[1]


def test_the_integral_does_it_and_not_the_bounds_of_the_activations() -> None:
    """A bound of 1e9 is none: the noise is taken out as well, and the rest is the same."""
    gains = {"form": "projected", "integral": 30.0, "proportional": 20.0, "noise": NOISE}
    networks = [NoiseSuppressingNetwork(bound=bound, **gains) for bound in (1.0, 1e9)]
    rests = [settled(network, STILL) for network in networks]
    np.testing.assert_allclose(rests[0], rests[1], atol=1e-12)
    assert np.abs(networks[1].rates(STILL, rests[1])[3:]).max() < 1e-9  # E, the integrals' rate


def measured(network: Network, noise: np.ndarray) -> float:
    """RMS residual A x - b under noise (steps, 3) on E in each Euler step of a share."""
    W = np.block([[STILL.P, STILL.A.T], [STILL.A, np.zeros((1, 1))]])
    rates = network.flow(STILL).rates
    state = np.zeros(network.state_size(STILL))
    errors = []
    for pushed in noise:
        state = state + SHARE * EULER.limit * rates(state)
        state[:3] += np.linalg.solve(W, pushed)
        errors.append(W @ state[:3] + [*STILL.q, *-STILL.b])
    return float(np.sqrt(np.mean(np.square(errors[50:]))))


def test_white_noise_is_amplified_by_18_percent() -> None:
    """Both at 0.4 of the limit: the root of 25 / 18, by Lyapunov's equation and in a run."""
    h = SHARE * EULER.limit
    step = np.array([[1.0 - 2.0 * h, -h], [h, 1.0]])  # of the error and its integral
    ours = solve_discrete_lyapunov(step, np.diag([1.0, 0.0]))[0, 0]
    linear = 1.0 / (1.0 - (1.0 - h) ** 2)
    assert np.sqrt(ours / linear) == pytest.approx(np.sqrt(25.0 / 18.0))
    noise = 1e-3 * np.random.default_rng(0).standard_normal((6000, 3))
    found = [
        measured(network, noise)
        for network in (NoiseSuppressingNetwork(form="projected"), ZeroingNetwork())
    ]
    assert found[0] / found[1] == pytest.approx(np.sqrt(25.0 / 18.0), rel=0.02)
