"""The state of a controller: all that one step leaves behind for the next."""

import numpy as np

from iiwa_dnn.qp import Vector

Q, LAST, BEFORE, WANTED, REST = range(5)
"""Rows of `ControllerState.past`."""


class ControllerState:
    """Last commands, the reference's clock, and whether the task yields.

    A step reads `past` and writes `following`; only `commit` makes the one the other. A step that
    is broken off leaves the state as it was.

    Attributes:
        past: Joint positions of this step [rad], last command, the one before, the velocity that a
            yielding task wanted at the last step [rad/s], and in the first entry of its last row
            the periods until the braking motion in hand rests, 0 if there is none, (5, n).
        following: The same for the next step, (5, n).
        delay: Time by which the reference's clock is behind [s].
        begun: Whether a first step was taken.
        yields: Whether the task yielded at the last step.
        relaxed: States of the networks of relaxed programs, (size,).
        halted: What stood in the way when a policy stopped the arm, (n + m,), after which every
            step brakes; None: it did not.
    """

    __slots__ = ("begun", "delay", "following", "halted", "past", "relaxed", "yields")

    def __init__(self, dof: int) -> None:
        """Start at rest."""
        self.past = np.zeros((5, dof))
        self.following = np.zeros((5, dof))
        self.begun = False
        self.reset()

    def reset(self) -> None:
        """Forget the commands and the clock."""
        self.past[LAST:] = 0.0
        self.delay = 0.0
        self.yields = False
        self.relaxed: Vector = np.zeros(0)
        self.halted: Vector | None = None

    def send(self, dq: Vector) -> None:
        """Take note of a command dq (n,) [rad/s] that the next `commit` makes the last one."""
        self.following[BEFORE] = self.past[LAST]
        self.following[LAST] = dq
        self.following[REST] = 0.0

    def commit(self) -> None:
        """Count the command that `following` holds as sent."""
        # No call in between, so no interrupt either: both happen, or neither.
        past = self.past
        self.past = self.following
        self.following = past
