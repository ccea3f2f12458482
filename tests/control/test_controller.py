"""One control step: a network that settles, and one that is given the robot's own time."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, near_target, paper_robot, paper_start, solve_by
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks import ProjectionNetwork
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Status
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator, PseudoInverse

SCHEME = DoubleIndicator(home=PAPER_Q0)


def test_a_converged_step_is_the_programs_solution() -> None:
    controller = Controller(SCHEME, DNNSolver())
    rng = np.random.default_rng(61)
    for seed in range(5):
        q = np.array(PAPER_Q0) + 0.02 * rng.standard_normal(7)
        conf, target = Configuration(paper_robot(), q), near_target(q, seed, size=2e-3)
        command = controller.step(conf, target)
        for one, other in zip(
            command.qp.arrays(), SCHEME.build_qp(conf, target).arrays(), strict=True
        ):
            np.testing.assert_array_equal(one, other)
        assert command.solution.found
        assert command.solution.residuals.largest <= 1e-9
        np.testing.assert_array_equal(command.dq, command.solution.x)
        np.testing.assert_allclose(command.dq, solve_by("proxqp", command.qp), rtol=0, atol=1e-7)


def test_a_continuous_step_advances_by_one_period_and_lags() -> None:
    conf, target = paper_start(), heart().at(0.5)
    settled = Controller(SCHEME, DNNSolver()).step(conf, target).dq
    controller = Controller(SCHEME, DNNSolver(), mode="continuous", dt=1e-4)
    command = controller.step(conf, target)
    assert command.solution.status is Status.ADVANCED
    assert not command.solution.found
    assert command.solution.network_time == pytest.approx(1e-4 / 9e-5)
    gap = [float(np.abs(command.dq - settled).max())]
    # The target held still, the network settles in its own time: sigma = 0.241 here, so like
    # exp(-sigma^2 t / rho), 16 control steps to a factor of e.
    for _ in range(300):
        gap.append(float(np.abs(controller.step(conf, target).dq - settled).max()))
    assert gap[0] > 1e-2
    assert gap[20] > 1e-3
    assert gap[300] < 1e-6


def test_the_continuous_networks_clock_is_the_robots() -> None:
    # Twice the period with twice the time constant is the same network time.
    conf, target = paper_start(), heart().at(0.5)
    fast = Controller(SCHEME, DNNSolver(), mode="continuous", dt=1e-4)
    slow_network = ProjectionNetwork(rho=2 * 9e-5)
    slow = Controller(SCHEME, DNNSolver(slow_network), mode="continuous", dt=2e-4)
    for _ in range(5):
        one, other = fast.step(conf, target), slow.step(conf, target)
        np.testing.assert_allclose(one.dq, other.dq, rtol=0, atol=1e-14)


@pytest.mark.parametrize("mode", ["converged", "continuous"])
@pytest.mark.parametrize("orientation", ["so3", "block", "none"])
def test_commands_stay_inside_the_velocity_bounds(mode: str, orientation: str) -> None:
    # Tight limits, a far target: many bounds bind, and the program may even be infeasible.
    robot = paper_robot().with_limits(velocity=0.05)
    scheme = DoubleIndicator(orientation=orientation, home=PAPER_Q0)
    controller = Controller(scheme, DNNSolver(), mode)
    rng = np.random.default_rng(62)
    bound = 0
    for seed in range(20):
        q = np.array(PAPER_Q0) + 0.05 * rng.standard_normal(7)
        q[0] = -2.5 + 1e-4 * seed
        conf, target = Configuration(robot, q), near_target(q, seed, size=0.01)
        for _ in range(1 if mode == "converged" else 15):
            command = controller.step(conf, target)
            assert (command.dq >= command.qp.lb).all()
            assert (command.dq <= command.qp.ub).all()
        near = np.minimum(command.dq - command.qp.lb, command.qp.ub - command.dq) < 1e-3
        bound += int(near.sum())
    assert bound > 20


def test_the_networks_state_is_carried_from_step_to_step() -> None:
    conf, target = paper_start(), heart().at(0.5)
    solver = DNNSolver()
    controller = Controller(SCHEME, solver)
    cold = controller.step(conf, target).solution.iterations
    warm = controller.step(conf, heart().at(0.5001)).solution.iterations
    assert warm < cold
    solver.reset()
    assert controller.step(conf, target).solution.iterations == cold


def test_any_scheme_will_do() -> None:
    conf, target = paper_start(), heart().at(0.5)
    command = Controller(PseudoInverse(), DNNSolver()).step(conf, target)
    expected = PseudoInverse().velocity(conf, target)
    np.testing.assert_allclose(command.dq, expected, rtol=0, atol=1e-8)


def test_an_unknown_mode_is_named() -> None:
    with pytest.raises(InvalidInputError, match=r"^mode\b.*converged, continuous.*'discrete'"):
        Controller(SCHEME, DNNSolver(), mode="discrete")


@pytest.mark.parametrize("dt", [0.0, -1e-4, np.nan, np.inf])
def test_a_bad_period_is_named(dt: float) -> None:
    with pytest.raises(InvalidInputError, match=r"^dt\b"):
        Controller(SCHEME, DNNSolver(), mode="continuous", dt=dt)
