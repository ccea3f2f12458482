"""Tools and held objects: shapes that a robot's tip carries beyond the links of its URDF."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.robot.obstacles import SHAPES, Box, Capsule, Obstacle, Sphere

ToolShapes = Obstacle | Iterable[Obstacle] | None
"""Shapes as they are given for a tool."""

RADIUS = 0.05
"""Radius of the capsule that stands for a tool without shapes [m]."""

_NO_LENGTH = 1e-6
"""Length up to which a tool only turns or names the tip: it has no body [m]."""


class Tool(NamedTuple):
    """A tool, fixed to a robot's tip, whose place its own frame takes.

    Attributes:
        name: Name of its frame.
        flange: Name of the frame to which it is fixed.
        pose: Pose of its frame in that of the flange.
        shapes: Its shapes in the frame of the flange.
        stated: Whether the shapes were stated.
    """

    name: str
    flange: str
    pose: pin.SE3
    shapes: tuple[Obstacle, ...]
    stated: bool

    def settings(self) -> dict[str, Any]:
        """Return arguments of `Robot.with_tool`, and the flange, as values that JSON can hold."""
        turn = pin.rpy.matrixToRpy(self.pose.rotation)
        return {
            "name": self.name,
            "flange": self.flange,
            "tool": [*self.pose.translation.tolist(), *turn.tolist()],
            "tool_shapes": [shape.settings() for shape in self.shapes],
        }

    @property
    def assumption(self) -> str:
        """Words for what stands for a tool whose shapes were not stated; "" if they were."""
        if self.stated or not self.shapes:
            return ""
        length = float(np.linalg.norm(self.pose.translation))
        return (
            f"{self.name!r} has no shapes: a capsule of radius {self.shapes[0].thickness:g} m from "
            f"{self.flange!r} to its tip, {length:.3g} m away, stands for it; tool_shapes= states "
            "others, or none by []"
        )


def make_tool(name: str, flange: str, pose: pin.SE3, shapes: ToolShapes) -> Tool:
    """Make a tool of the given shapes; of None, of one capsule from the flange to the tool's tip.

    The capsule's round end touches the flange, so that it meets no link before that. A tool whose
    tip is that of the flange has no capsule.

    Args:
        name: Name of the tool's frame.
        flange: Name of the frame to which it is fixed.
        pose: Pose of the tool's frame in that of the flange.
        shapes: A `Sphere`, `Capsule` or `Box` in that frame, or several; or None.

    Raises:
        InvalidInputError: A shape is another one, or moves; or obstacles go by such a name.
    """
    if name.rpartition(" ")[0].lower() in SHAPES:
        raise InvalidInputError("name", f"must not be an obstacle's, as {name!r} is", name)
    if shapes is not None:
        return Tool(name, flange, pose, _shapes("tool_shapes", shapes), True)
    tip = pose.translation
    length = float(np.linalg.norm(tip))
    if length <= _NO_LENGTH:
        return Tool(name, flange, pose, (), False)
    radius = min(RADIUS, length)
    near = radius / length * tip
    return Tool(name, flange, pose, (Capsule(near.tolist(), tip.tolist(), radius),), False)


def _shapes(argument: str, value: Any) -> tuple[Obstacle, ...]:
    """Return one shape or several as a tuple; refuse any that is no body of a tool."""
    shapes = tuple(value) if isinstance(value, Iterable) else (value,)
    for shape in shapes:
        if not isinstance(shape, Sphere | Capsule | Box):
            problem = f"must be a Sphere, Capsule or Box each, not {shape!r}"
            raise InvalidInputError(argument, problem, value)
        if shape.speed:
            problem = f"is carried by the robot: no velocity of its own, as {shape!r} has"
            raise InvalidInputError(argument, problem, value)
    return shapes
