"""Obstacles that an arm keeps away from: convex shapes in the world, still or moving.

A body of bounded speed, such as a hand, states `speed` in place of a velocity: it may move in any
direction, turn and bend, as long as none of its points is quicker.
"""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, NamedTuple

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.files import one_line

BEYOND = 100.0
"""Half an edge of the cube that represents a half-space [m]."""


class PlacedBox(NamedTuple):
    """A box in the world; without extents a point, with one a segment.

    Attributes:
        center: Its middle [m], (3,).
        rotation: Its axes as columns, (3, 3).
        half_extents: Half of its edges [m], (3,).
    """

    center: checks.Array
    rotation: checks.Array
    half_extents: checks.Array

    def grown(self, radius: float) -> tuple[coal.CollisionGeometry, pin.SE3]:
        """Return as a shape of coal's, with its pose, the box, or the capsule of a radius [m]."""
        sides = 2.0 * self.half_extents
        shape = coal.Capsule(radius, sides[2]) if radius else coal.Box(*sides)
        return shape, pin.SE3(self.rotation, self.center)


def box_around(a: ArrayLike, b: ArrayLike) -> PlacedBox:
    """Return the segment between two points (3,) [m] as a box with its z axis along it."""
    axis = np.subtract(b, a, dtype=np.float64)
    length = float(np.linalg.norm(axis))
    up = np.array([0.0, 0.0, 1.0])
    turn = pin.Quaternion.FromTwoVectors(up, axis if length else up)
    half = np.array([0.0, 0.0, 0.5 * length])
    return PlacedBox(0.5 * np.add(a, b), turn.toRotationMatrix(), half)


@dataclass(frozen=True, kw_only=True)
class Obstacle(checks.Checked, ABC):
    """A convex shape that is fixed, or moves without turning.

    Attributes:
        velocity: Constant velocity [m/s], (3,).
        speed: Bound on its speed in any direction [m/s], in place of a velocity; of an obstacle
            without one, the length of `velocity`.
        error: Bound on the error of the place at which a sensor sees it [m], with `speed`.
        name: Its name; None: that of the shape, with a number.

    Raises:
        InvalidInputError: A parameter is wrong; it is named. So do all shapes.
    """

    _checks: ClassVar[checks.Checks] = {
        "velocity": checks.vector3,
        "speed": checks.not_negative,
        "error": checks.not_negative,
    }
    velocity: Sequence[float] = (0.0, 0.0, 0.0)
    speed: float = 0.0
    error: float = 0.0
    name: str | None = None

    def __post_init__(self) -> None:
        """Check the parameters; a velocity states the speed."""
        super().__post_init__()
        own = float(np.linalg.norm(self.velocity))
        if own and self.speed not in (0.0, own):
            raise InvalidInputError("speed", "is stated by the velocity: pass one of them", self)
        if self.error and not self.is_free:
            raise InvalidInputError("error", "is that of a body with a speed", self)
        self._set(speed=self.speed or own)

    @property
    def is_free(self) -> bool:
        """Test whether the obstacle moves in any direction at a bounded speed."""
        return self.speed > 0.0 and not np.any(self.velocity)

    @property
    @abstractmethod
    def box(self) -> PlacedBox:
        """Box that is the shape at time 0, grown by `thickness`."""

    @property
    def thickness(self) -> float:
        """Radius by which `box` is grown [m]."""
        return float(getattr(self, "radius", 0.0))

    def shift(self, t: float) -> checks.Array:
        """Return the displacement at a time [s], (3,) [m]."""
        return t * np.asarray(self.velocity)

    def settings(self) -> dict[str, Any]:
        """Return shape and parameters as a table of an obstacle file has them."""
        names = [field.name for field in fields(self)]
        if not self.is_free:
            names = [name for name in names if name not in ("speed", "error")]
        values = {name: getattr(self, name) for name in names}
        return {"shape": type(self).__name__} | {k: v for k, v in values.items() if v is not None}


def names_of(obstacles: Sequence[Obstacle]) -> list[str]:
    """Return the name of each obstacle: its own, or that of its shape with its number.

    Raises:
        InvalidInputError: Two have the same one.
    """
    names = [each.name or f"{type(each).__name__} {k}" for k, each in enumerate(obstacles, 1)]
    if len({*names}) < len(names):
        twice = max(names, key=names.count)
        raise InvalidInputError("obstacles", f"two go by the name {twice!r}", obstacles)
    return names


@dataclass(frozen=True)
class Sphere(Obstacle):
    """A sphere.

    Attributes:
        center: Its middle [m], (3,).
        radius: Its radius [m], above 0.
    """

    _checks: ClassVar[checks.Checks] = {"center": checks.vector3, "radius": checks.positive}
    center: Sequence[float]
    radius: float

    @property
    def box(self) -> PlacedBox:
        """A point at the center."""
        return box_around(self.center, self.center)


@dataclass(frozen=True)
class Capsule(Obstacle):
    """All points within a radius of a segment.

    Attributes:
        a: One end of the segment [m], (3,).
        b: The other end [m], (3,).
        radius: The radius [m], above 0.
    """

    _checks: ClassVar[checks.Checks] = {
        "a": checks.vector3,
        "b": checks.vector3,
        "radius": checks.positive,
    }
    a: Sequence[float]
    b: Sequence[float]
    radius: float

    @property
    def box(self) -> PlacedBox:
        """The segment from `a` to `b`."""
        return box_around(self.a, self.b)


def extents(argument: str, value: Sequence[float]) -> checks.Vector3:
    """Return half-extents of a box [m] as a tuple; refuse any that are not above 0."""
    found = checks.vector3(argument, value)
    checks.positive(argument, min(found))
    return found


def turned(argument: str, axes: ArrayLike) -> tuple[tuple[float, ...], ...]:
    """Return a rotation (3, 3) as a tuple of its rows; refuse any other value."""
    return tuple(map(tuple, checks.rotation(argument, axes).tolist()))


@dataclass(frozen=True)
class Box(Obstacle):
    """A box.

    Attributes:
        center: Center [m], (3,).
        half_extents: Halves of the edges [m], (3,), above 0.
        rotation: Axes of the box in the world as columns, (3, 3); None: the world's.
    """

    _checks: ClassVar[checks.Checks] = {
        "center": checks.vector3,
        "half_extents": extents,
        "rotation": turned,
    }
    center: Sequence[float]
    half_extents: Sequence[float]
    rotation: Sequence[Sequence[float]] | None = None

    @property
    def box(self) -> PlacedBox:
        """The box itself."""
        axes = np.eye(3) if self.rotation is None else np.array(self.rotation)
        return PlacedBox(np.array(self.center), axes, np.array(self.half_extents))


@dataclass(frozen=True)
class HalfSpace(Obstacle):
    """A half of space, such as the floor: all points x with normal . x <= offset.

    Attributes:
        normal: Direction out of it, (3,), of any length above 0; kept with length 1.
        offset: Its boundary's distance from the origin along the normal [m].
    """

    _checks: ClassVar[checks.Checks] = {"normal": checks.direction, "offset": checks.finite}
    normal: Sequence[float]
    offset: float

    @property
    def box(self) -> PlacedBox:
        """A cube with edges of 2 `BEYOND`, on the half-space's side of the boundary.

        The middle of one face is the boundary's point that is nearest to the origin.
        """
        normal = np.array(self.normal)
        _, rotation, _ = box_around(np.zeros(3), normal)
        return PlacedBox((self.offset - BEYOND) * normal, rotation, np.full(3, BEYOND))


SHAPES = {shape.__name__.lower(): shape for shape in (Sphere, Capsule, Box, HalfSpace)}


def make_obstacles(tables: Any) -> list[Obstacle]:
    """Make the obstacles of a file: a list of tables of ``shape`` and the shape's parameters.

    Raises:
        InvalidInputError: It is no list, or the shape or a parameter of the one with a number is
            missing, unknown or wrong.
    """
    if not isinstance(tables, list):
        raise InvalidInputError("obstacle", "must be tables [[obstacle]], one for each", tables)
    found: list[Obstacle] = []
    for number, table in enumerate(tables, 1):
        try:
            values = dict(table)
            shape = str(values.pop("shape", None)).replace("_", "").lower()
            found.append(SHAPES[checks.one_of("shape", shape, tuple(SHAPES))](**values))
        except (ValueError, TypeError) as error:
            raise InvalidInputError(
                f"obstacle {number}",
                one_line(error).rpartition("() ")[2],  # of Python's own message
                table,
            ) from error
    return found


def outline(obstacle: Obstacle) -> tuple[checks.Array, NDArray[np.int32]]:
    """Return a mesh of a shape at time 0 for pictures: vertices (k, 3) [m], triangles (m, 3).

    The mesh is a ball's, of radius `thickness`, each octant of which is moved to a corner of `box`.
    """
    center, rotation, half_extents = obstacle.box
    turn = np.linspace(0.0, 2.0 * np.pi, 32, endpoint=False) + 0.1
    height = np.cos(np.linspace(0.0, np.pi, 16))[:, np.newaxis]
    ring = np.sqrt(1.0 - height**2)  # 0 at both poles, each of which goes to one corner
    axes = np.broadcast_arrays(ring * np.cos(turn), ring * np.sin(turn), height)
    ball = np.stack(axes, axis=-1)
    corners = np.where(ball < 0.0, -half_extents, half_extents) + obstacle.thickness * ball
    here = np.arange(ball[..., 0].size, dtype=np.int32).reshape(height.size, -1)
    aside = np.roll(here, -1, axis=1)
    lower = np.stack([here[:-1], here[1:], aside[1:]], axis=-1)
    upper = np.stack([here[:-1], aside[1:], aside[:-1]], axis=-1)
    faces = np.concatenate([lower, upper]).reshape(-1, 3)
    return corners.reshape(-1, 3) @ rotation.T + center, faces
