r"""Bounds on the motion of a link's points, by how far each joint goes.

Along the joints :math:`1 \dots n` between a body at rest and the link, which travel by
:math:`\delta_k`, and with a point at most :math:`r_k` from the axis of joint k, the point's way,
and what that lacks to be linear in the joints' (twice), are at most

.. math::

    V = \sum_k \delta_k r_k, \qquad
    B = \sum_k r_k \delta_k \Bigl(\delta_k + 2 \sum_{j<k} \delta_j\Bigr)

(docs/theory.md). A prismatic joint counts with :math:`r_k = 1`, turns nothing and has no
:math:`\delta_k^2`. With velocities in place of ways they bound velocity and acceleration.
"""

from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot


class MotionBounds(NamedTuple):
    """Joints between two links, by which the second moves as seen from the first.

    Attributes:
        moves: 1 for each joint that moves the second link alone, -1 for each that moves the first
            alone, else 0, (n,).
        radii: Largest distance of the points from the axis of each joint that moves them [m], -1
            for a prismatic joint, 0 for the others, (n,).
    """

    moves: Vector
    radii: Vector


def bounds_of_motion(robot: Robot, first: int, second: int, points: Matrix) -> MotionBounds:
    """Find the joints that move points (k, 3) [m] of the second joint's link beside the first's.

    The joints are Pinocchio's, 0 the world; the points are in the frame of the second.
    """
    model = robot.model
    above = [set(list(model.supports[joint])[1:]) for joint in (first, second)]
    up = sorted(above[0] - above[1], reverse=True)
    path = [*up, *sorted(above[1] - above[0])]
    moves = np.zeros(robot.dof)
    radii = np.zeros(robot.dof)
    for index, joint in enumerate(path):
        at = model.idx_vs[joint]
        moves[at] = -1.0 if joint in up else 1.0
        slides = _slides(robot, joint)
        radii[at] = -1.0 if slides else _largest_radius(robot, path[index:], up, points)
    return MotionBounds(moves, radii)


@compiled
def second_order(moves: Matrix, radii: Matrix, k: int, travel: Vector) -> float:
    """Compute B [m] for pair k, whose joints travel by `travel` (n,) [rad].

    Args:
        moves: `MotionBounds.moves` of all pairs, (pairs, n).
        radii: `MotionBounds.radii` of all pairs, (pairs, n).
        k: Index of the pair.
        travel: Way of each joint, at least 0, (n,) [rad].
    """
    n = travel.size
    B = 0.0
    turning = 0.0
    for step in range(2 * n):  # from the first body up to the common base, then down
        j = n - 1 - step if step < n else step - n
        if moves[k, j] == 0.0 or (moves[k, j] < 0.0) != (step < n):
            continue
        if radii[k, j] < 0.0:
            B += 2.0 * travel[j] * turning
        else:
            B += travel[j] * radii[k, j] * (2.0 * turning + travel[j])
            turning += travel[j]
    return B


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
