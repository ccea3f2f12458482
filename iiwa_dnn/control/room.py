"""Answers of a robot's loop, in stretches that share one array."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.plan import Plan
from iiwa_dnn.references import Reference
from iiwa_dnn.schemes.parts import TARGET_SIZE

SIZE = 256
"""Steps whose programs and answers share one array."""


class Room(Answers):
    """Room for the next commands; those that were given keep the room they are in.

    Attributes:
        commands: Joint velocities of all rows, answered or not, as views.
        paths: Reference of each frame; none where one of them is missing.
    """

    def __init__(self, plan: Plan, paths: Sequence[Reference]) -> None:
        """Allocate for a plan."""
        targets = np.empty((SIZE, TARGET_SIZE * len(plan.frames)))
        super().__init__(plan.sizes, plan.q.size, plan.expected, targets, plan.accelerates)
        self.paths = paths
        self.commands = list(self._dq)
        self._plan = plan

    def following(self) -> Room:
        """Return the room after this one."""
        return Room(self._plan, self.paths)

    def sample(self, t: float, index: int) -> None:
        """Sample the targets of a time [s] into a row."""
        column = self.at_targets
        for path in self.paths:
            target = self.rows[index, column : column + TARGET_SIZE]
            target[:] = path.base
            path.move(t, target)
            column += TARGET_SIZE
