"""Pairs of a robot's links that may meet, found by their shapes in random postures and searches.

Bodies around two links may overlap in most postures though the links themselves do not. Such a pair
is close: what is measured is by how much its bodies overlap where the links begin to touch.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from functools import partial
from itertools import permutations
from typing import NamedTuple

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn.checks import Array
from iiwa_dnn.robot.fitting import GRID, Body
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.shapes import read_shapes

SAMPLES = 10_000
"""Random postures in which pairs are looked for that come near each other."""

CLEARANCE = 0.02
"""Distance beyond which a pair never meets [m]."""

TOUCH = 0.005
"""Distance that a close pair keeps, by the overlap of its bodies where its links touch [m]."""

MEETS = "may meet"
"""Reason of a pair that is not watched, or not in whole, though its links may meet."""

_NEARBY = 0.1
_STARTS = 3
"""Distance from which a pair is searched for a nearer posture, from so many postures [m]."""

_CONTACTS = 2000
_PLACES = 200
"""Random postures in which shapes are tested for contact, and bodies for their distance."""

_ALWAYS = 0.95
_OFTEN = 0.5
_LOST = 0.3
"""Share of the postures in which a pair is assembled in contact; in which a close one has bodies
nearer than `CLEARANCE`; and that a pair may lose beyond those where its links touch."""

_DEEP = 0.6
"""Largest overlap, in radii, beyond which the axes of bodies could meet."""

_LEAST = 1e-6
"""Overlap of a close pair at least [m]."""

_TRIALS = 60
_STEP = 0.3
_SHRINK = 0.93
"""Trials of a search, its first step [rad], and the step's ratio after a trial in vain."""

Placed = tuple[str, tuple[coal.CollisionGeometry, pin.SE3]]
"""A shape of coal's with its pose in the frame of a link."""


class Watched(NamedTuple):
    """A pair of bodies that is kept apart.

    Attributes:
        first: Number of the first body.
        second: Number of the second one, a capsule.
        overlap: Overlap of the bodies of a close pair where its links begin to touch [m]; 0 if the
            pair is none.
    """

    first: int
    second: int
    overlap: float = 0.0


def geometry_of(
    robot: Robot, placed: Iterable[Placed], pairs: Iterable[tuple[int, int]]
) -> pin.GeometryModel:
    """Make Pinocchio's geometry model of shapes on links and of pairs of their numbers."""
    geometry = pin.GeometryModel()
    for number, (link, (shape, pose)) in enumerate(placed):
        frame = robot.model.frames[robot.frame_id(link)]
        place = frame.placement * pose
        added = pin.GeometryObject(f"{link}_{number}", frame.parentJoint, place, shape)
        geometry.addGeometryObject(added)
    for i, k in pairs:
        geometry.addCollisionPair(pin.CollisionPair(i, k))
    return geometry


class Space:
    """Shapes of a robot at a posture, and pairs of them.

    Args:
        robot: The robot.
        geometry: The shapes.
        margin: Distance at which a pair is in contact [m].
    """

    def __init__(self, robot: Robot, geometry: pin.GeometryModel, margin: float = 0.0) -> None:
        self._model = robot.model
        self._data = robot.model.createData()
        self._geometry = geometry
        self._found = self._scratch(margin)

    def _scratch(self, margin: float) -> pin.GeometryData:
        """Make room for results, where pairs are in contact within a margin [m]."""
        found = pin.GeometryData(self._geometry)
        for request in found.collisionRequests:
            request.security_margin = margin
        return found

    def distances(self, pairs: Sequence[int], q: Array) -> list[float]:
        """Compute the distances of pairs at q (n,) [m], negative where convex shapes overlap."""
        self._place(q)
        scene = self._geometry, self._found
        return [float(pin.computeDistance(*scene, pair).min_distance) for pair in pairs]

    def touch(self, pairs: Sequence[int], q: Array) -> bool:
        """Test whether any of some pairs is in contact at q (n,)."""
        self._place(q)
        return any(pin.computeCollision(self._geometry, self._found, pair) for pair in pairs)

    def _place(self, q: Array) -> None:
        pin.updateGeometryPlacements(self._model, self._data, self._geometry, self._found, q)

    def near(
        self, pairs: Collection[int], postures: Array, margin: float, most: int
    ) -> dict[int, list[Array]]:
        """Find postures out of (k, n) in which pairs are within a margin [m], the first ones."""
        scratch = self._scratch(margin)
        for pair in {*range(len(scratch.collisionRequests))}.difference(pairs):
            scratch.deactivateCollisionPair(pair)
        found: dict[int, list[Array]] = {}
        for q in postures:
            if pin.computeCollisions(self._model, self._data, self._geometry, scratch, q):
                for pair, result in enumerate(scratch.collisionResults):
                    if scratch.activeCollisionPairs[pair] and result.isCollision():
                        found.setdefault(pair, []).append(q)
                        if len(found[pair]) == most:
                            scratch.deactivateCollisionPair(pair)
        return found


def climb(
    robot: Robot, score: Callable[[Array], float], q: Array, enough: float = np.inf
) -> tuple[float, Array]:
    """Search for a posture of a larger score from q (n,) on; return the score and the posture."""
    random = np.random.default_rng(0)
    best = score(q)
    step = _STEP
    for _ in range(_TRIALS):
        if best >= enough:
            break
        trial = np.clip(q + step * random.standard_normal(q.size), robot.q_lower, robot.q_upper)
        found = score(trial)
        if found > best:
            best = found
            q = trial
        else:
            step *= _SHRINK
    return best, q


class Meetings:
    """Search of a robot's bodies for the pairs that may meet.

    Args:
        robot: The robot.
        bodies: Bodies with the names of their links.
        pairs: Pairs of their numbers that are searched.
        samples: Number of random postures.
    """

    def __init__(
        self,
        robot: Robot,
        bodies: Sequence[tuple[str, Body]],
        pairs: Sequence[tuple[int, int]],
        samples: int,
    ) -> None:
        self._robot = robot
        self._parts = bodies
        self._pairs = pairs
        self._draws = robot.draw(np.random.default_rng(0), samples)
        placed = [(link, body.placed) for link, body in bodies]
        hulls = [(link, body.hull) for link, body in bodies]
        self._bodies = Space(robot, geometry_of(robot, placed, pairs))
        self._hulls = Space(robot, geometry_of(robot, hulls, pairs), 2.0 * GRID)
        shapes = read_shapes(robot, pin.GeometryType.COLLISION)
        on = [robot.model.frames[each.parentFrame].name for each in shapes.geometryObjects]
        self._own: dict[tuple[str, str], list[int]] = {}
        searched = {*map(self._links, range(len(pairs)))}
        for i, k in permutations(range(len(on)), 2):
            if (on[i], on[k]) in searched:
                self._own.setdefault((on[i], on[k]), []).append(len(shapes.collisionPairs))
                shapes.addCollisionPair(pin.CollisionPair(i, k))
        self._shapes = Space(robot, shapes)

    def _links(self, pair: int) -> tuple[str, str]:
        i, k = self._pairs[pair]
        return self._parts[i][0], self._parts[k][0]

    def _near(self) -> list[int]:
        """Number the pairs whose parts of links come within `CLEARANCE`."""
        nearby = self._bodies.near(range(len(self._pairs)), self._draws, _NEARBY, 1)
        found = set(self._hulls.near(nearby, self._draws, CLEARANCE, 1))
        starts = self._hulls.near(nearby.keys() - found, self._draws, _NEARBY, _STARTS)
        for pair, postures in starts.items():
            score = partial(_nearness, self._hulls, [pair])
            if any(climb(self._robot, score, q, -CLEARANCE)[0] >= -CLEARANCE for q in postures):
                found.add(pair)
        return sorted(found)

    def sort(
        self, disabled: Mapping[frozenset[str], str]
    ) -> tuple[list[Watched], dict[tuple[str, str], str]]:
        """Sort pairs that come near into those that are watched, and links that are not.

        Args:
            disabled: Pairs of links that are not watched whatever is found, with the reasons.

        Returns:
            The watched pairs; pairs of links that are not watched, or not in whole, with the
            reasons.
        """
        near = self._near()
        places = [self._robot.start_posture(), *self._draws[:_PLACES]]
        apart = np.array([self._bodies.distances(near, q) for q in places])
        is_close = (apart[0] < CLEARANCE) | ((apart < CLEARANCE).mean(axis=0) > _OFTEN)
        watched = []
        close: dict[tuple[str, str], dict[int, Array]] = {}
        for pair, row, is_one in zip(near, apart.T, is_close.tolist(), strict=True):
            if is_one or frozenset(self._links(pair)) in disabled:
                close.setdefault(self._links(pair), {})[pair] = row
            else:
                watched.append(Watched(*self._pairs[pair]))
        left_out = {}
        for links, rows in close.items():
            found, reason = self._judged(links, rows, disabled.get(frozenset(links), ""))
            watched += found
            if reason:
                left_out[links] = reason
        return watched, left_out

    def _judged(
        self, links: tuple[str, str], rows: Mapping[int, Array], disabled: str
    ) -> tuple[list[Watched], str]:
        """Search for contacts of two links whose bodies are close, or that are disabled.

        Args:
            links: Their names.
            rows: Pairs of their bodies, each with distances as `_kept` takes them.
            disabled: Reason for which they are disabled; "" if they are not.

        Returns:
            The pairs that are watched, and the reason why others are not; "" if there are none.
        """
        share, postures = self._contacts(links, [*rows])
        if disabled:
            meets = len(postures) > 0 and share < _ALWAYS
            return [], f"{MEETS}, disabled: {disabled}" if meets else disabled
        if share >= _ALWAYS:
            return [], "always"
        kept = [self._kept(links, pair, row, postures) for pair, row in rows.items()]
        return [each for each in kept if each and each.overlap], "" if all(kept) else MEETS

    def _contacts(self, links: tuple[str, str], pairs: Sequence[int]) -> tuple[float, Array]:
        """Search for contacts of two links by their own shapes.

        Args:
            links: Their names.
            pairs: Pairs of their bodies.

        Returns:
            The share of random postures in which they touch, and such postures (k, n).
        """
        draws = self._draws[:_CONTACTS]
        touched = np.array([self._touch(links, pairs, q) for q in draws])
        if touched.any():
            return float(touched.mean()), draws[touched]

        def score(q: Array) -> float:
            return np.inf if self._touch(links, pairs, q) else _nearness(self._hulls, pairs, q)

        deepest = max(draws[:_PLACES], key=partial(_nearness, self._hulls, pairs))
        found, q = climb(self._robot, score, deepest, np.inf)
        return 0.0, q[np.newaxis][: found == np.inf]

    def _touch(self, links: tuple[str, str], pairs: Sequence[int], q: Array) -> bool:
        """Test whether two links touch at q (n,), and the hulls of any of their pairs."""
        return self._hulls.touch(pairs, q) and self._shapes.touch(self._own[links], q)

    def _kept(
        self, links: tuple[str, str], pair: int, apart: Array, postures: Array
    ) -> Watched | None:
        """Search for the least overlap of a pair of bodies where its links touch.

        Args:
            links: Names of the links.
            pair: The pair.
            apart: Distances of the bodies at the start and in random postures [m], (k,).
            postures: Postures in which the links touch (k, n).

        Returns:
            The pair; without an overlap if its parts do not touch; None if the bodies overlap so
            far, or so much more often than the parts touch, that it cannot be watched.
        """
        i, k = self._pairs[pair]
        touching = [q for q in postures if self._hulls.touch([pair], q)]
        if not touching:
            return Watched(i, k)

        def score(q: Array) -> float:
            touch = self._touch(links, [pair], q)
            return self._bodies.distances([pair], q)[0] if touch else -np.inf

        best = max(touching, key=lambda q: self._bodies.distances([pair], q)[0])
        overlap = max(round(-climb(self._robot, score, best)[0], 6), _LEAST)
        near = apart + overlap < TOUCH
        share = len(touching) / _CONTACTS
        deep = _DEEP * (self._parts[i][1].radius + self._parts[k][1].radius)
        if near[0] or near.mean() > share + _LOST or overlap > deep:
            return None
        return Watched(i, k, overlap)


def _nearness(space: Space, pairs: Sequence[int], q: Array) -> float:
    """Return minus the least distance of pairs at q (n,) [m]."""
    return -min(space.distances(pairs, q))
