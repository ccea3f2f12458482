"""State that a controller keeps from one control step to the next."""

from typing import Any

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.qp import Vector


class MotionState(Record):
    """State of the motion of n joints, kept from one control step to the next.

    Attributes:
        stopping_periods: Control periods that the stored stopping motion takes from the last
            command to rest; 0 if no stopping motion is stored.
        path_lag: Time by which the reference's clock is behind the time of the loop [s].
        spacing: Period by which `last` - `before` is divided for the acceleration [s]; 0 before
            the first step.
        yields: Whether a policy replaced the nominal program at the last step.
        halts: Whether the arm brakes at this step, even if the nominal program has a solution.
        q: Joint positions of the step [rad], (n,).
        last: Last command [rad/s], (n,).
        before: Command before the last one [rad/s], (n,).
        wanted: Answer of the last fallback program, before rate limits [rad/s], (n,).
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
    """Convert the state to a control period of dt [s]; acceleration and time to rest stay.

    Overwrites `before`, `stopping_periods` and `spacing`; before the first step only `spacing`.
    """
    if motion.spacing > 0.0 and dt != motion.spacing:
        ratio = dt / motion.spacing
        for i in range(motion.last.size):
            motion.before[i] = motion.last[i] - ratio * (motion.last[i] - motion.before[i])
        motion.stopping_periods = motion.stopping_periods / ratio
    motion.spacing = dt


@compiled
def count_as_sent(motion: MotionState, dq: Vector, dt: float) -> None:
    """Write a velocity dq (n,) [rad/s] to `last`, and the last command to `before`.

    Sets `stopping_periods` to 0, and `spacing` to dt [s] if it is 0.
    """
    for i in range(motion.last.size):
        motion.before[i] = motion.last[i]
        motion.last[i] = dq[i]
    motion.stopping_periods = 0.0
    motion.spacing = motion.spacing if motion.spacing > 0.0 else dt


class ControllerState:
    """State of a controller between steps.

    Attributes:
        sizes: Numbers of joints and of watched pairs.
        numbers: Numbers of the current `MotionState`, (k,), replaced by `next_numbers` as the
            controller returns a command.
        next_numbers: Numbers of the `MotionState` after the last command that was computed, (k,).
        slowed: If periods vary, fraction of the last period by which the reference's clock fell
            behind; else 0.
        booked: If periods vary, length of the last period as `path_lag` counts it [s]; else 0.
        halted: Whether the arm brakes at every step from now on.
        warned: Names of the warnings that are not given again: ``"start"`` for those at the start,
            and that of a period above the longest.
        pairs: Names of the two bodies of each watched pair.
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
        """Create the state of an arm of `dof` joints at rest, without watched pairs."""
        self.warned: set[str] = set()
        self.pairs: Any = []
        self.sizes = (dof, 0)
        self.rest()

    @property
    def motion(self) -> MotionState:
        """`MotionState` in `numbers`, a view."""
        return MotionState.of(self.numbers, *self.sizes)

    @property
    def next_motion(self) -> MotionState:
        """`MotionState` in `next_numbers`, a view."""
        return MotionState.of(self.next_numbers, *self.sizes)

    def watch(self, pairs: Any) -> None:
        """Set the watched pairs, each the names of its two bodies.

        If they differ from `pairs`, the distances of all pairs are set to 0, so that the next step
        initialises them; else nothing changes, even if an obstacle is elsewhere.
        """
        if pairs != self.pairs:
            dof, before = self.sizes
            kept = self.numbers[: self.numbers.size - before]
            self.pairs = pairs
            self.sizes = (dof, len(pairs))
            self.numbers = np.concatenate([kept, np.zeros(len(pairs))])
            self.next_numbers = self.numbers

    def rest(self) -> None:
        """Set the state of an arm at rest: all numbers 0 and no halt; `warned` and pairs stay."""
        self.numbers = np.zeros(MotionState.width(*self.sizes))
        self.next_numbers = self.numbers
        self.slowed = 0.0
        self.booked = 0.0
        self.halted = False

    def book(self, elapsed: float) -> None:
        """Correct the path lag, given that the last command was held for `elapsed` [s]."""
        self.motion.path_lag += self.slowed * (elapsed - self.booked)
        self.booked = elapsed
