"""Bodies and pairs of a scene, laid out for compiled code."""

import itertools
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import unwatched
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import collision_model, unwatched_links
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.robot.obstacles import Obstacle, PlacedBox, box_around
from iiwa_dnn.schemes.distances import HEAD, PER_BODY, write_distances
from iiwa_dnn.schemes.motion_bounds import MotionBounds, bounds_of_motion


class Pair(NamedTuple):
    """Two bodies that are kept apart: a link or an obstacle, and a link that moves beside it."""

    first: str
    second: str


class Scene(NamedTuple):
    """Bodies and pairs of a robot among obstacles.

    Attributes:
        robot: The robot, n joints.
        pairs: The pairs.
        frames: Links whose placements are needed.
        moving: Obstacles that move, each with the part of `constants` that its centre takes.
        constants: Numbers that compiled code sees through `scene_views`, (k,).
    """

    robot: Robot
    pairs: list[Pair]
    frames: tuple[str, ...]
    moving: list[tuple[Obstacle, slice]]
    constants: Vector

    def move(self, constants: Vector, t: float) -> None:
        """Bring the moving obstacles in a copy of `constants`, (k,), to a time [s]."""
        for obstacle, part in self.moving:
            constants[part] = self.constants[part] + obstacle.shift(t)

    def nearest(self, q: Matrix, t: Vector) -> tuple[Vector, NDArray[np.int64]]:
        """Compute the least distance [m] of all pairs, (k,), and the index of its pair, (k,).

        The joints are at q (k, n) [rad] at times t (k,) [s].
        """
        constants = self.constants.copy()
        kinematics = Kinematics(self.robot, self.frames)
        distances = np.empty(len(self.pairs))
        found = np.empty((len(q), 2))
        for row, posture, time in zip(found, q, t, strict=True):
            self.move(constants, float(time))
            kinematics.update(posture)
            write_distances(constants, self.robot.dof, kinematics.placements, distances)
            row[:] = (distances.min(), distances.argmin())
        return found[:, 0].copy(), found[:, 1].astype(np.int64)


class _Body(NamedTuple):
    """A box with a radius in a frame of the robot, 0 the world; a joint or a speed moves it."""

    name: str
    frame: int
    box: PlacedBox
    radius: float
    joint: int = 0
    speed: float = 0.0


def make_scene(
    robot: Robot, obstacles: Sequence[Obstacle], self_collision: bool, least: float, gain: float
) -> Scene:
    """Lay the capsules of a robot, obstacles and their pairs out; among them, or not, of links.

    Raises:
        InvalidInputError: There is no URDF file, no velocity limit of a joint, or no pair.
        FileError: The collision geometry of the robot cannot be read.
    """
    if not (robot.dq_max < np.inf).all():
        name = robot.joint_names[int(np.argmax(robot.dq_max))]
        problem = f"must have a velocity limit on {name}, or no distance can be kept"
        raise InvalidInputError("robot", problem, robot)
    model = collision_model(robot)
    bodies: list[_Body] = []
    for capsule in model.capsules:
        frame = robot.frame_id(capsule.link)
        joint = int(robot.model.frames[frame].parentJoint)
        box = box_around(capsule.a, capsule.b)
        bodies.append(_Body(capsule.link, frame, box, capsule.radius, joint))
    links = len(bodies)
    for number, obstacle in enumerate(obstacles, 1):
        name = f"{type(obstacle).__name__} {number}"
        body = _Body(name, 0, obstacle.box, obstacle.thickness, speed=obstacle.speed)
        bodies.append(body)
    pairs = list(model.pairs(robot)) if self_collision else []
    carried = [k for k in range(links) if bodies[k].joint]
    pairs += itertools.product(range(links, len(bodies)), carried)
    if not pairs:
        bare = unwatched_links(robot)
        reason = f"; {unwatched(bare)}" if bare else ""
        problem = f"there is no pair that could meet{reason}"
        raise InvalidInputError("obstacles", problem, obstacles)
    moving = []
    for index, obstacle in enumerate(obstacles, links + 1):
        if obstacle.moves:  # the last three numbers of a body are its centre
            end = HEAD + robot.dof + PER_BODY * index
            moving.append((obstacle, slice(end - 3, end)))
    frames = tuple(dict.fromkeys(body.name for body in bodies[:links]))
    names = [Pair(bodies[i].name, bodies[k].name) for i, k in pairs]
    head = np.array([least, gain, len(bodies), len(pairs)])
    constants = np.concatenate([head, robot.dq_max, _layout(robot, bodies, pairs)])
    return Scene(robot, names, frames, moving, constants)


def _layout(robot: Robot, bodies: list[_Body], pairs: list[tuple[int, int]]) -> Vector:
    """Return the numbers of bodies and of their pairs, by their indices, as `SceneViews` has them.

    They are the columns `bodies`, `pairs`, `moves` and `radii`, one after another, (k,).
    """
    placed = [
        np.concatenate([[frame], box.half_extents, box.rotation.T.ravel(), box.center])
        for _, frame, box, *_ in bodies
    ]
    motions = [_motion(robot, bodies[i], bodies[k]) for i, k in pairs]
    rows = [(bodies[i].speed, k, i, bodies[i].radius + bodies[k].radius) for i, k in pairs]
    moves = [motion.moves for motion in motions]
    radii = [motion.radii for motion in motions]
    return np.concatenate([np.ravel(part) for part in (placed, rows, moves, radii)])


def _motion(robot: Robot, first: _Body, second: _Body) -> MotionBounds:
    """Return the joints that move the second body's segment as seen from the first body."""
    center, rotation, half = second.box
    placement = robot.model.frames[second.frame].placement
    ends = [placement.act(center + z * rotation[:, 2]) for z in (-half[2], half[2])]
    return bounds_of_motion(robot, first.joint, second.joint, np.array(ends))
