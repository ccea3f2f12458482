"""Collision geometry of a robot: bodies around its links, and the pairs that are kept apart.

It is read from ``NAME.collisions.toml`` beside the URDF, or made from the URDF's own shapes: a
cylinder gets two round ends, any other shape capsules around its parts, and boxes where these are
much smaller. As in an SRDF file some pairs are left out: neighbours, pairs that never meet, and
pairs that are assembled in contact. Those that may meet and are left out all the same are named.
Tools and held objects are further capsules, by the names of their frames.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import chain, combinations, compress, product
from pathlib import Path
from time import process_time
from typing import Any, ClassVar, NamedTuple
from xml.etree import ElementTree

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, InvalidInputError, MissingDependencyError, warn_caller
from iiwa_dnn.files import one_line, read_toml, write_text
from iiwa_dnn.robot.arms import ARMS, robots_folder
from iiwa_dnn.robot.fitting import Body, fit_bodies
from iiwa_dnn.robot.meetings import CLEARANCE, MEETS, SAMPLES, Meetings, Space, Watched, geometry_of
from iiwa_dnn.robot.obstacles import Box, Capsule
from iiwa_dnn.robot.robot import Robot, model_limits
from iiwa_dnn.robot.shapes import read_shapes, source_of, tool_shapes

Part = tuple[str, Body]
"""A body in the frame of a link, whose name comes first."""

LONG = 2.0
"""Time of making a geometry above which a warning says how to keep it [s]."""

DIGITS = 6
"""Digits of lengths behind the point, in [m]."""

TOOL_SAMPLES = 300
"""Random postures in which the distances of tools from links are measured."""

TOO_NEAR = "near in every posture"

_STILL = 1e-6
"""Change of a distance over those postures up to which no joint moves a pair [m]."""

_made: dict[tuple[object, ...], CollisionModel] = {}
"""Models that were made, by all that they depend on."""


class LinkBody(NamedTuple):
    """A capsule or a box fixed to a link.

    Attributes:
        link: Name of the link's frame.
        shape: The shape in that frame; a capsule is a sphere where both ends are equal.
    """

    link: str
    shape: Capsule | Box


def _body_of(kind: type[Capsule | Box], *, link: str, **parameters: Any) -> LinkBody:
    """Return a body out of its table in a file."""
    return LinkBody(link, kind(**parameters))


def _entries(
    argument: str, value: Iterable[Any], make: Callable[..., tuple[Any, ...]], words: str
) -> tuple[Any, ...]:
    """Make a tuple of the entries of a list; refuse any other value in words for an entry."""
    try:
        return tuple(make(*entry) for entry in value)
    except (TypeError, ValueError) as error:
        raise InvalidInputError(argument, f"must have {words} in each entry", value) from error


def _left_out(a: object, b: object, reason: object) -> tuple[str, str, str]:
    return str(a), str(b), str(reason)


def _watched(first: Any, second: Any, overlap: Any) -> Watched:
    return Watched(int(first), int(second), float(overlap))


@dataclass(frozen=True)
class CollisionModel(checks.Checked):
    """Bodies of a robot's links, and the pairs that are kept apart.

    Attributes:
        bodies: Capsules of the links, then boxes that stand for a link as the first body of a pair,
            then capsules of tools.
        left_out: Pairs of links or tools that are left out, or not watched in whole, each with the
            reason: ``"adjacent"``, ``"never"``, ``"always"``, one that begins with `MEETS`,
            `TOO_NEAR` or ``"no joint moves it"`` of a tool, or a text of one's own.
        watched: The pairs that are kept apart, by the numbers of their bodies. None: all pairs of
            capsules but those that are left out.
        source: Digest of the URDF that all this is of (`digest_of`); "": not known.
    """

    _checks: ClassVar[checks.Checks] = {
        "left_out": partial(_entries, make=_left_out, words="two links and a reason"),
        "watched": partial(_entries, make=_watched, words="two numbers of bodies and an overlap"),
    }
    bodies: tuple[LinkBody, ...]
    left_out: tuple[tuple[str, str, str], ...]
    watched: tuple[Watched, ...] | None = None
    source: str = ""

    @property
    def capsules(self) -> tuple[LinkBody, ...]:
        """The capsules."""
        return tuple(each for each in self.bodies if isinstance(each.shape, Capsule))

    @property
    def unguarded(self) -> list[tuple[str, str]]:
        """Pairs of links that may meet and are not watched, or not in whole."""
        return [(a, b) for a, b, why in self.left_out if why.startswith(MEETS)]

    def pairs(self, robot: Robot) -> list[Watched]:
        """List the pairs that are kept apart, the inner link first.

        Raises:
            NotFoundError: The robot has no link of a name.
        """
        links = [body.link for body in self.bodies]
        joints = [_joint(robot, link) for link in links]
        left_out = {frozenset(pair[:2]) for pair in self.left_out}
        for link in chain.from_iterable(left_out):
            robot.frame_id(link)
        capsules = [k for k, each in enumerate(self.bodies) if isinstance(each.shape, Capsule)]
        every = [
            Watched(i, k)
            for i, k in combinations(sorted(capsules, key=joints.__getitem__), 2)
            if frozenset((links[i], links[k])) not in left_out
        ]
        pairs = every if self.watched is None else self.watched
        return [each for each in pairs if joints[each.first] != joints[each.second]]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as a TOML file that `collision_model` reads; lengths in [m]."""
        lines = ["# Collision geometry: links left out, bodies that are kept apart; lengths in [m]"]
        lines += [f"source = {json.dumps(self.source)}"] if self.source else []
        for name, entries in (("left_out", self.left_out), ("watched", self.watched)):
            if entries is not None:
                lines += [f"{name} = [", *(f"  {json.dumps(each)}," for each in entries), "]"]
        for link, shape in self.bodies:
            values = {"link": link} | shape.settings()
            lines += ["", f"[[{values.pop('shape').lower()}]]"]
            values.pop("velocity")
            lines += [f"{key} = {json.dumps(value)}" for key, value in values.items()]
        write_text(path, "\n".join([*lines, ""]))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> CollisionModel:
        """Read a file as `save` writes it.

        Raises:
            FileError: It cannot be read, or is no such file; the message says why.
        """
        tables = read_toml(path)
        try:
            bodies = [_body_of(Capsule, **entry) for entry in tables["capsule"]]
            bodies += [_body_of(Box, **entry) for entry in tables.get("box", ())]
            pairs = tables["left_out"], tables.get("watched")
            return cls(tuple(bodies), *pairs, tables.get("source", ""))
        except (KeyError, ValueError, TypeError) as error:
            problem = one_line(error).rpartition("() ")[2]  # of Python's own message
            raise FileError(path, f"no collision geometry: {problem}") from error


def collision_file(robot: Robot) -> Path:
    """Return the path of a robot's collision geometry; the file need not exist.

    Raises:
        InvalidInputError: The robot does not come from a file.
    """
    path = source_of(robot)[0]
    with suppress(KeyError, MissingDependencyError):
        if ARMS[robot.name].path == path:
            path = robots_folder() / robot.name / robot.name  # the arm's may be somebody else's
    return path.with_suffix(".collisions.toml")


def digest_of(robot: Robot) -> str:
    """Return the digest of a robot's URDF."""
    return hashlib.sha256(str(robot.urdf).encode()).hexdigest()[:16]


@lru_cache(maxsize=32)
def collision_model(robot: Robot) -> CollisionModel:
    """Return the collision geometry of a robot's links (`link_model`) and of its tools.

    Raises:
        InvalidInputError, FileError: As of `link_model`.
    """
    links = link_model(robot)
    parts = [part for shape in tool_shapes(robot) for part in _fitted(robot, [shape])]
    if not parts:
        return links
    bodies = (*links.bodies, *(_body(*part) for part in parts if part[1].radius))
    model = replace(links, bodies=bodies, watched=None)
    pairs = [pair for pair in model.pairs(robot) if max(pair[:2]) >= len(links.bodies)]
    space = Space(robot, coal_geometry(robot, model, pairs))
    draws = robot.draw(np.random.default_rng(0), TOOL_SAMPLES)
    apart = np.array([space.distances(range(len(pairs)), q) for q in draws])
    is_near = apart.max(axis=0) <= CLEARANCE
    reasons = np.where(np.ptp(apart, axis=0) > _STILL, TOO_NEAR, "no joint moves it").tolist()
    near = [
        (bodies[pairs[at].first].link, bodies[pairs[at].second].link, reasons[at])
        for at in np.flatnonzero(is_near)
    ]
    watched = (*links.pairs(robot), *compress(pairs, ~is_near))
    return replace(model, left_out=(*links.left_out, *near), watched=watched)


@lru_cache(maxsize=32)
def link_model(robot: Robot) -> CollisionModel:
    """Read the collision geometry of a robot's links; if it has no file, make it from the URDF.

    If a position limit is beyond the URDF's, within which pairs of a file never meet, the file has
    the bodies alone. A warning tells of one that was made of another URDF. No file is written. If
    making takes longer than `LONG`, a warning says how to keep the result. It is made once for all
    robots that differ in tools and rates alone.

    Raises:
        InvalidInputError: The robot does not come from a file.
        FileError: The file of the geometry is damaged, or a mesh cannot be read.
    """
    file = collision_file(robot)
    least, most = model_limits(robot.model)[:2]
    is_within = bool((robot.q_lower >= least).all() and (robot.q_upper <= most).all())
    kept = CollisionModel.load(file) if file.exists() else None
    if kept and kept.source not in ("", digest_of(robot)):
        warn_caller(f"{file} was made of another {robot.path}: remove it, and make it anew")
    if kept and is_within:
        return kept
    flange = robot.tools[0].flange if robot.tools else robot.tip
    ranges = robot.limits[:2].tobytes()
    arm = (robot.path, robot.urdf, robot.locked, robot.q_locked, ranges, flange)
    if arm not in _made:
        began = process_time()
        bodies = kept.bodies if kept else ()
        _made[arm] = make_collision_model(replace(robot, tip=flange, tools=()), bodies=bodies)
        if (taken := process_time() - began) > LONG:
            remedy = f"`iiwa-dnn collisions` keeps them beside {robot.path}"
            if kept:
                remedy = f"position limits are beyond the URDF's, for which {file} is"
            warn_caller(f"capsules and pairs of {robot.name} took {taken:.1f} s; {remedy}")
    return _made[arm]


@lru_cache(maxsize=32)
def unwatched_links(robot: Robot) -> tuple[str, ...]:
    """Name the first link of each joint that carries mass but no capsule: no row keeps it clear.

    Raises:
        InvalidInputError, FileError, NotFoundError: As of `link_model`.
    """
    watched = {_joint(robot, body.link) for body in link_model(robot).bodies}
    heavy = {joint for joint, body in enumerate(robot.model.inertias) if joint and body.mass > 0.0}
    links = [frame for frame in robot.model.frames if frame.type == pin.FrameType.BODY]
    first = {link.parentJoint: link.name for link in reversed(links)}
    return tuple(first[joint] for joint in sorted(heavy - watched))


def read_srdf(path: str | os.PathLike[str]) -> dict[frozenset[str], str]:
    """Read the pairs of links that an SRDF file disables, each with its reason.

    Raises:
        FileError: It cannot be read.
    """
    try:
        found = ElementTree.parse(path).iter("disable_collisions")
    except (OSError, ElementTree.ParseError) as error:
        raise FileError(path, one_line(error)) from error
    return {
        frozenset((each.get("link1", ""), each.get("link2", ""))): each.get("reason", "disabled")
        for each in found
    }


def make_collision_model(
    robot: Robot,
    samples: int = SAMPLES,
    srdf: str | os.PathLike[str] | None = None,
    bodies: Sequence[LinkBody] = (),
) -> CollisionModel:
    """Fit bodies to the shapes of a robot's URDF, and search for the pairs that may meet.

    Postures are drawn evenly within the robot's limits, with a fixed seed.

    Args:
        robot: The robot.
        samples: Number of random postures.
        srdf: SRDF file whose disabled pairs are not watched; None: the one beside the URDF, if any.
        bodies: Bodies in place of fitted ones.

    Raises:
        InvalidInputError: The robot does not come from a file.
        FileError: A mesh or the SRDF file cannot be read.
    """
    beside = source_of(robot)[0].with_suffix(".srdf")
    file = srdf or (beside if beside.exists() else None)
    parts = [*map(_part, bodies)]
    if not parts:
        parts = _fitted(robot, read_shapes(robot, pin.GeometryType.COLLISION).geometryObjects)
    left_out, pairs = _candidates(robot, parts)
    meetings = Meetings(robot, parts, pairs, samples)
    watched, other = meetings.sort(read_srdf(file) if file else {})
    for each in watched:
        left_out.pop((parts[each.first][0], parts[each.second][0]), None)
    first_ones = {each.first for each in watched}
    used = [k for k, (_, body) in enumerate(parts) if body.radius or k in first_ones]
    return CollisionModel(
        tuple(_body(*parts[k]) for k in used),
        tuple((*links, why) for links, why in {**left_out, **other}.items()),
        tuple(each._replace(first=used.index(each.first)) for each in watched),
    )


def _candidates(
    robot: Robot, parts: Sequence[Part]
) -> tuple[dict[tuple[str, str], str], list[tuple[int, int]]]:
    """Pair each body of a link, its boxes if it has any, with the capsules of links further out.

    Returns:
        The pairs of links, each with the reason to leave it out if it never comes near; and the
        pairs of bodies, without those of neighbours.
    """
    joints = [_joint(robot, link) for link, _ in parts]
    boxed = {link for link, body in parts if not body.radius}
    inner = [i for i, (link, body) in enumerate(parts) if link not in boxed or not body.radius]
    outer = [k for k, (_, body) in enumerate(parts) if body.radius]
    left_out = {}
    pairs = []
    for i, k in product(inner, outer):
        if joints[i] < joints[k]:
            is_adjacent = robot.model.parents[joints[k]] == joints[i]
            left_out[parts[i][0], parts[k][0]] = "adjacent" if is_adjacent else "never"
            pairs += [] if is_adjacent else [(i, k)]
    return left_out, pairs


def _fitted(robot: Robot, shapes: Iterable[pin.GeometryObject]) -> list[Part]:
    """Fit capsules to the shapes of links and tools; and boxes, the last ones, that pay."""
    of_links: dict[str, list[tuple[coal.CollisionGeometry, pin.SE3]]] = {}
    for shape in shapes:
        frame = robot.model.frames[shape.parentFrame]
        pose = frame.placement.actInv(shape.placement)
        of_links.setdefault(frame.name, []).append((shape.geometry, pose))
    parts = [(link, body) for link, own in of_links.items() for body in fit_bodies(own)]
    return sorted(parts, key=lambda part: not part[1].radius)


def _part(own: LinkBody) -> Part:
    """Return the part of a body, which itself stands for the hull of the shape."""
    radius = own.shape.radius if isinstance(own.shape, Capsule) else 0.0
    return own.link, Body(own.shape.box, radius, own.shape.box.center[np.newaxis])


def _body(link: str, body: Body) -> LinkBody:
    """Return the body of a part, with rounded lengths."""
    if body.radius:
        a, b = np.round(body.ends, DIGITS).tolist()
        return LinkBody(link, Capsule(a, b, max(round(body.radius, DIGITS), 10.0**-DIGITS)))
    center, half = np.round([body.box.center, body.box.half_extents], DIGITS).tolist()
    return LinkBody(link, Box(center, half, body.box.rotation.tolist()))


def coal_geometry(
    robot: Robot, model: CollisionModel, pairs: Iterable[tuple[int, int, float]]
) -> pin.GeometryModel:
    """Make Pinocchio's geometry model of the bodies and of pairs of their indices."""
    placed = [(link, shape.box.grown(shape.thickness)) for link, shape in model.bodies]
    return geometry_of(robot, placed, [pair[:2] for pair in pairs])


def _joint(robot: Robot, link: str) -> int:
    """Return the number of the joint that carries a link."""
    return int(robot.model.frames[robot.frame_id(link)].parentJoint)
