"""The shapes that a robot is drawn with: the <visual> primitives of its URDF, link by link."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.robot import Robot, file_of

Kind = Literal["cylinder", "sphere", "box"]

_STICK_RADIUS, _STICK_COLOUR = 0.02, (0.6, 0.6, 0.6)  # [m]


@dataclass(frozen=True, eq=False)
class Shape:
    """One primitive, fixed to a joint's frame.

    Attributes:
        kind: ``"cylinder"`` (along its own z axis), ``"sphere"`` or ``"box"``.
        size: Radius and length, radius, or three edges [m].
        joint: Index of Pinocchio's joint that carries it; 0 is the base.
        position: Its middle in the joint's frame [m], (3,).
        rotation: Its axes in the joint's frame, (3, 3).
        colour: Red, green, blue, 0 to 1.
    """

    kind: Kind
    size: tuple[float, ...]
    joint: int
    position: NDArray[np.float64]
    rotation: NDArray[np.float64]
    colour: tuple[float, float, float]


def visual_shapes(robot: Robot) -> list[Shape]:
    """List the primitives of a robot, or sticks from joint to joint where it has only meshes.

    Raises:
        InvalidInputError: If the robot does not come from a file.
        FileError: If the file cannot be read any more.
    """
    root = urdf.read(file_of(robot))
    urdf.drop_meshes(root)
    visuals = pin.buildGeomFromUrdfString(robot.model, urdf.text_of(root), pin.GeometryType.VISUAL)
    shapes = []
    for found in visuals.geometryObjects:
        if (measured := _measure(found.geometry)) is not None:
            position, rotation = found.placement.translation.copy(), found.placement.rotation.copy()
            red, green, blue = map(float, found.meshColor[:3])
            joint = int(found.parentJoint)
            shapes.append(Shape(*measured, joint, position, rotation, (red, green, blue)))
    return shapes or _sticks(robot)


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


def _measure(shape: pin.CollisionGeometry) -> tuple[Kind, tuple[float, ...]] | None:
    """Return kind and size of one of coal's primitives; None for anything else."""
    name = type(shape).__name__
    if name == "Cylinder":
        return "cylinder", (float(shape.radius), 2.0 * float(shape.halfLength))
    if name == "Sphere":
        return "sphere", (float(shape.radius),)
    if name == "Box":
        return "box", tuple(2.0 * float(half) for half in shape.halfSide)
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
            sticks.append(Shape("cylinder", size, int(joint), 0.5 * end, turn, _STICK_COLOUR))
    return sticks
