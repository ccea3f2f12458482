"""All networks: fields, derivatives, equilibria and steps, against their sources' equations."""

from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
import osqp
import pytest
from scipy import sparse
from scipy.integrate import solve_ivp

import iiwa_dnn as d
from helpers_kinematics import finite_difference
from helpers_qp import known_qp, network_rates
from iiwa_dnn.networks import Flow, Network, NoiseSuppressingNetwork
from iiwa_dnn.networks.activations import FixedTime
from iiwa_dnn.networks.admm import AdmmIteration
from iiwa_dnn.networks.primal_dual import variational
from iiwa_dnn.networks.tracking import TrackingSolver

Array = np.ndarray


def dual_rates(qp: d.QP, u: Array) -> Array:
    """Zhang, Wang and Xia's equations, row by row."""
    rows = [*qp.A, *qp.G, *np.eye(qp.q.size)]
    lower = [*qp.b, *[-np.inf] * qp.h.size, *qp.lb]
    upper = [*qp.b, *qp.h, *qp.ub]
    x = np.linalg.inv(qp.P) @ (sum(row * value for row, value in zip(rows, u, strict=True)) - qp.q)
    values = np.array([row @ x for row in rows])
    return np.minimum(np.maximum(values - u, lower), upper) - values


def simplified_dual_rates(qp: d.QP, u: Array) -> Array:
    """x of a state minimises the cost less u^T E x on the equalities: one linear system."""
    n, m, p = qp.sizes
    rows = np.vstack([qp.G, np.eye(n)])
    whole = np.block([[qp.P, qp.A.T], [qp.A, np.zeros((p, p))]])
    x = np.linalg.solve(whole, np.concatenate([rows.T @ u - qp.q, qp.b]))[:n]
    lower, upper = np.r_[np.full(m, -np.inf), qp.lb], np.r_[qp.h, qp.ub]
    return np.clip(rows @ x - u, lower, upper) - rows @ x


def products(qp: d.QP, u: Array) -> tuple[Array, Array, Array]:
    """H u + c of the variational inequality, part by part."""
    n, _, p = qp.sizes
    x, y, z = u[:n], u[n : n + p], u[n + p :]
    return qp.P @ x + qp.q + qp.A.T @ y + qp.G.T @ z, qp.b - qp.A @ x, qp.h - qp.G @ x


def projected(qp: d.QP, u: Array, alpha: float) -> Array:
    n, _, p = qp.sizes
    aim = u - alpha * np.concatenate(products(qp, u))
    return np.r_[np.clip(aim[:n], qp.lb, qp.ub), aim[n : n + p], np.maximum(aim[n + p :], 0.0)]


def primal_dual_rates(qp: d.QP, u: Array) -> Array:
    """Zhang, Ge and Lee's equations, with (I + H^T) e written out."""
    n, _, p = qp.sizes
    e = projected(qp, u, 1.0) - u
    x, y, z = e[:n], e[n : n + p], e[n + p :]
    turned = [qp.P @ x - qp.A.T @ y - qp.G.T @ z, qp.A @ x, qp.G @ x]
    return e + np.concatenate(turned)


def one_layer_rates(qp: d.QP, u: Array, corrected: bool = True) -> Array:
    """Xia and Wang's equation, and Tseng's correction."""
    alpha = 0.5 / np.linalg.norm(variational(qp)[0], 2)
    v = projected(qp, u, alpha)
    change = np.concatenate(products(qp, u)) - np.concatenate(products(qp, v))
    return v - u + (alpha * change if corrected else 0.0)


def activated_rates(qp: d.QP, u: Array) -> Array:
    inner = dual_rates(qp, u)
    size = np.linalg.norm(inner)
    return inner / size * (size**0.5 + size**2)


SOURCES: dict[str, tuple[d.Network, Callable[..., Array]]] = {
    "projection": (d.ProjectionNetwork(), network_rates),
    "free": (
        d.ProjectionNetwork(primal_projection=False),
        lambda qp, u: network_rates(qp, u, project=False),
    ),
    "dual": (d.DualNetwork(), dual_rates),
    "simplified dual": (d.SimplifiedDualNetwork(), simplified_dual_rates),
    "primal-dual": (d.PrimalDualNetwork(), primal_dual_rates),
    "one-layer": (d.OneLayerNetwork(), one_layer_rates),
    "uncorrected": (
        d.OneLayerNetwork(corrected=False),
        lambda qp, u: one_layer_rates(qp, u, corrected=False),
    ),
    "activated": (d.ActivatedNetwork(activation=FixedTime()), activated_rates),
}
OTHERS = ["dual", "primal-dual"]


@pytest.fixture(params=SOURCES)
def name(request: pytest.FixtureRequest) -> str:
    return request.param


def test_rates_are_the_sources_equations(name: str) -> None:
    rng, (network, reference) = np.random.default_rng(0), SOURCES[name]
    for case in range(20):
        qp, _ = known_qp(rng, 6, 2, case % 7, inequalities=case % 4)
        qp.lb[0], qp.ub[1] = -np.inf, np.inf
        state = 2.0 * rng.standard_normal(network.state_size(qp))
        np.testing.assert_allclose(network.rates(qp, state), reference(qp, state), atol=1e-9)


def test_derivatives_by_finite_differences(name: str) -> None:
    rng, (network, _) = np.random.default_rng(1), SOURCES[name]
    network = getattr(network, "network", network)  # of an activated one: at a constant speed
    for case in range(8):
        qp, _ = known_qp(rng, 5, 2, case % 6, inequalities=3)
        flow, state = network.flow(qp), 2.0 * rng.standard_normal(network.state_size(qp))
        expected = finite_difference(flow.rates, state)
        np.testing.assert_allclose(flow.derivative(state), expected, rtol=1e-5, atol=1e-6)


def test_at_rest_exactly_at_kkt_points(name: str) -> None:
    rng, (network, reference) = np.random.default_rng(2), SOURCES[name]
    solver = d.DNNSolver(getattr(network, "network", network))
    for case in range(20):
        qp, x = known_qp(rng, 6, 2, case % 7, inequalities=3)
        solver.reset()
        solution = solver.solve(qp)
        assert solution.found
        assert np.abs(solution.x - x).max() < 1e-6
        assert np.abs(solver.network.rates(qp, solver.state)).max() < 1e-8
        moved = solver.state + 1e-2 * rng.standard_normal(solver.state.size)
        assert np.abs(reference(qp, moved)).max() > 1e-5


MANY_BOUNDS = known_qp(np.random.default_rng(3), 5, 2, 2, inequalities=2)[0]


@cache
def end_of_flow(name: str) -> Array:
    """The state after one unit of time from zero: independent field, independent integrator."""
    network, reference = SOURCES[name]
    start = np.zeros(network.state_size(MANY_BOUNDS))
    options = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13, "max_step": 0.02}
    return solve_ivp(lambda _, s: reference(MANY_BOUNDS, s), (0.0, 1.0), start, **options).y[:, -1]


@pytest.mark.parametrize("case", ["projection", "free", *OTHERS])
@pytest.mark.parametrize("integrator", [d.ExplicitEuler, d.ImplicitEuler])
def test_order_by_regression_against_scipy(case: str, integrator: type) -> None:
    network, exact = SOURCES[case][0], end_of_flow(case)
    counts, errors = np.array([400, 800, 1600]), []
    for count in counts:
        explicit = integrator is d.ExplicitEuler
        tried = d.ExplicitEuler(int(count)) if explicit else d.ImplicitEuler(1.0 / count)
        state = np.zeros(exact.size)
        tried.advance(network, MANY_BOUNDS, state, 1.0)
        errors.append(np.abs(state - exact).max())
    assert -np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(1.0, abs=0.2)
    assert errors[-1] < 0.02 * np.abs(exact).max()


def test_the_projection_networks_stable_step_separates_decay_from_growth() -> None:
    rng = np.random.default_rng(2)
    for _ in range(50):
        # Idle bounds: the network is linear, so numpy's eigenvalues say what is stable.
        n, p = 7, 4
        root = rng.standard_normal((n, n))
        P, A = root @ root.T / n + 0.2 * np.eye(n), rng.standard_normal((p, n))
        linear = np.block([[-P, -A.T], [A, np.zeros((p, p))]])
        qp = d.QP(P, np.zeros(n), A=A, b=np.zeros(p))
        step = d.ProjectionNetwork().stable_step(qp, np.zeros(3 * n + p))
        spread = np.abs(np.linalg.eigvals(np.eye(n + p) + 0.999 * step * linear))
        assert spread.max() < 1.0
    # With P = I it is sharp: h sigma^2 < 1 (the paper's own analysis).
    A = np.diag([2.54, 1.0, 0.2, 0.0])[:3]
    qp = d.QP(np.eye(4), np.zeros(4), A=A, b=np.zeros(3))
    step = d.ProjectionNetwork().stable_step(qp, np.zeros(15))
    assert step == pytest.approx(1.0 / 2.54**2, rel=1e-12)
    # Rows count that are active; no step is known where the cost is singular.
    bounds = {"lb": [-1.0, -1.0], "ub": [1.0, 1.0]}
    qp = d.QP(np.eye(2), np.zeros(2), A=[[1.0, 0.0]], b=[0.0], **bounds)
    assert d.ProjectionNetwork().stable_step(qp, np.zeros(7)) == pytest.approx(1.0)
    assert d.ProjectionNetwork().stable_step(qp, np.r_[0.0, 0.0, 0.0, 2.0, np.zeros(3)]) == 0.5
    singular = d.QP(np.diag([1.0, 0.0]), np.zeros(2), A=[[1.0, 1.0]], b=[0.0])
    assert d.ProjectionNetwork().stable_step(singular, np.zeros(7)) == 0.0


def test_the_gradient_network_descends_the_square_of_the_error() -> None:
    qp = d.QP(np.diag([1.0, 2.0, 4.0]), [1.0, -1.0, 0.5], A=[[1.0, 1.0, 1.0]], b=[0.5])

    def half_square(state: Array) -> float:
        x, y = state[:3], state[3:]
        return 0.5 * sum((qp.P @ x + qp.q + qp.A.T @ y) ** 2) + 0.5 * (qp.A @ x - qp.b)[0] ** 2

    state = np.array([0.3, -0.2, 0.1, 0.4])
    expected = -finite_difference(half_square, state)
    np.testing.assert_allclose(d.GradientNetwork().rates(qp, state), expected, atol=1e-8)


def test_the_yardsticks_iterations_are_osqps() -> None:
    network = AdmmIteration()
    qp, x = known_qp(np.random.default_rng(6), 6, 2, 2, inequalities=3)
    state = np.zeros(network.state_size(qp))
    expected = osqp.OSQP()
    rows = np.vstack([qp.A, qp.G, np.eye(6)])
    expected.setup(
        sparse.csc_matrix(np.triu(qp.P)), qp.q, sparse.csc_matrix(rows),
        np.r_[qp.b, np.full(3, -np.inf), qp.lb], np.r_[qp.b, qp.h, qp.ub], max_iter=50,
        verbose=False, scaling=0, check_termination=0, adaptive_rho=False, polishing=False,
    )  # fmt: skip
    for _ in range(3):  # it starts warm
        d.ExplicitEuler(substeps=50).advance(network, qp, state, 50.0)
        result = expected.solve(raise_error=False)
        np.testing.assert_allclose(state[:17], np.r_[result.x, result.y], atol=1e-9)
    d.ExplicitEuler(substeps=5000).advance(network, qp, state, 5000.0)
    np.testing.assert_allclose(state[:6], x, atol=1e-4)


def test_singular_cost_converges_but_not_with_the_dual_networks() -> None:
    nothing = d.QP(np.zeros((1, 1)), [1.0], lb=[-1.0])
    assert d.OneLayerNetwork().rates(nothing, np.zeros(1)) == [-0.5]
    qp = d.QP(np.diag([1.0, 0.0]), [0.0, 1.0], A=[[1.0, 1.0]], b=[1.0], lb=[-5.0, -5.0])
    solution = d.solve_problem(qp, solver=d.DNNSolver(d.PrimalDualNetwork()))
    assert solution.found
    np.testing.assert_allclose(solution.x, [1.0, 0.0], atol=1e-7)
    for network in (d.DualNetwork(), d.SimplifiedDualNetwork()):
        with pytest.raises(d.InvalidInputError, match="singular") as caught:
            d.solve_problem(qp, solver=d.DNNSolver(network))
        assert caught.value.argument == "P"


@pytest.mark.parametrize(
    ("flow", "problem"),
    [
        (Flow(lambda s: np.zeros(3)), r"^rates of Own: has shape \(3,\), not \(4,\)"),
        (Flow(lambda s: None), r"^rates of Own: has shape \(\)"),
        (Flow(lambda s: -s, lambda s: np.eye(3)), r"^jacobian: must have shape \(4, 4\)"),
        (None, r"^Own\.flow: must be an iiwa_dnn\.Flow, not None"),
        (Flow(lambda s: s), "^Own: no explicit step is known to be stable"),
        (Flow(lambda s: -1e9 * s), "^Own: no explicit step .* more than 1000000 would"),
    ],
)
def test_a_network_of_wrong_shapes_or_sign_is_named(flow: Any, problem: str) -> None:
    qp = d.QP(np.diag([1.0, 2.0, 4.0]), np.ones(3), A=np.ones((1, 3)), b=[0.5])
    own = type("Own", (Network,), {"flow": lambda self, qp: flow})
    with pytest.raises(d.InvalidInputError, match=problem):
        d.DNNSolver(own()).advance(qp, 1e-4)


def test_a_state_without_x_is_not_disturbed() -> None:
    for network in (d.DualNetwork(), SOURCES["activated"][0]):
        with pytest.raises(d.InvalidInputError, match="network"):
            d.DNNSolver(network).disturb(np.zeros(4))
    solver = d.DNNSolver()
    solver.solve(MANY_BOUNDS)
    solver.disturb(np.zeros(4))  # of five variables the first ones may be the joints
    for noise in (np.zeros(6), np.zeros((1, 5)), "loud"):
        with pytest.raises(d.InvalidInputError, match="noise"):
            solver.disturb(noise)


@pytest.mark.parametrize(
    ("make", "argument"),
    [
        (lambda: d.ProjectionNetwork(rho=0.0), "rho"),
        (lambda: d.ProjectionNetwork(rho=np.inf), "rho"),
        (lambda: d.ZeroingNetwork(form="other"), "form"),
        (lambda: d.ZeroingNetwork(integral=-1.0), "integral"),
        (lambda: d.ZeroingNetwork(growth=-1), "growth"),
        (lambda: NoiseSuppressingNetwork(proportional=0.0), "proportional"),
        (lambda: FixedTime(low=0.0), "low"),
        (lambda: d.ExplicitEuler(substeps=0), "substeps"),
        (lambda: d.ImplicitEuler(step=0.0), "step"),
        (lambda: d.ImplicitEuler(max_steps=0), "max_steps"),
        (lambda: TrackingSolver(formula="euler"), "formula"),
        (lambda: d.DNNSolver(network=d.ExplicitEuler()), "network"),
        (lambda: d.DNNSolver(solve_integrator=d.ExplicitEuler()), "solve_integrator"),
        (lambda: d.DNNSolver().solve(MANY_BOUNDS.to_qpsolvers()), "qp"),
        (lambda: d.DNNSolver().advance(MANY_BOUNDS.to_qpsolvers(), 1e-4), "qp"),
        *[
            (partial(call, value), name)
            for value in (0.0, -1.0, np.nan, np.inf, None, "a")
            for call, name in (
                (lambda value: d.DNNSolver(tol=value), "tol"),
                (lambda value: d.DNNSolver().advance(MANY_BOUNDS, value), "duration"),
                (lambda value: TrackingSolver().advance(MANY_BOUNDS, value), "duration"),
                (lambda value: d.CrossCheck(tolerance=value), "tolerance"),
                (lambda value: d.CrossCheck(reference_tolerance=value), "reference_tolerance"),
            )
        ],
    ],
)  # fmt: skip
def test_wrong_parameters_are_named(make: Callable[[], object], argument: str) -> None:
    with pytest.raises(d.InvalidInputError) as caught:
        make()
    assert caught.value.argument == argument
