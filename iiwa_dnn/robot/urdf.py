"""URDF files: read with care, then made into a Pinocchio model.

The file is first read as XML here. That gives one-line reasons for what is wrong with it, and a few
facts that Pinocchio's model does not keep: which limits were given, which joints follow others.
"""

from __future__ import annotations

import os
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.errors import FileError, InvalidInputError, NotFoundError


class _NoDoctype(ET.TreeBuilder):
    """Refuses a DOCTYPE: a URDF needs none, and entities can read files or fill the memory."""

    def doctype(self, *_: str | None) -> None:
        raise ET.ParseError("a DOCTYPE is not accepted")


def read(path: Path) -> tuple[str, dict[str, ET.Element]]:
    """Read a URDF file as XML.

    Args:
        path: The file.

    Returns:
        The XML text for :func:`build_model`, and the ``<joint>`` elements by name.

    Raises:
        FileError: If the file cannot be read, is not XML, has a DOCTYPE or is not a robot with
            joints.
    """
    try:
        content = path.read_bytes()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        raise FileError(path, getattr(error, "strerror", None) or str(error)) from error
    try:
        root = ET.fromstring(content, parser=ET.XMLParser(target=_NoDoctype()))
        # What was checked is what Pinocchio gets: the tree, not the file's bytes.
        text = ET.tostring(root, encoding="unicode")
    except (ET.ParseError, LookupError, ValueError, RecursionError) as error:
        raise FileError(path, f"not XML that can be read: {error}") from error
    if root.tag != "robot":
        raise FileError(path, f"not a URDF: its first element is <{root.tag}>, not <robot>")
    joints = {joint.get("name", ""): joint for joint in root.findall("joint")}
    if not joints:
        raise FileError(path, "the robot has no joints")
    return text, joints


def build_model(path: Path, text: str) -> pin.Model:
    """Build the Pinocchio model of a URDF, with no word on the console.

    Args:
        path: The file that the text came from, for the error.
        text: The URDF's XML.

    Returns:
        The model, its base fixed to the world.

    Raises:
        FileError: If Pinocchio refuses the text (its own first complaint is the reason), or no
            joint moves.
    """
    complaints: list[str] = []
    try:
        with _captured_stderr(complaints):
            model = pin.buildModelFromXML(text)
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
    """Collect what C++ writes to standard error; urdfdom tells its reasons only there.

    It redirects the process's file descriptor 2, as nothing else reaches C++ streams, so another
    thread's messages of these few milliseconds end up in ``lines`` too.
    """
    try:
        saved = os.dup(2)
    except OSError:  # the process has no standard error
        yield
        return
    try:
        with tempfile.TemporaryFile() as file:
            os.dup2(file.fileno(), 2)
            try:
                yield
            finally:
                os.dup2(saved, 2)
                file.seek(0)
                lines += file.read().decode(errors="replace").splitlines()
    finally:
        os.close(saved)


def lock(model: pin.Model, locked: tuple[str, ...]) -> pin.Model:
    """Freeze joints at their zero position, or at the limit nearest to it.

    Args:
        model: The model with all its joints.
        locked: Names of the joints to freeze.

    Returns:
        The model of the joints that are left; ``model`` itself if none is to be frozen.

    Raises:
        NotFoundError: If there is no such joint.
        InvalidInputError: If no joint is left.
    """
    names = tuple(model.names)
    for name in locked:
        if name not in names[1:]:
            raise NotFoundError("joint", name, names[1:])
    if len(locked) == len(names) - 1:
        raise InvalidInputError("locked", "no joint is left to move", locked)
    if not locked:
        return model
    # A zero position can lie outside the limits (the panda's joint 4): then the nearest limit.
    posture = np.clip(pin.neutral(model), model.lowerPositionLimit, model.upperPositionLimit)
    return pin.buildReducedModel(model, [names.index(name) for name in locked], posture)


def check_one_coordinate_each(model: pin.Model, joints: dict[str, ET.Element]) -> None:
    """Refuse continuous, planar and floating joints: for those, q and its velocity differ in kind.

    Args:
        model: The model.
        joints: The URDF's ``<joint>`` elements by name.

    Raises:
        InvalidInputError: At the first such joint, with its name.
    """
    for index, name in enumerate(tuple(model.names)[1:], start=1):
        if model.nqs[index] != 1 or model.nvs[index] != 1:
            problem = (
                f"joint {name!r} is {joints[name].get('type')}; only joints with one coordinate "
                "are supported: lock it, or make it revolute, with limits, in the URDF"
            )
            raise InvalidInputError("locked", problem, name)


def check_no_mimic(model: pin.Model, tip_id: int, joints: dict[str, ET.Element]) -> None:
    """Refuse a joint that moves the tip and follows another: here it would move on its own.

    Args:
        model: The model.
        tip_id: Index of the tip frame.
        joints: The URDF's ``<joint>`` elements by name.

    Raises:
        InvalidInputError: At the first such joint, with its name.
    """
    names = tuple(model.names)
    for index in list(model.supports[model.frames[tip_id].parentJoint])[1:]:
        mimic = joints[names[index]].find("mimic")
        if mimic is not None:
            problem = (
                f"joint {names[index]!r} follows {mimic.get('joint')!r} (<mimic>), which is not "
                "supported between base and tip: lock it"
            )
            raise InvalidInputError("locked", problem, names[index])


def limits(
    path: Path, model: pin.Model, joints: dict[str, ET.Element]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """The URDF's limits; infinite where it gives none.

    A joint without ``lower`` and ``upper`` has no position limit; velocity 0 means "not given".

    Args:
        path: The file, for the error.
        model: The model, each joint with one coordinate.
        joints: The URDF's ``<joint>`` elements by name.

    Returns:
        Lower and upper position limits [rad] and velocity limits [rad/s], each of shape (n,).

    Raises:
        FileError: If a lower limit is not below the upper one, or a velocity limit is negative.
    """
    lower, upper = model.lowerPositionLimit.copy(), model.upperPositionLimit.copy()
    velocity = model.velocityLimit.copy()
    for i, name in enumerate(tuple(model.names)[1:]):
        limit = joints[name].find("limit")
        if limit is None or not {"lower", "upper"} & set(limit.keys()):
            lower[i], upper[i] = -np.inf, np.inf
        if not lower[i] < upper[i]:
            raise FileError(path, f"joint {name!r}: lower limit {lower[i]} is not below {upper[i]}")
        if not velocity[i] >= 0.0:
            raise FileError(path, f"joint {name!r}: velocity limit {velocity[i]} is negative")
    velocity[velocity == 0.0] = np.inf
    return lower, upper, velocity
