"""URDF files: read as Pinocchio's parser does, or refused with its reason."""

import os
import posixpath
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from tempfile import TemporaryFile
from threading import Lock
from xml.parsers import expat

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn.errors import FileError, warn_caller
from iiwa_dnn.files import one_line

ENDLESS = ("-1e308", "1e308")
"""Range of a joint without position limits, as the parser takes it."""

_UTF_16 = (b"\xfe\xff", b"\xff\xfe")
_UNREAD = re.compile(r"<\?xml\s.*?\?>|<!--.*?-->", re.DOTALL)
# One sentence of it: what follows two spaces is advice.
_MESSAGE = re.compile(rb"(?:Error|Warning): +(.*?)(?:\.  .*)?\n +at line \d+ in .*\n")
_UNSPECIFIC = b"joint xml is not initialized correctly"
# Of the reader of meshes: there is nothing that encloses a body.
_NO_TRIANGLES = re.compile(
    r"Could not load resource (.+)\n"
    r"(?:No meshes remaining|.*There are no facets defined|Mesh with invalid primitive type)"
)
_NOT_FOUND = "could not be found"

_lock = Lock()


def read_urdf(path: Path) -> ET.Element:
    """Read a URDF file as XML; return its first element.

    A continuous joint becomes a revolute one of a range without end: one coordinate, like all
    others. An effort that is missing or negative becomes 0, "not given". Capsules are read whatever
    the version of the file.

    Raises:
        FileError: If the file cannot be read, is not XML or no URDF, or a velocity limit is not a
            number of at least 0.
    """
    if path.suffix == ".xacro":
        urdf = Path(path.stem).with_suffix(".urdf")
        raise FileError(path, f"make a URDF of it: xacro {path.name} -o {urdf}")
    try:
        root = _parse(path.read_bytes())
    except OSError as error:
        raise FileError(path, one_line(error)) from error
    except (expat.ExpatError, ValueError) as error:
        raise FileError(path, f"not XML that can be read: {one_line(error)}") from error
    if root.tag != "robot":
        raise FileError(path, f"no URDF: its first element is <{root.tag}>, not <robot>")
    if root.get("version", "1.0") == "1.0" and root.find(".//geometry/capsule") is not None:
        root.set("version", "1.1")  # the first one in which the parser takes a capsule
    for joint in root.findall("joint"):
        limit = joint.find("limit")
        if joint.get("type") == "continuous":
            joint.set("type", "revolute")
            if limit is None:
                limit = ET.SubElement(joint, "limit", velocity="0")
            limit.attrib.update(zip(("lower", "upper"), ENDLESS, strict=True))
        if limit is not None:
            number_of(path, joint, limit, "velocity")
            if limit.get("effort", "-").startswith("-"):
                limit.set("effort", "0")
    return root


def _parse(data: bytes) -> ET.Element:
    """Build the tree of an XML text as loosely as Pinocchio's parser.

    A declared encoding means nothing, space may come first, comments hold anything, and a prefix is
    a part of its name: ``p.name`` for ``p:name``, so that other parsers read the tree's text.
    """
    text = data.decode("utf-16" if data[:2] in _UTF_16 else "utf-8-sig", "replace")
    text = text.partition("\0")[0]  # the end of a string in C
    # Lines keep their numbers.
    text = _UNREAD.sub(lambda found: "\n" * found[0].count("\n"), text)
    tree = ET.TreeBuilder()

    def start(tag: str, attributes: dict[str, str]) -> None:
        named = {key.replace(":", "."): value for key, value in attributes.items()}
        named.pop("xmlns", None)
        tree.start(tag.replace(":", "."), named)

    parser = expat.ParserCreate()
    parser.StartElementHandler = start
    parser.EndElementHandler = tree.end
    parser.CharacterDataHandler = tree.data
    parser.Parse(re.sub(r"&(?!#?\w+;)", "&amp;", text), True)
    return tree.close()


def number_of(path: Path | None, joint: ET.Element, element: ET.Element, key: str) -> float:
    """Read a number from an attribute `key` or ``drake:key`` within a joint; 0 if there is none.

    Raises:
        FileError: If it is no number of at least 0; joint and key are named.
    """
    text = element.get(key, element.get(f"drake.{key}", "0"))
    with suppress(ValueError):
        if (number := float(text)) >= 0.0:
            return number
    problem = f"{key} must be a number of at least 0 (0: not given), not {text!r}"
    raise FileError(path or "", f"joint {joint.get('name')!r}: {problem}")


def build_model(path: Path, root: ET.Element, text: str) -> tuple[pin.Model, list[str]]:
    """Build the Pinocchio model of a URDF, its base fixed to the world.

    Args:
        path: The file, for errors.
        root: Its first element.
        text: That element as text.

    Returns:
        The model, and the parser's messages on what it left out.

    Raises:
        FileError: If Pinocchio refuses the robot; the parser's messages say why. If it drops a
            joint of a loop, about which it says nothing.
    """
    try:
        with parser_messages() as messages:
            model = pin.buildModelFromXML(text)
    except (ValueError, RuntimeError, IndexError) as error:
        reason = "; ".join(messages[-2:]) or one_line(error)  # it stops at the last one
        raise FileError(path, f"no URDF that Pinocchio can read: {reason}") from error
    known = {frame.name for frame in model.frames if frame.type != pin.FrameType.BODY}
    for joint in root.findall("joint"):
        if joint.get("name") not in known:
            problem = "is in a loop, or its child link has another parent"
            raise FileError(path, f"joint {joint.get('name')!r} {problem}")
    return model, messages


@lru_cache(maxsize=8)  # meshes of 100,000 triangles take a second
def read_geometry(
    model: pin.Model, path: Path, text: str, kind: pin.GeometryType
) -> pin.GeometryModel:
    """Read the visual or collision shapes of a URDF; meshes in its folder or above it.

    A mesh without triangles, and a solid whose sizes are all 0, are left out with a warning.

    Args:
        model: Its Pinocchio model.
        path: The file.
        text: The URDF as it was read.
        kind: Visual or collision shapes.

    Raises:
        FileError: A mesh is missing or damaged, or a size of a solid is negative.
    """
    folders = [str(folder) for folder in (*path.absolute().parents, *path.resolve().parents)]
    loader = coal.CachedMeshLoader(coal.BV_OBB)  # half of the default's time
    try:
        with parser_messages():  # they were shown when the robot was loaded
            found = pin.buildGeomFromUrdfString(model, text, kind, None, folders, loader)
        return _with_sizes(found, model, path)
    except (ValueError, RuntimeError) as error:
        empty = _NO_TRIANGLES.search(str(error))
        rest, links = _without_mesh(text, empty[1]) if empty else (text, [])
        if not empty or not links:
            # Behind where coal's source has it, before its advice.
            reason = one_line(error).rpartition("message: ")[2].partition(" Hint: ")[0]
            advice = "; ROS_PACKAGE_PATH names the folder of packages"
            advice *= _NOT_FOUND in reason
            raise FileError(path, f"a shape cannot be read ({reason}){advice}") from error
    named = ", ".join(dict.fromkeys(links))
    warn_caller(f"{path}: the mesh {empty[1]} of {named} has no triangles: it is left out")
    return read_geometry(model, path, rest, kind)


def _with_sizes(found: pin.GeometryModel, model: pin.Model, path: Path) -> pin.GeometryModel:
    """Return shapes without solids whose sizes are all 0, of which a warning tells."""
    for shape in list(found.geometryObjects):
        solid = shape.geometry
        sizes = [
            float(size)
            for name in ("radius", "halfLength", "halfSide")
            for size in np.ravel(getattr(solid, name, ()))
        ]
        link = model.frames[shape.parentFrame].name
        if min(sizes, default=1.0) < 0.0:
            what = f"a {type(solid).__name__.lower()} has a negative size"
            raise FileError(path, f"link {link!r}: {what}")
        if isinstance(solid, coal.BVHModelBase) and not np.isfinite(solid.vertices()).all():
            what = f"the mesh {shape.meshPath} has vertices that are no numbers"
            raise FileError(path, f"link {link!r}: {what}")
        if max(sizes, default=1.0) == 0.0:
            warn_caller(f"{path}: a {type(solid).__name__.lower()} of {link} has no size: left out")
            found.removeGeometryObject(shape.name)
    return found


def _without_mesh(text: str, file: str) -> tuple[str, list[str]]:
    """Return a URDF's text without the shapes of a mesh's file, and the names of their links."""
    root = ET.fromstring(text)
    links = []
    for link in root.findall("link"):
        for shape in link.findall("*/geometry/mesh/../.."):
            mesh = shape.find("geometry/mesh[@filename]")
            name = "" if mesh is None else mesh.get("filename", "").rpartition("://")[2]
            tail = posixpath.normpath(name).lstrip("./")
            if name and f"/{file}".endswith(f"/{tail}"):
                link.remove(shape)
                links.append(link.get("name", ""))
    return ET.tostring(root, encoding="unicode"), links


@contextmanager
def parser_messages() -> Iterator[list[str]]:
    """Collect the messages of Pinocchio's parser, each once; the list is filled at the end.

    The parser writes them to the standard error of the process, where anything else still goes.
    """
    messages: list[str] = []
    with _lock, TemporaryFile() as file:
        stderr = os.dup(2)
        os.dup2(file.fileno(), 2)
        try:
            yield messages
        finally:
            os.dup2(stderr, 2)
            os.close(stderr)
            file.seek(0)
            text = file.read()
            found = dict.fromkeys(_MESSAGE.findall(text))
            messages += [each.decode(errors="replace") for each in found if each != _UNSPECIFIC]
            os.write(2, _MESSAGE.sub(b"", text))
