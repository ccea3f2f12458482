"""Bodies and pairs of a scene, laid out for compiled code, and their distances."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import Triple, compiled
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import LinkCapsule, collision_model, unwatched_links
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.robot.obstacles import HalfSpace, Obstacle
from iiwa_dnn.schemes.distances import (
    difference,
    dot,
    hull_points,
    moved,
    point_of,
    segment_points,
)
from iiwa_dnn.schemes.motion_bounds import bounds_of_motion

_HEAD = 6
"""Constants of a scene before those of joints, shapes and pairs."""

BRAKED = 2
"""Index of `Damper.braked` among the constants of a scene."""

_PER_PAIR = 14
"""Length of `PairConstants`."""


class Pair(NamedTuple):
    """Two bodies that are kept apart: a link or an obstacle, and a link that moves beside it."""

    first: str
    second: str


class Scene(NamedTuple):
    """Bodies and pairs of a robot among obstacles.

    Attributes:
        robot: The robot, n joints.
        pairs: The pairs.
        frames: Links whose placements are needed.
        moving: Obstacles that move, each with the part of `constants` that its points take.
        speeds: Bound on the rate of each pair's distance [m/s], (pairs,).
        constants: Numbers that compiled code sees through `scene_views`, (k,).
    """

    robot: Robot
    pairs: list[Pair]
    frames: tuple[str, ...]
    moving: list[tuple[Obstacle, slice]]
    speeds: Vector
    constants: Vector

    def move(self, constants: Vector, t: float) -> None:
        """Bring the moving obstacles in a copy of `constants`, (k,), to a time [s]."""
        for obstacle, part in self.moving:
            points = self.constants[part].reshape(-1, 3)
            shift_points(points, obstacle.shift(t), constants[part])

    def nearest(self, q: Matrix, t: Vector) -> tuple[Vector, NDArray[np.int64]]:
        """Compute the least distance [m] of all pairs, (k,), and the index of its pair, (k,).

        The joints are at q (k, n) [rad] at times t (k,) [s].
        """
        constants = self.constants.copy()
        kinematics = Kinematics(self.robot, self.frames)
        distances = np.empty(len(q))
        indices = np.empty(len(q), np.int64)
        for k in range(len(q)):
            self.move(constants, float(t[k]))
            kinematics.update(q[k])
            of_pairs = pair_distances(constants, self.robot.dof, kinematics.placements)
            indices[k] = of_pairs.argmin()
            distances[k] = of_pairs[indices[k]]
        return distances, indices


@compiled
def shift_points(points: Matrix, shift: Vector, shifted: Vector) -> None:
    """Write points (k, 3) [m], displaced by a shift (3,) [m], into `shifted` (3 k,)."""
    for k in range(points.shape[0]):
        for i in range(3):
            shifted[3 * k + i] = points[k, i] + shift[i]


class Damper(NamedTuple):
    """Parameters of all rows.

    Attributes:
        least: Least distance [m].
        gain: Largest rate at which a distance shrinks towards it [1/s].
        braked: 1 where braking in time keeps the least distance, not the rows.
    """

    least: float
    gain: float
    braked: float = 0.0


class PairConstants(NamedTuple):
    """Constants of a pair of bodies.

    The second body is a shape, a segment with a radius. The first one is a shape, or the hull of an
    obstacle's points, grown by a radius, or a half-space.

    Attributes:
        speed: Bound on the speed of the second body's points as seen from the first [m/s].
        acceleration: Bound on their acceleration [m/s^2].
        turning: Bound on the second body's turning rate [rad/s].
        turning_change: Bound on the change of that rate [rad/s^2].
        obstacle_speed: Bound on the obstacle's speed [m/s].
        second: Index of the second body's shape.
        second_radius: Radius of the second body [m].
        first: Index of the first body's shape; -1 for an obstacle.
        first_radius: Radius of the first body [m].
        corners: Number of the obstacle's points or of the first shape's different ends; 0 for a
            half-space.
        start: Index of the obstacle's first point.
        normal_x: Direction out of a half-space, its x.
        normal_y: Its y.
        normal_z: Its z.
    """

    speed: float
    acceleration: float
    turning: float
    turning_change: float
    obstacle_speed: float
    second: float
    second_radius: float
    first: float
    first_radius: float
    corners: float
    start: float = 0.0
    normal_x: float = 0.0
    normal_y: float = 0.0
    normal_z: float = 0.0


class _Row(NamedTuple):
    """A pair, its constants, and `MotionBounds.moves` and `radii`."""

    names: Pair
    constants: PairConstants
    moves: Vector
    radii: Vector


class _Shape(NamedTuple):
    """A segment in a frame; in the world if the frame's index is -1."""

    frame: int
    ends: Matrix


class _Link(NamedTuple):
    """A capsule of a link, the joint that moves it, and its ends in the joint's frame [m]."""

    capsule: LinkCapsule
    joint: int
    ends: Matrix


def make_scene(
    robot: Robot, obstacles: Sequence[Obstacle], self_collision: bool, damper: Damper
) -> Scene:
    """Lay the capsules of a robot, obstacles and their pairs out; among them, or not, of links.

    Raises:
        InvalidInputError: There is no URDF file, no velocity limit of a joint, or no pair.
        FileError: The collision geometry of the robot cannot be read.
    """
    _check_velocity_limits(robot)
    links = [_link(robot, capsule) for capsule in collision_model(robot).capsules]
    shapes = [_shape(robot, link) for link in links]
    rows = list(_pairs_of_links(robot, links)) if self_collision else []
    starts = np.cumsum([0, *(len(obstacle.points) for obstacle in obstacles)]).tolist()
    for number, obstacle in enumerate(obstacles):
        name = f"{type(obstacle).__name__} {number + 1}"
        rows += _pairs_of_obstacle(robot, links, shapes, obstacle, starts[number], name)
    if not rows:
        bare = unwatched_links(robot)
        reason = f"; {unwatched(bare)}" if bare else ""
        problem = f"there is no pair that could meet{reason}"
        raise InvalidInputError("obstacles", problem, obstacles)
    constants = _constants(robot, damper, shapes, rows, obstacles)
    begin = constants.size - 3 * starts[-1]
    moving = [
        (obstacle, slice(begin + 3 * start, begin + 3 * start + obstacle.points.size))
        for obstacle, start in zip(obstacles, starts, strict=False)
        if obstacle.moves
    ]
    frames = tuple(dict.fromkeys(link.capsule.link for link in links if link.joint))
    speeds = np.array([row.constants.speed + row.constants.obstacle_speed for row in rows])
    return Scene(robot, [row.names for row in rows], frames, moving, speeds, constants)


def _check_velocity_limits(robot: Robot) -> None:
    for name, fastest in zip(robot.joint_names, robot.dq_max, strict=True):
        if not fastest < np.inf:
            problem = f"must have a velocity limit on {name}, or no distance can be kept"
            raise InvalidInputError("robot", problem, robot)


def _link(robot: Robot, capsule: LinkCapsule) -> _Link:
    frame = robot.model.frames[robot.frame_id(capsule.link)]
    ends = [frame.placement.act(np.array(end)) for end in (capsule.a, capsule.b)]
    return _Link(capsule, int(frame.parentJoint), np.array(ends))


def _shape(robot: Robot, link: _Link) -> _Shape:
    capsule = link.capsule
    if link.joint == 0:
        return _Shape(-1, link.ends)
    return _Shape(robot.frame_id(capsule.link), np.array([capsule.a, capsule.b]))


def _pairs_of_links(robot: Robot, links: list[_Link]) -> Iterator[_Row]:
    """Lay the pairs of links out that may meet."""
    for i, k in collision_model(robot).pairs(robot):
        first = links[i].capsule
        second = links[k].capsule
        bounds = bounds_of_motion(robot, links[i].joint, links[k].joint, links[k].ends)
        corners = 1 if first.a == first.b else 2
        bodies = (k, second.radius, i, first.radius, corners)
        constants = PairConstants(*bounds[:4], 0.0, *bodies)
        yield _Row(Pair(first.link, second.link), constants, bounds.moves, bounds.radii)


def _pairs_of_obstacle(
    robot: Robot,
    links: list[_Link],
    shapes: list[_Shape],
    obstacle: Obstacle,
    start: int,
    name: str,
) -> Iterator[_Row]:
    """Lay the pairs of an obstacle, whose points begin at `start`, and the links that move out.

    Beside a half-space a capsule counts as two balls at its ends, whose rows never jump; they are
    added to the shapes.
    """
    flat = isinstance(obstacle, HalfSpace)
    normal = obstacle.normal if isinstance(obstacle, HalfSpace) else (0.0, 0.0, 0.0)
    corners = 0 if flat else len(obstacle.points)
    for k, link in enumerate(links):
        if link.joint == 0:
            continue
        seconds = [k]
        if flat and link.capsule.a != link.capsule.b:
            seconds = [len(shapes), len(shapes) + 1]
            shapes += [shapes[k]._replace(ends=np.array([end, end])) for end in shapes[k].ends]
        bounds = bounds_of_motion(robot, 0, link.joint, link.ends)
        for second in seconds:
            bodies = (second, link.capsule.radius, -1, obstacle.thickness, corners)
            constants = PairConstants(*bounds[:4], obstacle.speed, *bodies, start, *normal)
            yield _Row(Pair(name, link.capsule.link), constants, bounds.moves, bounds.radii)


class SceneViews(NamedTuple):
    """Constants of a scene of s shapes, k pairs and p points, as views.

    Attributes:
        damper: Parameters of all rows.
        dq_max: Velocity limits of the joints [rad/s], (n,).
        frames: Index of each shape's frame, (s,); -1 for the world.
        ends: Ends of the shapes' segments in their frames [m], (2 s, 3).
        pairs: `PairConstants` of each pair, (k, 14).
        moves: `MotionBounds.moves` of each pair, (k, n).
        radii: `MotionBounds.radii` of each pair, (k, n).
        points: Points of the obstacles [m], (p, 3).
    """

    damper: Damper
    dq_max: Vector
    frames: Vector
    ends: Matrix
    pairs: Matrix
    moves: Matrix
    radii: Matrix
    points: Matrix


def _constants(
    robot: Robot,
    damper: Damper,
    shapes: list[_Shape],
    rows: list[_Row],
    obstacles: Sequence[Obstacle],
) -> Vector:
    """Join the constants of a scene in the order of `scene_views`, (k,)."""
    points = np.vstack([np.empty((0, 3)), *(obstacle.points for obstacle in obstacles)])
    head = [*damper, len(shapes), len(rows), len(points)]
    parts: list[Any] = [
        head,
        robot.dq_max,
        [shape.frame for shape in shapes],
        [shape.ends for shape in shapes],
        [row.constants for row in rows],
        [row.moves for row in rows],
        [row.radii for row in rows],
        points,
    ]
    return np.concatenate([np.ravel(part) for part in parts])


@compiled
def scene_views(constants: Vector, dof: int) -> SceneViews:
    """Make the views of a scene's constants (k,) for a robot of `dof` joints."""
    shapes = int(constants[3])
    pairs = int(constants[4])
    points = int(constants[5])
    at_frames = _HEAD + dof
    at_ends = at_frames + shapes
    at_pairs = at_ends + 6 * shapes
    at_moves = at_pairs + _PER_PAIR * pairs
    at_radii = at_moves + dof * pairs
    at_points = at_radii + dof * pairs
    return SceneViews(
        Damper(constants[0], constants[1], constants[BRAKED]),
        constants[_HEAD:at_frames],
        constants[at_frames:at_ends],
        constants[at_ends:at_pairs].reshape(2 * shapes, 3),
        constants[at_pairs:at_moves].reshape(pairs, _PER_PAIR),
        constants[at_moves:at_radii].reshape(pairs, dof),
        constants[at_radii:at_points].reshape(pairs, dof),
        constants[at_points : at_points + 3 * points].reshape(points, 3),
    )


@compiled
def pair_of(pairs: Matrix, k: int) -> PairConstants:
    """Return a row of `SceneViews.pairs`, (k, 14), by its names."""
    return PairConstants(
        pairs[k, 0],
        pairs[k, 1],
        pairs[k, 2],
        pairs[k, 3],
        pairs[k, 4],
        pairs[k, 5],
        pairs[k, 6],
        pairs[k, 7],
        pairs[k, 8],
        pairs[k, 9],
        pairs[k, 10],
        pairs[k, 11],
        pairs[k, 12],
        pairs[k, 13],
    )


class Contact(NamedTuple):
    """Nearest points of a pair's cores.

    Attributes:
        second: Point of the second body [m], (3,).
        first: Point of the first body [m], (3,).
        normal: Unit normal from the first to the second, (3,).
        core: Distance of the cores [m].
        distance: Distance of the bodies [m].
    """

    second: Triple
    first: Triple
    normal: Triple
    core: float
    distance: float


@compiled
def place_ends(scene: SceneViews, placements: Matrix, ends: Matrix) -> None:
    """Write the ends of all shapes in the world [m], (2 s, 3), for placements (frames, 12)."""
    for k in range(scene.ends.shape[0]):
        frame = int(scene.frames[k // 2])
        for i in range(3):
            value = scene.ends[k, i]
            if frame >= 0:
                value = placements[frame, 9 + i]
                for j in range(3):
                    value += placements[frame, 3 * j + i] * scene.ends[k, j]
            ends[k, i] = value


@compiled
def contact_of(pair: PairConstants, ends: Matrix, points: Matrix) -> Contact:
    """Compute the contact of a pair.

    Args:
        pair: The pair.
        ends: Ends of all shapes in the world [m], (2 s, 3).
        points: Points of the obstacles [m], (p, 3).
    """
    at_second = 2 * int(pair.second)
    at_first = 2 * int(pair.first)
    start = int(pair.start)
    corners = int(pair.corners)
    a = point_of(ends, at_second)
    b = point_of(ends, at_second + 1)
    if corners == 0:  # a ball and a half-space
        normal = (pair.normal_x, pair.normal_y, pair.normal_z)
        core = dot(normal, difference(a, point_of(points, start)))
        distance = core - pair.first_radius - pair.second_radius
        return Contact(a, moved(a, -core, normal), normal, core, distance)
    if at_first >= 0:
        x, y = segment_points(a, b, point_of(ends, at_first), point_of(ends, at_first + 1))
    elif corners <= 2:
        last = start + corners - 1
        x, y = segment_points(a, b, point_of(points, start), point_of(points, last))
    else:
        x, y = hull_points(a, b, points[start : start + corners])
    side = difference(x, y)
    core = math.sqrt(dot(side, side))
    normal = (0.0, 0.0, 1.0)  # where the cores meet, upwards is as good as any
    if core > 1e-9:
        normal = (side[0] / core, side[1] / core, side[2] / core)
    return Contact(x, y, normal, core, core - pair.first_radius - pair.second_radius)


@compiled
def pair_distances(constants: Vector, dof: int, placements: Matrix) -> Vector:
    """Compute the distance of each pair [m], (pairs,).

    Args:
        constants: `Scene.constants`, (k,).
        dof: Number of the robot's joints.
        placements: `Kinematics.placements`, (frames, 12).
    """
    scene = scene_views(constants, dof)
    ends = np.empty(scene.ends.shape)
    place_ends(scene, placements, ends)
    distances = np.empty(len(scene.pairs))
    for k in range(distances.size):
        distances[k] = contact_of(pair_of(scene.pairs, k), ends, scene.points).distance
    return distances
