"""Curves through samples, piecewise cubic: of a chunk a spline, of a stream where samples lead."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.step.samples import FollowState

PIECES = 3
"""Cubic pieces of the curve of a stream: as many as reach given positions, velocities and
accelerations at both ends."""


class Knot(IntEnum):
    """Samples of a curve: the first one, and the inner and outer ends of that of a stream."""

    FIRST = 0
    SECOND = 1
    THIRD = 2
    LAST = 3


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
def piece_at(own: FollowState, t: float) -> int:
    """Return the number of the piece at the time t [s] of a curve of two samples or more."""
    k = 0
    while k < own.count - 2 and own.times[k + 1] <= t:
        k += 1
    return k


@compiled
def curve_of(own: FollowState, i: int, k: int) -> Curve:
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
def state_at(own: FollowState, i: int, t: float) -> Curve:
    """Compute the reference of joint i from the time t [s] on, up to its next sample.

    Before the first sample it goes on with the velocity there, after the last one it rests.
    """
    last = own.count - 1
    n = own.goal.size
    if t >= own.times[last]:
        return Curve(own.positions[last * n + i], 0.0, 0.0, 0.0)
    if t < own.times[Knot.FIRST]:
        v = own.slopes[i]
        return Curve(own.positions[i] + (t - own.times[Knot.FIRST]) * v, v, 0.0, 0.0)
    k = piece_at(own, t)
    u = t - own.times[k]
    curve = curve_of(own, i, k)
    bent = curve.c + 3.0 * u * curve.d
    p = curve.p + u * (curve.v + u * (curve.c + u * curve.d))
    return Curve(p, curve.v + u * (curve.c + bent), bent, curve.d)


@compiled
def solve_slopes(own: FollowState, i: int) -> None:
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
def move(own: FollowState, i: int, by: float) -> None:
    """Move the reference of joint i by a displacement [rad]."""
    for k in range(own.count):
        own.positions[k * own.goal.size + i] += by


@compiled
def inner_accelerations(begin: Curve, end: Curve, span: float) -> tuple[float, float]:
    """Compute the accelerations where three cubic pieces meet that lead from one state to another.

    Position, velocity and acceleration are continuous.

    Args:
        begin: State at the begin.
        end: State at the end.
        span: Time between them [s].
    """
    h = span / PIECES
    a = 2.0 * end.c
    first = 2.0 * begin.c
    both = (end.v - begin.v) / h - 0.5 * (first + a)
    second = (end.p - begin.p - span * begin.v) / (h * h) - (8.0 * first + a) / 6.0 - both
    return second, both - second


@compiled
def bend(own: FollowState, i: int, begin: Curve, end: Curve, span: float) -> None:
    """Let the reference of joint i lead from one state to another (`inner_accelerations`).

    The samples of joint i are overwritten, their times are not.
    """
    n = own.goal.size
    h = span / PIECES
    second, third = inner_accelerations(begin, end, span)
    own.positions[i] = begin.p
    own.slopes[i] = begin.v
    own.positions[n + i] = begin.p + h * (begin.v + h * (4.0 * begin.c + second) / 6.0)
    own.slopes[n + i] = begin.v + 0.5 * h * (2.0 * begin.c + second)
    own.positions[Knot.THIRD * n + i] = end.p - h * (end.v - h * (4.0 * end.c + third) / 6.0)
    own.slopes[Knot.THIRD * n + i] = end.v - 0.5 * h * (2.0 * end.c + third)
    own.positions[Knot.LAST * n + i] = end.p
    own.slopes[Knot.LAST * n + i] = end.v


@compiled
def lay_out(own: FollowState, span: float) -> None:
    """Lay the pieces of a stream out from now on, over a time [s]."""
    own.count = PIECES + 1
    for k in range(PIECES + 1):
        own.times[k] = own.clock + k * span / PIECES
