"""Bodies and pairs of a scene, laid out for compiled code, and their distances."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.collision import collision_model
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.robot.obstacles import HalfSpace, Obstacle
from iiwa_dnn.schemes.distances import hull_points, segment_points
from iiwa_dnn.schemes.reaches import bounds_of_motion

HEAD, SHAPE, PAIR, FOUND = 8, 8, 13, 17
"""Numbers of the head, of a shape, of a pair without its joints, and of a measurement likewise."""


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
        moving: Obstacles that move, with their place in `numbers` and their points, (k, 3).
        speeds: Bound on the rate of each pair's distance [m/s], (pairs,).
        numbers: ``[4 parameters of the rows | shapes, pairs, start of pairs, start of points |
            velocity limits | shapes | pairs | points]``. A shape is ``[frame, or -1 for the world |
            ends | radius]``; a pair ``[second shape, first shape or -1, start of points, number of
            points or 0 for a half-space, thickness | normal | speed, acceleration, turning rate and
            its change (`reaches`), obstacle's speed | 1 for each joint that moves the second alone,
            -1 the first]``.
    """

    robot: Robot
    pairs: list[Pair]
    frames: tuple[str, ...]
    moving: list[tuple[Obstacle, int, Matrix]]
    speeds: Vector
    numbers: Vector

    def move(self, numbers: Vector, t: float) -> None:
        """Write the moving obstacles where they are at a time [s] into a copy of `numbers`."""
        for obstacle, at, points in self.moving:
            numbers[at : at + points.size] = (points + obstacle.shift(t)).ravel()

    def nearest(self, q: Matrix, t: Vector) -> tuple[Vector, NDArray[np.int64]]:
        """Compute the least distance [m] of all pairs, (k,), and the index of its pair, (k,).

        The joints are at q (k, n) [rad] at times t (k,) [s].
        """
        numbers, kinematics = self.numbers.copy(), Kinematics(self.robot, self.frames)
        distances, indices = np.empty(len(q)), np.empty(len(q), np.int64)
        found = np.empty(len(self.pairs) * (FOUND + self.robot.dof))
        for k in range(len(q)):
            self.move(numbers, float(t[k]))
            kinematics.update(q[k])
            measure(numbers, 0, self.robot.dof, kinematics.placements, found)
            column = found[10 :: FOUND + self.robot.dof]
            indices[k] = column.argmin()
            distances[k] = column[indices[k]]
        return distances, indices


def make_scene(
    robot: Robot, obstacles: Sequence[Obstacle], self_collision: bool, parameters: Sequence[float]
) -> Scene:
    """Lay the capsules of a robot, obstacles and their pairs out; among them, or not, of links.

    The parameters are the first four of `Scene.numbers`.

    Raises:
        InvalidInputError: There is no URDF file, no velocity limit of a joint, or no pair.
        FileError: The collision geometry of the robot cannot be read.
    """
    for name, fastest in zip(robot.joint_names, robot.dq_max, strict=True):
        if not fastest < np.inf:
            problem = f"must have a velocity limit on {name}, or no distance can be kept"
            raise InvalidInputError("robot", problem, robot)
    model = collision_model(robot)
    frames = [robot.model.frames[robot.frame_id(c.link)] for c in model.capsules]
    joints = [int(frame.parentJoint) for frame in frames]
    ends = [
        np.array([frame.placement.act(np.array(x)) for x in (c.a, c.b)])
        for c, frame in zip(model.capsules, frames, strict=True)
    ]
    shapes = []
    for c, frame, end in zip(model.capsules, frames, ends, strict=True):
        fixed = frame.parentJoint == 0
        place = [-1, *end.ravel()] if fixed else [robot.frame_id(c.link), *c.a, *c.b]
        shapes.append([*place, c.radius])
    pairs, rows = [], []
    for i, k in model.pairs(robot) if self_collision else []:
        first, second = model.capsules[i], model.capsules[k]
        bounds = bounds_of_motion(robot, joints[i], joints[k], ends[k])
        pairs.append(Pair(first.link, second.link))
        count = 1 if first.a == first.b else 2
        rows.append([k, i, 0, count, first.radius, 0, 0, 0, *bounds[:4], 0, *bounds[4:]])
    starts = np.cumsum([0, *(obstacle.points.size for obstacle in obstacles)]).tolist()
    for number, obstacle in enumerate(obstacles):
        flat, normal = isinstance(obstacle, HalfSpace), getattr(obstacle, "normal", (0, 0, 0))
        count = 0 if flat else len(obstacle.points)
        fixed = [-1, starts[number], count, obstacle.thickness, *normal]
        for k, c in enumerate(model.capsules):
            if joints[k] == 0:
                continue
            of_second = [k]
            if flat and c.a != c.b:  # its ends: two balls, whose rows never jump
                of_second = [len(shapes), len(shapes) + 1]
                shapes += [[shapes[k][0], *end, *end, c.radius] for end in (c.a, c.b)]
            bounds = bounds_of_motion(robot, 0, joints[k], ends[k])
            for shape in of_second:
                pairs.append(Pair(f"{type(obstacle).__name__} {number + 1}", c.link))
                rows.append([shape, *fixed, *bounds[:4], obstacle.speed, *bounds[4:]])
    if not pairs:
        raise InvalidInputError("obstacles", "there is no pair that could meet", obstacles)
    at_pairs = HEAD + robot.dof + SHAPE * len(shapes)
    begin = at_pairs + (PAIR + robot.dof) * len(pairs)
    points = [obstacle.points for obstacle in obstacles]
    numbers = np.concatenate(
        [parameters, [len(shapes), len(pairs), at_pairs, begin], robot.dq_max, np.ravel(shapes),
         np.ravel(rows), *map(np.ravel, points)]
    )  # fmt: skip
    needed = dict.fromkeys(c.link for c, j in zip(model.capsules, joints, strict=True) if j)
    placed = zip(obstacles, starts, points, strict=False)
    moving = [(each, begin + start, at) for each, start, at in placed if each.moves]
    speeds = [row[8] + row[12] for row in rows]
    return Scene(robot, pairs, tuple(needed), moving, np.array(speeds), numbers)


@compiled
def measure(numbers: Vector, at: int, dof: int, placements: Matrix, found: Vector) -> None:
    """Write the nearest points of every pair.

    Of each ``[x of the second | x of the first | normal, from the first | distance of the cores,
    distance | of each end of the second its distance from x and its height over it | room for 2 +
    dof numbers more]``, in all `found` (k,), k = pairs (17 + dof). `numbers` (c,) has those of
    `Scene.numbers` from index `at` on.
    """
    shapes, pairs = int(numbers[at + 4]), int(numbers[at + 5])
    at_pairs, at_points = at + int(numbers[at + 6]), at + int(numbers[at + 7])
    placed = np.empty(6 * shapes)
    for k in range(shapes):
        shape = at + HEAD + dof + SHAPE * k
        frame = int(numbers[shape])
        for end in range(2):
            x = shape + 1 + 3 * end
            for i in range(3):
                value = numbers[x + i]
                if frame >= 0:
                    value = placements[frame, 9 + i]
                    for j in range(3):
                        value += placements[frame, 3 * j + i] * numbers[x + j]
                placed[6 * k + 3 * end + i] = value
    for k in range(pairs):
        pair, out = at_pairs + (PAIR + dof) * k, (FOUND + dof) * k
        second, first, count = int(numbers[pair]), int(numbers[pair + 1]), int(numbers[pair + 3])
        s, points, core = 6 * second, at_points + int(numbers[pair + 2]), 0.0
        if first >= 0:
            segment_points(placed, s, placed, 6 * first, 2, found, out)
        elif count == 1 or count == 2:
            segment_points(placed, s, numbers, points, count, found, out)
        elif count > 2:
            hull_points(placed, s, numbers, points, count, found, out)
        if count == 0:
            for i in range(3):
                core += numbers[pair + 5 + i] * (placed[s + i] - numbers[points + i])
            for i in range(3):
                found[out + 6 + i] = numbers[pair + 5 + i]
                found[out + i] = placed[s + i]
                found[out + 3 + i] = placed[s + i] - core * numbers[pair + 5 + i]
        else:
            for i in range(3):
                found[out + 6 + i] = found[out + i] - found[out + 3 + i]
                core += found[out + 6 + i] ** 2
            core = np.sqrt(core)
            for i in range(3):  # where the cores meet, upwards is as good a normal as any
                found[out + 6 + i] = found[out + 6 + i] / core if core > 1e-9 else 1.0 * (i == 2)
        radius = numbers[at + HEAD + dof + SHAPE * second + 7]
        found[out + 9], found[out + 10] = core, core - numbers[pair + 4] - radius
        for end in range(2):
            length, height = 0.0, 0.0
            for i in range(3):
                side = placed[s + 3 * end + i] - found[out + i]
                length += side * side
                height += side * found[out + 6 + i]
            found[out + 11 + 2 * end], found[out + 12 + 2 * end] = np.sqrt(length), height
