"""The meshes that a robot is drawn with."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest
import yourdfpy

from helpers_kinematics import example_urdf
from iiwa_dnn import InvalidInputError, Robot, load_robot
from iiwa_dnn.robot.shapes import visual_meshes


def placed(robot: Robot, q: np.ndarray) -> list[np.ndarray]:
    """Corners of every mesh in the world, (k, 3) each."""
    data = robot.model.createData()
    pin.forwardKinematics(robot.model, data, q)
    poses = [data.oMi[mesh.joint] for mesh in visual_meshes(robot)]
    meshes = zip(poses, visual_meshes(robot), strict=True)
    return [mesh.corners @ pose.rotation.T + pose.translation for pose, mesh in meshes]


@pytest.mark.parametrize("name", ["ur5", "xarm7"])
def test_meshes_are_where_yourdfpy_has_them(name: str) -> None:
    example_urdf("ur_description/urdf/ur5_robot.urdf")
    robot = load_robot(name)
    q = np.linspace(-1.0, 1.0, robot.dof)
    folder = str(robot.path.parents[3])
    other = yourdfpy.URDF.load(
        str(robot.path),
        filename_handler=lambda fname: fname.replace("package://example-robot-data", folder),
    )
    other.update_cfg(dict(zip(robot.joint_names, q, strict=True)))
    expected = np.array(other.scene.bounds)
    corners = np.vstack(placed(robot, q))
    np.testing.assert_allclose([corners.min(axis=0), corners.max(axis=0)], expected, atol=1e-5)


def test_a_robot_of_primitives_has_no_meshes() -> None:
    assert visual_meshes(load_robot("iiwa7")) == ()  # MuJoCo draws its cylinders and spheres


def test_a_robot_without_a_file_has_none() -> None:
    with pytest.raises(InvalidInputError, match="URDF file"):
        visual_meshes(dataclasses.replace(load_robot("iiwa7"), path=None))
