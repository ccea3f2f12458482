"""Answers of a robot's loop, their targets sampled ahead while the calls come on time."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.plan import Plan
from iiwa_dnn.qp import Vector
from iiwa_dnn.schemes.parts import TARGET_SIZE

SIZE = 256
"""Steps whose programs and answers share one array."""


class Room(Answers):
    """Room for the next commands; those that were given keep the room they are in.

    The way into compiled code takes as long as sampling ten targets, so a call that is on time
    finds its target sampled by an earlier one.

    Attributes:
        times: Times of the targets in the rows [s]; NaN where none is sampled yet.
        commands: Joint velocities of all rows, answered or not, as views.
        paths: Compiled form (`Reference.compiled`) and numbers of each frame's reference; none
            where one of them has no compiled form.
    """

    def __init__(
        self, plan: Plan, dt: float, paths: Sequence[tuple[Any, Vector]], base: Vector
    ) -> None:
        """Allocate for a plan; base (18 frames,) is the targets' at the paths' origins."""
        targets = np.tile(base, (SIZE, 1))
        super().__init__(plan.sizes, plan.q.size, plan.expected, targets, plan.accelerates)
        self.paths, self.times = paths, [math.nan] * SIZE
        self.commands = list(self._dq)
        self._arguments = (plan, dt, paths, base)
        self._periods, self._ahead, self._next = np.arange(SIZE + 1), 1, math.nan

    def following(self) -> Room:
        """Return the room after this one."""
        room = Room(*self._arguments)
        room._ahead, room._next = self._ahead, self._next
        return room

    def look_ahead(self, t: float, index: int) -> None:
        """Sample the target of a time [s], and more and more after it while calls are on time."""
        _, dt, paths, base = self._arguments
        self._ahead = count = min(2 * self._ahead, SIZE - index) if t == self._next else 1
        # Rounded as a caller rounds k dt; a NaN stays one.
        times = ((t / dt + 0.5) // 1.0 + self._periods[: count + 1]) * dt
        times[0] = t
        self.targets[index : index + count] = base  # to which a path adds
        column = self.at_targets
        for path, numbers in paths:
            path(times[:count], numbers, self.rows, index, column)
            column += TARGET_SIZE
        *self.times[index : index + count], self._next = times.tolist()
