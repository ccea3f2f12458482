"""URDF files: read with care, then made into a Pinocchio model.

The XML has a fact that Pinocchio's model does not keep: limits that were not given.
"""

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pinocchio as pin

from iiwa_dnn.errors import FileError
from iiwa_dnn.files import one_line
from iiwa_dnn.robot.robot import Robot

_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def read(path: Path) -> ET.Element:
    """Read a URDF file as XML; return the element ``<robot>``, which has joints.

    A continuous joint becomes a revolute one without position limits: one coordinate, like all
    others.

    Raises:
        FileError: If the file cannot be read, is not XML or is not a robot with joints.
    """
    if path.suffix == ".xacro":
        raise FileError(path, f"make a URDF of it: xacro {path.name} -o {path.stem}.urdf")
    try:
        root = ET.fromstring(path.read_bytes())
        text_of(root)  # elements nested too deeply can be read, but not written
    except OSError as error:
        raise FileError(path, one_line(error)) from error
    except (ET.ParseError, LookupError, ValueError, RecursionError) as error:
        raise FileError(path, f"not XML that can be read: {one_line(error)}") from error
    if root.tag != "robot":
        raise FileError(path, f"not a URDF: its first element is <{root.tag}>, not <robot>")
    if root.find("joint") is None:
        raise FileError(path, "the robot has no joints")
    for joint in root.findall("joint[@type='continuous']"):
        joint.set("type", "revolute")
        limit = joint.find("limit")
        if limit is None:
            limit = ET.SubElement(joint, "limit", effort="0", velocity="0")
        for key in ("lower", "upper"):
            limit.attrib.pop(key, None)
    return root


def text_of(root: ET.Element) -> str:
    """Write XML as text: other readers get the tree that was checked, not the file's bytes."""
    return ET.tostring(root, encoding="unicode")


def build_model(path: Path, root: ET.Element) -> pin.Model:
    """Build the Pinocchio model of a URDF from `path`, its base fixed to the world.

    Raises:
        FileError: If Pinocchio refuses the robot, or a frame of it is not finite.
    """
    try:
        model = pin.buildModelFromXML(text_of(root))
    except (ValueError, RuntimeError, IndexError) as error:
        raise FileError(path, f"no URDF that Pinocchio can read: {one_line(error)}") from error
    if not all(np.isfinite(frame.placement.homogeneous).all() for frame in model.frames):
        raise FileError(path, "an <origin> is not finite")
    return model


def mend_inertias(root: ET.Element) -> None:
    """Raise principal moments of inertia that no body has: 0 by rounding, or A + B below C."""
    for inertia in root.findall("link/inertial/inertia"):
        xx, xy, xz, yy, yz, zz = (float(inertia.get(key, "0")) for key in _MOMENTS)
        moments, axes = np.linalg.eigh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        # A link without any, fixed to another, is none of MuJoCo's worries.
        if moments[2] > 0.0 and (moments[0] <= 0.0 or moments[0] + moments[1] < moments[2]):
            mended = axes @ np.diag(np.maximum(moments, 0.51 * moments[2])) @ axes.T
            for key, value in zip(_MOMENTS, mended[np.triu_indices(3)], strict=True):
                inertia.set(key, repr(float(value)))


def drop_meshes(root: ET.Element) -> None:
    """Remove the shapes that would be read from other files."""
    for link in root.findall("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            if shape.find("geometry/mesh") is not None:
                link.remove(shape)


def weld(root: ET.Element, robot: Robot) -> None:
    """Fix the locked joints of a robot where they are; joints that follow others are among them."""
    held = dict(zip(robot.locked, robot.q_locked, strict=True))
    for joint in root.findall("joint"):
        name = joint.get("name", "")
        for mimic in joint.findall("mimic"):
            joint.remove(mimic)
        if name in held:
            # In Pinocchio's model both links have become frames of one joint.
            ends = [*joint.findall("parent"), *joint.findall("child")]
            frames = [robot.model.frames[robot.frame_id(end.get("link", ""))] for end in ends]
            pose = frames[0].placement.actInv(frames[1].placement)
            for origin in joint.findall("origin"):
                joint.remove(origin)
            xyz = " ".join(map(repr, pose.translation.tolist()))
            rpy = " ".join(map(repr, pin.rpy.matrixToRpy(pose.rotation).tolist()))
            ET.SubElement(joint, "origin", xyz=xyz, rpy=rpy)
            joint.set("type", "fixed")
