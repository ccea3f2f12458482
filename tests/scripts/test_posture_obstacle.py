"""The second paper's arm, rows and runs, beside finite differences and a second implementation."""

import runpy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from helpers_kinematics import Array, finite_difference
from iiwa_dnn import Configuration, Step

SCRIPT = Path(__file__).parents[2] / "scripts" / "posture_obstacle.py"
study = SimpleNamespace(**runpy.run_path(str(SCRIPT)))
ARM = study.arm()
FRAMES = ("base", *(f"link_{i}" for i in range(1, 7)))
NEAR = np.array([-0.1, 0.05, 0.1, -0.2, 0.1, 0.3]) + study.START
"""A posture near the point."""


def step_at(q: Array, dq: Array) -> Step:
    return Step(ARM, q, dt=1e-3, dq=dq)


def states(q: Array) -> list:
    conf = Configuration(ARM, q)
    return [conf.frame(name) for name in FRAMES]


def test_posture_rows_are_the_rates_of_the_vertical_seen_from_the_tool() -> None:
    A, b = study.Posture(3).equations(step_at(NEAR, np.zeros(6)))
    expected = finite_difference(lambda q: Configuration(ARM, q).rotation[2], NEAR)
    np.testing.assert_allclose(A, expected, atol=1e-8)
    assert not b.any()
    assert np.linalg.matrix_rank(A, 1e-9) == 2
    np.testing.assert_array_equal(study.Posture(2).equations(step_at(NEAR, b.repeat(2)))[0], A[:2])


def test_nearest_points_are_the_nearest_of_many() -> None:
    points, distance = study.nearest_points(states(NEAR))
    joints = np.array([f.position for f in states(NEAR)])
    joints[3] -= 0.2073 * states(NEAR)[3].rotation[:, 2]
    samples = (
        joints[1:3, None] + np.linspace(0, 1, 2001)[:, None] * np.diff(joints, axis=0)[1:3, None]
    )
    brute = np.linalg.norm(samples - study.OBSTACLE, axis=-1).min(axis=1)
    np.testing.assert_allclose(distance[1:3], brute, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(points - study.OBSTACLE, axis=1), distance)


@pytest.mark.parametrize("link", [2, 3])
def test_jacobian_of_the_nearest_point(link: int) -> None:
    frames = states(NEAR)
    critical, _ = study.nearest_points(frames)
    body = frames[link].rotation.T @ (critical[link - 1] - frames[link].position)

    def move(q: Array) -> Array:
        frame = states(q)[link]
        return frame.position + frame.rotation @ body

    expected = finite_difference(move, NEAR)
    printed = study.PointAvoidance().jacobian(frames, critical, link - 1)
    if link == 2:
        np.testing.assert_allclose(printed, expected, atol=1e-8)
    else:  # the authors' point lies on the axis of the link's own joint, which does not move it
        assert not np.allclose(printed, expected, atol=1e-2)
        np.testing.assert_allclose(printed[:, link - 1], 0.0, atol=1e-12)
        assert np.linalg.norm(expected[:, link - 1]) > 0.01


def test_rows_of_avoidance_remember_the_approach_at_the_outer_distance() -> None:
    limit, dq, approach = study.PointAvoidance(), np.array([-0.1, 0, 0, 0, 0, 0]), []
    for turned in np.linspace(0.0, 0.1, 400):  # joint 1 alone turns the arm towards the point
        q = study.START - turned * np.eye(6)[0]
        G, h = limit.inequalities(step_at(q, dq))
        distance = study.nearest_points(states(q))[1].min()
        if distance > study.OUTER * 1.001:
            assert not h.any()
        elif distance < study.OUTER * 0.998 and not G[3:].any():  # one link is near
            assert (h >= 0.0).all()
            scale = (distance - study.INNER) / (study.OUTER - study.INNER)
            approach.append(h.max() / max(scale, 1e-9))
    np.testing.assert_allclose(approach, approach[0], rtol=1e-9)
    assert approach[0] > 0.0


@pytest.mark.filterwarnings("ignore:in continuous mode the rows")  # as the authors run it
def test_tilt_and_distance_are_kept() -> None:
    record = study.run("AOA-3PF", 4e-3, 1.8)
    assert record.settings["status"] == "completed"
    distance, posture = study.over_time(record.q)
    assert study.INNER < distance.min() < study.OUTER
    assert posture.max() < np.deg2rad(1.0)
    assert np.linalg.norm(record.position - record.position_desired, axis=1).max() < 1e-3
