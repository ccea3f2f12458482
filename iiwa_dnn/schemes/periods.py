r"""Periods of a control step, which may vary up to T.

A velocity that may be held for h is within the distance d of a limit if :math:`v h + v^2 / (2 A)
\le d`, and with a jerk limit if h v and the continuous stopping path after it are. That is kept
whatever period comes next (docs/theory_limits.md).
"""

from typing import NamedTuple

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError

SLACK = 1e-9
"""Relative excess of a period that is rounding."""


class Periods(NamedTuple):
    """Periods with which the bounds of a step count.

    Attributes:
        dt: Period over which changes of the command are measured [s].
        expected: Time for which the command is expected to be held [s].
        hold: Longest time for which it may be held [s].
        longest: Longest period that may come [s].
        fraction: Part of a distance that is gone in the stated periods at least: 1, or dt / T where
            nobody states them and they may last T.
        vary: Whether periods differ.
        exceeded: Whether the stated one is above the longest.
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
    """Return `stated_periods`, where 0 is a period that is not stated, or no longest one."""
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
    """Return a longest period [s], or None; refuse one that is below the control period [s]."""
    if longest is not None and checks.positive("longest_period", longest) < dt:
        raise InvalidInputError("longest_period", f"must be at least dt, {dt:g} s", longest)
    return longest


def stated_periods(
    nominal: float, longest: float | None, dt: float | None, elapsed: float | None
) -> Periods:
    """Return the periods of a step, as a loop states them.

    Args:
        nominal: Control period where none is stated [s].
        longest: Longest period of a loop whose periods vary [s]; None: `elapsed` is refused.
        dt: Period for which the command will be held [s], if that is stated.
        elapsed: Time since the last step [s], if that is stated.

    Raises:
        InvalidInputError: A period is not above 0; or both are stated.
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
