"""URDF files: read with care, then made into a Pinocchio model.

The XML gives one-line reasons for faults, and facts that Pinocchio's model does not keep: limits
that were not given, joints that follow others.
"""

import io
import os
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, redirect_stderr
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import FileError, import_extra
from iiwa_dnn.files import one_line

_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")

_NAMING = {"link": "name", "joint": "name", "parent": "link", "child": "link", "mimic": "joint"}
"""Attribute that names a link or a joint, by element."""

_LIGHT_BODY = """
<inertial> <mass value="0.1"/>
<inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/> </inertial>
"""
_MOBILE_BASE = f"""<robot>
<link name="base_floor">{_LIGHT_BODY}</link>
<link name="base_rail">{_LIGHT_BODY}</link>
<link name="base_plate">{_LIGHT_BODY}</link>
<joint name="base_x" type="prismatic"> <parent link="base_floor"/> <child link="base_rail"/>
<axis xyz="1 0 0"/> <limit effort="1000" velocity="1"/> </joint>
<joint name="base_y" type="prismatic"> <parent link="base_rail"/> <child link="base_plate"/>
<axis xyz="0 1 0"/> <limit effort="1000" velocity="1"/> </joint>
<joint name="base_yaw" type="revolute"> <parent link="base_plate"/> <child link=""/>
<axis xyz="0 0 1"/> <limit effort="1000" velocity="1"/> </joint>
</robot>"""
"""Base that moves in the plane; masses and speeds [m/s, rad/s] are estimates."""


class _NoDoctype(ET.TreeBuilder):
    """A tree builder that refuses a DOCTYPE: entities can read files or fill the memory."""

    def doctype(self, *_: str | None) -> None:
        raise ET.ParseError("a DOCTYPE is not accepted")


def read(path: Path, mobile: bool = False) -> ET.Element:
    """Read a URDF file as XML; return the element ``<robot>``, which has joints.

    A file that ends in ``.xacro`` goes through xacro, one in MuJoCo's MJCF through MuJoCo. A
    `mobile` robot has three joints between the world and its first link.

    ``<include file="other.urdf" prefix="left_"/>``, which is no URDF, stands for the links and
    joints of another file, their names with the prefix. A continuous joint becomes a revolute one
    without position limits: one coordinate, like all others.

    Raises:
        FileError: If the file cannot be read, is not XML, has a DOCTYPE or is not a robot with
            joints, or a file that it includes includes others.
        MissingDependencyError: If xacro or MuJoCo is needed and not installed.
    """
    root = _read(path)
    for include in root.findall("include"):
        root.remove(include)
        root.extend(_included(path.parent / include.get("file", ""), include.get("prefix", "")))
    for joint in root.findall("joint[@type='continuous']"):
        joint.set("type", "revolute")
        limit = joint.find("limit")
        if limit is None:
            limit = ET.SubElement(joint, "limit", effort="0", velocity="0")
        for key in ("lower", "upper"):
            limit.attrib.pop(key, None)
    if mobile:
        _add_mobile_base(root)
    return root


def _included(path: Path, prefix: str) -> list[ET.Element]:
    """Read the links and joints of a file that another one includes, a prefix on their names."""
    root = _read(path)
    if root.find("include") is not None:
        raise FileError(path, "is included and includes others")
    for element in root.iter():
        key = _NAMING.get(element.tag, "")
        if key in element.attrib:
            element.set(key, prefix + element.attrib[key])
    return [*root.findall("link"), *root.findall("joint")]


def _add_mobile_base(root: ET.Element) -> None:
    """Put a base that moves in the plane under the first link that hangs on no joint."""
    children = {child.get("link") for child in root.iterfind("joint/child")}
    names = [link.get("name", "") for link in root.findall("link")]
    base = ET.fromstring(_MOBILE_BASE)
    for child in base.iterfind("joint/child[@link='']"):
        child.set("link", next((name for name in names if name not in children), ""))
    root.extend(base)


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


def _read(path: Path) -> ET.Element:
    """Read one file; see `read`."""
    try:
        content = _expanded(path) if path.suffix == ".xacro" else path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        raise FileError(path, one_line(error)) from error
    try:
        root = ET.fromstring(content, parser=ET.XMLParser(target=_NoDoctype()))
        text_of(root)  # elements nested too deeply can be read, but not written
    except (ET.ParseError, LookupError, ValueError, RecursionError) as error:
        raise FileError(path, f"not XML that can be read: {error}") from error
    if root.tag == "mujoco":
        from iiwa_dnn.robot.mjcf import as_urdf  # MuJoCo is in an extra

        root = as_urdf(path)
    if root.tag != "robot":
        raise FileError(path, f"not a URDF: its first element is <{root.tag}>, not <robot>")
    if root.find("joint") is None:
        raise FileError(path, "the robot has no joints")
    return root


def _expanded(path: Path) -> bytes:
    """Expand a xacro file."""
    xacro = import_extra("xacro", "pip install 'iiwa-dnn[xacro]'")
    try:
        with redirect_stderr(io.StringIO()):
            return bytes(xacro.process_file(str(path)).toxml(encoding="utf-8"))
    except OSError:
        raise
    except Exception as error:  # whatever an expression in the file raises
        raise FileError(path, f"xacro cannot expand it: {one_line(error)}") from error


def text_of(root: ET.Element) -> str:
    """Write XML as text: other readers get the tree that was checked, not the file's bytes."""
    return ET.tostring(root, encoding="unicode")


def drop_meshes(root: ET.Element) -> None:
    """Remove the shapes that would be read from other files."""
    for link in root.findall("link"):
        for shape in [*link.findall("visual"), *link.findall("collision")]:
            if shape.find("geometry/mesh") is not None:
                link.remove(shape)


def weld(root: ET.Element, posture: Mapping[str, float]) -> None:
    """Replace joints by fixed ones, each at its position in `posture` [rad], by name.

    The position of planar and floating joints has to be 0.
    """
    for joint in root.findall("joint"):
        name = joint.get("name", "")
        mimic = joint.find("mimic")
        if mimic is not None and {name, mimic.get("joint")} & posture.keys():
            joint.remove(mimic)
        if posture.get(name):
            _move(joint, posture[name])
        if name in posture:
            joint.set("type", "fixed")


def _move(joint: ET.Element, position: float) -> None:
    """Shift a joint's origin to where a joint position [rad or m] puts its child."""
    axis = _vector(joint.find("axis"), "xyz", "1 0 0")
    step = position * axis / np.linalg.norm(axis)
    origin = joint.find("origin")
    rotation = pin.rpy.rpyToMatrix(_vector(origin, "rpy"))
    pose = pin.SE3(rotation, _vector(origin, "xyz"))
    if joint.get("type") == "prismatic":
        pose *= pin.SE3(np.eye(3), step)
    else:
        pose *= pin.SE3(pin.exp3(step), np.zeros(3))
    set_origin(joint, pose)


def _vector(element: ET.Element | None, key: str, default: str = "0 0 0") -> Array:
    """Read three numbers of an element's attribute."""
    text = default if element is None else element.get(key, default)
    return np.array(text.split(), dtype=float)


def set_origin(element: ET.Element, pose: pin.SE3) -> None:
    """Write a pose as the ``<origin>`` of an element."""
    origin = element.find("origin")
    if origin is None:
        origin = ET.SubElement(element, "origin")
    origin.set("xyz", words(pose.translation))
    origin.set("rpy", words(pin.rpy.matrixToRpy(pose.rotation)))


def words(vector: ArrayLike) -> str:
    """Write a vector (k,) as an attribute has it, all digits kept."""
    return " ".join(map(repr, np.asarray(vector, dtype=float).tolist()))


def build_model(path: Path, root: ET.Element) -> pin.Model:
    """Build the Pinocchio model of a URDF from `path`, its base fixed to the world, silently.

    Raises:
        FileError: If Pinocchio refuses the robot (its own first complaint is the reason), or no
            joint moves.
    """
    complaints: list[str] = []
    try:
        with _captured_stderr(complaints):
            model = pin.buildModelFromXML(text_of(root))
    except (ValueError, RuntimeError, IndexError) as error:
        found = [line.partition("Error:")[2].strip() for line in complaints if "Error:" in line]
        reason = found[0] if found else str(error).strip().partition("\n")[0]
        raise FileError(path, f"not a URDF that Pinocchio can read: {reason}") from error
    if model.nv == 0:
        raise FileError(path, "no joint of the robot moves")
    if not all(np.isfinite(frame.placement.homogeneous).all() for frame in model.frames):
        raise FileError(path, "an <origin> is not finite")
    for joint in root.findall("joint"):
        moves = joint.get("type") in ("revolute", "prismatic")
        if moves and not _vector(joint.find("axis"), "xyz", "1 0 0").any():
            raise FileError(path, f"joint {joint.get('name')!r}: its <axis> is zero")
    return model


@contextmanager
def _captured_stderr(lines: list[str]) -> Iterator[None]:
    """Collect the lines that C++ writes to standard error; urdfdom tells its reasons only there.

    Nothing but the file descriptor reaches C++ streams: other threads' messages come along.
    """
    with tempfile.TemporaryFile() as file:
        try:
            saved = os.dup(2)
        except OSError:  # the process has no standard error
            yield
            return
        os.dup2(file.fileno(), 2)
        try:
            yield
        finally:
            os.dup2(saved, 2)
            os.close(saved)
            file.seek(0)
            lines += file.read().decode(errors="replace").splitlines()
