"""The shapes that a robot is drawn with: primitives and meshes of its URDF's <visual>s."""

import xml.etree.ElementTree as ET
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.robot import Robot, file_of, urdf_of

Kind = Literal["cylinder", "sphere", "box", "mesh"]
Mesh = tuple[NDArray[np.float64], NDArray[np.int32]]

_STICK_RADIUS = 0.02  # [m]
STICK_COLOR = (0.6, 0.6, 0.6)
_GLASS = 0.5  # shapes less opaque are marks for programs, not parts of the robot


@dataclass(frozen=True, eq=False)
class Shape:
    """One primitive or mesh, fixed to a joint's frame.

    Attributes:
        kind: ``"cylinder"`` (along its own z axis), ``"sphere"``, ``"box"`` or ``"mesh"``.
        size: Radius and length, radius, or three edges [m]; of a mesh empty.
        mesh: Corners (k, 3) [m] and triangles (t, 3) of a mesh, from 0.
        joint: Index of Pinocchio's joint that carries it; 0 is the base.
        position: Its middle in the joint's frame [m], (3,).
        rotation: Its axes in the joint's frame, (3, 3).
        color: Red, green, blue, 0 to 1.
    """

    kind: Kind
    size: tuple[float, ...]
    mesh: Mesh | None
    joint: int
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    color: tuple[float, float, float]


def read_shapes(robot: Robot, kind: pin.GeometryType, text: str) -> list[pin.GeometryObject]:
    """Read the visual or collision shapes of a URDF's text; meshes in its folder or above it.

    Raises:
        InvalidInputError: The robot does not come from a file.
        ValueError: A mesh is missing or damaged.
    """
    path = file_of(robot)
    folders = [str(folder) for folder in (*path.absolute().parents, *path.resolve().parents)]
    try:
        found = pin.buildGeomFromUrdfString(robot.model, text, kind, package_dirs=folders)
    except RuntimeError as error:
        raise ValueError(str(error)) from error
    return list(found.geometryObjects)


@lru_cache(maxsize=4)  # a robot of 100,000 triangles takes seconds
def visual_shapes(robot: Robot) -> tuple[Shape, ...]:
    """List the shapes of a robot, or sticks from joint to joint where it has none.

    Meshes in the URDF's folder or above it are read; where one is missing, none is.

    Raises:
        InvalidInputError: If the robot does not come from a file.
    """
    text = urdf_of(robot)
    try:
        found = read_shapes(robot, pin.GeometryType.VISUAL, text)
    except ValueError:
        root = ET.fromstring(text)
        urdf.drop_meshes(root)
        found = read_shapes(robot, pin.GeometryType.VISUAL, urdf.text_of(root))
    shapes = []
    for part in found:
        *color, opacity = part.meshColor.tolist()
        drawn = _drawn(part.geometry) if opacity >= _GLASS else None
        if drawn is not None:
            pose = part.placement.copy()
            joint = int(part.parentJoint)
            shapes.append(Shape(*drawn, joint, pose.translation, pose.rotation, tuple(color)))
    return tuple(shapes or _sticks(robot))


def joint_poses(robot: Robot, q: ArrayLike, data: pin.Data | None = None) -> list[pin.SE3]:
    """Compute the pose of each joint's frame in the world, in the order of `Shape.joint`.

    Args:
        robot: The robot, n joints.
        q: Joint positions [rad], (n,).
        data: Pinocchio scratch memory to reuse; None makes it.
    """
    data = robot.model.createData() if data is None else data
    pin.forwardKinematics(robot.model, data, np.asarray(q, dtype=np.float64))
    return [data.oMi[i].copy() for i in range(robot.model.njoints)]


def _drawn(body: pin.CollisionGeometry) -> tuple[Kind, tuple[float, ...], Mesh | None] | None:
    """Return kind, size and mesh of one of coal's shapes; one that is not drawn gives None."""
    name = type(body).__name__
    if name == "Cylinder":
        return "cylinder", (body.radius, 2.0 * body.halfLength), None
    if name == "Sphere":
        return "sphere", (body.radius,), None
    if name == "Box":
        return "box", tuple(2.0 * body.halfSide), None
    if name.startswith("BVHModel"):
        triangles = map(body.tri_indices, range(body.num_tris))
        faces = np.array([(at[0], at[1], at[2]) for at in triangles], dtype=np.int32)
        return "mesh", (), (np.array(body.vertices()), faces)
    return None


def _sticks(robot: Robot) -> list[Shape]:
    """Make a cylinder from each joint to the next, and to the tip."""
    tip = robot.model.frames[robot.tip_id]
    ends = list(zip(robot.model.parents, robot.model.jointPlacements, strict=True))[1:]
    sticks = []
    for joint, pose in [*ends, (tip.parentJoint, tip.placement)]:
        end = pose.translation.copy()
        length = float(np.linalg.norm(end))
        if length > 1e-6:
            turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), end / length).matrix()
            size = (_STICK_RADIUS, length)
            sticks.append(Shape("cylinder", size, None, int(joint), 0.5 * end, turn, STICK_COLOR))
    return sticks
