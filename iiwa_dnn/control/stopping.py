r"""Synchronised motions of all joints to a wanted velocity, and stopping motions after a command.

All joints reach the wanted velocity w together, in M periods, from the velocities :math:`v_0` of
the present period and :math:`v_{-1}` of the one before. With :math:`x = v - w` and
:math:`u = i / M`, in period i

.. math::

    x_i = x_0 \,(1 - u)^2 (1 + 2 u) + b\, u\,(1 - u)^2

if a jerk is limited, with b such that the curve goes through :math:`x_{-1}` too; else
:math:`x_i = x_0 (1 - u)`. The second difference of a cubic is its second derivative in the middle,
so the jerk is linear in u and largest at an end. M is the least number of periods that the limits
allow; with a jerk limit up to about an eighth more. While a motion is executed, M falls by one each
period, and the velocities stay on the same curve.

Without acceleration limits, a stopping motion is one period at the command, then rest.

A command is **stoppable** if the motion from it to rest keeps all limits of the joints, and all
distances: a pair at the distance d, with the gradient g of the distance of a link's end and the
joints' displacement :math:`\Delta q`, still has at least

.. math::  d + g \cdot \Delta q - \tfrac12 B - v_o T

by inequality (1) of docs/theory_braking.md, with the bound B on the curvature of the pair's motion,
the speed :math:`v_o` of the obstacle and the time T of the motion. Along the motion
:math:`g \cdot \Delta q` is least at rest, or where its rate changes sign. At any time the joints
have covered at most a part :math:`\lambda` of their displacements, that of the curve of
:math:`x_0`, so the curvature term is at most :math:`\lambda^2 B`. If the end of a link starts away
from the other body, with :math:`x_0 \ge \max(b / 3 M, 0)`, and its whole displacement is
away too, it has covered at least :math:`\lambda^2` of that: the bound on the
distance is then least at the start or at rest.
"""

import math
from typing import NamedTuple

import numpy as np

from iiwa_dnn.checks import Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.control.fallback import Yielding
from iiwa_dnn.control.state import MotionState
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.schemes.periods import Periods
from iiwa_dnn.schemes.program import ProgramArrays, block_constants
from iiwa_dnn.schemes.rate_limits import MotionConstants
from iiwa_dnn.schemes.scene import (
    Body,
    Pair,
    contact_of,
    ends_of,
    height_of,
    place_bodies,
    scene_views,
    second_order,
)
from iiwa_dnn.schemes.step import rate_along

LONGEST = 1e6
"""Number of periods above which no motion to rest is searched for."""

GROWTH = 1.1
"""Factor between successive numbers of periods that `least_periods` tries."""

STRETCH = 1.01
"""Factor between successive numbers of periods that `stretched` tries."""

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
        cubic: Whether the velocities are cubic in time, else linear.
        varies: Whether control periods may be shorter than the longest one.
        skips: Whether a velocity may be held for no time at all.
    """

    first: Vector
    coefficient: Vector
    periods: float
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
    x: Vector, before: Vector, limits: MotionConstants, dt: float, cubic: bool, vary: bool
) -> float:
    """Compute the number of periods in which all joints can come to rest together.

    Without a jerk limit it is the least number. With one, the number is raised by a tenth and
    rounded up until every joint keeps its limits, so it may be larger than the least.

    Args:
        x: Present velocities [rad/s], (n,).
        before: Velocities one period earlier [rad/s], (n,).
        limits: Limits of the joints, of which acceleration and jerk are read.
        dt: Control period [s].
        cubic: Whether a jerk is limited.
        vary: Whether the later periods may be shorter.

    Returns:
        Number M of periods, 0 at rest; inf if it would be above `LONGEST`.
    """
    accelerations = limits.acceleration
    jerks = limits.jerk
    periods = 0.0
    for i in range(x.size):
        fewest = math.ceil(abs(x[i]) / (accelerations[i] * dt) * (1.0 - SLACK))
        periods = max(periods, fewest)
    i = 0
    while cubic and i < x.size:
        if periods > LONGEST:
            return np.inf
        jerk = jerks[i] * dt * dt
        if within_rates(x[i], before[i], periods, accelerations[i] * dt, jerk, vary):
            i += 1
        else:
            periods = max(1.0, math.ceil(GROWTH * periods))
            i = 0
    return periods


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
def displacement_after(motion: Motion, x: float, b: float, count: float, dt: float) -> float:
    """Compute the displacement over the first `count` periods of a motion to rest [rad].

    `motion` states the number of periods and the kind of curve; x and b [rad/s] are a joint's
    first velocity and coefficient, or in [m/s] those of a point, for a displacement in [m].
    """
    M = max(motion.periods, 1.0)
    first = 0.5 * count * (count - 1.0) / M
    if not motion.cubic:
        return dt * x * (count - first)
    second = first * (2.0 * count - 1.0) / (3.0 * M)
    third = first * first / M
    return dt * (x * (count - 3.0 * second + 2.0 * third) + b * (first - 2.0 * second + third))


@compiled
def least_displacement(motion: Motion, x: float, b: float, dt: float) -> float:
    """Compute the least displacement along a motion to rest, at most 0, its value at the start.

    Arguments and unit are those of `displacement_after`.
    """
    M = motion.periods
    least = min(0.0, displacement_after(motion, x, b, M, dt))
    turn = 2.0 * x + b
    if motion.cubic and x * turn < 0.0:
        least = min(least, displacement_after(motion, x, b, min(math.ceil(-x / turn * M), M), dt))
    return least


@compiled
def end_displacement(motion: Motion, x: float, b: float, dt: float) -> float:
    """Compute the displacement with which a limit on a joint or a distance is tested.

    If the motion starts fast enough in the positive direction, with x >= max(b / 3 M, 0), it is the
    displacement at rest; else the least along the motion. If periods vary, a bound on their effect
    is subtracted. Arguments and unit are those of `displacement_after`.
    """
    displacement = displacement_after(motion, x, b, motion.periods, dt)
    if x < max(b / (3.0 * motion.periods), 0.0):
        displacement = least_displacement(motion, x, b, dt)
    if motion.skips and x > 0.0 and 2.0 * x + b < 0.0:
        displacement += least_displacement(motion, -x, -b, dt)  # the positive part may be skipped
    return displacement - UNEVEN * dt * abs(b) if motion.varies else displacement


@compiled
def keeps_joint_limits(motion: Motion, q: Vector, limits: MotionConstants, dt: float) -> bool:
    """Test whether joints at q (n,) [rad] keep position and velocity limits on a motion to rest.

    A joint outside its position limits must not move further out. `dt` is the control period [s].
    """
    for i in range(q.size):
        x = motion.first[i]
        b = motion.coefficient[i]
        top = q[i] - min(end_displacement(motion, -x, -b, dt), 0.0)
        bottom = q[i] + min(end_displacement(motion, x, b, dt), 0.0)
        if top > max(limits.upper[i], q[i]) or bottom < min(limits.lower[i], q[i]):
            return False
        steepest = 6.0 * x + 3.0 * b
        u = b / steepest if steepest != 0.0 else 0.0
        fastest = limits.velocity[i] * (1.0 + SLACK)
        if 0.0 < u < 1.0 and abs(velocity_at(x, b, u, True)) > fastest:
            return False
        if limits.lag[i] > 0.0 and not keeps_varying_limit(motion, q, limits, dt, i):
            return False
    return True


@compiled
def keeps_varying_limit(
    motion: Motion, q: Vector, limits: MotionConstants, dt: float, i: int
) -> bool:
    """Test whether joint i keeps its position-dependent velocity limit on a motion to rest.

    The joints are at q (n,) [rad]; `dt` is the control period [s].
    """
    at = q[i]
    for k in range(int(motion.periods)):
        x = velocity_at(motion.first[i], motion.coefficient[i], k / motion.periods, motion.cubic)
        left = limits.upper[i] - at if x > 0.0 else at - limits.lower[i]
        if motion.varies:  # the velocity may be held for one period more
            left -= dt * abs(x)
        needed = x * x / (2.0 * limits.slope[i]) + abs(x) * limits.lag[i]
        if needed > max(left, 0.0) * (1.0 + SLACK):
            return False
        at += dt * x
    return True


@compiled
def keeps_distances(
    motion: Motion, arrays: ProgramArrays, constants: Vector, least: Vector, dt: float
) -> bool:
    """Test whether all pairs of a scene surely keep their distance on a motion to rest.

    The test is by bounds: False may be returned for a motion that would keep all of them.
    If a pair is nearer than the distance that it has to keep, or a moving obstacle may bring it
    that near while the arm brakes, the motion of the arm must not reduce its distance.

    Args:
        motion: The motion, of n joints.
        arrays: Arrays of the scheme's programs, with the kinematics at the start of the motion.
        constants: Numbers of the scene, `Scene.constants`, (k,).
        least: Distance that each watched pair of all scenes has to keep [m], (pairs,); 0 stands for
            that of the scene.
        dt: Control period [s].
    """
    n = motion.first.size
    scene = scene_views(constants, n)
    placed = np.empty((len(scene.bodies), Placement.width()))
    place_bodies(scene, arrays.placements, placed)
    M = motion.periods
    travel = np.empty(n)
    for i in range(n):
        travel[i] = displacement_after(
            motion, abs(motion.first[i]), abs(motion.coefficient[i]), M, dt
        )
    for k in range(len(scene.pairs)):
        contact = contact_of(scene, k, placed)
        pair = Pair.of(scene.pairs[k])
        left = contact.distance - Body.of(scene.bodies[pair.first]).speed * dt * M
        most = 0.0
        for i in range(n):
            most += abs(pair.radii[i]) * travel[i]
        own = least[scene.head.first + k]
        kept = own if own != 0.0 else scene.head.least
        if left - most >= kept:
            continue
        change = np.inf
        remainder = 0.5 * second_order(pair, travel)
        ends = ends_of(scene, placed, pair.second)
        for at in range(2):
            end = ends[at]
            if pair.unmoved_end == at + 1:
                continue
            x, coefficient = _along(motion, arrays.jacobian, pair, end, contact.normal)
            displacement = end_displacement(motion, x, coefficient, dt)
            change = min(change, height_of(end, contact) + min(displacement - remainder, 0.0))
        if left + change < min(kept, left):
            return False
    return True


@compiled
def _along(
    motion: Motion, jacobian: Matrix, pair: Pair, point: Vector3, normal: Vector3
) -> tuple[float, float]:
    """Compute the velocity of a point along a normal (3,), relative to the pair's first body.

    Args:
        motion: A motion of n joints to rest.
        jacobian: Joint Jacobian, `Kinematics.jacobian`, (n, 6).
        pair: The pair; the point is of its second body.
        point: Position of the point [m], (3,).
        normal: Unit normal from the first to the second body, (3,).

    Returns:
        Its first velocity and its coefficient b [m/s].
    """
    x = 0.0
    b = 0.0
    for j in range(motion.first.size):
        if pair.support[j] != 0.0:
            rate = pair.support[j] * rate_along(jacobian, j, point, normal)
            x += rate * motion.first[j]
            b += rate * motion.coefficient[j]
    return x, b


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
def stopping_time(
    arrays: ProgramArrays,
    motion_state: MotionState,
    least: Vector,
    yielding: Yielding,
    timing: Periods,
    dq: Vector,
) -> float:
    """Compute the number of control periods of the stopping motion after a command.

    Args:
        arrays: Arrays of the scheme's programs, with the kinematics at the joint positions.
        motion_state: State of the motion, with the joint positions and the last command.
        least: Distance that each watched pair has to keep [m], (pairs,).
        yielding: Limits of the joints, and the scheme's collision avoidance.
        timing: Periods of the step.
        dq: The command, held for one period before the joints stop [rad/s], (dof,).

    Returns:
        Number of periods of `timing.dt` until rest; -1.0 if the motion breaks a limit of a joint or
        a distance; 0.0 if the scheme does not avoid collisions, so that no test is needed.
    """
    if len(yielding.scenes) == 0:
        return 0.0
    limits = yielding.limits
    dt = timing.longest
    ratio = dt / timing.dt
    vary = timing.vary
    before = motion_state.last.copy()
    coefficient = np.zeros(dq.size)
    for i in range(dq.size if vary else 0):  # same acceleration, longest period
        before[i] = dq[i] - ratio * (dq[i] - before[i])
    support = limits.lower.size > 0
    periods = least_periods(dq, before, limits, dt, yielding.cubic, vary) if support else 1.0
    if periods == np.inf:
        return -1.0
    if yielding.cubic and periods > 0.0:
        write_cubic_coefficients(dq, before, periods, vary, coefficient)
    # If periods vary, the first may be the longest and the others arbitrarily short.
    fraction = timing.fraction
    motion = Motion(dq, coefficient, periods + vary, yielding.cubic, vary, fraction < 1.0)
    dt = dt / fraction
    if support and not keeps_joint_limits(motion, motion_state.q, limits, dt):
        return -1.0
    for k in range(len(yielding.scenes)):
        scene = block_constants(arrays, yielding.scenes[k])
        if not keeps_distances(motion, arrays, scene, least, dt):
            return -1.0
    return periods * ratio
