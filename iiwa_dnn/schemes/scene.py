r"""Scene of a robot among obstacles: bodies, pairs of bodies that may meet, and their distances.

A body is a box that is grown by a radius; a box may be flat, a segment or a point. In each pair the
second body is a segment, a + s u with s in [0, 1], and the distance is computed in the coordinates
of the first one, a box with half-extents h about the origin. Points are tuples (x, y, z) [m]. The
distance of a close pair, whose bodies overlap before its links meet, has an allowance on top.

Let the joints :math:`1 \dots n` between two bodies move by :math:`\delta_k`, and a point of the
second body be at most :math:`r_k` away from the axis of joint k. The displacement of the point is
at most V, and twice its difference from the linear one, by the Jacobian, is at most B:

.. math::

    V = \sum_k \delta_k r_k, \qquad
    B = \sum_k r_k \delta_k \Bigl(\delta_k + 2 \sum_{j<k} \delta_j\Bigr)

(docs/theory_braking.md). A prismatic joint has :math:`r_k = 1`, and neither turns other joints nor
has the term :math:`\delta_k^2`. With velocities in place of displacements V and B bound the point's
velocity and acceleration.
"""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.naming import unguarded, unwatched
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import combined, dot, triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import collision_model, unwatched_links
from iiwa_dnn.robot.kinematics import Kinematics, Placement
from iiwa_dnn.robot.meetings import TOUCH, Watched
from iiwa_dnn.robot.obstacles import HalfSpace, Obstacle, PlacedBox, names_of
from iiwa_dnn.schemes.step import axis_at, rate_along, seen_from

ROUNDS = 60
"""Largest number of steps of the search along a segment; about six are needed."""

POSTURES = 64
UNMOVED = 1e-9
"""A joint does not move an end of a pair if its rate is at most `UNMOVED` [m/rad] in `POSTURES`
random postures."""

_MET = 1e-9
"""Distance of two boxes, without their radii, below which they touch [m]."""


class SceneHead(Record):
    """First constants of a scene: its settings, and the sizes of the tables that follow.

    Attributes:
        least: Least distance [m].
        gain: Largest rate at which a distance shrinks towards it [1/s].
        bodies: Number of bodies.
        pairs: Number of pairs.
        pair_size: Length of a `Pair`.
        first: Index of the first pair of this scene among those of all scenes of a scheme.
        row: Index of the first row of this scene among the inequality rows of a scheme.
    """

    least: float
    gain: float
    bodies: int
    pairs: int
    pair_size: int
    first: int
    row: int


class Body(Record):
    """A box with a radius, in a frame of the robot.

    Attributes:
        frame: Index of the frame; 0 is the world.
        radius: Radius by which the box is grown [m].
        speed: Speed [m/s].
        half: Half-extents [m]; a segment lies along the third axis.
        axes: The box's axes in the frame, one a row.
        center: Its centre in the frame [m].
    """

    frame: int
    radius: float
    speed: float
    half: Vector = part(3)
    axes: Matrix = part(3, 3)
    center: Vector = part(3)


class Pair(Record):
    """Two bodies that may meet, of a robot with n joints.

    Attributes:
        second: Index of the second body, a segment.
        first: Index of the first body, any box.
        unmoved_end: 1 or 2 for the end of the segment that no joint moves along the normal, else 0.
        allowance: What is added to the distance of the bodies [m].
        support: For each joint 1 if it moves the second body alone, -1 if it moves the first alone,
            else 0, (n,).
        radii: For each joint the largest distance of the second body from its axis [m], -1 for a
            prismatic joint, 0 for one that moves neither alone, (n,).
    """

    second: int
    first: int
    unmoved_end: int
    allowance: float
    support: Vector = part()
    radii: Vector = part()


class SceneViews(NamedTuple):
    """Constants of a scene of b bodies and k pairs, as views.

    Attributes:
        head: Settings of the scene.
        bodies: A `Body` in each row, (b, 17).
        pairs: A `Pair` in each row, (k, 4 + 2 n).
    """

    head: SceneHead
    bodies: Matrix
    pairs: Matrix


class Contact(NamedTuple):
    """Nearest points of a pair.

    Attributes:
        second: Nearest point on the segment of the second body, without its radius [m], (3,).
        normal: Unit normal from the first to the second body, (3,); zero where the first one is a
            segment or a point and touches the segment.
        distance: Distance of the bodies with their radii and the pair's allowance [m], negative
            where they overlap by more than that.
    """

    second: Vector3
    normal: Vector3
    distance: float


class Scene(NamedTuple):
    """Bodies and pairs of a robot among obstacles.

    Attributes:
        robot: The robot, n joints.
        pairs: Names of the two bodies of each watched pair; the second is a link.
        frames: Names of the links whose placements the kernels read.
        moving: Obstacles that move, each with the index of its body.
        constants: Numbers that compiled code reads through `scene_views`, (k,).
        left_out: Names of the two bodies of each pair that is not watched, and the reason.
    """

    robot: Robot
    pairs: list[tuple[str, str]]
    frames: tuple[str, ...]
    moving: list[tuple[Obstacle, int]]
    constants: Vector
    left_out: tuple[tuple[str, str, str], ...]

    def move(self, constants: Vector, t: float) -> None:
        """Write the centres of moving obstacles at time t [s] to a copy of the constants, (k,)."""
        begun = scene_views(self.constants).bodies
        moved = scene_views(constants).bodies
        for obstacle, k in self.moving:
            Body.of(moved[k]).center = Body.of(begun[k]).center + obstacle.shift(t)

    def distances(self, q: Matrix, t: Vector) -> Matrix:
        """Compute the distances of all pairs at each of k postures and times.

        Args:
            q: Joint positions [rad], (k, n).
            t: Times [s], (k,).

        Returns:
            The distances [m], (k, pairs).
        """
        constants = self.constants.copy()
        kinematics = Kinematics(self.robot, self.frames)
        found = np.empty((len(q), len(self.pairs)))
        for row, posture, time in zip(found, q, t, strict=True):
            self.move(constants, float(time))
            kinematics.update(posture)
            write_distances(constants, kinematics.placements, row)
        return found

    def nearest(self, q: Matrix, t: Vector) -> tuple[Vector, NDArray[np.int64]]:
        """Compute the least distance over all pairs at each of k postures and times.

        Args:
            q: Joint positions [rad], (k, n).
            t: Times [s], (k,).

        Returns:
            The distances [m], (k,), and the index of the pair of each, (k,).
        """
        found = self.distances(q, t)
        return found.min(axis=1), found.argmin(axis=1)


def make_scene(
    robot: Robot,
    obstacles: Sequence[Obstacle],
    self_collision: bool,
    distances: tuple[float, float],
    may_touch: Sequence[tuple[str, str]] = (),
) -> Scene:
    """Lay out the bodies of a robot's links, the obstacles, and the pairs that are watched.

    A close pair keeps the least distance too, or what it has where its links are `TOUCH` apart.

    Args:
        robot: The robot.
        obstacles: The obstacles.
        self_collision: Whether pairs of links are watched.
        distances: Least distance [m], and the largest rate at which a distance shrinks to it [1/s].
        may_touch: Names of the two bodies of each pair that is not watched. Pairs that no joint
            moves are left out too.

    Raises:
        NotFoundError: `may_touch` has a name that is no body's.
        InvalidInputError: The robot has no URDF file, a joint has no velocity limit, an obstacle
            goes by another body's name, or no pair is left to be watched.
        FileError: The collision geometry of the robot cannot be read.
    """
    if not (robot.dq_max < np.inf).all():
        name = robot.joint_names[int(np.argmax(robot.dq_max))]
        problem = f"must have a velocity limit on {name}, or no distance can be kept"
        raise InvalidInputError("robot", problem, robot)
    model = collision_model(robot)
    links = [each.link for each in model.bodies]
    names = links + names_beside(links, obstacles)
    bodies = _bodies(robot, obstacles)
    numbered = model.pairs(robot) if self_collision else []
    numbered += _obstacle_pairs(robot, bodies, len(links))
    rows = [make_pair(robot, bodies, each, distances[0]) for each in numbered]
    pairs = np.reshape(rows, (-1, Pair.width(robot.dof)))
    frames = tuple(dict.fromkeys(links))
    placed = [k for k, each in enumerate(obstacles, len(links)) if not isinstance(each, HalfSpace)]
    moved = _moved_ends(robot, frames, _constants(distances, bodies, pairs), placed)
    unmoved = np.where(moved.all(axis=1), 0, 1 + moved[:, 0])
    for row, end in zip(pairs, unmoved, strict=True):
        Pair.of(row).unmoved_end = end
    named = [(names[i], names[k]) for i, k, _ in numbered]
    watched = moved.any(axis=1) & ~_are_given(named, may_touch, names)
    if not watched.any():
        raise InvalidInputError("obstacles", _why_none(robot), obstacles)
    reasons = np.where(moved.any(axis=1), "may touch", "no joint moves it").tolist()
    left = tuple((*named[at], reasons[at]) for at in np.flatnonzero(~watched))
    constants = _constants(distances, bodies, pairs[watched])
    moving = [(each, k) for k, each in enumerate(obstacles, len(links)) if each.speed]
    return Scene(robot, [*itertools.compress(named, watched)], frames, moving, constants, left)


def _why_none(robot: Robot) -> str:
    """Tell why no pair is watched, and which links that leaves."""
    left_out = collision_model(robot).unguarded
    bare = unwatched_links(robot)
    told = ["leave them out, there is no pair that could meet"]
    if left_out:
        told = [f"no pair is watched; {unguarded(map(' and '.join, left_out))}"]
    return "; ".join([*told, unwatched(bare)] if bare else told)


def names_beside(links: Sequence[str], obstacles: Sequence[Obstacle]) -> list[str]:
    """Return the name of each obstacle; refuse that of a link, or one that two have."""
    names = names_of(obstacles)
    for name in {*links} & {*names}:
        raise InvalidInputError("obstacles", f"one goes by the link's name {name!r}", obstacles)
    return names


def _are_given(
    pairs: list[tuple[str, str]], given: Sequence[tuple[str, str]], names: list[str]
) -> NDArray[np.bool_]:
    """Test which pairs of names are among those given, (pairs,); refuse a name of no body."""
    for name in itertools.chain(*given):
        if name not in names:
            raise NotFoundError("link or obstacle", name, names)
    return np.array([pair in given or pair[::-1] in given for pair in pairs], dtype=bool)


def _bodies(robot: Robot, obstacles: Sequence[Obstacle]) -> list[Body]:
    """Return the bodies of a robot's links, then those of the obstacles."""
    bodies = [
        _body(robot.frame_id(link), shape.box, shape.thickness, 0.0)
        for link, shape in collision_model(robot).bodies
    ]
    return bodies + [_body(0, each.box, each.thickness, each.speed) for each in obstacles]


def _obstacle_pairs(robot: Robot, bodies: list[Body], links: int) -> list[Watched]:
    """Pair each obstacle with each capsule that a joint moves.

    Args:
        robot: The robot.
        bodies: All bodies, the obstacles last.
        links: Number of those before.
    """
    capsules = [k for k in range(links) if bodies[k].radius]
    carried = [k for k in capsules if robot.support[bodies[k].frame].any()]
    return [Watched(*each) for each in itertools.product(range(links, len(bodies)), carried)]


def _allowance(overlap: float, distance: float) -> float:
    """Return what is added to the distance of a pair of links [m].

    Args:
        overlap: Overlap of its bodies where the links of a close pair touch [m]; 0 of another one.
        distance: Least distance that is to be kept [m].
    """
    return overlap + max(0.0, distance - TOUCH) if overlap else 0.0


def _body(frame: int, box: PlacedBox, radius: float, speed: float) -> Body:
    """Return the `Body` of a box in a frame, grown by a radius [m], with a speed [m/s]."""
    return Body.make(
        frame=frame,
        radius=radius,
        speed=speed,
        half=box.half_extents,
        axes=box.rotation.T,
        center=box.center,
    )


def _moved_ends(
    robot: Robot, frames: Sequence[str], constants: Vector, placed: list[int]
) -> NDArray[np.bool_]:
    """Test which ends of each pair's segment some joint moves along the normal, (pairs, 2).

    An obstacle may be placed anew at any step, so an end counts as moved if it is with the obstacle
    anywhere. Both ends do if it moves by itself, and some joint moves the second body.

    Args:
        robot: The robot, n joints.
        frames: Links whose placements are needed.
        constants: Constants of a scene of all pairs, (k,).
        placed: Numbers of the obstacles but half-spaces, whose normal is the same anywhere.
    """
    scene = scene_views(constants)
    pairs = Pair.of(scene.pairs)
    kinematics = Kinematics(robot, frames)
    rates = np.zeros((len(pairs), 2))
    random = np.random.default_rng(0)
    elsewhere = constants.copy()
    bodies = scene_views(elsewhere).bodies
    for q in robot.draw(random, POSTURES):
        kinematics.update(q)
        for k in placed:
            Body.of(bodies[k]).center[:] = robot.reach * random.uniform(-1.0, 1.0, 3)
        for own in (constants, elsewhere):
            raise_end_rates(own, kinematics.jacobian, kinematics.placements, rates)
    alone = Body.of(scene.bodies[pairs.first]).speed > 0.0
    supported = np.any(pairs.support, axis=1)
    return np.array(((rates.T > UNMOVED) | alone) & supported).T


def _constants(distances: tuple[float, float], bodies: list[Body], pairs: Matrix) -> Vector:
    """Return the constants of a scene, (k,).

    Args:
        distances: As in `make_scene`.
        bodies: All bodies.
        pairs: A `Pair` in each row, (pairs, 4 + 2 n).
    """
    least, gain = distances
    count, size = pairs.shape
    head = SceneHead.make(
        least=least, gain=gain, bodies=len(bodies), pairs=count, pair_size=size, first=0, row=0
    )
    return np.concatenate([head, *bodies, pairs.ravel()])


def make_pair(robot: Robot, bodies: list[Body], watched: Watched, distance: float) -> Pair:
    """Make a pair of bodies, the second a segment: which joints move one relative to the other.

    Its `unmoved_end` is 0; `distance` is the least one that is to be kept [m].
    """
    i, k, overlap = watched
    model = robot.model
    second = bodies[k]
    placement = model.frames[second.frame].placement
    support = robot.support[second.frame] - robot.support[bodies[i].frame]
    radii = np.zeros(robot.dof)
    # From the second body to the base, and up to the first: nothing is farther than `reach` from
    # the joint in turn, and `offsets` lead from the joint before it.
    half = second.half[2] * second.axes[2]
    offsets = np.array([placement.act(second.center + end) for end in (-half, half)])
    reach = float(np.linalg.norm(offsets, axis=1).max())
    for j in np.flatnonzero(support > 0.0)[::-1].tolist():
        # The axis may be met anywhere along itself: only what is across it counts.
        axis = np.reshape(model.joints[j + 1].createData().S, (2, 3)).sum(axis=0)
        across = np.linalg.norm(np.cross(axis, offsets), axis=1).max()
        radii[j] = reach - np.linalg.norm(offsets, axis=1).max() + across
        offsets = model.jointPlacements[j + 1].translation[np.newaxis]
        reach += robot.lengths[j]
    for j in np.flatnonzero(support < 0.0):
        reach += robot.lengths[j]  # on the way up a joint's own offset lies ahead of it
        radii[j] = reach
    slides = list(robot.slides)
    radii[slides] = np.where(support[slides], -1.0, 0.0)
    allowance = _allowance(overlap, distance)
    return Pair.make(
        second=k, first=i, unmoved_end=0, allowance=allowance, support=support, radii=radii
    )


@compiled
def scene_views(constants: Vector) -> SceneViews:
    """Return views of a scene's constants (k,)."""
    at_bodies = SceneHead.width()
    head = SceneHead.of(constants[:at_bodies])
    at_pairs = at_bodies + Body.width() * head.bodies
    return SceneViews(
        head,
        constants[at_bodies:at_pairs].reshape(head.bodies, Body.width()),
        constants[at_pairs:].reshape(head.pairs, head.pair_size),
    )


@compiled
def place_bodies(scene: SceneViews, placements: Matrix, placed: Matrix) -> None:
    """Write the placements of all bodies in the world.

    Args:
        scene: The scene, b bodies.
        placements: `Kinematics.placements`, (frames, 12).
        placed: A `Placement` in each row, (b, 12), overwritten.
    """
    for k in range(len(scene.bodies)):
        body = Body.of(scene.bodies[k])
        frame = Placement.of(placements[body.frame])
        here = Placement.of(placed[k])
        for i in range(3):
            here.position[i] = frame.position[i]
            for j in range(3):
                here.position[i] += frame.axes[j, i] * body.center[j]
                here.axes[j, i] = 0.0
                for axis in range(3):
                    here.axes[j, i] += frame.axes[axis, i] * body.axes[j, axis]


@compiled
def ends_of(scene: SceneViews, placed: Matrix, body: int) -> tuple[Vector3, Vector3]:
    """Compute the two ends of a body's segment in the world [m].

    Args:
        scene: The scene, b bodies.
        placed: Placements of the bodies, (b, 12).
        body: Index of the body.
    """
    place = Placement.of(placed[body])
    center = triple(place.position)
    axis = triple(place.axes[2])
    half = Body.of(scene.bodies[body]).half[2]
    return combined(1.0, center, -half, axis), combined(1.0, center, half, axis)


@compiled
def contact_of(scene: SceneViews, k: int, placed: Matrix) -> Contact:
    """Compute the nearest points and the distance of pair k.

    Args:
        scene: The scene, b bodies.
        k: Index of the pair.
        placed: Placements of the bodies, (b, 12).
    """
    pair = Pair.of(scene.pairs[k])
    first = Body.of(scene.bodies[pair.first])
    base = Placement.of(placed[pair.first])
    a, b = ends_of(scene, placed, pair.second)
    contact = box_contact(base, triple(first.half), a, b)
    radius = first.radius + Body.of(scene.bodies[pair.second]).radius
    distance = contact.distance - radius + pair.allowance
    return Contact(contact.second, contact.normal, distance)


@compiled
def box_contact(base: Placement, half: Vector3, a: Vector3, b: Vector3) -> Contact:
    """Compute the nearest points and the distance of a box and a segment, both without a radius.

    Args:
        base: Placement of the box.
        half: Its half-extents [m], (3,).
        a: One end of the segment [m], (3,).
        b: The other end [m], (3,).
    """
    path = combined(1.0, b, -1.0, a)
    start = seen_from(base, combined(1.0, a, -1.0, triple(base.position)))
    along = seen_from(base, path)
    s = nearest_parameter(start, along, half)
    nearest = combined(1.0, start, s, along)
    side = beyond(nearest, half)
    core = math.sqrt(dot(side, side))
    if core > _MET:
        normal = (side[0] / core, side[1] / core, side[2] / core)
    else:
        core, x, y, z = depth(nearest, half)
        flat = 0.0 if half[0] == 0.0 else 1.0
        normal = (flat * x, flat * y, flat * z)
    return Contact(combined(1.0, a, s, path), axis_at(base, normal), core)


@compiled
def height_of(end: Vector3, contact: Contact) -> float:
    """Compute how much farther away than the nearest point an end of the segment is [m].

    It is measured along the normal, and at least 0 whatever rounding does.
    """
    return max(0.0, dot(combined(1.0, end, -1.0, contact.second), contact.normal))


@compiled
def write_distances(constants: Vector, placements: Matrix, distances: Vector) -> None:
    """Write the distance of each pair [m].

    Args:
        constants: Constants of the scene, (k,).
        placements: `Kinematics.placements`, (frames, 12).
        distances: The distances, (pairs,), overwritten.
    """
    scene = scene_views(constants)
    placed = np.empty((len(scene.bodies), Placement.width()))
    place_bodies(scene, placements, placed)
    for k in range(distances.size):
        distances[k] = contact_of(scene, k, placed).distance


@compiled
def raise_end_rates(constants: Vector, jacobian: Matrix, placements: Matrix, rates: Matrix) -> None:
    """Update the largest rates at which a joint moves the ends of each pair along its normal.

    Args:
        constants: Constants of the scene, (k,).
        jacobian: `Kinematics.jacobian`, (n, 6).
        placements: `Kinematics.placements`, (frames, 12).
        rates: Largest rates [m/rad], (pairs, 2), raised to those of this posture.
    """
    dof = len(jacobian)
    scene = scene_views(constants)
    placed = np.empty((len(scene.bodies), Placement.width()))
    place_bodies(scene, placements, placed)
    for k in range(len(scene.pairs)):
        pair = Pair.of(scene.pairs[k])
        normal = contact_of(scene, k, placed).normal
        ends = ends_of(scene, placed, pair.second)
        for at in range(2):
            for j in range(dof):
                rate = abs(pair.support[j] * rate_along(jacobian, j, ends[at], normal))
                rates[k, at] = max(rates[k, at], rate)


@compiled
def second_order(pair: Pair, travel: Vector) -> float:
    """Compute B of a pair [m], a bound on the curvature of its motion.

    Args:
        pair: The pair.
        travel: Displacement of each joint, at least 0 [rad], (n,).
    """
    n = travel.size
    B = 0.0
    turning = 0.0
    for step in range(2 * n):  # from the first body up to the common base, then down
        j = n - 1 - step if step < n else step - n
        if pair.support[j] == 0.0 or (pair.support[j] < 0.0) != (step < n):
            continue
        if pair.radii[j] < 0.0:
            B += 2.0 * travel[j] * turning
        else:
            B += travel[j] * pair.radii[j] * (2.0 * turning + travel[j])
            turning += travel[j]
    return B


@compiled
def beyond(x: Vector3, half: Vector3) -> Vector3:
    """Return the vector to a point x (3,) from the nearest point of a box of half-extents (3,)."""
    return (
        x[0] - min(max(x[0], -half[0]), half[0]),
        x[1] - min(max(x[1], -half[1]), half[1]),
        x[2] - min(max(x[2], -half[2]), half[2]),
    )


@compiled
def nearest_parameter(a: Vector3, u: Vector3, half: Vector3) -> float:
    """Compute the s in [0, 1] of the point a + s u of a segment that is nearest to a box.

    Half the derivative of the squared distance grows with s. Its root is found by regula falsi with
    a bisection at each third step.

    Args:
        a: One end in the coordinates of the box [m], (3,).
        u: Vector to the other end [m], (3,).
        half: Half-extents of the box [m], (3,).
    """
    low = 0.0
    high = 1.0
    below = dot(u, beyond(a, half))
    above = dot(u, beyond(combined(1.0, a, 1.0, u), half))
    if below >= 0.0:
        return low
    if above <= 0.0:
        return high
    for k in range(ROUNDS):
        fraction = 0.5 if k % 3 == 2 else below / (below - above)
        middle = low + fraction * (high - low)
        slope = dot(u, beyond(combined(1.0, a, middle, u), half))
        if slope == 0.0 or not low < middle < high:
            return middle
        if slope < 0.0:
            low = middle
            below = slope
        else:
            high = middle
            above = slope
    return 0.5 * (low + high)


@compiled
def depth(x: Vector3, half: Vector3) -> tuple[float, float, float, float]:
    """Compute the signed distance of a point x (3,) to the nearest face of a box, negative inside.

    Returns:
        The distance along the outer normal of the face [m], and the normal's components.
    """
    found = -1e300
    axis = 2
    sign = 1.0
    for i in range(3):
        if abs(x[i]) - half[i] > found:
            found = abs(x[i]) - half[i]
            sign = 1.0 if x[i] >= 0.0 else -1.0
            axis = i
    return found, sign * (axis == 0), sign * (axis == 1), sign * (axis == 2)
