r"""Bounds of a joint's next command after which it can still come to rest within its limits.

A command v_k moves a joint to q_{k+1} = q_k + dt v_k, with acceleration a_k = (v_k - v_{k-1}) / dt
and jerk (a_k - a_{k-1}) / dt. Between the bounds lie the commands after which the joint can come to
rest step by step within all of its limits. A command within them leaves such commands for the next
step, so the bounds never contradict each other. The kernels of this file return numbers and write
no array.

**Velocity.** With a_k > 0 the velocity goes on growing, by a_k - J dt, a_k - 2 J dt, ... times dt,
until the acceleration is zero; v_k has to leave a margin for that sum (`approach`). With an
acceleration limit alone the stopping distance of a joint is the same sum. It has to be within the
distance to the position limit, which is the exact discrete viability kernel.

**Position, with a jerk limit.** The largest position on the stopping path, `highest`, grows with
v_k: the upper bound is the v_k at which it is the position limit. The stopping path has the jerk J'
and the deceleration A' = A - J' dt, with J' at most A / (8 dt) and dq_max / (8 dt^2)
(`usable_jerk`): a step with the full limits J and A then brakes no less than the path. Samples are
above the path by at most `MARGIN`, which is kept free at either limit. A joint needs a range long
enough to reverse in with J' (`iiwa_dnn.schemes.joint_limits.check_ranges`).

**Position-dependent velocity limits** (`Robot.position_dependent_velocity`) are zero at :math:`o^2
/ (2 D)` before a position limit. At the distance x from that point, v is below the limit if
:math:`v^2 / (2 D) + v\,o / D \le x`, the law of `iiwa_dnn.schemes.periods` with o / D in place of
h. With a jerk limit, a stopping path at a deceleration B < D is below the limit everywhere if it
ends :math:`(o / D)^2 B D / (2 (D - B))` before that point. The bound is the largest of several B:
the joint can brake with the B of the step before.

Sources: A. Del Prete, "Joint position and velocity bounds in discrete-time acceleration/torque
control of robot arms", IEEE Robotics and Automation Letters 3(1), 2018, for the second order. The
third order is derived in docs/theory_limits.md.
"""

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.profiles import (
    ROUNDING,
    Rates,
    approach,
    arriving,
    easing,
    highest,
    usable_jerk,
)

MARGIN = 0.2
"""Distance that is kept free at a position limit, in units of J' dt^3; 1 / sqrt(27) is needed."""

REST = 0.25
"""Offset of the rest position of a joint at a limit, in units of J' dt^3, slightly above
`MARGIN`."""

HALVINGS = 20
"""Bisection steps for the command whose stopping path ends at a position limit."""

LEVELS = 15
"""Number of decelerations B that are tried below a position-dependent velocity limit."""

LOWER = 0.7
"""Ratio of each B to the one before."""


@compiled
def joint_bounds(
    last: float, before: float, above: float, below: float, rates: Rates, periods: Periods
) -> tuple[float, float, float, float]:
    """Compute the bounds of one joint's next command and their kinds, with lower <= upper.

    Between the bounds acceleration and jerk are within their limits, whatever the state is.

    Args:
        last: Last command [rad/s].
        before: Command before it [rad/s].
        above: Distance to the upper position limit [rad].
        below: Distance to the lower position limit [rad].
        rates: Limits of the joint.
        periods: Periods of the step.

    Returns:
        Lower and upper bound [rad/s], and the `LimitKind` of each; -inf and inf for a joint without
        acceleration and jerk limits.
    """
    above *= periods.fraction
    below *= periods.fraction
    if rates.jerk < np.inf:
        lower, upper, low_kind, high_kind = _jerk_bounds(last, before, above, below, rates, periods)
    elif rates.acceleration < np.inf:
        lower, upper, low_kind, high_kind = _acceleration_bounds(last, above, below, rates, periods)
    else:
        return -np.inf, np.inf, LimitKind.VELOCITY, LimitKind.VELOCITY
    if lower <= upper:
        return lower, upper, low_kind, high_kind
    # By rounding, or at a position that no command led to: the way back into the range may take
    # longer, but not end beyond its other side.
    command = 0.5 * (lower + upper)
    if above < 0.0:
        command = lower
    elif below < 0.0:
        command = upper
    return command, command, low_kind, high_kind


@compiled
def _position_kind(rates: Rates) -> float:
    """Return the `LimitKind` of the limit by which a joint brakes before the end of its range."""
    return LimitKind.POSITION_DEPENDENT_VELOCITY if rates.lag > 0.0 else LimitKind.POSITION


@compiled
def _rate_kind(bound: float, speed: float, quickest: float, other: float) -> float:
    """Return the `LimitKind` of a bound: velocity, acceleration, or else `other`.

    Args:
        bound: The bound [rad/s].
        speed: Bound of the velocity limit [rad/s].
        quickest: Bound of the acceleration limit [rad/s].
        other: `LimitKind` of a bound that is neither.
    """
    if bound == speed:
        return LimitKind.VELOCITY
    return LimitKind.ACCELERATION if bound == quickest else other


@compiled
def _acceleration_bounds(
    last: float, above: float, below: float, rates: Rates, periods: Periods
) -> tuple[float, float, float, float]:
    """Compute `joint_bounds` of a joint with an acceleration limit and no jerk limit."""
    fastest = rates.velocity
    first = last - rates.acceleration * periods.dt
    final = last + rates.acceleration * periods.dt
    above -= min(max(above, 0.0), ROUNDING)
    below -= min(max(below, 0.0), ROUNDING)
    # Outside of the range the way back is no quicker than the velocity limit.
    if rates.lag > 0.0:
        upper = _speed_within(above, rates, periods.hold)
        lower = -_speed_within(below, rates, periods.hold)
    else:
        unit = rates.deceleration * periods.hold
        upper = unit * approach(above / (unit * periods.hold), periods.vary)
        lower = -unit * approach(below / (unit * periods.hold), periods.vary)
    lower = min(max(min(max(lower, -fastest), fastest), first), final)
    upper = min(max(min(max(upper, -fastest), fastest), first), final)
    # From outside of the range the joint comes to rest at its limit.
    unit = rates.deceleration * periods.hold
    if below < 0.0:
        back = unit * approach(-below / (unit * periods.hold), periods.vary)
        lower = min(lower, max(back, first))
    if above < 0.0:
        back = unit * approach(-above / (unit * periods.hold), periods.vary)
        upper = max(upper, min(-back, final))
    position = _position_kind(rates)
    lower_kind = _rate_kind(lower, -fastest, first, position)
    return lower, upper, lower_kind, _rate_kind(upper, fastest, final, position)


@compiled
def _speed_within(distance: float, rates: Rates, hold: float) -> float:
    """Compute the largest velocity [rad/s] below a position-dependent velocity limit.

    Args:
        distance: Distance to the position at which that limit is zero [rad].
        rates: Limits of the joint, which brakes with at most its acceleration limit.
        hold: Time for which the velocity may be held before the joint brakes [s].
    """
    accel = rates.acceleration
    slope = rates.slope
    lag = rates.lag
    unit = slope * (hold + lag)
    speed = unit * approach(distance / (unit * (hold + lag)), True)
    # Where the limit shrinks by more than the joint can brake, it has to have braked before.
    turn = accel * lag * slope / (slope - accel) if slope > accel else np.inf
    if speed > turn:
        unit = accel * hold
        speed = unit * approach((distance - 0.5 * turn * lag) / (unit * hold), True)
    return speed


@compiled
def _jerk_bounds(
    last: float, before: float, above: float, below: float, rates: Rates, periods: Periods
) -> tuple[float, float, float, float]:
    """Compute `joint_bounds` of a joint with a jerk limit."""
    fastest = rates.velocity
    accel = rates.acceleration
    dt = periods.dt
    longest = periods.longest
    slowest = last - accel * dt
    quickest = last + accel * dt
    # A state that no command led to may leave nothing: acceleration goes before jerk, and so does
    # velocity, or an acceleration beyond its limit would go on.
    bottom = min(-fastest, quickest)
    top = max(fastest, slowest)
    middle = min(max(2.0 * last - before, slowest), quickest)
    change = rates.jerk * dt * dt
    first = min(max(max(slowest, middle - change), bottom), top)
    final = min(max(min(quickest, middle + change), bottom), top)
    jerk = usable_jerk(rates, longest)
    unit = jerk * dt * dt
    vary = periods.vary or rates.lag > 0.0
    down = last - unit * approach((last + fastest) / unit, vary)
    up = last + unit * approach((fastest - last) / unit, vary)
    lb = min(max(down, first), final)
    ub = min(max(up, first), final)
    if lb > ub:
        lb = 0.5 * (lb + ub)
        ub = lb
    profile = (jerk, min(rates.deceleration, accel - jerk * longest), np.inf)
    margin = 0.0 if periods.vary else MARGIN * unit * dt
    if rates.lag > 0.0:
        upper = _ceiling_below_velocity_limit(lb, ub, above, last, rates, periods)
        lower = -_ceiling_below_velocity_limit(-ub, -lb, below, -last, rates, periods)
    else:
        upper = _ceiling(lb, ub, above - margin, last, periods, profile)
        lower = -_ceiling(-ub, -lb, below - margin, -last, periods, profile)
    if min(above, below) < 0.0:
        lower = min(lower, _return(lb, ub, below, last, periods, profile))
        upper = max(upper, -_return(-ub, -lb, above, -last, periods, profile))
    if lower < upper and max(abs(last), abs(last - before)) < unit:
        # Held at that bound, a joint at its margin would swing by it, 2 + sqrt(3) times as far in
        # each period (the zeros of a sampled triple integrator): all but at rest, it comes to rest.
        rest = 0.0 if periods.vary else REST * unit * dt
        eased = max(min(upper, max(easing(above - rest, periods.hold), lb)), lower)
        lower = min(max(lower, min(-easing(below - rest, periods.hold), ub)), eased)
        upper = eased
    lower_kind = _rate_kind(lb, down, slowest, LimitKind.JERK)
    upper_kind = _rate_kind(ub, up, quickest, LimitKind.JERK)
    if lower != lb:
        lower_kind = _position_kind(rates)
    if upper != ub:
        upper_kind = _position_kind(rates)
    return lower, upper, lower_kind, upper_kind


@compiled
def _return(
    lb: float,
    ub: float,
    below: float,
    last: float,
    periods: Periods,
    profile: tuple[float, float, float],
) -> float:
    """Compute the largest command in [lb, ub] that returns from below a limit to rest at it.

    If the joint is not below the limit, it is inf. `below` is the distance to the limit [rad],
    negative below it; `last`, `periods` and `profile` are those of `highest`.
    """
    if not below < 0.0:
        return np.inf
    jerk, _, _ = profile
    # Where a joint rests that is held at its limit.
    rest = 0.0 if periods.vary else REST * jerk * periods.dt * periods.dt * periods.dt
    return _ceiling(lb, ub, rest - below, last, periods, profile)


@compiled
def _ceiling(
    lb: float,
    ub: float,
    end: float,
    last: float,
    periods: Periods,
    profile: tuple[float, float, float],
) -> float:
    """Compute the largest command in [lb, ub] whose stopping path stays up to `end` [rad].

    It is lb if there is none. `end` is relative to the present position; `last`, `periods` and
    `profile` are those of `highest`.
    """
    if highest(ub, last, periods, profile) <= end:
        return ub
    for _ in range(HALVINGS):
        middle = 0.5 * (lb + ub)
        if highest(middle, last, periods, profile) <= end:
            lb = middle
        else:
            ub = middle
    return lb


@compiled
def _ceiling_below_velocity_limit(
    lb: float, ub: float, distance: float, last: float, rates: Rates, periods: Periods
) -> float:
    """Compute the largest command in [lb, ub] below a position-dependent velocity limit.

    It is lb if there is none. The stopping paths are those of `LEVELS` decelerations B, each of
    which ends before the point at which the limit is zero, as the head of this file says.

    Args:
        lb: Lower bound [rad/s].
        ub: Upper bound [rad/s].
        distance: Distance to that point [rad].
        last: Last command [rad/s].
        rates: Limits of the joint.
        periods: Periods of the step.
    """
    # Below a limit that shrinks, the stopping path is counted at the samples.
    own = Periods(
        periods.dt,
        periods.expected,
        periods.hold,
        periods.longest,
        periods.fraction,
        True,
        periods.exceeded,
    )
    deceleration = rates.deceleration
    J = usable_jerk(rates, periods.longest)
    for level in range(LEVELS):
        A = min(deceleration, rates.acceleration - J * periods.longest)
        end = distance - 0.5 * rates.lag * rates.lag * rates.slope * A / (rates.slope - A)
        # One that brakes by more is behind on its way.
        profile = (J, A, A)
        if level == 0 or highest(lb, last, own, profile) <= end:
            lb = _ceiling(lb, ub, end, last, own, profile)
        deceleration *= LOWER
    return lb


@compiled
def reaching(
    last: float, before: float, left: float, most: float, rates: Rates, periods: Periods
) -> float:
    """Compute the largest velocity [rad/s] from which a joint can still come to rest at a position.

    Args:
        last: Last command [rad/s].
        before: Command before it [rad/s].
        left: Position less the present one [rad].
        most: Largest speed that is wanted [rad/s].
        rates: Limits of the joint, with one deceleration.
        periods: Periods of the step.
    """
    above = left if left >= 0.0 else np.inf
    below = -left if left < 0.0 else np.inf
    wanted = min(max(left / periods.hold, -most), most)
    lower, upper, _, _ = joint_bounds(last, before, above, below, rates, periods)
    wanted = min(max(wanted, lower), upper)
    return arriving(last, before, left, wanted, rates, periods)


@compiled
def rest_ahead(v: float, last: float, rates: Rates, periods: Periods) -> float:
    """Compute the displacement [rad] to where a joint comes to rest that begins to brake after v.

    Args:
        v: Command [rad/s].
        last: Command before it [rad/s].
        rates: Limits of the joint.
        periods: Periods of the step.
    """
    dt = periods.dt
    accel = rates.acceleration
    if rates.jerk < np.inf:
        jerk = usable_jerk(rates, periods.longest)
        profile = (jerk, min(accel, accel - jerk * periods.longest), np.inf)
        margin = 0.0 if periods.vary else MARGIN * jerk * dt * dt * dt
        sign = math.copysign(1.0, v)
        return sign * (highest(sign * v, sign * last, periods, profile) + margin)
    if accel == np.inf:
        return v * periods.hold
    unit = accel * periods.hold
    x = abs(v) / unit
    m = math.floor(x)
    steps = x + 0.5 * x * x if periods.vary else (m + 1.0) * x - 0.5 * m * (m + 1.0)
    return math.copysign(steps * unit * periods.hold, v)
