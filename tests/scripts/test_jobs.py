"""Programs by job: what they send keeps the limits, by judges of their own."""

import os
import struct
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn
from fake_ur import Robot
from helpers_export import needs, use_armstep
from judge_distances import Judge
from judge_limits import breaches
from judge_people import apart, place, skeleton_of
from scripts import chunks, deltas, gamepad_ur, payload, person, two_arms, vector_environment


@pytest.mark.parametrize("name", ["so101", "fr3"])
def test_chunks_are_followed_without_lag_and_seams_make_no_jump(name: str) -> None:
    path, late, off = chunks.run(name, 5.0)
    robot = iiwa_dnn.load_robot(name)
    if name == "so101":
        robot = robot.with_limits(acceleration=10.0, jerk=200.0)
    assert breaches(path, chunks.PERIODS[name], *robot.limits) == []
    assert late == 0.0
    assert off < 2.5 * chunks.SEAM
    times = chunks.PERIODS[name] * np.arange(len(path))
    waves = 0.3 * np.sin(times[:, np.newaxis] * np.linspace(1.0, 1.5, robot.dof))
    assert np.abs(path - path[0] - waves).max() < 3.0 * chunks.SEAM


def test_steps_of_the_hand_add_up_and_a_limit_stops_the_goal() -> None:
    random = np.random.default_rng(1)
    actions = np.vstack([[deltas.policy(k, random) for k in range(20)], np.zeros((10, 7))])
    path, opening = deltas.run(actions)
    robot = iiwa_dnn.load_robot("fr3")
    assert breaches(path, deltas.DT, *robot.limits) == []
    start, end = (iiwa_dnn.Configuration(robot, q) for q in path[[0, -1]])
    moved = end.position - start.position
    np.testing.assert_allclose(moved, actions[:, :3].sum(axis=0), atol=1e-3)
    turned = np.eye(3)
    for action in actions:
        turned = pin.exp3(action[3:6]) @ turned
    np.testing.assert_allclose(end.rotation, turned @ start.rotation, atol=1e-3)
    assert np.abs(np.diff(opening)).max() <= deltas.GRIPPER_SPEED * deltas.DT * 1.000001
    assert opening[1000] == 1.0
    assert opening[-1] == 0.0
    out = np.tile([0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], (60, 1))  # 1.2 m
    back = np.vstack([out, -out[:10]])
    path, _ = deltas.run(back)
    x = [iiwa_dnn.Configuration(robot, q).position[0] for q in path[[-1001, -1]]]
    assert x[1] - x[0] < -0.08


def test_two_hands_that_want_to_one_point_stay_apart() -> None:
    path, command = two_arms.run(2000)
    robot = iiwa_dnn.load_robot("iiwa7_dual").with_limits(jerk=500.0)
    assert breaches(path, 2e-3, *robot.limits) == []
    judge = Judge(robot, iiwa_dnn.CollisionAvoidance([], distance=0.03))
    distances = [judge.distance(q, 0.0) for q in path[::20]]
    assert 0.0299 < min(distances) < 0.031
    assert np.abs(command.dq).max() < 0.05


def test_an_arm_rests_where_a_person_is_near() -> None:
    path = person.run(6.2)
    robot = iiwa_dnn.load_robot("iiwa7").with_limits(jerk=500.0)
    assert breaches(path, person.DT, *robot.limits) == []
    arm = skeleton_of(robot)
    ends = np.empty(arm.ends.shape)
    speed = np.abs(np.diff(path, axis=0)).max(axis=1) / person.DT
    near = np.empty(speed.size)
    for k, q in enumerate(path[:-1]):
        place(arm, q, ends)
        body = np.array(person.person(k * person.DT))
        gaps = [apart(link, body)[0] - radius for link, radius in zip(ends, arm.radii, strict=True)]
        near[k] = min(gaps) - person.RADIUS
    assert near.min() < 0.02
    assert speed[near < 0.02].max() < 1e-9
    assert speed.max() > 0.3
    assert (speed[: round(0.5 / person.DT)] > 0.1).any()


def test_torques_with_a_payload_are_within_the_limits() -> None:
    free, _ = payload.run(4000, is_limited=False)
    bounded, path = payload.run(4000, is_limited=True)
    assert free > 1.0
    assert bounded <= 0.95 + 1e-9
    assert np.ptp(path, axis=0).max() > 0.5
    assert breaches(path, payload.DT, *iiwa_dnn.load_robot("fr3").limits) == []


def test_episodes_of_a_vector_environment_end_one_by_one_and_keep_the_limits() -> None:
    env = vector_environment.make(8)
    limits = iiwa_dnn.load_robot("so101").with_limits(acceleration=10.0, jerk=200.0).limits
    random = np.random.default_rng(0)
    before, _ = env.reset(seed=0)
    paths = [[q] for q in before]
    ended = 0
    for _ in range(300):
        joints, _, _, over, _ = env.step(random.normal(0.0, 10.0, (8, 5)))
        for i in range(8):
            if over[i]:
                assert breaches(np.array(paths[i]), vector_environment.DT, *limits) == []
                paths[i] = []
                ended += 1
            paths[i].append(joints[i])
    assert ended >= 8
    assert min(np.ptp(each, axis=0).max() for each in paths if len(each) > 50) > 0.01


@needs("gcc")
def test_a_gamepad_moves_a_ur_and_unplugged_it_lets_it_brake(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    use_armstep()
    from armstep_drivers.ur import UR  # of armstep's library

    arm = iiwa_dnn.load_robot("ur5").with_limits(acceleration=8.0, jerk=80.0)
    robot = Robot(arm.start_posture().tolist())
    for name, module in robot.modules().items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.setattr(UR, "now", lambda _: robot.t)
    pipe = tmp_path / "js0"
    os.mkfifo(pipe)
    sender = os.open(pipe, os.O_RDWR)
    wait = robot.waitPeriod

    def play(began: float) -> None:
        wait(began)
        if len(robot.path) == 1:
            os.write(sender, struct.pack("=IhBB", 0, 0, 0x82, 4))  # the state at the beginning
        if len(robot.path) == 50:
            os.write(sender, struct.pack("=IhBB", 400, -16384, 0x02, 4))  # half up
        if len(robot.path) == 300:
            os.close(sender)

    monkeypatch.setattr(robot, "waitPeriod", play)
    tables = str(tmp_path / "ur5.json")
    gamepad_ur.main("192.168.1.2", str(pipe), tables, duration=3.0)
    assert "ended: the time is over" in capsys.readouterr().out
    goals = np.array(robot.goals)
    assert breaches(np.vstack([arm.start_posture(), goals]), gamepad_ur.DT, *arm.limits) == []
    z: Any = [iiwa_dnn.Configuration(arm, q).position[2] for q in robot.path]
    assert (z[250] - z[150]) / (100 * gamepad_ur.DT) == pytest.approx(0.125, rel=0.02)
    assert abs(z[-1] - z[340]) < 1e-3  # it has braked
