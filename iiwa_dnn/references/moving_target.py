"""A target that is set from outside: by a person's hand, a camera, another program."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, not_negative, offers
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.references.base import Pose, Reference
from iiwa_dnn.references.rotations import dot, scaled, set_mean_twist, triple, turn_about
from iiwa_dnn.references.targets import Target, TargetData

ARRIVED = 1e-12
"""Distance [m] and angle [rad] below which a target is at its goal: rounding has no direction."""


class MovingTarget(Reference):
    """A desired pose that is set from outside and may jump, approached at a limited speed.

    After `set` the target moves from the pose that was sampled last to the new one, along a
    straight line and about a fixed axis, as a function of the time in `at`: a controller never sees
    a jump, and a policy that slows the path's clock slows the target. If the time in `at` goes back
    to before the motion began, the motion begins anew at that time, from the same pose. `set` may
    be called in another thread than `at`. The speed of the target jumps: limits on acceleration and
    jerk are those of the controller.

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
        self._end = self._goal
        self._shown = (np.inf, self._goal.data)
        self._start = self._shown

    def set(self, position: ArrayLike, rotation: ArrayLike | None = None) -> None:
        """Set the desired pose of the frame.

        Args:
            position: Position [m], (3,).
            rotation: Orientation, (3, 3); None keeps the last one.

        Raises:
            InvalidInputError: An array is not finite, has a wrong shape or is no rotation; the
                target stays as it was.
        """
        goal = Target(position, self._goal.rotation if rotation is None else rotation)
        if not np.array_equal(goal.data, self._goal.data):
            self._goal = goal

    def move(self, t: float, target: TargetData) -> None:
        """Set a target to the pose and the velocity at time t [s]; see `Reference.move`."""
        goal = self._goal  # one reading: it may be set in another thread meanwhile
        began, start = self._start if goal is self._end else self._shown
        self._end = goal
        self._start = (min(t, began), start)
        target[:] = start
        approach(target, TargetData.of(goal.data), t - self._start[0], self.speed, self.rate)
        self._shown = (t, target.copy())

    def settings(self) -> dict[str, Any]:
        """Return name and speeds, in JSON types."""
        return {"name": self.name, "speed": self.speed, "rate": self.rate}


@compiled
def approach(
    target: TargetData, goal: TargetData, elapsed: float, speed: float, rate: float
) -> None:
    """Move a target towards a goal at limited speed for a time, and set its twist.

    Args:
        target: The target, overwritten.
        goal: The goal.
        elapsed: The time [s].
        speed: Largest linear speed [m/s].
        rate: Largest angular speed [rad/s].
    """
    set_mean_twist(target, goal, 1.0)
    path = triple(target.linear_velocity)
    turn = triple(target.angular_velocity)
    moved = _paced(target.linear_velocity, speed, elapsed)
    turned = _paced(target.angular_velocity, rate, elapsed)
    for i in range(3):
        target.position[i] += moved * path[i]
    angle = np.sqrt(dot(turn, turn))
    if angle > 0.0:
        turn_about(target, scaled(1.0 / angle, turn), turned * angle, 0.0)


@compiled
def _paced(path: Array, fastest: float, elapsed: float) -> float:
    """Replace a displacement (3,) by the velocity along it; return the fraction that is covered.

    Args:
        path: The displacement; it becomes a velocity of the fastest speed, 0 where all is covered.
        fastest: Largest speed [1/s].
        elapsed: Time since the motion began [s].
    """
    length = np.sqrt(dot(triple(path), triple(path)))
    arrived = length <= max(fastest * elapsed, ARRIVED)
    velocity = 0.0 if arrived else fastest / length
    for i in range(3):
        path[i] *= velocity
    return 1.0 if arrived else elapsed * velocity
