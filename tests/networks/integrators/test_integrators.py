"""The integrators against scipy's at tight tolerance, their order, and what they settle to."""

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_qp import known_qp
from iiwa_dnn.networks import Flow
from iiwa_dnn.networks.integrators import Integrator
from iiwa_dnn.studies.paper import START as PAPER_START

BOUNDS = known_qp(np.random.default_rng(3), 5, 2, 2, inequalities=2)[0]


def test_eight_substeps_are_stable_for_the_papers_start_and_seven_are_not() -> None:
    robot = d.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
    conf = d.Configuration(robot, PAPER_START)
    qp = d.DoubleIndicator(orientation="block").build_qp(conf, d.Heart().anchored(conf).at(1.0))
    network, state = d.ProjectionNetwork(), np.zeros(sum(qp.sizes) + 2 * qp.sizes[0])
    step = 1e-4 / network.rho
    assert d.ExplicitEuler().advance(network, qp, state.copy(), step) == 8
    ends = {}
    for count in (7, 8):
        state = np.zeros(network.state_size(qp))
        for _ in range(400):
            d.ExplicitEuler(substeps=count).advance(network, qp, state, step)
        ends[count] = np.abs(network.rates(qp, state)).max()
    assert ends[8] < 0.05
    assert ends[7] > 1.0  # it chatters at the velocity bounds, which keep it finite


class Doubled(d.ProjectionNetwork):
    """A network with a flow of its own: the paper's, twice as fast."""

    def flow(self, qp: d.QP, rate: d.QP | None = None) -> Flow:
        slow = super().flow(qp)
        return slow._replace(rates=lambda s: 2.0 * slow.rates(s))


@pytest.mark.parametrize("project", [True, False])
@pytest.mark.parametrize("integrator", [d.ExplicitEuler(1000), d.ImplicitEuler(1e-3)], ids=repr)
def test_a_flow_of_a_subclass_is_integrated(integrator: Integrator, project: bool) -> None:
    network, state = Doubled(primal_projection=project), np.zeros(19)
    integrator.advance(network, BOUNDS, state, 0.5)
    expected = np.zeros(19)
    integrator.advance(d.ProjectionNetwork(primal_projection=project), BOUNDS, expected, 1.0)
    np.testing.assert_allclose(state, expected, atol=0.01 * np.abs(expected).max())
    assert d.DNNSolver(network).solve(BOUNDS).found
    assert d.DNNSolver(network).compiled_answer(BOUNDS.sizes) is None


@pytest.mark.parametrize(
    "network",
    [d.ProjectionNetwork(), d.ProjectionNetwork(rho=1e-4, primal_projection=False)],
    ids=repr,
)
@pytest.mark.parametrize("integrator", [d.ExplicitEuler(), d.ImplicitEuler()], ids=repr)
def test_a_state_or_a_point_of_another_size_is_refused(network, integrator) -> None:
    wrong = (0, 18, 20, 19000)
    for call, states, points in (
        (lambda s, p: integrator.advance(network, BOUNDS, s, 1.0), wrong, ()),
        (lambda s, p: d.ImplicitEuler().solve(network, BOUNDS, s, p, 1e-6), wrong, (0, 13, 15)),
        (lambda s, p: network.rates(BOUNDS, s), wrong, ()),
        (lambda s, p: network.stable_step(BOUNDS, s), wrong, ()),
        (lambda s, p: network.flow(BOUNDS).read(BOUNDS, s, p), (8,), (0, 13, 15)),
    ):
        call(np.zeros(19), np.zeros(14))
        for size in states:
            with pytest.raises(d.InvalidInputError, match="state"):
                call(np.zeros(size), np.zeros(14))
        for size in points:
            with pytest.raises(d.InvalidInputError, match="point"):
                call(np.zeros(19), np.zeros(size))
