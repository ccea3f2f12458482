"""The paper's network: its field, its equilibria and its stability bound."""

import numpy as np
import pytest

from helpers_qp import known_qp, network_rates
from iiwa_dnn import QP, DNNSolver, InvalidInputError, ProjectionNetwork


@pytest.mark.parametrize("project", [True, False])
def test_rates_are_the_papers_equations(project: bool) -> None:
    rng = np.random.default_rng(0)
    network = ProjectionNetwork(primal_projection=project)
    for case in range(50):
        qp, _ = known_qp(rng, 7, 4, case % 8, inequalities=case % 4)
        state = 3.0 * rng.standard_normal(network.state_size(qp))
        np.testing.assert_allclose(
            network.rates(qp, state), network_rates(qp, state, project), rtol=1e-12, atol=1e-12
        )


def test_seven_joints_and_seven_rows_make_28_states() -> None:
    qp = QP(np.eye(7), np.zeros(7), A=np.ones((7, 7)), b=np.ones(7))
    assert ProjectionNetwork().state_size(qp) == 28
    assert (ProjectionNetwork().initial_state(qp) == np.zeros(28)).all()


def test_infinite_bounds_make_no_nan() -> None:
    qp = QP(np.eye(2), np.ones(2), lb=[-np.inf, 0.0], ub=[np.inf, np.inf])
    network = ProjectionNetwork()
    rates = network.rates(qp, np.ones(network.state_size(qp)))
    assert np.isfinite(rates).all()


def test_at_rest_exactly_at_kkt_points() -> None:
    rng = np.random.default_rng(1)
    network = ProjectionNetwork()
    for case in range(30):
        qp, x = known_qp(rng, 6, 2, case % 7, inequalities=3)
        solver = DNNSolver(network)
        assert solver.solve(qp).found
        # The solver's last state, on the full field that it did not integrate.
        assert np.abs(network_rates(qp, solver.state)).max() < 1e-8
        moved = solver.state
        moved[: x.size] += 1e-3
        assert np.abs(network_rates(qp, moved)).max() > 1e-5


def test_stable_step_separates_decay_from_growth() -> None:
    rng = np.random.default_rng(2)
    for _ in range(50):
        # Idle bounds: the network is linear, so numpy's eigenvalues say what is stable.
        n, p = 7, 4
        root = rng.standard_normal((n, n))
        P, A = root @ root.T / n + 0.2 * np.eye(n), rng.standard_normal((p, n))
        qp = QP(P, np.zeros(n), A=A, b=np.zeros(p))
        linear = np.block([[-P, -A.T], [A, np.zeros((p, p))]])
        step = ProjectionNetwork().stable_step(qp)
        spread = np.abs(np.linalg.eigvals(np.eye(n + p) + 0.999 * step * linear))
        assert spread.max() < 1.0


def test_stable_step_is_sharp_where_the_paper_stands() -> None:
    # With P = I the largest singular value decides: h sigma^2 < 1 (PAPER's own analysis).
    A = np.diag([2.54, 1.0, 0.2, 0.0])[:3]
    qp = QP(np.eye(4), np.zeros(4), A=A, b=np.zeros(3))
    assert ProjectionNetwork().stable_step(qp) == pytest.approx(1.0 / 2.54**2, rel=1e-12)
    linear = np.block([[-np.eye(4), -A.T], [A, np.zeros((3, 3))]])
    for factor, stable in ((0.99, True), (1.01, False)):
        step = factor / 2.54**2
        largest = np.abs(np.linalg.eigvals(np.eye(7) + step * linear)).max()
        assert (largest < 1.0) == stable


def test_stable_step_counts_active_rows_only_where_a_state_is_given() -> None:
    qp = QP(np.eye(2), np.zeros(2), A=[[1.0, 0.0]], b=[0.0], lb=[-1.0, -1.0], ub=[1.0, 1.0])
    network = ProjectionNetwork()
    at_rest = network.initial_state(qp)
    assert network.stable_step(qp, at_rest) == pytest.approx(1.0)
    assert network.stable_step(qp) == pytest.approx(0.5)


def test_stable_step_is_zero_where_the_cost_is_singular() -> None:
    qp = QP(np.diag([1.0, 0.0]), np.zeros(2), A=[[1.0, 1.0]], b=[0.0])
    assert ProjectionNetwork().stable_step(qp) == 0.0


@pytest.mark.parametrize("rho", [0.0, -1.0, float("nan"), float("inf")])
def test_time_constant_must_be_positive(rho: float) -> None:
    with pytest.raises(InvalidInputError, match="rho"):
        ProjectionNetwork(rho=rho)
