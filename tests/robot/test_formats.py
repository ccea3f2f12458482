"""Robots from a Pinocchio model, and with joints that do not move the tip."""

from __future__ import annotations

import warnings
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn as d
from helpers_kinematics import example_urdf
from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.shapes import visual_meshes

FINGERS = ("panda_finger_joint1", "panda_finger_joint2")


def written(folder: Path, name: str, text: str) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def test_of_a_xacro_file_the_program_that_makes_a_urdf_is_named(tmp_path: Path) -> None:
    with pytest.raises(d.FileError, match=r"make a URDF of it: xacro a.xacro -o a.urdf"):
        d.load_robot(written(tmp_path, "a.xacro", "<robot/>"))


def chain(*links: tuple[str, str]) -> str:
    """A URDF of revolute joints `j_CHILD` about z, 0.3 m from their parents."""
    names = dict.fromkeys(name for pair in links for name in pair)
    text = "".join(f'<link name="{name}"/>' for name in names)
    for parent, child in links:
        text += (
            f'<joint name="j_{child}" type="revolute"><parent link="{parent}"/>'
            f'<child link="{child}"/><origin xyz="0.3 0 0"/><axis xyz="0 0 1"/>'
            '<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>'
        )
    return f'<robot name="chain">{text}</robot>'


def test_a_joint_that_does_not_move_the_tip_is_held_still_and_it_is_said(tmp_path: Path) -> None:
    path = written(tmp_path, "two.urdf", chain(("base", "a"), ("a", "left"), ("a", "right")))
    with pytest.raises(d.InvalidInputError, match="several ends: left, right"):
        d.load_robot(path)
    with pytest.warns(UserWarning, match="^held still, since they do not move left: j_right at 0$"):
        robot = d.load_robot(path, tip="left")
    assert robot.joint_names == ("j_a", "j_left")
    assert robot.locked == ("j_right",)
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # what was asked for is not said
        assert d.load_robot(path, tip="left", locked="j_right").dof == 2
        both = d.load_robot(path, tip="left", frames=["right"])
    assert both.joint_names == ("j_a", "j_left", "j_right")
    with pytest.raises(d.NotFoundError, match="no frame 'rihgt'"):
        d.load_robot(path, tip="left", frames=["rihgt"])


def test_the_fingers_of_a_panda_are_held_still_unless_one_is_the_tip() -> None:
    path = example_urdf("panda_description/urdf/panda.urdf")
    with pytest.warns(UserWarning, match="panda_hand_tcp: panda_finger_joint1 at 0, panda_finger"):
        robot = d.load_robot(path, tip="panda_hand_tcp")
    assert (robot.name, robot.dof, robot.locked) == ("panda", 7, FINGERS)
    with pytest.raises(d.InvalidInputError, match=r"several ends: .*panda_hand_tcp") as caught:
        d.load_robot(path)
    assert caught.value.argument == "tip"
    first, second = FINGERS
    with pytest.raises(d.InvalidInputError, match=f"{second!r} follows {first!r}: lock it"):
        d.load_robot(path, tip="panda_rightfinger")


@pytest.mark.parametrize("unlimited", [True, False])
def test_a_pinocchio_model_is_a_robot_too(unlimited: bool) -> None:
    ours = d.load_robot("iiwa7")
    model = ours.model.copy()
    if unlimited:
        model.upperPositionLimit[2] = np.finfo(float).max  # Pinocchio's own way to say none
    robot = d.load_robot(model)
    assert (robot.name, robot.tip, robot.path) == ("iiwa7", "iiwa7_flange", None)
    q = ours.start_posture()
    np.testing.assert_array_equal(d.Configuration(robot, q).pose, d.Configuration(ours, q).pose)
    expected = ours.limits.copy()
    if unlimited:
        expected[1, 2] = np.inf
    np.testing.assert_array_equal(robot.limits, expected)
    with pytest.warns(UserWarning, match="do not move iiwa7_link_5: iiwa7_joint_6 at 0"):
        assert d.load_robot(model, tip="iiwa7_link_5").dof == 5
    arm = pin.buildSampleModelManipulator()
    reached = d.load_robot(arm, tip="effector_body")
    np.testing.assert_array_equal(reached.q_upper, arm.upperPositionLimit)
    with pytest.raises(d.InvalidInputError, match="must come from a URDF file"):
        visual_meshes(robot)


def test_moments_of_inertia_that_no_body_has_are_raised() -> None:
    text = '<robot><link><inertial><inertia ixx="1" iyy="1e-9" izz="0"/></inertial></link></robot>'
    root = ET.fromstring(text)
    urdf.mend_inertias(root)
    inertia = root.find("link/inertial/inertia")
    assert inertia is not None
    assert [float(inertia.get(k, "0")) for k in ("ixx", "iyy", "izz")] == [1.0, 0.51, 0.51]
