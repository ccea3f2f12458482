"""Bodies of bounded speed in the memory of an arm: where they were seen, and how long ago.

`iiwa_dnn.schemes.separation` has the rule. A frame of people replaces the one before; a body that
is seen alone replaces itself. What is no frame changes nothing, so that all bodies grow older, and
the arm comes to rest by itself: numbers that are not finite, too many bodies, an age that is
negative, or a frame that is older than the last one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.control.requests import DAMPING, TWIST, RequestConstants, twist_rows
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, cholesky_factor, factor_solve
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.references.rotations import combined, cross, dot, scaled, triple
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.robot.obstacles import Box, Obstacle, PlacedBox, Sphere, box_around
from iiwa_dnn.schemes.program import ProgramArrays, add_soft
from iiwa_dnn.schemes.separation import FreeBody, Separation, separation_views

CAPSULE = 7
"""Numbers of a capsule in a frame of people: both ends and the radius [m]."""

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


@compiled
def twist_rates(arrays: ProgramArrays, request: RequestConstants, dq: Vector) -> None:
    """Compute the joint velocities dq (n,) [rad/s] that answer a requested twist without limits."""
    n = dq.size
    v = request.velocity[: Twist.width()]
    A = np.empty((TWIST, n))
    twist_rows(arrays.jacobian, arrays.placements, arrays.support, request.frame, A)
    P = np.zeros((n, n))
    q = np.zeros(n)
    add_soft(P, q, A, v, 1.0)
    for i in range(n):
        P[i, i] += DAMPING * DAMPING
        q[i] = -q[i]
    dq[:] = 0.0
    if cholesky_factor(P):
        factor_solve(P, q, dq)


def separation_in(parts: Iterable[object]) -> Separation | None:
    """Return the `Separation` among limits or parts; None if there is none."""
    return next((part for part in parts if isinstance(part, Separation)), None)


def split_bodies(obstacles: Any) -> tuple[list[Obstacle], list[Obstacle]]:
    """Split obstacles, or the one, into bodies of bounded speed and all others."""
    given = tuple(obstacles) if isinstance(obstacles, Iterable) else (obstacles,)
    free = [each for each in given if isinstance(each, Obstacle) and each.is_free]
    return free, [each for each in given if each not in free]


class News:
    """Places of bodies of bounded speed that a sensor reported since the last step, checked.

    Attributes:
        age: Time since it was seen [s].
        people: Capsules of a complete frame, (k, 7); None: there is no frame.
        bodies: Boxes, (15,), of bodies that were seen one by one, by their numbers.
    """

    def __init__(
        self,
        rule: Separation | None,
        people: Any,
        bodies: Mapping[str, Any] | None,
        age: float | None,
    ) -> None:
        """Take arguments of a step.

        Args:
            rule: The limit that keeps the bodies away; None: there is none.
            people: Ends and radius of each body in a frame [m], (k, 7) or k tuples; or None.
            bodies: Place of each body that was seen, by its name; or None.
            age: Time since [s]; None: the latency.

        Raises:
            InvalidInputError: An argument has a wrong shape, or there is no such rule.
            NotFoundError: There is no body of a name.
        """
        self.people: Matrix | None = None
        self.bodies: dict[int, Vector] = {}
        if rule is None:
            raise InvalidInputError("people", "no Separation is among the limits", people)
        self.age = rule.latency if age is None else float(checks.array("age", age, ()))
        if people is not None:
            self.people = capsules_of(people)
        names = rule.names[: len(rule.bodies)]
        for name, place in (bodies or {}).items():
            if name not in names:
                raise NotFoundError("body with a speed", name, names)
            number = names.index(name)
            self.bodies[number] = _box_of(rule.bodies[number], place)


def is_of_each(people: Any, count: int) -> bool:
    """Test whether people are a list of as many frames as arms, and no frame of capsules."""
    if isinstance(people, np.ndarray):
        return people.ndim > 2
    if people is None or len(people) != count:
        return False
    ends = [end for each in people if each is not None and len(each) for end in (each[0], each[-1])]
    return all(hasattr(end, "__len__") for end in ends)


def capsules_of(people: Any) -> Matrix:
    """Return the capsules of a frame, (k, 7): ends and radius of each [m]; they may be NaN.

    Raises:
        InvalidInputError: They have a wrong shape.
    """
    if not isinstance(people, np.ndarray):
        try:
            rows = [np.concatenate([*map(np.ravel, each)]) for each in people]
        except (TypeError, ValueError):
            rows = [np.zeros(0)]
        if any(row.size != CAPSULE for row in rows):
            problem = "must be tuples (a, b, radius): both ends [m], (3,), and a radius [m]"
            raise InvalidInputError("people", problem, people)
        people = rows
    if len(people) == 0:
        people = np.zeros((0, CAPSULE))
    found: Matrix = checks.array("people", people, (-1, CAPSULE))
    return found


def _box_of(body: Obstacle, place: Any) -> Vector:
    """Return the box of a body at a place, (15,); NaN for one that is not finite.

    Raises:
        InvalidInputError: The place has a wrong shape: a sphere's is its center, a capsule's are
            its ends, a box's its center, or its center and its rotation.
    """
    half = body.box.half_extents
    if isinstance(body, Box):
        alone = np.ndim(place[0]) == 0
        center, turn = (place, body.box.rotation) if alone else place
        placed = PlacedBox(
            checks.array("center", center, (3,)), checks.array("rotation", turn, (3, 3)), half
        )
    else:
        ends = checks.array("place", [place] if isinstance(body, Sphere) else place, (-1, 3))
        if not np.isfinite(ends).all():
            return np.full(BoxPlace.width(), np.nan)
        placed = box_around(ends[0], ends[-1])
    return np.concatenate([placed.half_extents, placed.rotation.T.ravel(), placed.center])
