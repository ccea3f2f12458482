r"""Joints that follow timed positions without lag, within every limit: the request `FOLLOW`.

A chunk of samples is a cubic spline r(s) of its clock s, which is one more joint: it comes to rest
at the last sample. A stream is the curve from where the reference is to where the last samples
lead. Two joints of thought are between r and a command; each takes the law by which a joint comes
to rest at a position (`reaching`):

- A *virtual joint* follows r within :math:`1 - \varphi` of the limits. Where it cannot, it aims at
  the position at which r could come to rest.
- The *offset* of the arm from the virtual joint comes to rest at 0 within :math:`\varphi` of the
  limits, :math:`\varphi` being `SHARE`.

The command is the sum of both velocities, so it is within all limits. Where a new chunk begins
beside the old one, the virtual joint is moved by the difference, which fades as an offset; where
a position limit or a distance changes a command, the virtual joint begins anew at the arm.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.control.requests import Request
from iiwa_dnn.control.state import MotionState
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, largest_entry
from iiwa_dnn.qp.layout import IntVector, copied
from iiwa_dnn.schemes.joint_limits import MotionConstants
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.profiles import Rates
from iiwa_dnn.schemes.viability import reaching, rest_ahead

SAMPLES = 64
"""Largest number of samples of a chunk, where none is stated; a stream takes four."""

SHARE = 0.1
"""Share of the limits with which an offset fades."""

FADE = 1.0
"""Time in which the largest offset that a new chunk may leave fades [s]."""

KEPT = 0.3
"""Least share of the limits that the clock of a chunk may use to brake."""

TURNS = 0.7
"""Share of the acceleration limits that a path slowed down for them uses."""

BENDS = 0.5
"""Share of the jerk limits that a path slowed down for them uses."""

CLOCK = 1e3
"""Largest acceleration [1/s] and jerk [1/s^2] of a clock."""

SHORTEST = 1e-9
"""Least time between two samples [s]."""

LONGEST = 1e9
"""Largest time of a sample [s]."""

SILENCE = 1.5
"""Sampling periods after which a stream without a new sample comes to rest at the last one."""

OTHER = 1e-9
"""Difference of a command from the request above which the virtual joint begins anew [rad/s]."""

ROUNDING = 1e-9
"""Relative excess over a limit that counts as rounding."""

SLOWEST = 0.5
"""Longest sampling period of a stream [s]; after a longer pause it goes on with the one before."""

STEPS = 60
"""Newton's steps of a cube root."""

MISSED = 1e-3
"""Distance from a sample up to which it counts as reached [rad]."""

NEAR = 1e-4
"""Time before a chunk's last sample at which its clock, which comes to rest there, is there [s]."""

PATIENCE = 10.0
"""Time after its last sample until which a preview waits for a chunk [s]."""

ALONE = 19
"""Single numbers of a `FollowState`."""

OF_JOINT = 8
"""Numbers of it for each joint."""

PIECES = 3
"""Cubic pieces of the curve of a stream: as many as reach given positions, velocities and
accelerations at both ends."""


class Mode(IntEnum):
    """What is kept where samples are too quick: their times or their path; or a stream.

    A stream has a lead of `mode` - `STREAM` samples.
    """

    TIME = 0
    PATH = 1
    STREAM = 2


class Knot(IntEnum):
    """Samples of a curve: the first one, and the inner and outer ends of that of a stream."""

    FIRST = 0
    SECOND = 1
    THIRD = 2
    LAST = 3


class Past(IntEnum):
    """Steps at which the reference is compared where a new chunk begins."""

    PRESENT = 0
    LAST = 1
    BEFORE = 2


class Rate(IntEnum):
    """Derivatives of a path."""

    VELOCITY = 0
    ACCELERATION = 1
    JERK = 2


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


KEEPS = {"time": Mode.TIME, "path": Mode.PATH}
"""Modes of a chunk by what it keeps."""


def follow_width(n: int, samples: int) -> int:
    """Count the numbers of a `FollowState` of n joints; 0 without samples."""
    return FollowState.width(n, samples, n * samples) if samples else 0


def checked_times(times: ArrayLike, most: int) -> Vector:
    """Return the times (m,) [s] of a chunk, m at most `most`, which may be NaN.

    Raises:
        InvalidInputError: They are no list, do not rise, or are too many.
    """
    t = checks.array("times", times, (-1,))
    if not 1 <= t.size <= most:
        raise InvalidInputError("times", f"must be 1 to {most}, not {t.size}", times)
    steps = np.diff(t)
    if (steps < SHORTEST).any():
        k = int(np.argmax(steps < SHORTEST))
        problem = f"must rise: {t[k + 1]:g} s comes after {t[k]:g} s"
        raise InvalidInputError("times", problem, times)
    return t


def stream_mode(kind: Request, lead: int | None, samples: int) -> int:
    """Return the `Mode` of a stream with a lead; None stands for 1.

    Raises:
        InvalidInputError: The request is of another kind, or the shield follows no samples.
    """
    if kind is not Request.POSITION or not samples:
        raise InvalidInputError("time, lead", "belong to a position of a shield with samples", lead)
    return Mode.STREAM + (1 if lead is None else checks.one_of("lead", lead, (0, 1, 2)))


class Preview(NamedTuple):
    """What would become of a chunk, as `Shield.preview` finds it before the arm moves.

    Attributes:
        sample: Number of the first sample that is more than `MISSED` off, or of a pose that is left
            out; None: all are reached.
        active_limits: What kept the arm off until then, in words; none: they are too quick.
        late: Largest time by which a sample is reached after its own [s].
        off: Largest distance of a joint from each sample when it is due by the clock, which may be
            late [rad], (m,). It is NaN for samples that are in the past, or not come to.
    """

    sample: int | None
    active_limits: tuple[str, ...]
    late: float
    off: Vector

    def among(self, places: IntVector, left_out: dict[int, str]) -> Preview:
        """Return the preview of all poses, from that of those at some places among them."""
        off = np.full(len(places) + len(left_out), np.nan)
        off[places] = self.off
        sample = None if self.sample is None else int(places[self.sample])
        whole = self._replace(sample=sample, off=off)
        first = min(left_out, default=off.size)
        if first < (off.size if sample is None else sample):
            return whole._replace(sample=first, active_limits=(left_out[first],))
        return whole


class Rehearsal:
    """Steps of a chunk without an arm, and what they tell of it.

    Attributes:
        goes_on: Whether a sample is still to come.
        result: What was found.
    """

    def __init__(self, times: Vector, positions: Matrix) -> None:
        """Take times (m,) [s] and positions (m, n) [rad] of the samples."""
        self.goes_on = times.size > 0
        self.result = Preview(None, (), 0.0, np.full(times.size, np.nan))
        self._times = times
        self._positions = positions
        self._words: dict[str, None] = {}

    def take(self, own: FollowState, arm: Any, after: Any, words: tuple[str, ...]) -> None:
        """Take a step: what is followed, the `ArmState` before and after it, its active limits."""
        t = self._times
        if own.count + own.waiting == 0:  # refused, or the arm brakes
            self._words = dict.fromkeys(words)
            self.goes_on = False
            self._miss(np.flatnonzero(np.isnan(self.result.off)))
            return
        if own.waiting > 0:
            return
        if np.abs(after.positions - own.reference).max() > MISSED:
            self._words.update(dict.fromkeys(words))
        end = own.clock + (after.time - arm.time) * own.rate
        if end > t[-1] - NEAR:
            end = t[-1]
        reached = (t >= own.clock - SHORTEST) & (t <= end + SHORTEST) & np.isnan(self.result.off)
        for k in np.flatnonzero(reached):
            part = min(max(t[k] - own.clock, 0.0) / max(end - own.clock, SHORTEST), 1.0)
            q = arm.positions + part * (after.positions - arm.positions)
            self.result.off[k] = np.abs(q - self._positions[k]).max()
            late = arm.time + part * (after.time - arm.time) - t[k]
            self.result = self.result._replace(late=max(self.result.late, float(late)))
            if self.result.off[k] > MISSED:
                self._miss([k])
        if after.time > t[-1] + PATIENCE:
            self._miss(np.flatnonzero(t > end))
        self.goes_on = end < t[-1] and after.time <= t[-1] + PATIENCE

    def _miss(self, samples: ArrayLike) -> None:
        """Note the first of samples that are not reached, and what kept the arm from it."""
        if self.result.sample is None:
            first = int(np.asarray(samples)[0])
            self.result = self.result._replace(sample=first, active_limits=tuple(self._words))


class Curve(NamedTuple):
    """Cubic piece of a joint's reference: p + u (v + u (c + u d)) at the time u from its begin.

    Attributes:
        p: Position at its begin [rad].
        v: Velocity there [rad/s].
        c: Half the acceleration there [rad/s^2].
        d: A sixth of the jerk [rad/s^3].
    """

    p: float
    v: float
    c: float
    d: float


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


@compiled
def follow_samples(
    own: FollowState,
    q: Vector,
    motion: MotionState,
    limits: MotionConstants,
    periods: Periods,
    now: float,
    dq: Vector,
) -> None:
    """Write the next velocities dq (n,) [rad/s] of joints that follow samples, or longer.

    Args:
        own: The samples and what is kept from step to step.
        q: Commanded joint positions [rad], (n,).
        motion: The last commands.
        limits: Limits of the joints.
        periods: Periods of the step.
        now: Time of the step [s].
        dq: The velocities, overwritten.
    """
    _advance(own, q, motion, periods, now)
    if own.waiting > 0 and own.next_mode >= Mode.STREAM:
        _take_sample(own, q, limits, periods, now)
    elif own.waiting > 0 and (own.count == 0 or own.next_times[Knot.FIRST] <= now):
        _take_chunk(own, q, motion, limits, periods, now)
    elif own.mode >= Mode.STREAM and _is_silent(own, now):
        own.is_silent = True
        own.pace[:] = 0.0
        span = 2.0 * own.sampling
        for i in range(q.size):
            _bend(own, i, own.goal[i], 0.0, 0.0, span)
        _lay_out(own, span)
    clock = own.clock
    rate_before = own.rate_before
    own.rate_before = own.rate
    if own.mode < Mode.STREAM:
        fastest = own.fastest
        accel = own.clock_acceleration
        rates = Rates(fastest, accel, own.clock_jerk, accel, np.inf, 0.0)
        left = own.times[own.count - 1] - clock
        own.rate = max(reaching(own.rate, rate_before, left, fastest, rates, periods), 0.0)
    then = clock + periods.expected * own.rate
    own.late = min(now + periods.expected, max(own.times[own.count - 1], then)) - then
    first = own.times[Knot.FIRST]
    was = clock - periods.dt * own.rate_before if clock >= first else first
    for i in range(q.size):
        own.reference[i] = position_at(own, i, max(then, first))
        present = position_at(own, i, max(clock, first))
        w = (own.reference[i] - present) / periods.expected
        before = (present - position_at(own, i, was)) / periods.dt
        rates = _own_rates(limits, i, 1.0 - SHARE)
        v = _virtual_velocity(own, i, present - own.virtual[i], w, before, rates, periods)
        fading = _own_rates(limits, i, SHARE)
        last = motion.last[i] - own.speed[i]
        last_but_one = motion.before[i] - own.speed_before[i]
        offset = own.virtual[i] - q[i]
        u = reaching(last, last_but_one, offset, fading.velocity, fading, periods)
        own.speed_before[i] = own.speed[i]
        own.speed[i] = v
        own.asked[i] = v + u
        dq[i] = v + u


@compiled
def _own_rates(limits: MotionConstants, i: int, share: float) -> Rates:
    """Return a share of the limits of joint i, far from its position limits."""
    accel = share * limits.acceleration[i]
    return Rates(share * limits.velocity[i], accel, share * limits.jerk[i], accel, np.inf, 0.0)


@compiled
def _advance(
    own: FollowState, q: Vector, motion: MotionState, periods: Periods, now: float
) -> None:
    """Advance clock and virtual joints to the present step; those not followed begin at the arm."""
    held = now - own.since
    ratio = periods.dt / own.spacing if own.spacing > 0.0 else 1.0
    own.since = now
    own.spacing = periods.dt
    own.clock = own.clock + held * own.rate
    own.rate_before = own.rate - ratio * (own.rate - own.rate_before)
    for i in range(q.size):
        own.virtual[i] += held * own.speed[i]
        own.speed_before[i] = own.speed[i] - ratio * (own.speed[i] - own.speed_before[i])
        if own.count == 0 or abs(motion.last[i] - own.asked[i]) > OTHER:
            own.virtual[i] = q[i]
            own.speed[i] = motion.last[i]
            own.speed_before[i] = motion.before[i]


@compiled
def _virtual_velocity(
    own: FollowState, i: int, left: float, w: float, before: float, rates: Rates, periods: Periods
) -> float:
    """Compute the next velocity of a virtual joint [rad/s].

    Args:
        own: The state, with the velocities of the virtual joints.
        i: Number of the joint.
        left: Displacement to the reference [rad].
        w: Velocity of the reference in this step [rad/s].
        before: Its velocity in the step before [rad/s].
        rates: Limits of the virtual joint.
        periods: Periods of the step.
    """
    dt = periods.dt
    change = rates.acceleration * dt
    bend = rates.jerk * dt * dt
    last = own.speed[i]
    kept = w + 0.5 * left / periods.hold
    turn = kept - 2.0 * last + own.speed_before[i]
    steady = abs(w - before) <= change and abs(left) <= min(bend, change) * dt
    within = abs(kept) <= rates.velocity and abs(kept - last) <= change * (1.0 + ROUNDING)
    if steady and within and abs(turn) <= bend * (1.0 + ROUNDING):
        return kept
    fastest = rates.velocity
    w = min(max(w, -fastest), fastest)
    if w != 0.0:
        before = w - min(max(w - before, -change), change)
        left += rest_ahead(w, before, rates, periods)
    return reaching(last, own.speed_before[i], left, fastest, rates, periods)


@compiled
def _piece(own: FollowState, t: float) -> int:
    """Return the number of the piece at the time t [s] of a curve of two samples or more."""
    k = 0
    while k < own.count - 2 and own.times[k + 1] <= t:
        k += 1
    return k


@compiled
def _curve(own: FollowState, i: int, k: int) -> Curve:
    """Return piece k of the reference of joint i."""
    n = own.goal.size
    h = own.times[k + 1] - own.times[k]
    at = k * n + i
    v = own.slopes[at]
    end = own.slopes[at + n]
    mean = (own.positions[at + n] - own.positions[at]) / h
    return Curve(
        own.positions[at], v, (3.0 * mean - 2.0 * v - end) / h, (v + end - 2.0 * mean) / (h * h)
    )


@compiled
def position_at(own: FollowState, i: int, t: float) -> float:
    """Compute the position of joint i's reference at the time t [s].

    Before the first sample it goes on with the velocity there, after the last one it rests.
    """
    last = own.count - 1
    n = own.goal.size
    if t >= own.times[last]:
        resting: float = own.positions[last * n + i]
        return resting
    if t <= own.times[Knot.FIRST]:
        first: float = own.positions[i] + (t - own.times[Knot.FIRST]) * own.slopes[i]
        return first
    k = _piece(own, t)
    u = t - own.times[k]
    curve = _curve(own, i, k)
    between: float = curve.p + u * (curve.v + u * (curve.c + u * curve.d))
    return between


@compiled
def _take_chunk(
    own: FollowState,
    q: Vector,
    motion: MotionState,
    limits: MotionConstants,
    periods: Periods,
    now: float,
) -> None:
    """Take the waiting samples as the chunk that is followed; what differs becomes an offset."""
    n = q.size
    dt = periods.dt
    begins = own.count == 0
    if begins:
        own.clock = now
        own.rate = 1.0
        own.rate_before = 1.0
    old = np.empty((3, n))
    new = np.empty((3, n))
    if begins:
        for i in range(n):
            old[Past.PRESENT, i] = q[i]
            old[Past.LAST, i] = q[i] - dt * motion.last[i]
            old[Past.BEFORE, i] = old[Past.LAST, i] - dt * motion.before[i]
    else:
        _last_positions(own, dt, old)
    own.count = own.waiting
    own.waiting = 0
    own.mode = own.next_mode
    copied(own.times[: own.count], own.next_times)
    copied(own.positions[: own.count * n], own.next_positions)
    for i in range(n):
        _solve_slopes(own, i)
    _last_positions(own, dt, new)
    for i in range(n if own.times[Knot.FIRST] <= now else 0):
        speed = (
            new[Past.PRESENT, i] - new[Past.LAST, i] - old[Past.PRESENT, i] + old[Past.LAST, i]
        ) / dt
        before = (
            new[Past.LAST, i] - new[Past.BEFORE, i] - old[Past.LAST, i] + old[Past.BEFORE, i]
        ) / dt
        _shift(own, q, limits, i, new[Past.PRESENT, i] - old[Past.PRESENT, i])
        _shift_speed(own, limits, i, speed, before, dt)
    own.clock = now
    _limit_clock(own, limits)
    own.rate = own.fastest
    own.rate_before = own.fastest


@compiled
def _last_positions(own: FollowState, dt: float, found: Matrix) -> None:
    """Write the reference's positions at this step and the two before, (3, n) [rad]."""
    t = own.clock
    for k in range(len(found)):
        for i in range(found.shape[1]):
            found[k, i] = position_at(own, i, t)
        t -= dt * (own.rate if k == 0 else own.rate_before)


@compiled
def _shift(own: FollowState, q: Vector, limits: MotionConstants, i: int, by: float) -> None:
    """Move virtual joint i by a displacement [rad], as far as the offset fades in `FADE`."""
    most = 0.25 * SHARE * limits.acceleration[i] * FADE * FADE
    offset = own.virtual[i] - q[i]
    own.virtual[i] += min(max(by, min(-most - offset, 0.0)), max(most - offset, 0.0))


@compiled
def _shift_speed(
    own: FollowState, limits: MotionConstants, i: int, by: float, before: float, dt: float
) -> None:
    """Change the last two velocities of virtual joint i [rad/s], within its limits."""
    most = 0.25 * SHARE * limits.acceleration[i] * FADE
    fastest = (1.0 - SHARE) * limits.velocity[i]
    change = (1.0 - SHARE) * limits.acceleration[i] * dt
    by = min(max(by, -most), most)
    speed = min(max(own.speed[i] + by, -fastest), fastest)
    before = own.speed_before[i] + min(max(before, -most), most)
    own.speed_before[i] = min(max(before, speed - change), speed + change)
    own.speed[i] = speed


@compiled
def _solve_slopes(own: FollowState, i: int) -> None:
    """Compute the velocities at joint i's samples with which the acceleration is continuous.

    At both ends they are those of the polynomial through up to four samples.
    """
    n = own.goal.size
    last = own.count - 1
    own.slopes[i] = _end_slope(own, i, 0, 1)
    own.slopes[last * n + i] = _end_slope(own, i, last, -1)
    ratio = np.zeros(own.times.size)
    for k in range(1, last):
        h = own.times[k] - own.times[k - 1]
        after = own.times[k + 1] - own.times[k]
        at = k * n + i
        known = 3.0 * (own.positions[at] - own.positions[at - n]) / (h * h)
        known += 3.0 * (own.positions[at + n] - own.positions[at]) / (after * after)
        pivot = 2.0 / h + 2.0 / after - ratio[k - 1] / h
        ratio[k] = 1.0 / (after * pivot)
        own.slopes[at] = (known - own.slopes[at - n] / h) / pivot
    for back in range(1, last):
        at = (last - back) * n + i
        own.slopes[at] -= ratio[last - back] * own.slopes[at + n]


@compiled
def _end_slope(own: FollowState, i: int, first: int, step: int) -> float:
    """Compute the velocity at an end of a chunk [rad/s] from up to four samples (Newton's form)."""
    n = own.goal.size
    count = min(own.count, 4)
    table = np.empty(4)
    for k in range(count):
        table[k] = own.positions[(first + step * k) * n + i]
    slope = 0.0
    product = 1.0
    for order in range(1, count):
        for k in range(count - order):
            h = own.times[first + step * (k + order)] - own.times[first + step * k]
            table[k] = (table[k + 1] - table[k]) / h
        slope += table[Knot.FIRST] * product
        product *= own.times[first] - own.times[first + step * order]
    return slope


@compiled
def _limit_clock(own: FollowState, limits: MotionConstants) -> None:
    """Compute the limits of a chunk's clock from what its samples take of the joints' limits."""
    n = own.goal.size
    most = np.zeros((3, n))
    _largest_rates(own, most)
    fastest = _fastest(own, limits, most) if own.mode == Mode.PATH else 1.0
    accel = CLOCK
    jerk = CLOCK * CLOCK
    for i in range(n):
        if most[Rate.VELOCITY, i] > 0.0:
            whole = (1.0 - SHARE) * limits.acceleration[i]
            left = max(whole - fastest * fastest * most[Rate.ACCELERATION, i], KEPT * whole)
            accel = min(accel, left / most[Rate.VELOCITY, i])
    for i in range(n):
        if most[Rate.VELOCITY, i] > 0.0 and limits.jerk[i] < np.inf:
            whole = (1.0 - SHARE) * limits.jerk[i]
            taken = fastest * (
                fastest * fastest * most[Rate.JERK, i] + 3.0 * most[Rate.ACCELERATION, i] * accel
            )
            jerk = min(jerk, max(whole - taken, KEPT * whole) / most[Rate.VELOCITY, i])
    own.fastest = fastest
    own.clock_acceleration = accel
    own.clock_jerk = jerk


@compiled
def _largest_rates(own: FollowState, most: Matrix) -> None:
    """Raise `most` (3, n) to the largest derivatives of a chunk's joints, up to the third."""
    for k in range(own.count - 1):
        h = own.times[k + 1] - own.times[k]
        for i in range(own.goal.size):
            curve = _curve(own, i, k)
            end = curve.v + h * (2.0 * curve.c + 3.0 * h * curve.d)
            u = -curve.c / (3.0 * curve.d) if curve.d != 0.0 else 0.0
            between = curve.v + u * curve.c if 0.0 < u < h else 0.0
            most[Rate.VELOCITY, i] = max(
                max(most[Rate.VELOCITY, i], abs(curve.v)), max(abs(end), abs(between))
            )
            bent = max(abs(curve.c), abs(curve.c + 3.0 * h * curve.d))
            most[Rate.ACCELERATION, i] = max(most[Rate.ACCELERATION, i], 2.0 * bent)
            most[Rate.JERK, i] = max(most[Rate.JERK, i], 6.0 * abs(curve.d))


@compiled
def _fastest(own: FollowState, limits: MotionConstants, most: Matrix) -> float:
    """Compute the rate of the clock at which a path with these derivatives (3, n) can be kept."""
    fastest = 1.0
    for i in range(own.goal.size):
        rates = _own_rates(limits, i, 1.0 - SHARE)
        if most[Rate.VELOCITY, i] > 0.0:
            fastest = min(fastest, rates.velocity / most[Rate.VELOCITY, i])
        if most[Rate.ACCELERATION, i] > 0.0:
            fastest = min(
                fastest, math.sqrt(TURNS * rates.acceleration / most[Rate.ACCELERATION, i])
            )
        if most[Rate.JERK, i] > 0.0:
            fastest = min(fastest, _cube_root(BENDS * rates.jerk / most[Rate.JERK, i]))
    return fastest


@compiled
def _cube_root(x: float) -> float:
    """Compute the cube root of a number in (0, 1], by Newton's steps; of a larger one 1."""
    root = 1.0
    for _ in range(STEPS if x < 1.0 else 0):
        root = (2.0 * root + x / (root * root)) / 3.0
    return root


@compiled
def _is_silent(own: FollowState, now: float) -> bool:
    """Test whether a stream's next sample is overdue for the first time."""
    due = own.stamp + own.offset + SILENCE * own.sampling
    return own.sampling > 0.0 and not own.is_silent and now > due


@compiled
def _take_sample(
    own: FollowState, q: Vector, limits: MotionConstants, periods: Periods, now: float
) -> None:
    """Take the waiting sample of a stream, and bend the reference to where it leads."""
    n = q.size
    t = own.next_times[Knot.FIRST]
    begins = own.count == 0 or own.mode < Mode.STREAM
    sampling = min(t - own.stamp, SLOWEST)
    if own.sampling > 0.0:
        sampling = min(sampling, 2.0 * own.sampling)
    delay = (Mode.STREAM + 2 - own.next_mode) * sampling
    own.waiting = 0
    own.mode = own.next_mode
    own.is_silent = False
    own.stamp = t
    own.clock = now
    own.rate = 1.0
    own.rate_before = 1.0
    if begins:
        own.count = 1
        own.times[Knot.FIRST] = now
        copied(own.positions[:n], own.next_positions)
        copied(own.goal, own.next_positions[:n])
        own.slopes[:n] = 0.0
        own.pace[:] = 0.0
        own.misses[:] = 1.0
        own.sampling = 0.0
        own.offset = now - t
        return
    own.sampling = sampling
    age = now - own.offset - t
    span = min(max(2.0 * sampling - age, sampling), 3.0 * sampling)
    ahead = age + span - delay
    moves = 0
    for i in range(n):
        moves += own.next_positions[i] != own.goal[i]
    for i in range(n):
        p = own.next_positions[i]
        mean = (p - own.goal[i]) / sampling
        accel = limits.acceleration[i]
        change = accel * sampling * own.misses[i]
        seam = 0.0
        a = 0.0
        w = own.pace[i]
        if abs(mean - w) <= change and abs(mean) <= limits.velocity[i]:
            a = (mean - w) / sampling
            w = mean
            own.misses[i] = 1.0
        elif moves == 0:
            w = 0.0
        else:
            own.misses[i] += 1.0
            seam = p - own.goal[i] - w * sampling
            _shift(own, q, limits, i, seam)
            _move(own, i, seam)
        own.goal[i] = p
        own.pace[i] = w
        end = p + ahead * (w + 0.5 * a * (ahead + sampling))
        _bend(own, i, end, w + a * (ahead + 0.5 * sampling), a, span)
    _lay_out(own, span)


@compiled
def _move(own: FollowState, i: int, by: float) -> None:
    """Move the reference of joint i by a displacement [rad]."""
    for k in range(own.count):
        own.positions[k * own.goal.size + i] += by


@compiled
def _bend(own: FollowState, i: int, end: float, w: float, a: float, span: float) -> None:
    """Bend the reference of joint i from where it is to an end, by three cubic pieces.

    Position, velocity and acceleration are continuous.

    Args:
        own: The state; the samples of joint i are overwritten, their times are not.
        i: Number of the joint.
        end: Position at the end [rad].
        w: Velocity there [rad/s].
        a: Acceleration there [rad/s^2].
        span: Time from now to the end [s].
    """
    n = own.goal.size
    h = span / PIECES
    u = 0.0
    now = Curve(position_at(own, i, own.clock), 0.0, 0.0, 0.0)
    if own.count > 1 and own.clock < own.times[own.count - 1]:
        k = _piece(own, own.clock)
        u = own.clock - own.times[k]
        now = _curve(own, i, k)
    p = now.p + u * (now.v + u * (now.c + u * now.d))
    v = now.v + u * (2.0 * now.c + 3.0 * u * now.d)
    first = 2.0 * now.c + 6.0 * u * now.d
    # The accelerations at both inner ends of pieces, from velocity and position at the end.
    both = (w - v) / h - 0.5 * (first + a)
    second = (end - p - span * v) / (h * h) - (8.0 * first + a) / 6.0 - both
    third = both - second
    own.positions[i] = p
    own.slopes[i] = v
    own.positions[n + i] = p + h * (v + h * (2.0 * first + second) / 6.0)
    own.slopes[n + i] = v + 0.5 * h * (first + second)
    own.positions[Knot.THIRD * n + i] = end - h * (w - h * (2.0 * a + third) / 6.0)
    own.slopes[Knot.THIRD * n + i] = w - 0.5 * h * (a + third)
    own.positions[Knot.LAST * n + i] = end
    own.slopes[Knot.LAST * n + i] = w


@compiled
def _lay_out(own: FollowState, span: float) -> None:
    """Lay the pieces of a stream out from now on, over a time [s]."""
    own.count = PIECES + 1
    for k in range(PIECES + 1):
        own.times[k] = own.clock + k * span / PIECES
