"""Bodies of bounded speed in the memory of an arm: where they were seen, and how long ago.

`iiwa_dnn.schemes.separation` has the rule. A frame of people replaces the one before; a body that
is seen alone replaces itself. What is no frame changes nothing, so that all bodies grow older, and
the arm comes to rest by itself: numbers that are not finite, too many bodies, an age that is
negative, or a frame that is older than the last one.
"""

from __future__ import annotations

import math

import numpy as np

from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.references.rotations import combined, cross, dot, scaled, triple
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.schemes.separation import FreeBody, separation_views

ROUNDING = 1e-9
"""Part of its age by which a frame may seem older than the last one."""

ORTHOGONAL = 1e-6
"""Product of two axes, or error of a squared length, up to which a box has a rotation."""

POINT = 1e-12
"""Length up to which a segment has no direction [m]."""


class BoxPlace(Record):
    """Place of a body: the half-extents of its box [m], axes and center."""

    half: Vector = part(3)
    place: Placement = part(Placement)


@compiled
def is_newer(age: float, last: float) -> bool:
    """Test whether a frame of an age [s] is as new as the last one, of the age `last`."""
    return age >= 0.0 and age < np.inf and age <= last * (1.0 + ROUNDING)


@compiled
def take_people(bodies: Matrix, people: int, capsules: Matrix) -> bool:
    """Write the capsules of a frame to the last `people` bodies, if they have a meaning.

    Args:
        bodies: A `FreeBody` in each row.
        people: Number of bodies that a frame may show.
        capsules: Ends and radius of each [m], (k, 7).
    """
    flat = capsules.reshape(capsules.size)
    if len(capsules) > people or not all_finite(flat, 0, flat.size):
        return False
    last = capsules.shape[1] - 1
    middle = last // 2
    for k in range(len(capsules)):
        if capsules[k, last] < 0.0:
            return False
    for k in range(people):
        body = FreeBody.of(bodies[len(bodies) - people + k])
        body.is_there = k < len(capsules)
        if k < len(capsules):
            body.radius = capsules[k, last]
            _lay_along(body, triple(capsules[k]), triple(capsules[k, middle:]))
    return True


@compiled
def _lay_along(body: FreeBody, a: Vector3, b: Vector3) -> None:
    """Make a body the segment between two points (3,) [m]; writes body."""
    path = combined(1.0, b, -1.0, a)
    length = math.sqrt(dot(path, path))
    along = scaled(1.0 / length, path) if length > POINT else (0.0, 0.0, 1.0)
    x, _, _ = along
    aside = cross((1.0, 0.0, 0.0) if abs(x) < 0.5 else (0.0, 1.0, 0.0), along)
    across = scaled(1.0 / math.sqrt(dot(aside, aside)), aside)
    write_axes(body.place, across, cross(along, across), along)
    half = scaled(0.5 * length, (0.0, 0.0, 1.0))
    middle = combined(0.5, a, 0.5, b)
    for i in range(body.half.size):
        body.half[i] = half[i]
        body.place.position[i] = middle[i]


@compiled
def write_axes(place: Placement, x: Vector3, y: Vector3, z: Vector3) -> None:
    """Write the axes of a placement."""
    for i in range(place.position.size):
        place.axes[0, i] = x[i]
        place.axes[1, i] = y[i]
        place.axes[2, i] = z[i]


@compiled
def take_body(body: FreeBody, numbers: Vector, age: float) -> bool:
    """Place a body as a box (15,) that was seen some time ago [s], if that has a meaning.

    Writes body.
    """
    if not is_newer(age, body.age) or not all_finite(numbers, 0, numbers.size):
        return False
    box = BoxPlace.of(numbers)
    if not _is_box(box):
        return False
    copied(body.half, box.half)
    copied(body.place.numbers, box.place.numbers)
    body.age = age
    return True


@compiled
def _is_box(box: BoxPlace) -> bool:
    """Test whether no half-extent is negative, and axes of length 1 are at right angles."""
    axes = box.place.axes
    for i in range(box.half.size):
        if box.half[i] < 0.0:
            return False
        for j in range(box.half.size):
            expected = 1.0 if i == j else 0.0
            if abs(dot(triple(axes[i]), triple(axes[j])) - expected) > ORTHOGONAL:
                return False
    return True


@compiled
def grow_older(bodies: Matrix, seconds: float) -> None:
    """Add seconds to the age of all bodies; writes bodies."""
    for k in range(len(bodies)):
        body = FreeBody.of(bodies[k])
        body.age += seconds


@compiled
def write_bodies(constants: Vector, bodies: Matrix, age: float) -> None:
    """Write bodies, and the age [s] of the last frame of people, into the constants of the rule.

    Writes constants.
    """
    own = separation_views(constants)
    own.head.age = age
    for k in range(len(bodies)):
        copied(own.bodies[k], bodies[k])
