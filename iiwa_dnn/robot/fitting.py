"""Bodies around shapes: capsules, or boxes, that hold all of a shape, in as many parts as pay.

A shape is cut in two where the bodies around its halves have much less volume than the one around
the whole, and each half in its turn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import combinations, product
from typing import NamedTuple

import coal
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.checks import Array
from iiwa_dnn.robot.obstacles import PlacedBox, box_around

CUTS = 2
"""Times that a part is cut in two at most, one after another."""

WORTH = 0.7
"""Ratio of volumes up to which a cut, or a box in place of a capsule, pays."""

FINE = 0.03
"""Radius up to which a body is not cut, and is no box [m]."""

SIDES = 24
"""Sides of the prism around a cylinder."""

GRID = 1e-3
"""Spacing to which corners of a mesh are rounded for its hull [m]; coal refuses fine ones."""

_TURNED = 0.2
_TRIALS = 200
"""First turn of a capsule's axis [rad], and trials of axes until it is as small as it gets."""


_TURNS = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
_RIM = np.array([np.cos(_TURNS), np.sin(_TURNS), 0.0 * _TURNS]).T / np.cos(np.pi / SIDES)
_BALL = np.concatenate([_RIM * [y, y, 0.0] + [0.0, 0.0, x] for x, y, _ in _RIM[: SIDES // 2 + 1]])
"""Corners of polygons and polyhedra around the unit circle and the unit ball."""


class Surface(NamedTuple):
    """Triangles.

    Attributes:
        points: Points [m], (k, 3).
        faces: Three of the points, by their indices, for each triangle, (t, 3).
    """

    points: Array
    faces: NDArray[np.int32]

    @property
    def used(self) -> Array:
        """The points of the triangles [m], (k, 3)."""
        used = np.zeros(len(self.points), dtype=bool)
        used[self.faces] = True
        return np.asarray(self.points[used])

    def cut(self, axis: Array, at: Array) -> list[Surface]:
        """Cut the triangles by a plane through a point across an axis; return both sides."""
        heights = (self.points - at) @ axis
        high = heights[self.faces] > 0.0
        above = high.sum(axis=1)
        alone = np.where(above == 1, high.argmax(axis=1), high.argmin(axis=1))
        order = (alone[:, np.newaxis] + np.arange(3)) % 3
        crossed = (above == 1) | (above == 2)
        a, b, c = np.take_along_axis(self.faces, order, 1)[crossed].T
        cuts = []
        for end in (b, c):
            ratio = heights[a] / (heights[a] - heights[end])
            cuts.append(self.points[a] + ratio[:, np.newaxis] * (self.points[end] - self.points[a]))
        p = len(self.points) + np.arange(len(a))
        q = p + len(a)
        tips = np.stack([a, p, q], axis=1)
        rests = np.concatenate([np.stack([p, b, c], axis=1), np.stack([p, c, q], axis=1)])
        points = np.concatenate([self.points, *cuts])
        single = above[crossed] == 1
        sides = [
            np.concatenate([self.faces[above == whole], tips[tip], rests[np.tile(~tip, 2)]])
            for whole, tip in ((3, single), (0, ~single))
        ]
        return [Surface(points, side) for side in sides if len(side)]


class Body(NamedTuple):
    """A box grown by a radius around a part of a shape.

    Attributes:
        box: The box; a capsule lies along its third axis.
        radius: Radius by which it is grown [m]; 0 of a box.
        corners: Corners of the convex hull of the part, or what is left of it without the radius
            of a ball or a capsule [m], (k, 3).
    """

    box: PlacedBox
    radius: float
    corners: Array

    @property
    def volume(self) -> float:
        """Volume of a box or a capsule [m^3]."""
        half = self.box.half_extents
        across = np.pi * self.radius**2 * (2.0 * half[2] + 4.0 / 3.0 * self.radius)
        return float(8.0 * half.prod() + across)

    @property
    def size(self) -> float:
        """Radius of a capsule, or half of the second largest edge of a box [m]."""
        return self.radius + float(np.sort(self.box.half_extents)[1])

    @property
    def ends(self) -> Array:
        """The ends of the segment of a capsule [m], (2, 3)."""
        half = self.box.half_extents[2] * self.box.rotation[:, 2]
        return np.array([self.box.center - half, self.box.center + half])

    @property
    def placed(self) -> tuple[coal.CollisionGeometry, pin.SE3]:
        """The body as a shape of coal's, and its pose."""
        return self.box.grown(self.radius)

    @property
    def hull(self) -> tuple[coal.CollisionGeometry, pin.SE3]:
        """The convex hull of the part as a shape of coal's, and its pose; the body if flat."""
        corners = np.unique(np.round(self.corners / GRID), axis=0) * GRID
        if np.linalg.matrix_rank(corners - corners[0], GRID) < corners.shape[1]:
            return self.placed  # coal crashes
        points = coal.StdVec_Vec3s()
        points.extend(corners)
        try:
            return coal.ConvexBase.convexHull(points, True, "Qt"), pin.SE3.Identity()
        except RuntimeError:  # too many neighbours of a corner
            return self.placed


def fit_bodies(
    shapes: Sequence[tuple[coal.CollisionGeometry, pin.SE3]],
) -> list[Body]:
    """Fit bodies around the shapes of a link, with their poses.

    One body holds all of them, unless several have much less volume.

    Returns:
        Capsules that hold the link, then boxes that do with much less volume, if there are any.
    """
    capsules: list[Body] = []
    boxes: list[Body] = []
    for shape, pose in sorted(shapes, key=lambda each: isinstance(each[0], coal.Sphere)):
        surface = surface_of(shape, pose)
        exact = _exact_capsule(shape, pose)
        if exact:
            _add(capsules, exact)
        else:
            capsules += map(_smallest, _cover(surface, CUTS, _capsule))
        boxes += [_box(surface.points)] if exact else _cover(surface, CUTS, _box)
    if len(shapes) > 1:
        corners = np.concatenate([each.corners for each in boxes])
        capsules = _fewer(capsules, _smallest(_capsule(corners)))
        boxes = _fewer(boxes, _box(corners))
    is_thin = max(each.radius for each in capsules) < FINE
    pays = not is_thin and _volume(boxes) <= WORTH * _volume(capsules)
    return capsules + boxes * pays


def _fewer(bodies: list[Body], whole: Body) -> list[Body]:
    """Return bodies, or the one around all of them if it has not much more volume."""
    pays = whole.size > FINE and _volume(bodies) < WORTH * whole.volume
    return bodies if pays or len(bodies) == 1 else [whole]


def _add(capsules: list[Body], exact: Body) -> None:
    """Add a capsule, or its corners to those of a capsule of which it is a round end."""
    for k, capsule in enumerate(capsules):
        if _holds(capsule, exact):
            corners = _corners(np.concatenate([capsule.corners, exact.corners]))
            capsules[k] = capsule._replace(corners=corners)
            return
    capsules.append(exact)


def _volume(bodies: Iterable[Body]) -> float:
    """Return the sum of the volumes of bodies [m^3]."""
    return sum(each.volume for each in bodies)


def _exact_capsule(shape: coal.CollisionGeometry, pose: pin.SE3) -> Body | None:
    """Return the capsule that is a ball, a capsule or, but for its ends, a cylinder; else None."""
    half = np.array([0.0, 0.0, getattr(shape, "halfLength", 0.0)])
    is_long = isinstance(shape, coal.Cylinder) and half[2] >= shape.radius
    if not is_long and not isinstance(shape, coal.Sphere | coal.Capsule):
        return None
    corners = surface_of(shape, pose).points
    box = PlacedBox(pose.translation, pose.rotation, half)
    return Body(box, float(shape.radius), corners)


def _holds(capsule: Body, ball: Body) -> bool:
    """Test whether a round end of a capsule encloses a ball, to 0.03 mm."""
    away = np.linalg.norm(capsule.ends - ball.box.center, axis=1).min()
    return not ball.box.half_extents.any() and bool(away + ball.radius <= capsule.radius + 3e-5)


def surface_of(shape: coal.CollisionGeometry, pose: pin.SE3) -> Surface:
    """Return the triangles of a mesh, or the lines between all corners of a solid.

    A line is a triangle with an end twice. A polyhedron around it stands for a round solid.
    """
    if hasattr(shape, "num_tris"):
        points = np.array(shape.vertices(), dtype=np.float64)
        faces = [(at[0], at[1], at[2]) for at in map(shape.tri_indices, range(shape.num_tris))]
    else:
        points = _corners(_solid_corners(shape))
        faces = [(i, k, k) for i, k in combinations(range(len(points)), 2)]
    points = points @ pose.rotation.T + pose.translation
    return Surface(points, np.array(faces, dtype=np.int32))


def _solid_corners(shape: coal.CollisionGeometry) -> Array:
    """Return the corners of a convex solid, or of a polyhedron around a round one (k, 3) [m]."""
    if hasattr(shape, "halfSide"):
        return np.array([*product(*zip(-shape.halfSide, shape.halfSide, strict=True))])
    if not hasattr(shape, "radius"):
        return np.array(shape.points(), dtype=np.float64)
    half = np.array([0.0, 0.0, getattr(shape, "halfLength", 0.0)])
    if isinstance(shape, coal.Sphere | coal.Capsule):
        return np.concatenate([shape.radius * _BALL - half, shape.radius * _BALL + half])
    return np.concatenate([shape.radius * _RIM - half, shape.radius * _RIM + half])


def _cover(surface: Surface, cuts: int, fit: Callable[[Array], Body]) -> list[Body]:
    """Cover triangles with bodies, each of which may be cut so many times."""
    whole = fit(surface.used)
    found = [whole._replace(corners=_corners(whole.corners))]
    least = WORTH * whole.volume
    axes = _principal_axes(whole.corners) if cuts and whole.size > FINE else ()
    for axis in axes:
        halves = surface.cut(axis, _middle(whole.corners))
        volume = sum(fit(half.used).volume for half in halves)
        if volume < least:
            least = volume
            found = [each for half in halves for each in _cover(half, cuts - 1, fit)]
    return found


def _corners(points: Array) -> Array:
    """Return the corners (k, 3) of the convex hull of points (k, 3), or all if they are flat."""
    from scipy.spatial import ConvexHull, QhullError  # slow to import

    try:
        return np.asarray(points[ConvexHull(points).vertices])
    except QhullError:
        return points


def _box(points: Array) -> Body:
    """Fit a box around points (k, 3), along the axes of their frame or along principal axes."""
    boxes = []
    for axes in (np.eye(3), _principal_axes(points)):
        along = points @ axes.T
        low = along.min(axis=0)
        high = along.max(axis=0)
        half = np.maximum(0.5 * (high - low), GRID)
        box = PlacedBox(axes.T @ (0.5 * (low + high)), axes.T, half)
        boxes.append(Body(box, 0.0, points))
    return min(boxes, key=lambda each: each.volume)


def _capsule(points: Array) -> Body:
    """Fit a capsule around points (k, 3), along the principal axis that makes it smallest."""
    middle = _middle(points)
    capsules = (_along(points, axis, middle) for axis in _principal_axes(points))
    return min(capsules, key=lambda each: each.volume)


def _middle(points: Array) -> Array:
    """Return the middle of the box around points (k, 3) along the axes of their frame, (3,)."""
    return np.asarray(0.5 * (points.min(axis=0) + points.max(axis=0)))


def _principal_axes(points: Array) -> Array:
    """Return the principal axes about the `_middle` of points (k, 3), right-handed rows, (3, 3)."""
    away = points - _middle(points)
    axes = np.linalg.eigh(away.T @ away)[1].T
    axes[0] = np.cross(axes[1], axes[2])
    return np.asarray(axes)


def _along(points: Array, axis: Array, middle: Array) -> Body:
    """Fit a capsule around points (k, 3) [m] with its segment on a line.

    For a line and a radius the shortest segment is known in closed form. The ends of a ball are
    equal.
    """
    along = (points - middle) @ axis
    across = np.linalg.norm(points - middle - along[:, np.newaxis] * axis, axis=1)
    radius = float(across.max()) + 1e-9
    cap = np.sqrt(radius**2 - across**2)
    low = float((along + cap).min())
    high = float((along - cap).max())
    if low > high:  # any point between them is the middle of a ball that holds all
        low = high = 0.5 * (low + high)
    return Body(box_around(middle + low * axis, middle + high * axis), radius, points)


def _smallest(body: Body) -> Body:
    """Turn and shift the axis of a capsule until its volume falls no more, from three axes on."""
    turns = (np.roll(body.box.rotation, k, axis=1) for k in range(3))
    return min([body, *(_refined(body, turn) for turn in turns)], key=lambda each: each.volume)


def _refined(body: Body, turn: Array) -> Body:
    """Fit a smaller capsule than a body by turning and shifting an axis, the third column."""
    from scipy.optimize import minimize  # slow to import

    reach = body.radius + float(body.box.half_extents[2])

    def turned(x: Array) -> Body:
        axis = turn @ [x[0], x[1], 1.0]
        middle = body.box.center + reach * (turn[:, :2] @ x[2:])
        return _along(body.corners, axis / np.linalg.norm(axis), middle)

    start = np.vstack([np.zeros(4), _TURNED * np.eye(4)])
    options = {"initial_simplex": start, "maxfev": _TRIALS}
    x0 = np.zeros(4)
    found = minimize(lambda x: turned(x).volume, x0, method="Nelder-Mead", options=options)
    return turned(found.x)
