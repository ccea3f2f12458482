"""Motions to rest of all joints at once (`iiwa_dnn.schemes.rest`): how long, and who agrees.

While a motion is executed, its number of periods falls by one each period, and the velocities stay
on the same curve. A command is given if every limit agrees with the motion to rest after it, else
the next command of the motion that they agreed with (docs/theory_braking.md).
"""

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.dense import largest_entry
from iiwa_dnn.schemes.joint_limits import (
    MotionConstants,
    joint_range,
    joint_rates,
    motion_constants,
)
from iiwa_dnn.schemes.parts import enter_rest
from iiwa_dnn.schemes.periods import constant_periods
from iiwa_dnn.schemes.program import Column, block_constants
from iiwa_dnn.schemes.rest import SLACK, Motion, cubic_coefficient, velocity_at
from iiwa_dnn.schemes.viability import joint_bounds
from iiwa_dnn.step.plan import ControlPlan, Instant
from iiwa_dnn.step.state import MotionState, change_spacing

LONGEST = 1e6
"""Number of periods above which no motion to rest is searched for."""

GROWTH = 1.1
"""Factor between successive numbers of periods that `least_periods` tries."""

LONGER = 1.6
"""Factor between successive numbers of periods that `periods_to_rest` tries."""

TRIES = 6
"""Largest number of motions to rest that are tried for a command."""

BRIEF = 0.1
"""Time of a stored motion to rest up to which longer ones are tried, for each command [s]."""

STRETCH = 1.01
"""Factor between successive numbers of periods that `stretched` tries."""


@compiled
def next_velocity(x: float, before: float, periods: float, cubic: bool) -> float:
    """Compute the velocity after the first period of a motion to rest [rad/s].

    Args:
        x: Velocity at the start [rad/s].
        before: Velocity one period earlier [rad/s].
        periods: Number of periods until rest.
        cubic: Whether the velocities are cubic in time, else linear.
    """
    if periods <= 1.0:  # below 1 if the control period has grown
        return 0.0
    b = cubic_coefficient(x, before, periods, False) if cubic else 0.0
    return velocity_at(x, b, 1.0 / periods, cubic)


@compiled
def least_periods(
    x: Vector, before: Vector, limits: MotionConstants, dt: float, vary: bool
) -> float:
    """Compute the number of periods in which all joints can come to rest together.

    Without a jerk limit it is the least number. With one, the number is raised by a tenth and
    rounded up until every joint keeps its limits, so it may be larger than the least.

    Args:
        x: Present velocities [rad/s], (n,).
        before: Velocities one period earlier [rad/s], (n,).
        limits: Limits of the joints, of which acceleration and jerk are read.
        dt: Control period [s].
        vary: Whether the later periods may be shorter.

    Returns:
        Number M of periods, 0 at rest; inf if it would be above `LONGEST`.
    """
    periods = 0.0
    for i in range(x.size):
        fewest = math.ceil(abs(x[i]) / (limits.acceleration[i] * dt) * (1.0 - SLACK))
        periods = max(periods, fewest)
    return rated_periods(x, before, limits, dt, periods, vary) if limits.cubic else periods


@compiled
def rated_periods(
    x: Vector, before: Vector, limits: MotionConstants, dt: float, periods: float, vary: bool
) -> float:
    """Raise the number of periods of a cubic motion to rest until it keeps the rate limits.

    Arguments and result are those of `least_periods`; `periods` is the number to begin with.
    """
    i = 0
    while i < x.size:
        if periods > LONGEST:
            return np.inf
        jerk = limits.jerk[i] * dt * dt
        if within_rates(x[i], before[i], periods, limits.acceleration[i] * dt, jerk, vary):
            i += 1
        else:
            periods = max(1.0, math.ceil(GROWTH * periods))
            i = 0
    return periods


@compiled
def brake_blindly(motion: MotionState, limits: MotionConstants, dt: float) -> None:
    """Advance a motion by the next command of its motion to rest, where no program can be asked.

    That is the stored one; without one, that in which all joints come to rest together, within the
    bounds of their own limits. A joint outside of its range stays there.

    Args:
        motion: State of the motion of n joints, overwritten.
        limits: Limits of the joints; one without acceleration and jerk limits stops at once.
        dt: Control period [s].
    """
    change_spacing(motion, dt)
    is_stored = motion.stopping_periods > 0.0
    periods = motion.stopping_periods
    if not is_stored:
        periods = min(least_periods(motion.last, motion.before, limits, dt, False), LONGEST)
    elif limits.cubic:
        periods = stretched(motion.last, motion.before, limits, dt, periods)
    for i in range(motion.last.size):
        sent = motion.last[i]
        rates = joint_rates(limits, i)
        first, end = joint_range(limits, i)
        dq = next_velocity(sent, motion.before[i], periods, limits.cubic)
        if not is_stored and min(rates.acceleration, rates.jerk) < np.inf:
            above = end - motion.q[i] if motion.q[i] <= end else np.inf
            below = motion.q[i] - first if motion.q[i] >= first else np.inf
            lower, upper, _, _ = joint_bounds(
                sent, motion.before[i], above, below, rates, constant_periods(dt)
            )
            dq = min(max(dq, lower), upper)
        motion.last[i] = dq
        motion.before[i] = sent
    motion.stopping_periods = max(periods - 1.0, 0.0) if is_stored else 0.0


@compiled
def stretched(
    x: Vector, before: Vector, limits: MotionConstants, dt: float, periods: float
) -> float:
    """Raise the number of periods of a motion to rest until its next period keeps the rate limits.

    Args:
        x: Present velocities [rad/s], (n,).
        before: Velocities one period earlier [rad/s], (n,).
        limits: Limits of the joints, of which acceleration and jerk are read.
        dt: Control period [s].
        periods: Number of periods to begin with.

    Returns:
        Number of periods, not rounded; at least `LONGEST` if no smaller one was found.
    """
    i = 0
    while i < x.size and periods < LONGEST:
        change = next_velocity(x[i], before[i], periods, True) - x[i]
        jerk = abs(change - x[i] + before[i]) / dt
        fraction = max(abs(change) / limits.acceleration[i], jerk / limits.jerk[i])
        if fraction <= dt * (1.0 + SLACK):
            i += 1
        else:
            periods *= STRETCH
            i = 0
    return periods


@compiled
def within_rates(
    x: float, before: float, periods: float, accel: float, jerk: float, vary: bool
) -> bool:
    """Test whether the cubic motion of a joint to rest keeps its acceleration and jerk limits.

    Args:
        x: Present velocity [rad/s].
        before: Velocity one period earlier [rad/s].
        periods: Number of periods until rest.
        accel: Largest change of velocity in a period [rad/s].
        jerk: Largest change of that change in a period [rad/s].
        vary: Whether the later periods may be shorter.
    """
    if periods < 0.5:
        return x == 0.0 and before == 0.0
    b = cubic_coefficient(x, before, periods, vary)
    u = 1.0 / periods
    end = 0.0 if vary else u
    # The first jerk, that of the last period, and that of the period after it, at rest.
    largest = max(abs(6.0 * x + 4.0 * b), abs(x * (6.0 - 12.0 * end) + b * (2.0 - 6.0 * end)))
    largest = max(largest, abs(x * (3.0 - 2.0 * u) + b * (1.0 - u)))
    if largest * u * u > jerk * (1.0 + SLACK):
        return False
    most = accel * (1.0 + SLACK)
    turn = 12.0 * x + 6.0 * b
    at = (6.0 * x + 4.0 * b) / turn if turn != 0.0 else 0.0
    steepest = abs(-6.0 * x * at * (1.0 - at) + b * (1.0 - at) * (1.0 - 3.0 * at)) * u
    if end <= at < 1.0 and steepest > most:
        return False
    return abs(next_velocity(x, before, periods, True) - x) <= most


@compiled
def write_cubic_coefficients(
    dq: Vector, before: Vector, periods: float, vary: bool, coefficient: Vector
) -> None:
    """Compute the coefficient of each joint's motion to rest, as `cubic_coefficient`.

    Args:
        dq: The command that the motion begins with [rad/s], (dof,).
        before: The command before it [rad/s], (dof,).
        periods: Periods until rest.
        vary: Whether periods vary.
        coefficient: The coefficients, (dof,), overwritten.
    """
    for i in range(dq.size):
        coefficient[i] = cubic_coefficient(dq[i], before[i], periods, vary)


@compiled
def periods_to_rest(plan: ControlPlan, instant: Instant, dq: Vector, tries: int) -> float:
    """Compute the number of control periods of the motion to rest after a command.

    Args:
        plan: Layout of the step, whose limits are asked.
        instant: The instant of the step.
        dq: The command, held for one period before the joints stop [rad/s], (dof,).
        tries: Largest number of motions that are tested; the second one takes what is left of the
            stored one.

    Returns:
        Number of periods of `timing.dt` until rest; inf if a limit does not agree with the motion;
        0, without a test, if the rows of all limits suffice.
    """
    yielding = plan.yielding
    if not yielding.verifies:
        return 0.0
    limits = motion_constants(plan.arrays)
    dt = plan.timing.longest
    ratio = dt / plan.timing.dt
    vary = plan.timing.vary
    before = instant.motion.last.copy()
    coefficient = np.zeros(dq.size)
    if vary:
        _at_longest(dq, ratio, before)
    periods = least_periods(dq, before, limits, dt, vary) if limits.rated else 1.0
    stored = instant.motion.stopping_periods - 1.0
    grown = periods
    for k in range(tries):
        if periods == np.inf:
            return np.inf
        motion = _motion(plan, limits.cubic, dq, before, periods, coefficient)
        refusing = _first_refusing(plan, instant, motion)
        if refusing < 0:
            return periods * ratio
        if yielding.lengthens[refusing] == 0.0:
            if periods == grown:
                return np.inf
        elif periods <= max(grown, BRIEF / dt):
            grown = math.ceil(LONGER * periods)
        # What is left of the stored motion most likely is enough.
        periods = max(stored, grown) if k == 0 else grown
        if limits.cubic:
            periods = rated_periods(dq, before, limits, dt, periods, vary)
    return np.inf


@compiled
def _motion(
    plan: ControlPlan,
    cubic: bool,
    dq: Vector,
    before: Vector,
    periods: float,
    coefficient: Vector,
) -> Motion:
    """Return the motion to rest after a command; its coefficients (n,) are overwritten."""
    timing = plan.timing
    if cubic and periods > 0.0:
        write_cubic_coefficients(dq, before, periods, timing.vary, coefficient)
    # If periods vary, the first may be the longest and the others arbitrarily short.
    skips = timing.fraction < 1.0
    longest = timing.longest / timing.fraction
    return Motion(dq, coefficient, periods + timing.vary, longest, cubic, timing.vary, skips)


@compiled
def _at_longest(dq: Vector, ratio: float, before: Vector) -> None:
    """Replace the velocities before a command by those of the same acceleration, `ratio` longer."""
    for i in range(dq.size):
        before[i] = dq[i] - ratio * (dq[i] - before[i])


@compiled
def _first_refusing(plan: ControlPlan, instant: Instant, motion: Motion) -> int:
    """Find the first limit of `Yielding.rests` that does not agree with a motion; -1: all agree."""
    for k in range(plan.yielding.rests.size):
        limit = plan.yielding.rests[k]
        address = plan.arrays.table[limit, Column.REST]
        if not enter_rest(address, instant.step, block_constants(plan.arrays, limit), motion):
            return k
    return -1


@compiled
def store_command(plan: ControlPlan, motion: MotionState, dq: Vector) -> float:
    """Compute the next command of the stored motion to rest; at rest that is 0.

    Args:
        plan: Layout of the step.
        motion: State of the motion, of n joints.
        dq: The command [rad/s], (n,), overwritten; NaN at rest and where no motion is stored, so
            that it widens no bounds.

    Returns:
        Periods until rest after the command; inf if no motion is stored and the arm moves.
    """
    rest = motion.stopping_periods
    if rest == 0.0:
        dq[:] = np.nan
        moves = max(largest_entry(motion.last), largest_entry(motion.before)) > 0.0
        return np.inf if moves else 0.0
    limits = motion_constants(plan.arrays)
    dq[:] = 0.0
    if not limits.rated:
        return 0.0
    if limits.cubic and plan.timing.vary:
        rest = stretched(motion.last, motion.before, limits, plan.timing.dt, rest)
    slow_down(plan, motion, rest, dq)
    return max(rest - 1.0, 0.0)


@compiled
def slow_down(plan: ControlPlan, motion: MotionState, periods: float, dq: Vector) -> None:
    """Compute the next command of a motion that comes to rest after a number of periods.

    The command dq [rad/s], (n,), is overwritten, within velocity and acceleration limits.
    """
    limits = motion_constants(plan.arrays)
    for i in range(motion.q.size):
        last = motion.last[i]
        fastest = max(limits.velocity[i], abs(last))
        change = limits.acceleration[i] * plan.timing.dt
        dq[i] = next_velocity(last, motion.before[i], periods, limits.cubic)
        # After a change of the control period the curve may exceed a limit.
        dq[i] = min(max(dq[i], last - change), last + change)
        dq[i] = min(max(dq[i], -fastest), fastest)
