"""Postures to start from: known ones, and a bent one for any other robot."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0, example_urdf
from iiwa_dnn import Configuration, Robot, load_robot, robot_from_dh
from iiwa_dnn.robot.arms import ARMS, TIPS


def load(name: str) -> Robot:
    if name in ARMS:
        example_urdf(ARMS[name].file)
    return load_robot(name)


def smallest(robot: Robot, q: np.ndarray) -> float:
    return float(np.linalg.svd(Configuration(robot, q).jacobian, compute_uv=False)[5])


def is_inside(robot: Robot, q: np.ndarray) -> bool:
    return bool((q > robot.q_lower).all() and (q < robot.q_upper).all())


@pytest.mark.parametrize("name", [*TIPS, *ARMS])
def test_every_named_arm_has_a_start_inside_its_limits_and_not_singular(name: str) -> None:
    robot = load(name)
    assert robot.has_known_start
    assert is_inside(robot, robot.start_posture())
    assert smallest(robot, robot.start_posture()) > 0.1
    if name in ARMS:
        np.testing.assert_array_equal(robot.start_posture(), ARMS[name].start)
    # Of another name, or with a joint locked, its joints begin bent, where no arm is singular.
    for other in (
        dataclasses.replace(robot, name="some"),
        load_robot(name, locked=robot.joint_names[0]),
    ):
        assert not other.has_known_start
        assert is_inside(other, other.start_posture())
    bent = dataclasses.replace(robot, name="some").start_posture()
    assert smallest(robot, bent) > 0.03


def test_the_iiwa_starts_where_the_paper_does_or_as_near_as_its_limits_let_it() -> None:
    robot = load_robot("iiwa7")
    np.testing.assert_array_equal(robot.start_posture(), PAPER_Q0)
    tight = robot.with_limits(lower=-2.0, upper=2.0)
    expected = [-1.8, *PAPER_Q0[1:]]  # the first joint's -2.357 is outside
    np.testing.assert_allclose(tight.start_posture(), expected, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("lower", "upper"),
    [(-np.inf, np.inf), (1.0, np.inf), (-np.inf, -1.0), ([-1, -np.inf, 4], [np.inf, 2, 5])],
)
def test_limits_on_one_side_or_on_none(lower: object, upper: object) -> None:
    robot = robot_from_dh(np.full((3, 4), 0.3), lower=lower, upper=upper)
    q = robot.start_posture()
    assert is_inside(robot, q)
    assert np.abs(q).max() < 3.0 * np.pi
