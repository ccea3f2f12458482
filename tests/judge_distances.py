"""A judge of distances: coal's shapes and nearest points, Pinocchio's placements."""

from typing import Any, NamedTuple

import coal
import numpy as np
import pinocchio as pin

import iiwa_dnn
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot.collision import coal_geometry, collision_model
from iiwa_dnn.robot.meetings import TOUCH

SLACK = 1e-6
"""Distance that coal's own tolerance may cost [m]."""


class Verdict(NamedTuple):
    """Least distance of a path from still obstacles [m], and samples that broke the promise."""

    least: float
    broken: int


class Judge:
    """Distances of a robot's links from obstacles and from each other."""

    def __init__(self, robot: iiwa_dnn.Robot, avoidance: iiwa_dnn.CollisionAvoidance) -> None:
        """Build the scene."""
        self._robot = robot
        self._obstacles = avoidance.obstacles
        self._promised = avoidance.distance
        model = collision_model(robot)
        pairs = model.pairs(robot) if avoidance.self_collision else []
        beyond = max(0.0, avoidance.distance - TOUCH)  # a close pair keeps no more than `TOUCH`
        self._allowed = [each.overlap + beyond if each.overlap else 0.0 for each in pairs]
        self._geometry = geometry = coal_geometry(robot, model, pairs)
        self._first = geometry.ngeoms
        self._rest = []
        for number, obstacle in enumerate(self._obstacles):
            shape, place = _coal(obstacle)
            self._rest.append(place)
            geometry.addGeometryObject(pin.GeometryObject(str(number), 0, place, shape))
            for k, body in enumerate(model.bodies):
                if body in model.capsules and geometry.geometryObjects[k].parentJoint:
                    geometry.addCollisionPair(pin.CollisionPair(self._first + number, k))
        self._data = robot.model.createData()
        self._found = pin.GeometryData(geometry)

    def distances(self, q: Vector, t: float = 0.0) -> Vector:
        """Return the distances of all pairs [m] at joint positions q (n,) [rad] and a time [s]."""
        for number, (obstacle, place) in enumerate(zip(self._obstacles, self._rest, strict=True)):
            if obstacle.speed:
                moved = pin.SE3(place.rotation, place.translation + obstacle.shift(t))
                self._geometry.geometryObjects[self._first + number].placement = moved
        scene = self._geometry, self._found
        pin.computeDistances(self._robot.model, self._data, *scene, q)
        distances = np.array([found.min_distance for found in self._found.distanceResults])
        distances[: len(self._allowed)] += self._allowed
        return distances

    def distance(self, q: Vector, t: float) -> float:
        """Return the least distance [m] at joint positions q (n,) [rad] and a time [s]."""
        return float(self.distances(q, t).min())

    def verdict(self, path: Matrix, dt: float, ok: Any = ()) -> Verdict:
        """Judge a path (k + 1, n) [rad], at its samples, dt [s] apart, and half-way between.

        A moving obstacle that is too near has broken no promise if the step said so (`ok`, (k,))
        and the arm itself did not come nearer.
        """
        doubled = np.empty((2 * len(path) - 1, path.shape[1]))
        doubled[::2] = path
        doubled[1::2] = 0.5 * (path[1:] + path[:-1])
        clock = 0.5 * dt * np.arange(len(doubled))
        distances = np.array([self.distance(*each) for each in zip(doubled, clock, strict=True)])
        moving = any(obstacle.speed for obstacle in self._obstacles)
        broken = 0
        for i in np.flatnonzero(distances < self._promised - SLACK):
            excused = moving and i > 0 and not ok[(i - 1) // 2]
            still = excused and self.distance(doubled[i - 1], clock[i])
            broken += bool(not excused or distances[i] < still - SLACK)
        return Verdict(np.inf if moving else float(distances.min()), broken)


def swinging(kind: type[Any], rate: float = 1.0, until: float = np.inf) -> type[Any]:
    """Return a shape that swings at a rate [1/s] up to a time [s], no faster than its velocity."""

    def shift(obstacle: Any, t: float) -> Vector:
        return np.sin(rate * min(t, until)) / rate * np.array(obstacle.velocity)

    return type(kind.__name__, (kind,), {"shift": shift})


def obstacles_for(moving: bool) -> list[Any]:
    """Return one obstacle of each kind, around an arm of 0.9 m at the origin."""
    velocity = (0.0, 0.1 * moving, 0.0)
    turn = pin.exp3(np.array([0.4, -0.3, 0.5])).tolist()
    return [
        swinging(iiwa_dnn.Sphere)([0.45, 0.35, 0.5], 0.1, velocity=velocity),
        swinging(iiwa_dnn.Capsule)([-0.5, 0.2, 0.2], [-0.4, 0.4, 0.9], 0.05, velocity=velocity),
        iiwa_dnn.Box([0.5, -0.45, 0.3], [0.1, 0.1, 0.3]),
        swinging(iiwa_dnn.Box)([-0.4, -0.5, 0.4], [0.1, 0.05, 0.15], turn, velocity=velocity),
        iiwa_dnn.HalfSpace([0.0, 0.0, 1.0], -0.15),
    ]


def _coal(obstacle: Any) -> tuple[coal.CollisionGeometry, pin.SE3]:
    if isinstance(obstacle, iiwa_dnn.Sphere):
        return coal.Sphere(obstacle.radius), pin.SE3(np.eye(3), np.array(obstacle.center))
    if isinstance(obstacle, iiwa_dnn.Capsule):
        a = np.array(obstacle.a)
        b = np.array(obstacle.b)
        turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), b - a).matrix()
        shape = coal.Capsule(obstacle.radius, float(np.linalg.norm(b - a)))
        return shape, pin.SE3(turn, 0.5 * (a + b))
    if isinstance(obstacle, iiwa_dnn.Box):
        turn = np.eye(3) if obstacle.rotation is None else np.array(obstacle.rotation)
        size = 2.0 * np.array(obstacle.half_extents)
        return coal.Box(*size), pin.SE3(turn, np.array(obstacle.center))
    return coal.Halfspace(np.array(obstacle.normal), obstacle.offset), pin.SE3.Identity()
