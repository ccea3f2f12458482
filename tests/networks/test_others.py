"""The dual and the primal-dual network: their fields, equilibria, steps, and all integrators."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import iiwa_dnn
from benchmarks import programs
from helpers_qp import known_qp
from iiwa_dnn import (
    QP,
    DNNSolver,
    DualNetwork,
    ExplicitEuler,
    ImplicitEuler,
    InvalidInputError,
    PrimalDualNetwork,
    ProjectionNetwork,
    Status,
)
from iiwa_dnn.networks import ActivatedNetwork, Network, OneLayerNetwork, SimplifiedDualNetwork
from iiwa_dnn.studies.paper import START as PAPER_START

OTHERS = [DualNetwork(), PrimalDualNetwork()]
NETWORKS = [ProjectionNetwork(), ProjectionNetwork(primal_projection=False), *OTHERS]
ATLAS = [SimplifiedDualNetwork(), OneLayerNetwork(), OneLayerNetwork(corrected=False)]


def dual_rates(qp: QP, u: np.ndarray) -> np.ndarray:
    """Zhang, Wang and Xia's equations, row by row."""
    rows = [*qp.A, *qp.G, *np.eye(qp.q.size)]
    lower = [*qp.b, *[-np.inf] * qp.h.size, *qp.lb]
    upper = [*qp.b, *qp.h, *qp.ub]
    x = np.linalg.inv(qp.P) @ (sum(row * value for row, value in zip(rows, u, strict=True)) - qp.q)
    values = np.array([row @ x for row in rows])
    return np.minimum(np.maximum(values - u, lower), upper) - values


def primal_dual_rates(qp: QP, u: np.ndarray) -> np.ndarray:
    """Zhang, Ge and Lee's equations, part by part, with (I + H^T) e written out."""
    n, _, p = qp.sizes
    x, y, z = u[:n], u[n : n + p], u[n + p :]
    ex = np.clip(x - (qp.P @ x + qp.q + qp.A.T @ y + qp.G.T @ z), qp.lb, qp.ub) - x
    ey = qp.A @ x - qp.b
    ez = np.maximum(z + qp.G @ x - qp.h, 0.0) - z
    return np.concatenate(
        [ex + qp.P @ ex - qp.A.T @ ey - qp.G.T @ ez, ey + qp.A @ ex, ez + qp.G @ ex]
    )


@pytest.mark.parametrize(
    ("network", "reference"),
    [(OTHERS[0], dual_rates), (OTHERS[1], primal_dual_rates)],
    ids=["dual", "primal-dual"],
)
def test_rates_are_the_sources_equations(network: Network, reference: object) -> None:
    rng = np.random.default_rng(0)
    for case in range(30):
        qp, _ = known_qp(rng, 6, 2, case % 7, inequalities=case % 4)
        qp.lb[0], qp.ub[1] = -np.inf, np.inf
        state = 2.0 * rng.standard_normal(network.state_size(qp))
        np.testing.assert_allclose(network.rates(qp, state), reference(qp, state), atol=1e-10)


@pytest.mark.parametrize("network", [*NETWORKS, *ATLAS], ids=repr)
def test_jacobians_by_finite_differences(network: Network) -> None:
    rng = np.random.default_rng(1)
    for case in range(10):
        qp, _ = known_qp(rng, 5, 2, case % 6, inequalities=3)
        flow, state = network.flow(qp), 2.0 * rng.standard_normal(network.state_size(qp))
        jacobian = flow.jacobian(state)
        for i in range(state.size):
            step = np.zeros(state.size)
            step[i] = 1e-6
            column = (flow.rates(state + step) - flow.rates(state - step)) / 2e-6
            np.testing.assert_allclose(jacobian[:, i], column, rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("network", [*OTHERS, *ATLAS, ActivatedNetwork()], ids=repr)
def test_at_rest_exactly_at_kkt_points(network: Network) -> None:
    rng = np.random.default_rng(2)
    for case in range(20):
        qp, x = known_qp(rng, 6, 2, case % 7, inequalities=3)
        inner = network.network if isinstance(network, ActivatedNetwork) else network
        solver = DNNSolver(inner)
        solution = solver.solve(qp)
        assert solution.found
        assert np.abs(solution.x - x).max() < 1e-6
        assert np.abs(inner.rates(qp, solver.state)).max() < 1e-8
        moved = solver.state + 1e-2 * rng.standard_normal(solver.state.size)
        assert np.abs(network.rates(qp, moved)).max() > 1e-5


def test_the_primal_dual_step_decreases_the_distance_to_the_solution() -> None:
    rng = np.random.default_rng(4)
    network = PrimalDualNetwork()
    for case in range(10):
        qp, _ = known_qp(rng, 5, 2, case % 4, inequalities=2)
        solver = DNNSolver(network)
        assert solver.solve(qp).found
        rest, state = solver.state, solver.state + 3.0 * rng.standard_normal(solver.state.size)
        step = network.stable_step(qp)
        for _ in range(200):
            nearer = state + step * network.rates(qp, state)
            assert np.linalg.norm(nearer - rest) <= np.linalg.norm(state - rest) + 1e-12
            state = nearer


@pytest.mark.parametrize("network", OTHERS, ids=repr)
def test_every_network_settles(network: Network) -> None:
    rng = np.random.default_rng(5)
    for case in range(4):
        qp, x = known_qp(rng, 4, case % 2, case % 3, inequalities=case % 2)
        solver = DNNSolver(network, tol=1e-7)
        solution = iiwa_dnn.solve_problem(qp, solver=solver)
        assert solution.found
        assert solution.is_optimal(1e-7)
        np.testing.assert_allclose(solution.x, x, atol=1e-4)


MANY_BOUNDS = known_qp(np.random.default_rng(3), 5, 2, 2, inequalities=2)[0]


@cache
def end_of_flow(network: Network) -> np.ndarray:
    """The state after one unit of time from zero, by scipy."""
    start = np.zeros(network.state_size(MANY_BOUNDS))
    return solve_ivp(
        lambda _, state: network.rates(MANY_BOUNDS, state), (0.0, 1.0), start, method="DOP853",
        rtol=1e-11, atol=1e-13, max_step=0.02,
    ).y[:, -1]  # fmt: skip


@pytest.mark.parametrize("network", NETWORKS, ids=repr)
@pytest.mark.parametrize("integrator", [ExplicitEuler, ImplicitEuler])
def test_order_by_regression_against_scipy(network: Network, integrator: type) -> None:
    qp, duration = MANY_BOUNDS, 1.0
    start = np.zeros(network.state_size(qp))
    exact = end_of_flow(network)
    counts, errors = np.array([400, 800, 1600]), []
    for count in counts:
        if integrator is ExplicitEuler:
            tried = ExplicitEuler(substeps=int(count))
        else:
            tried = ImplicitEuler(step=duration / count)
        state = start.copy()
        tried.advance(network, qp, state, duration)
        errors.append(np.abs(state - exact).max())
    slope = -np.polyfit(np.log(counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(1.0, abs=0.2)


def test_singular_cost_settles_but_not_with_the_dual_network() -> None:
    qp = QP(np.diag([1.0, 0.0]), [0.0, 1.0], A=[[1.0, 1.0]], b=[1.0], lb=[-5.0, -5.0])
    solution = iiwa_dnn.solve_problem(qp, solver=DNNSolver(PrimalDualNetwork()))
    assert solution.found
    np.testing.assert_allclose(solution.x, [1.0, 0.0], atol=1e-7)
    with pytest.raises(InvalidInputError, match="singular") as caught:
        iiwa_dnn.solve_problem(qp, solver=DNNSolver(DualNetwork()))
    assert caught.value.argument == "P"


@pytest.mark.long
@pytest.mark.parametrize("network", OTHERS, ids=repr)
def test_random_programs_are_solved_or_not_claimed(network: Network) -> None:
    found, solver = 0, DNNSolver(network)
    for seed in range(40):
        qp, x = programs.strictly_convex(np.random.default_rng([7, seed]), None, 1e2)
        solver.reset()
        solution = solver.solve(qp)
        found += solution.found
        assert solution.certificate is None
        if solution.found:
            residuals = qp.residuals(solution.x, solution.y, solution.z, solution.z_box)
            assert residuals.largest <= 1e-9
            assert np.abs(solution.x - x).max() < 1e-5
    assert found >= 38


@pytest.mark.parametrize("network", OTHERS, ids=repr)
def test_contradictions_are_proven_with_every_network(network: Network) -> None:
    qp = QP(np.eye(3), np.ones(3), A=[[1.0, 1.0, 0.0], [2.0, 2.0, 0.0]], b=[0.0, 1.0])
    solver = DNNSolver(network)
    assert solver.solve(qp).status is Status.NONE_FEASIBLE_NEAR
    assert solver.solve(QP(qp.P, qp.q, A=qp.A, b=[0.0, 0.0])).found


def test_what_is_disturbed_is_x_of_the_state() -> None:
    qp, x = known_qp(np.random.default_rng(8), 4, 1, 1)
    solver = DNNSolver(PrimalDualNetwork())
    solver.solve(qp)
    solver.disturb(np.full(4, 0.5))
    np.testing.assert_allclose(solver.state[:4], x + 0.5, atol=1e-6)
    with pytest.raises(InvalidInputError, match="network"):
        DNNSolver(DualNetwork()).disturb(np.zeros(4))


@pytest.mark.parametrize("network", OTHERS, ids=repr)
@pytest.mark.parametrize("mode", ["converged", "continuous"])
def test_the_robot_runs_on_every_network(network: Network, mode: str) -> None:
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    conf = iiwa_dnn.Configuration(robot, PAPER_START)
    record = iiwa_dnn.simulate(
        robot, iiwa_dnn.DoubleIndicator(), iiwa_dnn.Heart().anchored(conf), PAPER_START,
        dt=1e-3, duration=0.03, mode=mode, solver=DNNSolver(network),
    )  # fmt: skip
    assert record.q.shape == (31, 7)
    if mode == "converged":
        assert iiwa_dnn.failures(record) == []
