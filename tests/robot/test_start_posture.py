"""Postures to start from: known ones, and for any other robot one that is not singular."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0, Array, example_urdf
from iiwa_dnn import CrossCheck, DoubleIndicator, Heart, compute_metrics, failures, simulate
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.robot.robot import SINGULAR

MIDDLE = {
    "baxter_left", "baxter_right", "panda", "talos_left", "talos_right", "tiago", "tiago_mobile",
    "xarm7", "z1",
}  # fmt: skip
"""Arms whose joints can all be in the middle of their ranges."""


def load(name: str) -> Robot:
    if name in ARMS:
        example_urdf(ARMS[name].file)
    return load_robot(name)


def nameless(name: str) -> Robot:
    return dataclasses.replace(load(name), name="some")


def smallest(robot: Robot, q: Array) -> float:
    rows = 6 if robot.dof >= 6 else 3
    values = np.linalg.svd(Configuration(robot, q).jacobian[:rows], compute_uv=False)
    return float(values[min(rows, robot.dof) - 1])


def is_inside(robot: Robot, q: Array) -> bool:
    return bool((q > robot.q_lower).all() and (q < robot.q_upper).all())


def test_known_postures() -> None:
    np.testing.assert_array_equal(load_robot("iiwa7").start_posture(), PAPER_Q0)
    for name, arm in ARMS.items():
        if arm.start:
            np.testing.assert_array_equal(load(name).start_posture(), arm.start)


def test_a_known_posture_outside_the_limits_is_not_taken() -> None:
    robot = load_robot("iiwa7").with_limits(lower=-2.0, upper=2.0)
    assert is_inside(robot, robot.start_posture())
    assert smallest(robot, robot.start_posture()) > SINGULAR


@pytest.mark.parametrize("name", ["iiwa7", *ARMS])
def test_no_start_is_singular(name: str) -> None:
    robot = nameless(name)
    q = robot.start_posture()
    assert q.shape == (robot.dof,)
    assert is_inside(robot, q)
    assert smallest(robot, q) >= SINGULAR
    np.testing.assert_array_equal(q, robot.start_posture())
    middle = np.clip(0.5 * (robot.q_lower.clip(-7) + robot.q_upper.clip(max=7)), -7, 7)
    is_middle = np.allclose(q, middle, atol=1e-12)
    assert is_middle == (smallest(robot, middle) >= SINGULAR) == (name in MIDDLE)


@pytest.mark.parametrize("name", ["iiwa7", "talos_left_arm", "ur5"])
def test_the_heart_can_be_drawn_where_the_middle_is_singular(name: str) -> None:
    robot = nameless(name)
    q = robot.start_posture()
    heart = Heart().anchored(Configuration(robot, q))
    record = simulate(robot, DoubleIndicator(), heart, q, dt=1e-2, check=CrossCheck(()))
    assert failures(record) == []
    assert compute_metrics(record)["max_position_error_m"] < 1e-4
    drawn = np.ptp(record.position, axis=0)
    np.testing.assert_allclose(drawn, np.ptp(record.position_desired, axis=0), atol=1e-3)


def chain(*joints: str, limit: str = 'lower="-1" upper="2"') -> str:
    """A URDF of joints one behind the other, each 0.3 m long."""
    links = "".join(f'<link name="l{i}"/>' for i in range(len(joints) + 2))
    text = "".join(
        f'<joint name="j{i}" type="revolute"><parent link="l{i}"/><child link="l{i + 1}"/>'
        f'<origin xyz="{0.3 if i else 0} 0 0"/><axis xyz="{axis}"/>'
        f'<limit {limit} effort="1" velocity="1"/></joint>'
        for i, axis in enumerate(joints)
    )
    n = len(joints)
    tip = (
        f'<joint name="end" type="fixed"><parent link="l{n}"/><child link="l{n + 1}"/>'
        '<origin xyz="0.3 0 0"/></joint>'
    )
    return f'<robot name="chain">{links}{text}{tip}</robot>'


@pytest.mark.parametrize(
    ("joints", "rank"),
    [(["0 0 1"] * 3, 2), (["0 0 1"] * 2, 2), (["0 0 1", "0 1 0", "0 1 0"], 3), (["0 0 1"], 1)],
    ids=["planar", "two joints", "three joints", "one joint"],
)
def test_arms_of_few_joints_start_bent(joints: list[str], rank: int, tmp_path: Path) -> None:
    (tmp_path / "chain.urdf").write_text(chain(*joints, limit='lower="-2" upper="2"'))
    robot = load_robot(tmp_path / "chain.urdf")
    q = robot.start_posture()
    assert is_inside(robot, q)
    values = np.linalg.svd(Configuration(robot, q).jacobian[:3], compute_uv=False)
    assert values[rank - 1] >= SINGULAR


def test_a_tip_on_its_only_axis_starts_in_the_middle(tmp_path: Path) -> None:
    (tmp_path / "chain.urdf").write_text(chain("1 0 0"))
    np.testing.assert_array_equal(load_robot(tmp_path / "chain.urdf").start_posture(), [0.5])


@pytest.mark.parametrize(
    ("lower", "upper"),
    [(-np.inf, np.inf), (1.0, np.inf), (-np.inf, -1.0), ([-1, -np.inf, 4], [np.inf, 2, 5])],
)
def test_limits_on_one_side_or_on_none(lower, upper, tmp_path: Path) -> None:
    (tmp_path / "chain.urdf").write_text(chain("0 0 1", "0 1 0", "0 1 0"))
    robot = load_robot(tmp_path / "chain.urdf").with_limits(lower, upper)
    q = robot.start_posture()
    assert is_inside(robot, q)
    assert smallest(robot, q) >= SINGULAR
