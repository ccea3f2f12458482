"""The shapes that a robot is drawn with, against a second reader of the URDF."""

from __future__ import annotations

import dataclasses

import numpy as np
import pinocchio as pin
import pytest
import yourdfpy

from helpers_kinematics import example_urdf
from helpers_physics import START
from iiwa_dnn import Configuration, InvalidInputError, load_robot
from iiwa_dnn.robot.shapes import joint_poses, visual_shapes


def placed(robot, q) -> list[tuple[str, tuple[float, ...], np.ndarray]]:
    """Kind, size and place in the world of every shape."""
    poses = joint_poses(robot, q)
    found = []
    for shape in visual_shapes(robot):
        pose = poses[shape.joint] * pin.SE3(shape.rotation, shape.position)
        found.append((shape.kind, shape.size, pose.homogeneous))
    return found


def test_shapes_are_where_yourdfpy_has_them():
    robot = load_robot("iiwa7")
    other = yourdfpy.URDF.load(str(robot.path), load_meshes=False, build_scene_graph=True)
    other.update_cfg(START)
    expected = []
    for link in other.robot.links:
        for visual in link.visuals:
            origin = np.eye(4) if visual.origin is None else visual.origin
            world = other.get_transform(link.name) @ origin
            cylinder, sphere = visual.geometry.cylinder, visual.geometry.sphere
            if cylinder is not None:
                expected.append(("cylinder", (cylinder.radius, cylinder.length), world))
            else:
                expected.append(("sphere", (sphere.radius,), world))
    found = placed(robot, START)
    assert len(found) == len(expected) == 15
    for (kind, size, pose), (kind2, size2, pose2) in zip(found, expected, strict=True):
        assert kind == kind2
        assert size == pytest.approx(size2)
        np.testing.assert_allclose(pose, pose2, atol=1e-9)


def test_colors_are_the_urdfs():
    colors = {shape.color for shape in visual_shapes(load_robot("iiwa7"))}
    rounded = {tuple(round(part, 3) for part in color) for color in colors}
    assert rounded == {(1.0, 0.4, 0.0), (0.6, 0.6, 0.6)}


def test_a_locked_joint_takes_its_shapes_along():
    full, locked = load_robot("iiwa7"), load_robot("iiwa7", locked=("iiwa7_joint_3",))
    q = np.array([0.3, 0.5, 0.0, 1.0, 0.2, -0.4, 0.1])
    for one, two in zip(placed(full, q), placed(locked, np.delete(q, 2)), strict=True):
        np.testing.assert_allclose(one[2], two[2], atol=1e-12)


def test_an_arm_without_its_meshes_is_drawn_with_sticks(tmp_path):
    file = example_urdf("ur_description/urdf/ur5_robot.urdf")
    assert {shape.kind for shape in visual_shapes(load_robot(file, tip="tool0"))} == {"mesh"}
    alone = tmp_path / "ur5.urdf"
    alone.write_bytes(file.read_bytes())
    robot = load_robot(alone, tip="tool0")
    q = np.linspace(-1.0, 1.0, robot.dof)
    found = placed(robot, q)
    assert {kind for kind, _, _ in found} == {"cylinder"}
    # Sticks from joint to joint reach the tip.
    _, (_, length), pose = found[-1]
    ends = pose[:3, 3] + np.outer([-0.5, 0.5], length * pose[:3, 2])
    tip = Configuration(robot, q).position
    assert np.linalg.norm(ends - tip, axis=1).min() < 1e-12


def test_a_robot_without_a_file():
    robot = dataclasses.replace(load_robot("iiwa7"), path=None)
    with pytest.raises(InvalidInputError, match="URDF file"):
        visual_shapes(robot)
