"""Further networks for a program that stands still: fields, equilibria, and their theorems."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from helpers_qp import known_qp
from iiwa_dnn import (
    QP,
    DNNSolver,
    DualNetwork,
    ExplicitEuler,
    ImplicitEuler,
    InvalidInputError,
    PrimalDualNetwork,
)
from iiwa_dnn.networks import (
    ActivatedNetwork,
    GradientNetwork,
    Network,
    OneLayerNetwork,
    SimplifiedDualNetwork,
    ZeroingNetwork,
)
from iiwa_dnn.networks.activations import Activation, FixedTime, PredefinedTime, SignBiPower
from iiwa_dnn.networks.admm import AdmmSolver
from iiwa_dnn.networks.kkt_system import KktSystem
from iiwa_dnn.networks.primal_dual import variational

ACTIVATIONS = [SignBiPower(), FixedTime(), PredefinedTime(2.0)]


def test_the_simplified_dual_field_is_the_sources() -> None:
    rng, network = np.random.default_rng(1), SimplifiedDualNetwork()
    for case in range(10):
        qp, _ = known_qp(rng, 6, 2, case % 7, inequalities=case % 4)
        u = rng.standard_normal(network.state_size(qp))
        # x of a state minimises the cost less u^T E x on the equalities: one linear system.
        rows = np.vstack([qp.G, np.eye(6)])
        whole = np.block([[qp.P, qp.A.T], [qp.A, np.zeros((2, 2))]])
        x = np.linalg.solve(whole, np.concatenate([rows.T @ u - qp.q, qp.b]))[:6]
        lower, upper = np.r_[np.full(qp.h.size, -np.inf), qp.lb], np.r_[qp.h, qp.ub]
        expected = np.clip(rows @ x - u, lower, upper) - rows @ x
        np.testing.assert_allclose(network.rates(qp, u), expected, atol=1e-9)


@pytest.mark.parametrize("network", [OneLayerNetwork(), OneLayerNetwork(share=0.8)], ids=repr)
def test_the_corrected_one_layer_network_gets_nearer_as_proved(network: OneLayerNetwork) -> None:
    rng = np.random.default_rng(2)
    for case in range(10):
        qp, _ = known_qp(rng, 5, 2, case % 4, inequalities=2)
        solver = DNNSolver(PrimalDualNetwork())
        assert solver.solve(qp).found
        rest = solver.state
        H, constant, lower, upper = variational(qp)
        alpha = network.share / np.linalg.norm(H, 2)
        for _ in range(20):
            u = rest + 3.0 * rng.standard_normal(rest.size)
            residual = np.clip(u - alpha * (H @ u + constant), lower, upper) - u
            rates = network.rates(qp, u)
            assert (u - rest) @ rates <= -(1 - network.share) * residual @ residual + 1e-9
            step = u + network.stable_step(qp) * rates
            assert np.linalg.norm(step - rest) <= np.linalg.norm(u - rest) + 1e-9


def test_the_gradient_network_descends_at_the_smallest_eigenvalue() -> None:
    qp = QP(np.diag([1.0, 2.0, 4.0]), [1.0, -1.0, 0.5], A=[[1.0, 1.0, 1.0]], b=[0.5])
    network, start = GradientNetwork(), np.array([0.3, -0.2, 0.1, 0.4])
    W = np.block([[qp.P, qp.A.T], [qp.A, np.zeros((1, 1))]])
    rest = np.linalg.solve(W, np.concatenate([-qp.q, qp.b]))
    values, vectors = np.linalg.eigh(W @ W)
    rates = network.flow(qp).rates
    end = solve_ivp(lambda t, s: rates(s), (0, 3.0), start, rtol=1e-9, atol=1e-12).y[:, -1]
    expected = vectors @ (np.exp(-3.0 * values) * (vectors.T @ (start - rest)))
    np.testing.assert_allclose(end - rest, expected, atol=1e-6)


def test_the_gradient_network_lowers_its_energy_and_rests_at_kkt_points() -> None:
    rng, network = np.random.default_rng(3), GradientNetwork(form="smooth")
    for case in range(3):
        qp, _ = known_qp(rng, 4, 1, case, inequalities=2)
        state = np.zeros(network.state_size(qp))
        ExplicitEuler(substeps=200).advance(ZeroingNetwork(form="smooth"), qp, state, 100.0)
        assert np.abs(network.rates(qp, state)).max() < 1e-4
        system, energy = KktSystem(qp, "smooth"), np.inf
        state = state + rng.standard_normal(state.size)
        for _ in range(200):
            error, _ = system.evaluate(state)
            assert error @ error < energy
            energy = error @ error
            state = state + 0.4 * network.stable_step(qp, state) * network.rates(qp, state)


@pytest.mark.parametrize("activation", ACTIVATIONS, ids=repr)
def test_activated_networks_settle_below_their_bound_from_1000_starts(
    activation: Activation,
) -> None:
    """Equality rows only, where the two constants of the bound are known."""
    rng = np.random.default_rng(4)
    qp = QP(np.diag([1.0, 1.5, 2.0]), [1.0, -1.0, 0.5], A=[[1.0, 1.0, 1.0]], b=[0.5])
    H = variational(qp)[0]
    network = ActivatedNetwork(network=PrimalDualNetwork(), activation=activation)
    rest = -np.linalg.solve(H, np.concatenate([qp.q, qp.b]))
    field = (np.eye(4) + H.T) @ H
    kappa, c = np.linalg.svd(field)[1][-1], 1.0 / np.linalg.norm(np.eye(4) + H, 2) ** 2
    away = 10.0 ** rng.uniform(-1, 1, (1000, 1)) * rng.standard_normal((1000, 4))
    for start in away[:20]:
        F = -field @ start
        scaled = activation(np.array([np.linalg.norm(F)])) * F / np.linalg.norm(F)
        np.testing.assert_allclose(network.rates(qp, rest + start), scaled, rtol=1e-9, atol=1e-9)
    bounds = [activation.settle_time(kappa * w) for w in np.linalg.norm(away, axis=1)]
    # The trajectories are those of the network inside, run through at another speed.
    time, stable = np.zeros(1000), 0.1 * network.network.stable_step(qp)
    halfway = np.eye(4) - 0.5 * stable * field.T
    while (left := (size := np.linalg.norm(away @ field.T, axis=1)) > 1e-6).any():
        time += np.where(left, stable * size / activation(size), 0.0)
        away = away - stable * away @ halfway @ field.T
    assert (time <= np.array(bounds) / (c * kappa**2)).all()


def test_an_activated_network_has_the_direction_of_the_one_inside() -> None:
    rng = np.random.default_rng(5)
    qp, _ = known_qp(rng, 5, 2, 2, inequalities=2)
    network = ActivatedNetwork(activation=FixedTime())
    state = rng.standard_normal(network.state_size(qp))
    inner, ours = DualNetwork().rates(qp, state), network.rates(qp, state)
    size = np.linalg.norm(inner)
    np.testing.assert_allclose(ours, inner / size * (size**0.5 + size**2), rtol=1e-12)
    base = DualNetwork().stable_step(qp)
    assert network.stable_step(qp, state) == pytest.approx(base / (size**-0.5 + size))
    assert network.stable_step(qp) == 0.0
    assert not network.carries_x
    assert network.settings()["activation"]["name"] == "FixedTime"


@pytest.mark.parametrize(
    "network",
    [
        PrimalDualNetwork(), OneLayerNetwork(), OneLayerNetwork(corrected=False), DualNetwork(),
        SimplifiedDualNetwork(), ActivatedNetwork(), ActivatedNetwork(activation=FixedTime()),
    ],
    ids=repr,
)  # fmt: skip
def test_compiled_steps_are_those_of_the_rates(network: Network) -> None:
    rng = np.random.default_rng(7)
    qp, _ = known_qp(rng, 5, 2, 2, inequalities=2)
    state = rng.standard_normal(network.state_size(qp))
    expected = state.copy()
    rates = network.flow(qp).rates
    for _ in range(7):
        expected += 0.01 * rates(expected)
    assert ExplicitEuler(substeps=7).advance(network, qp, state, 0.07) == 7
    np.testing.assert_allclose(state, expected, rtol=1e-12)
    assert DNNSolver(network).compiled_answer(qp.sizes, 0.1) is None  # no program is set up there


def test_the_yardstick_reaches_the_solution_and_starts_warm() -> None:
    rng = np.random.default_rng(6)
    qp, x = known_qp(rng, 6, 2, 2, inequalities=3)
    solver = AdmmSolver(substeps=50)
    first = np.abs(solver.advance(qp, 1e-3).x - x).max()
    for _ in range(100):
        last = np.abs(solver.advance(qp, 1e-3).x - x).max()
    assert last < 1e-4 < 0.01 < first
    solver.reset()
    assert np.abs(solver.advance(qp, 1e-3).x - x).max() == pytest.approx(first)


def test_wrong_parameters_and_programs_are_named() -> None:
    with pytest.raises(InvalidInputError, match="share"):
        OneLayerNetwork(share=1.0)
    with pytest.raises(InvalidInputError, match="P: is singular"):
        DNNSolver(SimplifiedDualNetwork(), settler=ImplicitEuler()).solve(
            QP(np.zeros((2, 2)), [1.0, 1.0], lb=[0.0, 0.0])
        )
