r"""Bodies and pairs of a scene: their layout, bounds on their motion, and their distances.

Of a pair the second body is a segment and the first a box, both rounded by a radius. A point is a
tuple (x, y, z) [m], which compiled code keeps in registers. The segment is a + s u, s in [0, 1];
the box has half-extents h about the origin, along the axes. It may be flat: without extents it is a
point, with one a segment.

Along the joints :math:`1 \dots n` between a body at rest and the link, which travel by
:math:`\delta_k`, and with a point at most :math:`r_k` from the axis of joint k, the point's
displacement, and twice its remainder of second order in the joints', are at most

.. math::

    V = \sum_k \delta_k r_k, \qquad
    B = \sum_k r_k \delta_k \Bigl(\delta_k + 2 \sum_{j<k} \delta_j\Bigr)

(docs/theory_braking.md). A prismatic joint counts with :math:`r_k = 1`, turns nothing and has no
:math:`\delta_k^2`. With velocities in place of displacements they bound velocity and acceleration.
"""

import itertools
import math
from collections.abc import Sequence
from dataclasses import astuple
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import combined, dot, triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import collision_model, unwatched_links
from iiwa_dnn.robot.kinematics import Kinematics, Placement
from iiwa_dnn.robot.obstacles import Obstacle, PlacedBox, box_around
from iiwa_dnn.schemes.step import axis_at, rate_along, seen_from

ROUNDS = 60
"""Most steps of the search along the segment; it needs about six."""

POSTURES = 64
UNMOVED = 1e-9
"""Random postures in which no joint moves an end of a pair, and the rate below which none does
[m/rad]."""

_MET = 1e-9
"""Distance of two cores below which they count as one [m]."""


class SceneHead(Record):
    """Settings of a scene, and the sizes of the tables that follow them.

    Attributes:
        least: Least distance [m].
        gain: Largest rate at which a distance shrinks towards it [1/s].
        bodies: Number of bodies.
        pairs: Number of pairs.
        first: Number of pairs of the scenes before this one.
    """

    least: float
    gain: float
    bodies: int
    pairs: int
    first: int


class Body(Record):
    """A box in a frame.

    Attributes:
        frame: Index of the frame.
        half: Half-extents [m]; a segment lies along the third axis.
        axes: The box's axes in the frame, one a row.
        center: Its centre in the frame [m].
    """

    frame: int
    half: Vector = part(3)
    axes: Matrix = part(3, 3)
    center: Vector = part(3)


class Pair(Record):
    """Two bodies that may meet.

    Attributes:
        speed: Bound on the speed of the first body [m/s].
        second: Index of the second body, a segment.
        first: Index of the first body, any box.
        radius: Sum of both radii [m].
        still: 1 or 2 for the end of the segment that no joint moves towards or away from the first
            body, else 0.
    """

    speed: float
    second: int
    first: int
    radius: float
    still: int


class SceneViews(NamedTuple):
    """Constants of a scene of b bodies and k pairs, as views.

    Attributes:
        head: Settings of the scene.
        dq_max: Velocity limits of the joints [rad/s], (n,).
        bodies: A `Body` in each row, (b, 16).
        pairs: A `Pair` in each row, (k, 5).
        support: For each pair and joint 1 if it moves the second body alone, -1 if it moves the
            first alone, else 0, (k, n).
        radii: For each pair and joint the largest distance of the second body from its axis [m], -1
            for a prismatic joint, 0 for one that moves neither alone, (k, n).
    """

    head: SceneHead
    dq_max: Vector
    bodies: Matrix
    pairs: Matrix
    support: Matrix
    radii: Matrix


class Contact(NamedTuple):
    """Nearest points of a pair's cores, as far as rows need them.

    Attributes:
        second: Point of the second body [m], (3,).
        normal: Unit normal from the first to the second, (3,); zero where segments or points meet.
        distance: Distance of the bodies [m], negative where they meet.
    """

    second: Vector3
    normal: Vector3
    distance: float


class Scene(NamedTuple):
    """Bodies and pairs of a robot among obstacles.

    Attributes:
        robot: The robot, n joints.
        pairs: Names of the bodies of each pair: a link or an obstacle, and a link beside it.
        frames: Links whose placements are needed.
        moving: Obstacles that move, each with the number of its body.
        constants: Numbers that compiled code sees through `scene_views`, (k,).
        left_out: Names of the bodies of each pair that is not watched, and the reason.
    """

    robot: Robot
    pairs: list[tuple[str, str]]
    frames: tuple[str, ...]
    moving: list[tuple[Obstacle, int]]
    constants: Vector
    left_out: tuple[tuple[str, str, str], ...]

    def move(self, constants: Vector, t: float) -> None:
        """Bring the moving obstacles in a copy of `constants`, (k,), to a time [s]."""
        resting = scene_views(self.constants, self.robot.dof).bodies
        moved = scene_views(constants, self.robot.dof).bodies
        for obstacle, k in self.moving:
            Body.of(moved[k]).center = Body.of(resting[k]).center + obstacle.shift(t)

    def distances(self, q: Matrix, t: Vector) -> Matrix:
        """Compute the distances of all pairs [m], (k, pairs), at q (k, n) [rad] and t (k,) [s]."""
        constants = self.constants.copy()
        kinematics = Kinematics(self.robot, self.frames)
        found = np.empty((len(q), len(self.pairs)))
        for row, posture, time in zip(found, q, t, strict=True):
            self.move(constants, float(time))
            kinematics.update(posture)
            write_distances(constants, self.robot.dof, kinematics.placements, row)
        return found

    def nearest(self, q: Matrix, t: Vector) -> tuple[Vector, NDArray[np.int64]]:
        """Compute the least distance [m] of all pairs, (k,), and the index of its pair, (k,).

        The joints are at q (k, n) [rad] at times t (k,) [s].
        """
        found = self.distances(q, t)
        return found.min(axis=1), found.argmin(axis=1)


class _Body(NamedTuple):
    """A box with a radius in a frame of the robot, 0 the world, where it may have a speed."""

    name: str
    frame: int
    box: PlacedBox
    radius: float
    speed: float


def make_scene(
    robot: Robot,
    obstacles: Sequence[Obstacle],
    self_collision: bool,
    distances: tuple[float, float],
    left_out: Sequence[tuple[str, str]] = (),
) -> Scene:
    """Lay the capsules of a robot, obstacles and their pairs out; among them, or not, of links.

    Args:
        robot: The robot.
        obstacles: The obstacles.
        self_collision: Whether pairs of links are watched.
        distances: Least distance [m], and the largest rate at which a distance shrinks to it [1/s].
        left_out: Names of the bodies of pairs that are not watched. Nor are those that no joint
            moves.

    Raises:
        NotFoundError: There is no body of a name in `left_out`.
        InvalidInputError: There is no URDF file, no velocity limit of a joint, or no pair.
        FileError: The collision geometry of the robot cannot be read.
    """
    if not (robot.dq_max < np.inf).all():
        name = robot.joint_names[int(np.argmax(robot.dq_max))]
        problem = f"must have a velocity limit on {name}, or no distance can be kept"
        raise InvalidInputError("robot", problem, robot)
    bodies = _bodies(robot, obstacles)
    links = len(bodies) - len(obstacles)
    pairs = [*collision_model(robot).pairs(robot)] if self_collision else []
    carried = [k for k in range(links) if robot.support[bodies[k].frame].any()]
    pairs += itertools.product(range(links, len(bodies)), carried)
    frames = tuple(dict.fromkeys(body.name for body in bodies[:links]))
    rows, motions = _layout(robot, bodies, pairs)
    moved = _moved_ends(robot, frames, _constants(robot, distances, bodies, rows, motions))
    names = [(bodies[i].name, bodies[k].name) for i, k in pairs]
    watched = moved.any(axis=1) & ~_are_given(names, left_out, bodies)
    if not watched.any():
        bare = unwatched_links(robot)
        reason = f"; {unwatched(bare)}" if bare else ""
        problem = f"there is no pair that could meet{reason}"
        raise InvalidInputError("obstacles", problem, obstacles)
    still = np.where(moved.all(axis=1), 0, 1 + moved[:, 0])
    for row, end in zip(rows, still, strict=True):
        Pair.of(row).still = end
    constants = _constants(robot, distances, bodies, rows[watched], motions[watched])
    numbered = enumerate(obstacles, links)
    moving = [(each, k) for k, each in numbered if each.speed]
    reasons = np.where(moved.any(axis=1), "given", "no joint moves it").tolist()
    left = tuple((*names[at], reasons[at]) for at in np.flatnonzero(~watched))
    return Scene(robot, [*itertools.compress(names, watched)], frames, moving, constants, left)


def _bodies(robot: Robot, obstacles: Sequence[Obstacle]) -> list[_Body]:
    """Return the capsules of a robot's links, then the obstacles."""
    bodies = [
        _Body(link, robot.frame_id(link), box_around(a, b), radius, 0.0)
        for link, a, b, radius in map(astuple, collision_model(robot).capsules)
    ]
    return bodies + [
        _Body(f"{type(each).__name__} {number}", 0, each.box, each.thickness, each.speed)
        for number, each in enumerate(obstacles, 1)
    ]


def _are_given(
    names: list[tuple[str, str]], left_out: Sequence[tuple[str, str]], bodies: list[_Body]
) -> NDArray[np.bool_]:
    """Test which pairs of names are left out; raises NotFoundError if no body has a name."""
    known = [body.name for body in bodies]
    for name in itertools.chain(*left_out):
        if name not in known:
            raise NotFoundError("link or obstacle", name, known)
    return np.array([pair in left_out or pair[::-1] in left_out for pair in names], dtype=bool)


def _moved_ends(robot: Robot, frames: Sequence[str], constants: Vector) -> NDArray[np.bool_]:
    """Test which ends of each pair joints move towards or away from its first body, (pairs, 2).

    A body that moves by itself counts as moved, if any joint moves the other beside it.
    """
    scene = scene_views(constants, robot.dof)
    kinematics = Kinematics(robot, frames)
    rates = np.zeros((len(scene.pairs), 2))
    for q in robot.draw(np.random.default_rng(0), POSTURES):
        kinematics.update(q)
        write_end_rates(constants, kinematics.jacobian, kinematics.placements, rates)
    itself = [[Pair.of(row).speed > 0.0] for row in scene.pairs]
    moved = (rates > UNMOVED) | np.array(itself, dtype=bool).reshape(-1, 1)
    return np.array(moved & scene.support.any(axis=1, keepdims=True))


def _constants(
    robot: Robot,
    distances: tuple[float, float],
    bodies: list[_Body],
    rows: Matrix,
    motions: Matrix,
) -> Vector:
    """Return `Scene.constants`, (k,), for bodies and the pairs of `_layout`."""
    placed = [
        Body.make(
            frame=body.frame,
            half=body.box.half_extents,
            axes=body.box.rotation.T,
            center=body.box.center,
        )
        for body in bodies
    ]
    least, gain = distances
    head = SceneHead.make(least=least, gain=gain, bodies=len(bodies), pairs=len(rows), first=0)
    parts = (head, robot.dq_max, placed, rows, motions[:, 0], motions[:, 1])
    return np.concatenate([np.ravel(part) for part in parts])


def _layout(
    robot: Robot, bodies: list[_Body], pairs: list[tuple[int, int]]
) -> tuple[Matrix, Matrix]:
    """Return `SceneViews.pairs`, (k, 5), `support` and `radii`, (k, 2, n), of pairs of bodies."""
    rows = [
        Pair.make(
            speed=bodies[i].speed,
            second=k,
            first=i,
            radius=bodies[i].radius + bodies[k].radius,
            still=0,
        )
        for i, k in pairs
    ]
    motions = [_motion(robot, bodies[i], bodies[k]) for i, k in pairs]
    return np.reshape(rows, (-1, Pair.width())), np.reshape(motions, (-1, 2, robot.dof))


def _motion(robot: Robot, first: _Body, second: _Body) -> Matrix:
    """Find the joints that move the second body, a segment, beside the first one.

    Returns:
        Two rows, (2, n): 1 for each joint that moves the second body alone, -1 for each that moves
        the first alone, else 0; and the largest distance of the segment from the axis of each joint
        that moves it [m], -1 for a prismatic joint, 0 for the others.
    """
    model = robot.model
    center, rotation, half = second.box
    placement = model.frames[second.frame].placement
    support = robot.support[second.frame] - robot.support[first.frame]
    radii = np.zeros(robot.dof)
    # From the second body to the base, and up to the first: nothing is farther than `reach` from
    # the joint in turn, and `offsets` lead from the joint before it.
    offsets = np.array([placement.act(center + z * rotation[:, 2]) for z in (-half[2], half[2])])
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
    return np.array([support, radii])


@compiled
def scene_views(constants: Vector, dof: int) -> SceneViews:
    """Make the views of a scene's constants (k,) for a robot of `dof` joints."""
    at_limits = SceneHead.width()
    head = SceneHead.of(constants[:at_limits])
    bodies = head.bodies
    pairs = head.pairs
    at_bodies = at_limits + dof
    at_pairs = at_bodies + Body.width() * bodies
    at_support = at_pairs + Pair.width() * pairs
    at_radii = at_support + dof * pairs
    return SceneViews(
        head,
        constants[at_limits:at_bodies],
        constants[at_bodies:at_pairs].reshape(bodies, Body.width()),
        constants[at_pairs:at_support].reshape(pairs, Pair.width()),
        constants[at_support:at_radii].reshape(pairs, dof),
        constants[at_radii : at_radii + dof * pairs].reshape(pairs, dof),
    )


@compiled
def place_bodies(scene: SceneViews, placements: Matrix, placed: Matrix) -> None:
    """Write the placements of all bodies in the world, (b, 12), for those of frames (k, 12)."""
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
    """Return the ends of a segment among the bodies in the world [m], (3,) each."""
    place = Placement.of(placed[body])
    center = triple(place.position)
    axis = triple(place.axes[2])
    half = Body.of(scene.bodies[body]).half[2]
    return combined(1.0, center, -half, axis), combined(1.0, center, half, axis)


@compiled
def contact_of(scene: SceneViews, k: int, placed: Matrix) -> Contact:
    """Compute the contact of pair k, for the placements of all bodies (b, 12)."""
    pair = Pair.of(scene.pairs[k])
    base = Placement.of(placed[pair.first])
    half = triple(Body.of(scene.bodies[pair.first]).half)
    a, b = ends_of(scene, placed, pair.second)
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
    outward = axis_at(base, normal)
    return Contact(combined(1.0, a, s, path), outward, core - pair.radius)


@compiled
def height_of(end: Vector3, contact: Contact) -> float:
    """Compute by how much an end of a pair's segment is farther away than the contact [m].

    No end is below the nearest point, but rounding would hold an arm that is too near.
    """
    return max(0.0, dot(combined(1.0, end, -1.0, contact.second), contact.normal))


@compiled
def write_distances(constants: Vector, dof: int, placements: Matrix, distances: Vector) -> None:
    """Write the distance of each pair [m].

    Args:
        constants: `Scene.constants`, (k,).
        dof: Number of the robot's joints.
        placements: `Kinematics.placements`, (frames, 12).
        distances: The distances, (pairs,), overwritten.
    """
    scene = scene_views(constants, dof)
    placed = np.empty((len(scene.bodies), Placement.width()))
    place_bodies(scene, placements, placed)
    for k in range(distances.size):
        distances[k] = contact_of(scene, k, placed).distance


@compiled
def write_end_rates(constants: Vector, jacobian: Matrix, placements: Matrix, rates: Matrix) -> None:
    """Raise the rates (pairs, 2) to those at which joints move the ends of each pair [m/rad].

    The largest of a joint counts, along the pair's normal; inf where there is none.

    Args:
        constants: `Scene.constants`, (k,).
        jacobian: `Kinematics.jacobian`, (n, 6).
        placements: `Kinematics.placements`, (frames, 12).
        rates: The rates so far, overwritten.
    """
    dof = len(jacobian)
    scene = scene_views(constants, dof)
    placed = np.empty((len(scene.bodies), Placement.width()))
    place_bodies(scene, placements, placed)
    for k in range(len(scene.pairs)):
        contact = contact_of(scene, k, placed)
        ends = ends_of(scene, placed, Pair.of(scene.pairs[k]).second)
        for at in range(2):
            if dot(contact.normal, contact.normal) == 0.0:
                rates[k, at] = np.inf
            for j in range(dof):
                rate = abs(scene.support[k, j] * rate_along(jacobian, j, ends[at], contact.normal))
                rates[k, at] = max(rates[k, at], rate)


@compiled
def second_order(support: Matrix, radii: Matrix, k: int, travel: Vector) -> float:
    """Compute B [m] for pair k, whose joints travel by `travel` (n,) [rad].

    Args:
        support: `SceneViews.support`, (pairs, n).
        radii: `SceneViews.radii`, (pairs, n).
        k: Index of the pair.
        travel: Displacement of each joint, at least 0, (n,) [rad].
    """
    n = travel.size
    B = 0.0
    turning = 0.0
    for step in range(2 * n):  # from the first body up to the common base, then down
        j = n - 1 - step if step < n else step - n
        if support[k, j] == 0.0 or (support[k, j] < 0.0) != (step < n):
            continue
        if radii[k, j] < 0.0:
            B += 2.0 * travel[j] * turning
        else:
            B += travel[j] * radii[k, j] * (2.0 * turning + travel[j])
            turning += travel[j]
    return B


@compiled
def beyond(x: Vector3, half: Vector3) -> Vector3:
    """Return the vector to a point from the nearest one of a box."""
    return (
        x[0] - min(max(x[0], -half[0]), half[0]),
        x[1] - min(max(x[1], -half[1]), half[1]),
        x[2] - min(max(x[2], -half[2]), half[2]),
    )


@compiled
def nearest_parameter(a: Vector3, u: Vector3, half: Vector3) -> float:
    """Compute the s in [0, 1] of the point of a segment that is nearest to a box.

    Half the derivative of the squared distance grows with s: its root is found by regula falsi,
    every third step of which halves.
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
    """Compute the signed distance of a point to the nearest face of a box, negative inside.

    Returns:
        The distance along the face's outer normal, and the three components of the normal.
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
