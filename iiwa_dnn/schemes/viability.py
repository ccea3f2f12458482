r"""Bounds of a joint's next command after which it can still come to rest within its limits.

A command v_k moves a joint to q_{k+1} = q_k + dt v_k, with acceleration a_k = (v_k - v_{k-1}) / dt
and jerk (a_k - a_{k-1}) / dt. The bounds of v_k hold the commands after which the joint can still
come to rest within all of its limits, one step after the other, so that a next command exists
whenever one did: they are never empty.

**Velocity.** After a_k > 0 the velocity grows on, by a_k - J dt, a_k - 2 J dt, ... times dt, until
the acceleration is gone; v_k has to leave a margin for that sum (`approach`). With the acceleration
limit alone, the same sum is the stopping distance of a joint, and leaves the distance to the
position limit: the exact discrete viability kernel.

**Position, with a jerk limit.** The highest point of the stopping path, `highest`, grows with v_k:
the upper bound is its root. In one step of the true limits that point can always be kept, since -J
over a whole step brakes no less: for that, A' = A - J' dt leaves a margin for one step of jerk, and
J' is at most A / (8 dt) and dq_max / (8 dt^2). Samples are above that path by `MARGIN` at most,
which is kept free at either end. A joint needs a range to turn round in, with J' too
(`check_ranges`).

**Position-dependent velocity limits** (`Robot.position_dependent_velocity`) are zero at :math:`o^2
/ (2 D)` before a position limit. At the distance x from there one admits v if :math:`v^2 / (2 D) +
v\,o / D \le x`, the same law with o / D in place of h (`iiwa_dnn.schemes.periods`). With a jerk
limit a stopping path at a deceleration B < D that ends :math:`(o / D)^2 B D / (2 (D - B))` before
that point is below the limit all along; of several B the one that admits most counts, as a joint
may go on with its own.

Sources: A. Del Prete, "Joint position and velocity bounds in discrete-time acceleration/torque
control of robot arms", IEEE Robotics and Automation Letters 3(1), 2018, for the second order. The
third order is derived in docs/theory_limits.md.
"""

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.profiles import ROUNDING, Rates, approach, easing, highest, usable_jerk

MARGIN = 0.2
"""Margin that is kept free at a position limit, in units of J' dt^3; 1 / sqrt(27) is needed."""

REST = 0.25
"""Offset of the rest position of a joint at a limit, in units of J' dt^3, slightly above
`MARGIN`."""

HALVINGS = 20
"""Bisection steps for a command that ends at a position limit."""

LEVELS = 15
"""Decelerations that are tried below a position-dependent velocity limit."""

LOWER = 0.7
"""Ratio of each of them to the one before."""


@compiled
def joint_bounds(
    last: float, before: float, above: float, below: float, rates: Rates, periods: Periods
) -> tuple[float, float, float, float]:
    """Compute bounds of one joint's next command [rad/s], with lower <= upper, and their kinds.

    Jerk and acceleration are within their limits at both, whatever the state is.

    Args:
        last: Last command [rad/s].
        before: Command before it [rad/s].
        above: Distance to the upper position limit [rad].
        below: Distance to the lower position limit [rad].
        rates: Its limits.
        periods: Periods of the step.

    Returns:
        Lower and upper bound, and the `LimitKind` of each.
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
    """Return the kind of the limit that keeps a joint inside its range."""
    return LimitKind.POSITION_DEPENDENT_VELOCITY if rates.lag > 0.0 else LimitKind.POSITION


@compiled
def _rate_kind(bound: float, speed: float, quickest: float, other: float) -> float:
    """Return the kind of a bound, which may be that of the velocity or of the acceleration."""
    if bound == speed:
        return LimitKind.VELOCITY
    return LimitKind.ACCELERATION if bound == quickest else other


@compiled
def _acceleration_bounds(
    last: float, above: float, below: float, rates: Rates, periods: Periods
) -> tuple[float, float, float, float]:
    """Compute `joint_bounds` where no jerk is limited."""
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
    position = _position_kind(rates)
    lower_kind = _rate_kind(lower, -fastest, first, position)
    return lower, upper, lower_kind, _rate_kind(upper, fastest, final, position)


@compiled
def _speed_within(distance: float, rates: Rates, hold: float) -> float:
    """Compute the largest velocity [rad/s] from which a joint can brake within `distance` [rad].

    A position-dependent velocity limit is zero at its end, and bounds the velocity on the way.
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
    """Compute `joint_bounds` where the jerk is limited."""
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
def _ceiling(
    lb: float,
    ub: float,
    end: float,
    last: float,
    periods: Periods,
    profile: tuple[float, float, float],
) -> float:
    """Compute the largest command in [lb, ub] whose highest position is within `end`, else lb.

    The stopping path is that of `highest`.
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
    """Compute the largest command in [lb, ub] whose stopping path is within a distance, else lb.

    Below a position-dependent velocity limit it ends before that by what the limit asks for beyond
    the distance at constant deceleration: the lower the deceleration, the less.
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
