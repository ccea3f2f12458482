"""A speed scale that changes while the arm moves."""

from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from helpers_export import in_armstep
from judge_limits import breaches

DT = 2e-3
ROBOT = iiwa_dnn.load_robot("iiwa7").with_limits(acceleration=10.0, jerk=500.0)
START = ROBOT.start_posture()
TOWARDS = np.array([1.0, -1.0, 1.0, 1.0, -1.0, 1.0, 1.0])


def shield() -> iiwa_dnn.Shield:
    """Return a shield of an arm among nothing, whose requests last."""
    return iiwa_dnn.Shield(ROBOT, DT, obstacles=None, timeout=np.inf)


def test_requests_use_the_part_of_the_limits_that_they_may() -> None:
    made = shield()
    q = START
    path = [q]
    for scale in (0.3, 1.0, 0.05, 0.5, 0.0, 0.2):
        made.scale_speed(scale)
        reached = []
        for k in range(250):
            sign = 1.0 if k < 125 else -1.0  # a request that is too quick, there and back
            command = made.step(q, 3.0 * sign * ROBOT.dq_max * TOWARDS)
            q = command.next_q
            path.append(q)
            reached.append(np.abs(command.dq) / ROBOT.dq_max)
            assert ("speed scale" in command.reasons) == (scale < 1.0)
        if scale <= 0.2:  # else the range of some joint ends before
            np.testing.assert_allclose(reached[120], scale, atol=1e-12)
        assert np.max(reached[110:125]) <= scale + 1e-12
    assert breaches(np.array(path), DT, *ROBOT.limits) == []


def test_positions_are_reached_at_the_scaled_speed_and_a_scale_outlasts_a_reset() -> None:
    made = shield()
    made.scale_speed(0.1)
    made.reset(START)
    goal = START + 0.3 * TOWARDS
    q = START
    speeds = []
    for _ in range(2200):
        command = made.step(q, position=goal)
        q = command.next_q
        speeds.append(np.abs(command.dq) / ROBOT.dq_max)
    np.testing.assert_allclose(q, goal, atol=1e-9)
    assert np.max(speeds) == pytest.approx(0.1, abs=1e-9)


def test_chunks_are_followed_within_the_part() -> None:
    made = shield()
    made.scale_speed(0.15)
    made.reset(START)
    times = np.arange(30) / 30.0
    ahead = 0.4 * ROBOT.dq_max.min() * TOWARDS * times[:, np.newaxis] ** 2
    made.follow(times, START + ahead / 2.0)
    q = START
    path = [q]
    for _ in range(1500):
        q = made.step(q).next_q
        path.append(q)
    speeds = np.abs(np.diff(path, axis=0)) / DT / ROBOT.dq_max
    assert 0.12 < speeds.max() <= 0.15 + 1e-9
    assert breaches(np.array(path), DT, *ROBOT.limits) == []
    np.testing.assert_allclose(q, START + ahead[-1] / 2.0, atol=1e-6)


def test_a_twist_keeps_its_direction() -> None:
    made = shield()
    twist = np.array([0.0, 0.6, 0.3, 0.0, 0.0, 0.0])
    made.scale_speed(0.08)
    q = START
    for _ in range(100):
        command = made.step(q, twist=twist)
        q = command.next_q
    there = iiwa_dnn.Configuration(ROBOT, command.state.motion[5 : 5 + ROBOT.dof])
    moved = there.jacobian[:3] @ command.dq
    assert np.abs(command.dq / ROBOT.dq_max).max() == pytest.approx(0.08, rel=0.05)
    assert moved @ twist[:3] / np.linalg.norm(moved) / np.linalg.norm(twist) > 0.999


def test_each_of_many_arms_has_its_own_scale_in_python_and_in_c(tmp_path: Path) -> None:
    own = shield()
    many = iiwa_dnn.Shields(own, 2)
    there = in_armstep(own, tmp_path)
    many.scale_speed(0.25, np.array([False, True]))
    there.scale_speed(0.25)
    q = np.tile(START, (2, 1))
    for _ in range(100):
        request = np.tile(ROBOT.dq_max * TOWARDS, (2, 1))
        exported = there.step(q[1], request[1])
        command = many.step(q, request)
        q = command.next_q
        np.testing.assert_array_equal(exported.dq, command.dq[1])
    assert np.abs(command.dq[0] / ROBOT.dq_max).max() > 0.5
    assert np.abs(command.dq[1] / ROBOT.dq_max).max() == pytest.approx(0.25, abs=1e-9)


@pytest.mark.parametrize("scale", [-0.1, 1.1, np.nan, "half", True])
def test_what_is_no_part_is_refused(scale: object) -> None:
    made = shield()
    with pytest.raises(iiwa_dnn.InvalidInputError, match="scale"):
        made.scale_speed(scale)
