r"""Limit of the speed of a frame's origin, at every step and on the motion to rest.

A step has one row, along the direction n of the velocity that the last command :math:`\dot q` gives
the frame, of the speed :math:`s = \|J \dot q\|`. In a period dt the change of the posture adds at
most dt B to it, with B of `iiwa_dnn.schemes.scene` for the joints' velocities:

.. math::  n \cdot J x \;\le\; s + \min(\gamma\,dt, 1)\,(V - dt\,B - s)

A command across n may still be quicker than V. What keeps V is the second kernel: along the motion
to rest the frame's velocity is computed at up to `NODES` times, each at the positions with which
its period begins and ends. Where the joints move at most at w, change it by a between two nodes,
h apart, and by a rate that changes by j, the speed between is above the larger of both by at most

.. math::

    \tfrac18 \Bigl(\tfrac32\,h^2\,B(w) \sum_k w_k + \tfrac32\,h\,(B(w + a) - B(w))
        + \sum_k r_k\,j_k\Bigr),

since a convex function's largest value lies at an end, and the three sums bound the third
derivative of the frame's position by positions, velocities and accelerations of the joints.
"""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import sin_cos
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import combined, cross, dot, scaled, triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.robot.meetings import Watched
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.rest import UNEVEN, Motion, displacement_after, velocity_at
from iiwa_dnn.schemes.scene import Body, Pair, make_pair, second_order
from iiwa_dnn.schemes.step import StepViews, rate_along

NODES = 16
"""Largest number of times along a motion to rest at which the speed is computed."""

PEAK = 4.0 / 27.0
"""Largest value of u (1 - u)^2, the factor of b in a velocity."""


class TipSpeedConstants(Record):
    """Constants of `TipSpeedLimit`.

    Attributes:
        frame: Index of the frame.
        limit: Largest speed V [m/s].
        gain: Rate at which the speed may come near to the limit [1/s].
        reach: `Pair` of the base and the frame's origin, (4 + 2 n,).
    """

    frame: int
    limit: float
    gain: float
    reach: Vector = part("reach")


@compiled
def tip_speed_rows(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write G (1, n) and h (1,) of `TipSpeedLimit`; lb and ub (n,) stay.

    Without a control period, or for a frame at rest, the row is idle. `constants` are
    `TipSpeedConstants`.
    """
    dof = step.q.size
    own = TipSpeedConstants.of(constants)
    rates = np.empty(dof)
    for j in range(dof):
        rates[j] = abs(step.last[j])
    velocity = velocity_after(step, own, np.zeros(dof), step.last)
    speed = math.sqrt(dot(velocity, velocity))
    h[:] = np.inf
    if not (speed > 0.0 and step.rate < np.inf):
        return
    point = triple(Placement.of(step.placements[own.frame]).position)
    direction = scaled(1.0 / speed, velocity)
    limit = own.limit - second_order(Pair.of(own.reach), rates) / step.rate
    h[:] = speed + min(own.gain / step.rate, 1.0) * (limit - speed)
    for row in range(h.size):
        for j in range(dof):
            G[row, j] = step.support[own.frame, j] * rate_along(step.jacobian, j, point, direction)


@compiled
def velocity_after(
    step: StepViews, own: TipSpeedConstants, displacement: Vector, rates: Vector
) -> Vector3:
    """Compute the velocity of the frame's origin after displacements of the joints [m/s].

    Args:
        step: The instant, whose Jacobian has the axes of the joints before the displacements.
        own: The frame.
        displacement: Displacement of each joint [rad], (n,).
        rates: Velocity of each joint after it [rad/s], (n,).
    """
    point = triple(Placement.of(step.placements[own.frame]).position)
    velocity = (0.0, 0.0, 0.0)
    for k in range(rates.size):
        j = rates.size - 1 - k  # a joint turns all that comes after it
        if step.support[own.frame, j] == 0.0:
            continue
        joint = Twist.of(step.jacobian[j])
        axis = triple(joint.angular)
        linear = triple(joint.linear)
        if dot(axis, axis) == 0.0:
            point = combined(1.0, point, displacement[j], linear)
            velocity = combined(1.0, velocity, rates[j], linear)
            continue
        sine, cosine = sin_cos(displacement[j])
        moved = combined(1.0, linear, 1.0, cross(axis, point))
        turned = cross(axis, velocity)
        change = combined(sine, moved, 1.0 - cosine, cross(axis, moved))
        turn = combined(sine, turned, 1.0 - cosine, cross(axis, turned))
        point = combined(1.0, point, 1.0, change)
        velocity = combined(1.0, velocity, 1.0, turn)
        own_rate = combined(1.0, linear, 1.0, cross(axis, point))
        velocity = combined(1.0, velocity, rates[j], own_rate)
    return velocity


@compiled
def keeps_speed(step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Test whether the frame surely is no quicker than its limit on a motion to rest.

    `constants` are `TipSpeedConstants`.
    """
    dof = step.q.size
    own = TipSpeedConstants.of(constants)
    periods = max(motion.periods, 1.0)
    count = int(min(math.ceil(periods), NODES))
    left = own.limit - _between_nodes(own, motion, periods, count)
    if left == own.limit:
        return True
    displacement = np.empty(dof)
    rates = np.empty(dof)
    for k in range(2 * count):
        begun = periods * (k // 2) / count
        for j in range(dof):
            x = motion.first[j]
            b = motion.coefficient[j]
            displacement[j] = displacement_after(motion, x, b, begun + k % 2)
            rates[j] = velocity_at(x, b, begun / periods, motion.cubic)
        velocity = velocity_after(step, own, displacement, rates)
        if left < 0.0 or dot(velocity, velocity) > left * left:
            return False
    return True


@compiled
def _between_nodes(own: TipSpeedConstants, motion: Motion, periods: float, count: int) -> float:
    """Bound the part of the speed between two nodes that is above both [m/s].

    It is 0 if the joints are so slow that the frame cannot be quicker than its limit anywhere.

    Args:
        own: The limit.
        motion: The motion, of n joints.
        periods: Number of its periods, at least 1.
        count: Number of nodes.
    """
    reach = Pair.of(own.reach)
    dof = motion.first.size
    rates = np.empty(dof)
    faster = np.empty(dof)
    uneven = np.zeros(dof)
    step = motion.period * periods / count
    most = 0.0
    turning = 0.0
    bend = 0.0
    for j in range(dof):
        x = abs(motion.first[j])
        b = abs(motion.coefficient[j])
        radius = abs(reach.radii[j])
        rates[j] = x + PEAK * b
        faster[j] = rates[j] + (1.5 * x + b) / count
        uneven[j] = rates[j] + motion.period * (x + UNEVEN * b)
        most += radius * rates[j]
        turning += rates[j] if reach.radii[j] > 0.0 else 0.0
        bend += radius * (6.0 * x + 4.0 * b) / (count * count)
    if most <= own.limit:
        return 0.0
    B = second_order(reach, rates)
    above = 1.5 * step * step * B * turning
    if count < periods:
        above += 1.5 * step * (second_order(reach, faster) - B)
        above += bend if motion.cubic else 0.0
    if motion.varies:  # the joints may be elsewhere by a period more
        above += 4.0 * (second_order(reach, uneven) - B)
    return above / 8.0


@dataclass(frozen=True)
class TipSpeedLimit(Limit):
    """Limit of the speed of a frame's origin, kept at every step and until the arm rests.

    A scheme may have several, of any frames. If the arm begins at rest and follows its commands, no
    command and no stopping motion is quicker than the limit, between steps neither (the module has
    the bound). Near the limit a command that is refused is moved towards the stopping motion.

    Attributes:
        limit: Largest speed [m/s], above 0.
        frame: The frame; None takes the tip.
        gain: Rate at which the speed may come near to the limit [1/s], above 0.
    """

    kernel = staticmethod(tip_speed_rows)
    rest_kernel = staticmethod(keeps_speed)
    rows = 1
    _checks: ClassVar[checks.Checks] = {"limit": checks.positive, "gain": checks.positive}
    limit: float
    frame: str | None = None
    gain: float = 100.0

    def row_names(self, robot: Robot) -> list[str]:
        """Return the name of the row, the frame's."""
        return [f"speed of {self.frame_name(robot)}"]

    def constants(self, robot: Robot) -> Vector:
        """Return `TipSpeedConstants`."""
        frame = robot.frame_id(self.frame_name(robot))
        ends = [
            Body.make(
                frame=k, radius=0.0, speed=0.0, half=np.zeros(3), axes=np.eye(3), center=np.zeros(3)
            )
            for k in (0, frame)
        ]
        reach = make_pair(robot, ends, Watched(0, 1), 0.0)
        return TipSpeedConstants.make(
            frame=frame, limit=self.limit, gain=self.gain, reach=reach.numbers
        )
