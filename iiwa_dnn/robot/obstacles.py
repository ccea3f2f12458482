"""Obstacles that an arm keeps away from: convex shapes in the world, still or moving."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError, suggestion
from iiwa_dnn.files import one_line


@dataclass(frozen=True, kw_only=True)
class Obstacle(ABC):
    """A convex shape that stands still or moves without turning.

    Attributes:
        velocity: Constant velocity [m/s], (3,).

    Raises:
        InvalidInputError: A parameter is wrong; it is named. So do all shapes.
    """

    velocity: Sequence[float] = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for name in {"center", "a", "b", "half_extents", "velocity"} & vars(self).keys():
            self._set(name, checks.vector3(name, getattr(self, name)))
        if hasattr(self, "radius"):
            checks.positive("radius", self.radius)

    @property
    def moves(self) -> bool:
        """True if the obstacle ever moves."""
        return any(self.velocity)

    @property
    def speed(self) -> float:
        """Bound on the speed [m/s]."""
        return float(np.linalg.norm(self.velocity))

    @property
    @abstractmethod
    def points(self) -> checks.Array:
        """Points whose convex hull, grown by `thickness`, is the shape at time 0 [m], (k, 3)."""

    @property
    def thickness(self) -> float:
        """Radius by which the hull of `points` is grown [m]."""
        return float(getattr(self, "radius", 0.0))

    def shift(self, t: float) -> checks.Array:
        """Return the displacement at a time [s], (3,) [m]."""
        return t * np.asarray(self.velocity)

    def settings(self) -> dict[str, Any]:
        """Return shape and parameters as a table of an obstacle file has them."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return {"shape": type(self).__name__} | {k: v for k, v in values.items() if v is not None}

    def _set(self, name: str, value: object) -> None:
        object.__setattr__(self, name, value)


@dataclass(frozen=True)
class Sphere(Obstacle):
    """A sphere.

    Attributes:
        center: Its middle [m], (3,).
        radius: Its radius [m], above 0.
    """

    center: Sequence[float]
    radius: float

    @property
    def points(self) -> checks.Array:
        """The middle, (1, 3)."""
        return np.array([self.center])


@dataclass(frozen=True)
class Capsule(Obstacle):
    """All points within a radius of a segment.

    Attributes:
        a: One end of the segment [m], (3,).
        b: The other end [m], (3,).
        radius: The radius [m], above 0.
    """

    a: Sequence[float]
    b: Sequence[float]
    radius: float

    @property
    def points(self) -> checks.Array:
        """The ends, (2, 3)."""
        return np.array([self.a, self.b])


@dataclass(frozen=True)
class Box(Obstacle):
    """A box.

    Attributes:
        center: Its middle [m], (3,).
        half_extents: Half of its edges [m], (3,), above 0.
        rotation: Its axes in the world as columns, (3, 3); None: the world's.
    """

    center: Sequence[float]
    half_extents: Sequence[float]
    rotation: Sequence[Sequence[float]] | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        for half in self.half_extents:
            checks.positive("half_extents", half)
        if self.rotation is not None:
            turn = checks.rotation("rotation", self.rotation)
            self._set("rotation", tuple(map(tuple, turn.tolist())))

    @property
    def points(self) -> checks.Array:
        """The corners, (8, 3)."""
        signs = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
        axes = np.eye(3) if self.rotation is None else np.array(self.rotation)
        corners: checks.Array = (
            np.asarray(self.center) + signs * np.asarray(self.half_extents) @ axes.T
        )
        return corners


@dataclass(frozen=True)
class ConvexMesh(Obstacle):
    """The convex hull of points.

    Attributes:
        vertices: The points [m], (k, 3), four at least, not all in a plane.
    """

    vertices: Sequence[Sequence[float]]

    def __post_init__(self) -> None:
        super().__post_init__()
        vertices = checks.finite_array("vertices", self.vertices, (-1, 3))
        if len(vertices) < 4 or np.linalg.matrix_rank(vertices - vertices[0], 1e-9) < 3:
            raise InvalidInputError("vertices", "must be four or more and span a solid", vertices)
        self._set("vertices", tuple(map(tuple, vertices.tolist())))

    @property
    def points(self) -> checks.Array:
        """The vertices, (k, 3)."""
        return np.array(self.vertices)


@dataclass(frozen=True)
class HalfSpace(Obstacle):
    """A half of space, such as the floor: all points x with normal . x <= offset.

    Attributes:
        normal: Direction out of it, (3,), of any length above 0; kept with length 1.
        offset: Its boundary's distance from the origin along the normal [m].
    """

    normal: Sequence[float]
    offset: float

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set("normal", checks.direction("normal", self.normal))
        checks.finite("offset", self.offset)

    @property
    def points(self) -> checks.Array:
        """A point of the boundary, (1, 3)."""
        return self.offset * np.array([self.normal])


SHAPES: dict[str, type[Obstacle]] = {
    shape.__name__: shape for shape in (Sphere, Capsule, Box, ConvexMesh, HalfSpace)
}


def make_obstacle(table: dict[str, Any]) -> Obstacle:
    """Make an obstacle from a table of an obstacle file: ``shape`` and the shape's parameters.

    Raises:
        InvalidInputError: The shape or a parameter is missing, unknown or wrong.
    """
    values = dict(table)
    name = str(values.pop("shape", "")).replace("_", "").lower()
    kind = next((kind for shape, kind in SHAPES.items() if shape.lower() == name), None)
    if kind is None:
        raise InvalidInputError("shape", f"must be one of {', '.join(SHAPES)}, not {name!r}")
    known = {field.name for field in fields(kind)}
    for unknown in sorted(values.keys() - known):
        problem = f"is no parameter of {kind.__name__}{suggestion(unknown, sorted(known))}"
        raise InvalidInputError(unknown, problem)
    try:
        return kind(**values)
    except TypeError as error:
        raise InvalidInputError(kind.__name__, one_line(error).partition(" ")[2]) from error


def outline(obstacle: Obstacle) -> tuple[checks.Array, NDArray[np.int32]]:
    """Return vertices (k, 3) [m] at time 0 and triangles (m, 3) of a shape, for pictures."""
    from scipy.spatial import ConvexHull  # slow to import

    points = obstacle.points
    if obstacle.thickness:
        rank = np.arange(800) + 0.5  # points spread evenly over a ball
        turn = np.pi * (1.0 + 5.0**0.5) * rank
        height = 1.0 - rank / 400.0
        ring = np.sqrt(1.0 - height**2)
        ball = np.column_stack([ring * np.cos(turn), ring * np.sin(turn), height])
        points = (points[:, np.newaxis] + obstacle.thickness * ball).reshape(-1, 3)
    hull = ConvexHull(points)
    faces = hull.simplices.astype(np.int32)
    a, b, c = points[faces].transpose(1, 0, 2)
    inward = np.sum(np.cross(b - a, c - a) * hull.equations[:, :3], axis=1) < 0.0
    faces[inward] = faces[inward, ::-1]
    return points, faces
