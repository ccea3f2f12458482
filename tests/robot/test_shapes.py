"""The meshes that a robot is drawn with."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
import yourdfpy

from helpers_kinematics import example_urdf
from iiwa_dnn import Configuration, InvalidInputError, Robot, load_robot
from iiwa_dnn.robot.shapes import Mesh, visual_meshes


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


@pytest.mark.parametrize("lost", ["meshes", "shapes"])
def test_an_arm_without_its_shapes_is_drawn_with_sticks_to_its_tip(
    lost: str, tmp_path: Path
) -> None:
    file = example_urdf("ur_description/urdf/ur5_robot.urdf")
    alone = tmp_path / "ur5.urdf"
    text = file.read_text()
    alone.write_text(text if lost == "meshes" else text.replace("visual>", "seen>"))
    robot = load_robot(alone, tip="tool0")
    sticks: tuple[Mesh, ...] = visual_meshes(robot)
    assert len(sticks) == robot.dof + 1
    q = np.linspace(-1.0, 1.0, robot.dof)
    last = placed(robot, q)[-1]
    tip = Configuration(robot, q).position
    assert np.linalg.norm(last - tip, axis=1).min() == pytest.approx(0.02, abs=1e-3)


def test_a_robot_without_a_file_has_none() -> None:
    with pytest.raises(InvalidInputError, match="URDF file"):
        visual_meshes(dataclasses.replace(load_robot("iiwa7"), path=None))
