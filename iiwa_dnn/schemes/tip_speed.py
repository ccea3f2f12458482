r"""Limit of a frame's speed, as a robot's safety controller watches it, by bounds of the joints.

A frame that the joints move at :math:`v = J \dot q` with the last command has the speed
:math:`s = \|v\|`, to which joint j contributes :math:`g_j \dot q_j`, :math:`g = J^T v / s`. Each
joint may add an equal part of what is left to the limit V,

.. math::

    \operatorname{sign}(g_j)\,(\dot q_j - \dot q_j^{last}) \;\le\;
        \gamma\,dt\,\frac{V - s}{\sum_i |g_i|},

so that the speed along v grows by at most :math:`\gamma\,dt\,(V - s)` in a step, and shrinks by as
much above the limit. What is left shrinks exponentially, as the way to a position limit does.

The bounds give way to those of acceleration and jerk, without which nothing ties a command to the
last one, and to position limits. The speed may then be above V for a while: by what the pose adds,
:math:`\dot J \dot q / \gamma`, and by what jerk takes to turn an acceleration. A limit of 0.9
times the robot's own has room for both.
"""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Checks, Limit
from iiwa_dnn.schemes.step import StepViews, rate_along, vector_at

NEGLIGIBLE = 1e-6
"""Contribution of a joint to the speed that is rounding, as of one whose axis meets the tip [m]."""


@compiled
def speed_along(step: StepViews, frame: int, point: Vector3, axis: Vector3) -> float:
    """Compute the velocity along an axis (3,) of a point [m] of a frame at the last command."""
    speed = 0.0
    for j in range(step.q.size):
        speed += step.last[j] * step.moves[frame, j] * rate_along(step.jacobian, j, point, axis)
    return speed


@compiled
def tip_speed_bounds(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds to those of `TipSpeedLimit`, whose constants these are."""
    frame = int(constants[0])
    gain = min(constants[2], step.rate)
    point = vector_at(step.placements[frame], 9)
    x = speed_along(step, frame, point, (1.0, 0.0, 0.0))
    y = speed_along(step, frame, point, (0.0, 1.0, 0.0))
    z = speed_along(step, frame, point, (0.0, 0.0, 1.0))
    speed = math.sqrt(x * x + y * y + z * z)
    if not (speed > 0.0 and step.rate < np.inf):
        return
    direction = (x / speed, y / speed, z / speed)
    along = np.empty(step.q.size)
    total = 0.0
    for j in range(step.q.size):
        along[j] = step.moves[frame, j] * rate_along(step.jacobian, j, point, direction)
        total += abs(along[j])
    growth = gain / step.rate * (constants[1] - speed) / total
    for j in range(step.q.size):
        if along[j] > NEGLIGIBLE:
            ub[j] = max(min(ub[j], step.last[j] + growth), lb[j])
        elif along[j] < -NEGLIGIBLE:
            lb[j] = min(max(lb[j], step.last[j] - growth), ub[j])


@dataclass(frozen=True)
class TipSpeedLimit(Limit):
    """Joint velocity bounds that keep the speed of a frame's origin; beside acceleration limits.

    Attributes:
        limit: Largest speed [m/s], above 0.
        frame: The frame; None takes the tip.
        gain: Rate at which the speed may come near to the limit [1/s], above 0.
    """

    kernel = staticmethod(tip_speed_bounds)
    _checks: ClassVar[Checks] = {"limit": checks.positive, "gain": checks.positive}
    limit: float
    frame: str | None = None
    gain: float = 100.0

    def constants(self, robot: Robot) -> Vector:
        """Return the index of the frame, the limit [m/s] and the gain [1/s], (3,)."""
        return np.array([robot.frame_id(self.frame_name(robot)), self.limit, self.gain])
