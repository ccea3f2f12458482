"""A second reader of URDF files, yourdfpy, that judges the robot made by Pinocchio."""

from __future__ import annotations

from typing import Any

import numpy as np
import pinocchio as pin
import yourdfpy

from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.robot.robot import Robot, finite_ranges

CONFIGURATIONS = 5
"""Configurations at which link poses are compared, drawn with a fixed seed inside the limits."""

TOLERANCE = 1e-9
"""Largest difference of two poses: of positions [m] and of the rotation matrices' entries."""


def verify_robot(robot: Robot) -> None:
    """Compare a robot, as loaded, with its file as yourdfpy reads it.

    Compared are the free joints and the joint that each hangs on, their position, velocity and
    effort limits, and the pose of every link at `CONFIGURATIONS` configurations.

    Args:
        robot: The robot, from a URDF file, with the limits of the file.

    Raises:
        InvalidInputError: If the robot does not come from a file.
        FileError: If the two readers differ, which names the joint or the frame, or the second one
            cannot read the file.
    """
    if robot.path is None:
        raise InvalidInputError("robot", "must come from a URDF file", robot)
    try:
        file = yourdfpy.URDF.load(str(robot.path), build_scene_graph=False, load_meshes=False).robot
        for joint in file.joints:
            joint.mimic = None  # every joint is given its position
        for link in file.links:
            link.visuals = []
        reader = yourdfpy.URDF(file, load_meshes=False)
    except Exception as error:  # any that its parsers have
        raise FileError(robot.path, f"yourdfpy cannot read it: {error!r}") from error
    difference = _of_joints(robot, reader) or _of_limits(robot, reader) or _of_poses(robot, reader)
    if difference:
        raise FileError(robot.path, f"Pinocchio and yourdfpy differ: {difference}")


def _of_joints(robot: Robot, reader: Any) -> str:
    """Describe the first difference of the free joints and their order, if there is one."""
    free = {joint.name for joint in reader.robot.joints if joint.type != "fixed"}
    free -= set(robot.locked)
    for name in sorted(free ^ set(robot.joint_names)):
        return f"joint {name!r} moves for one of them only"
    carriers = {joint.child: joint for joint in reader.robot.joints}
    for index, name in enumerate(robot.joint_names, start=1):
        carrier = carriers.get(reader.joint_map[name].parent)
        while carrier is not None and carrier.name not in free:
            carrier = carriers.get(carrier.parent)
        theirs = None if carrier is None else carrier.name
        parent = robot.model.parents[index]
        ours = robot.model.names[parent] if parent else None
        if ours != theirs:
            return f"joint {name!r} hangs on {ours} or on {theirs}"
    return ""


def _of_limits(robot: Robot, reader: Any) -> str:
    """Describe the first difference of the limits, if there is one."""
    for i, name in enumerate(robot.joint_names):
        limit = reader.joint_map[name].limit or yourdfpy.Limit()
        given = limit.lower is not None or limit.upper is not None
        theirs = {
            "lower": (limit.lower or 0.0) if given else -np.inf,
            "upper": (limit.upper or 0.0) if given else np.inf,
            "velocity": limit.velocity or np.inf,
            "effort": limit.effort or 0.0,
        }
        ours = (*robot.limits[:, i], robot.model.effortLimit[i])
        for (kind, value), own in zip(theirs.items(), ours, strict=True):
            if value != own:
                return f"joint {name!r}: {kind} limit {own:g} or {value:g}"
    return ""


def _of_poses(robot: Robot, reader: Any) -> str:
    """Describe the first difference of the links' poses, if there is one."""
    data = robot.model.createData()
    shape = (CONFIGURATIONS, robot.dof)
    for q in np.random.default_rng(0).uniform(*finite_ranges(robot), shape):
        pin.framesForwardKinematics(robot.model, data, q)
        names = (*robot.joint_names, *robot.locked)
        reader.update_cfg(dict(zip(names, (*q, *robot.q_locked), strict=True)))
        for link in reader.link_map:
            theirs = reader.get_transform(link, reader.base_link)
            difference = np.abs(theirs - data.oMf[robot.frame_id(link)].homogeneous).max()
            if not difference <= TOLERANCE:
                return f"frame {link!r} by {difference:.1e} at q = {np.round(q, 3).tolist()}"
    return ""
