"""Controllers: joint positions in, the joint velocities that their scheme answers out."""

from __future__ import annotations

import math
import os
from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from armstep._library import ONE
from armstep.arms import FARTHEST, FINITE, TARGET, Answer, Arms, Decision, Decisions, numbers
from armstep.errors import InputError
from armstep.tables import Array, Path, Tables

Action = IntEnum("Action", {"NONE": 0, "SLOW": 2, "RELAX": 3, "STOP": 4, "EULER": 5})
"""Actions at a step in place of the network's answer."""

Program = IntEnum("Program", ["NOMINAL", "SCALED", "RELAXED", "RATE_LIMITED", "STOPPED"], start=0)
"""Programs that a step answers."""


def make_target(
    position: ArrayLike,
    rotation: ArrayLike | None = None,
    linear_velocity: ArrayLike = (0.0, 0.0, 0.0),
    angular_velocity: ArrayLike = (0.0, 0.0, 0.0),
) -> Array:
    """Return a target (18,) along the axes of the robot's base.

    Args:
        position: Position [m], (3,).
        rotation: Orientation, (3, 3); None: the identity.
        linear_velocity: Linear velocity [m/s], (3,).
        angular_velocity: Angular velocity [rad/s], (3,).
    """
    parts = {
        "position": (position, (3,)),
        "rotation": (np.eye(3) if rotation is None else rotation, (3, 3)),
        "linear_velocity": (linear_velocity, (3,)),
        "angular_velocity": (angular_velocity, (3,)),
    }
    return np.concatenate([numbers(k, *own, FINITE).ravel() for k, own in parts.items()])


class Command(Decision):
    """Command of one step of a controller."""

    @property
    def action(self) -> Action:
        """The action taken; ``Action.NONE`` where the network's answer was taken."""
        return Action(self.result)

    @property
    def ok(self) -> bool:
        """True if the command does all that the tasks ask."""
        return self.action is Action.NONE

    @property
    def program(self) -> Program:
        """Program that was answered."""
        return Program(ONE.armstep_program_of(self.tables.arm, self.memory.ctypes))

    @property
    def fraction(self) -> float:
        """Fraction of the period by which the path's clock goes on, in [0, 1]."""
        return float(ONE.armstep_fraction(self.tables.arm, self.memory.ctypes))


class _Controllers(Arms[Answer]):
    """What a controller and many have in common."""

    _kind = "controller"
    _decision = Command

    def step(
        self,
        q: ArrayLike,
        t: float,
        target: ArrayLike | None = None,
        *,
        obstacles: ArrayLike | None = None,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> Answer:
        """Compute the command for joint positions; it counts as sent. N arms have arrays of N rows.

        Args:
            q: Measured joint positions [rad], (n,).
            t: Time [s]; the reference is asked for the time `path_lag` before it.
            target: Targets of the tracked frames, (18,) or (frames, 18), in place of the
                reference's.
            obstacles: Where the centres of the obstacles are at the end of the last step [m],
                (k, 3), of many or (N, k, 3); None: where they were, or their velocities lead them.
            dt: Period for which the command will be held [s].
            elapsed: Time since the last step [s].

        Raises:
            InputError: An argument has a wrong shape or is not finite, or there is neither target
                nor reference, or a period is wrong; nothing is changed.
        """
        periods = self._periods(dt, elapsed)
        joints = numbers("q", q, self._shape, FARTHEST)
        if not np.isfinite(t):
            raise InputError(f"t: must be finite, not {t!r}")
        wanted: Any = None
        if target is not None:
            shape = (*self._many, len(self.tables.frame_names), TARGET)
            given = np.asarray(target)
            is_flat = given.ndim == len(shape) - 1 and given.size == math.prod(shape)
            wanted = numbers("target", given.reshape(shape) if is_flat else given, shape, FINITE)
        elif not self.tables.has_reference:
            raise InputError("target: there is no reference, so each step needs one")
        with self._lock:
            if obstacles is not None:
                self.place(obstacles)
            return self._take(joints, 0, wanted, periods, t)


class Controller(_Controllers[Command]):
    """Controller of one arm."""

    def __init__(self, tables: Path | Tables, own: Path | None = None) -> None:
        """Begin at rest.

        Args:
            tables: File that ``iiwa_dnn.export.tables`` wrote, or what `load_tables` read.
            own: Library of the parts of a user's own, if the arm has such.

        Raises:
            TablesError: The tables cannot be read, or are those of a shield.
        """
        super().__init__(tables, None, 1, own)

    @property
    def path_lag(self) -> float:
        """Time by which the path's clock is behind, since a policy slowed it [s]."""
        return float(ONE.armstep_path_lag(self.tables.arm, self._memory.ctypes))

    def targets(self, t: float) -> Array:
        """Compute the targets of the reference at a time [s], less `path_lag`, (frames, 18).

        Raises:
            InputError: There is no reference.
        """
        found = np.empty((len(self.tables.frame_names), TARGET))
        for _, memory in self._each():
            if ONE.armstep_targets(self.tables.arm, memory, self._call[2], t, found.ctypes):
                raise InputError("targets: there is no reference")
        return found

    def send(self, dq: ArrayLike, fraction: float = 1.0) -> None:
        """Count a velocity dq (n,) [rad/s] as sent for a period, in place of a step's command.

        The path's clock goes on by a fraction of the period.
        """
        if not 0.0 <= fraction < np.inf:
            raise InputError(f"fraction: must be finite and not negative, not {fraction!r}")
        self._send(dq, self.dt, fraction)


class Controllers(_Controllers[Decisions]):
    """Controllers of N arms, whose steps are one call; each is answered as by a `Controller`."""

    def __init__(
        self,
        tables: Path | Tables,
        count: int,
        threads: int | None = None,
        own: Path | None = None,
    ) -> None:
        """Begin at rest; as `Controller`, with a number of arms, and of threads as `Shields`."""
        super().__init__(tables, count, int(threads or os.cpu_count() or 1), own)
