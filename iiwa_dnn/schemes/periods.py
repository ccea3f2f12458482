r"""Control periods of a step: constant, or different from step to step and at most T.

Where a velocity v may be held for the time h before the joint brakes at A, the joint stays within
the distance d of a limit if :math:`v h + v^2 / (2 A) \le d`; with a jerk limit, if h v plus the
stopping path of continuous time is at most d. The next step can keep both conditions whatever its
period is (docs/theory_limits.md).
"""

from typing import NamedTuple

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError

SLACK = 1e-9
"""Relative excess over the longest period that counts as rounding."""


class Periods(NamedTuple):
    """Periods for which the bounds of a step are computed.

    Attributes:
        dt: Period by which a change of the command is divided for its acceleration [s].
        expected: Time for which the command is expected to be held [s].
        hold: Longest time for which it may be held [s].
        longest: Longest period of a later step [s].
        fraction: Factor for distances to position limits: dt / T where periods are not stated but
            may last T, else 1.
        vary: Whether periods differ from step to step.
        exceeded: Whether the stated period is above the longest.
    """

    dt: float
    expected: float
    hold: float
    longest: float
    fraction: float
    vary: bool
    exceeded: bool


@compiled
def constant_periods(dt: float) -> Periods:
    """Return the periods of a loop whose period [s] is constant."""
    return Periods(dt, dt, dt, dt, 1.0, False, False)


@compiled
def periods_of(nominal: float, longest: float, dt: float, elapsed: float) -> Periods:
    """Return the periods of a step, all in [s], as `stated_periods` without its checks.

    `longest` is 0 where periods are constant; of `dt` and `elapsed`, 0 is one that is not stated.
    """
    hold = dt if dt > 0.0 else nominal
    if longest == 0.0:
        return constant_periods(hold)
    exceeded = max(dt, elapsed) > longest * (1.0 + SLACK)
    if dt > 0.0:
        return Periods(dt, dt, dt, longest, 1.0, True, exceeded)
    if elapsed > 0.0:
        return Periods(elapsed, nominal, longest, longest, 1.0, True, exceeded)
    return Periods(nominal, nominal, nominal, nominal, nominal / longest, True, False)


def checked_longest(longest: float | None, dt: float) -> float | None:
    """Return a longest period [s], or None; refuse one that is below the control period dt [s]."""
    if longest is not None and checks.positive("longest_period", longest) < dt:
        raise InvalidInputError("longest_period", f"must be at least dt, {dt:g} s", longest)
    return longest


def stated_periods(
    nominal: float, longest: float | None, dt: float | None, elapsed: float | None
) -> Periods:
    """Return the periods of a step from the periods that a loop states, after checking these.

    Args:
        nominal: Control period where none is stated [s].
        longest: Longest period of a loop whose periods vary [s]; None: `elapsed` is refused.
        dt: Period for which the command will be held [s], if that is stated.
        elapsed: Time since the last step [s], if that is stated.

    Raises:
        InvalidInputError: A period is not above 0, `elapsed` is stated without a longest period, or
            both periods are stated.
    """
    if dt is not None and elapsed is not None:
        raise InvalidInputError(
            "dt and elapsed", "are two periods: pass one of them", (dt, elapsed)
        )
    if elapsed is not None and longest is None:
        raise InvalidInputError("elapsed", "needs a longest_period", elapsed)
    said = 0.0 if dt is None else checks.positive("dt", dt)
    passed = 0.0 if elapsed is None else checks.positive("elapsed", elapsed)
    return periods_of(nominal, longest or 0.0, said, passed)
