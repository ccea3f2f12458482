"""The state of a controller: all that one step leaves behind for the next."""

from typing import Any

import numpy as np

from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.qp import Vector


class MotionState(Record):
    """State of the motion of n joints, as one step leaves it behind for the next.

    Attributes:
        stopping_periods: Periods until the stopping motion that is available rests; 0 if none is.
        path_lag: Time by which the reference's clock is behind [s].
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
    yields: bool
    halts: bool
    q: Vector = part("joints")
    last: Vector = part("joints")
    before: Vector = part("joints")
    wanted: Vector = part("joints")
    least: Vector = part("pairs")


class ControllerState:
    """State of a controller between steps.

    Attributes:
        sizes: Numbers of joints and of watched pairs.
        numbers: Those of `MotionState`, (k,). A step makes new ones, which count from when the
            controller returns its command.
        next_numbers: Those after the last command that was computed.
        dt: Control period of the last step [s]; 0 before the first.
        slowed: Fraction of the last period by which the reference's clock fell behind in it, and
        booked: that period [s], where periods vary.
        halted: Whether the arm brakes from now on; each step writes it into its state.
        begun: Whether the start was looked at, and warned of.
        exceeded: Whether a period above the longest was warned of.
        pairs: The watched pairs, each with its names.
    """

    __slots__ = (
        "begun",
        "booked",
        "dt",
        "exceeded",
        "halted",
        "next_numbers",
        "numbers",
        "pairs",
        "sizes",
        "slowed",
    )

    numbers: Vector
    next_numbers: Vector

    def __init__(self, dof: int) -> None:
        """Begin with an arm of n joints that has had no command."""
        self.begun = False
        self.exceeded = False
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
        self.dt = 0.0
        self.slowed = 0.0
        self.booked = 0.0
        self.halted = False

    def set_period(self, dt: float) -> None:
        """Change the control period [s]; accelerations and the time to rest stay."""
        if self.dt > 0.0 and dt != self.dt:
            ratio = dt / self.dt
            motion = self.motion.duplicate()
            motion.before[:] = motion.last - ratio * (motion.last - motion.before)
            motion.stopping_periods /= ratio
            self.numbers = motion.numbers
        self.dt = dt

    def book(self, elapsed: float) -> None:
        """Correct the path lag for a last command that was held for `elapsed` [s]."""
        self.motion.path_lag += self.slowed * (elapsed - self.booked)
        self.booked = elapsed
