"""The state of a controller: all that one step leaves behind for the next."""

from typing import Any

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.qp import Vector


class MotionState(Record):
    """State of the motion of n joints, as one step leaves it behind for the next.

    Attributes:
        stopping_periods: Periods until the stopping motion that is available rests; 0 if none is.
        path_lag: Time by which the reference's clock is behind [s].
        spacing: Period over which the last change of the command counts [s]; 0 before the first.
        yields: Whether the task yielded at the last step.
        halts: Whether the arm brakes, whatever has a solution.
        q: Joint positions of this step [rad], (n,).
        last: Last command [rad/s], (n,).
        before: Command before it [rad/s], (n,).
        wanted: Velocity that a yielding task wanted at the last step [rad/s], (n,).
        least: Distance that each watched pair has to keep [m], (pairs,); 0 before the first step.
    """

    stopping_periods: float
    path_lag: float
    spacing: float
    yields: bool
    halts: bool
    q: Vector = part("joints")
    last: Vector = part("joints")
    before: Vector = part("joints")
    wanted: Vector = part("joints")
    least: Vector = part("pairs")


@compiled
def change_spacing(motion: MotionState, dt: float) -> None:
    """Count changes of the command over another period [s]; acceleration and time to rest stay."""
    if motion.spacing > 0.0 and dt != motion.spacing:
        ratio = dt / motion.spacing
        for i in range(motion.last.size):
            motion.before[i] = motion.last[i] - ratio * (motion.last[i] - motion.before[i])
        motion.stopping_periods = motion.stopping_periods / ratio
    motion.spacing = dt


@compiled
def count_as_sent(motion: MotionState, dq: Vector, dt: float) -> None:
    """Count a velocity dq (n,) [rad/s] as the last command, held for a period [s]."""
    for i in range(motion.last.size):
        motion.before[i] = motion.last[i]
        motion.last[i] = dq[i]
    motion.stopping_periods = 0.0
    motion.spacing = motion.spacing if motion.spacing > 0.0 else dt


class ControllerState:
    """State of a controller between steps.

    Attributes:
        sizes: Numbers of joints and of watched pairs.
        numbers: Those of `MotionState`, (k,). A step makes new ones, which count from when the
            controller returns its command.
        next_numbers: Those after the last command that was computed.
        slowed: Fraction of the last period by which the reference's clock fell behind in it, and
        booked: that period [s], where periods vary.
        halted: Whether the arm brakes from now on; each step writes it into its state.
        warned: What was warned of: the start once it was looked at, a period above the longest.
        pairs: The watched pairs, each with its names.
    """

    __slots__ = (
        "booked",
        "halted",
        "next_numbers",
        "numbers",
        "pairs",
        "sizes",
        "slowed",
        "warned",
    )

    numbers: Vector
    next_numbers: Vector

    def __init__(self, dof: int) -> None:
        """Begin with an arm of n joints that has had no command."""
        self.warned: set[str] = set()
        self.pairs: Any = []
        self.sizes = (dof, 0)
        self.rest()

    @property
    def motion(self) -> MotionState:
        """The state of the motion, a view."""
        return MotionState.of(self.numbers, *self.sizes)

    @property
    def next_motion(self) -> MotionState:
        """The state after the last command that was computed, a view."""
        return MotionState.of(self.next_numbers, *self.sizes)

    def watch(self, pairs: Any) -> None:
        """Allocate the distances of the watched pairs; new pairs begin at the next step.

        The same pairs keep theirs: an obstacle that is elsewhere in a new scheme has moved.
        """
        if pairs != self.pairs:
            dof, before = self.sizes
            kept = self.numbers[: self.numbers.size - before]
            self.pairs = pairs
            self.sizes = (dof, len(pairs))
            self.numbers = np.concatenate([kept, np.zeros(len(pairs))])
            self.next_numbers = self.numbers

    def rest(self) -> None:
        """Forget all commands."""
        self.numbers = np.zeros(MotionState.width(*self.sizes))
        self.next_numbers = self.numbers
        self.slowed = 0.0
        self.booked = 0.0
        self.halted = False

    def book(self, elapsed: float) -> None:
        """Correct the path lag for a last command that was held for `elapsed` [s]."""
        self.motion.path_lag += self.slowed * (elapsed - self.booked)
        self.booked = elapsed
