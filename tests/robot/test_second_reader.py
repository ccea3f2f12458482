"""Robots as Pinocchio reads them, judged by yourdfpy, which reads the same text."""

from __future__ import annotations

import io

import numpy as np
import pinocchio as pin
import pytest
import yourdfpy

from helpers_kinematics import example_urdf
from iiwa_dnn import Robot, load_robot
from iiwa_dnn.robot.arms import ARMS, TIPS


def reader_of(robot: Robot) -> yourdfpy.URDF:
    """Read a robot's text a second time; joints that follow others are given their positions."""
    text = io.BytesIO(robot.urdf.encode())
    file = yourdfpy.URDF.load(text, build_scene_graph=False, load_meshes=False).robot
    for joint in file.joints:
        joint.mimic = None
    for link in file.links:
        link.visuals = []
    return yourdfpy.URDF(file, load_meshes=False)


CASES = [
    *[(name, ()) for name in (*TIPS, *ARMS)],
    ("panda", ("panda_joint4",)),  # which is not held at zero
    ("kinova", ("j2s6s200_joint_1", "j2s6s200_joint_4")),  # continuous
]


@pytest.mark.parametrize(("name", "locked"), CASES)
def test_joints_limits_and_poses_of_all_links(name: str, locked: tuple[str, ...]) -> None:
    if name in ARMS:
        example_urdf(ARMS[name].file)
    robot = load_robot(name, locked=locked)
    reader = reader_of(robot)
    movable = {joint.name for joint in reader.robot.joints if joint.type != "fixed"}
    assert movable == {*robot.joint_names, *robot.locked}
    assert set(locked) <= set(robot.locked)
    for i, joint in enumerate(robot.joint_names):
        limit = reader.joint_map[joint].limit or yourdfpy.Limit()
        limited = limit.lower is not None or limit.upper is not None
        assert robot.q_lower[i] == ((limit.lower or 0.0) if limited else -np.inf)
        assert robot.q_upper[i] == ((limit.upper or 0.0) if limited else np.inf)
        assert robot.dq_max[i] == (limit.velocity or np.inf)
        assert robot.model.effortLimit[i] == (limit.effort or 0.0)
    data = robot.model.createData()
    names = (*robot.joint_names, *robot.locked)
    for q in np.random.default_rng(0).uniform(-np.pi, np.pi, (5, robot.dof)):
        pin.framesForwardKinematics(robot.model, data, q)
        reader.update_cfg(dict(zip(names, (*q, *robot.q_locked), strict=True)))
        for link in reader.link_map:
            ours = data.oMf[robot.frame_id(link)].homogeneous
            theirs = reader.get_transform(link, reader.base_link)
            np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9, err_msg=link)
