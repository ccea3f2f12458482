"""The state of a controller: all that one step leaves behind for the next."""

import math
from typing import Any

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector

Q, LAST, BEFORE, WANTED, REST, DELAY, YIELDS, HALTED, LEAST = range(9)
"""Rows of `ControllerState.past`; from the last one on the distances that pairs keep."""


def rows_of(pairs: int, dof: int) -> int:
    """Count the rows of a state of so many pairs and joints."""
    return LEAST + math.ceil(pairs / max(dof, 1))


@compiled
def kept_distances(past: Matrix) -> Vector:
    """Return the view of the least distance of each pair [m], and of what is left of its rows."""
    return past.reshape(past.size)[LEAST * past.shape[1] :]


class ControllerState:
    """Last commands, the reference's clock, and whether the task yields.

    Attributes:
        past: Joint positions of this step [rad], last command, the one before, the velocity that a
            yielding task wanted at the last step [rad/s], and in the first entries of further rows
            the periods until the braking motion in hand rests, 0 if there is none, the time by
            which the reference's clock is behind [s], and 1 if the task yielded at the last step
            and if the arm brakes whatever has a solution; then the distance that each watched pair
            has to keep [m], 0 before the first step, one after another, (8 + k, n). A step makes a
            new one, which counts from when the controller returns its command.
        next: The one after the last command that was computed.
        dt: Control period of the last step [s]; 0 before the first.
        slowed: Share of the last period by which the reference's clock fell behind in it, and
        booked: that period [s], where periods vary.
        halted: Whether the arm brakes from now on; each step writes it into the row `HALTED`.
        begun: Whether the start was looked at, and warned of.
        exceeded: Whether a period above the longest was warned of.
        pairs: The watched pairs, each with its names.
    """

    __slots__ = ("begun", "booked", "dt", "exceeded", "halted", "next", "pairs", "past", "slowed")

    past: Matrix
    next: Matrix

    def __init__(self, dof: int) -> None:
        """Begin with an arm of n joints that has had no command."""
        self.begun = False
        self.exceeded = False
        self.pairs: Any = []
        self.past = np.zeros((LEAST, dof))
        self.rest()

    def watch(self, shape: tuple[int, int], pairs: Any) -> None:
        """Make room for the distances of all pairs, (8 + k, n); other pairs begin at the next step.

        The same pairs keep theirs: an obstacle that is elsewhere in a new scheme has moved.
        """
        if pairs != self.pairs:
            past = np.zeros(shape)
            past[:LEAST] = self.past[:LEAST]
            self.past = past
            self.next = past
            self.pairs = pairs

    def rest(self) -> None:
        """Forget all commands."""
        self.past = np.zeros_like(self.past)
        self.next = self.past
        self.dt = 0.0
        self.slowed = 0.0
        self.booked = 0.0
        self.halted = False

    def set_period(self, dt: float) -> None:
        """Go on in periods of another length [s]: accelerations and the time to rest stay."""
        if self.dt > 0.0 and dt != self.dt:
            ratio = dt / self.dt
            past = self.past.copy()
            past[BEFORE] = past[LAST] - ratio * (past[LAST] - past[BEFORE])
            past[REST] /= ratio
            self.past = past
        self.dt = dt

    def book(self, elapsed: float) -> None:
        """Count the last command as one that was held for so long [s]."""
        self.past[DELAY] += self.slowed * (elapsed - self.booked)
        self.booked = elapsed
