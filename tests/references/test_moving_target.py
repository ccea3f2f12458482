"""A moving target of limited acceleration and jerk, judged by finite differences."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pinocchio as pin
import pytest

from helpers_simulation import paper_start
from iiwa_dnn import InvalidInputError, MovingTarget

DT = 1e-3


def test_a_filtered_target_keeps_its_limits_and_arrives() -> None:
    start = paper_start()
    hand = MovingTarget(start, 0.3, 1.2, acceleration=1.0, jerk=8.0)
    rng = np.random.default_rng(2)
    places, turns, velocities = [], [], []
    for k in range(6000):
        if k < 3000 and k % 230 == 0:
            place = start.position + rng.uniform(-0.3, 0.3, 3)
            turn = pin.exp3(rng.uniform(-1.0, 1.0, 3)) @ start.rotation
            hand.set(place, turn)
        target = hand.at(k * DT)
        places.append(target.position)
        turns.append(target.rotation)
        velocities.append(target.data[12:])
    path, v = np.array(places), np.array(velocities)
    for order, limit in enumerate((0.3, 1.0, 8.0), start=1):
        rate = np.linalg.norm(np.diff(path, order, axis=0), axis=1).max() / DT**order
        assert 0.3 * limit < rate <= limit * (1.0 + 1e-6)
    spin = np.array([pin.log3(b @ a.T) for a, b in itertools.pairwise(turns)]) / DT
    assert np.linalg.norm(spin, axis=1).max() <= 1.2 * (1.0 + 1e-6)
    assert np.linalg.norm(np.diff(spin, axis=0), axis=1).max() / DT <= 4.0 * 1.01
    # The velocities that are handed out are the derivatives of the poses.
    np.testing.assert_allclose(np.diff(path, axis=0) / DT, 0.5 * (v[1:] + v[:-1])[:, :3], atol=1e-5)
    np.testing.assert_allclose(spin, 0.5 * (v[1:] + v[:-1])[:, 3:], atol=1e-4)
    np.testing.assert_allclose(path[-1], place, atol=1e-12)
    np.testing.assert_allclose(turns[-1], turn, atol=1e-12)
    assert not v[-1].any()


def test_without_a_jerk_the_acceleration_jumps() -> None:
    hand = MovingTarget(paper_start(), 0.3, acceleration=1.0)
    hand.set(paper_start().position + [0.1, 0.0, 0.0])
    path = np.array([hand.at(k * DT).position for k in range(2000)])
    rates = np.linalg.norm(np.diff(path, 2, axis=0), axis=1) / DT**2
    assert rates.max() == pytest.approx(1.0 / math.sqrt(3.0), rel=1e-6)
    assert hand.settings()["acceleration"] == 1.0
    assert "jerk" not in hand.settings()


def test_bad_limits_are_refused() -> None:
    with pytest.raises(InvalidInputError, match="acceleration"):
        MovingTarget(paper_start(), acceleration=-1.0)
    with pytest.raises(InvalidInputError, match="needs an acceleration"):
        MovingTarget(paper_start(), jerk=1.0)
    with pytest.raises(InvalidInputError, match="speed"):
        MovingTarget(paper_start(), speed=0.0, acceleration=1.0)


LIMITS = ({}, {"acceleration": 1.0, "jerk": 10.0})


@pytest.mark.parametrize("limits", LIMITS, ids=["straight", "smooth"])
class TestClock:
    """A target is a function of the clock between two poses that are set."""

    def test_a_late_clock_value_does_not_keep_it_from_the_next_pose(self, limits) -> None:
        start = paper_start()
        hand = MovingTarget(start, 0.3, **limits)
        hand.at(0.0)
        hand.at(3600.0)
        hand.set(start.position + [0.1, 0.0, 0.0])
        hand.at(0.001)
        assert hand.at(0.301).position[0] > start.position[0] + 1e-2
        np.testing.assert_allclose(hand.at(3.0).position, start.position + [0.1, 0.0, 0.0])

    def test_sampling_ahead_moves_it_once(self, limits) -> None:
        start = paper_start()
        hand = MovingTarget(start, 0.3, **limits)
        once = MovingTarget(start, 0.3, **limits)
        for target in (hand, once):
            target.at(0.0)
            target.set(start.position + [0.1, 0.0, 0.0])
        for k in range(1, 100):
            hand.at(k * DT + DT)
            np.testing.assert_array_equal(hand.at(k * DT).data, once.at(k * DT).data)

    def test_a_slowed_clock_slows_it(self, limits) -> None:
        start = paper_start()
        hand = MovingTarget(start, 0.3, **limits)
        hand.at(0.0)
        hand.set(start.position + [0.1, 0.0, 0.0])
        path = np.array([hand.at(0.25 * k * DT).position for k in range(2000)])
        speeds = np.linalg.norm(np.diff(path, axis=0), axis=1) / DT
        assert 0.4 * 0.075 < speeds.max() < 0.075 * (1.0 + 1e-6)

    def test_a_pose_may_be_set_at_every_step(self, limits) -> None:
        start = paper_start()
        hand = MovingTarget(start, 0.3, **limits)
        for k in range(1000):
            hand.set(start.position + [0.1 + 1e-5 * k, 0.0, 0.0])
            target = hand.at(k * DT)
        np.testing.assert_allclose(target.position, start.position + [0.11, 0.0, 0.0], atol=2e-3)

    def test_a_pose_that_is_set_begins_from_the_one_shown(self, limits) -> None:
        start = paper_start()
        hand = MovingTarget(start, 0.3, **limits)
        hand.set(
            start.position + [0.1, 0.0, 0.0], pin.exp3(np.array([0.3, 0.0, 0.1])) @ start.rotation
        )
        for t in (0.0, 0.1, 0.05):  # the clock of a policy that slows a sampled step down
            shown = hand.at(t)
        hand.set(start.position - [0.1, 0.0, 0.0])
        again = hand.at(0.05)
        np.testing.assert_allclose(again.data[:12], shown.data[:12], rtol=0, atol=1e-14)
        soon = hand.at(0.051)
        assert np.linalg.norm(soon.position - shown.position) <= 0.3 * DT * (1.0 + 1e-6)
