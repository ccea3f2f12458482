"""The shapes of a robot: those of its URDF, of its tools, and the meshes that it is drawn with."""

import warnings
from functools import lru_cache
from pathlib import Path

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.robot.fitting import surface_of
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.urdf import read_geometry

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
    return read_geometry(robot.model, *source_of(robot), kind).copy()


def tool_shapes(robot: Robot) -> list[pin.GeometryObject]:
    """List the shapes of a robot's tools in the frames of the joints that carry them."""
    found = []
    for tool in robot.tools:
        index = robot.frame_id(tool.name)
        flange = robot.model.frames[robot.frame_id(tool.flange)]
        for number, shape in enumerate(tool.shapes):
            body, pose = shape.box.grown(shape.thickness)
            place = flange.placement * pose
            name = f"{tool.name}_{number}"
            found.append(pin.GeometryObject(name, flange.parentJoint, index, place, body))
    return found


def visual_shapes(robot: Robot) -> pin.GeometryModel:
    """Read the visual shapes of a robot; if a mesh is missing, warn, and return its tools alone."""
    shapes = pin.GeometryModel()
    try:
        if robot.path is not None:
            shapes = read_shapes(robot, pin.GeometryType.VISUAL)
    except FileError as error:
        warnings.warn(f"{robot.name} is drawn without its shapes: {error}", stacklevel=2)
    for tool in tool_shapes(robot):
        shapes.addGeometryObject(tool)
    return shapes


@lru_cache(maxsize=4)  # a robot of 100,000 triangles takes seconds
def visual_meshes(robot: Robot) -> tuple[Mesh, ...]:
    """List the meshes of `visual_shapes`."""
    meshes = []
    for shape in visual_shapes(robot).geometryObjects:
        if hasattr(shape.geometry, "num_tris"):
            meshes.append((shape, *surface_of(shape.geometry, shape.placement)))
    return tuple(meshes)
