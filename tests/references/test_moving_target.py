"""A target that is set from outside, as a function of the clock between two poses that are set."""

import itertools

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn
from helpers_simulation import paper_start
from iiwa_dnn import MovingTarget
from iiwa_dnn.references.moving_target import LINEAR

DT = 1e-3
AWAY = np.array([0.1, 0.0, 0.0])


def test_it_keeps_its_speeds_and_arrives() -> None:
    start = paper_start()
    hand = MovingTarget(start, 0.3, 1.2)
    rng = np.random.default_rng(2)
    targets = []
    for k in range(6000):
        if k < 3000 and k % 230 == 0:
            place = start.position + rng.uniform(-0.3, 0.3, 3)
            turn = pin.exp3(rng.uniform(-1.0, 1.0, 3)) @ start.rotation
            hand.set(place, turn)
        targets.append(hand.at(k * DT))
    moved = np.array([b.position - a.position for a, b in itertools.pairwise(targets)]) / DT
    spin = np.array([pin.log3(b.rotation @ a.rotation.T) for a, b in itertools.pairwise(targets)])
    twists = np.array([target.data[12:] for target in targets])
    for rates, limit in ((moved, 0.3), (spin / DT, 1.2)):
        speeds = np.linalg.norm(rates, axis=1)
        assert 0.99 * limit < speeds.max() <= limit * (1.0 + 1e-9)
    acceleration = np.linalg.norm(np.diff(twists[:, :3], axis=0), axis=1) / DT
    assert acceleration.max() <= LINEAR * (1.0 + 1e-9)
    # The twist is the derivative of the pose, and continuous.
    means = np.hstack([moved, spin / DT])
    np.testing.assert_allclose(twists[1:-1], 0.5 * (means[1:] + means[:-1]), atol=1e-3)
    np.testing.assert_allclose(targets[-1].position, place, atol=1e-11)
    np.testing.assert_allclose(targets[-1].rotation, turn, atol=1e-11)
    assert not twists[-1].any()


def test_a_pose_that_is_set_alone_is_approached_straight_and_not_passed() -> None:
    start = paper_start()
    hand = MovingTarget(start, 0.5, 2.0)
    hand.at(0.0)
    axis = np.array([0.6, 0.0, 0.8])
    hand.set(start.position + AWAY, pin.exp3(0.5 * axis) @ start.rotation)
    targets = [hand.at(k * 5.0 * DT) for k in range(300)]
    moved = np.array([target.position - start.position for target in targets])
    turned = np.array([pin.log3(target.rotation @ start.rotation.T) for target in targets])
    for way, along, end in ((moved, AWAY / 0.1, 0.1), (turned, axis, 0.5)):
        length = way @ along
        np.testing.assert_allclose(way, np.outer(length, along), atol=1e-9)
        assert (np.diff(length) > -1e-12).all()
        np.testing.assert_allclose(length[-1], end, atol=1e-11)


@pytest.mark.parametrize("speed", [0.1, 0.25, 1.0])
def test_poses_of_a_hand_are_followed_beside_rate_limits_whatever_the_speed(speed: float) -> None:
    """At 6 to 91 mm, the more the quicker it might go: its speed jumped with each pose."""
    robot = iiwa_dnn.load_robot("iiwa7")
    q = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q)
    hand = MovingTarget(start, speed)
    rates = (iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits(500.0))
    scheme = iiwa_dnn.DoubleIndicator(weight=0.2, extra_limits=rates)
    controller = iiwa_dnn.Controller(robot, scheme, hand, dt=2e-3)
    off = []
    for k in range(2000):
        goal = start.position + [0.0, 0.05 * (1.0 - np.cos(np.pi * k * 1e-3)), 0.0]
        if k % 16 == 0:
            hand.set(goal)
        q = controller.step(q, k * 2e-3).next_q
        off.append(np.linalg.norm(iiwa_dnn.Configuration(robot, q).position - goal))
    assert np.max(off) < 3e-3
    assert np.median(off) < 1e-3


@pytest.mark.parametrize("turns", [False, True])
def test_a_stream_is_one_sample_late_and_comes_to_rest_where_it_ends(turns: bool) -> None:
    start = paper_start()
    hand = MovingTarget(start, 1.0, 2.0)
    axis = np.array([0.0, 0.6, 0.8])

    def angle(t: float) -> float:
        return float(0.4 * np.sin(np.clip(t, 0.0, np.pi)) ** 2)

    off = []
    for k in range(4000):
        t = k * DT
        if k % 100 == 0 and t < 3.5:
            size = angle(t)
            turn = pin.exp3(size * axis) @ start.rotation
            hand.set(start.position + (not turns) * size * axis, turn if turns else None)
        shown = hand.at(t)
        way = pin.log3(shown.rotation @ start.rotation.T) + shown.position - start.position
        off.append(np.linalg.norm(way - angle(t - 0.1) * axis))
    assert np.median(off[:3200]) < 4e-4
    assert np.max(off) < 2e-3
    assert off[-1] < 1e-9


def test_sampling_ahead_moves_it_once() -> None:
    start = paper_start()
    hand = MovingTarget(start, 0.3)
    once = MovingTarget(start, 0.3)
    for target in (hand, once):
        target.at(0.0)
        target.set(start.position + AWAY)
    for k in range(1, 100):
        hand.at(k * DT + DT)
        np.testing.assert_array_equal(hand.at(k * DT).data, once.at(k * DT).data)


def test_a_pose_that_is_set_begins_from_the_one_shown() -> None:
    start = paper_start()
    hand = MovingTarget(start, 0.3)
    hand.set(start.position + AWAY, pin.exp3(np.array([0.3, 0.0, 0.1])) @ start.rotation)
    for t in (0.0, 3600.0, 0.1, 0.05):  # the clock of a policy that slows a sampled step down
        shown = hand.at(t)
    hand.set(start.position - AWAY)
    np.testing.assert_allclose(hand.at(0.05).data[:12], shown.data[:12], rtol=0, atol=1e-14)
    soon = hand.at(0.051)
    assert np.linalg.norm(soon.position - shown.position) <= 0.3 * DT * (1.0 + 1e-6)
