"""The shapes of a robot's URDF: its collision shapes, and the meshes that it is drawn with."""

import xml.etree.ElementTree as ET
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.robot import Robot, source_of

_GLASS = 0.5  # shapes less opaque are marks for programs, not parts of the robot


class Mesh(NamedTuple):
    """A mesh, fixed to a joint's frame.

    Attributes:
        joint: Index of Pinocchio's joint that carries it; 0 is the base.
        corners: Corners in the joint's frame [m], (k, 3).
        faces: Triangles of corners, from 0, (t, 3).
        color: Red, green, blue, 0 to 1.
    """

    joint: int
    corners: NDArray[np.float64]
    faces: NDArray[np.int32]
    color: tuple[float, ...]


def read_shapes(robot: Robot, kind: pin.GeometryType, text: str) -> list[pin.GeometryObject]:
    """Read the visual or collision shapes of a URDF's text; meshes in its folder or above it.

    Raises:
        InvalidInputError: The robot does not come from a file.
        ValueError: A mesh is missing or damaged.
    """
    path = source_of(robot)[0]
    folders = [str(folder) for folder in (*path.absolute().parents, *path.resolve().parents)]
    try:
        found = pin.buildGeomFromUrdfString(robot.model, text, kind, package_dirs=folders)
    except RuntimeError as error:
        raise ValueError(str(error)) from error
    return list(found.geometryObjects)


@lru_cache(maxsize=4)  # a robot of 100,000 triangles takes seconds
def visual_meshes(robot: Robot) -> tuple[Mesh, ...]:
    """List the meshes of a robot's <visual>s.

    Meshes in the URDF's folder or above it are read; where one is missing, none is.

    Raises:
        InvalidInputError: If the robot does not come from a file.
    """
    text = source_of(robot)[1]
    try:
        shapes = read_shapes(robot, pin.GeometryType.VISUAL, text)
    except ValueError:
        root = ET.fromstring(text)
        urdf.drop_meshes(root)
        shapes = read_shapes(robot, pin.GeometryType.VISUAL, urdf.text_of(root))
    meshes = []
    for shape in shapes:
        *color, opacity = shape.meshColor.tolist()
        body = shape.geometry
        if opacity >= _GLASS and hasattr(body, "num_tris"):
            turn = shape.placement.rotation
            corners = np.array(body.vertices()) @ turn.T + shape.placement.translation
            triangles = map(body.tri_indices, range(body.num_tris))
            faces = np.array([(at[0], at[1], at[2]) for at in triangles], dtype=np.int32)
            meshes.append(Mesh(int(shape.parentJoint), corners, faces, tuple(color)))
    return tuple(meshes)
