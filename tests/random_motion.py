"""Random motion among obstacles, judged by coal: ``python tests/random_motion.py STEPS``.

Each joint is asked for its largest velocity, up or down, drawn anew every tenth of a second, and
the rows alone keep the arm out of still and moving obstacles and of itself. coal computes every
distance again from the joint positions; between steps a Lipschitz constant of the distance bounds
how small it can have been, and intervals are halved until the bound says enough.
"""

import sys
import time
from typing import Any

import coal
import numpy as np
import pinocchio as pin

import iiwa_dnn
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot.collision import coal_geometry, collision_model

SLACK = 1e-7
"""Distance [m] that the solver's tolerance and coal's own may cost."""


class Wander(iiwa_dnn.Cost):
    """The wish for random velocities at the limits, |dq - v|^2 / 2."""

    def __init__(self, robot: iiwa_dnn.Robot, seed: int, hold: float = 0.1) -> None:
        """Draw from a seed; a velocity is held for so long [s]."""
        self._robot = robot
        self._seed = seed
        self._hold = hold

    def quadratic(self, step: iiwa_dnn.Step) -> tuple[Matrix, Vector]:
        """Return the identity and -v(t)."""
        draw = np.random.default_rng((self._seed, int(step.t / self._hold + 1e-9)))
        return np.eye(step.q.size), -draw.choice([-1.0, 1.0], step.q.size) * self._robot.dq_max


def swinging(kind: type[Any], rate: float = 1.0, until: float = np.inf) -> type[Any]:
    """Return a shape that swings at a rate [1/s] up to a time [s], no faster than its velocity."""

    def shift(obstacle: Any, t: float) -> Vector:
        shifted: Vector = np.sin(rate * min(t, until)) / rate * np.array(obstacle.velocity)
        return shifted

    return type(kind.__name__, (kind,), {"shift": shift})


def obstacles_for(moving: bool) -> list[Any]:
    """Return one obstacle of each kind, around an arm of 0.9 m at the origin."""
    path = {"velocity": (0.0, 0.1, 0.0)} if moving else {}
    turn = pin.exp3(np.array([0.4, -0.3, 0.5])).tolist()
    return [
        swinging(iiwa_dnn.Sphere)([0.45, 0.35, 0.5], 0.1, **path),
        swinging(iiwa_dnn.Capsule)([-0.5, 0.2, 0.2], [-0.4, 0.4, 0.9], 0.05, **path),
        iiwa_dnn.Box([0.5, -0.45, 0.3], [0.1, 0.1, 0.3]),
        swinging(iiwa_dnn.Box)([-0.4, -0.5, 0.4], [0.1, 0.05, 0.15], turn, **path),
        iiwa_dnn.HalfSpace([0.0, 0.0, 1.0], -0.15),
    ]


class Judge:
    """Distances by coal alone: its own shapes, its own nearest points, Pinocchio's placements."""

    def __init__(self, robot: iiwa_dnn.Robot, avoidance: iiwa_dnn.CollisionAvoidance) -> None:
        """Build the scene."""
        self._robot = robot
        self._obstacles = avoidance.obstacles
        model = collision_model(robot)
        self._geometry = geometry = coal_geometry(
            robot, model, model.pairs(robot) if avoidance.self_collision else ()
        )
        self._first = geometry.ngeoms
        self._rest = []
        for number, obstacle in enumerate(self._obstacles):
            shape, place = _coal(obstacle)
            self._rest.append(place)
            geometry.addGeometryObject(pin.GeometryObject(str(number), 0, place, shape))
            for k in range(self._first):
                if geometry.geometryObjects[k].parentJoint:
                    geometry.addCollisionPair(pin.CollisionPair(self._first + number, k))
        self._data = robot.model.createData()
        self._found = pin.GeometryData(geometry)

    def distance(self, q: Vector, t: float) -> float:
        """Return the least distance [m] at joint positions q (n,) [rad] and a time [s]."""
        for number, (obstacle, place) in enumerate(zip(self._obstacles, self._rest, strict=True)):
            if obstacle.moves:
                moved = pin.SE3(place.rotation, place.translation + obstacle.shift(t))
                self._geometry.geometryObjects[self._first + number].placement = moved
        scene = self._geometry, self._found
        nearest = pin.computeDistances(self._robot.model, self._data, *scene, q)
        return float(self._found.distanceResults[nearest].min_distance)

    def between(self, q: Matrix, t: Vector, least: float, lipschitz: float) -> float:
        """Bound from below the distance between two samples q (2, n), t (2,), down to `least`.

        Args:
            q: Joint positions at both ends, a straight line between them [rad].
            t: Times [s].
            least: Distance [m] that suffices.
            lipschitz: Bound on the rate of the distance [m/s].
        """
        ends = [self.distance(q[i], float(t[i])) for i in range(2)]
        bound = 0.5 * (ends[0] + ends[1] - lipschitz * float(t[1] - t[0]))
        if bound >= least or t[1] - t[0] < 1e-9 or min(ends) < least:
            return min(bound, *ends)
        q = np.insert(q, 1, q.mean(axis=0), axis=0)
        t = np.insert(t, 1, t.mean())
        return min(self.between(q[i : i + 2], t[i : i + 2], least, lipschitz) for i in range(2))


def _coal(obstacle: Any) -> tuple[coal.CollisionGeometry, pin.SE3]:
    if isinstance(obstacle, iiwa_dnn.Sphere):
        return coal.Sphere(obstacle.radius), pin.SE3(np.eye(3), np.array(obstacle.center))
    if isinstance(obstacle, iiwa_dnn.Capsule):
        a = np.array(obstacle.a)
        b = np.array(obstacle.b)
        turn = pin.Quaternion.FromTwoVectors(np.array([0.0, 0.0, 1.0]), b - a).matrix()
        length = float(np.linalg.norm(b - a))
        return coal.Capsule(obstacle.radius, length), pin.SE3(turn, 0.5 * (a + b))
    if isinstance(obstacle, iiwa_dnn.Box):
        turn = np.eye(3) if obstacle.rotation is None else np.array(obstacle.rotation)
        size = 2.0 * np.array(obstacle.half_extents)
        return coal.Box(*size), pin.SE3(turn, np.array(obstacle.center))
    normal = np.array(obstacle.normal)
    return coal.Halfspace(normal, obstacle.offset), pin.SE3.Identity()


def wander(
    name: str, steps: int, seed: int, moving: bool = True, dt: float = 1e-3, sampled: int = 10
) -> dict[str, Any]:
    """Let an arm wander and judge every step.

    Returns:
        Least distances by coal ``least_m``, by the package ``least_own_m``, between steps
        ``least_between_m`` over `sampled` of the nearest, the largest difference of the first two
        ``difference_m``, ``steps``, steps with an active row ``active``, with a policy ``policy``.
    """
    robot = iiwa_dnn.load_robot(name)
    avoidance = iiwa_dnn.CollisionAvoidance(obstacles_for(moving), nearest=64)
    limits = [iiwa_dnn.JointLimits(), avoidance]
    scheme = iiwa_dnn.Scheme(costs=[Wander(robot, seed)], limits=limits)
    scene = avoidance.scene(robot)
    start = robot.start_posture()
    judge = Judge(robot, avoidance)
    random = np.random.default_rng(seed)
    while judge.distance(start, 0.0) < 0.03:
        start = random.uniform(robot.q_lower, robot.q_upper)
    reference = iiwa_dnn.Heart(period=1.0).anchored(iiwa_dnn.Configuration(robot, start))
    record = iiwa_dnn.simulate(
        robot,
        scheme,
        reference,
        start,
        dt=dt,
        duration=steps * dt,
        policy="relax",
        check=iiwa_dnn.CrossCheck(()),
    )
    coals = np.array([judge.distance(q, t) for q, t in zip(record.q, record.t, strict=True)])
    own, _ = scene.nearest(record.q, record.t)
    speeds = [obstacle.speed for obstacle in avoidance.obstacles]
    lipschitz = 1.5 * float(robot.dq_max.sum()) + max(speeds)  # no link is 1.5 m from an axis
    nearest = np.argsort(np.minimum(coals[1:], coals[:-1]))[:sampled]
    between = [
        judge.between(record.q[k : k + 2], record.t[k : k + 2], 0.02 - SLACK, lipschitz)
        for k in nearest
    ]
    active = 0 if record.row_multiplier is None else (record.row_multiplier > 0).any(axis=1).sum()
    return {
        "robot": name,
        "seed": seed,
        "steps": record.steps,
        "status": record.settings["status"],
        "least_m": float(coals.min()),
        "least_own_m": float(own.min()),
        "least_between_m": float(min(between, default=np.inf)),
        "difference_m": float(np.abs(coals - own).max()),
        "active": int(active),
        "policy": 0 if record.action is None else int((record.action > 0).sum()),
    }


def main(steps: int = 1_000_000, block: int = 50_000) -> int:
    """Share the steps among both arms, with still and with moving obstacles."""
    done = 0
    worst = np.inf
    began = time.perf_counter()
    while done < steps:
        seed = done // block
        name = ("iiwa7", "panda")[seed % 2]
        moving = seed % 4 >= 2
        found = wander(name, min(block, steps - done), seed, moving)
        done += found["steps"]
        worst = min(worst, found["least_m"], found["least_between_m"])
        print({**found, "moving": moving}, flush=True)
    print(f"{done:,} steps in {time.perf_counter() - began:.0f} s, least distance {worst:.9f} m")
    return int(worst < 0.02 - SLACK)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
