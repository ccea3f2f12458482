"""URDF files: read as XML, then made into a Pinocchio model, or into a text for MuJoCo."""

import xml.etree.ElementTree as ET
from pathlib import Path

import pinocchio as pin

from iiwa_dnn.errors import FileError
from iiwa_dnn.files import one_line
from iiwa_dnn.robot.robot import Robot

_UNLIMITED = {"lower": "-1e308", "upper": "1e308"}


def read(path: Path) -> ET.Element:
    """Read a URDF file as XML; return its first element.

    A continuous joint becomes a revolute one of a range without end: one coordinate, like all
    others.

    Raises:
        FileError: If the file cannot be read or is not XML.
    """
    if path.suffix == ".xacro":
        raise FileError(path, f"make a URDF of it: xacro {path.name} -o {path.stem}.urdf")
    try:
        root = ET.fromstring(path.read_bytes())
    except OSError as error:
        raise FileError(path, one_line(error)) from error
    except (ET.ParseError, LookupError, ValueError) as error:
        raise FileError(path, f"not XML that can be read: {one_line(error)}") from error
    for joint in root.findall("joint[@type='continuous']"):
        joint.set("type", "revolute")
        limit = joint.find("limit")
        if limit is None:
            limit = ET.SubElement(joint, "limit", effort="0", velocity="0")
        limit.attrib.update(_UNLIMITED)
    return root


def text_of(root: ET.Element) -> str:
    """Write XML as text: other readers get the tree that was checked, not the file's bytes."""
    return ET.tostring(root, encoding="unicode")


def build_model(path: Path, root: ET.Element) -> pin.Model:
    """Build the Pinocchio model of a URDF from `path`, its base fixed to the world.

    Raises:
        FileError: If Pinocchio refuses the robot.
    """
    try:
        return pin.buildModelFromXML(text_of(root))
    except (ValueError, RuntimeError, IndexError) as error:
        raise FileError(path, f"no URDF that Pinocchio can read: {one_line(error)}") from error


def strip(root: ET.Element, robot: Robot) -> None:
    """Remove what physics does not need: shapes out of other files, inertias of the base."""
    for link in root.findall("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            if shape.find("geometry/mesh") is not None:
                link.remove(shape)
        if robot.model.frames[robot.frame_id(link.get("name", ""))].parentJoint == 0:
            for inertia in link.findall("inertial"):  # some are no body's, as of TIAGo's antennas
                link.remove(inertia)
