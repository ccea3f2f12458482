"""A target that is set from outside: by a person's hand, a camera, another program."""

import math
from typing import Any, ClassVar

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.checks import Array, finite_array, not_negative, offers, positive
from iiwa_dnn.errors import InvalidInputError, import_extra
from iiwa_dnn.references.base import Pose, Reference

_Place = tuple[Array, Array]  # position and rotation


class MovingTarget(Reference):
    """A pose that may jump, approached at a limited speed.

    The target moves to the pose given by `set` in a straight line and about a fixed axis, as time
    goes on in `at`: a controller never sees a jump, and a policy's slowed clock slows the target.

    With an acceleration, the target also starts and brakes smoothly: by the time-optimal trajectory
    from its present motion to rest at the pose (L. Berscheid, T. Kroeger, "Jerk-limited real-time
    trajectory generation with arbitrary target states", RSS 2021; the library ruckig). The angular
    limits are in the same proportion to `rate` as the linear ones are to `speed`.

    Attributes:
        speed: Largest linear speed of the target [m/s].
        rate: Largest angular speed of the target [rad/s].
        acceleration: Largest linear acceleration [m/s^2]; None: the speed may jump.
        jerk: Largest linear jerk [m/s^3]; None: the acceleration may jump.
    """

    name: ClassVar[str] = "moving target"

    def __init__(
        self,
        pose: Pose,
        speed: float = 0.25,
        rate: float = 1.0,
        acceleration: float | None = None,
        jerk: float | None = None,
    ) -> None:
        """Begin at rest at a pose, for example an ``iiwa_dnn.Configuration``.

        Raises:
            InvalidInputError: The pose is not finite, or a limit is not a number above zero; or a
                jerk is given without an acceleration.
            MissingDependencyError: An acceleration is given and ruckig is not installed.
        """
        self.speed, self.rate = not_negative("speed", speed), not_negative("rate", rate)
        self.acceleration, self.jerk = acceleration, jerk
        self._filter = None
        if acceleration is not None:
            limits = (positive("speed", speed), positive("rate", rate))
            hardest = math.inf if jerk is None else positive("jerk", jerk)
            self._filter = _Filter(limits, positive("acceleration", acceleration), hardest)
        elif jerk is not None:
            raise InvalidInputError("jerk", "needs an acceleration beside it", jerk)
        self._time: float | None = None
        self._velocity: Array = np.zeros(6)
        offers("pose", pose, "position", "rotation")
        self._wanted = pose.position.copy(), pose.rotation.copy()
        self.set(pose.position, pose.rotation)
        self._now = self._wanted

    def set(self, position: ArrayLike, rotation: ArrayLike | None = None) -> None:
        """Set the desired pose of the frame.

        Args:
            position: Position [m], (3,).
            rotation: Orientation, (3, 3); None keeps the last one.

        Raises:
            InvalidInputError: An array is not finite, has a wrong shape or is no rotation; the
                target stays as it was.
        """
        place = finite_array("position", position, (3,))
        turn = self._wanted[1] if rotation is None else checks.rotation("rotation", rotation)
        if not (np.array_equal(place, self._wanted[0]) and np.array_equal(turn, self._wanted[1])):
            self._wanted = place, turn

    @property
    def period(self) -> float:
        """Infinite: it does not repeat."""
        return math.inf

    def _targets(self, times: Array) -> Array:
        return np.stack([self._move_to(t) for t in times.tolist()])

    def _move_to(self, t: float) -> Array:
        """Let the target move until time t; returns its data (18,)."""
        elapsed = 0.0 if self._time is None else t - self._time
        if elapsed > 0.0:
            move = self._straight if self._filter is None else self._filter.move
            *now, self._velocity = move(self._now, self._wanted, elapsed)
            self._now = now[0], now[1]
        if self._time is None or elapsed > 0.0:
            self._time = t
        position, rotation = self._now
        return np.concatenate([position, rotation.ravel(), self._velocity])

    def _straight(self, now: _Place, goal: _Place, elapsed: float) -> tuple[Array, Array, Array]:
        """Return position, rotation and velocities (6,) after a time [s] at the largest speeds."""
        shift, axis = goal[0] - now[0], np.asarray(pin.log3(goal[1] @ now[1].T))
        shift = shift * _share(float(np.linalg.norm(shift)), self.speed * elapsed)
        axis = axis * _share(float(np.linalg.norm(axis)), self.rate * elapsed)
        return now[0] + shift, pin.exp3(axis) @ now[1], np.concatenate([shift, axis]) / elapsed

    def accelerations(self, t: float) -> Array:
        """Return zeros, (6,): it is not known how the target will move on."""
        return np.zeros(6)

    def settings(self) -> dict[str, Any]:
        """Return name and speeds, in values that JSON knows."""
        limits = {"acceleration": self.acceleration, "jerk": self.jerk}
        given = {name: value for name, value in limits.items() if value is not None}
        return {"name": self.name, "speed": self.speed, "rate": self.rate, **given}


class _Filter:
    """Time-optimal motion of a pose: six axes, the last three a rotation vector from `_anchor`."""

    def __init__(self, limits: tuple[float, float], acceleration: float, jerk: float) -> None:
        ruckig = import_extra("ruckig", "pip install ruckig")  # for filters of accelerations only
        self._ruckig, self._ask = ruckig.Ruckig(6), ruckig.InputParameter(6)
        self._way = ruckig.Trajectory(6)
        # The limits of ruckig are those of each axis, these are of the whole vector.
        most = np.repeat(limits, 3) / math.sqrt(3.0)
        self._ask.max_velocity = most.tolist()
        self._ask.max_acceleration = (acceleration / limits[0] * most).tolist()
        self._ask.max_jerk = (jerk / limits[0] * most).tolist()
        self._goal: _Place | None = None
        self._spent = 0.0
        self._motion: Array = np.zeros((2, 6))
        self._start: Array = np.zeros(3)
        self._anchor: Array = np.eye(3)

    def move(self, now: _Place, goal: _Place, elapsed: float) -> tuple[Array, Array, Array]:
        """Return position (3,), rotation (3, 3) and velocities (6,) after a time [s]."""
        if self._goal is not goal:
            axis = np.asarray(pin.log3(goal[1] @ now[1].T))
            ask = self._ask
            ask.current_position = [0.0] * 6
            ask.current_velocity, ask.current_acceleration = self._motion.tolist()
            ask.target_position = [*(goal[0] - now[0]), *axis]
            if self._ruckig.calculate(ask, self._way).value >= 0:
                self._goal, self._spent = goal, 0.0
                self._start, self._anchor = now
        self._spent += elapsed
        shift, velocity = self._at(self._spent)
        later = self._at(self._spent + _STEP)[1]
        self._motion = np.stack([velocity, (later - velocity) / _STEP])
        return self._start + shift[:3], pin.exp3(shift[3:]) @ self._anchor, velocity

    def _at(self, t: float) -> tuple[Array, Array]:
        """Displacement and velocities (6,), the latter's last three of the world's frame."""
        place, speed, _ = map(np.array, self._way.at_time(min(t, self._way.duration)))
        if t >= self._way.duration:
            speed[:] = 0.0
        # The left Jacobian of the rotation vector gives the angular velocity in the world's axes.
        speed[3:] = pin.Jexp3(-place[3:]) @ speed[3:]
        return place, speed


_STEP = 1e-6
"""Difference of time for the acceleration [s]."""


def _share(size: float, most: float) -> float:
    """Return the share of a way that may be gone."""
    return 1.0 if size <= most else most / size
