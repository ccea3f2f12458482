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
