"""A second reader of URDF files, yourdfpy, that judges the robot made by Pinocchio."""

import io
from collections.abc import Iterator
from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn.errors import FileError, import_extra
from iiwa_dnn.robot.robot import Robot, file_of, urdf_of

yourdfpy = import_extra("yourdfpy", "pip install 'iiwa-dnn[verify]'")

_TOLERANCE = 1e-9  # of positions [m] and of the rotation matrices' entries


def verify_robot(robot: Robot) -> None:
    """Compare a robot, as loaded, with its file as yourdfpy reads it.

    Compared are the free joints and the joint that each hangs on, their position, velocity and
    effort limits, and the poses of all links at five seeded configurations.

    Raises:
        InvalidInputError: If the robot does not come from a file.
        FileError: If the two readers differ, which names the joint or the frame, or the second one
            cannot read the file.
    """
    text = io.BytesIO(urdf_of(robot).encode())
    try:
        file = yourdfpy.URDF.load(text, build_scene_graph=False, load_meshes=False).robot
        for joint in file.joints:
            joint.mimic = None  # every joint is given its position
        for link in file.links:
            link.visuals = []
        reader = yourdfpy.URDF(file, load_meshes=False)
    except Exception as error:  # any that its parsers have
        raise FileError(file_of(robot), f"yourdfpy cannot read it: {error!r}") from error
    for differences in (_joint_differences, _limit_differences, _pose_differences):
        for difference in differences(robot, reader):
            raise FileError(file_of(robot), f"Pinocchio and yourdfpy differ: {difference}")


def _joint_differences(robot: Robot, reader: Any) -> Iterator[str]:
    movable = {joint.name for joint in reader.robot.joints if joint.type != "fixed"}
    free = movable - set(robot.locked)
    for name in sorted(free ^ set(robot.joint_names)):
        yield f"joint {name!r} moves for one of them only"
    carriers = {joint.child: joint for joint in reader.robot.joints}
    for index, name in enumerate(robot.joint_names, start=1):
        carrier = carriers.get(reader.joint_map[name].parent)
        while carrier is not None and carrier.name not in free:
            carrier = carriers.get(carrier.parent)
        theirs = "the base" if carrier is None else carrier.name
        ours = ("the base", *robot.joint_names)[robot.model.parents[index]]
        if ours != theirs:
            yield f"joint {name!r} hangs on {ours} or on {theirs}"


def _limit_differences(robot: Robot, reader: Any) -> Iterator[str]:
    for i, name in enumerate(robot.joint_names):
        limit = reader.joint_map[name].limit or yourdfpy.Limit()
        limited = limit.lower is not None or limit.upper is not None
        pairs = {
            "lower": (robot.q_lower[i], (limit.lower or 0.0) if limited else -np.inf),
            "upper": (robot.q_upper[i], (limit.upper or 0.0) if limited else np.inf),
            "velocity": (robot.dq_max[i], limit.velocity or np.inf),
            "effort": (robot.model.effortLimit[i], limit.effort or 0.0),
        }
        for kind, (ours, theirs) in pairs.items():
            if ours != theirs:
                yield f"joint {name!r}: {kind} limit {ours:g} or {theirs:g}"


def _pose_differences(robot: Robot, reader: Any) -> Iterator[str]:
    data = robot.model.createData()
    names = (*robot.joint_names, *robot.locked)
    for q in np.random.default_rng(0).uniform(-np.pi, np.pi, (5, robot.dof)):
        pin.framesForwardKinematics(robot.model, data, q)
        reader.update_cfg(dict(zip(names, (*q, *robot.q_locked), strict=True)))
        for link in reader.link_map:
            theirs = reader.get_transform(link, reader.base_link)
            difference = np.abs(theirs - data.oMf[robot.frame_id(link)].homogeneous).max()
            if not difference <= _TOLERANCE:
                yield f"frame {link!r} by {difference:.1e} at q = {np.round(q, 3).tolist()}"
