r"""Bodies and pairs of a scene, laid out for compiled code, and bounds on their motion.

Along the joints :math:`1 \dots n` between a body at rest and the link, which travel by
:math:`\delta_k`, and with a point at most :math:`r_k` from the axis of joint k, the point's way,
and what that lacks to be linear in the joints' (twice), are at most

.. math::

    V = \sum_k \delta_k r_k, \qquad
    B = \sum_k r_k \delta_k \Bigl(\delta_k + 2 \sum_{j<k} \delta_j\Bigr)

(docs/theory.md). A prismatic joint counts with :math:`r_k = 1`, turns nothing and has no
:math:`\delta_k^2`. With velocities in place of ways they bound velocity and acceleration.
"""

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
    bodies += [
        _Body(f"{type(each).__name__} {number}", 0, each.box, each.thickness, speed=each.speed)
        for number, each in enumerate(obstacles, 1)
    ]
    pairs = list(model.pairs(robot)) if self_collision else []
    carried = [k for k in range(links) if bodies[k].joint]
    pairs += itertools.product(range(links, len(bodies)), carried)
    if not pairs:
        bare = unwatched_links(robot)
        reason = f"; {unwatched(bare)}" if bare else ""
        problem = f"there is no pair that could meet{reason}"
        raise InvalidInputError("obstacles", problem, obstacles)
    # The last three numbers of a body are its centre.
    first = HEAD + robot.dof + PER_BODY * (links + 1) - 3
    centers = [slice(at, at + 3) for at in first + PER_BODY * np.arange(len(obstacles))]
    moving = [pair for pair in zip(obstacles, centers, strict=True) if pair[0].moves]
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
    motions = np.array([_motion(robot, bodies[i], bodies[k]) for i, k in pairs])
    rows = [(bodies[i].speed, k, i, bodies[i].radius + bodies[k].radius) for i, k in pairs]
    parts = (placed, rows, motions[:, 0], motions[:, 1])
    return np.concatenate([np.ravel(part) for part in parts])


def _motion(robot: Robot, first: _Body, second: _Body) -> Matrix:
    """Return `bounds_of_motion` of the second body's segment as seen from the first body."""
    center, rotation, half = second.box
    placement = robot.model.frames[second.frame].placement
    ends = [placement.act(center + z * rotation[:, 2]) for z in (-half[2], half[2])]
    return bounds_of_motion(robot, first.joint, second.joint, np.array(ends))


def bounds_of_motion(robot: Robot, first: int, second: int, points: Matrix) -> Matrix:
    """Find the joints that move points (k, 3) [m] of the second joint's link beside the first's.

    The joints are Pinocchio's, 0 the world; the points are in the frame of the second.

    Returns:
        Two rows, (2, n): 1 for each joint that moves the second link alone, -1 for each that moves
        the first alone, else 0; and the largest distance of the points from the axis of each joint
        that moves them [m], -1 for a prismatic joint, 0 for the others.
    """
    model = robot.model
    above = [set(list(model.supports[joint])[1:]) for joint in (first, second)]
    moves = np.zeros(robot.dof)
    radii = np.zeros(robot.dof)
    # From the second link to the base, and up to the first: nothing is farther than `reach` from
    # the joint in turn, and `offsets` lead from the joint before it.
    reach = float(np.linalg.norm(points, axis=1).max())
    offsets = points
    for joint in sorted(above[1] - above[0], reverse=True):
        # The axis may be met anywhere along itself: only what is across it counts.
        across = np.linalg.norm(np.cross(_axis(robot, joint), offsets), axis=1).max()
        moves[model.idx_vs[joint]] = 1.0
        radii[model.idx_vs[joint]] = reach - np.linalg.norm(offsets, axis=1).max() + across
        offsets = model.jointPlacements[joint].translation[np.newaxis]
        reach += _length(robot, joint)
    for joint in sorted(above[0] - above[1]):
        reach += _length(robot, joint)  # on the way up a joint's own offset lies ahead of it
        moves[model.idx_vs[joint]] = -1.0
        radii[model.idx_vs[joint]] = reach
    for joint in above[0] ^ above[1]:
        if _slides(robot, joint):
            radii[model.idx_vs[joint]] = -1.0
    return np.array([moves, radii])


def _axis(robot: Robot, joint: int) -> Vector:
    """Direction of a joint's axis in its own frame, (3,)."""
    data = robot.model.joints[joint].createData()
    robot.model.joints[joint].calc(data, np.zeros(1), np.zeros(1))
    axis: Vector = np.ravel(data.S)
    return axis[:3] if np.any(axis[:3]) else axis[3:]


def _slides(robot: Robot, joint: int) -> bool:
    return "JointModelP" in robot.model.joints[joint].shortname()


def _length(robot: Robot, joint: int) -> float:
    """Largest distance of a joint's frame from its parent's [m]."""
    length = float(np.linalg.norm(robot.model.jointPlacements[joint].translation))
    if _slides(robot, joint):
        at = robot.model.idx_vs[joint]
        length += float(np.abs([robot.q_lower[at], robot.q_upper[at]]).max())
    return length
