"""Limits of the clock of a chunk: its largest rate, acceleration and jerk."""

from __future__ import annotations

import math
from enum import IntEnum

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix
from iiwa_dnn.schemes.joint_limits import MotionConstants
from iiwa_dnn.schemes.profiles import Rates
from iiwa_dnn.step.curves import curve_of
from iiwa_dnn.step.samples import FollowState, Mode

SHARE = 0.1
"""Share of the limits with which an offset fades."""

KEPT = 0.3
"""Least share of the limits that the clock of a chunk may use to brake."""

TURNS = 0.7
"""Share of the acceleration limits that a path slowed down for them uses."""

BENDS = 0.5
"""Share of the jerk limits that a path slowed down for them uses."""

CLOCK = 1e3
"""Largest acceleration [1/s] and jerk [1/s^2] of a clock."""

STEPS = 60
"""Newton's steps of a cube root."""


class Rate(IntEnum):
    """Derivatives of a path."""

    VELOCITY = 0
    ACCELERATION = 1
    JERK = 2


@compiled
def own_rates(limits: MotionConstants, i: int, share: float) -> Rates:
    """Return a share of the limits of joint i, far from its position limits."""
    accel = share * limits.acceleration[i]
    return Rates(share * limits.velocity[i], accel, share * limits.jerk[i], accel, np.inf, 0.0)


@compiled
def limit_clock(own: FollowState, limits: MotionConstants) -> None:
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
            curve = curve_of(own, i, k)
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
        rates = own_rates(limits, i, 1.0 - SHARE)
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
