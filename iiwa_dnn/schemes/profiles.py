r"""Velocity profiles of one joint that brakes or arrives, within acceleration and jerk limits.

**Samples.** With a jerk limit the positions are the control points of a cubic B-spline whose third
derivative is the jerk, constant in each step:

.. math::

    \tilde q_k = q_k + \tfrac16 dt^2 a_k, \qquad \tilde v_k = \tfrac12 (v_k + v_{k-1})

It comes to rest at :math:`\tilde q_k + \Delta(\tilde v_k, a_k)` where the jerk is -J, the
acceleration held at -A', and the jerk J (`stopping_distance`; mirrored where the joint is about to
turn round), and its highest point on the way there is `highest`.
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.schemes.periods import Periods

ROUNDING = 2e-14
"""Rounding of positions while a joint brakes at constant deceleration [rad]."""

AT_REST = 1e-100
"""Velocity that counts as none [rad/s]: a smaller one may vanish in units of a step of jerk."""

EASE = 0.5
"""Fraction of the distance to a position limit that a joint all but at rest may cover in a
period."""

JERK_PERIODS = 8.0
"""Least number of periods of jerk in which braking reaches its full deceleration."""


class Rates(NamedTuple):
    """Limits of a joint on the derivatives of its position; inf for none.

    Attributes:
        velocity: Largest velocity [rad/s].
        acceleration: Largest acceleration [rad/s^2].
        jerk: Largest jerk [rad/s^3].
        deceleration: Deceleration with which it stops before its position limits [rad/s^2].
        slope: Deceleration D of its position-dependent velocity limit [rad/s^2].
        lag: Offset o of that limit over D [s].
    """

    velocity: float
    acceleration: float
    jerk: float
    deceleration: float
    slope: float
    lag: float


@compiled
def usable_jerk(rates: Rates, period: float) -> float:
    """Compute J' [rad/s^3], with which braking reaches a deceleration in `JERK_PERIODS` or more."""
    steepest = min(rates.deceleration / period, rates.velocity / (period * period))
    return min(rates.jerk, steepest / JERK_PERIODS)


@compiled
def approach(distance: float, vary: bool) -> float:
    """Compute the largest x for which x + (x - 1) + (x - 2) + ... down to 0 is within `distance`.

    Where periods vary, for which x + x^2 / 2 is: that holds for any sum whose steps are shorter.
    """
    if not distance > 0.0 or distance == np.inf:
        return distance
    if vary:
        return 2.0 * distance / (math.sqrt(1.0 + 2.0 * distance) + 1.0)
    m = math.floor(0.5 * (math.sqrt(1.0 + 8.0 * distance) - 1.0))
    return distance / (m + 1.0) + 0.5 * m


@compiled
def stopping_distance(v: float, a: float, J: float, A: float) -> float:
    """Compute the stopping distance of a spline from velocity v and acceleration a.

    The joint does not turn round: v >= -a |a| / (2 J). It brakes at A, or at -a where that is more.
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
    """Compute the highest position of the stopping path after command v, relative to that of now.

    Args:
        v: Command [rad/s].
        last: The command before it [rad/s].
        periods: Periods of the step.
        profile: Jerk [rad/s^3], deceleration and largest present deceleration [rad/s^2]: a joint
            that brakes by more counts as one that brakes by that.
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
    """Compute the command in [lb, ub] that comes to rest quickest, without turning round."""
    wanted = 0.0
    unit = jerk * periods.dt * periods.dt
    if jerk < np.inf and abs(last) > AT_REST:
        wanted = last - math.copysign(unit * approach(abs(last) / unit, periods.vary), last)
    return min(max(wanted, lb), ub)


@compiled
def arriving(
    last: float, before: float, left: float, wanted: float, rates: Rates, periods: Periods
) -> float:
    """Compute the velocity with which a joint comes to rest exactly at a position.

    A joint that is all but at rest halves what is left in each period, if its jerk limit allows
    this period's change and the next one's; else the velocity is the wanted one.
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
    """Compute the velocity [rad/s] over a distance [rad] that is left; 0 if it is rounding."""
    if abs(distance) <= ROUNDING:
        return 0.0
    return EASE * distance / hold
