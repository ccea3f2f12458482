"""A target that is set from outside: by a person's hand, a camera, another program."""

import math
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.checks import Array, finite_array, not_negative, offers, positive
from iiwa_dnn.errors import InvalidInputError, import_extra
from iiwa_dnn.references.base import Pose, Reference
from iiwa_dnn.references.rotations import jacobian_rate

_ARRIVED = 1e-12
"""Distance [m] and angle [rad] below which a target is at its goal: rounding has no direction."""


class _Goal(NamedTuple):
    """A pose to go to: position (3,) and rotation (3, 3)."""

    position: Array
    rotation: Array


class _State(NamedTuple):
    """Pose, velocity and acceleration of the target at a time.

    The last two are linear and angular, (6,), along the world's axes.
    """

    t: float
    position: Array
    rotation: Array
    velocity: Array
    acceleration: Array


class MovingTarget(Reference):
    """A pose that may jump, approached at a limited speed.

    From the pose shown last when `set` was called the target moves to the new one, in a straight
    line and about a fixed axis, as a function of the time in `at`: a controller never sees a jump,
    and a policy's slowed clock slows the target. A time before that last one begins the motion
    anew, from the same pose. `set` may be called in another thread than `at`.

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
        offers("pose", pose, "position", "rotation")
        self.speed = not_negative("speed", speed)
        self.rate = not_negative("rate", rate)
        self.acceleration = acceleration
        self.jerk = jerk
        self._profile: _Profile | None = None
        if acceleration is not None:
            positive("speed", speed)
            positive("rate", rate)
            positive("acceleration", acceleration)
            hardest = math.inf if jerk is None else positive("jerk", jerk)
            self._profile = _Profile(np.array([speed, acceleration, hardest]), rate / speed)
        elif jerk is not None:
            raise InvalidInputError("jerk", "needs an acceleration beside it", jerk)
        position = finite_array("position", pose.position, (3,))
        self._goal = _Goal(position, checks.rotation("rotation", pose.rotation))
        self._shown = _State(math.inf, *self._goal, np.zeros(6), np.zeros(6))
        self._start = self._shown
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
        goal = self._goal
        wanted = finite_array("position", position, (3,))
        turned = goal.rotation if rotation is None else checks.rotation("rotation", rotation)
        if not (np.array_equal(wanted, goal.position) and np.array_equal(turned, goal.rotation)):
            self._goal = _Goal(wanted, turned)

    @property
    def period(self) -> float:
        """Infinite: it does not repeat."""
        return math.inf

    def move(self, t: float, target: Array) -> None:
        """Set a target to the pose and the velocity at time t [s]; see `Reference.move`."""
        goal = self._goal  # one reading: it may be set in another thread meanwhile
        profile = self._profile
        if goal is not self._end and (profile is None or profile.fit(self._shown, goal)):
            self._start = self._shown
            self._end = goal
        self._start = self._start._replace(t=min(t, self._start.t))
        self._shown = state = self._state(t)
        target[:3] = state.position
        target[3:12] = state.rotation.ravel()
        target[12:] = state.velocity

    def _state(self, t: float) -> _State:
        """Compute the state at a time [s], not before the start's."""
        start = self._start
        elapsed = t - start.t
        if self._profile is not None:
            moved, velocity, acceleration = self._profile.at(elapsed)
        else:
            way = _difference(start, self._end)
            moved = np.zeros(6)
            velocity = np.zeros(6)
            acceleration = np.zeros(6)
            for part, fastest in ((slice(0, 3), self.speed), (slice(3, 6), self.rate)):
                length = float(np.linalg.norm(way[part]))
                if length > max(fastest * elapsed, _ARRIVED):
                    velocity[part] = fastest / length * way[part]
                    moved[part] = elapsed * velocity[part]
                else:
                    moved[part] = way[part]
        rotation = pin.exp3(moved[3:]) @ start.rotation
        return _State(t, start.position + moved[:3], rotation, velocity, acceleration)

    def accelerations(self, t: float) -> Array:
        """Return zeros, (6,): it is not known how the target will move on."""
        return np.zeros(6)

    def settings(self) -> dict[str, Any]:
        """Return name and speeds, in values that JSON knows."""
        limits = {"acceleration": self.acceleration, "jerk": self.jerk}
        given = {name: value for name, value in limits.items() if value is not None}
        return {"name": self.name, "speed": self.speed, "rate": self.rate, **given}


class _Profile:
    """Time-optimal motion from a state to rest at a pose.

    Six axes: the displacement and, from the first orientation on, the rotation vector.
    """

    def __init__(self, limits: Array, turning: float) -> None:
        """Take linear speed, acceleration and jerk, and the angular limits' ratio to them."""
        ruckig = import_extra("ruckig", "pip install ruckig")  # for limits of acceleration only
        self._ruckig = ruckig.Ruckig(6)
        self._input = ruckig.InputParameter(6)
        self._trajectory = ruckig.Trajectory(6)
        # The limits of ruckig are those of each axis, these are of the whole vector.
        axes = np.repeat([1.0, turning], 3) / math.sqrt(3.0)
        self._input.max_velocity = (limits[0] * axes).tolist()
        self._input.max_acceleration = (limits[1] * axes).tolist()
        self._input.max_jerk = (limits[2] * axes).tolist()
        self._input.current_position = [0.0] * 6
        self.fit(_State(0.0, np.zeros(3), np.eye(3), np.zeros(6), np.zeros(6)), _ORIGIN)

    def fit(self, start: _State, goal: _Goal) -> bool:
        """Fit the motion from a state to a pose; without success the one before stays."""
        self._input.current_velocity = start.velocity.tolist()
        self._input.current_acceleration = start.acceleration.tolist()
        self._input.target_position = _difference(start, goal).tolist()
        return bool(self._ruckig.calculate(self._input, self._trajectory).value >= 0)

    def at(self, elapsed: float) -> tuple[Array, Array, Array]:
        """Return displacement, velocity and acceleration (6,) a time [s] after the start."""
        end = self._trajectory.duration
        moved, velocity, acceleration = map(np.array, self._trajectory.at_time(min(elapsed, end)))
        if elapsed >= end:
            return moved, np.zeros(6), np.zeros(6)
        # The left Jacobian of the rotation vector gives the angular velocity in the world's axes.
        jacobian = pin.Jexp3(-moved[3:])
        bent = jacobian_rate(tuple(moved[3:]), tuple(velocity[3:]))
        acceleration[3:] = jacobian @ acceleration[3:] + bent
        velocity[3:] = jacobian @ velocity[3:]
        return moved, velocity, acceleration


_ORIGIN = _Goal(np.zeros(3), np.eye(3))


def _difference(start: _State, goal: _Goal) -> Array:
    """Compute displacement and rotation vector (6,) from a state to a pose."""
    turn = pin.log3(goal.rotation @ start.rotation.T)
    return np.concatenate([goal.position - start.position, turn])
