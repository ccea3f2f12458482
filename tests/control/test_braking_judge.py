"""The judge of tests/braking.py: what it finds, and the way that it leads back."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("coal")

import iiwa_dnn
from braking import DISTANCE, SLACK, Case, Drive, judge_distances
from random_motion import Judge

ROBOT = iiwa_dnn.load_robot("iiwa7")


def test_the_judge_leaves_no_sample_out_that_is_too_near() -> None:
    start = ROBOT.start_posture()
    turn = np.zeros(7)
    turn[0] = -1.2
    on_the_way = iiwa_dnn.Configuration(ROBOT, start + 0.5 * turn).position
    ball = iiwa_dnn.Sphere(on_the_way, 0.08)
    avoidance = iiwa_dnn.CollisionAvoidance([ball], self_collision=False, distance=DISTANCE)
    case = Case(ROBOT, avoidance, (), "none", "relax", 1e-3, 100, False)
    path = start + np.linspace(0.0, 1.0, 300)[:, np.newaxis] * turn
    judge = Judge(ROBOT, avoidance)
    doubled = np.vstack([path, 0.5 * (path[1:] + path[:-1])])
    distances = np.array([judge.distance(q, 0.0) for q in doubled])
    too_near = (distances < DISTANCE - SLACK).sum()
    assert 0 < too_near < len(doubled)
    found = judge_distances(case, judge, Drive(path, np.ones(len(path) - 1, bool), 0.0))
    assert found.broken == too_near
    assert found.least == distances.min()
