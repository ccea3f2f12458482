"""The integrators against scipy's at tight tolerance, their order, and what they settle to."""

import json
from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from helpers_qp import known_qp, network_rates
from iiwa_dnn import (
    QP,
    Configuration,
    DNNSolver,
    DoubleIndicator,
    ExplicitEuler,
    Heart,
    ImplicitEuler,
    InvalidInputError,
    ProjectionNetwork,
    load_robot,
)
from iiwa_dnn.networks import Flow
from iiwa_dnn.networks.integrators import Integrator
from iiwa_dnn.studies.paper import START as PAPER_START


def heart_qp(orientation: str = "so3") -> QP:
    """A program of the heart, one second into it with the robot still at its start."""
    robot = load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    conf = Configuration(robot, PAPER_START)
    return DoubleIndicator(orientation=orientation).build_qp(conf, Heart().anchored(conf).at(1.0))


@cache
def flow(name: str, duration: float, project: bool) -> np.ndarray:
    """The state of a case after `duration` from zero: independent field, independent integrator."""
    qp = CASES[name]
    size = ProjectionNetwork().state_size(qp)
    solution = solve_ivp(
        lambda _, state: network_rates(qp, state, project),
        (0.0, duration),
        np.zeros(size),
        method="DOP853",
        rtol=1e-11,
        atol=1e-13,
        max_step=0.05,  # the field has kinks where a bound becomes active
    )
    assert solution.success
    return solution.y[:, -1]


CASES = {
    "heart": heart_qp(),
    "bounds": known_qp(np.random.default_rng(3), 5, 2, 2, inequalities=2)[0],
    "pushed": QP(np.eye(1), [-10.0], lb=[-0.1], ub=[0.1]),
}


def test_computed_substeps_follow_the_flow() -> None:
    qp = CASES["heart"]
    network, state = ProjectionNetwork(), np.zeros(sum(qp.sizes) + 2 * qp.sizes[0])
    for _ in range(20):
        ExplicitEuler().advance(network, qp, state, 1e-4 / network.rho)
    exact = flow("heart", 20 * 1e-4 / network.rho, True)
    assert np.abs(state - exact).max() < 0.05 * np.abs(exact).max()


def test_eight_substeps_are_stable_for_the_papers_start_and_seven_are_not() -> None:
    qp = heart_qp("block")
    network, state = ProjectionNetwork(), np.zeros(sum(qp.sizes) + 2 * qp.sizes[0])
    step = 1e-4 / network.rho
    assert ExplicitEuler().advance(network, qp, state.copy(), step) == 8
    ends = {}
    for count in (7, 8):
        state = np.zeros(network.state_size(qp))
        for _ in range(400):
            ExplicitEuler(substeps=count).advance(network, qp, state, step)
        ends[count] = np.abs(network.rates(qp, state)).max()
    assert ends[8] < 0.05
    assert ends[7] > 1.0  # it chatters at the velocity bounds, which keep it finite


def test_one_implicit_step_is_the_fixed_point_of_its_definition() -> None:
    # Backward Euler: s+ = s + h F(s+), checked with the independent field at any step length.
    rng = np.random.default_rng(6)
    network = ProjectionNetwork(primal_projection=False)
    for step in (1e-2, 1.0, 1e2, 1e4):
        qp, _ = known_qp(rng, 6, 2, 3, inequalities=3)
        start = rng.standard_normal(network.state_size(qp))
        state = start.copy()
        ImplicitEuler(step=step).advance(network, qp, state, step)
        defect = state - start - step * network_rates(qp, state, project=False)
        assert np.abs(defect).max() < 1e-9 * max(1.0, step)


def test_the_primal_projection_is_integrated() -> None:
    # One variable in +-0.1, pushed by 10: without the projection it leaves the bounds far behind.
    qp = CASES["pushed"]
    exact = flow("pushed", 1.0, True)
    assert exact[0] == pytest.approx(0.1 * (1.0 - np.exp(-1.0)), abs=1e-6)
    network = ProjectionNetwork()
    for integrator in (ExplicitEuler(1000), ImplicitEuler(1e-3)):
        state = np.zeros(network.state_size(qp))
        integrator.advance(network, qp, state, 1.0)
        np.testing.assert_allclose(state, exact, rtol=0, atol=2e-3)


class Doubled(ProjectionNetwork):
    """A network with a flow of its own: the paper's, twice as fast."""

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        slow = super().flow(qp)
        return slow._replace(rates=lambda s: 2.0 * slow.rates(s))


@pytest.mark.parametrize("project", [True, False])
@pytest.mark.parametrize("integrator", [ExplicitEuler(1000), ImplicitEuler(1e-3)], ids=repr)
def test_a_flow_of_a_subclass_is_integrated(integrator: Integrator, project: bool) -> None:
    qp = CASES["bounds"]
    network, state = Doubled(primal_projection=project), np.zeros(19)
    integrator.advance(network, qp, state, 0.5)
    exact = flow("bounds", 1.0, project)
    assert np.abs(state - exact).max() < 0.01 * np.abs(exact).max()
    assert DNNSolver(network).solve(qp).found
    assert DNNSolver(network).compiled_answer(qp.sizes) is None


def test_a_subclass_that_changes_nothing_stays_compiled() -> None:
    solver = DNNSolver(type("Subclass", (ProjectionNetwork,), {})())
    for duration in (0.0, 1e-4):
        assert solver.compiled_answer(CASES["bounds"].sizes, duration) is not None


@pytest.mark.parametrize(
    "network", [ProjectionNetwork(), ProjectionNetwork(rho=1e-4, primal_projection=False)], ids=repr
)
@pytest.mark.parametrize("integrator", [ExplicitEuler(), ImplicitEuler()], ids=repr)
def test_a_state_or_a_point_of_another_size_is_refused(
    network: ProjectionNetwork, integrator: Integrator
) -> None:
    qp = CASES["bounds"]
    state, point = np.zeros(19), np.zeros(14)
    for calls in (
        lambda s, p: integrator.advance(network, qp, s, 1.0),
        lambda s, p: ImplicitEuler().settle(network, qp, s, p, 1e-6),
        lambda s, p: network.rates(qp, s),
        lambda s, p: network.stable_step(qp, s),
    ):
        calls(state.copy(), point.copy())
        for size in (0, 18, 20, 19000):
            with pytest.raises(InvalidInputError, match="state"):
                calls(np.zeros(size), point.copy())
    with pytest.raises(InvalidInputError, match="state"):
        network.flow(qp).read(qp, np.zeros(8), point)
    for size in (0, 13, 15):
        with pytest.raises(InvalidInputError, match="point"):
            network.flow(qp).read(qp, state, np.zeros(size))
        with pytest.raises(InvalidInputError, match="point"):
            ImplicitEuler().settle(network, qp, state.copy(), np.zeros(size), 1e-6)


def test_integrators_and_networks_name_themselves() -> None:
    assert ExplicitEuler(np.int64(8)).settings() == {"name": "ExplicitEuler", "substeps": 8}
    assert ImplicitEuler(step=np.float64(0.5)).settings()["step"] == 0.5
    network = ProjectionNetwork(rho=np.float64(1e-4), primal_projection=False)
    assert json.loads(json.dumps(network.settings())) == {
        "name": "ProjectionNetwork", "rho": 1e-4, "primal_projection": False,
    }  # fmt: skip
    assert Doubled().settings()["name"] == "Doubled"
    json.dumps(ExplicitEuler(np.int64(8)).settings())
