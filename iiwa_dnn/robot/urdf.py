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
from numpy.typing import NDArray

from iiwa_dnn.errors import FileError, import_extra
from iiwa_dnn.files import one_line

_MOMENTS = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")

# Attributes that name a link or a joint, by element.
_NAMES = {
    "link": ("name",), "joint": ("name",), "parent": ("link",), "child": ("link",),
    "mimic": ("joint",),
}  # fmt: skip


class _NoDoctype(ET.TreeBuilder):
    """A tree builder that refuses a DOCTYPE: entities can read files or fill the memory."""

    def doctype(self, *_: str | None) -> None:
        raise ET.ParseError("a DOCTYPE is not accepted")


BASE = ("base_x", "base_y", "base_yaw")
"""Joints of a mobile base."""

_SPEED, _TURN = 1.0, 1.0  # of a mobile base: estimates [m/s, rad/s]


def read(path: Path, mobile: bool = False) -> ET.Element:
    """Read a URDF file as XML; return the element ``<robot>``, which has joints.

    A file that ends in ``.xacro`` goes through xacro, one in MuJoCo's MJCF through MuJoCo. A
    `mobile` robot has the joints ``BASE`` between the world and its first link.

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
        other = path.parent / include.get("file", "")
        part = _read(other)
        if part.find("include") is not None:
            raise FileError(other, "is included and includes others")
        for element in part.iter():
            for key in _NAMES.get(element.tag, ()):
                if key in element.attrib:
                    element.set(key, include.get("prefix", "") + element.get(key, ""))
        root.extend([*part.findall("link"), *part.findall("joint")])
    for joint in root.findall("joint[@type='continuous']"):
        limit = joint.find("limit")
        limit = ET.SubElement(joint, "limit", effort="0", velocity="0") if limit is None else limit
        for key in ("lower", "upper"):
            limit.attrib.pop(key, None)
        joint.set("type", "revolute")
    if mobile:
        _put_on_wheels(root)
    return root


def _put_on_wheels(root: ET.Element) -> None:
    """Add the joints of a base that moves in the plane, with light links between them."""
    children = {joint.find("child").get("link") for joint in root.findall("joint")}  # type: ignore[union-attr]
    links = [link.get("name", "") for link in root.findall("link")]
    below = next(name for name in links if name not in children)
    chain = ["base_floor", "base_rail", "base_plate", below]
    for name in chain[:3]:
        inertial = ET.SubElement(ET.SubElement(root, "link", name=name), "inertial")
        ET.SubElement(inertial, "mass", value="0.1")
        moments = {key: "1e-3" if key[1] == key[2] else "0" for key in _MOMENTS}
        ET.SubElement(inertial, "inertia", moments)
    kinds = (("prismatic", "1 0 0"), ("prismatic", "0 1 0"), ("revolute", "0 0 1"))
    for name, (kind, axis), parent, child in zip(BASE, kinds, chain, chain[1:], strict=False):
        joint = ET.SubElement(root, "joint", name=name, type=kind)
        ET.SubElement(joint, "parent", link=parent)
        ET.SubElement(joint, "child", link=child)
        ET.SubElement(joint, "axis", xyz=axis)
        speed = _SPEED if kind == "prismatic" else _TURN
        ET.SubElement(joint, "limit", effort="1000", velocity=repr(speed))


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
        raise FileError(path, getattr(error, "strerror", None) or str(error)) from error
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
        name, mimic = joint.get("name", ""), joint.find("mimic")
        if mimic is not None and {name, mimic.get("joint")} & posture.keys():
            joint.remove(mimic)
        if posture.get(name):
            axis = _numbers(joint, "axis", "xyz", "1 0 0")
            step = posture[name] * axis / np.linalg.norm(axis)
            slides = joint.get("type") == "prismatic"
            rpy, xyz = (_numbers(joint, "origin", key, "0 0 0") for key in ("rpy", "xyz"))
            place = pin.SE3(pin.rpy.rpyToMatrix(rpy), xyz)
            place *= pin.SE3(np.eye(3), step) if slides else pin.SE3(pin.exp3(step), np.zeros(3))
            origin = joint.find("origin")
            origin = ET.SubElement(joint, "origin") if origin is None else origin
            rpy, xyz = pin.rpy.matrixToRpy(place.rotation), place.translation
            for key, numbers in (("rpy", rpy), ("xyz", xyz)):
                origin.set(key, " ".join(map(repr, numbers.tolist())))
        if name in posture:
            joint.set("type", "fixed")


def _numbers(joint: ET.Element, tag: str, key: str, default: str) -> NDArray[np.float64]:
    """Read the three numbers of an attribute of a joint's element `tag`."""
    element = joint.find(tag)
    text = default if element is None else element.get(key, default)
    return np.array([float(word) for word in text.split()])


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
