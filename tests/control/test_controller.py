"""One control step: a network that settles, and one that is given the robot's own time."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, near_target, paper_robot, paper_start, solve_by
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks import ProjectionNetwork
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Status
from iiwa_dnn.references import Circle, Heart, MovingTarget, Reference, Target
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.schemes import (
    CollisionAvoidance,
    CyclicMotion,
    DoubleIndicator,
    PoseTask,
    PositionTask,
    PseudoInverse,
    Scheme,
    Sphere,
)

SCHEME = DoubleIndicator(home=PAPER_Q0)


def controller_of(scheme: Scheme, robot: Robot | None = None, **options: Any) -> Controller:
    return Controller(robot or paper_robot(), scheme, **options)


def test_a_converged_step_is_the_programs_solution() -> None:
    controller = controller_of(SCHEME)
    rng = np.random.default_rng(61)
    for seed in range(5):
        q = np.array(PAPER_Q0) + 0.02 * rng.standard_normal(7)
        conf, target = Configuration(paper_robot(), q), near_target(q, seed, size=2e-3)
        command = controller.step(conf.q, 0.0, target)
        np.testing.assert_array_equal(command.qp.data, SCHEME.build_qp(conf, target).data)
        assert command.solution.found
        assert command.solution.residuals.largest <= 1e-9
        np.testing.assert_array_equal(command.dq, command.solution.x)
        np.testing.assert_allclose(command.dq, solve_by("proxqp", command.qp), rtol=0, atol=1e-7)


def test_a_continuous_step_advances_by_one_period_and_lags() -> None:
    conf, target = paper_start(), heart().at(0.5)
    settled = controller_of(SCHEME).step(conf.q, 0.0, target).dq
    controller = controller_of(SCHEME, mode="continuous", dt=1e-4)
    command = controller.step(conf.q, 0.0, target)
    assert command.solution.status is Status.ADVANCED
    assert not command.solution.found
    assert command.solution.network_time == pytest.approx(1e-4 / 9e-5)
    gap = [float(np.abs(command.dq - settled).max())]
    # The target held still, the network settles in its own time: sigma = 0.241 here, so like
    # exp(-sigma^2 t / rho), 16 control steps to a factor of e.
    for _ in range(300):
        gap.append(float(np.abs(controller.step(conf.q, 0.0, target).dq - settled).max()))
    assert gap[0] > 1e-2
    assert gap[20] > 1e-3
    assert gap[300] < 1e-6


def test_the_continuous_networks_clock_is_the_robots() -> None:
    # Twice the period with twice the time constant is the same network time.
    conf, target = paper_start(), heart().at(0.5)
    fast = controller_of(SCHEME, mode="continuous", dt=1e-4)
    slow_network = ProjectionNetwork(rho=2 * 9e-5)
    slow = controller_of(SCHEME, solver=DNNSolver(slow_network), mode="continuous", dt=2e-4)
    for _ in range(5):
        one, other = fast.step(conf.q, 0.0, target), slow.step(conf.q, 0.0, target)
        np.testing.assert_allclose(one.dq, other.dq, rtol=0, atol=1e-14)


@pytest.mark.parametrize("mode", ["converged", "continuous"])
@pytest.mark.parametrize("orientation", ["so3", "block", "none"])
def test_commands_stay_inside_the_velocity_bounds(mode: str, orientation: str) -> None:
    # Tight limits, a far target: many bounds bind, and the program may even be infeasible.
    robot = paper_robot().with_limits(velocity=0.05)
    scheme = DoubleIndicator(orientation=orientation, home=PAPER_Q0)
    controller = controller_of(scheme, robot, mode=mode, dt=1e-4)
    rng = np.random.default_rng(62)
    bound = 0
    for seed in range(20):
        q = np.array(PAPER_Q0) + 0.05 * rng.standard_normal(7)
        q[0] = -2.5 + 1e-4 * seed
        conf, target = Configuration(robot, q), near_target(q, seed, size=0.01)
        for _ in range(1 if mode == "converged" else 15):
            command = controller.step(conf.q, 0.0, target)
            assert (command.dq >= command.qp.lb).all()
            assert (command.dq <= command.qp.ub).all()
        near = np.minimum(command.dq - command.qp.lb, command.qp.ub - command.dq) < 1e-3
        bound += int(near.sum())
    assert bound > 20


def test_the_networks_state_is_carried_from_step_to_step() -> None:
    conf, target = paper_start(), heart().at(0.5)
    solver = DNNSolver()
    controller = controller_of(SCHEME, solver=solver)
    cold = controller.step(conf.q, 0.0, target).solution.iterations
    warm = controller.step(conf.q, 0.0, heart().at(0.5001)).solution.iterations
    assert warm < cold
    solver.reset()
    assert controller.step(conf.q, 0.0, target).solution.iterations == cold


def test_any_scheme_will_do() -> None:
    conf, target = paper_start(), heart().at(0.5)
    command = controller_of(PseudoInverse()).step(conf.q, 0.0, target)
    qp = PseudoInverse().build_qp(conf, target)
    expected = np.linalg.pinv(qp.A) @ qp.b
    np.testing.assert_allclose(command.dq, expected, rtol=0, atol=1e-8)


def test_a_command_says_in_words_what_it_is() -> None:
    start = paper_start()
    far = Target(start.position + [0.5, 0.0, 0.0], start.rotation)
    controller = Controller(paper_robot(), DoubleIndicator(), policy="stop")
    command = controller.step(PAPER_Q0, 0.0, far)
    stopped = repr(command)
    reason = "no solution: stopped, against joint 4 lower velocity limit; ok = False>"
    assert stopped.endswith(reason)
    controller.policy = "relax"
    assert repr(command.qp) == "<QP of 7 variables: 0 inequalities, 6 equalities, 14 bounds>"
    assert "as near to the task as the limits allow, against" in repr(
        controller.step(PAPER_Q0, 0.0, far)
    )
    there = Target(start.position, start.rotation)
    assert repr(controller.step(PAPER_Q0, 0.0, there)).endswith("rad/s, solved; ok = True>")


def test_an_unknown_mode_is_named() -> None:
    with pytest.raises(InvalidInputError, match=r"^mode\b.*converged, continuous.*'discrete'"):
        controller_of(SCHEME, mode="discrete")


@pytest.mark.parametrize("dt", [0.0, -1e-4, np.nan, np.inf])
def test_a_bad_period_is_named(dt: float) -> None:
    with pytest.raises(InvalidInputError, match=r"^dt\b"):
        controller_of(SCHEME, mode="continuous", dt=dt)


@pytest.mark.parametrize("t", [np.nan, "a", None])
def test_a_time_that_is_no_number_is_named(t: Any) -> None:
    controller = controller_of(SCHEME, reference=heart())
    for _ in range(2):
        with pytest.raises(InvalidInputError, match=r"^t\b"):
            controller.step(PAPER_Q0, t)
        controller.step(PAPER_Q0, 0.0)


@pytest.mark.parametrize("jitter", [0.0, 1e-13, 3e-4])
def test_targets_sampled_ahead_are_those_of_the_time_asked_for(jitter: float) -> None:
    robot = load_robot("iiwa7")
    start = Configuration(robot, robot.start_posture())
    reference = Heart().anchored(start)
    ahead = Controller(robot, DoubleIndicator(), reference, dt=1e-3)
    one_by_one = Controller(robot, DoubleIndicator(), dt=1e-3)
    shifts = np.random.default_rng(3).uniform(0.0, jitter, 200)
    shifts[150:] += 0.005  # the clock jumps
    q = start.q
    for k in range(200):
        t = k * 1e-3 + shifts[k]
        dq = ahead.step(q, t).dq
        np.testing.assert_allclose(dq, one_by_one.step(q, t, reference.at(t)).dq, rtol=0, atol=1e-9)
        q = q + 1e-3 * dq


def test_targets_sampled_ahead_follow_a_changed_period_and_delay() -> None:
    robot = load_robot("iiwa7")
    start = Configuration(robot, robot.start_posture())
    reference = Heart().anchored(start)
    controller = Controller(robot, DoubleIndicator(), reference, dt=1e-3)
    for k in range(10):
        controller.step(start.q, k * 1e-3)
    controller.delay = 0.5
    late = controller.step(start.q, 0.51)
    controller.delay, controller.dt = 0.0, 2e-3
    for k in range(10):
        early = controller.step(start.q, 2e-3 * k)
    fresh = Controller(robot, DoubleIndicator(), dt=1e-3)
    want = fresh.step(start.q, 0.0, reference.at(0.01)).dq
    np.testing.assert_allclose(late.dq, want, rtol=0, atol=1e-7)
    fresh.dt = 2e-3
    want = fresh.step(start.q, 0.0, reference.at(0.018)).dq
    np.testing.assert_allclose(early.dq, want, rtol=0, atol=1e-7)


@pytest.mark.parametrize("gain", [10.2, np.inf])
@pytest.mark.parametrize("compiled", [True, False])
def test_targets_of_two_frames_are_sampled_ahead_too(gain: float, compiled: bool) -> None:
    robot = load_robot("iiwa7_dual")
    start = Configuration(robot, robot.start_posture())
    left, right = "left_iiwa7_flange", "right_iiwa7_flange"
    still = MovingTarget(start.frame(right))  # which has no compiled form
    other: Reference = Circle().anchored(start.frame(right)) if compiled else still
    references = {right: other, left: Heart().anchored(start.frame(left))}
    tasks = [PositionTask(frame=right, gain=gain), PoseTask(frame=left, gain=gain)]
    scheme = Scheme([CyclicMotion()], tasks)
    if gain == np.inf:
        references = {name: reference.ahead(1e-3) for name, reference in references.items()}
    ahead = Controller(robot, scheme, references, dt=1e-3)
    one_by_one = Controller(robot, scheme, dt=1e-3)
    q = start.q
    for k in range(20):
        given = {name: reference.at(k * 1e-3) for name, reference in references.items()}
        dq = ahead.step(q, k * 1e-3).dq
        want = one_by_one.step(q, k * 1e-3, given).dq
        np.testing.assert_allclose(dq, want, rtol=0, atol=1e-9)
        q = q + 1e-3 * dq


def test_a_network_that_lags_says_that_it_keeps_bounds_alone() -> None:
    ball = Sphere(paper_start().position + [0.2, 0.0, 0.0], 0.05)
    avoidance = CollisionAvoidance([ball], self_collision=False)
    scheme = DoubleIndicator(home=PAPER_Q0, extra_limits=(avoidance,))
    controller = controller_of(scheme, mode="continuous")
    with pytest.warns(UserWarning, match="the rows of CollisionAvoidance hold where"):
        controller.step(PAPER_Q0, 0.0, near_target(np.array(PAPER_Q0), 0, size=2e-3))


def test_too_few_joints_for_a_pose_are_warned_of_once() -> None:
    robot = load_robot("iiwa7", locked=("iiwa7_joint_3", "iiwa7_joint_5"))
    q0 = robot.start_posture()
    circle = Circle(0.01).anchored(Configuration(robot, q0))
    for orientation in ("so3", "block", "none"):
        scheme = DoubleIndicator(orientation=orientation)
        controller = Controller(robot, scheme, circle, dt=1e-2)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            controller.step(q0, 0.0)
            controller.step(q0, 1e-2)
        said = [str(warning.message) for warning in caught]
        expected = "5 joints cannot hold a pose: orientation='none' leaves it free"
        assert said == ([] if orientation == "none" else [expected])
    # The paper's four rows have rank 3: six joints fulfil all seven rows.
    six = load_robot("iiwa7", locked=("iiwa7_joint_3",))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        Controller(six, DoubleIndicator(orientation="block"), circle, dt=1e-2).anchor(
            Configuration(six, six.start_posture())
        )
