r"""Motions of all joints to rest at once, with which limits are tested until the arm stands still.

With :math:`u = i / M` in period i of M, the velocities that begin with the command :math:`x_0` are

.. math::

    x_i = x_0 \,(1 - u)^2 (1 + 2 u) + b\, u\,(1 - u)^2

if a jerk is limited, with b such that the curve goes through the command before :math:`x_0` too;
else :math:`x_i = x_0 (1 - u)`. Without acceleration limits a motion to rest is one period at the
command.
"""

import math
from typing import NamedTuple

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Vector

SLACK = 1e-12
"""Relative excess over a limit that counts as rounding."""

UNEVEN = 0.175
"""Bound on how far varying periods lower a displacement to rest, as a part of |b| dt; the largest
over all signs of velocity and acceleration is 0.169 (docs/theory_limits.md)."""


class Motion(NamedTuple):
    """Motion of n joints to rest, all at once (see the module).

    Attributes:
        first: Velocities x_0 at the start [rad/s], (n,).
        coefficient: Coefficients b of the cubics [rad/s], (n,); 0 if velocities are linear in time.
        periods: Number M of control periods until rest.
        period: Longest time for which each velocity is held [s].
        cubic: Whether the velocities are cubic in time, else linear.
        varies: Whether control periods may be shorter than the longest one.
        skips: Whether a velocity may be held for no time at all.
    """

    first: Vector
    coefficient: Vector
    periods: float
    period: float
    cubic: bool
    varies: bool
    skips: bool


@compiled
def cubic_coefficient(x: float, before: float, periods: float, vary: bool) -> float:
    """Compute the coefficient b of a cubic that reaches zero after a number of periods [rad/s].

    Args:
        x: Velocity at the start [rad/s].
        before: Velocity one period earlier [rad/s]; the cubic goes through it or, if `vary`, its
            tangent at the start does.
        periods: Number M of periods until zero, above 0.
        vary: Whether periods vary.
    """
    if vary:
        return periods * (x - before)
    u = 1.0 / periods
    return (x * (1.0 - 3.0 * u * u - 2.0 * u * u * u) - before) / (u * (1.0 + u) * (1.0 + u))


@compiled
def velocity_at(x: float, b: float, u: float, cubic: bool) -> float:
    """Compute the velocity [rad/s] at the fraction u of a motion to rest from x, coefficient b."""
    left = 1.0 - u
    if not cubic:
        return x * left
    return left * left * (x * (1.0 + 2.0 * u) + b * u)


@compiled
def turning_velocity(x: float, b: float) -> float:
    """Compute the velocity where a motion to rest from x, coefficient b, turns [rad/s]; else 0."""
    steepest = 6.0 * x + 3.0 * b
    u = b / steepest if steepest != 0.0 else 0.0
    return velocity_at(x, b, u, True) if 0.0 < u < 1.0 else 0.0


@compiled
def displacement_after(motion: Motion, x: float, b: float, count: float) -> float:
    """Compute the displacement over the first `count` periods of a motion to rest [rad].

    `motion` states number and length of the periods and the kind of curve; x and b [rad/s] are a
    joint's first velocity and coefficient, or in [m/s] those of a point, for a displacement in [m].
    """
    M = max(motion.periods, 1.0)
    dt = motion.period
    first = 0.5 * count * (count - 1.0) / M
    if not motion.cubic:
        return dt * x * (count - first)
    second = first * (2.0 * count - 1.0) / (3.0 * M)
    third = first * first / M
    return dt * (x * (count - 3.0 * second + 2.0 * third) + b * (first - 2.0 * second + third))


@compiled
def least_displacement(motion: Motion, x: float, b: float) -> float:
    """Compute the least displacement along a motion to rest, at most 0, its value at the start.

    Arguments and unit are those of `displacement_after`.
    """
    M = motion.periods
    least = min(0.0, displacement_after(motion, x, b, M))
    turn = 2.0 * x + b
    if motion.cubic and x * turn < 0.0:
        least = min(least, displacement_after(motion, x, b, min(math.ceil(-x / turn * M), M)))
    return least


@compiled
def end_displacement(motion: Motion, x: float, b: float) -> float:
    """Compute the displacement with which a limit on a joint or a distance is tested.

    If the motion starts fast enough in the positive direction, with x >= max(b / 3 M, 0), it is the
    displacement at rest; else the least along the motion. If periods vary, a bound on their effect
    is subtracted. Arguments and unit are those of `displacement_after`.
    """
    displacement = displacement_after(motion, x, b, motion.periods)
    if x < max(b / (3.0 * motion.periods), 0.0):
        displacement = least_displacement(motion, x, b)
    if motion.skips and x > 0.0 and 2.0 * x + b < 0.0:
        displacement += least_displacement(motion, -x, -b)  # the positive part may be skipped
    return displacement - UNEVEN * motion.period * abs(b) if motion.varies else displacement
