"""The controller in a robot's loop: encoders in, command out."""

from __future__ import annotations

import copy
import warnings

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0, dh_pose, rotation_angle
from helpers_simulation import heart, paper_robot, paper_start, run
from iiwa_dnn import (
    Circle,
    Configuration,
    Controller,
    DNNSolver,
    DoubleIndicator,
    Heart,
    InvalidInputError,
    MovingTarget,
    Target,
    Waypoints,
)
from iiwa_dnn.control.policies import Action
from iiwa_dnn.references import Reference

DT = 1e-3


def loop(controller: Controller, steps: int, q: np.ndarray | None = None) -> np.ndarray:
    """Joint positions of a loop whose joints move as they are told, (steps + 1, n)."""
    path = [np.array(PAPER_Q0) if q is None else q]
    for k in range(steps):
        path.append(path[-1] + controller.dt * controller.step(path[-1], k * controller.dt).dq)
    return np.array(path)


def test_a_robots_loop_is_the_runners_loop() -> None:
    controller = Controller(paper_robot(), DoubleIndicator(), heart(), dt=DT)
    record = run(duration=0.2, dt=DT)
    np.testing.assert_array_equal(loop(controller, 200), record.q)


def test_a_path_of_ones_own_and_a_spline_serve_as_well() -> None:
    class Slanted(Reference):
        name = "slanted"
        period = 1.0

        def move(self, t, target):
            target[:3] += 0.01 * t * np.array([1.0, 0.0, 2.0])
            target[12:15] = [0.01, 0.0, 0.02]

    points = Waypoints(np.array([0.0, 0.5, 1.0]), 0.01 * np.eye(3))
    for path in (Slanted(), points):
        reference = path.anchored(paper_start())
        q = loop(Controller(paper_robot(), DoubleIndicator(), reference, dt=DT), 100)
        np.testing.assert_allclose(dh_pose(q[-1])[0], reference.at(0.1).position, atol=1e-4)


def test_commands_stay_what_they_were() -> None:
    controller = Controller(paper_robot(), DoubleIndicator(), heart(), dt=DT)
    q, commands, kept = np.array(PAPER_Q0), [], []
    for k in range(300):
        commands.append(controller.step(q, k * DT))
        kept.append((commands[-1].dq.copy(), commands[-1].qp.data.copy()))
        q = q + DT * commands[-1].dq
    for command, (dq, data) in zip(commands, kept, strict=True):
        np.testing.assert_array_equal(command.dq, dq)
        np.testing.assert_array_equal(command.qp.data, data)
        np.testing.assert_array_equal(command.solution.x, dq)
        assert command.ok


def test_a_target_out_of_reach_is_not_ok_and_is_gone_to_directly() -> None:
    controller = Controller(paper_robot(), DoubleIndicator(), dt=DT)
    start = paper_start()
    far = Target(start.position + [3.0, 0.0, 0.0], start.rotation)
    command = controller.step(PAPER_Q0, 0.0, far)
    assert not command.ok
    assert command.action is Action.RELAX
    assert (start.jacobian @ command.dq)[0] > 0.0
    assert controller.delay == 0.0


def test_a_path_that_is_too_quick_is_followed_more_slowly() -> None:
    controller = Controller(paper_robot(), DoubleIndicator(), dt=DT)
    start = paper_start()
    quick = Target(start.position, start.rotation, [9.0, 0.0, 0.0])
    command = controller.step(PAPER_Q0, 0.0, quick)
    assert not command.ok
    assert command.action is Action.SLOW
    # The direction stays, and with it most joints away from their limits.
    at_limit = np.abs(command.dq) > 0.999 * paper_robot().dq_max
    assert at_limit.sum() <= 2
    moved = start.jacobian @ command.dq
    assert moved[0] > 0.0
    np.testing.assert_allclose(moved[1:], 0.0, rtol=0, atol=1e-7)
    assert 0.0 < controller.delay < DT


def test_warm_up_at_a_posture_leaves_nothing_to_be_laid_out() -> None:
    cold, warm = (Controller(paper_robot(), DoubleIndicator(), heart(), dt=DT) for _ in range(2))
    warm.warm_up(PAPER_Q0)
    laid_out = warm.control_step
    np.testing.assert_array_equal(loop(warm, 30), loop(cold, 30))
    assert warm.control_step is laid_out
    assert cold.control_step is not laid_out
    with pytest.raises(InvalidInputError, match=r"^q\b"):
        warm.warm_up(PAPER_Q0[:6])


def test_the_reference_is_judged_at_the_time_of_the_first_step() -> None:
    """A run that is taken up later begins where the path is then, wherever it began."""
    controller = Controller(paper_robot(), DoubleIndicator(), heart(2.0), dt=DT)
    q = np.array(PAPER_Q0)
    half = round(1.0 / DT)  # 7.6 cm from where the path began
    for k in range(half):
        q = q + DT * controller.step(q, k * DT).dq
    again = Controller(paper_robot(), DoubleIndicator(), heart(2.0), dt=DT)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        again.warm_up(q)
        again.step(q, half * DT)
    elsewhere = Controller(paper_robot(), DoubleIndicator(), Circle(), dt=DT)
    elsewhere.warm_up(PAPER_Q0)
    with pytest.warns(UserWarning, match="the reference begins"):
        elsewhere.step(PAPER_Q0, 0.0)
    with pytest.warns(UserWarning, match="the reference begins"):
        Controller(paper_robot(), DoubleIndicator(), Circle(), dt=DT).warm_up(PAPER_Q0, 0.0)


def test_a_bad_reading_is_named_and_loses_nothing() -> None:
    controller = Controller(paper_robot(), DoubleIndicator(), heart(), dt=DT)
    before = controller.step(PAPER_Q0, 0.0)
    for bad in (np.zeros(6), np.zeros((7, 1)), [0.0] * 8):
        with pytest.raises(InvalidInputError, match=r"^q\b"):
            controller.step(bad, DT)
    with pytest.raises(InvalidInputError, match=r"^q\b.*finite"):
        controller.step(np.full(7, np.nan), DT)
    np.testing.assert_allclose(controller.step(PAPER_Q0, 0.0).dq, before.dq, rtol=0, atol=1e-9)


def test_without_reference_and_target_the_argument_is_named() -> None:
    with pytest.raises(InvalidInputError, match=r"^reference\b"):
        Controller(paper_robot(), DoubleIndicator(), dt=DT).step(PAPER_Q0, 0.0)


def test_a_reference_far_away_is_told_once() -> None:
    controller = Controller(paper_robot(), DoubleIndicator(), Heart(), dt=DT)
    with pytest.warns(UserWarning, match="anchored"):
        controller.step(PAPER_Q0, 0.0)
    assert not controller.step(PAPER_Q0, DT).ok


def test_a_moving_target_is_reached_no_faster_than_it_may() -> None:
    robot, start = paper_robot(), paper_start()
    target = MovingTarget(start, speed=0.1, rate=0.5)
    controller = Controller(robot, DoubleIndicator(), target, dt=DT)
    q = loop(controller, 5)[-1]
    np.testing.assert_allclose(q, PAPER_Q0, rtol=0, atol=1e-9)
    goal = Configuration(robot, np.array(PAPER_Q0) + 0.1)
    target.set(goal.position, goal.rotation)
    positions = []
    for k in range(5, 1500):
        command = controller.step(q, k * DT)
        assert command.ok
        q = q + DT * command.dq
        positions.append(dh_pose(q)[0])
    speed = np.linalg.norm(np.diff(positions, axis=0), axis=1) / DT
    assert speed.max() < 0.1 * 1.05
    np.testing.assert_allclose(positions[-1], goal.position, rtol=0, atol=1e-4)
    assert rotation_angle(dh_pose(q)[1], goal.rotation) < 1e-3


@pytest.mark.parametrize(
    ("position", "rotation", "name"),
    [([0.0, 0.0], None, "position"), ([np.nan] * 3, None, "position"),
     (np.zeros(3), 2.0 * np.eye(3), "rotation"), (np.zeros(3), -np.eye(3), "rotation")],
)  # fmt: skip
def test_a_target_that_is_no_pose_is_refused(position, rotation, name) -> None:
    target = MovingTarget(paper_start())
    before = target.at(0.0).data.copy()
    with pytest.raises(InvalidInputError, match=rf"^{name}\b"):
        target.set(position, rotation)
    np.testing.assert_allclose(target.at(1.0).data, before, rtol=0, atol=1e-12)


def test_a_network_without_a_compiled_form_serves_the_loop() -> None:
    from iiwa_dnn import PrimalDualNetwork

    quick = loop(Controller(paper_robot(), DoubleIndicator(), heart(), dt=DT), 5)
    solver = DNNSolver(PrimalDualNetwork(), tol=1e-9)
    other = loop(Controller(paper_robot(), DoubleIndicator(), heart(), dt=DT, solver=solver), 5)
    np.testing.assert_allclose(other, quick, rtol=0, atol=1e-9)


@pytest.mark.parametrize("mode", ["converged", "continuous"])
def test_a_loop_that_jitters_says_the_period_of_each_step(mode) -> None:
    random = np.random.default_rng(0)
    scheme = DoubleIndicator(home=PAPER_Q0)
    told = Controller(paper_robot(), scheme, heart(), dt=DT, mode=mode)
    told.step(PAPER_Q0, 0.0)
    laid_out = told.control_step
    q = np.array(PAPER_Q0)
    t = 0.0
    for period in DT * random.uniform(0.5, 1.5, 300):
        anew = Controller(paper_robot(), scheme, heart(), dt=period, mode=mode)
        anew.solver = copy.copy(told.solver)
        command = told.step(q, t, dt=period)
        expected = anew.step(q, t)
        np.testing.assert_allclose(command.dq, expected.dq, rtol=0, atol=1e-12)
        q = q + period * command.dq
        t += period
    assert told.control_step is laid_out
    assert np.linalg.norm(dh_pose(q)[0] - heart().at(t).position) < 5e-5
    with pytest.raises(InvalidInputError, match=r"^dt\b"):
        told.step(q, t, dt=0.0)
