"""The state of a controller: all that one step leaves behind for the next."""

from typing import NamedTuple

import numpy as np

from iiwa_dnn.qp import Matrix, Vector

Q, LAST, BEFORE, WANTED, REST, DELAY, YIELDS, HALTED, ROWS = range(9)
"""Rows of `ControllerState.past`, and their number."""


class ControllerState(NamedTuple):
    """Last commands, the reference's clock, and whether the task yields.

    A step makes a new one, which counts from when the controller returns its command.

    Attributes:
        past: Joint positions of this step [rad], last command, the one before, the velocity that a
            yielding task wanted at the last step [rad/s], and in the first entries of further rows
            the periods until the braking motion in hand rests, 0 if there is none, the time by
            which the reference's clock is behind [s], and 1 if the task yielded at the last step
            and if the arm brakes whatever has a solution, (8, n).
        begun: Whether a first step was taken.
        blocking: What stood in the way when a policy stopped the arm, (n + m,); None: it did not.
        relaxed: States of the networks of relaxed programs, (size,), warm starts.
    """

    past: Matrix
    begun: bool = False
    blocking: Vector | None = None
    relaxed: Vector = np.zeros(0)

    @classmethod
    def at_rest(cls, dof: int, begun: bool = False) -> "ControllerState":
        """Return the state of an arm of n joints that has had no command."""
        return cls(np.zeros((ROWS, dof)), begun)


class KeptStates:
    """The state that counts, and the one after the last computed command.

    Attributes:
        now: The state after the last command that was sent.
        next: The state after the last command that was computed.
    """

    __slots__ = ("next", "now")

    def __init__(self, state: ControllerState) -> None:
        """Begin with a state."""
        self.now = state
        self.next = state
