"""Timed positions that joints are to follow: a chunk, or a stream of one sample after another."""

from __future__ import annotations

from enum import IntEnum

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry
from iiwa_dnn.qp.layout import copied

SHORTEST = 1e-9
"""Least time between two samples [s]."""

LONGEST = 1e10
"""Largest time of a sample [s]: seconds since 1970 are 2e9."""

ALONE = 19
"""Single numbers of a `FollowState`."""

OF_JOINT = 8
"""Numbers of it for each joint."""


class Mode(IntEnum):
    """Ways to follow samples: a chunk at their times, or along their path, later; or a stream.

    A stream has a lead of `mode` - `STREAM` samples.
    """

    TIME = 0
    PATH = 1
    STREAM = 2


class FollowState(Record):
    """State of n joints that follow samples.

    Attributes:
        count: Number of samples of the curve that is followed; 0: none is.
        mode: Its `Mode`.
        waiting: Number of samples that wait for their time.
        next_mode: Their `Mode`.
        is_stale: Whether the samples that came since the last step were all in the past.
        is_broken: Whether the last ones that came were not finite.
        since: Time of the last step [s].
        spacing: Period of the last step [s].
        clock: Clock s at the last step [s].
        rate: Its rate.
        rate_before: Its rate at the step before.
        fastest: Largest rate of the clock.
        clock_acceleration: Largest acceleration of the clock [1/s].
        clock_jerk: Largest jerk of the clock [1/s^2].
        late: Time by which the clock is behind at the end of the step [s].
        stamp: Time of a stream's last sample [s].
        sampling: Sampling period of a stream [s]; 0 before its second sample.
        offset: Time of the arm less that of the stream [s].
        is_silent: Whether a stream comes to rest at its last sample.
        reference: Position of the reference at the end of the step [rad], (n,).
        goal: Last sample of a stream [rad], (n,).
        pace: Velocity of a stream at its last sample [rad/s], (n,).
        misses: Samples since the last one whose velocity counted, (n,).
        virtual: Positions of the virtual joints at the last step [rad], (n,).
        speed: Velocities of the virtual joints [rad/s], (n,).
        speed_before: Their velocities at the step before [rad/s], (n,).
        asked: Requested velocities of the last step [rad/s], (n,).
        times: Times of the samples [s].
        next_times: Times of the waiting ones [s].
        positions: Positions of the samples, one sample after another [rad], (samples n,).
        slopes: Their velocities [rad/s], (samples n,).
        next_positions: Positions of the waiting ones [rad], (samples n,).
    """

    count: int
    mode: int
    waiting: int
    next_mode: int
    is_stale: bool
    is_broken: bool
    since: float
    spacing: float
    clock: float
    rate: float
    rate_before: float
    fastest: float
    clock_acceleration: float
    clock_jerk: float
    late: float
    stamp: float
    sampling: float
    offset: float
    is_silent: bool
    reference: Vector = part()
    goal: Vector = part()
    pace: Vector = part()
    misses: Vector = part()
    virtual: Vector = part()
    speed: Vector = part()
    speed_before: Vector = part()
    asked: Vector = part()
    times: Vector = part("samples")
    next_times: Vector = part("samples")
    positions: Vector = part("entries")
    slopes: Vector = part("entries")
    next_positions: Vector = part("entries")


@compiled
def samples_of(n: int, width: int) -> int:
    """Return for how many samples of n joints a `FollowState` of some numbers has room."""
    return (width - ALONE - OF_JOINT * n) // (2 + 3 * n) if width > 0 else 0


@compiled
def have_meaning(times: Vector, mode: int, most: int) -> bool:
    """Test whether times (m,) [s] rise and are at most `most`, and there is such a `Mode`."""
    if times.size < 1 or times.size > most or mode < Mode.TIME or mode > Mode.STREAM + 2:
        return False
    if mode >= Mode.STREAM and times.size > 1:
        return False
    count = 0
    for k in range(1, times.size):
        count += times[k] - times[k - 1] < SHORTEST
    return count == 0


@compiled
def keep_samples(own: FollowState, times: Vector, positions: Vector, mode: int, now: float) -> None:
    """Let samples wait for their time, in place of those that wait.

    With numbers that are not finite the arm brakes. Stale samples change nothing: a chunk that is
    all before the present time; one of a stream that is not after the last one.

    Args:
        own: What is followed.
        times: Time of each sample [s], rising; of a chunk on the arm's clock, (m,).
        positions: Joint positions of one sample after another [rad], (m n,).
        mode: Their `Mode`; of a stream one sample comes at a time.
        now: Time of the next step [s].
    """
    own.is_broken = not all_finite(times, 0, times.size)
    own.is_broken = own.is_broken or not all_finite(positions, 0, positions.size)
    if not own.is_broken:
        own.is_broken = largest_entry(times) > LONGEST or largest_entry(positions) > LARGEST
    if own.is_broken:
        return
    last = times[times.size - 1]
    own.is_stale = last < now
    if mode >= Mode.STREAM:
        streams = own.count > 0 and own.mode >= Mode.STREAM
        own.is_stale = streams and last - own.stamp < SHORTEST
    if own.is_stale:
        return
    own.waiting = times.size
    own.next_mode = mode
    copied(own.next_times[: times.size], times)
    copied(own.next_positions[: positions.size], positions)


@compiled
def forget_samples(own: FollowState) -> None:
    """Follow nothing from now on."""
    own.count = 0
    own.waiting = 0
    own.is_broken = False


@compiled
def asks(own: FollowState) -> bool:
    """Test whether samples are a request: not a stream without a new one, which grows older."""
    is_chunk = own.count > 0 and own.mode < Mode.STREAM
    return own.is_broken or own.waiting > 0 or is_chunk
