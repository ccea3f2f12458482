"""Names of a controller's limits, and the kind of a joint's bound.

With acceleration or jerk limits a bound is made of all of them at once. It is said to be of the one
whose own bound it equals, or of a position.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.naming import describe, in_the_way
from iiwa_dnn.qp import Matrix
from iiwa_dnn.schemes.motion_limits import SHARE, approach
from iiwa_dnn.schemes.program import StepProgram

Signs = NDArray[Any]

POSITION, VELOCITY, ACCELERATION, JERK = range(1, 5)

_CLOSE = 1e-9
"""Difference of two bounds that is rounding, in units of the velocity limit."""


class LimitNames:
    """Names of the bounds and inequality rows of a controller's programs.

    Attributes:
        dt: Control period [s].
    """

    def __init__(self, program: StepProgram, dt: float) -> None:
        """Take the limits of a step program and its control period [s]."""
        self._settings = program.settings()
        self.dt = dt
        self._limits = np.vstack(
            [program.robot.limits[:3], np.full((3, program.robot.dof), np.inf)]
        )
        motion = program.rate_limits
        if motion is not None:
            self._limits = motion.constants(program.robot).reshape(self._limits.shape)

    def in_words(self, bounds: Matrix, sides: Signs, rows: Signs, past: Matrix) -> list[str]:
        """Name bounds and rows of a program; arguments as `codes`, and (m,) not 0 for a row."""
        return [*map(describe, in_the_way(self._settings, self.codes(bounds, sides, past), rows))]

    def codes(self, bounds: Matrix, sides: Signs, past: Matrix) -> NDArray[np.int8]:
        """Give the bounds on some sides of a program's joints their codes.

        Args:
            bounds: Lower and upper bounds of the joints [rad/s], (2, n).
            sides: Above 0 for an upper bound, below for a lower one, 0 for neither, (n,).
            past: Joint positions [rad], last command and the one before [rad/s], (3, n).

        Returns:
            Places in `naming.KINDS`, from 1, negative for lower bounds; 0 where `sides` is, (n,).
        """
        found = np.zeros(past.shape[1], np.int8)
        for i in np.flatnonzero(sides[: found.size]):
            crossed = bounds[0, i] > bounds[1, i]  # such bounds are others' than the robot's
            value = bounds[1, i] if sides[i] > 0.0 else bounds[0, i]
            sign = 1.0 if sides[i] > 0.0 else -1.0
            kind = POSITION if crossed else bound_kind(value, sign, past, self._limits, i, self.dt)
            found[i] = int(sign) * kind
        return found


def bound_kind(value: float, sign: float, past: Matrix, limits: Matrix, i: int, dt: float) -> int:
    """Tell the kind of one bound: that of the first candidate which it equals, else a position.

    Args:
        value: The bound [rad/s].
        sign: 1 for an upper bound, -1 for a lower one.
        past: Joint positions [rad], last command and the one before [rad/s], (3, n).
        limits: `MotionLimits.constants`, (6, n).
        i: The joint.
        dt: Control period [s].
    """
    _, _, velocity, acceleration, jerk, braking = limits[:, i]
    last = sign * past[1, i]
    fastest = velocity
    if jerk < np.inf:  # the velocity after which the acceleration can still be taken back in time
        unit = dt * dt * min(jerk, braking / dt / SHARE, velocity / (dt * dt) / SHARE)
        fastest = last + unit * approach((velocity - last) / unit)
    candidates = {
        VELOCITY: fastest,
        ACCELERATION: last + acceleration * dt,
        JERK: 2.0 * last - sign * past[2, i] + jerk * dt * dt,
    }
    close = _CLOSE * velocity
    found = [kind for kind, bound in candidates.items() if abs(bound - sign * value) <= close]
    return found[0] if found else POSITION
