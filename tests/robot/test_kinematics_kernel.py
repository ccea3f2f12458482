"""The kernel of the kinematics, against Pinocchio's."""

from pathlib import Path

import numpy as np
import pytest

import iiwa_dnn
from iiwa_dnn.robot import Robot, available_robots
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.robot.kinematics_kernel import model_tables, write_kinematics

# A joint of each kind, about and along slanting axes, and a branch of its own for a camera.
_JOINTS = [
    ("a", "base", "one", "revolute", "1 2 -0.5", "0.1 -0.2 0.3", "0.3 -1.2 2.0"),
    ("b", "one", "two", "prismatic", "0 -1 1", "0.1 0.2 0", "1.5707963267948966 0 0"),
    ("c", "two", "three", "continuous", "0 0 -1", "0 0 0.4", "0 0 0"),
    ("d", "three", "four", "revolute", "-1 0 0", "0.2 0 0", "0 0.5 0"),
    ("e", "one", "camera", "revolute", "0 1 0", "0 0 0.1", "0 0 0"),
    ("f", "four", "tool", "fixed", "0 0 1", "0.05 0 0.1", "0.1 0.2 0.3"),
]


def odd_robot(folder: Path) -> Robot:
    """Write and load a robot with every kind of joint."""
    joints = [
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="{axis}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
        + '<limit lower="-3" upper="3" velocity="2" effort="1"/></joint>'
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
    robot = iiwa_dnn.load_robot(path, tip="tool", frames=["camera"])
    robot.model.armature[:] = 0.1  # the motors' share
    return robot


def compare(robot: Robot, frames: tuple[str, ...]) -> None:
    """Compare Jacobian, placements and inertia matrix at random postures."""
    kinematics = Kinematics(robot, frames, dynamics=True)
    rows = list(kinematics.frame_ids)
    tables = model_tables(robot, rows, dynamics=True)
    rng = np.random.default_rng(0)
    jacobian = np.full((robot.dof, 6), np.nan)
    placements = np.full((robot.model.nframes, 12), np.nan)
    inertia = np.full((robot.dof, robot.dof), np.nan)
    for q in rng.uniform(-3.0, 3.0, (100, robot.dof)):
        kinematics.update(q)
        write_kinematics(tables, q, jacobian, placements, inertia)
        scale = max(1.0, np.abs(kinematics.jacobian).max())  # slides of 3 m take the arm far away
        np.testing.assert_allclose(jacobian, kinematics.jacobian, rtol=0, atol=4e-14 * scale)
        expected = kinematics.placements[rows]
        np.testing.assert_allclose(placements[rows], expected, rtol=0, atol=4e-14 * scale)
        largest = np.abs(kinematics.inertia).max()
        np.testing.assert_allclose(inertia, kinematics.inertia, rtol=0, atol=1e-14 * largest)
    assert np.abs(placements[rows]).max() > 0.1
    others = [k for k in range(robot.model.nframes) if k not in rows]
    assert np.isnan(placements[others]).all()


@pytest.mark.parametrize("name", available_robots())
def test_arms_move_as_pinocchio_says(name: str) -> None:
    robot = iiwa_dnn.load_robot(name)
    compare(robot, robot.frame_names[::2])


def test_every_kind_of_joint_moves_as_pinocchio_says(tmp_path: Path) -> None:
    robot = odd_robot(tmp_path)
    assert robot.dof == 5
    compare(robot, ("tool", "camera", "one", "base"))


def test_tool_and_locked_joints_are_in_the_tables() -> None:
    robot = iiwa_dnn.load_robot("iiwa7", locked=("iiwa7_joint_3",), tool=(0.1, 0, 0.2, 0.3, 0, 1))
    assert robot.dof == 6
    compare(robot, (robot.tip,))
