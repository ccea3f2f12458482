"""Collision geometry of a robot: bodies around its links, and the pairs that are kept apart.

It is read from ``NAME.collisions.toml`` beside the URDF, or made from the URDF's own shapes: a
cylinder gets two round ends, any other shape capsules around its parts, and boxes where these are
much smaller. As in an SRDF file some pairs are left out: neighbours, pairs that never meet, and
pairs that are assembled in contact. Those that may meet and are left out all the same are named.
Tools and held objects are further capsules, by the names of their frames.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from itertools import chain, combinations, product
from pathlib import Path
from time import process_time
from typing import Any, ClassVar
from xml.etree import ElementTree

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, InvalidInputError, MissingDependencyError, warn_caller
from iiwa_dnn.files import one_line, read_toml, write_text
from iiwa_dnn.robot.arms import ARMS, robots_folder
from iiwa_dnn.robot.fitting import Body, fit_bodies
from iiwa_dnn.robot.meetings import CLEARANCE, MEETS, SAMPLES, Meetings, Watched, geometry_of
from iiwa_dnn.robot.obstacles import PlacedBox, box_around, extents, turned
from iiwa_dnn.robot.robot import Robot
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


@dataclass(frozen=True)
class LinkCapsule(checks.Checked):
    """A capsule fixed to a link; a sphere where both ends are equal.

    Attributes:
        link: Name of the link's frame.
        a: One end of its axis in that frame [m], (3,).
        b: The other end [m], (3,).
        radius: Radius [m], above 0.
    """

    _checks: ClassVar[checks.Checks] = {
        "a": checks.vector3,
        "b": checks.vector3,
        "radius": checks.positive,
    }
    link: str
    a: Sequence[float]
    b: Sequence[float]
    radius: float

    @property
    def box(self) -> PlacedBox:
        """Its segment as a box."""
        return box_around(self.a, self.b)


@dataclass(frozen=True)
class LinkBox(checks.Checked):
    """A box fixed to a link.

    Attributes:
        link: Name of the link's frame.
        center: Its middle in that frame [m], (3,).
        half_extents: Halves of its edges [m], (3,), above 0.
        rotation: Its axes in that frame as columns, (3, 3).
    """

    _checks: ClassVar[checks.Checks] = {
        "center": checks.vector3,
        "half_extents": extents,
        "rotation": turned,
    }
    link: str
    center: Sequence[float]
    half_extents: Sequence[float]
    rotation: Sequence[Sequence[float]]
    radius: ClassVar[float] = 0.0

    @property
    def box(self) -> PlacedBox:
        """The box itself."""
        return PlacedBox(*map(np.array, (self.center, self.rotation, self.half_extents)))


def _reasons(argument: str, value: Iterable[Any]) -> tuple[tuple[str, str, str], ...]:
    """Return pairs of links with their reasons as tuples; refuse any other value."""
    try:
        return tuple((str(a), str(b), str(why)) for a, b, why in value)
    except (TypeError, ValueError) as error:
        problem = "must have two links and a reason in each entry"
        raise InvalidInputError(argument, problem, value) from error


def _watched(argument: str, value: Iterable[Any]) -> tuple[Watched, ...]:
    """Return numbers of bodies, with overlaps, as pairs; refuse any other value."""
    try:
        return tuple(Watched(int(i), int(k), float(overlap)) for i, k, overlap in value)
    except (TypeError, ValueError) as error:
        problem = "must have two numbers of bodies and an overlap in each entry"
        raise InvalidInputError(argument, problem, value) from error


@dataclass(frozen=True)
class CollisionModel(checks.Checked):
    """Bodies of a robot's links, and the pairs that are kept apart.

    Attributes:
        capsules: The capsules.
        left_out: Pairs of links that are left out, or not watched in whole, each with the reason:
            ``"adjacent"``, ``"never"``, ``"always"``, one that begins with `MEETS`, or a text of
            one's own.
        boxes: Boxes that stand for a link as the first body of a pair.
        watched: The pairs that are kept apart, by the numbers of their bodies: capsules first, then
            boxes. None: all pairs of capsules but those that are left out.
        too_near: Pairs of a tool's capsule and a link's, by their indices, that are within
            `CLEARANCE` in every posture, as at the wrist, and are not kept apart; each with the
            reason: ``"no joint moves it"`` or `TOO_NEAR`.
    """

    _checks: ClassVar[checks.Checks] = {"left_out": _reasons, "watched": _watched}
    capsules: tuple[LinkCapsule, ...]
    left_out: tuple[tuple[str, str, str], ...]
    boxes: tuple[LinkBox, ...] = ()
    watched: tuple[Watched, ...] | None = None
    too_near: tuple[tuple[int, int, str], ...] = ()

    @property
    def unwatched(self) -> tuple[tuple[str, str, str], ...]:
        """Pairs of links and tools that are not kept apart, each with the reason."""
        names = [capsule.link for capsule in self.capsules]
        near = ((names[i], names[k], reason) for i, k, reason in self.too_near)
        return (*self.left_out, *near)

    @property
    def bodies(self) -> tuple[LinkCapsule | LinkBox, ...]:
        """The capsules, then the boxes."""
        return (*self.capsules, *self.boxes)

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
        outward = sorted(range(len(self.capsules)), key=joints.__getitem__)
        every = [
            Watched(i, k)
            for i, k in combinations(outward, 2)
            if frozenset((links[i], links[k])) not in left_out
        ]
        pairs = every if self.watched is None else self.watched
        return [each for each in pairs if joints[each.first] != joints[each.second]]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as a TOML file that `collision_model` reads; lengths in [m]."""
        lines = ["# Collision geometry: links left out, bodies that are kept apart; lengths in [m]"]
        for name, entries in (("left_out", self.left_out), ("watched", self.watched)):
            if entries is not None:
                lines += [f"{name} = [", *(f"  {json.dumps(each)}," for each in entries), "]"]
        for body in self.bodies:
            lines += ["", "[[capsule]]" if isinstance(body, LinkCapsule) else "[[box]]"]
            lines += [f"{key} = {json.dumps(value)}" for key, value in asdict(body).items()]
        write_text(path, "\n".join([*lines, ""]))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> CollisionModel:
        """Read a file as `save` writes it.

        Raises:
            FileError: It cannot be read, or is no such file; the message says why.
        """
        tables = read_toml(path)
        try:
            capsules = tuple(LinkCapsule(**entry) for entry in tables["capsule"])
            boxes = tuple(LinkBox(**entry) for entry in tables.get("box", ()))
            watched = tables.get("watched")
            return cls(capsules, tables["left_out"], boxes=boxes, watched=watched)
        except (KeyError, ValueError, TypeError) as error:
            problem = one_line(error).rpartition("__init__() ")[2]  # of Python's own message
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


@lru_cache(maxsize=32)
def collision_model(robot: Robot) -> CollisionModel:
    """Return the collision geometry of a robot's links (`link_model`) and of its tools.

    Raises:
        InvalidInputError, FileError: As of `link_model`.
    """
    links = link_model(robot)
    tools = [_capsule(*part) for shape in tool_shapes(robot) for part in _bodies(robot, [shape])[0]]
    if not tools:
        return links
    first = len(links.capsules)
    model = replace(links, capsules=(*links.capsules, *tools), watched=None)
    of_tools = [pair for pair in model.pairs(robot) if max(pair[:2]) >= first]
    near = _too_near(robot, coal_geometry(robot, model, of_tools))
    barred = {pair[:2] for pair in near}
    watched = [
        # The tools come before the boxes.
        each._replace(first=each.first + len(tools) * (each.first >= first))
        for each in links.pairs(robot)
    ]
    watched += [pair for pair in of_tools if pair[:2] not in barred]
    return replace(model, watched=tuple(watched), too_near=near)


def _too_near(robot: Robot, geometry: pin.GeometryModel) -> tuple[tuple[int, int, str], ...]:
    """List the pairs of a geometry that are within `CLEARANCE` in every posture, with reasons."""
    data = robot.model.createData()
    scratch = pin.GeometryData(geometry)
    distances = []
    for q in robot.draw(np.random.default_rng(0), TOOL_SAMPLES):
        pin.computeDistances(robot.model, data, geometry, scratch, q)
        distances.append([found.min_distance for found in scratch.distanceResults])
    apart = np.max(distances, axis=0)
    moved = apart - np.min(distances, axis=0) > _STILL
    reasons = np.where(moved, TOO_NEAR, "no joint moves it").tolist()
    pairs = [(pair.first, pair.second) for pair in geometry.collisionPairs]
    return tuple((*pairs[k], reasons[k]) for k in np.flatnonzero(apart <= CLEARANCE))


@lru_cache(maxsize=32)
def link_model(robot: Robot) -> CollisionModel:
    """Read the collision geometry of a robot's links; if it has no file, make it from the URDF.

    No file is written. If making takes longer than `LONG`, a warning says how to keep the result.
    It is made once for all robots that differ in tools and rates alone.

    Raises:
        InvalidInputError: The robot does not come from a file.
        FileError: The file of the geometry is damaged, or a mesh cannot be read.
    """
    file = collision_file(robot)
    if file.exists():
        return CollisionModel.load(file)
    flange = robot.tools[0].flange if robot.tools else robot.tip
    bare = replace(robot, tip=flange, tools=())
    ranges = robot.limits[:2].tobytes()
    return _made(_Arm(robot.path, robot.urdf, robot.locked, robot.q_locked, ranges, flange, bare))


@dataclass(frozen=True)
class _Arm:
    """A robot without tools, equal to any other for which the same geometry is made.

    Attributes:
        path: The URDF file.
        text: Its text.
        locked: Names of the joints that are locked.
        q_locked: Their positions [rad].
        ranges: Bytes of the position limits.
        tip: Name of the tip.
        robot: The robot.
    """

    path: Path | None
    text: str | None
    locked: tuple[str, ...]
    q_locked: tuple[float, ...]
    ranges: bytes
    tip: str
    robot: Robot = field(compare=False)


@lru_cache(maxsize=32)
def _made(arm: _Arm) -> CollisionModel:
    """Make the collision geometry of an arm, and warn if that takes long."""
    robot = arm.robot
    began = process_time()
    model = make_collision_model(robot)
    if (taken := process_time() - began) > LONG:
        warn_caller(
            f"capsules and pairs of {robot.name} took {taken:.1f} s; "
            f"`iiwa-dnn collisions` keeps them beside {robot.path}"
        )
    return model


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
    robot: Robot, samples: int = SAMPLES, srdf: str | os.PathLike[str] | None = None
) -> CollisionModel:
    """Fit bodies to the shapes of a robot's URDF, and search for the pairs that may meet.

    Postures are drawn evenly within the robot's limits, with a fixed seed.

    Args:
        robot: The robot.
        samples: Number of random postures.
        srdf: SRDF file whose disabled pairs are not watched; None: the one beside the URDF, if any.

    Raises:
        InvalidInputError: The robot does not come from a file.
        FileError: A mesh or the SRDF file cannot be read.
    """
    beside = source_of(robot)[0].with_suffix(".srdf")
    file = srdf or (beside if beside.exists() else None)
    shapes = read_shapes(robot, pin.GeometryType.COLLISION).geometryObjects
    return watch(robot, *_bodies(robot, shapes), samples, read_srdf(file) if file else {})


def watch(
    robot: Robot,
    capsules: Sequence[Part],
    boxes: Sequence[Part],
    samples: int,
    disabled: Mapping[frozenset[str], str],
) -> CollisionModel:
    """Search for the pairs of bodies that may meet.

    Args:
        robot: The robot.
        capsules: Capsules around all links.
        boxes: Boxes around some of them.
        samples: Number of random postures.
        disabled: Pairs of links that are not watched, with the reasons.
    """
    parts = [*capsules, *boxes]
    left_out, pairs = _candidates(robot, parts)
    meetings = Meetings(robot, parts, pairs, samples)
    watched, other = meetings.sort(meetings.near(), disabled)
    for each in watched:
        left_out.pop((parts[each.first][0], parts[each.second][0]), None)
    reasons = tuple((*links, why) for links, why in {**left_out, **other}.items())
    used = sorted({each.first for each in watched} - {*range(len(capsules))})
    number = {old: len(capsules) + new for new, old in enumerate(used)}
    return CollisionModel(
        tuple(_capsule(*part) for part in capsules),
        reasons,
        boxes=tuple(_box(*parts[i]) for i in used),
        watched=tuple(each._replace(first=number.get(each.first, each.first)) for each in watched),
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


def _bodies(robot: Robot, shapes: Iterable[pin.GeometryObject]) -> tuple[list[Part], list[Part]]:
    """Fit capsules to the shapes of links and tools, and boxes where they are much smaller."""
    of_links: dict[str, list[tuple[coal.CollisionGeometry, pin.SE3]]] = {}
    for shape in shapes:
        frame = robot.model.frames[shape.parentFrame]
        pose = frame.placement.actInv(shape.placement)
        of_links.setdefault(frame.name, []).append((shape.geometry, pose))
    capsules: list[Part] = []
    boxes: list[Part] = []
    for link, own in of_links.items():
        round_ones, flat_ones = fit_bodies(own)
        boxes += [(link, each) for each in flat_ones]
        capsules += [(link, each) for each in round_ones]
    return capsules, boxes


def _capsule(link: str, body: Body) -> LinkCapsule:
    """Return the capsule of a part, with rounded lengths."""
    a, b = np.round(body.ends, DIGITS).tolist()
    return LinkCapsule(link, a, b, max(round(body.radius, DIGITS), 10.0**-DIGITS))


def _box(link: str, body: Body) -> LinkBox:
    """Return the box of a part, with rounded lengths."""
    center, half = np.round([body.center, body.half_extents], DIGITS).tolist()
    return LinkBox(link, center, half, body.rotation.tolist())


def coal_geometry(
    robot: Robot, model: CollisionModel, pairs: Iterable[tuple[int, int, float]]
) -> pin.GeometryModel:
    """Make Pinocchio's geometry model of the bodies and of pairs of their indices."""
    placed = []
    for body in model.bodies:
        center, rotation, half = body.box
        long = 2.0 * half[2]
        shape = coal.Capsule(body.radius, long) if body.radius else coal.Box(*2.0 * half)
        placed.append((body.link, (shape, pin.SE3(rotation, center))))
    return geometry_of(robot, placed, [pair[:2] for pair in pairs])


def _joint(robot: Robot, link: str) -> int:
    """Return the number of the joint that carries a link."""
    return int(robot.model.frames[robot.frame_id(link)].parentJoint)
