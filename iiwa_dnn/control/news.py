"""News of bodies of bounded speed: the arguments of a step that say where they were seen."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot.obstacles import Box, Obstacle, PlacedBox, Sphere, box_around, names_of
from iiwa_dnn.schemes.separation import Separation
from iiwa_dnn.step.bodies import BoxPlace

CAPSULE = 7
"""Numbers of a capsule in a frame of people: both ends and the radius [m]."""


def separation_in(parts: Iterable[object]) -> Separation | None:
    """Return the `Separation` among limits or parts; None if there is none."""
    return next((part for part in parts if isinstance(part, Separation)), None)


def split_bodies(obstacles: Any) -> tuple[list[Obstacle], list[Obstacle]]:
    """Split obstacles, or the one, into bodies of bounded speed and all others.

    Raises:
        InvalidInputError: Two have the same name.
    """
    given = tuple(obstacles) if isinstance(obstacles, Iterable) else (obstacles,)
    names_of([each for each in given if isinstance(each, Obstacle)])
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
