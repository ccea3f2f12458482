"""Limit of the speed of a frame."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import combined, cross, dot, scaled, triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.step import StepViews, rate_along

NEGLIGIBLE = 1e-6
"""Lever of a joint that counts as rounding, as where its axis goes through the tip [m]."""


class TipSpeedConstants(Record):
    """Constants of `TipSpeedLimit`: index of the frame, limit V [m/s] and gain [1/s]."""

    frame: int
    limit: float
    gain: float


@compiled
def tip_speed_bounds(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds lb and ub (n,) [rad/s] to those of `TipSpeedLimit`.

    Without a control period, or for a frame at rest, they stay. `constants` are a
    `TipSpeedConstants`. Writes lb and ub; G and h have no rows.
    """
    own = TipSpeedConstants.of(constants)
    frame = own.frame
    gain = min(own.gain, step.rate)
    point = triple(Placement.of(step.placements[frame]).position)
    linear = (0.0, 0.0, 0.0)
    angular = (0.0, 0.0, 0.0)
    change = (0.0, 0.0, 0.0)
    for j in range(step.q.size):
        rate = step.last[j] * step.support[frame, j]
        joint = Twist.of(step.jacobian[j])
        v = scaled(rate, triple(joint.linear))
        w = scaled(rate, triple(joint.angular))
        # The joints before this one move its axis.
        moved = combined(1.0, cross(linear, w), 1.0, cross(angular, v))
        turned = cross(cross(angular, w), point)
        change = combined(1.0, change, 1.0, combined(1.0, moved, 1.0, turned))
        linear = combined(1.0, linear, 1.0, v)
        angular = combined(1.0, angular, 1.0, w)
    velocity = combined(1.0, linear, 1.0, cross(angular, point))
    change = combined(1.0, change, 1.0, cross(angular, velocity))
    speed = math.sqrt(dot(velocity, velocity))
    if not (speed > 0.0 and step.rate < np.inf):
        return
    direction = scaled(1.0 / speed, velocity)
    along = np.empty(step.q.size)
    total = 0.0
    for j in range(step.q.size):
        along[j] = step.support[frame, j] * rate_along(step.jacobian, j, point, direction)
        total += abs(along[j])
    added = max(dot(direction, change), 0.0)
    growth = (gain * (own.limit - speed) - added) / (step.rate * total)
    for j in range(step.q.size):
        if along[j] > NEGLIGIBLE:
            ub[j] = max(min(ub[j], step.last[j] + growth), lb[j])
        elif along[j] < -NEGLIGIBLE:
            lb[j] = min(max(lb[j], step.last[j] - growth), ub[j])


@dataclass(frozen=True)
class TipSpeedLimit(Limit):
    r"""Limit of the speed of a frame's origin, as joint velocity bounds beside acceleration limits.

    With the last command a frame moves at :math:`v = J \dot q` and the speed :math:`s = \|v\|`, to
    which joint j contributes :math:`g_j \dot q_j`, :math:`g = J^T v / s`. In a period dt the change
    of the posture alone adds :math:`dt\,c` to it, :math:`c = v^T \dot J \dot q / s`. Each joint may
    add an equal part of what is left to the limit V,

    .. math::

        \operatorname{sign}(g_j)\,(\dot q_j - \dot q_j^{last}) \;\le\;
            dt\,\frac{\gamma\,(V - s) - \max(c, 0)}{\sum_i |g_i|},

    so that the speed grows by at most :math:`\gamma\,dt\,(V - s)` in a step, and shrinks by as much
    above the limit, up to terms of second order in dt. The distance to V shrinks exponentially, as
    that to a position limit does.

    The bounds give way to those of acceleration and jerk, without which nothing ties a command to
    the last one, and to position limits: where a joint brakes for one of its own limits, the frame
    may be quicker than V for some hundredths of a second (docs/limits.md has the figures).

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
        """Return `TipSpeedConstants`."""
        frame = robot.frame_id(self.frame_name(robot))
        return TipSpeedConstants.make(frame=frame, limit=self.limit, gain=self.gain)
