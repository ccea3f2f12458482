"""The benchmarks of arrivals and of braking: what they draw, and what they judge."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("coal")

import iiwa_dnn
from benchmarks.arrivals import DT, OWN, arrival, draw_postures, measure_arrivals, summary
from benchmarks.braking import DISTANCE, SLACK, Case, Drive, judge_distances, way_back
from benchmarks.random_motion import Judge

ROBOT = iiwa_dnn.load_robot("iiwa7")


def test_postures_are_within_the_limits_and_near_in_turn() -> None:
    drawn = draw_postures(ROBOT, 20, 0)
    assert (drawn > ROBOT.q_lower).all()
    assert (drawn < ROBOT.q_upper).all()
    far = np.abs(drawn - ROBOT.start_posture()).max(axis=1)
    assert far[::2].max() < 1.2 < far[1::2].max()


def test_an_arrival_is_the_last_time_that_a_tip_was_away() -> None:
    start = ROBOT.start_posture()
    goal = iiwa_dnn.Configuration(ROBOT, start)
    away = start + 0.1
    path = np.array([away, start, away, start, start])
    assert arrival(ROBOT, path, goal) == pytest.approx(4 * DT)
    assert arrival(ROBOT, path[:3], goal) == np.inf
    assert arrival(ROBOT, path[3:], goal) == DT
    assert summary(np.array([1.0, np.inf, 3.0])) == ["2 of 2", "0 of 1", "2.00", "3.00"]


def test_the_own_loop_arrives_at_a_near_pose() -> None:
    postures = ROBOT.start_posture() + np.array([[0.05] * 7, [-0.05] * 7])
    times, missing = measure_arrivals(ROBOT, postures, 2.5, {}, OWN[:1])
    assert not missing
    assert (times["iiwa_dnn"] < 2.0).all()
    assert (times["iiwa_dnn"] > 0.2).all()


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


def test_the_way_back_leaves_loops_out() -> None:
    there = np.linspace(0.0, 1.0, 101)[:, np.newaxis]
    path = np.vstack([there, there[::-1], there])
    postures = np.array(way_back(path))
    assert len(postures) < 110
    assert postures[-1] == 0.0
    assert (np.diff(postures[:, 0]) <= 0.0).all()
