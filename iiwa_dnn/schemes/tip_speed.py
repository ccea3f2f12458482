"""Limit of the speed of a frame's origin."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import combined, dot, scaled, triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.step import StepViews, point_rate, rate_along

NEGLIGIBLE = 1e-6
"""Contribution of a joint to the speed that is rounding, as of one whose axis meets the tip [m]."""


class TipSpeedConstants(Record):
    """Constants of `TipSpeedLimit`: index of the frame, limit [m/s] and gain [1/s]."""

    frame: int
    limit: float
    gain: float


@compiled
def tip_speed_bounds(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds to those of `TipSpeedLimit`, whose constants these are."""
    own = TipSpeedConstants.of(constants)
    frame = own.frame
    gain = min(own.gain, step.rate)
    point = triple(Placement.of(step.placements[frame]).position)
    velocity = (0.0, 0.0, 0.0)
    for j in range(step.q.size):
        fraction = step.last[j] * step.support[frame, j]
        velocity = combined(1.0, velocity, fraction, point_rate(step.jacobian, j, point))
    speed = math.sqrt(dot(velocity, velocity))
    if not (speed > 0.0 and step.rate < np.inf):
        return
    direction = scaled(1.0 / speed, velocity)
    along = np.empty(step.q.size)
    total = 0.0
    for j in range(step.q.size):
        along[j] = step.support[frame, j] * rate_along(step.jacobian, j, point, direction)
        total += abs(along[j])
    growth = gain / step.rate * (own.limit - speed) / total
    for j in range(step.q.size):
        if along[j] > NEGLIGIBLE:
            ub[j] = max(min(ub[j], step.last[j] + growth), lb[j])
        elif along[j] < -NEGLIGIBLE:
            lb[j] = min(max(lb[j], step.last[j] - growth), ub[j])


@dataclass(frozen=True)
class TipSpeedLimit(Limit):
    r"""Joint velocity bounds that keep the speed of a frame's origin; beside acceleration limits.

    A frame that the joints move at :math:`v = J \dot q` with the last command has the speed
    :math:`s = \|v\|`, to which joint j contributes :math:`g_j \dot q_j`, :math:`g = J^T v / s`.
    Each joint may add an equal part of what is left to the limit V,

    .. math::

        \operatorname{sign}(g_j)\,(\dot q_j - \dot q_j^{last}) \;\le\;
            \gamma\,dt\,\frac{V - s}{\sum_i |g_i|},

    so that the speed along v grows by at most :math:`\gamma\,dt\,(V - s)` in a step, and shrinks by
    as much above the limit. What is left shrinks exponentially, as the distance to a position limit
    does.

    The bounds give way to those of acceleration and jerk, without which nothing ties a command to
    the last one, and to position limits. The speed may then be above V for a while: by what the
    pose adds, :math:`\dot J \dot q / \gamma`, and by what jerk takes to turn an acceleration. A
    limit of 0.9 times the robot's own covers both.

    Attributes:
        limit: Largest speed [m/s], above 0.
        frame: The frame; None takes the tip.
        gain: Rate at which the speed may come near to the limit [1/s], above 0.
    """

    kernel = staticmethod(tip_speed_bounds)
    _checks: ClassVar[checks.Checks] = {"limit": checks.positive, "gain": checks.positive}
    limit: float
    frame: str | None = None
    gain: float = 100.0

    def constants(self, robot: Robot) -> Vector:
        """Return the index of the frame, the limit [m/s] and the gain [1/s], (3,)."""
        return np.array([robot.frame_id(self.frame_name(robot)), self.limit, self.gain])
