"""Names of a controller's limits, and the kind of a joint's bound.

With acceleration or jerk limits a bound is made of all of them at once. It is said to be of the one
whose own bound it equals, or of a position.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.naming import describe, in_the_way
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.schemes.limits import SHARE, MotionLimits, approach
from iiwa_dnn.schemes.program import StepProgram

Signs = NDArray[Any]

POSITION, VELOCITY, ACCELERATION, JERK = range(1, 5)

_KINDS = (JERK, ACCELERATION, VELOCITY)
"""Kinds that a bound may have beside that of a position; of several the last counts."""

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
        motion = program.rate_limits or MotionLimits()
        self._limits = motion.constants(program.robot).reshape(6, -1)

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
        dof = past.shape[1]
        sign = np.sign(sides[:dof])
        lower, upper = bounds[:, :dof]
        value = np.where(sign > 0.0, upper, -lower)
        kinds = np.full(dof, POSITION)
        # Crossed bounds are others' than the robot's.
        close = np.where(lower > upper, -1.0, _CLOSE * self._limits[2])
        with np.errstate(invalid="ignore"):  # joints without limits
            for kind, candidate in zip(_KINDS, self._candidates(sign * past), strict=True):
                kinds[np.abs(candidate - value) <= close] = kind
        return np.asarray(sign * kinds, np.int8)

    def _candidates(self, past: Matrix) -> list[Vector]:
        """Return the upper bounds that the limit of each of `_KINDS` alone makes, (n,) [rad/s].

        Args:
            past: Joint positions [rad], last command and the one before [rad/s], (3, n); of the
                joints whose lower bounds are meant they have the other sign.
        """
        _, last, before = past
        _, _, velocity, acceleration, jerk, braking = self._limits
        dt = self.dt
        unit = dt * dt * np.fmin(jerk, np.fmin(braking / dt, velocity / (dt * dt)) / SHARE)
        room = [approach(x) for x in (velocity - last) / unit]
        # The velocity after which the acceleration can still be taken back in time.
        fastest = np.where(jerk < np.inf, last + unit * room, velocity)
        rates = [2.0 * last - before + jerk * dt * dt, last + acceleration * dt]
        return [*rates, fastest]
