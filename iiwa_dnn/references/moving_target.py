r"""A target that is set from outside: by a person's hand, a camera, another program.

Its path is a uniform cubic B-spline, whose control points are `SPACING` [s] apart. A control point
moves on by a velocity times this time, which is within the speed and changes by no more than an
acceleration admits. Velocity and acceleration of such a spline are means of those of its control
points: they keep the same bounds, and are continuous. Orientations are a cumulative B-spline, whose
velocity is such a mean too.

Control points are two spacings ahead of the time. They aim at the pose that was set last, or where
the last two poses lead, and come to rest there.

Sources: M.-J. Kim, M.-S. Kim, S. Y. Shin, "A general construction scheme for unit quaternion curves
with simple high order derivatives", SIGGRAPH 1995, for the orientations.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, Vector3, not_negative, offers
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.references.base import Pose, Reference
from iiwa_dnn.references.rotations import combined, dot, scaled, set_mean_twist, triple, turn_about
from iiwa_dnn.references.targets import Target, TargetData

ARRIVED = 1e-12
"""Distance [m] and angle [rad] below which a target is at its goal: rounding has no direction."""

SPACING = 0.02
"""Time between two control points [s]."""

APPROACH = 2.0 * SPACING
"""Time constant with which a target that is near approaches its goal [s]."""

LINEAR = 2.0
"""Largest linear acceleration of a target [m/s^2]."""

ANGULAR = 8.0
"""Largest angular acceleration of a target [rad/s^2]."""

DENSE = 0.05
"""Longest time between two poses of a stream that is shown on time, where it leads [s].

Its error is that time squared times an acceleration; from twice that time on the stream is shown
one pose late, without that error.
"""

SLOWEST = 0.5
"""Longest time between two poses of a stream [s]; after a longer one it begins anew."""

SILENCE = 1.5
"""Sampling periods after which a stream without a new pose comes to rest at the last one."""


class Rates(Record):
    """Linear [m/s] and angular [rad/s] velocity."""

    linear: Array = part(3)
    angular: Array = part(3)


class MovingPath(Record):
    """Path of a moving target from when its goal was set.

    Attributes:
        begin: Time at which the goal was set [s].
        age: Time of the last knot since then [s].
        sampling: Time from the goal before, in a stream [s]; else 0.
        first: Control point of the knot before the last one, a `TargetData`.
        last: Control point of the knot after the next one, a `TargetData`.
        goal: Pose that was set last, a `TargetData`.
        behind: Velocity from the first control point to the next.
        present: That to the third.
        ahead: That to the last.
        pace: Velocity of the stream; else 0.
    """

    begin: float
    age: float
    sampling: float
    first: Array = part(18)
    last: Array = part(18)
    goal: Array = part(18)
    behind: Rates = part(Rates)
    present: Rates = part(Rates)
    ahead: Rates = part(Rates)
    pace: Rates = part(Rates)


class MovingTarget(Reference):
    """A desired pose that is set from outside and may jump, approached at a limited speed.

    A pose that is set alone is approached from the one that was sampled last along a straight line
    and about a fixed axis, and the target rests there. Poses that are set one soon after another,
    each within the speed from the last, are a stream: at 20 Hz or more the target is where they
    lead, at 10 Hz or less it passes each of them one sampling period later. It is a function of the
    time in `at`: a policy that slows the path's clock slows the target. If that time goes back to
    before the motion began, the motion begins anew at that time, from the same pose. `set` may be
    called in another thread than `at`.

    Attributes:
        speed: Largest linear speed of the target [m/s].
        rate: Largest angular speed of the target [rad/s].
    """

    name: str = "moving target"
    period: float = np.inf

    def __init__(self, pose: Pose, speed: float = 0.25, rate: float = 1.0) -> None:
        """Start at rest at a pose, for example an ``iiwa_dnn.Configuration``.

        Raises:
            InvalidInputError: The pose is not finite, or a speed is not a number of at least 0.
        """
        offers("pose", pose, "position", "rotation")
        self.speed = not_negative("speed", speed)
        self.rate = not_negative("rate", rate)
        self._goal = Target(pose.position, pose.rotation)
        self._begun = MovingPath.zeros()
        self._begun.begin = np.inf
        for pose_of in (self._begun.first, self._begun.last, self._begun.goal):
            pose_of[:] = self._goal.data
        self._path = self._begun.copy()
        self._time = np.inf  # that was sampled last
        self._end = self._goal

    def set(self, position: ArrayLike, rotation: ArrayLike | None = None) -> None:
        """Set the desired pose of the frame.

        Args:
            position: Position [m], (3,).
            rotation: Orientation, (3, 3); None keeps the last one.

        Raises:
            InvalidInputError: An array is not finite, has a wrong shape or is no rotation; the
                target stays as it was.
        """
        self._goal = Target(position, self._goal.rotation if rotation is None else rotation)

    def move(self, t: float, target: TargetData) -> None:
        """Set a target to the pose and the velocity at time t [s]; see `Reference.move`."""
        goal = self._goal  # one reading: it may be set in another thread meanwhile
        if goal is not self._end:
            if self._time < np.inf:
                self._bring_to(self._time)
            take_goal(self._path, goal.data, self._time, self.speed, self.rate)
            self._begun = self._path.copy()
            self._end = goal
        self._bring_to(t)
        target[:] = self._path.first
        show(self._path, t, target)
        self._time = t

    def _bring_to(self, t: float) -> None:
        """Bring the path to the last knot before the time t [s]."""
        self._begun.begin = min(self._begun.begin, t)
        if not t - self._path.begin >= self._path.age or self._path.begin > t:
            self._path = self._begun.copy()
        advance(self._path, t, self.speed, self.rate)

    def settings(self) -> dict[str, Any]:
        """Return name and speeds, in JSON types."""
        return {"name": self.name, "speed": self.speed, "rate": self.rate}


@compiled
def take_goal(own: MovingPath, goal: Array, now: float, speed: float, rate: float) -> None:
    """Take the goal (18,) that was set at the time `now` [s]; inf: before the path began."""
    elapsed = now - own.begin if own.begin < np.inf else np.inf
    if elapsed > 0.0:
        own.sampling = elapsed if elapsed <= SLOWEST else 0.0
        way = TargetData.of(own.goal.copy())
        set_mean_twist(way, TargetData.of(goal), elapsed)
        v = triple(way.linear_velocity)
        turn = triple(way.angular_velocity)
        flows = own.sampling > 0.0
        for i in range(3):
            own.pace.linear[i] = v[i] if flows and dot(v, v) <= speed * speed else 0.0
            own.pace.angular[i] = turn[i] if flows and dot(turn, turn) <= rate * rate else 0.0
        own.age -= elapsed if elapsed < np.inf else 0.0
        own.begin = now
    for i in range(own.goal.size):
        own.goal[i] = goal[i]


@compiled
def advance(own: MovingPath, t: float, speed: float, rate: float) -> None:
    """Advance a path to the last knot before the time t [s], within the speed and the rate."""
    moves = True
    while moves and own.age + SPACING <= t - own.begin:
        _add_motion(TargetData.of(own.first), own.behind, SPACING, 0.0)
        for i in range(3):
            own.behind.linear[i] = own.present.linear[i]
            own.behind.angular[i] = own.present.angular[i]
            own.present.linear[i] = own.ahead.linear[i]
            own.present.angular[i] = own.ahead.angular[i]
        own.age += SPACING
        _set_rates(own, speed, rate)
        _add_motion(TargetData.of(own.last), own.ahead, SPACING, 0.0)
        moves = _is_moving(own.behind) or _is_moving(own.present) or _is_moving(own.ahead)
    if not moves:
        own.age = t - own.begin


@compiled
def _is_moving(rates: Rates) -> bool:
    """Test whether velocities are not all zero."""
    linear = triple(rates.linear)
    angular = triple(rates.angular)
    return dot(linear, linear) + dot(angular, angular) > 0.0


@compiled
def _set_rates(own: MovingPath, speed: float, rate: float) -> None:
    """Compute the velocities by which the last control point moves on: `ahead`."""
    way = TargetData.of(own.last.copy())
    set_mean_twist(way, TargetData.of(own.goal), 1.0)
    flows = own.age <= SILENCE * own.sampling
    late = min(max(2.0 * (own.sampling - DENSE), 0.0), own.sampling)
    ahead = own.age + SPACING - late  # the control point that moves on is one spacing ahead
    share = 1.0 if flows else 0.0
    pace = scaled(share, triple(own.pace.linear))
    turn = scaled(share, triple(own.pace.angular))
    left = combined(1.0, triple(way.linear_velocity), ahead, pace)
    angle = combined(1.0, triple(way.angular_velocity), ahead, turn)
    v = _next_rate(triple(own.ahead.linear), pace, left, speed, LINEAR)
    spin = _next_rate(triple(own.ahead.angular), turn, angle, rate, ANGULAR)
    for i in range(3):
        own.ahead.linear[i] = v[i]
        own.ahead.angular[i] = spin[i]


@compiled
def _next_rate(
    last: Vector3, pace: Vector3, left: Vector3, most: float, acceleration: float
) -> Vector3:
    """Compute a velocity with which what is left vanishes, and the pace remains.

    Args:
        last: Velocity before.
        pace: Velocity of the goal.
        left: Displacement to it.
        most: Largest speed.
        acceleration: Largest acceleration.
    """
    distance = math.sqrt(dot(left, left))
    v = pace
    if distance > ARRIVED:
        v = combined(1.0, pace, min(1.0 / APPROACH, math.sqrt(acceleration / distance)), left)
    fastest = math.sqrt(dot(v, v))
    if fastest > most:
        v = scaled(most / fastest, v)
    change = combined(1.0, v, -1.0, last)
    size = math.sqrt(dot(change, change))
    if size > acceleration * SPACING:
        v = combined(1.0, last, acceleration * SPACING / size, change)
    return v


@compiled
def _add_motion(target: TargetData, rates: Rates, seconds: float, share: float) -> None:
    """Move a target by velocities for some seconds, and add a share of these to its own."""
    for i in range(3):
        target.position[i] += seconds * rates.linear[i]
        target.linear_velocity[i] += share * rates.linear[i]
    turn = triple(rates.angular)
    rate = math.sqrt(dot(turn, turn))
    if rate > 0.0:
        turn_about(target, scaled(1.0 / rate, turn), seconds * rate, share * rate)


@compiled
def show(own: MovingPath, t: float, target: TargetData) -> None:
    """Move a target at the first control point to a time t [s] after the last knot."""
    u = (t - own.begin - own.age) / SPACING
    sixth = SPACING / 6.0
    first = sixth * (5.0 + u * (3.0 + u * (u - 3.0)))
    second = sixth * (1.0 + u * (3.0 + u * (3.0 - 2.0 * u)))
    _add_motion(target, own.behind, first, 0.5 * (1.0 - u) * (1.0 - u))
    _add_motion(target, own.present, second, 0.5 + u * (1.0 - u))
    _add_motion(target, own.ahead, sixth * u * u * u, 0.5 * u * u)
