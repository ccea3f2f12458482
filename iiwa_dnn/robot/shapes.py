"""The shapes of a robot's URDF: its collision shapes, and the meshes that it is drawn with."""

from __future__ import annotations

import warnings
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.files import one_line
from iiwa_dnn.robot.urdf import parser_messages

if TYPE_CHECKING:
    from iiwa_dnn.robot.robot import Robot

Mesh = tuple[pin.GeometryObject, NDArray[np.float64], NDArray[np.int32]]
"""A shape with its corners in the frame of the joint that carries it [m], (k, 3), and triangles of
these, (t, 3)."""


def source_of(robot: Robot) -> tuple[Path, str]:
    """Return file and text of a robot's URDF, or raise an InvalidInputError if it has no file."""
    if robot.path is None:
        raise InvalidInputError("robot", "must come from a URDF file", robot)
    return robot.path, str(robot.urdf)


def read_shapes(robot: Robot, kind: pin.GeometryType) -> pin.GeometryModel:
    """Read the visual or collision shapes of a robot's URDF; meshes in its folder or above it.

    Raises:
        InvalidInputError: The robot does not come from a file.
        FileError: A mesh is missing or damaged.
    """
    return _read(robot.model, *source_of(robot), kind).copy()


@lru_cache(maxsize=8)  # meshes of 100,000 triangles take a second
def _read(model: pin.Model, path: Path, text: str, kind: pin.GeometryType) -> pin.GeometryModel:
    folders = [str(folder) for folder in (*path.absolute().parents, *path.resolve().parents)]
    loader = coal.CachedMeshLoader(coal.BV_OBB)  # half of the default's time
    try:
        with parser_messages():  # they were shown when the robot was loaded
            return pin.buildGeomFromUrdfString(model, text, kind, None, folders, loader)
    except (ValueError, RuntimeError) as error:
        # Behind where coal's source has it, before its advice.
        reason = one_line(error).rpartition("message: ")[2].partition(" Hint: ")[0]
        advice = "ROS_PACKAGE_PATH names the folder of packages"
        raise FileError(path, f"a shape cannot be read ({reason}); {advice}") from error


def visual_shapes(robot: Robot) -> pin.GeometryModel:
    """Read the visual shapes of a robot; if a mesh is missing, return none and warn."""
    if robot.path is None:
        return pin.GeometryModel()
    try:
        return read_shapes(robot, pin.GeometryType.VISUAL)
    except FileError as error:
        warnings.warn(f"{robot.name} is drawn without its shapes: {error}", stacklevel=2)
        return pin.GeometryModel()


@lru_cache(maxsize=4)  # a robot of 100,000 triangles takes seconds
def visual_meshes(robot: Robot) -> tuple[Mesh, ...]:
    """List the meshes of `visual_shapes`."""
    meshes = []
    for shape in visual_shapes(robot).geometryObjects:
        body = shape.geometry
        if hasattr(body, "num_tris"):
            turn = shape.placement.rotation
            corners = np.array(body.vertices()) @ turn.T + shape.placement.translation
            triangles = map(body.tri_indices, range(body.num_tris))
            faces = np.array([(at[0], at[1], at[2]) for at in triangles], dtype=np.int32)
            meshes.append((shape, corners, faces))
    return tuple(meshes)
