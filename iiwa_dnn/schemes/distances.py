"""Distances of a scene's pairs, compiled: nearest points of a segment and a box, both rounded.

A point is a tuple (x, y, z) [m], which compiled code keeps in registers. The segment is a + s u, s
in [0, 1]; the box has half-extents h about the origin, along the axes. It may be flat: without
extents it is a point, with one a segment.
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import Triple
from iiwa_dnn.references.rotations import combined, dot
from iiwa_dnn.schemes.step import axis_at, seen_from, vector_at

ROUNDS = 60
"""Most steps of the search along the segment; it needs about six."""

HEAD = 4
"""Constants of a scene before those of joints, bodies and pairs."""

PER_BODY = 16
"""Numbers of a body."""

PER_PAIR = 4
SPEED, SECOND, FIRST, RADIUS = range(PER_PAIR)
"""Numbers of a pair: bound on the speed of its first body [m/s], the index of the second body, a
segment, that of the first, any box, and the sum of both radii [m]."""

_MET = 1e-9
"""Distance of two cores below which they count as one [m]."""


class SceneViews(NamedTuple):
    """Constants of a scene of b bodies and k pairs, as views.

    Attributes:
        least: Least distance [m].
        gain: Largest rate at which a distance shrinks towards it [1/s].
        dq_max: Velocity limits of the joints [rad/s], (n,).
        bodies: Of each body the index of its frame, half-extents [m], and placement in the frame
            as of `Kinematics.placements`, (b, 16).
        pairs: Numbers of each pair, (k, 4).
        moves: For each pair and joint 1 if it moves the second body alone, -1 if it moves the
            first alone, else 0, (k, n).
        radii: For each pair and joint the largest distance of the second body from its axis [m], -1
            for a prismatic joint, 0 for one that moves neither alone, (k, n).
    """

    least: float
    gain: float
    dq_max: Vector
    bodies: Matrix
    pairs: Matrix
    moves: Matrix
    radii: Matrix


class Contact(NamedTuple):
    """Nearest points of a pair's cores.

    Attributes:
        second: Point of the second body [m], (3,).
        first: Point of the first body [m], (3,).
        normal: Unit normal from the first to the second, (3,).
        distance: Distance of the bodies [m], negative where they meet.
    """

    second: Triple
    first: Triple
    normal: Triple
    distance: float


@compiled
def scene_views(constants: Vector, dof: int) -> SceneViews:
    """Make the views of a scene's constants (k,) for a robot of `dof` joints."""
    bodies = int(constants[2])
    pairs = int(constants[3])
    at_bodies = HEAD + dof
    at_pairs = at_bodies + PER_BODY * bodies
    at_moves = at_pairs + PER_PAIR * pairs
    at_radii = at_moves + dof * pairs
    return SceneViews(
        constants[0],
        constants[1],
        constants[HEAD:at_bodies],
        constants[at_bodies:at_pairs].reshape(bodies, PER_BODY),
        constants[at_pairs:at_moves].reshape(pairs, PER_PAIR),
        constants[at_moves:at_radii].reshape(pairs, dof),
        constants[at_radii : at_radii + dof * pairs].reshape(pairs, dof),
    )


@compiled
def place_bodies(scene: SceneViews, placements: Matrix, placed: Matrix) -> None:
    """Write the placements of all bodies in the world, (b, 12), for those of frames (k, 12)."""
    for k in range(len(scene.bodies)):
        frame = placements[int(scene.bodies[k, 0])]
        for i in range(12):
            value = frame[9 + i % 3] if i >= 9 else 0.0
            for j in range(3):
                value += frame[3 * j + i % 3] * scene.bodies[k, 4 + i - i % 3 + j]
            placed[k, i] = value


@compiled
def ends_of(scene: SceneViews, placed: Matrix, body: int) -> tuple[Triple, Triple]:
    """Return the ends of a segment among the bodies in the world [m], (3,) each."""
    center = vector_at(placed[body], 9)
    axis = vector_at(placed[body], 6)
    half = scene.bodies[body, 3]
    return combined(1.0, center, -half, axis), combined(1.0, center, half, axis)


@compiled
def contact_of(scene: SceneViews, k: int, placed: Matrix) -> Contact:
    """Compute the contact of pair k, for the placements of all bodies (b, 12)."""
    first = int(scene.pairs[k, FIRST])
    base = placed[first]
    half = vector_at(scene.bodies[first], 1)
    a, b = ends_of(scene, placed, int(scene.pairs[k, SECOND]))
    way = combined(1.0, b, -1.0, a)
    start = seen_from(base, combined(1.0, a, -1.0, vector_at(base, 9)))
    along = seen_from(base, way)
    s = nearest_parameter(start, along, half)
    nearest = combined(1.0, start, s, along)
    side = beyond(nearest, half)
    core = math.sqrt(dot(side, side))
    if core > _MET:
        normal = (side[0] / core, side[1] / core, side[2] / core)
    else:
        core, normal = depth(nearest, half)
    outward = axis_at(base, normal)
    point = combined(1.0, a, s, way)
    other = combined(1.0, point, -core, outward)
    return Contact(point, other, outward, core - scene.pairs[k, RADIUS])


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
    placed = np.empty((len(scene.bodies), 12))
    place_bodies(scene, placements, placed)
    for k in range(distances.size):
        distances[k] = contact_of(scene, k, placed).distance


@compiled
def second_order(moves: Matrix, radii: Matrix, k: int, travel: Vector) -> float:
    """Compute B [m] for pair k, whose joints travel by `travel` (n,) [rad].

    Args:
        moves: `SceneViews.moves`, (pairs, n).
        radii: `SceneViews.radii`, (pairs, n).
        k: Index of the pair.
        travel: Way of each joint, at least 0, (n,) [rad].
    """
    n = travel.size
    B = 0.0
    turning = 0.0
    for step in range(2 * n):  # from the first body up to the common base, then down
        j = n - 1 - step if step < n else step - n
        if moves[k, j] == 0.0 or (moves[k, j] < 0.0) != (step < n):
            continue
        if radii[k, j] < 0.0:
            B += 2.0 * travel[j] * turning
        else:
            B += travel[j] * radii[k, j] * (2.0 * turning + travel[j])
            turning += travel[j]
    return B


@compiled
def beyond(x: Triple, half: Triple) -> Triple:
    """Return the way to a point from the nearest one of a box."""
    return (
        x[0] - min(max(x[0], -half[0]), half[0]),
        x[1] - min(max(x[1], -half[1]), half[1]),
        x[2] - min(max(x[2], -half[2]), half[2]),
    )


@compiled
def nearest_parameter(a: Triple, u: Triple, half: Triple) -> float:
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
        share = 0.5 if k % 3 == 2 else below / (below - above)
        middle = low + share * (high - low)
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
def depth(x: Triple, half: Triple) -> tuple[float, Triple]:
    """Compute how far a point is from leaving a box by its nearest face, negative inside.

    Returns:
        The distance from the face, and the normal out of it, (3,).
    """
    found = -1e300
    normal = (0.0, 0.0, 1.0)
    for i in range(3):
        if abs(x[i]) - half[i] > found:
            found = abs(x[i]) - half[i]
            sign = 1.0 if x[i] >= 0.0 else -1.0
            normal = (sign * (i == 0), sign * (i == 1), sign * (i == 2))
    return found, normal
