"""A target that is set from outside: by a person's hand, a camera, another program."""

import math
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, not_negative, offers
from iiwa_dnn.references.base import Pose, Reference
from iiwa_dnn.references.targets import Target

_ARRIVED = 1e-12
"""Distance [m] and angle [rad] below which a target is at its goal: rounding has no direction."""


class MovingTarget(Reference):
    """A pose that may jump, approached at a limited speed.

    From the pose shown last when `set` was called the target moves to the new one, in a straight
    line and about a fixed axis, as a function of the time in `at`: a controller never sees a jump,
    and a policy's slowed clock slows the target. A time before that last one begins the motion
    anew, from the same pose. `set` may be called in another thread than `at`. The speed of the
    target jumps: limits on acceleration and jerk are those of the controller.

    Attributes:
        speed: Largest linear speed of the target [m/s].
        rate: Largest angular speed of the target [rad/s].
    """

    name: str = "moving target"
    period: float = math.inf

    def __init__(self, pose: Pose, speed: float = 0.25, rate: float = 1.0) -> None:
        """Begin at rest at a pose, for example an ``iiwa_dnn.Configuration``.

        Raises:
            InvalidInputError: The pose is not finite, or a speed is not a number of at least 0.
        """
        offers("pose", pose, "position", "rotation")
        self.speed = not_negative("speed", speed)
        self.rate = not_negative("rate", rate)
        self._goal = Target(pose.position, pose.rotation)
        self._end = self._goal
        self._shown = (math.inf, self._goal)
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

    def move(self, t: float, target: Array) -> None:
        """Set a target to the pose and the velocity at time t [s]; see `Reference.move`."""
        goal = self._goal  # one reading: it may be set in another thread meanwhile
        if goal is not self._end:
            self._start = self._shown
            self._end = goal
        began, start = self._start
        began = min(t, began)
        self._start = (began, start)
        turn = pin.log3(goal.rotation @ start.rotation.T)
        moved, velocity = _approach(goal.position - start.position, self.speed, t - began)
        turned, rate = _approach(turn, self.rate, t - began)
        target[:3] = start.position + moved
        target[3:12] = (pin.exp3(turned) @ start.rotation).ravel()
        target[12:15] = velocity
        target[15:] = rate
        self._shown = (t, Target.from_data(target.copy()))

    def settings(self) -> dict[str, Any]:
        """Return name and speeds, in values that JSON knows."""
        return {"name": self.name, "speed": self.speed, "rate": self.rate}


def _approach(difference: Array, fastest: float, elapsed: float) -> tuple[Array, Array]:
    """Return the part (3,) of a difference (3,) covered after a time [s], and its rate (3,)."""
    length = float(np.linalg.norm(difference))
    if length <= max(fastest * elapsed, _ARRIVED):
        return difference, np.zeros(3)
    velocity = fastest / length * difference
    return elapsed * velocity, velocity
