"""Postures for poses: found ones are judged by Pinocchio, missing ones by geometry."""

import numpy as np
import pinocchio as pin
import pytest
from scipy.optimize import minimize

import iiwa_dnn as d


def error(robot: d.Robot, q: np.ndarray, target: d.Target) -> tuple[float, float]:
    """Distance [m] and angle [rad] of the tip from a target, by Pinocchio."""
    data = robot.model.createData()
    pin.framesForwardKinematics(robot.model, data, q)
    pose = data.oMf[robot.tip_id]
    turn = pin.log3(pose.rotation.T @ target.rotation)
    return float(np.linalg.norm(pose.translation - target.position)), float(np.linalg.norm(turn))


def pose_of(robot: d.Robot, q: np.ndarray) -> d.Target:
    conf = d.Configuration(robot, q)
    return d.Target(conf.position, conf.rotation)


@pytest.mark.parametrize("name", ["iiwa7", "panda", "ur5"])
def test_poses_that_can_be_reached_are_reached_within_the_limits(name: str) -> None:
    robot = d.load_robot(name)
    for q in robot.draw(np.random.default_rng(3), 6):
        target = pose_of(robot, q)
        answer = d.solve_pose(robot, target)
        assert answer.found
        assert max(error(robot, answer.q, target)) <= 1.001e-9
        assert robot.outside(answer.q) == ""
        assert answer.active_limits == ()


def test_the_answer_is_the_nearest_of_those_that_the_starts_lead_to() -> None:
    robot = d.load_robot("iiwa7")
    q0 = robot.start_posture()
    target = pose_of(robot, robot.draw(np.random.default_rng(5), 1)[0])
    few, many, again = (d.solve_pose(robot, target, q0, starts=k, seed=1) for k in (4, 20, 20))
    assert np.linalg.norm(many.q - q0) <= np.linalg.norm(few.q - q0)
    np.testing.assert_array_equal(many.q, again.q)


def test_a_posture_at_hand_is_its_own_answer() -> None:
    robot = d.load_robot("iiwa7")
    q0 = robot.start_posture()
    answer = d.solve_pose(robot, pose_of(robot, q0), q0)
    np.testing.assert_array_equal(answer.q, q0)


def test_a_pose_out_of_reach_gives_the_stretched_arm() -> None:
    """Both lower and upper arm point at the target: 0.4 m and 0.4 + 0.126 m from the shoulder."""
    robot = d.load_robot("iiwa7")
    shoulder = np.array([0.0, 0.0, 0.34])
    target = d.Target(shoulder + [3.0, 0.0, 0.0], pin.utils.rotate("y", np.pi / 2))
    answer = d.solve_pose(robot, target)
    assert not answer.found
    assert answer.q is None
    reach = np.linalg.norm(answer.nearest.position - shoulder)
    straight = np.linalg.norm(d.Configuration(robot, np.zeros(7)).position - shoulder)
    assert reach == pytest.approx(straight, abs=1e-3)
    assert answer.position_error == pytest.approx(3.0 - straight, abs=1e-3)
    assert answer.active_limits == ()


def test_a_limit_limiting_is_named() -> None:
    robot = d.load_robot("iiwa7")
    q = np.array([0.3, 0.6, 0.0, -1.2, 0.0, 0.8, 0.2])
    target = pose_of(robot, q)
    elbow = np.arange(7) == 3
    lower = np.where(elbow, -1.0, robot.q_lower)
    upper = np.where(elbow, 1.0, robot.q_upper)
    answer = d.solve_pose(robot.with_limits(lower=lower, upper=upper), target)
    assert not answer.found
    # The distance from shoulder to wrist is a function of the elbow's angle alone.
    assert abs(answer.nearest.q[3]) == pytest.approx(1.0, abs=1e-9)
    side = "lower" if answer.nearest.q[3] < 0.0 else "upper"
    assert f"joint 4 {side} position limit" in answer.active_limits


def test_no_velocity_limit_keeps_a_posture_from_a_pose() -> None:
    """A step of the last posture, which is almost singular, would be a long one."""
    robot = d.load_robot("panda")
    rng = np.random.default_rng(1)
    for _ in range(23):
        conf = d.Configuration(robot, robot.draw(rng, 1)[0])
        turn = pin.exp3(rng.uniform(-2.0, 2.0, 3))
        farther = rng.choice([1.0, 1.0, 1.02, 1.1])
    target = d.Target(conf.position * farther, turn @ conf.rotation)
    answer = d.solve_pose(robot, target, starts=6)
    assert not answer.found
    assert answer.active_limits == ()


def test_obstacles_are_kept_clear_of_and_named() -> None:
    robot = d.load_robot("iiwa7")
    q0 = robot.start_posture()
    target = pose_of(robot, q0)
    elbow = d.Configuration(robot, q0).frame("iiwa7_link_4").position
    beside = d.CollisionAvoidance([d.Sphere(elbow, 0.05)], distance=0.03)
    clear = d.solve_pose(robot, target, q0, obstacles=beside)
    assert max(error(robot, clear.q, target)) <= 1.001e-9
    assert beside.scene(robot).nearest(clear.q[None], np.zeros(1))[0] >= 0.03 - 2e-9
    assert beside.scene(robot).nearest(q0[None], np.zeros(1))[0] < 0.0
    ball = d.Sphere(target.position, 0.1)
    barred = d.solve_pose(robot, target, q0, obstacles=[ball], starts=5)
    assert not barred.found
    assert any("Sphere 1" in limit for limit in barred.active_limits)
    scene = d.CollisionAvoidance([ball]).scene(robot)
    assert scene.nearest(barred.nearest.q[None], np.zeros(1))[0] >= 0.02 - 1e-6


@pytest.mark.parametrize("upper", [2000.0, 100.0, 10.0, 0.5])
def test_a_long_slide_is_executed_in_steps_of_its_range(upper: float) -> None:
    """One start from the far end, for a slide alone and for one that carries an arm."""
    alone = d.robot_from_dh([(0, 0, 0, 0)], lower=0, upper=upper, velocity=1, prismatic=[1])
    carried = d.robot_from_dh(
        [(0.0, 0.0, 0.0, -np.pi / 2), (0.4, 0.0, 0.0, 0.0), (0.3, 0.0, 0.0, 0.0)],
        lower=[0.0, -3.0, -3.0],
        upper=[upper, 3.0, 3.0],
        velocity=1,
        prismatic=[1],
    )
    for robot in (alone, carried):
        for q in robot.draw(np.random.default_rng(8), 5):
            target = pose_of(robot, q)
            begin = np.clip(q, -0.9 * np.abs(q), 0.9 * np.abs(q))
            begin[0] = 0.0
            answer = d.solve_pose(robot, target, begin, starts=1)
            assert answer.found
            assert max(error(robot, answer.q, target)) <= 1.001e-9
            assert robot.outside(answer.q) == ""


def test_a_slide_without_limits_is_executed() -> None:
    slide = d.robot_from_dh([(0, 0, 0, 0)], prismatic=[1])
    answer = d.solve_pose(slide, pose_of(slide, np.array([12345.0])), [0.5], starts=1)
    assert answer.q == pytest.approx([12345.0], abs=1e-9)


def five_joints() -> d.Robot:
    """An arm of five joints, as of small kits."""
    quarter = np.pi / 2
    table = [
        (0.03, -quarter, 0.12, 0.0),
        (0.116, 0.0, 0.0, -quarter),
        (0.135, 0.0, 0.0, quarter),
        (0.0, -quarter, 0.0, -quarter),
        (0.0, 0.0, 0.1, 0.0),
    ]
    return d.robot_from_dh(table, lower=-1.9, upper=1.9, velocity=3.0)


def test_a_position_alone_is_found_by_five_joints() -> None:
    arm = five_joints()
    for q in arm.draw(np.random.default_rng(2), 5):
        target = d.Target(d.Configuration(arm, q).position)
        answer = d.solve_pose(arm, target, orientation="none")
        assert answer.found
        distance, angle = error(arm, answer.q, target)
        assert distance <= 1.001e-9
        assert answer.position_error == pytest.approx(distance, abs=1e-12)
        assert answer.orientation_error == pytest.approx(angle, rel=1e-9)
        assert arm.outside(answer.q) == ""


def test_of_a_pose_that_five_joints_do_not_have_the_position_comes_first() -> None:
    """No posture around that SLSQP finds has the position and a smaller angle."""
    arm = five_joints()
    start = d.Configuration(arm, arm.start_posture())
    target = d.Target(start.position + [0.0, 0.05, 0.0], start.rotation)
    answer = d.solve_pose(arm, target, starts=5)
    assert not answer.found
    assert answer.q is None
    distance, angle = error(arm, answer.nearest.q, target)
    assert distance < 1e-9
    assert answer.position_error < 1e-9
    at = {
        "type": "eq",
        "fun": lambda q: 10.0 * (d.Configuration(arm, q).position - target.position),
    }
    best = np.inf
    for q in answer.nearest.q + np.random.default_rng(0).uniform(-0.2, 0.2, (3, 5)):
        found = minimize(
            lambda q: error(arm, q, target)[1] ** 2,
            q,
            bounds=[*zip(arm.q_lower, arm.q_upper, strict=True)],
            constraints=[at],
            options={"ftol": 1e-12, "maxiter": 300},
        )
        if error(arm, found.x, target)[0] < 1e-6:
            best = min(best, found.fun**0.5)
    assert best < np.inf
    assert angle == pytest.approx(best, rel=1e-3)
