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

import numpy as np

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot


def bounds_of_motion(robot: Robot, first: int, second: int, points: Matrix) -> list[float]:
    """Bound the motion of points (k, 3) [m] of the second joint's link as seen from the first's.

    The joints are Pinocchio's, 0 the world; the points are in the frame of the second.

    Returns:
        Speed [m/s], acceleration [m/s^2], turning rate [rad/s] and its change [rad/s^2]; then of
        each joint 1 where it moves the second alone, -1 where it moves the first alone, or 0.
    """
    model = robot.model
    above = [set(list(model.supports[joint])[1:]) for joint in (first, second)]
    up, down = sorted(above[0] - above[1], reverse=True), sorted(above[1] - above[0])
    path = [*up, *down]
    mask = np.zeros(robot.dof)
    for sign, joints in ((-1.0, up), (1.0, down)):
        mask[[model.idx_vs[joint] for joint in joints]] = sign
    speed = acceleration = turn = change = 0.0
    end = float(np.linalg.norm(points, axis=1).max())
    for index, joint in enumerate(path):
        fastest, slides = float(robot.dq_max[model.idx_vs[joint]]), _slides(robot, joint)
        later = path[index + 1 :]
        reach = sum(_length(robot, k) for k in later if k in down) + end
        if joint in up:  # on the way up a joint's own offset lies ahead of it
            reach += sum(_length(robot, k) for k in path[index:] if k in up)
        elif not slides:
            # The axis may be met anywhere along itself: only what is across it counts.
            axis = _axis(robot, joint)
            if later and not _slides(robot, later[0]):
                offset = model.jointPlacements[later[0]].translation
                reach += _across(axis, offset) - _length(robot, later[0])
            elif not later:
                reach = max(_across(axis, point) for point in points)
        moved = fastest * (1.0 if slides else reach)
        speed += moved
        acceleration += moved * (2.0 * turn + (0.0 if slides else fastest))
        if not slides:
            change += fastest * turn
            turn += fastest
    return [speed, acceleration, turn, change, *mask.tolist()]


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
