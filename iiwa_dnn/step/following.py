r"""Joints that follow timed positions without lag, within every limit: the request `FOLLOW`.

A chunk of samples is a cubic spline r(s) of its clock s, which is one more joint: it comes to rest
at the last sample. A stream is the curve from where the reference is to where the last samples
lead. Between r and a command are a virtual joint and an offset from it; each takes the law by which
a joint comes to rest at a position (`reaching`):

- A *virtual joint* follows r within :math:`1 - \varphi` of the limits. Where it cannot, it aims at
  the position at which r could come to rest, and is no slower than r where it is late.
- The *offset* of the arm from the virtual joint comes to rest at 0 within :math:`\varphi` of the
  limits, :math:`\varphi` being `SHARE`.

The command is the sum of both velocities, so it is within all limits. A new chunk begins in the
state in which the old one is left, where that takes no more than :math:`\varphi` of the limits: it
differs by the rounding of a spline. Where it begins elsewhere, the virtual joint is moved by the
difference, which fades as an offset; where a position limit or a distance changes a command, the
virtual joint begins anew at the arm.
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.schemes.joint_limits import MotionConstants
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.profiles import Rates, usable_jerk
from iiwa_dnn.schemes.viability import reaching, rest_ahead
from iiwa_dnn.step.clocks import SHARE, limit_clock, own_rates
from iiwa_dnn.step.curves import (
    PIECES,
    Curve,
    Knot,
    bend,
    inner_accelerations,
    lay_out,
    move,
    piece_at,
    solve_slopes,
    state_at,
)
from iiwa_dnn.step.samples import SHORTEST, FollowState, Mode
from iiwa_dnn.step.state import MotionState

FADE = 1.0
"""Time in which the largest offset that a new chunk may leave fades [s]."""

SILENCE = 1.5
"""Sampling periods after which a stream without a new sample comes to rest at the last one."""

GENTLE = 0.02
"""Time in which an offset's acceleration builds up, at least [s]: jerk is felt, and saves little.
"""

JUMP = 2.0
"""Acceleration between samples of a stream, relative to the limit, above which they jump: samples
that are too quick to be followed are no jump, whose offset would fade slowly."""

OTHER = 1e-9
"""Difference of a command from the request above which the virtual joint begins anew [rad/s]."""

ROUNDING = 1e-9
"""Relative excess over a limit that counts as rounding."""

DRIFT = 0.02
"""Part of a sample's delay by which the clock of a stream is corrected: clocks drift."""

ASTRAY = 2.0
"""Sampling periods by which a sample may come early or late; beyond, a clock has jumped."""

SLOWEST = 0.5
"""Longest sampling period of a stream [s]; after a longer pause it goes on with the one before."""


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
            bend(own, i, state_at(own, i, own.clock), Curve(own.goal[i], 0.0, 0.0, 0.0), span)
        lay_out(own, span)
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
        own.reference[i] = state_at(own, i, max(then, first)).p
        present = state_at(own, i, max(clock, first)).p
        w = (own.reference[i] - present) / periods.expected
        before = (present - state_at(own, i, was).p) / periods.dt
        rates = own_rates(limits, i, 1.0 - SHARE)
        v = _virtual_velocity(own, i, present - own.virtual[i], w, before, rates, periods)
        fading = _fading_rates(limits, i)
        last = motion.last[i] - own.speed[i]
        last_but_one = motion.before[i] - own.speed_before[i]
        offset = own.virtual[i] - q[i]
        u = reaching(last, last_but_one, offset, fading.velocity, fading, periods)
        own.speed_before[i] = own.speed[i]
        own.speed[i] = v
        own.asked[i] = v + u
        dq[i] = v + u


@compiled
def _fading_rates(limits: MotionConstants, i: int) -> Rates:
    """Return the limits within which the offset of joint i fades: jerk builds up over `GENTLE`."""
    own = own_rates(limits, i, SHARE)
    accel = own.acceleration
    return Rates(own.velocity, accel, min(own.jerk, accel / GENTLE), accel, np.inf, 0.0)


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
    fastest = rates.velocity
    last = own.speed[i]
    middle = 2.0 * last - own.speed_before[i]
    kept = w + 0.5 * left / periods.hold
    steady = abs(w - before) <= change
    near = steady and abs(left) <= min(bend, change) * dt
    within = abs(kept) <= fastest and abs(kept - last) <= change * (1.0 + ROUNDING)
    if near and within and abs(kept - middle) <= bend * (1.0 + ROUNDING):
        return kept
    if w == 0.0:
        return reaching(last, own.speed_before[i], left, fastest, rates, periods)
    v = min(max(w, -fastest), fastest)
    ahead = rest_ahead(v, v - min(max(v - before, -change), change), rates, periods)
    v = reaching(last, own.speed_before[i], left + ahead, fastest, rates, periods)
    if not steady or rates.jerk == np.inf or rates.jerk <= usable_jerk(rates, periods.longest):
        return v
    # Where periods are long, that law counts on less jerk than there is: with it alone a late joint
    # would be slower than a reference that is nearly as quick as the limits, and never catch up.
    quicker = max(min(max(w, -fastest), fastest), max(last - change, middle - bend))
    quicker = min(quicker, min(last + change, middle + bend))
    found: float = max(v, quicker) if left > 0.0 else min(v, quicker)
    return found


@compiled
def _take_chunk(
    own: FollowState,
    q: Vector,
    motion: MotionState,
    limits: MotionConstants,
    periods: Periods,
    now: float,
) -> None:
    """Take the waiting samples as the chunk that is followed; what differs becomes an offset.

    Where they are the rest of the one that is followed, nothing changes: its clock may be braking
    for the end.
    """
    n = q.size
    dt = periods.dt
    if _is_sent_again(own, n):
        own.waiting = 0
        return
    p = q.copy()
    v = np.empty(n)
    c = np.empty(n)
    if own.count == 0:
        own.clock = now
        own.rate = 1.0
        for i in range(n):
            change = 0.5 * (motion.last[i] - motion.before[i])
            v[i] = motion.last[i] + change
            c[i] = change / dt
    for i in range(n if own.count > 0 else 0):
        old = state_at(own, i, own.clock)
        p[i] = old.p
        v[i] = old.v
        c[i] = old.c
    own.count = own.waiting
    own.waiting = 0
    own.mode = own.next_mode
    copied(own.times[: own.count], own.next_times)
    copied(own.positions[: own.count * n], own.next_positions)
    for i in range(n):
        solve_slopes(own, i)
    on_time = own.rate == 1.0 and abs(own.clock - now) < SHORTEST
    if own.times[Knot.FIRST] <= now and not (on_time and _joins(own, limits, p, v, c, dt)):
        for i in range(n):
            new = state_at(own, i, own.clock)
            _shift(own, q, limits, i, new.p - p[i])
            _shift_speed(own, limits, i, own.rate * (new.v - v[i]), dt)
    own.clock = now
    limit_clock(own, limits)
    own.rate = own.fastest
    own.rate_before = own.fastest


@compiled
def _is_sent_again(own: FollowState, n: int) -> bool:
    """Test whether the waiting samples of n joints are the last ones of the chunk's."""
    passed = own.count - own.waiting
    if passed < 0 or own.mode != own.next_mode:
        return False
    others = 0
    for j in range(own.waiting):
        others += not abs(own.times[passed + j] - own.next_times[j]) < SHORTEST
    for j in range(own.waiting * n):
        others += own.positions[passed * n + j] != own.next_positions[j]
    return others == 0


@compiled
def _joins(
    own: FollowState, limits: MotionConstants, p: Vector, v: Vector, c: Vector, dt: float
) -> bool:
    """Let a chunk begin in the old state, if that takes at most `SHARE` of the limits.

    The pieces up to the third sample from now on lead there. Where it takes more, or too few
    samples are left, the chunk stays as it is.

    Args:
        own: The state, with the chunk.
        limits: Limits of the joints.
        p: Positions of the old reference now [rad], (n,).
        v: Its velocities [rad/s], (n,).
        c: Half its accelerations [rad/s^2], (n,).
        dt: Control period [s].

    Returns:
        Whether it begins there.
    """
    n = p.size
    passed = piece_at(own, own.clock)
    k = passed + PIECES
    end = own.times[min(k, own.count - 1)]
    span = end - own.clock
    if k > own.count - 2 or span < dt:
        return False
    for i in range(n):
        new = state_at(own, i, own.clock)
        gap = Curve(p[i] - new.p, v[i] - new.v, c[i] - new.c, 0.0)
        rest = Curve(0.0, 0.0, 0.0, 0.0)
        first = 2.0 * gap.c
        second, third = inner_accelerations(gap, rest, span)
        rates = own_rates(limits, i, SHARE)
        most = max(max(abs(first), abs(second)), abs(third))
        jump = max(max(abs(second - first), abs(third - second)), abs(third))
        if most > rates.acceleration or jump * PIECES > rates.jerk * span:
            return False
    for i in range(n):
        there = state_at(own, i, end)
        for j in range(PIECES, own.count - k + PIECES):
            own.positions[j * n + i] = own.positions[(j + passed) * n + i]
            own.slopes[j * n + i] = own.slopes[(j + passed) * n + i]
        bend(own, i, Curve(p[i], v[i], c[i], 0.0), there, span)
    count = own.count - k + PIECES
    for j in range(PIECES, count):
        own.times[j] = own.times[j + passed]
    lay_out(own, span)
    own.count = count
    return True


@compiled
def _shift(own: FollowState, q: Vector, limits: MotionConstants, i: int, by: float) -> None:
    """Move virtual joint i by a displacement [rad], as far as the offset fades in `FADE`."""
    most = 0.25 * SHARE * limits.acceleration[i] * FADE * FADE
    offset = own.virtual[i] - q[i]
    own.virtual[i] += min(max(by, min(-most - offset, 0.0)), max(most - offset, 0.0))


@compiled
def _shift_speed(own: FollowState, limits: MotionConstants, i: int, by: float, dt: float) -> None:
    """Change the velocity of virtual joint i [rad/s], within its limits."""
    most = 0.25 * SHARE * limits.acceleration[i] * FADE
    rates = own_rates(limits, i, 1.0 - SHARE)
    change = rates.acceleration * dt
    by = min(max(by, -most), most)
    speed = min(max(own.speed[i] + by, -rates.velocity), rates.velocity)
    before = own.speed_before[i] + by
    own.speed_before[i] = min(max(before, speed - change), speed + change)
    own.speed[i] = speed


@compiled
def _is_silent(own: FollowState, now: float) -> bool:
    """Test whether a stream's next sample is overdue, by clock and arrival, for the first time."""
    due = max(own.stamp + own.offset, own.times[Knot.FIRST]) + SILENCE * own.sampling
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
    if abs(age) > ASTRAY * sampling:
        own.offset = now - t
        age = 0.0
    own.offset += DRIFT * age
    span = min(max(2.0 * sampling - age, sampling), 3.0 * sampling)
    ahead = age + span - delay
    moves = 0
    for i in range(n):
        moves += own.next_positions[i] != own.goal[i]
    for i in range(n):
        p = own.next_positions[i]
        mean = (p - own.goal[i]) / sampling
        accel = limits.acceleration[i]
        change = JUMP * accel * sampling * own.misses[i]
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
            move(own, i, seam)
        own.goal[i] = p
        own.pace[i] = w
        end = p + ahead * (w + 0.5 * a * (ahead + sampling))
        w += a * (ahead + 0.5 * sampling)
        bend(own, i, state_at(own, i, now), Curve(end, w, 0.5 * a, 0.0), span)
    lay_out(own, span)
