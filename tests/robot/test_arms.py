"""Arms by name: the chain, its gripper, and the heart drawn with it, whatever its redundancy."""

from __future__ import annotations

import dataclasses
from itertools import product
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0, Array, example_urdf
from iiwa_dnn import (
    Configuration,
    DoubleIndicator,
    Heart,
    MissingDependencyError,
    Robot,
    available_robots,
    compute_metrics,
    failures,
    load_robot,
    robot_from_dh,
    simulate,
)
from iiwa_dnn.robot import arms
from iiwa_dnn.robot.arms import ARMS, TIPS

JOINTS = {
    "baxter_left": 7, "baxter_right": 7, "kinova": 6, "panda": 7, "talos_left": 9, "talos_right": 9,
    "talos_left_arm": 6, "tiago": 8, "ur3": 6, "ur5": 6, "ur10": 6, "xarm7": 7,
    "z1": 6,
}  # fmt: skip


def still(name: str) -> set[str]:
    """Joints that are not between base and tip, by the XML."""
    root = ElementTree.parse(example_urdf(ARMS[name].file)).getroot()
    above = {joint.find("child").get("link"): joint for joint in root.findall("joint")}
    names = {joint.get("name") for joint in above.values() if joint.get("type") != "fixed"}
    link = ARMS[name].tip
    while link in above:
        names.discard(above[link].get("name"))
        link = above[link].find("parent").get("link")
    return names


@pytest.fixture(autouse=True)
def installed() -> None:
    example_urdf("panda_description/urdf/panda.urdf")


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_by_its_name_is_the_file_without_the_gripper(name: str) -> None:
    robot, arm = load_robot(name), ARMS[name]
    assert (robot.name, robot.dof, robot.tip) == (name, JOINTS[name], arm.tip)
    assert set(robot.locked) == still(name)
    assert name in available_robots()
    # By its file, everything said by hand.
    by_hand = load_robot(example_urdf(arm.file), tip=arm.tip, locked=robot.locked)
    q = robot.start_posture()
    for one, other in (
        (robot.limits[:3], by_hand.limits[:3]),
        (Configuration(robot, q).pose, Configuration(by_hand, q).pose),
    ):
        np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(q, arm.start)


def is_inside(robot: Robot, q: Array) -> bool:
    return bool((q > robot.q_lower).all() and (q < robot.q_upper).all())


@pytest.mark.parametrize("name", [*TIPS, *ARMS])
def test_every_arm_starts_inside_its_limits_and_not_singular(name: str) -> None:
    robot = load_robot(name)
    # Of another name, or with a joint locked, its joints begin bent, where no arm is singular.
    other = dataclasses.replace(robot, name="some")
    locked = load_robot(name, locked=robot.joint_names[0])
    assert (robot.has_known_start, locked.has_known_start) == (True, False)
    for start, least in ((robot, 0.1), (other, 0.03), (locked, 0.0)):
        q = start.start_posture()
        assert is_inside(start, q)
        assert np.linalg.svd(Configuration(start, q).jacobian, compute_uv=False)[-1] >= least


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
def test_a_start_where_limits_are_on_one_side_or_on_none(lower: object, upper: object) -> None:
    robot = robot_from_dh(np.full((3, 4), 0.3), lower=lower, upper=upper)
    assert is_inside(robot, robot.start_posture())
    assert np.abs(robot.start_posture()).max() < 3.0 * np.pi


def test_locked_and_tip_can_be_chosen_besides() -> None:
    robot = load_robot("panda", tip="panda_link8", locked=("panda_joint3",))
    assert (robot.dof, robot.tip) == (6, "panda_link8")
    assert robot.locked == ("panda_finger_joint1", "panda_finger_joint2", "panda_joint3")


@pytest.mark.parametrize(
    ("name", "orientation"),
    [*product(ARMS, ["so3"]), *product(["ur5", "panda"], ["none"])],
)
def test_the_heart_with_any_redundancy(name: str, orientation: str) -> None:
    robot = load_robot(name)
    q0 = robot.start_posture()
    reference = Heart().anchored(Configuration(robot, q0))
    scheme = DoubleIndicator(orientation=orientation)
    record = simulate(robot, scheme, reference, q0, dt=2e-2)
    assert failures(record) == []
    metrics = compute_metrics(record)
    assert metrics["crosscheck"]["steps_checked"] == 500
    # Euler's error is of first order: two hundred times that of 1e-4 s, which is 3.4e-7 m.
    assert metrics["max_position_error_m"] < 1e-4
    assert (metrics["max_orientation_error_rad"] < 1e-3) == (orientation == "so3")


def test_without_the_package_one_line_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def missing(name: str) -> None:
        raise arms.PackageNotFoundError(name)

    monkeypatch.setattr(arms, "distribution", missing)
    with pytest.raises(MissingDependencyError, match=r"pip install 'iiwa-dnn\[robots\]'"):
        load_robot("panda")
    assert "panda" not in available_robots()
