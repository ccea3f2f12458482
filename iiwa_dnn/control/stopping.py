r"""Motions to a wanted velocity on a straight line, and the way to rest that a command leaves.

From the velocities :math:`v_0` of now and :math:`v_{-1}` of the period before, all joints reach the
wanted velocity w together, in M periods. With :math:`x = v - w` and :math:`u = i / M`,

.. math::

    x_i = x_0 \,(1 - u)^2 (1 + 2 u) + b\, u\,(1 - u)^2

where a jerk is limited, with b such that :math:`x_{-1}` is on the curve too, and
:math:`x_i = x_0 (1 - u)` where it is not. The second difference of a cubic is its second derivative
in the middle, so the jerk is linear in u and largest at an end. M is the least number of periods
that the limits allow, or with a jerk limit up to about an eighth more; a motion that is gone along
keeps its M, and stays on the same curve.

Where no acceleration is limited, it is one period at the command, then rest.

A command is **stoppable** if the motion from it to rest keeps all limits of the joints, and all
distances: a pair at the distance d, with the gradient g of the distance of a link's end and the
joints' way :math:`\Delta q`, still has at least

.. math::  d + g \cdot \Delta q - \tfrac12 B - v_o T

by inequality (1) of docs/theory.md. Along the motion :math:`g \cdot \Delta q` has its least
value at rest, or where the sum of its terms changes sign. Where the joints go straight on, their
way up to any time is :math:`\lambda \Delta q` with :math:`0 \le \lambda \le 1`, and B at most
:math:`\lambda^2 B`: the difference, concave in :math:`\lambda`, is least at an end.
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled, entry
from iiwa_dnn.control.relaxed import Yielding
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import Triple
from iiwa_dnn.references.rotations import combined, dot
from iiwa_dnn.schemes.distances import (
    SECOND,
    SPEED,
    contact_of,
    ends_of,
    place_bodies,
    scene_views,
)
from iiwa_dnn.schemes.motion_bounds import second_order
from iiwa_dnn.schemes.step import rate_along

LONGEST = 1e6
"""Periods after which a motion counts as endless."""

GROWTH = 1.1
"""Factor between the numbers of periods that are tried."""

SLACK = 1e-9
"""Relative excess of a limit that is rounding."""

ROUNDING = 1e-12
"""Part of a velocity that is rounding."""


class Instant(NamedTuple):
    """Joints, kinematics and constants of one step.

    Attributes:
        q: Joint positions [rad], (dof,).
        last: Last command [rad/s], (dof,).
        before: Command before it [rad/s], (dof,).
        wanted: Velocity that was wanted at the last step [rad/s], (dof,).
        rest: Periods until the braking motion in hand rests; 0 if there is none.
        following: `ControllerState.following`, (5, dof), overwritten.
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        constants: Constants of all parts, (k,).
    """

    q: Vector
    last: Vector
    before: Vector
    wanted: Vector
    rest: float
    following: Matrix
    jacobian: Matrix
    placements: Matrix
    constants: Vector


@entry
def enter_stopping_time(address: int, instant: Instant, yielding: Yielding, x: Vector) -> float:
    """Enter `stopping_time` at an address, with velocities x (n,) [rad/s]."""
    raise NotImplementedError


class Motion(NamedTuple):
    """A motion to rest, or to a wanted velocity that is taken off.

    Attributes:
        first: Velocities at its start [rad/s], (n,).
        bend: b of the cubic [rad/s], (n,); zero for straight lines in time.
        periods: M; 0 if there is none.
        cubic: Whether the velocities are cubic in time.
    """

    first: Vector
    bend: Vector
    periods: float
    cubic: bool


@compiled
def bend_of(x: float, before: float, periods: float) -> float:
    """Compute b of the cubic through x now and x before, which ends after so many periods."""
    u = 1.0 / periods
    return (x * (1.0 - 3.0 * u * u - 2.0 * u * u * u) - before) / (u * (1.0 + u) * (1.0 + u))


@compiled
def next_velocity(x: float, before: float, periods: float, cubic: bool) -> float:
    """Compute the velocity after the first of so many periods on the way to zero [rad/s]."""
    if periods < 1.5:
        return 0.0
    u = 1.0 / periods
    if not cubic:
        return x * (1.0 - u)
    left = (1.0 - u) * (1.0 - u)
    return left * (x * (1.0 + 2.0 * u) + bend_of(x, before, periods) * u)


@compiled
def least_periods(x: Vector, before: Vector, limits: Vector, dt: float) -> float:
    """Compute the number of periods in which velocities go to zero together.

    It is the least one, or with a jerk limit one that is found from below in steps of a tenth.

    Args:
        x: Velocities of now [rad/s], (n,).
        before: Velocities of the period before [rad/s], (n,).
        limits: Constants of the acceleration and jerk limits, (6 n,).
        dt: Control period [s].

    Returns:
        M, 0 at rest; inf if no number is enough.
    """
    n = x.size
    cubic = has_jerk(limits)
    periods = 0.0
    for i in range(n):
        accel = limits[3 * n + i]
        jerk = limits[4 * n + i]
        periods = max(periods, math.ceil(abs(x[i]) / (accel * dt) * (1.0 - SLACK)))
        if cubic and (x[i] != 0.0 or before[i] != 0.0):
            periods = max(periods, 1.0, math.ceil(1.5 * abs(x[i]) / (accel * dt) - 2.0))
            if jerk < np.inf:
                periods = max(periods, math.ceil(math.sqrt(3.0 * abs(x[i]) / jerk) / dt - 2.0))
    if not cubic:
        return periods
    k = 0
    while k < n:
        if periods > LONGEST:
            return np.inf
        if within_rates(
            x[k], before[k], periods, limits[3 * n + k] * dt, limits[4 * n + k] * dt * dt
        ):
            k += 1
        else:
            periods = math.ceil(GROWTH * periods)
            k = 0
    return periods


@compiled
def has_jerk(limits: Vector) -> bool:
    """Test whether the jerk of a joint is limited, by the constants (6 n,) of the limits."""
    count = 0
    n = limits.size // 6
    for i in range(4 * n, 5 * n):
        count += limits[i] < np.inf
    return count > 0


@compiled
def within_rates(x: float, before: float, periods: float, accel: float, jerk: float) -> bool:
    """Test whether a cubic keeps its limits per period of acceleration and jerk [rad/s]."""
    if periods < 0.5:
        return True
    b = bend_of(x, before, periods)
    u = 1.0 / periods
    most = jerk * (1.0 + SLACK)
    if abs(6.0 * x + 4.0 * b) * u * u > most:
        return False
    if abs(x * (6.0 - 12.0 * u) + b * (2.0 - 6.0 * u)) * u * u > most:
        return False
    # The last one, from which the joint is at rest for good.
    if abs(x * (3.0 - 2.0 * u) + b * (1.0 - u)) * u * u > most:
        return False
    most = accel * (1.0 + SLACK)
    if abs(next_velocity(x, before, periods, True) - x) > most:
        return False
    steepest = 12.0 * x + 6.0 * b
    at = (6.0 * x + 4.0 * b) / steepest if steepest != 0.0 else 0.0
    if not u <= at < 1.0:
        return True
    return abs(-6.0 * x * at * (1.0 - at) + b * (1.0 - at) * (1.0 - 3.0 * at)) * u <= most


@compiled
def sums(motion: Motion, count: float) -> tuple[float, float]:
    """Sum the factors of the first velocities and of b over the first `count` periods."""
    M = motion.periods
    if M == 0.0:
        return 0.0, 0.0
    first = 0.5 * count * (count - 1.0)
    if not motion.cubic:
        return count - first / M, 0.0
    second = first * (2.0 * count - 1.0) / 3.0
    third = first * first
    of_first = count - 3.0 * second / (M * M) + 2.0 * third / (M * M * M)
    of_bend = first / M - 2.0 * second / (M * M) + third / (M * M * M)
    return of_first, of_bend


@compiled
def extremes(motion: Motion, x: float, b: float, dt: float) -> tuple[float, float]:
    """Compute the least and the largest way along a motion, of its cubic with x and b.

    At its start the way is zero; dt is the control period [s].
    """
    M = motion.periods
    of_first, of_bend = sums(motion, M)
    way = dt * (x * of_first + b * of_bend)
    least = min(0.0, way)
    largest = max(0.0, way)
    turn = 2.0 * x + b
    if motion.cubic and x * turn < 0.0:
        count = min(math.ceil(-x / turn * M), M)
        of_first, of_bend = sums(motion, count)
        way = dt * (x * of_first + b * of_bend)
        least = min(least, way)
        largest = max(largest, way)
    return least, largest


@compiled
def motion_to_rest(dq: Vector, last: Vector, bend: Vector, limits: Vector, dt: float) -> Motion:
    """Compute the motion to rest from a command dq (n,) after the last one (n,) [rad/s].

    Its `bend` (n,) [rad/s] is overwritten. The limits are those of `least_periods`, dt is the
    control period [s].
    """
    for i in range(dq.size):
        bend[i] = 0.0
    if limits.size == 0:
        return Motion(dq, bend, 1.0, False)
    periods = least_periods(dq, last, limits, dt)
    cubic = has_jerk(limits)
    if not periods < np.inf:
        return Motion(dq, bend, -1.0, cubic)
    if cubic and periods > 0.0:
        for i in range(dq.size):
            bend[i] = bend_of(dq[i], last[i], periods)
    return Motion(dq, bend, periods, cubic)


@compiled
def is_straight(motion: Motion) -> bool:
    """Test whether the joints go straight on to where they rest.

    Their velocities keep direction and sign where b is c times the first one with c >= -3.
    """
    along = 0.0
    square = 0.0
    for i in range(motion.first.size):
        along += motion.bend[i] * motion.first[i]
        square += motion.first[i] * motion.first[i]
    if square == 0.0:
        return False
    factor = along / square
    lacking = 0.0
    largest = 0.0
    for i in range(motion.first.size):
        lacking = max(lacking, abs(motion.bend[i] - factor * motion.first[i]))
        largest = max(largest, abs(motion.first[i]))
    return factor >= -3.0 and lacking <= ROUNDING * largest


@compiled
def keeps_joint_limits(motion: Motion, q: Vector, limits: Vector, dt: float) -> bool:
    """Test whether joints at q (n,) [rad] keep position and velocity limits on a motion to rest."""
    n = q.size
    for i in range(n):
        x = motion.first[i]
        b = motion.bend[i]
        least, largest = extremes(motion, x, b, dt)
        # A joint that is outside already may come back.
        if q[i] + largest > max(limits[n + i], q[i]) or q[i] + least < min(limits[i], q[i]):
            return False
        steepest = 6.0 * x + 3.0 * b
        u = b / steepest if steepest != 0.0 else 0.0
        if 0.0 < u < 1.0:
            peak = (1.0 - u) * (1.0 - u) * (x * (1.0 + 2.0 * u) + b * u)
            if abs(peak) > limits[2 * n + i] * (1.0 + SLACK):
                return False
        if limits[5 * n + i] < limits[3 * n + i] and not keeps_ramp(motion, q, limits, dt, i):
            return False
    return True


@compiled
def keeps_ramp(motion: Motion, q: Vector, limits: Vector, dt: float, i: int) -> bool:
    """Test whether joint i of those at q (n,) [rad] has room to brake all along a motion to rest.

    Its velocity limit shrinks towards its position limits: elsewhere it may brake harder than its
    deceleration, there not later.
    """
    n = q.size
    at = q[i]
    before = motion.first[i]
    x = before
    for k in range(int(motion.periods)):
        left = limits[n + i] - at if x > 0.0 else at - limits[i]
        if x * x > 2.0 * limits[5 * n + i] * max(left, 0.0) * (1.0 + SLACK):
            return False
        at += dt * x
        u = (k + 1.0) / motion.periods
        x = before * (1.0 - u)
        if motion.cubic:
            x = (1.0 - u) * (1.0 - u) * (before * (1.0 + 2.0 * u) + motion.bend[i] * u)
    return True


@compiled
def keeps_distances(motion: Motion, instant: Instant, constants: Vector, dt: float) -> bool:
    """Test whether all pairs of a scene keep their distance on a motion to rest.

    A pair that is too near, or that a moving obstacle comes too near while the arm brakes, must not
    come nearer by the arm's own motion.

    Args:
        motion: The motion.
        instant: Where it begins.
        constants: `Scene.constants`, (k,).
        dt: Control period [s].
    """
    n = motion.first.size
    scene = scene_views(constants, n)
    placed = np.empty((len(scene.bodies), 12))
    place_bodies(scene, instant.placements, placed)
    straight = is_straight(motion)
    of_first, of_bend = sums(motion, motion.periods)
    travel = np.empty(n)
    for i in range(n):
        travel[i] = dt * (abs(motion.first[i]) * of_first + abs(motion.bend[i]) * of_bend)
    rates = np.empty(n)
    for k in range(len(scene.pairs)):
        contact = contact_of(scene, k, placed)
        left = contact.distance - scene.pairs[k, SPEED] * dt * motion.periods
        way = 0.0
        for i in range(n):
            way += abs(scene.radii[k, i]) * travel[i]
        if left - way >= scene.least:
            continue
        normal = contact.normal
        change = np.inf
        lacking = 0.5 * second_order(scene.moves, scene.radii, k, travel)
        a, b = ends_of(scene, placed, int(scene.pairs[k, SECOND]))
        for end in (a, b):
            _write_rates(instant.jacobian, scene.moves, k, end, normal, rates)
            # No end is below the nearest point, but rounding would hold an arm that is too near.
            height = max(0.0, dot(combined(1.0, end, -1.0, contact.second), normal))
            change = min(change, height + _least_rise(motion, rates, dt, lacking, straight))
        if left + change < min(scene.least, left):
            return False
    return True


@compiled
def _write_rates(
    jacobian: Matrix, moves: Matrix, k: int, point: Triple, normal: Triple, rates: Vector
) -> None:
    """Write at which rate each joint (n,) moves a point of pair k's second body along a normal."""
    for j in range(rates.size):
        rates[j] = 0.0
        if moves[k, j] != 0.0:
            rates[j] = moves[k, j] * rate_along(jacobian, j, point, normal)


@compiled
def _least_rise(motion: Motion, rates: Vector, dt: float, lacking: float, straight: bool) -> float:
    """Bound the way of a point on a motion to rest from below.

    Args:
        motion: The motion.
        rates: Rate of the point for each joint, (n,) [m/rad].
        dt: Control period [s].
        lacking: Bound on what the whole way lacks to be linear in the joints' [m].
        straight: `is_straight` of the motion.
    """
    x = 0.0
    b = 0.0
    for j in range(rates.size):
        x += rates[j] * motion.first[j]
        b += rates[j] * motion.bend[j]
    if straight:
        of_first, of_bend = sums(motion, motion.periods)
        return min(0.0, dt * (x * of_first + b * of_bend) - lacking)
    least, _ = extremes(motion, x, b, dt)
    return least - lacking


@compiled
def stopping_time(instant: Instant, yielding: Yielding, dq: Vector) -> float:
    """Compute the periods of the motion to rest from a command dq (dof,) [rad/s].

    It is -1 if the motion breaks a limit, or brings a pair too near.
    """
    dt = yielding.dt
    bend = np.empty(dq.size)
    motion = motion_to_rest(dq, instant.last, bend, yielding.limits, dt)
    if motion.periods < 0.0:
        return -1.0
    if yielding.limits.size and not keeps_joint_limits(motion, instant.q, yielding.limits, dt):
        return -1.0
    scenes = yielding.scenes
    for k in range(len(scenes)):
        scene = instant.constants[scenes[k, 0] : scenes[k, 1]]
        if not keeps_distances(motion, instant, scene, dt):
            return -1.0
    return motion.periods
