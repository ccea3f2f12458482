"""Kinematics in C, against Pinocchio's."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from helpers_export import call, compiled_text, needs
from iiwa_dnn.export.kinematics import kinematics_code
from iiwa_dnn.robot.kinematics import Kinematics

pytestmark = needs("gcc")

# A joint of each kind, about and along slanting axes, and a branch of its own for a camera.
_JOINTS = [
    ("a", "base", "one", "revolute", "1 2 -0.5", "0.1 -0.2 0.3", "0.3 -1.2 2.0"),
    ("b", "one", "two", "prismatic", "0 -1 1", "0.1 0.2 0", "1.5707963267948966 0 0"),
    ("c", "two", "three", "continuous", "0 0 -1", "0 0 0.4", "0 0 0"),
    ("d", "three", "four", "revolute", "-1 0 0", "0.2 0 0", "0 0.5 0"),
    ("e", "one", "camera", "revolute", "0 1 0", "0 0 0.1", "0 0 0"),
    ("f", "four", "tool", "fixed", "0 0 1", "0.05 0 0.1", "0.1 0.2 0.3"),
]


def odd_robot(folder: Path) -> iiwa_dnn.Robot:
    """Write and load a robot with every kind of joint."""
    joints = [
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="{axis}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
        '<limit lower="-3" upper="3" velocity="2" effort="1"/></joint>'
        for name, parent, child, kind, axis, xyz, rpy in _JOINTS
    ]
    names = ["base", *(joint[2] for joint in _JOINTS)]
    inertia = '<inertia ixx="0.3" ixy="0.02" ixz="-0.01" iyy="0.2" iyz="0.03" izz="0.25"/>'
    links = [
        f'<link name="{name}"><inertial><origin xyz="0.1 -0.02 0.0{k}" rpy="0.{k} 0.2 -0.3"/>'
        f'<mass value="1.{k}"/>{inertia}</inertial></link>'
        for k, name in enumerate(names)
    ]
    path = folder / "odd.urdf"
    path.write_text(f'<robot name="odd">{"".join(links + joints)}</robot>', encoding="utf-8")
    return iiwa_dnn.load_robot(path, tip="tool", frames=["camera"])


def compare(robot: iiwa_dnn.Robot, frames: list[str], folder: Path) -> None:
    """Compare Jacobian, placements and inertia matrix at random postures."""
    kinematics = Kinematics(robot, frames, dynamics=True)
    text = kinematics_code(robot, kinematics.frame_ids, dynamics=True)
    head = "void entry(double *q, double *jacobian, double *placements, double *inertia)"
    text += f"\n\n{head};\n{head}\n{{\n    kinematics(q, jacobian, placements, inertia);\n}}\n"
    library = compiled_text(text, folder)
    rng = np.random.default_rng(0)
    jacobian = np.full((robot.dof, 6), np.nan)
    placements = np.zeros((robot.model.nframes, 12))
    inertia = np.full((robot.dof, robot.dof), np.nan)
    rows = list(kinematics.frame_ids)
    for q in rng.uniform(-3.0, 3.0, (100, robot.dof)):
        kinematics.update(q)
        call(library, "entry", q, jacobian, placements, inertia)
        np.testing.assert_allclose(jacobian, kinematics.jacobian, rtol=0, atol=1e-13)
        expected = kinematics.placements[rows]
        np.testing.assert_allclose(placements[rows], expected, rtol=0, atol=1e-13)
        np.testing.assert_allclose(inertia, kinematics.inertia, rtol=0, atol=1e-12)
    assert np.abs(placements[rows]).max() > 0.1


@pytest.mark.parametrize("name", ["iiwa7", "panda", "ur5", "xarm7", "iiwa7_dual"])
def test_arms_move_as_pinocchio_says(name: str, tmp_path: Path) -> None:
    robot = iiwa_dnn.load_robot(name)
    compare(robot, list(robot.frame_names), tmp_path)


def test_every_kind_of_joint_moves_as_pinocchio_says(tmp_path: Path) -> None:
    robot = odd_robot(tmp_path)
    robot.model.armature[:] = 0.1  # the motors' share
    compare(robot, ["tool", "camera", "one", "base"], tmp_path)


def test_tool_and_locked_joints_are_folded(tmp_path: Path) -> None:
    robot = iiwa_dnn.load_robot("iiwa7", locked=("iiwa7_joint_3",), tool=(0.1, 0, 0.2, 0.3, 0, 1))
    assert robot.dof == 6
    compare(robot, [robot.tip], tmp_path)
    text = kinematics_code(robot, [robot.tip_id])
    # One sine and one cosine a joint, and no product with a constant zero or one.
    assert text.count("sin(") == text.count("cos(") == 6
    assert " 0.0 *" not in text
    assert " 1.0 *" not in text
