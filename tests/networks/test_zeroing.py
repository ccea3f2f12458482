"""The zeroing network's theorems: rate, settle time, noise, moving programs, discrete formulas."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from helpers_kinematics import finite_difference
from helpers_qp import known_qp
from iiwa_dnn import QP, DNNSolver, ExplicitEuler, NoSolutionError
from iiwa_dnn.networks import ZeroingNetwork
from iiwa_dnn.networks.activations import (
    SIGN_BI_POWER,
    Activation,
    FixedTime,
    Linear,
    PowerSigmoid,
    PredefinedTime,
)
from iiwa_dnn.networks.kkt_residual import evaluate, system_size
from iiwa_dnn.networks.tracking import EULER, FIFD, TAYLOR3, TAYLOR4, TAYLOR5, TrackingSolver

SETTLING = [
    SIGN_BI_POWER, FixedTime(0.3, 1.0 / 0.3, 0.5, 0.5), FixedTime(), FixedTime(0.4, 1.7, 2.0, 0.5),
    PredefinedTime(), PredefinedTime(3.0, 0.3),
]  # fmt: skip
FORMULAS = [EULER, TAYLOR3, FIFD, TAYLOR4, TAYLOR5]
# Equality rows only: E is linear in the state, and the theorems hold entry by entry.
LINEAR = QP(np.diag([1.0, 2.0, 4.0]), [1.0, -1.0, 0.5], A=[[1.0, 1.0, 1.0]], b=[0.5])
MATRIX = np.block([[LINEAR.P, LINEAR.A.T], [LINEAR.A, np.zeros((1, 1))]])


def moving(t: float) -> QP:
    """A program with equality rows only: P, q, A and b are sinusoids of the time."""
    P = np.diag([2.0 + 0.5 * np.sin(t), 3.0, 2.0 + 0.5 * np.cos(2 * t)])
    q = [np.sin(t), np.cos(3 * t), np.sin(2 * t + 1)]
    A = [[1.0, np.cos(t), np.sin(t)]]
    return QP(P, q, A=A, b=[0.5 * np.cos(2 * t)])


def error_of(qp: QP, state: np.ndarray) -> np.ndarray:
    """The KKT residual of equality rows, written out."""
    x, y = state[: qp.q.size], state[qp.q.size :][: qp.b.size]
    return np.concatenate([qp.P @ x + qp.q + qp.A.T @ y, qp.A @ x - qp.b])


def integrate(network: ZeroingNetwork, qp: QP, start: np.ndarray, time: float) -> np.ndarray:
    rates = network.flow(qp).rates
    options = {"rtol": 1e-9, "atol": 1e-13, "method": "LSODA"}
    return solve_ivp(lambda t, s: rates(s), (0, time), start, **options).y[:, -1]


@pytest.mark.parametrize("activation", [*SETTLING, Linear(), PowerSigmoid()], ids=repr)
def test_activations_are_odd_and_increasing(activation: Activation) -> None:
    e = np.linspace(-3.0, 3.0, 601)
    value = activation(e)
    np.testing.assert_allclose(value, -value[::-1], atol=1e-12)
    assert (np.diff(value) > 0.0).all()
    assert value[300] == 0.0


@pytest.mark.parametrize("activation", [Linear(), PowerSigmoid()], ids=repr)
def test_decays_at_the_rate_gamma(activation: Activation) -> None:
    start = np.array([0.3, -0.2, 0.1, 0.4])
    network = ZeroingNetwork(activation=activation)
    before = error_of(LINEAR, start)
    after = error_of(LINEAR, integrate(network, LINEAR, start, 2.0))
    if isinstance(activation, Linear):
        np.testing.assert_allclose(after, before * np.exp(-2.0), rtol=1e-5)
    else:
        assert (np.abs(after) < np.abs(before) * np.exp(-2.0)).all()


@pytest.mark.parametrize("case", range(10))
@pytest.mark.parametrize("form", ["projected", "smooth"])
def test_derivatives_and_drift_by_finite_differences(form: str, case: int) -> None:
    rng = np.random.default_rng([1, case])
    (qp, _), (other, _) = (known_qp(rng, 5, 2, case % 5, inequalities=3) for _ in range(2))
    qp.lb[0], other.lb[0] = -np.inf, -np.inf
    move = np.nan_to_num(other.data, neginf=0.0) - np.nan_to_num(qp.data, neginf=0.0)
    state = rng.standard_normal(system_size(qp, form))
    _, drift, matrix = evaluate(qp, form, state, QP.from_data(move, qp.sizes))
    by_state = finite_difference(lambda s: evaluate(qp, form, s).error, state)
    np.testing.assert_allclose(matrix, by_state, atol=1e-5)

    def moved(t: np.ndarray) -> np.ndarray:
        return evaluate(QP.from_data(qp.data + t * move, qp.sizes), form, state).error

    np.testing.assert_allclose(drift, finite_difference(moved, [0.0])[:, 0], atol=1e-5)


@pytest.mark.parametrize("form", ["projected", "smooth"])
def test_converges_with_bounds_and_inequalities(form: str) -> None:
    rng = np.random.default_rng(2)
    for case in range(5):
        qp, x = known_qp(rng, 6, 2, case, inequalities=3)
        # The projected form is Newton's method on a system with kinks: it needs a start nearby.
        network, known = ZeroingNetwork(form=form), DNNSolver().solve(qp)
        state = np.zeros(network.state_size(qp))
        if form == "projected":
            state += known.point[: state.size] + 1e-3 * rng.standard_normal(state.size)
        ExplicitEuler(substeps=200).advance(network, qp, state, 100.0)
        point = np.empty(known.point.size)
        assert max(network.flow(qp).read(qp, state, point)) < 1e-5
        assert np.abs(point[: x.size] - x).max() < 1e-3


def disturbed_error(integral: float, noise: object, time: float) -> np.ndarray:
    """Largest error at the end, where W ds/dt gets a noise of the time [rho]."""
    network = ZeroingNetwork(integral=integral)
    rates = network.flow(LINEAR).rates

    def disturbed(t: float, s: np.ndarray) -> np.ndarray:
        result = rates(s)
        result[:4] += np.linalg.solve(MATRIX, noise(t))
        return result

    start = np.zeros(network.state_size(LINEAR))
    end = solve_ivp(disturbed, (0, time), start, rtol=1e-9, atol=1e-12).y[:, -1]
    return error_of(LINEAR, end)


def test_the_integral_rejects_constant_noise_and_bounds_that_of_a_ramp() -> None:
    direction = np.array([0.5, -1.0, 0.2, 0.3])
    plain, kappa = disturbed_error(0.0, lambda t: direction, 40.0), 0.5
    np.testing.assert_allclose(plain, direction, rtol=1e-6)  # noise / gamma stays
    assert np.abs(disturbed_error(kappa, lambda t: direction, 60.0)).max() < 1e-6
    ramp = disturbed_error(kappa, lambda t: direction * t, 80.0)
    np.testing.assert_allclose(ramp, direction / kappa, rtol=1e-5)
    growing = disturbed_error(0.0, lambda t: direction * t, 80.0)
    np.testing.assert_allclose(growing, 79.0 * direction, rtol=1e-3)


def test_a_growing_gain_is_faster_than_any_rate() -> None:
    network, start = ZeroingNetwork(growth=2.0), np.array([0.3, -0.2, 0.1, 0.4, 0.0])
    end = integrate(network, LINEAR, start, 3.0)
    assert end[-1] == pytest.approx(3.0)
    # The integral of the gain 1 + t^2 from 0 to 3 is 12.
    expected = error_of(LINEAR, start) * np.exp(-12.0)
    np.testing.assert_allclose(error_of(LINEAR, end), expected, rtol=1e-2, atol=1e-10)


@pytest.mark.parametrize("formula", FORMULAS)
def test_formulas_are_consistent_stable_and_of_their_order(formula) -> None:
    nodes = -np.arange(len(formula.past))
    for power in range(formula.order):  # exact for polynomials below the order
        value = formula.past @ nodes.astype(float) ** power
        assert value + formula.rate * (power == 1) == pytest.approx(1.0)

    def radius(h: float) -> float:
        polynomial = np.array([1.0, *(-a for a in formula.past)])
        polynomial[1] += formula.rate * h
        return np.abs(np.roots(polynomial)).max()

    roots = np.sort(np.abs(np.roots([1.0, *(-a for a in formula.past)])))
    assert roots[-1] == pytest.approx(1.0)
    assert formula.limit > 0.0
    assert (roots[:-1] < 0.95).all()
    assert radius(0.99 * formula.limit) < 1.0
    assert radius(1.01 * formula.limit) > 1.0


@pytest.mark.long
@pytest.mark.parametrize("formula", FORMULAS)
def test_the_residual_is_of_the_declared_order(formula) -> None:
    periods, largest = [], []
    for count in (250, 400, 640):
        tau = 2.0 / count
        network = ZeroingNetwork(rho=tau / (0.4 * formula.limit))
        solver, worst = TrackingSolver(network, formula=formula), 0.0
        for k in range(count):
            solver.advance(moving(k * tau), tau)
            if k > 0.75 * count:
                worst = max(worst, np.abs(error_of(moving(k * tau), solver.state)).max())
        periods.append(tau)
        largest.append(worst)
    slope = np.polyfit(np.log(periods), np.log(largest), 1)[0]
    assert slope == pytest.approx(formula.order, abs=0.1)


def test_a_moving_program_leaves_no_error_where_another_network_lags() -> None:
    network = ZeroingNetwork(rho=0.05)
    still = type("FixedPose", (ZeroingNetwork,), {"flow": lambda s, q, r=None: network.flow(q)})
    solver, blind = TrackingSolver(network), TrackingSolver(still(rho=0.05))
    for k in range(1000):
        for one in (solver, blind):
            one.advance(moving(1e-3 * k), 1e-3)
    last = moving(1e-3 * 999)
    ours, lag = (np.abs(error_of(last, one.state)).max() for one in (solver, blind))
    assert ours < 1e-3
    assert lag > 100.0 * ours


def test_a_singular_program_is_told() -> None:
    network, singular = ZeroingNetwork(), QP(np.zeros((2, 2)), [1.0, 1.0])
    with pytest.raises(NoSolutionError, match="is singular"):
        network.rates(singular, np.zeros(2))
