"""Collision geometry of a robot: capsules around its links, and the pairs that may meet.

It is read from ``NAME.collisions.toml`` beside the URDF, or made from the URDF's own shapes: a
cylinder between two spheres of its radius is a capsule already, anything else gets the smallest
capsule around it. The pairs are those of an SRDF file: left out are neighbours, pairs that never
meet, pairs that nearly always do, and pairs that are as near in the start posture.
"""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError
from iiwa_dnn.files import one_line, read_toml, write_text
from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.robot.loading import robots_folder
from iiwa_dnn.robot.obstacles import Box
from iiwa_dnn.robot.robot import Robot, file_of, urdf_of
from iiwa_dnn.robot.shapes import read_shapes

SAMPLES = 10_000
"""Random postures in which the distances of the pairs are measured."""

CLEARANCE = 0.02
"""Distance beyond which a pair never meets [m]."""

ALWAYS = 0.95
"""Fraction of the postures in which a pair that always meets does so."""


Ball = tuple[float, ...]
"""Middle and radius of a sphere [m], rounded."""


@dataclass(frozen=True)
class LinkCapsule:
    """A capsule fixed to a link; a sphere where both ends are equal.

    Attributes:
        link: Name of the link's frame.
        a: One end of its axis in that frame [m].
        b: The other end [m].
        radius: Radius [m].
    """

    link: str
    a: checks.Vector3
    b: checks.Vector3
    radius: float


@dataclass(frozen=True)
class CollisionModel:
    """Capsules of a robot's links, and the pairs of links that need no watching.

    Attributes:
        capsules: The capsules.
        left_out: Pairs of links that are left out, each with the reason: ``"adjacent"``,
            ``"never"``, ``"always"``, ``"start"`` or a text of one's own.
    """

    capsules: tuple[LinkCapsule, ...]
    left_out: tuple[tuple[str, str, str], ...]

    def pairs(self, robot: Robot) -> list[tuple[int, int]]:
        """List the pairs of capsules that may meet, the one nearer to the base first."""
        joints = [_joint(robot, capsule.link) for capsule in self.capsules]
        left_out = {frozenset(pair[:2]) for pair in self.left_out}
        pairs = []
        for i, k in combinations(sorted(range(len(joints)), key=joints.__getitem__), 2):
            links = frozenset((self.capsules[i].link, self.capsules[k].link))
            if joints[i] != joints[k] and links not in left_out:
                pairs.append((i, k))
        return pairs

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as a TOML file that `collision_model` reads."""
        pairs = "".join(f"  {json.dumps(pair)},\n" for pair in self.left_out)
        text = "# Collision geometry: pairs of links left out, capsules in link frames [m]\n"
        text += f"left_out = [\n{pairs}]\n"
        for capsule in self.capsules:
            radius = round(capsule.radius + 1.4e-6, 6)  # rounding never makes it smaller
            text += f"\n[[capsule]]\nlink = {json.dumps(capsule.link)}\n"
            text += f"a = {_rounded(capsule.a)}\nb = {_rounded(capsule.b)}\nradius = {radius}\n"
        write_text(path, text)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> CollisionModel:
        """Read a model that `save` wrote or a person did.

        Raises:
            FileError: It cannot be read, or is no such file; the message says why.
        """
        tables = read_toml(path)
        try:
            capsules = [
                LinkCapsule(
                    str(entry["link"]),
                    checks.vector3("a", entry["a"]),
                    checks.vector3("b", entry["b"]),
                    checks.positive("radius", entry["radius"]),
                )
                for entry in tables["capsule"]
            ]
            pairs = tuple((str(a), str(b), str(why)) for a, b, why in tables["left_out"])
            return cls(tuple(capsules), pairs)
        except KeyError as error:
            raise FileError(path, f"lacks the key {one_line(error)}") from error
        except (ValueError, TypeError) as error:
            raise FileError(path, f"no collision geometry: {one_line(error)}") from error


def collision_file(robot: Robot) -> Path:
    """Return the file that the collision geometry of a robot is kept in; it need not exist."""
    path = file_of(robot)
    if robot.name in ARMS and ARMS[robot.name].path == path:
        # The package's own file: the arm's folder is somebody else's.
        return robots_folder() / robot.name / f"{robot.name}.collisions.toml"
    return path.with_suffix(".collisions.toml")


@lru_cache(maxsize=32)
def collision_model(robot: Robot) -> CollisionModel:
    """Read the collision geometry of a robot, or make it where it has no file; none is written.

    Raises:
        InvalidInputError: The robot does not come from a file.
        FileError: The file of the geometry is damaged, or a mesh cannot be read.
        NotFoundError: The file names a link that the robot does not have.
    """
    path = collision_file(robot)
    model = CollisionModel.load(path) if path.exists() else make_collision_model(robot)
    for capsule in model.capsules:
        robot.frame_id(capsule.link)
    return model


@lru_cache(maxsize=32)
def unwatched_links(robot: Robot) -> tuple[str, ...]:
    """Name the moving links that have a body but no collision geometry: no row watches them.

    A link has a body if it is drawn and not held by a capsule of the same joint. If the file draws
    no link at all, a link with a mass has a body, unless its joint carries a capsule.

    Raises:
        InvalidInputError, FileError, NotFoundError: As of `collision_model`.
    """
    capsules = collision_model(robot).capsules
    watched = {capsule.link for capsule in capsules}
    root = ET.fromstring(robot.urdf or "<robot/>")
    drawn = root.find("link/visual") is not None
    bare = {}
    for link in root.findall("link"):
        name = link.get("name", "")
        if name not in watched and _joint(robot, name):
            bare[name] = link
        else:
            _drop_visuals(link)  # meshes that need not be read
    if drawn:
        return _not_held(robot, capsules, bare, urdf.text_of(root))
    joints = {_joint(robot, name) for name in watched}
    masses = {name: link.find("inertial/mass[@value]") for name, link in bare.items()}
    return tuple(
        name
        for name, mass in masses.items()
        if mass is not None and float(mass.attrib["value"]) and _joint(robot, name) not in joints
    )


def _drop_visuals(link: ET.Element) -> None:
    for visual in link.findall("visual"):
        link.remove(visual)


def _not_held(
    robot: Robot, capsules: Iterable[LinkCapsule], links: Mapping[str, ET.Element], text: str
) -> tuple[str, ...]:
    """Select the links that are drawn, in a URDF's text, outside of the capsules of their joint."""
    try:
        shapes = read_shapes(robot, pin.GeometryType.VISUAL, text)
    except ValueError:  # a mesh that cannot be read is a body
        return tuple(name for name, link in links.items() if link.find("visual") is not None)
    frames = robot.model.frames
    outside = [
        frames[shape.parentFrame].name
        for shape in shapes
        if not any(_holds(frames[robot.frame_id(each.link)], each, shape) for each in capsules)
    ]
    return tuple(dict.fromkeys(outside))


def _holds(frame: pin.Frame, capsule: LinkCapsule, shape: pin.GeometryObject) -> bool:
    """Test whether a shape lies in a capsule of a link's frame, both fixed to the same joint."""
    if frame.parentJoint != shape.parentJoint:
        return False
    shape.geometry.computeLocalAABB()
    pose = frame.placement.actInv(shape.placement)
    a = np.array(capsule.a)
    axis = np.array(capsule.b) - a
    points = _corners(shape.geometry) @ pose.rotation.T + pose.translation - a
    along = np.clip(points @ axis / max(float(axis @ axis), 1e-12), 0.0, 1.0)
    away = np.linalg.norm(points - along[:, np.newaxis] * axis, axis=1)
    return bool((away <= capsule.radius + 1e-6).all())


def make_collision_model(robot: Robot, samples: int = SAMPLES) -> CollisionModel:
    """Fit the capsules of a robot's URDF and find the pairs that may meet by sampling.

    Postures are drawn uniformly within the URDF's limits, with a fixed seed.
    """
    whole = CollisionModel(tuple(_capsules(robot)), ())
    pairs = whole.pairs(robot)
    model = robot.model
    lower = np.maximum(model.lowerPositionLimit, -np.pi)
    upper = np.minimum(model.upperPositionLimit, np.pi)
    postures = np.random.default_rng(0).uniform(lower, upper, (samples, robot.dof))
    distances = _distances(robot, whole, pairs, np.vstack([robot.start_posture(), postures]))
    columns: dict[tuple[str, str], list[int]] = {}
    for column, (i, k) in enumerate(pairs):
        links = (whole.capsules[i].link, whole.capsules[k].link)
        columns.setdefault(links, []).append(column)
    left_out = []
    for (first, second), chosen in columns.items():
        at_start, *nearest = distances[:, chosen].min(axis=1)
        reason = ""
        if model.parents[_joint(robot, second)] == _joint(robot, first):
            reason = "adjacent"
        elif min(nearest) > CLEARANCE:
            reason = "never"
        elif (np.array(nearest) <= 0.0).mean() >= ALWAYS:
            reason = "always"
        elif at_start <= CLEARANCE:
            reason = "start"
        if reason:
            left_out.append((first, second, reason))
    return CollisionModel(whole.capsules, tuple(left_out))


def _distances(
    robot: Robot, model: CollisionModel, pairs: list[tuple[int, int]], postures: checks.Array
) -> checks.Array:
    """Compute the distance of each pair [m] in each posture (k, n) by coal, (k, pairs)."""
    geometry = coal_geometry(robot, model, pairs)
    data = robot.model.createData()
    scratch = pin.GeometryData(geometry)
    distances = np.empty((len(postures), len(pairs)))
    for row, q in zip(distances, postures, strict=True):
        pin.computeDistances(robot.model, data, geometry, scratch, q)
        row[:] = [result.min_distance for result in scratch.distanceResults]
    return distances


def coal_geometry(
    robot: Robot, model: CollisionModel, pairs: Iterable[tuple[int, int]]
) -> pin.GeometryModel:
    """Describe capsules and pairs to coal, for `pinocchio.computeDistances`."""
    geometry = pin.GeometryModel()
    for i, capsule in enumerate(model.capsules):
        a = np.array(capsule.a)
        b = np.array(capsule.b)
        length = float(np.linalg.norm(b - a))
        shape = coal.Capsule(capsule.radius, length) if length else coal.Sphere(capsule.radius)
        turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), b - a).matrix()
        frame = robot.model.frames[robot.frame_id(capsule.link)]
        pose = frame.placement * pin.SE3(turn if length else np.eye(3), 0.5 * (a + b))
        name = f"{capsule.link}_{i}"
        geometry.addGeometryObject(pin.GeometryObject(name, frame.parentJoint, pose, shape))
    for i, k in pairs:
        geometry.addCollisionPair(pin.CollisionPair(i, k))
    return geometry


def _joint(robot: Robot, link: str) -> int:
    return int(robot.model.frames[robot.frame_id(link)].parentJoint)


def _capsules(robot: Robot) -> Iterator[LinkCapsule]:
    """Fit capsules to the <collision> shapes of the URDF, in the frames of their links."""
    try:
        shapes = read_shapes(robot, pin.GeometryType.COLLISION, urdf_of(robot))
    except ValueError as error:
        problem = f"a shape cannot be read: {one_line(error)}"
        hint = "; ROS_PACKAGE_PATH names the folder of its packages" * ("package://" in problem)
        raise FileError(file_of(robot), problem + hint) from error
    by_link: dict[int, list[pin.GeometryObject]] = {}
    for shape in shapes:
        by_link.setdefault(shape.parentFrame, []).append(shape)
    for index, of_link in by_link.items():
        frame = robot.model.frames[index]
        placed = [(frame.placement.actInv(each.placement), each.geometry) for each in of_link]
        found = [(pose, body.radius) for pose, body in placed if isinstance(body, coal.Sphere)]
        spheres = {(*pose.translation.round(5).tolist(), round(r, 6)) for pose, r in found}
        bodies = [(pose, body) for pose, body in placed if not isinstance(body, coal.Sphere)]
        for a, b, radius in _link_capsules(bodies, spheres):
            yield LinkCapsule(frame.name, checks.vector3("a", a), checks.vector3("b", b), radius)


def _link_capsules(
    bodies: list[tuple[pin.SE3, coal.CollisionGeometry]], spheres: set[Ball]
) -> Iterator[tuple[checks.Array, checks.Array, float]]:
    """Fit capsules (end, end, radius) to the spheres of a link and its other bodies.

    A cylinder between two of the spheres is a capsule, the other spheres are capsules of no
    length, and one capsule holds all other bodies.
    """
    alone = set(spheres)
    points = []
    for pose, body in bodies:
        half = body.halfLength if isinstance(body, coal.Cylinder) else 0.0
        ends = [pose.act(np.array([0.0, 0.0, z])) for z in (-half, half)]
        caps = [_spheres_at(end, body.radius, spheres) for end in ends] if half else [set()]
        if all(caps):
            alone -= caps[0] | caps[1]
            yield ends[0], ends[1], float(body.radius)
        else:
            points.append(_corners(body) @ pose.rotation.T + pose.translation)
    if points:
        yield _enclosing_capsule(np.vstack(points))
    for *middle, radius in sorted(alone):
        yield np.array(middle), np.array(middle), radius


def _spheres_at(point: checks.Array, radius: float, spheres: set[Ball]) -> set[Ball]:
    """Select the spheres of a radius about a point [m]."""
    return {ball for ball in spheres if np.allclose((*point, radius), ball, atol=3e-5)}


def _enclosing_capsule(points: checks.Array) -> tuple[checks.Array, checks.Array, float]:
    """Fit a capsule of small volume around points (k, 3) [m]; return its ends and its radius.

    The axis begins along each principal direction in turn and is then moved by Nelder and Mead's
    simplex method; for an axis and a radius the shortest segment is known in closed form, so the
    capsule holds all points whatever the method reached. The ends of a sphere are equal.
    """
    from scipy.optimize import minimize  # slow to import

    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    axes = np.linalg.svd(points - middle, full_matrices=False)[2]

    def volume(x: checks.Array) -> float:
        a, b, radius = _capsule_along(points, x)
        return float(np.pi * radius**2 * (np.linalg.norm(b - a) + 4.0 / 3.0 * radius))

    found = []
    for axis in axes:
        start = np.concatenate([middle, axis, [1.0]])
        scale = np.array([0.01, 0.01, 0.01, 0.1, 0.1, 0.1, 0.02])
        simplex = np.vstack([start, start + np.diag(scale)])
        options = {"initial_simplex": simplex, "maxfev": 4000, "xatol": 1e-6, "fatol": 1e-9}
        found.append(minimize(volume, start, (), "Nelder-Mead", options=options))
    best = min(found, key=lambda result: float(result.fun))
    return _capsule_along(points, best.x)


def _capsule_along(
    points: checks.Array, x: checks.Array
) -> tuple[checks.Array, checks.Array, float]:
    """Capsule along an axis: x holds a point, a direction and the radius over the least one."""
    origin = x[:3]
    axis = x[3:6] / np.linalg.norm(x[3:6])
    along = (points - origin) @ axis
    across = np.linalg.norm(points - origin - along[:, np.newaxis] * axis, axis=1)
    radius = float(across.max() * max(x[6], 1.0)) + 1e-9
    cap = np.sqrt(radius**2 - across**2)
    low = float((along + cap).min())
    high = float((along - cap).max())
    if low > high:  # any point between them is the middle of a sphere that holds all
        low = high = 0.5 * (low + high)
    return origin + low * axis, origin + high * axis, radius


def _corners(shape: coal.CollisionGeometry) -> checks.Array:
    """List points whose convex hull holds a shape, (k, 3) [m]."""
    if isinstance(shape, coal.Cylinder):
        turns = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
        rim = shape.radius / np.cos(np.pi / 64) * np.column_stack([np.cos(turns), np.sin(turns)])
        heights = np.repeat([-shape.halfLength, shape.halfLength], 64)[:, np.newaxis]
        return np.hstack([np.vstack([rim, rim]), heights])
    if isinstance(shape, coal.Capsule):
        return _corners(coal.Cylinder(shape.radius, 2.0 * (shape.halfLength + shape.radius)))
    if hasattr(shape, "vertices"):
        return np.array(shape.vertices(), dtype=np.float64)
    half = shape.halfSide if isinstance(shape, coal.Box) else [shape.aabb_radius] * 3
    return Box(center=(0.0, 0.0, 0.0), half_extents=tuple(half)).points


def _rounded(point: checks.Vector3) -> list[float]:
    """Round to micrometers."""
    return [round(x, 6) + 0.0 for x in point]  # no -0.0
