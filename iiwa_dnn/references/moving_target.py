"""A target that is set from outside: by a person's hand, a camera, another program."""

import math
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from iiwa_dnn.checks import Array, not_negative, offers, positive
from iiwa_dnn.errors import InvalidInputError, import_extra
from iiwa_dnn.references.base import Pose, Reference
from iiwa_dnn.references.rotations import jacobian_rate
from iiwa_dnn.references.targets import Target

_ARRIVED = 1e-12
"""Distance [m] and angle [rad] below which a target is at its goal: rounding has no direction."""


class _State(NamedTuple):
    """State of the target at a time.

    Attributes:
        t: Time [s].
        target: Pose and velocity.
        acceleration: Linear [m/s^2] and angular [rad/s^2], (6,), along the world's axes.
    """

    t: float
    target: Target
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
    period: float = math.inf

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
                jerk comes without an acceleration.
            MissingDependencyError: There is an acceleration limit and ruckig is not installed.
        """
        offers("pose", pose, "position", "rotation")
        self.speed = not_negative("speed", speed)
        self.rate = not_negative("rate", rate)
        self.acceleration = acceleration
        self.jerk = jerk
        self._ruckig: Any = None
        if acceleration is not None:
            for name in ("speed", "rate", "acceleration"):
                positive(name, getattr(self, name))
            positive("jerk", 1.0 if jerk is None else jerk)
            self._ruckig = import_extra("ruckig", "pip install ruckig")
            jacobian_rate((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))  # compiled now, not in a step
        elif jerk is not None:
            raise InvalidInputError("jerk", "needs an acceleration beside it", jerk)
        self._goal = Target(pose.position, pose.rotation)
        self._end = self._goal
        self._shown = _State(math.inf, self._goal, np.zeros(6))
        self._start = self._shown
        self._trajectory: Any = None

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
            self._turn_to(goal)
        self._start = self._start._replace(t=min(t, self._start.t))
        elapsed = t - self._start.t
        if self._trajectory is None:
            moved, velocity, acceleration = self._straight(elapsed)
        else:
            moved, velocity, acceleration = self._smooth(elapsed)
        start = self._start.target
        target[:3] = start.position + moved[:3]
        target[3:12] = (pin.exp3(moved[3:]) @ start.rotation).ravel()
        target[12:] = velocity
        self._shown = _State(t, Target.from_data(target.copy()), acceleration)

    def _turn_to(self, goal: Target) -> None:
        """Begin a motion from the state shown last to a pose."""
        if self.acceleration is not None:
            trajectory = self._fit(goal, self.acceleration)
            if trajectory is None:  # the motion goes on as it is
                return
            self._trajectory = trajectory
        self._start = self._shown
        self._end = goal

    def _straight(self, elapsed: float) -> tuple[Array, Array, Array]:
        """Compute displacement, velocity and acceleration (6,) a time [s] after the start."""
        difference = _difference(self._start, self._end)
        moved = difference.copy()
        velocity = np.zeros(6)
        for part, fastest in ((slice(0, 3), self.speed), (slice(3, 6), self.rate)):
            length = float(np.linalg.norm(difference[part]))
            if length > max(fastest * elapsed, _ARRIVED):
                velocity[part] = fastest / length * difference[part]
                moved[part] = elapsed * velocity[part]
        return moved, velocity, np.zeros(6)

    def _fit(self, goal: Target, acceleration: float) -> Any:
        """Fit ruckig's trajectory from the state shown last to a pose; None without success.

        Six axes: the displacement and, from the first orientation on, the rotation vector.
        """
        state = self._shown
        jerk = math.inf if self.jerk is None else self.jerk
        # The limits of ruckig are those of each axis, these are of the whole vector.
        axes = np.repeat([1.0, self.rate / self.speed], 3) / math.sqrt(3.0)
        asked = self._ruckig.InputParameter(6)
        asked.max_velocity = (self.speed * axes).tolist()
        asked.max_acceleration = (acceleration * axes).tolist()
        asked.max_jerk = (jerk * axes).tolist()
        asked.current_velocity = state.target.data[12:].tolist()
        asked.current_acceleration = state.acceleration.tolist()
        asked.target_position = _difference(state, goal).tolist()
        trajectory = self._ruckig.Trajectory(6)
        found = self._ruckig.Ruckig(6).calculate(asked, trajectory)
        return trajectory if found.value >= 0 else None

    def _smooth(self, elapsed: float) -> tuple[Array, Array, Array]:
        """Compute displacement, velocity and acceleration (6,) a time [s] after the start."""
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

    def accelerations(self, t: float) -> Array:
        """Return zeros, (6,): it is not known how the target will move on."""
        return np.zeros(6)

    def settings(self) -> dict[str, Any]:
        """Return name and speeds, in values that JSON knows."""
        names = ("name", "speed", "rate", "acceleration", "jerk")
        values = {name: getattr(self, name) for name in names}
        return {name: value for name, value in values.items() if value is not None}


def _difference(start: _State, goal: Target) -> Array:
    """Compute displacement and rotation vector (6,) from a state to a pose."""
    turn = pin.log3(goal.rotation @ start.target.rotation.T)
    return np.concatenate([goal.position - start.target.position, turn])
