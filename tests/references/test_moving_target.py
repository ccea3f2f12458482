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
