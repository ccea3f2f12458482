"""A target that is set from outside, as a function of the clock between two poses that are set."""

import itertools

import numpy as np
import pinocchio as pin

from helpers_simulation import paper_start
from iiwa_dnn import MovingTarget

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
    for rates, limit in ((moved, 0.3), (spin / DT, 1.2)):
        speeds = np.linalg.norm(rates, axis=1)
        assert 0.99 * limit < speeds.max() <= limit * (1.0 + 1e-9)
    # The twist is the derivative of the pose wherever both ends of a step are in motion.
    twists = np.array([target.data[12:] for target in targets])
    steady = (twists[:-1] == twists[1:]).all(axis=1)
    np.testing.assert_allclose(
        twists[:-1][steady], np.hstack([moved, spin / DT])[steady], atol=1e-9
    )
    np.testing.assert_allclose(targets[-1].position, place, atol=1e-12)
    np.testing.assert_allclose(targets[-1].rotation, turn, atol=1e-12)
    assert not twists[-1].any()


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
