r"""Velocity profiles of one joint that brakes, or arrives at a position, within its rate limits.

With a jerk limit the sampled positions are the control points of a cubic B-spline, whose third
derivative is the jerk, constant in each step. After the command v_k with the acceleration a_k the
spline has the position and velocity


.. math::

    \tilde q_k = q_k + \tfrac16 dt^2 a_k, \qquad \tilde v_k = \tfrac12 (v_k + v_{k-1})

A joint that brakes with the jerk -J up to the deceleration A', holds that, and ends with the jerk J
comes to rest at :math:`\tilde q_k + \Delta(\tilde v_k, a_k)`, where Delta is
`stopping_distance`. `highest` is the largest position on the way.

The kernels of this file return numbers and write no array.
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.schemes.periods import Periods

ROUNDING = 2e-14
"""Distance that counts as rounding of a position while a joint brakes [rad]."""

AT_REST = 1e-100
"""Velocity up to which a joint is at rest [rad/s]; in units of J dt^2 a smaller one may be 0."""

EASE = 0.5
"""Fraction of the remaining distance that a joint almost at rest covers in a period."""

JERK_PERIODS = 8.0
"""Least number of periods in which the usable jerk builds up the full deceleration."""


class Rates(NamedTuple):
    """Limits of one joint on the derivatives of its position; inf for none.

    Attributes:
        velocity: Largest velocity [rad/s].
        acceleration: Largest acceleration [rad/s^2].
        jerk: Largest jerk [rad/s^3].
        deceleration: Deceleration with which the joint brakes before its position limits [rad/s^2].
        slope: Deceleration D of the position-dependent velocity limit [rad/s^2].
        lag: Offset o of that limit, divided by D [s]; 0 for a joint without such a limit.
    """

    velocity: float
    acceleration: float
    jerk: float
    deceleration: float
    slope: float
    lag: float


@compiled
def usable_jerk(rates: Rates, period: float) -> float:
    """Compute the jerk J' [rad/s^3] of stopping paths, for a control period [s].

    It is at most the jerk limit, and so small that the deceleration takes `JERK_PERIODS` periods to
    build up.
    """
    steepest = min(rates.deceleration / period, rates.velocity / (period * period))
    return min(rates.jerk, steepest / JERK_PERIODS)


@compiled
def approach(distance: float, vary: bool) -> float:
    """Compute the largest speed from which a joint can brake within a distance.

    Units make the deceleration and the period 1: the speed falls by 1 a period, and the joint
    travels x + (x - 1) + (x - 2) + ... > 0 from the speed x. Where periods vary, the law is
    x + x^2 / 2, which is at least that sum for periods of any length up to 1.

    Args:
        distance: The distance; below 0 it is returned itself.
        vary: Whether periods vary.
    """
    if not distance > 0.0 or distance == np.inf:
        return distance
    if vary:
        return 2.0 * distance / (math.sqrt(1.0 + 2.0 * distance) + 1.0)
    m = math.floor(0.5 * (math.sqrt(1.0 + 8.0 * distance) - 1.0))
    return distance / (m + 1.0) + 0.5 * m


@compiled
def stopping_distance(v: float, a: float, J: float, A: float) -> float:
    """Compute the distance [rad] in which a spline comes to rest.

    Args:
        v: Velocity [rad/s], at least -a |a| / (2 J), so that the joint does not turn round.
        a: Acceleration [rad/s^2].
        J: Jerk [rad/s^3].
        A: Deceleration at which it brakes [rad/s^2]; -a where that is more.
    """
    deepest = max(A, -a)
    square = max(J * v + 0.5 * a * a, 0.0)
    d = min(math.sqrt(square), deepest)
    T = (a + d) / J
    distance = T * (v + T * (0.5 * a - J * T / 6.0)) + d * d * d / (6.0 * J * J)
    if square > d * d:
        v += 0.5 * (a * a - d * d) / J
        h = 0.5 * d * d / J
        distance += (v - h) * (v + h) / (2.0 * d)
    return distance


@compiled
def highest(v: float, last: float, periods: Periods, profile: tuple[float, float, float]) -> float:
    """Compute how far the stopping path after command v goes beyond the present position [rad].

    Args:
        v: Command [rad/s].
        last: The command before it [rad/s].
        periods: Periods of the step.
        profile: Jerk J [rad/s^3]; deceleration A [rad/s^2]; and the largest deceleration that the
            joint is taken to have at present [rad/s^2], inf for the one that it has.
    """
    J, A, most = profile
    last = min(last, v + most * periods.dt)
    dt = periods.dt
    a = (v - last) / dt
    start = dt * dt * a / 6.0
    speed = 0.5 * (v + last)
    if periods.vary:
        speed = v
        start = periods.hold * v
        if periods.hold >= periods.longest:
            # How long it lasts is known afterwards: the joint may be as quick for as long again.
            growth = max(a, 0.0)
            start = periods.hold * max(v + 0.5 * growth * growth / J, 0.0)
    if speed + 0.5 * a * abs(a) / J >= 0.0:
        return start + max(0.0, stopping_distance(speed, a, J, A))
    if speed <= 0.0:
        return start
    T = -(a + math.sqrt(max(a * a - 2.0 * J * speed, 0.0))) / J
    return start + T * (speed + T * (0.5 * a + J * T / 6.0))


@compiled
def braking(last: float, lb: float, ub: float, jerk: float, periods: Periods) -> float:
    """Compute the command in [lb, ub] [rad/s] with which a joint comes to rest soonest.

    The joint does not turn round, unless the bounds make it.

    Args:
        last: Last command [rad/s].
        lb: Lower bound [rad/s].
        ub: Upper bound [rad/s].
        jerk: Jerk limit [rad/s^3]; inf for none.
        periods: Periods of the step.
    """
    wanted = 0.0
    unit = jerk * periods.dt * periods.dt
    if jerk < np.inf and abs(last) > AT_REST:
        wanted = last - math.copysign(unit * approach(abs(last) / unit, periods.vary), last)
    return min(max(wanted, lb), ub)


@compiled
def arriving(
    last: float, before: float, left: float, wanted: float, rates: Rates, periods: Periods
) -> float:
    """Compute the command [rad/s] with which a joint comes to rest exactly at a position.

    Near the position that is `easing`, if the jerk and acceleration limits admit it in this period
    and in the next one; else it is the wanted velocity.

    Args:
        last: Last command [rad/s].
        before: Command before it [rad/s].
        left: Position less the present one [rad].
        wanted: Velocity towards the position, within all limits [rad/s].
        rates: Limits of the joint.
        periods: Periods of the step.
    """
    accel = rates.acceleration
    jerk = rates.jerk
    dt = periods.dt
    eased = easing(left, periods.hold)
    turn = max(abs(eased - 2.0 * last + before), abs((EASE + 1.0) * eased - last))
    most = min(jerk * dt * dt, accel * dt)
    if jerk < np.inf and max(turn, abs(eased)) <= most and abs(eased - last) <= accel * dt:
        return eased
    return wanted


@compiled
def easing(distance: float, hold: float) -> float:
    """Compute the velocity [rad/s] that covers `EASE` of a distance [rad] in the time `hold` [s].

    It is 0 where the distance is rounding.
    """
    if abs(distance) <= ROUNDING:
        return 0.0
    return EASE * distance / hold
