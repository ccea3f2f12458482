"""Collision geometry of a robot: capsules around its links, and the pairs that may meet.

It is read from ``NAME.collisions.toml`` beside the URDF, or made from the URDF's own shapes: a
cylinder gets two round ends, any other body a capsule around it along one of its principal axes.
The files of the named arms have smaller ones, along axes of any direction. As in an SRDF file some
pairs are left out: neighbours, pairs that never meet, and pairs that meet in the start posture
already, as capsules do that overlap in every posture. Tools and held objects are further capsules,
by the names of their frames.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from itertools import chain, combinations, product
from pathlib import Path
from time import perf_counter
from typing import Any, ClassVar

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, InvalidInputError, MissingDependencyError, warn_caller
from iiwa_dnn.files import one_line, read_toml, write_text
from iiwa_dnn.robot.arms import ARMS, robots_folder
from iiwa_dnn.robot.obstacles import box_around
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.robot.shapes import read_shapes, source_of, tool_shapes

SAMPLES = 10_000
"""Random postures in which the distances of the pairs are measured."""

CLEARANCE = 0.02
"""Distance beyond which a pair never meets [m]."""

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


def _reasons(argument: str, value: Iterable[Any]) -> tuple[tuple[str, str, str], ...]:
    """Return pairs of links with their reasons as tuples; refuse any other value."""
    try:
        return tuple((str(a), str(b), str(why)) for a, b, why in value)
    except (TypeError, ValueError) as error:
        problem = "must have two links and a reason in each entry"
        raise InvalidInputError(argument, problem, value) from error


@dataclass(frozen=True)
class CollisionModel(checks.Checked):
    """Capsules of a robot's links, and the pairs of links that are not kept apart.

    Attributes:
        capsules: The capsules.
        left_out: Pairs of links that are left out, each with the reason: ``"adjacent"``,
            ``"never"``, ``"start"`` or a text of one's own.
        too_near: Pairs of a tool's capsule and a link's, by their indices, that are within
            `CLEARANCE` in every posture, as at the wrist, and are not kept apart; each with the
            reason: ``"no joint moves it"`` or `TOO_NEAR`.
    """

    _checks: ClassVar[checks.Checks] = {"left_out": _reasons}
    capsules: tuple[LinkCapsule, ...]
    left_out: tuple[tuple[str, str, str], ...]
    too_near: tuple[tuple[int, int, str], ...] = ()

    @property
    def unwatched(self) -> tuple[tuple[str, str, str], ...]:
        """Pairs of links and tools that are not kept apart, each with the reason."""
        names = [capsule.link for capsule in self.capsules]
        near = ((names[i], names[k], reason) for i, k, reason in self.too_near)
        return (*self.left_out, *near)

    def pairs(self, robot: Robot) -> list[tuple[int, int]]:
        """List the pairs of capsules that are kept apart, by their indices, the inner link first.

        Raises:
            NotFoundError: The robot has no link of a name.
        """
        links = [capsule.link for capsule in self.capsules]
        joints = [_joint(robot, link) for link in links]
        left_out = {frozenset(pair[:2]) for pair in self.left_out}
        too_near = {pair[:2] for pair in self.too_near}
        for link in chain.from_iterable(left_out):
            robot.frame_id(link)
        outward = sorted(range(len(joints)), key=joints.__getitem__)
        return [
            (i, k)
            for i, k in combinations(outward, 2)
            if joints[i] != joints[k]
            and frozenset((links[i], links[k])) not in left_out
            and (i, k) not in too_near
        ]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as a TOML file that `collision_model` reads; lengths in [m]."""
        import tomli_w  # for those who use it

        capsules = [asdict(capsule) for capsule in self.capsules]
        write_text(path, tomli_w.dumps({"left_out": self.left_out, "capsule": capsules}))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> CollisionModel:
        """Read a file as `save` writes it.

        Raises:
            FileError: It cannot be read, or is no such file; the message says why.
        """
        tables = read_toml(path)
        try:
            capsules = tuple(LinkCapsule(**entry) for entry in tables["capsule"])
            return cls(capsules, tables["left_out"])
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
    tools = _capsules(robot, tool_shapes(robot))
    if not tools:
        return links
    model = replace(links, capsules=(*links.capsules, *tools))
    first = len(links.capsules)
    pairs = [pair for pair in model.pairs(robot) if max(pair) >= first]
    return replace(model, too_near=_too_near(robot, coal_geometry(robot, model, pairs)))


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

    No file is written. If making takes more than a second, a warning says how to keep the result.
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
    began = perf_counter()
    model = make_collision_model(robot)
    if (taken := perf_counter() - began) > 1.0:
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
    watched = {_joint(robot, capsule.link) for capsule in link_model(robot).capsules}
    heavy = {joint for joint, body in enumerate(robot.model.inertias) if joint and body.mass > 0.0}
    links = [frame for frame in robot.model.frames if frame.type == pin.FrameType.BODY]
    first = {link.parentJoint: link.name for link in reversed(links)}
    return tuple(first[joint] for joint in sorted(heavy - watched))


def make_collision_model(robot: Robot, samples: int = SAMPLES) -> CollisionModel:
    """Fit the capsules of a robot's URDF and find the pairs that may meet by sampling.

    Postures are drawn evenly within the robot's limits, with a fixed seed.
    """
    shapes = read_shapes(robot, pin.GeometryType.COLLISION).geometryObjects
    whole = CollisionModel(tuple(_capsules(robot, shapes)), ())
    links = [capsule.link for capsule in whole.capsules]
    joints = {link: _joint(robot, link) for link in links}
    pairs = whole.pairs(robot)
    of_links: dict[tuple[str, str], set[int]] = {}
    for number, (i, k) in enumerate(pairs):
        of_links.setdefault((links[i], links[k]), set()).add(number)
    geometry = coal_geometry(robot, whole, pairs)
    near = _near_pairs(robot, geometry, robot.draw(np.random.default_rng(0), samples))
    at_start = _near_pairs(robot, geometry, robot.start_posture()[np.newaxis])
    left_out = []
    for (first, second), numbers in of_links.items():
        if robot.model.parents[joints[second]] == joints[first]:
            left_out.append((first, second, "adjacent"))
        elif not numbers & near:
            left_out.append((first, second, "never"))
        elif numbers & at_start:
            left_out.append((first, second, "start"))
    return CollisionModel(whole.capsules, tuple(left_out))


def _near_pairs(robot: Robot, geometry: pin.GeometryModel, postures: checks.Array) -> set[int]:
    """Number the pairs that come within `CLEARANCE` in any of the postures (k, n)."""
    data = robot.model.createData()
    scratch = pin.GeometryData(geometry)
    for request in scratch.collisionRequests:
        request.security_margin = CLEARANCE
    near: set[int] = set()
    for q in postures:
        if pin.computeCollisions(robot.model, data, geometry, scratch, q):
            for i, result in enumerate(scratch.collisionResults):
                if result.isCollision():
                    near.add(i)
                    scratch.deactivateCollisionPair(i)
    return near


def coal_geometry(
    robot: Robot, model: CollisionModel, pairs: Iterable[tuple[int, int]]
) -> pin.GeometryModel:
    """Make Pinocchio's geometry model of capsules and of pairs of their indices."""
    geometry = pin.GeometryModel()
    for i, capsule in enumerate(model.capsules):
        center, rotation, half = box_around(capsule.a, capsule.b)
        shape = coal.Capsule(capsule.radius, 2.0 * half[2])
        frame = robot.model.frames[robot.frame_id(capsule.link)]
        pose = frame.placement * pin.SE3(rotation, center)
        name = f"{capsule.link}_{i}"
        geometry.addGeometryObject(pin.GeometryObject(name, frame.parentJoint, pose, shape))
    for i, k in pairs:
        geometry.addCollisionPair(pin.CollisionPair(i, k))
    return geometry


def _joint(robot: Robot, link: str) -> int:
    """Return the number of the joint that carries a link."""
    return int(robot.model.frames[robot.frame_id(link)].parentJoint)


def _capsules(robot: Robot, shapes: Iterable[pin.GeometryObject]) -> list[LinkCapsule]:
    """Fit a capsule to each shape of a robot, in the frame of its link.

    Spheres that another capsule of the link holds, such as the ends of a cylinder, are left out.
    """
    found: list[LinkCapsule] = []
    for shape in sorted(shapes, key=lambda each: isinstance(each.geometry, coal.Sphere)):
        frame = robot.model.frames[shape.parentFrame]
        pose = frame.placement.actInv(shape.placement)
        a, b, radius = _fit(shape.geometry)
        fitted = LinkCapsule(frame.name, pose.act(a), pose.act(b), radius)
        if not any(_holds(each, fitted) for each in found):
            found.append(fitted)
    return found


def _holds(capsule: LinkCapsule, sphere: LinkCapsule) -> bool:
    """Test whether a round end of a capsule encloses a sphere of the same link, to 0.03 mm."""
    away = np.linalg.norm(np.subtract(sphere.a, [capsule.a, capsule.b]), axis=1).min()
    return (
        sphere.link == capsule.link
        and sphere.a == sphere.b
        and bool(away + sphere.radius <= capsule.radius + 3e-5)
    )


def _fit(shape: coal.CollisionGeometry) -> tuple[checks.Array, checks.Array, float]:
    """Fit a capsule around a shape in its own frame [m]; return its ends (3,) and its radius."""
    if isinstance(shape, coal.Sphere):
        return np.zeros(3), np.zeros(3), float(shape.radius)
    if isinstance(shape, coal.Cylinder | coal.Capsule):
        half = np.array([0.0, 0.0, shape.halfLength])
        return -half, half, float(shape.radius)
    if hasattr(shape, "vertices"):
        return _enclosing_capsule(np.array(shape.vertices(), dtype=np.float64))
    corners = product(*zip(-shape.halfSide, shape.halfSide, strict=True))
    return _enclosing_capsule(np.array(list(corners)))


def _enclosing_capsule(points: checks.Array) -> tuple[checks.Array, checks.Array, float]:
    """Fit a capsule around points (k, 3) [m], along the principal axis that makes it smallest.

    For an axis and a radius the shortest segment is known in closed form. The ends of a sphere are
    equal.
    """
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    fitted = []
    for axis in np.linalg.svd(points - middle, full_matrices=False)[2]:
        along = (points - middle) @ axis
        across = np.linalg.norm(points - middle - along[:, np.newaxis] * axis, axis=1)
        radius = float(across.max()) + 1e-9
        cap = np.sqrt(radius**2 - across**2)
        low = float((along + cap).min())
        high = float((along - cap).max())
        if low > high:  # any point between them is the middle of a sphere that holds all
            low = high = 0.5 * (low + high)
        volume = radius**2 * (high - low + 4.0 / 3.0 * radius)
        fitted.append((volume, middle + low * axis, middle + high * axis, radius))
    return min(fitted, key=lambda capsule: capsule[0])[1:]
