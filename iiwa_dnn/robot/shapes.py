"""The shapes that a robot is drawn with: primitives and meshes of its URDF's <visual>s."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.robot import Robot, file_of, tree_of

Kind = Literal["cylinder", "sphere", "box", "mesh"]

_STICK_RADIUS, STICK_COLOUR = 0.02, (0.6, 0.6, 0.6)  # [m]
_GLASS = 0.5  # shapes less opaque are marks for programs, not parts of the robot


@dataclass(frozen=True, eq=False)
class Shape:
    """One primitive or mesh, fixed to a joint's frame.

    Attributes:
        kind: ``"cylinder"`` (along its own z axis), ``"sphere"``, ``"box"`` or ``"mesh"``.
        size: Radius and length, radius, or three edges [m]; of a mesh empty.
        joint: Index of Pinocchio's joint that carries it; 0 is the base.
        position: Its middle in the joint's frame [m], (3,).
        rotation: Its axes in the joint's frame, (3, 3).
        colour: Red, green, blue, 0 to 1.
        mesh: Corners (k, 3) [m] and triangles (t, 3) of a mesh, from 0.
    """

    kind: Kind
    size: tuple[float, ...]
    joint: int
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    colour: tuple[float, float, float]
    mesh: tuple[NDArray[np.float64], NDArray[np.int32]] | None = None


def visual_shapes(robot: Robot) -> list[Shape]:
    """List the shapes of a robot, or sticks from joint to joint where it has none.

    Meshes in the URDF's folder or above it are read; where one is missing, none is.

    Raises:
        InvalidInputError: If the robot does not come from a file.
        FileError: If the file cannot be read any more.
    """
    return list(_visuals(robot)) or _sticks(robot)


@lru_cache(maxsize=4)
def _visuals(robot: Robot) -> tuple[Shape, ...]:
    """Read the shapes; a robot of 100,000 triangles takes seconds."""
    path, shapes = file_of(robot), []
    root = tree_of(robot)
    folders = [str(folder) for folder in path.resolve().parents]
    visual = pin.GeometryType.VISUAL
    try:
        found = pin.buildGeomFromUrdfString(
            robot.model, urdf.text_of(root), visual, package_dirs=folders
        )
    except (ValueError, RuntimeError):  # a mesh that is missing or damaged
        urdf.drop_meshes(root)
        found = pin.buildGeomFromUrdfString(robot.model, urdf.text_of(root), visual)
    for part in found.geometryObjects:
        red, green, blue, opacity = map(float, part.meshColor)
        if opacity >= _GLASS and (measured := _measure(part.geometry)) is not None:
            kind, size, mesh = measured
            position, rotation = part.placement.translation.copy(), part.placement.rotation.copy()
            joint, colour = int(part.parentJoint), (red, green, blue)
            shapes.append(Shape(kind, size, joint, position, rotation, colour, mesh))
    return tuple(shapes)


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


def _measure(shape: pin.CollisionGeometry) -> tuple[Any, ...] | None:
    """Return kind, size and mesh of one of coal's shapes; None for one that is not drawn."""
    name = type(shape).__name__
    if name == "Cylinder":
        return "cylinder", (float(shape.radius), 2.0 * float(shape.halfLength)), None
    if name == "Sphere":
        return "sphere", (float(shape.radius),), None
    if name == "Box":
        return "box", tuple(2.0 * float(half) for half in shape.halfSide), None
    if name.startswith("BVHModel"):
        triangles = map(shape.tri_indices, range(shape.num_tris))
        faces = np.array([(at[0], at[1], at[2]) for at in triangles], dtype=np.int32)
        return "mesh", (), (np.array(shape.vertices()), faces)
    return None


def _sticks(robot: Robot) -> list[Shape]:
    """Make a cylinder from each joint to the next, and to the tip."""
    tip = robot.model.frames[robot.tip_id]
    ends = list(zip(robot.model.parents, robot.model.jointPlacements, strict=True))[1:]
    sticks = []
    for joint, place in [*ends, (tip.parentJoint, tip.placement)]:
        end = place.translation.copy()
        length = float(np.linalg.norm(end))
        if length > 1e-6:
            turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), end / length).matrix()
            size = (_STICK_RADIUS, length)
            sticks.append(Shape("cylinder", size, int(joint), 0.5 * end, turn, STICK_COLOUR))
    return sticks
