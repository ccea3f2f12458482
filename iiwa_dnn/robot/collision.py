"""Collision geometry of a robot: capsules around its links, and the pairs that may meet.

It is read from ``NAME.collisions.toml`` beside the URDF, or made from the URDF's own shapes: a
cylinder between two spheres of its radius is a capsule already, anything else gets the smallest
capsule around it. The pairs are those of an SRDF file: left out are neighbours, pairs that never
meet, pairs that nearly always do, and pairs that are as near in the start posture.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.checks import Array
from iiwa_dnn.errors import FileError
from iiwa_dnn.files import one_line, read_toml, write_text
from iiwa_dnn.robot import urdf
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.robot.loading import robots_folder
from iiwa_dnn.robot.robot import Robot, file_of, tree_of

SAMPLES, CLEARANCE, ALWAYS = 10_000, 0.02, 0.95
"""Random postures; distance that a pair never meets beyond [m]; share of one that always does."""


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
        order = sorted(range(len(joints)), key=joints.__getitem__)
        return [
            (i, k)
            for i, k in combinations(order, 2)
            if joints[i] != joints[k]
            and frozenset((self.capsules[i].link, self.capsules[k].link)) not in left_out
        ]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the model as a TOML file that `collision_model` reads."""
        pairs = "".join(f"  {json.dumps(pair)},\n" for pair in self.left_out)
        text = "# Collision geometry: pairs of links left out, capsules in link frames [m]\n"
        text += f"left_out = [\n{pairs}]\n"
        for c in self.capsules:
            a, b = ([round(x, 6) + 0.0 for x in end] for end in (c.a, c.b))  # no -0.0
            radius = round(c.radius + 1.4e-6, 6)  # rounding never makes it smaller
            text += f"\n[[capsule]]\nlink = {json.dumps(c.link)}\n"
            text += f"a = {a}\nb = {b}\nradius = {radius}\n"
        write_text(path, text)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> CollisionModel:
        """Read a model that `save` wrote or a person did.

        Raises:
            FileError: It cannot be read, or is no such file; the message says why.
        """
        tables = read_toml(path)
        try:
            capsules = tuple(
                LinkCapsule(
                    str(entry["link"]), checks.vector3("a", entry["a"]),
                    checks.vector3("b", entry["b"]), checks.positive("radius", entry["radius"]),
                )
                for entry in tables["capsule"]
            )  # fmt: skip
            pairs = tuple((str(a), str(b), str(why)) for a, b, why in tables["left_out"])
            return cls(capsules, pairs)
        except KeyError as error:
            raise FileError(path, f"lacks the key {one_line(error)}") from error
        except (ValueError, TypeError) as error:
            raise FileError(path, f"no collision geometry: {one_line(error)}") from error


def collision_file(robot: Robot) -> Path:
    """Return the file that the collision geometry of a robot is kept in; it need not exist."""
    path = file_of(robot)
    known = robot.name in ARMS and ARMS[robot.name].path == path
    if known:  # the package's own file: the arm's folder is somebody else's
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


def make_collision_model(robot: Robot, samples: int = SAMPLES) -> CollisionModel:
    """Fit the capsules of a robot's URDF and find the pairs that may meet by sampling.

    Postures are drawn uniformly within the URDF's limits, with a fixed seed.
    """
    capsules = tuple(_capsules(robot))
    everything = CollisionModel(capsules, ())
    pairs = everything.pairs(robot)
    geometry = coal_geometry(robot, everything, pairs)
    data, scratch = robot.model.createData(), pin.GeometryData(geometry)

    def measured(q: Array) -> list[float]:
        pin.computeDistances(robot.model, data, geometry, scratch, q)
        return [result.min_distance for result in scratch.distanceResults]

    model = robot.model
    lower = np.maximum(model.lowerPositionLimit, -np.pi)
    upper = np.minimum(model.upperPositionLimit, np.pi)
    postures = np.random.default_rng(0).uniform(lower, upper, (samples, robot.dof))
    distances = np.array([measured(q) for q in postures]).reshape(samples, len(pairs))
    at_start = measured(robot.start_posture())
    links: dict[tuple[str, str], list[int]] = {}
    for index, (i, k) in enumerate(pairs):
        links.setdefault((capsules[i].link, capsules[k].link), []).append(index)
    left_out = []
    for (first, second), columns in links.items():
        joints = [_joint(robot, name) for name in (first, second)]
        nearest = distances[:, columns].min(axis=1)
        if robot.model.parents[joints[1]] == joints[0]:
            left_out.append((first, second, "adjacent"))
        elif nearest.min() > CLEARANCE:
            left_out.append((first, second, "never"))
        elif (nearest <= 0.0).mean() >= ALWAYS:
            left_out.append((first, second, "always"))
        elif min(at_start[column] for column in columns) <= CLEARANCE:
            left_out.append((first, second, "start"))
    return CollisionModel(capsules, tuple(left_out))


def coal_geometry(
    robot: Robot, model: CollisionModel, pairs: Iterable[tuple[int, int]]
) -> pin.GeometryModel:
    """Describe capsules and pairs to coal, for `pinocchio.computeDistances`."""
    geometry = pin.GeometryModel()
    for i, capsule in enumerate(model.capsules):
        a, b = np.array(capsule.a), np.array(capsule.b)
        length, frame = (
            float(np.linalg.norm(b - a)),
            robot.model.frames[robot.frame_id(capsule.link)],
        )
        shape = coal.Capsule(capsule.radius, length) if length else coal.Sphere(capsule.radius)
        turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), b - a).matrix()
        place = frame.placement * pin.SE3(turn if length else np.eye(3), 0.5 * (a + b))
        name = f"{capsule.link}_{i}"
        geometry.addGeometryObject(pin.GeometryObject(name, frame.parentJoint, place, shape))
    for i, k in pairs:
        geometry.addCollisionPair(pin.CollisionPair(i, k))
    return geometry


def _joint(robot: Robot, link: str) -> int:
    return int(robot.model.frames[robot.frame_id(link)].parentJoint)


def _capsules(robot: Robot) -> Iterable[LinkCapsule]:
    """Fit capsules to the <collision> shapes of the URDF, in the frames of their links."""
    path = file_of(robot)
    root = tree_of(robot)
    folders = [str(parent) for parent in path.parents]
    try:
        found = pin.buildGeomFromUrdfString(
            robot.model, urdf.text_of(root), pin.GeometryType.COLLISION, package_dirs=folders
        )
    except (ValueError, RuntimeError) as error:
        problem = f"a shape cannot be read: {one_line(error)}"
        hint = "; ROS_PACKAGE_PATH names the folder of its packages" * ("package://" in problem)
        raise FileError(path, problem + hint) from error
    by_link: dict[int, list[pin.GeometryObject]] = {}
    for shape in found.geometryObjects:
        by_link.setdefault(shape.parentFrame, []).append(shape)
    for index, shapes in by_link.items():
        frame = robot.model.frames[index]
        placed = [(frame.placement.actInv(shape.placement), shape.geometry) for shape in shapes]
        balls = {(*place.translation.round(5).tolist(), round(shape.radius, 6))
                 for place, shape in placed if isinstance(shape, coal.Sphere)}  # fmt: skip
        used: set[tuple[float, ...]] = set()
        loose: list[Array] = []
        for place, shape in placed:
            if isinstance(shape, coal.Sphere):
                continue
            if isinstance(shape, coal.Cylinder):
                ends = [place.act(np.array([0.0, 0.0, z * shape.halfLength])) for z in (-1, 1)]
                caps = [(*end, shape.radius) for end in ends]
                near = [
                    {ball for ball in balls if np.allclose(cap, ball, atol=3e-5)} for cap in caps
                ]
                if all(near):
                    used |= near[0] | near[1]
                    yield LinkCapsule(
                        frame.name, _vector(ends[0]), _vector(ends[1]), float(shape.radius)
                    )
                    continue
            loose.append(_corners(shape) @ place.rotation.T + place.translation)
        if loose:
            a, b, radius = _enclosing_capsule(np.vstack(loose))
            yield LinkCapsule(frame.name, _vector(a), _vector(b), radius)
        for x, y, z, radius in sorted(balls - used):
            yield LinkCapsule(frame.name, (x, y, z), (x, y, z), radius)


def _enclosing_capsule(points: Array) -> tuple[Array, Array, float]:
    """Fit a capsule of small volume around points (k, 3) [m]; return its ends and its radius.

    The axis begins along each principal direction in turn and is then moved by Nelder and Mead's
    simplex method; for an axis and a radius the shortest segment is known in closed form, so the
    capsule holds all points whatever the method reached. The ends of a sphere are equal.
    """
    from scipy.optimize import minimize  # slow to import

    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    axes = np.linalg.svd(points - middle, full_matrices=False)[2]
    found = []
    for axis in axes:
        start = np.concatenate([middle, axis, [1.0]])
        scale = np.array([0.01, 0.01, 0.01, 0.1, 0.1, 0.1, 0.02])
        simplex = np.vstack([start, start + np.diag(scale)])
        options = {"initial_simplex": simplex, "maxfev": 4000, "xatol": 1e-6, "fatol": 1e-9}
        best = minimize(lambda x: _volume(*_capsule_along(points, x)), start, (), "Nelder-Mead",
                        options=options)  # fmt: skip
        found.append(_capsule_along(points, best.x))
    a, b, radius = min(found, key=lambda capsule: _volume(*capsule))
    return a, b, radius


def _capsule_along(points: Array, x: Array) -> tuple[Array, Array, float]:
    """Capsule along an axis: x holds a point, a direction and the radius over the least one."""
    origin, axis = x[:3], x[3:6] / np.linalg.norm(x[3:6])
    along = (points - origin) @ axis
    across = np.linalg.norm(points - origin - along[:, np.newaxis] * axis, axis=1)
    radius = float(across.max() * max(x[6], 1.0)) + 1e-9
    cap = np.sqrt(radius**2 - across**2)
    low, high = float((along + cap).min()), float((along - cap).max())
    if low > high:  # any point between them is the middle of a sphere that holds all
        low = high = 0.5 * (low + high)
    return origin + low * axis, origin + high * axis, radius


def _volume(a: Array, b: Array, radius: float) -> float:
    return float(np.pi * radius**2 * (np.linalg.norm(b - a) + 4.0 / 3.0 * radius))


def _corners(shape: coal.CollisionGeometry) -> Array:
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
    half = np.array(shape.halfSide if isinstance(shape, coal.Box) else [shape.aabb_radius] * 3)
    signs = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 3)
    corners: Array = signs * half
    return corners


def _vector(point: Array) -> checks.Vector3:
    x, y, z = point.tolist()
    return x, y, z
