"""The controller closed around a target that jumps."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import coal
import numpy as np
import pinocchio as pin
import pytest

from helpers_physics import START, papers_robot
from iiwa_dnn import (
    Configuration,
    CrossCheck,
    DoubleIndicator,
    InvalidInputError,
    load_robot,
)
from iiwa_dnn.app.viewer.follower import TIP_RATE, TIP_SPEED, Ball, Follower
from iiwa_dnn.app.viewer.live import describe


@pytest.fixture
def robot():
    return papers_robot()


def test_it_stays_where_the_target_is(robot):
    follower = Follower(robot, START)
    start = follower.configuration
    for _ in range(20):
        state = follower.step(start.position, start.rotation)
    np.testing.assert_allclose(state.q, START, atol=1e-12)
    assert describe(state) == "at the target"


def test_it_reaches_a_target_no_faster_than_it_may(robot):
    follower = Follower(robot, START)
    start = follower.configuration
    position = start.position + np.array([-0.08, -0.12, 0.1])
    rotation = pin.exp3(np.array([0.2, -0.3, 0.4])) @ start.rotation
    before = start
    speeds = []
    rates = []
    gaps = []
    for _ in range(400):
        state = follower.step(position, rotation)
        now = follower.configuration
        speeds.append(np.linalg.norm(now.position - before.position) / follower.dt)
        turn = pin.log3(now.rotation @ before.rotation.T)
        rates.append(np.linalg.norm(turn) / follower.dt)
        gaps.append(follower.check(CrossCheck()) if len(gaps) % 40 == 0 else 0.0)
        before = now
    np.testing.assert_allclose(now.position, position, atol=1e-5)
    np.testing.assert_allclose(now.rotation, rotation, atol=1e-5)
    assert max(speeds) <= 1.02 * TIP_SPEED
    assert max(speeds) > 0.9 * TIP_SPEED
    assert max(rates) <= 1.02 * TIP_RATE
    assert max(gaps) <= 1e-6
    assert state.command.solution.residuals.largest <= 1e-9


@pytest.mark.parametrize("direction", [(1, 1, 0), (0, 0, -1)])
def test_a_target_out_of_reach_leaves_it_still_and_within_its_limits(robot, direction):
    follower = Follower(robot, START)
    start = follower.configuration
    far = start.position + 3.0 * np.array(direction)
    for _ in range(650):
        state = follower.step(far, start.rotation)
        assert (np.abs(state.q) <= 2.5).all()
    drifted = follower.configuration.position
    for _ in range(50):
        follower.step(far, start.rotation)
    assert np.linalg.norm(follower.configuration.position - drifted) < 0.02
    # And back again.
    for _ in range(2500):
        state = follower.step(start.position, start.rotation)
        if state.position_error < 1e-3:
            break
    for _ in range(100):  # it stays there
        state = follower.step(start.position, start.rotation)
    assert state.position_error < 1e-3, describe(state)


def test_tuning(robot):
    follower = Follower(robot, START, DoubleIndicator(weight=0.5))
    follower.tune(weight=0.9, position_gain=3.0)
    assert (follower.scheme.weight, follower.scheme.position_gain) == (0.9, 3.0)
    assert follower.scheme.home == tuple(START)
    with pytest.raises(InvalidInputError, match="weight"):
        follower.tune(weight=2.0)
    assert follower.scheme.weight == 0.9
    # Above 1 / dt, a step of a period would overshoot.
    with pytest.raises(InvalidInputError, match=r"position_gain: must be at most 1 / dt = 200 1/s"):
        follower.tune(position_gain=1e4)
    assert follower.scheme.position_gain == 3.0
    follower.tune(position_gain=200.0)
    quick = Follower(robot, START, DoubleIndicator(drift_gain=1e4, limit_gain=1e3)).scheme
    assert (quick.drift_gain, quick.limit_gain) == (200.0, 200.0)


@pytest.mark.parametrize("gain", [0.0, 2.0, 10.0])
def test_an_error_decays_with_the_gain(gain, robot):
    follower = Follower(robot, START, DoubleIndicator(position_gain=gain))
    start = Configuration(robot, START)
    follower.push(np.full(7, 0.003))
    errors = [follower.step(start.position, start.rotation).position_error for _ in range(81)]
    assert errors[40] > 1e-4
    assert errors[80] == pytest.approx(errors[40] * np.exp(-gain * 0.2), rel=0.1)


def test_nobody_has_been_asked_before_the_first_step(robot):
    assert np.isnan(Follower(robot, START).check(CrossCheck()))


@pytest.mark.parametrize("side", [(0.0, -0.3, 0.0), (0.0, 0.0, 0.3)])
def test_an_arm_gives_way_to_a_ball_that_is_pushed_against_it(
    side: tuple[float, float, float],
) -> None:
    robot = load_robot("iiwa7")
    follower = Follower(robot, robot.start_posture())
    start = follower.configuration
    elbow = start.frame("iiwa7_link_4").position
    away = np.array(side)
    dragged = Ball(elbow + away, 0.08)
    follower.avoid(dragged)
    bodies = pin.buildGeomFromUrdf(robot.model, str(robot.path), pin.GeometryType.COLLISION)
    data = robot.model.createData()
    ball = coal.Sphere(0.08)
    least = np.inf
    placed = pin.GeometryData(bodies)
    request = coal.DistanceRequest()
    for _ in range(260):  # to where the elbow was, and on
        dragged.move(elbow - 0.1 * away, follower.dt)
        where = coal.Transform3s(np.eye(3), dragged.position)
        q = follower.step(start.position, start.rotation).q
        pin.updateGeometryPlacements(robot.model, data, bodies, placed, q)
        for body, at in zip(bodies.geometryObjects, placed.oMg, strict=True):
            if body.parentJoint > 2:
                pose = coal.Transform3s(at.rotation, at.translation)
                found = coal.DistanceResult()
                coal.distance(body.geometry, pose, ball, where, request, found)
                least = min(least, found.min_distance)
    assert np.abs(q - start.q).max() > 0.5
    assert least > 0.0199


def test_a_push_displaces_the_joints_inside_their_limits_and_is_made_good(robot):
    near = robot.with_limits(upper=np.append(np.full(6, 2.5), START[6] + 0.02))
    follower = Follower(near, START)
    start = follower.configuration
    follower.push(np.array([0.0, 0.05, 0.0, 0.0, 0.0, 0.0, 0.1]))
    errors = [follower.step(start.position, start.rotation).position_error for _ in range(20)]
    assert (follower.configuration.q <= near.q_upper).all()
    assert max(errors) > 0.01
    for _ in range(600):
        state = follower.step(start.position, start.rotation)
    assert state.position_error < 1e-5


def test_the_network_settles_from_rest_on_the_answer(robot):
    follower = Follower(robot, START)
    start = follower.configuration
    assert len(follower.settling()[0]) == 0
    target = start.position + np.array([0.02, 0.0, 0.0])
    before = follower.step(target, start.rotation).q
    after = follower.step(target, start.rotation).q
    times, distances = follower.settling()
    assert (np.diff(times) > 0.0).all()
    answer = np.abs(after - before) / follower.dt
    assert answer.max() > 0.05
    # From rest the distance is the answer itself, in the end it is zero.
    np.testing.assert_allclose(distances[0], answer, atol=0.05 * answer.max())
    assert distances[-1].max() < 1e-8


def test_the_distance_of_arm_and_ball(robot):
    follower = Follower(robot, START)
    assert np.isnan(follower.distance)
    tip = follower.configuration.position
    ball = Ball(tip + np.array([0.0, 0.0, 0.6]), 0.05)
    follower.avoid(ball)
    far = follower.distance
    ball.move(tip, follower.dt)
    assert 0.0 < far - follower.distance <= TIP_SPEED * follower.dt + 1e-9
    follower.avoid(None)
    assert np.isnan(follower.distance)


def test_an_arm_that_is_held_back_says_by_what(robot):
    follower = Follower(robot.with_limits(velocity=0.01), START)
    start = follower.configuration
    for _ in range(20):
        state = follower.step(start.position + [0.0, 0.1, 0.0], start.rotation)
    assert not state.command.ok
    assert "velocity limit" in describe(state)
    unnamed: Any = SimpleNamespace(ok=False, resolution=None)
    assert describe(replace(state, command=unnamed)) == "out of reach"
