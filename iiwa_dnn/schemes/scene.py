"""Bodies and pairs of a scene, laid out for compiled code, and their distances."""

import itertools
import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import Triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import LinkCapsule, collision_model, unwatched_links
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.robot.obstacles import Obstacle, PlacedBox, box_around
from iiwa_dnn.schemes.distances import beyond, depth, difference, dot, moved, nearest_parameter
from iiwa_dnn.schemes.motion_bounds import MotionBounds, bounds_of_motion
from iiwa_dnn.schemes.step import axis_at, seen_from, vector_at

_HEAD = 4
"""Constants of a scene before those of joints, bodies and pairs."""

_PER_PAIR = 4
"""Length of `PairConstants`."""

_PER_BODY = 16
_CENTER = 13
"""Numbers of a body, and the first of its centre's among them."""

_MET = 1e-9
"""Distance of two cores below which they count as one [m]."""


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
        moving: Obstacles that move, each with the part of `constants` that its centre takes.
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
            constants[part] = self.constants[part] + obstacle.shift(t)

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


class Damper(NamedTuple):
    """Parameters of all rows.

    Attributes:
        least: Least distance [m].
        gain: Largest rate at which a distance shrinks towards it [1/s].
    """

    least: float
    gain: float


class PairConstants(NamedTuple):
    """Constants of a pair of bodies.

    Attributes:
        obstacle_speed: Bound on the obstacle's speed [m/s].
        second: Index of the second body, a segment with a radius.
        first: Index of the first body, any box with a radius.
        radii: Sum of both radii [m].
    """

    obstacle_speed: float
    second: float
    first: float
    radii: float


class _Body(NamedTuple):
    """A box with a radius in a frame of the robot, or in the world; a joint or a speed moves it."""

    name: str
    frame: int
    box: PlacedBox
    radius: float
    joint: int = 0
    speed: float = 0.0


def make_scene(
    robot: Robot, obstacles: Sequence[Obstacle], self_collision: bool, damper: Damper
) -> Scene:
    """Lay the capsules of a robot, obstacles and their pairs out; among them, or not, of links.

    Raises:
        InvalidInputError: There is no URDF file, no velocity limit of a joint, or no pair.
        FileError: The collision geometry of the robot cannot be read.
    """
    _check_velocity_limits(robot)
    model = collision_model(robot)
    bodies = [_link(robot, capsule) for capsule in model.capsules]
    links = len(bodies)
    for number, obstacle in enumerate(obstacles, 1):
        name = f"{type(obstacle).__name__} {number}"
        body = _Body(name, -1, obstacle.box, obstacle.thickness, speed=obstacle.speed)
        bodies.append(body)
    pairs = list(model.pairs(robot)) if self_collision else []
    carried = [k for k in range(links) if bodies[k].joint]
    pairs += itertools.product(range(links, len(bodies)), carried)
    if not pairs:
        bare = unwatched_links(robot)
        reason = f"; {unwatched(bare)}" if bare else ""
        problem = f"there is no pair that could meet{reason}"
        raise InvalidInputError("obstacles", problem, obstacles)
    first = _HEAD + robot.dof + links * _PER_BODY + _CENTER
    moving = [
        (obstacle, slice(first + i * _PER_BODY, first + i * _PER_BODY + 3))
        for i, obstacle in enumerate(obstacles)
        if obstacle.moves
    ]
    frames = tuple(dict.fromkeys(body.name for body in bodies if body.joint))
    names = [Pair(bodies[i].name, bodies[k].name) for i, k in pairs]
    return Scene(robot, names, frames, moving, *_lay_out(robot, damper, bodies, pairs))


def _lay_out(
    robot: Robot, damper: Damper, bodies: list[_Body], pairs: list[tuple[int, int]]
) -> tuple[Vector, Vector]:
    """Return `Scene.speeds` and `Scene.constants` of pairs of bodies, by their indices."""
    motions = [_motion(robot, bodies[i], bodies[k]) for i, k in pairs]
    moves = np.array([motion.moves for motion in motions])
    radii = np.array([motion.radii for motion in motions])
    rows = [
        PairConstants(bodies[i].speed, k, i, bodies[i].radius + bodies[k].radius) for i, k in pairs
    ]
    speeds = np.abs(radii) @ robot.dq_max + [row.obstacle_speed for row in rows]
    head = [*damper, len(bodies), len(pairs)]
    parts: list[Any] = [head, robot.dq_max, *map(_numbers, bodies), rows, moves, radii]
    return speeds, np.concatenate([np.ravel(part) for part in parts])


def _check_velocity_limits(robot: Robot) -> None:
    for name, fastest in zip(robot.joint_names, robot.dq_max, strict=True):
        if not fastest < np.inf:
            problem = f"must have a velocity limit on {name}, or no distance can be kept"
            raise InvalidInputError("robot", problem, robot)


def _link(robot: Robot, capsule: LinkCapsule) -> _Body:
    """Return a link's capsule in its frame, or in the world if no joint moves it."""
    index = robot.frame_id(capsule.link)
    frame = robot.model.frames[index]
    joint = int(frame.parentJoint)
    ends = (capsule.a, capsule.b)
    if joint == 0:
        ends = tuple(frame.placement.act(np.array(end)) for end in ends)
        index = -1
    return _Body(capsule.link, index, box_around(*ends), capsule.radius, joint)


def _motion(robot: Robot, first: _Body, second: _Body) -> MotionBounds:
    """Return the joints that move the second body's segment as seen from the first body."""
    center, rotation, half = second.box
    ends = center + np.outer([-half[2], half[2]], rotation[:, 2])
    if second.joint:  # bounds are told the points in the joint's frame
        placement = robot.model.frames[second.frame].placement
        ends = np.array([placement.act(end) for end in ends])
    return bounds_of_motion(robot, first.joint, second.joint, ends)


class SceneViews(NamedTuple):
    """Constants of a scene of b bodies and k pairs, as views.

    Attributes:
        damper: Parameters of all rows.
        dq_max: Velocity limits of the joints [rad/s], (n,).
        bodies: Of each body the index of its frame or -1, half-extents [m], and placement in the
            frame as of `Kinematics.placements`, (b, 16).
        pairs: `PairConstants` of each pair, (k, 4).
        moves: `MotionBounds.moves` of each pair, (k, n).
        radii: `MotionBounds.radii` of each pair, (k, n).
    """

    damper: Damper
    dq_max: Vector
    bodies: Matrix
    pairs: Matrix
    moves: Matrix
    radii: Matrix


def _numbers(body: _Body) -> Vector:
    """Return a row of `SceneViews.bodies`, (16,)."""
    center, rotation, half = body.box
    return np.array([body.frame, *half, *rotation.T.ravel(), *center])


@compiled
def scene_views(constants: Vector, dof: int) -> SceneViews:
    """Make the views of a scene's constants (k,) for a robot of `dof` joints."""
    bodies = int(constants[2])
    pairs = int(constants[3])
    at_bodies = _HEAD + dof
    at_pairs = at_bodies + _PER_BODY * bodies
    at_moves = at_pairs + _PER_PAIR * pairs
    at_radii = at_moves + dof * pairs
    return SceneViews(
        Damper(constants[0], constants[1]),
        constants[_HEAD:at_bodies],
        constants[at_bodies:at_pairs].reshape(bodies, _PER_BODY),
        constants[at_pairs:at_moves].reshape(pairs, _PER_PAIR),
        constants[at_moves:at_radii].reshape(pairs, dof),
        constants[at_radii : at_radii + dof * pairs].reshape(pairs, dof),
    )


@compiled
def pair_of(pairs: Matrix, k: int) -> PairConstants:
    """Return a row of `SceneViews.pairs`, (k, 4), by its names."""
    return PairConstants(pairs[k, 0], pairs[k, 1], pairs[k, 2], pairs[k, 3])


class Contact(NamedTuple):
    """Nearest points of a pair's cores.

    Attributes:
        second: Point of the second body [m], (3,).
        first: Point of the first body [m], (3,).
        normal: Unit normal from the first to the second, (3,).
        core: Distance of the cores [m], negative where they meet.
        distance: Distance of the bodies [m].
    """

    second: Triple
    first: Triple
    normal: Triple
    core: float
    distance: float


@compiled
def place_bodies(scene: SceneViews, placements: Matrix, placed: Matrix) -> None:
    """Write the placements of all bodies in the world, (b, 12), for those of frames (k, 12)."""
    for k in range(len(scene.bodies)):
        frame = int(scene.bodies[k, 0])
        for i in range(12):
            value = scene.bodies[k, 4 + i]
            if frame >= 0:
                value = placements[frame, 9 + i % 3] if i >= 9 else 0.0
                for j in range(3):
                    value += placements[frame, 3 * j + i % 3] * scene.bodies[k, 4 + i - i % 3 + j]
            placed[k, i] = value


@compiled
def ends_of(scene: SceneViews, placed: Matrix, body: int) -> tuple[Triple, Triple]:
    """Return the ends of a segment among the bodies in the world [m], (3,) each."""
    center = vector_at(placed[body], 9)
    axis = vector_at(placed[body], 6)
    half = scene.bodies[body, 3]
    return moved(center, -half, axis), moved(center, half, axis)


@compiled
def contact_of(scene: SceneViews, pair: PairConstants, placed: Matrix) -> Contact:
    """Compute the contact of a pair, for the placements of all bodies (b, 12)."""
    a, b = ends_of(scene, placed, int(pair.second))
    way = difference(b, a)
    base = placed[int(pair.first)]
    half = vector_at(scene.bodies[int(pair.first)], 1)
    start = seen_from(base, difference(a, vector_at(base, 9)))
    along = seen_from(base, way)
    s = nearest_parameter(start, along, half)
    side = beyond(moved(start, s, along), half)
    core = math.sqrt(dot(side, side))
    normal = (side[0] / core, side[1] / core, side[2] / core)
    if core <= _MET:
        core, normal = depth(moved(start, s, along), half)
        for end in (0.0, 1.0):
            deeper, other = depth(moved(start, end, along), half)
            if deeper < core:
                s = end
                core = deeper
                normal = other
    outward = axis_at(base, normal)
    point = moved(a, s, way)
    return Contact(point, moved(point, -core, outward), outward, core, core - pair.radii)


@compiled
def pair_distances(constants: Vector, dof: int, placements: Matrix) -> Vector:
    """Compute the distance of each pair [m], (pairs,).

    Args:
        constants: `Scene.constants`, (k,).
        dof: Number of the robot's joints.
        placements: `Kinematics.placements`, (frames, 12).
    """
    scene = scene_views(constants, dof)
    placed = np.empty((len(scene.bodies), 12))
    place_bodies(scene, placements, placed)
    distances = np.empty(len(scene.pairs))
    for k in range(distances.size):
        distances[k] = contact_of(scene, pair_of(scene.pairs, k), placed).distance
    return distances
