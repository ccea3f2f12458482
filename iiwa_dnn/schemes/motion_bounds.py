r"""Bounds on the motion of a link's points within a step, in which every joint keeps its velocity.

Along the joints :math:`1 \dots n` between a body at rest and the link, with velocities bounded by
:math:`\bar q_k` and a point at most :math:`r_k` from the axis of joint k, the point's velocity,
acceleration, and the link's turning rate with its change are at most

.. math::

    V = \sum_k \bar q_k r_k, \quad
    A = \sum_k r_k \bar q_k \Bigl(\bar q_k + 2 \sum_{j<k} \bar q_j\Bigr), \quad
    \omega = \sum_k \bar q_k, \quad
    \dot\omega = \sum_{j<k} \bar q_j \bar q_k

(docs/collisions.md). A prismatic joint counts with :math:`r_k = 1`, turns nothing and has no
:math:`\bar q_k^2`.
"""

from typing import NamedTuple

import numpy as np

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot


class MotionBounds(NamedTuple):
    """Bounds on the motion of a link's points as seen from another link.

    Attributes:
        speed: Speed of a point [m/s].
        acceleration: Acceleration of a point [m/s^2].
        turning: Turning rate of the link [rad/s].
        turning_change: Change of the turning rate [rad/s^2].
        moves: 1 for each joint that moves the link alone, -1 for each that moves the other link
            alone, else 0, (n,).
        radii: Largest distance of the points from the axis of each joint that moves them [m], -1
            for a prismatic joint, 0 for the others, (n,).
    """

    speed: float
    acceleration: float
    turning: float
    turning_change: float
    moves: Vector
    radii: Vector


def bounds_of_motion(robot: Robot, first: int, second: int, points: Matrix) -> MotionBounds:
    """Bound the motion of points (k, 3) [m] of the second joint's link as seen from the first's.

    The joints are Pinocchio's, 0 the world; the points are in the frame of the second.
    """
    model = robot.model
    above = [set(list(model.supports[joint])[1:]) for joint in (first, second)]
    up = sorted(above[0] - above[1], reverse=True)
    path = [*up, *sorted(above[1] - above[0])]
    speed = 0.0
    acceleration = 0.0
    turning = 0.0
    change = 0.0
    radii = np.zeros(robot.dof)
    for index, joint in enumerate(path):
        at = model.idx_vs[joint]
        fastest = float(robot.dq_max[at])
        if _slides(robot, joint):
            radii[at] = -1.0
            speed += fastest
            acceleration += 2.0 * fastest * turning
        else:
            radii[at] = _largest_radius(robot, path[index:], up, points)
            moved = fastest * radii[at]
            speed += moved
            acceleration += moved * (2.0 * turning + fastest)
            change += fastest * turning
            turning += fastest
    moves = np.zeros(robot.dof)
    for joint in path:
        moves[model.idx_vs[joint]] = -1.0 if joint in up else 1.0
    return MotionBounds(speed, acceleration, turning, change, moves, radii)


def _largest_radius(robot: Robot, path: list[int], up: list[int], points: Matrix) -> float:
    """Bound the distance of points (k, 3) from a joint's axis [m].

    The path leads from the joint to the points' link; its joints in `up` are passed from the link
    to the base.
    """
    joint, *later = path
    to_link = sum(_length(robot, other) for other in later if other not in up)
    radius = to_link + float(np.linalg.norm(points, axis=1).max())
    if joint in up:  # on the way up a joint's own offset lies ahead of it
        return radius + sum(_length(robot, other) for other in path if other in up)
    # The axis may be met anywhere along itself: only what is across it counts.
    axis = _axis(robot, joint)
    if not later:
        return max(_across(axis, point) for point in points)
    if not _slides(robot, later[0]):
        offset = robot.model.jointPlacements[later[0]].translation
        radius += _across(axis, offset) - _length(robot, later[0])
    return radius


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


def _across(axis: Vector, point: Vector) -> float:
    return float(np.linalg.norm(np.cross(axis, point)))
