r"""Limits of the joints: bounds on their velocities that every command keeps.

With acceleration or jerk limits, a bound comes from the last commands and a stopping path.

A command v_k moves a joint to q_{k+1} = q_k + dt v_k, with acceleration a_k = (v_k - v_{k-1}) / dt
and jerk (a_k - a_{k-1}) / dt. The bounds of v_k hold the commands after which the joint can still
come to rest within all of its limits, one step after the other, so that a next command exists
whenever one did: they are never empty.

**Velocity.** After a_k > 0 the velocity grows on, by a_k - J dt, a_k - 2 J dt, ... times dt, until
the acceleration is gone; v_k has to leave a margin for that sum (`approach`). With the acceleration
limit alone, the same sum is the stopping distance of a joint, and leaves the distance to the
position limit: the exact discrete viability kernel.

**Position, with a jerk limit.** The positions are the control points of a cubic B-spline whose
third derivative is the jerk, constant in each step:

.. math::

    \tilde q_k = q_k + \tfrac16 dt^2 a_k, \qquad \tilde v_k = \tfrac12 (v_k + v_{k-1})

It comes to rest at :math:`\tilde q_k + \Delta(\tilde v_k, a_k)` where the jerk is -J, the
acceleration held at -A', and the jerk J (`stopping_distance`; mirrored where the joint is about to
turn round), and its highest point on the way there, `highest`, grows with v_k: the upper bound is
its root. In one step of the true limits that point can always be kept, since -J over a whole step
brakes no less: for that, A' = A - J' dt leaves a margin for one step of jerk, and J' is at most
A / (8 dt) and dq_max / (8 dt^2). Samples are above that path by `MARGIN` at most, which is kept
free at either end. A joint needs a range to turn round in, with J' too (`check_ranges`).

**Periods that vary** up to T (`Periods`): a velocity that may be held for h is within the distance
d of a limit if :math:`v h + v^2 / (2 A) \le d`, and with a jerk limit if h v and the continuous
stopping path after it are. That is kept whatever period comes next (docs/theory_limits.md).

**Position-dependent velocity limits** (`Robot.position_dependent_velocity`) are zero at :math:`o^2
/ (2 D)` before a position limit. At the distance x from there one admits v if :math:`v^2 / (2 D) +
v\,o / D \le x`, the same law with o / D in place of h. With a jerk limit a stopping path at a
deceleration B < D that ends :math:`(o / D)^2 B D / (2 (D - B))` before that point is below the
limit all along; of several B the one that admits most counts, as a joint may go on with its own.

Sources: A. Del Prete, "Joint position and velocity bounds in discrete-time acceleration/torque
control of robot arms", IEEE Robotics and Automation Letters 3(1), 2018, for the second order. The
third order is derived in docs/theory_limits.md.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import combined, dot, scaled, triple
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.schemes.parts import Limit, Task
from iiwa_dnn.schemes.step import StepViews, point_rate, rate_along
from iiwa_dnn.schemes.tasks import JointCouplingTask

NEGLIGIBLE = 1e-6
"""Contribution of a joint to the speed that is rounding, as of one whose axis meets the tip [m]."""

MARGIN = 0.2
"""Margin that is kept free at a position limit, in units of J' dt^3; 1 / sqrt(27) is needed."""

ROUNDING = 2e-14
"""Rounding of positions while a joint brakes at constant deceleration [rad]."""

AT_REST = 1e-100
"""Velocity that counts as none [rad/s]: a smaller one may vanish in units of a step of jerk."""

EASE = 0.5
"""Fraction of the distance to a position limit that a joint all but at rest may cover in a
period."""

REST = 0.25
"""Offset of the rest position of a joint at a limit, in units of J' dt^3, slightly above
`MARGIN`."""

JERK_PERIODS = 8.0
"""Least number of periods of jerk in which braking reaches its full deceleration."""

HALVINGS = 20
"""Bisection steps for a command that ends at a position limit."""

LEVELS = 15
"""Decelerations that are tried below a position-dependent velocity limit."""

LOWER = 0.7
"""Ratio of each of them to the one before."""

SLACK = 1e-9
"""Relative excess of a period that is rounding."""


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


class MotionConstants(Record):
    """Limits of n joints on their motion, as `MotionLimits` gives them.

    The first numbers are those of `Periods` that a step states; they are 0 where periods are
    constant.

    Attributes:
        dt: Period over which changes of the command are measured [s].
        hold: Longest time for which the command may be held [s].
        longest: Longest period that may come [s].
        fraction: Part of a distance that is gone in the stated periods at least.
        lower: Lower position limits [rad], (n,): at one below which a position-dependent velocity
            limit is zero, that position.
        upper: Upper position limits [rad], (n,).
        velocity: As in `Rates`, and so the others, (n,).
    """

    dt: float
    hold: float
    longest: float
    fraction: float
    lower: Vector = part()
    upper: Vector = part()
    velocity: Vector = part()
    acceleration: Vector = part()
    jerk: Vector = part()
    deceleration: Vector = part()
    slope: Vector = part()
    lag: Vector = part()


class PositionConstants(Record):
    """Constants of `JointLimits` for n joints.

    Attributes:
        gain: kappa [1/s].
        lower: Lower position limits [rad], (n,).
        upper: Upper position limits [rad], (n,).
        velocity: Velocity limits [rad/s], (n,).
        offset: Offsets of the position-dependent velocity limits [rad/s], (n,).
        slope: Decelerations along them [rad/s^2], (n,); inf for none.
    """

    gain: float
    lower: Vector = part()
    upper: Vector = part()
    velocity: Vector = part()
    offset: Vector = part()
    slope: Vector = part()


class TipSpeedConstants(Record):
    """Constants of `TipSpeedLimit`: index of the frame, limit [m/s] and gain [1/s]."""

    frame: int
    limit: float
    gain: float


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


@compiled
def joint_limits(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds to those of `JointLimits`, whose constants these are."""
    dof = step.q.size
    limits = PositionConstants.of(constants)
    gain = min(limits.gain, step.rate)
    for i in range(dof):
        above = limits.upper[i] - step.q[i]
        below = step.q[i] - limits.lower[i]
        fastest = limits.velocity[i]
        up = min(fastest, position_dependent_speed(above, limits.offset[i], limits.slope[i]))
        down = min(fastest, position_dependent_speed(below, limits.offset[i], limits.slope[i]))
        lower = min(max(-gain * below, -down), up)
        upper = min(max(gain * above, -down), up)
        step.lower_kind[i] = _speed_kind(-lower, down, fastest)
        step.upper_kind[i] = _speed_kind(upper, up, fastest)
        lb[i] = max(lb[i], lower)
        ub[i] = min(ub[i], upper)


@compiled
def _speed_kind(bound: float, speed: float, fastest: float) -> int:
    """Return the kind of a bound, beside the velocity limits at the position and elsewhere."""
    if bound < speed:
        return LimitKind.POSITION
    return LimitKind.POSITION_DEPENDENT_VELOCITY if speed < fastest else LimitKind.VELOCITY


@compiled
def position_dependent_speed(distance: float, offset: float, deceleration: float) -> float:
    """Compute the position-dependent velocity limit at a distance from a position limit.

    Args:
        distance: The distance [rad].
        offset: Offset of the limit [rad/s].
        deceleration: Deceleration along the limit [rad/s^2]; inf for a joint without one.
    """
    if not deceleration < np.inf:
        return np.inf
    return max(math.sqrt(2.0 * deceleration * max(distance, 0.0)) - offset, 0.0)


@dataclass(frozen=True, kw_only=True)
class JointLimits(Limit):
    r"""Joint velocity bounds that keep the joint positions inside their limits.

    .. math::

        lb = \max(-\dot q_{max},\; \kappa\,(q_{lower} - q)), \qquad
        ub = \min(\dot q_{max},\; \kappa\,(q_{upper} - q))

    A joint may approach its limit no faster than exponentially with rate :math:`\kappa`, so in
    steps of dt it never passes it as long as :math:`\kappa\,dt \le 1`; a larger :math:`\kappa` is
    cut to 1 / dt. Outside a limit the formula can ask for more than the velocity limit allows and
    then has lb > ub: both bounds are clipped to the velocity limit, so that the arm comes back as
    fast as it may. Where the robot has such limits (`Robot.position_dependent_velocity`), as a
    Franka arm has, its velocity limit shrinks to :math:`\sqrt{2 D d} - o` at a distance d from the
    position limit.

    Source: equation (6) of the paper; the position-dependent limits are
    `getUpperJointVelocityLimits` in src/joint_velocity_limits.cpp of libfranka.

    Attributes:
        gain: The paper's kappa [1/s], above 0.
    """

    kernel = staticmethod(joint_limits)
    _checks: ClassVar[checks.Checks] = {"gain": checks.positive}
    gain: float = 20.0

    def constants(self, robot: Robot) -> Vector:
        """Return gain, position and velocity limits, and position-dependent ones, (1 + 5 n,)."""
        return np.concatenate(
            [[self.gain], robot.limits[:3].ravel(), robot.position_dependent_velocity.ravel()]
        )


def positive_rates(argument: str, value: ArrayLike) -> float | tuple[float, ...]:
    """Return one number above 0, or several as a tuple; refuse any other value but inf."""
    given = np.ravel(value).tolist()
    rates = [rate if rate == np.inf else checks.positive(argument, rate) for rate in given]
    return tuple(rates) if np.ndim(value) else rates[0]


@dataclass(frozen=True)
class RateLimits(Limit):
    """A limit of each joint on a derivative of its velocity.

    Attributes:
        limit: The limit, one number or one a joint, above 0; None takes the robot's, inf states
            that there is none.
    """

    _checks: ClassVar[checks.Checks] = {"limit": positive_rates}
    limit: ArrayLike | None = None
    quantity: ClassVar[str]
    row: ClassVar[int]

    def of(self, robot: Robot) -> Vector:
        """Return the limit of each joint, (n,).

        Raises:
            InvalidInputError: It is not one number or n, not above 0, or None and the robot has
                none.
        """
        given: dict[str, Any] = {self.quantity: self.limit}
        values: Vector = robot.with_limits(**given).limits[self.row]
        if self.limit is None and np.isinf(values).all():
            problem = f"is needed: robot {robot.name} has no limit of its own"
            raise InvalidInputError(self.quantity, problem)
        return values


@dataclass(frozen=True)
class AccelerationLimits(RateLimits):
    """Bounds on the change of the joint velocities from one command to the next.

    A joint can always stop before its position limit. Where a row of a task or another limit
    conflicts with the bounds, the task yields (`iiwa_dnn.control.policies`), the bounds never do.

    Attributes:
        limit: Largest acceleration [rad/s^2], one number or (n,); None takes `Robot.ddq_max`, inf
            states that it is not limited.
    """

    quantity = "acceleration"
    row = 3


@dataclass(frozen=True)
class JerkLimits(RateLimits):
    """Bounds on the change of the joint accelerations from one command to the next.

    Attributes:
        limit: Largest jerk [rad/s^3], one number or (n,); None takes `Robot.dddq_max`, inf states
            that it is not limited.
    """

    quantity = "jerk"
    row = 4


def own_rate_limits(robot: Robot) -> tuple[RateLimits, ...]:
    """Return the robot's acceleration and jerk limits, the default where none are given.

    They are those of `Shield` and of ``iiwa-dnn track``.
    """
    return tuple(
        limit
        for limit in (AccelerationLimits(), JerkLimits())
        if np.isfinite(robot.limits[limit.row]).any()
    )


@compiled
def joint_rates(limits: MotionConstants, i: int) -> Rates:
    """Return the rates of joint i."""
    return Rates(
        limits.velocity[i],
        limits.acceleration[i],
        limits.jerk[i],
        limits.deceleration[i],
        limits.slope[i],
        limits.lag[i],
    )


@compiled
def state_periods(limits: MotionConstants, periods: Periods) -> None:
    """Write the periods of a step among the constants of `MotionLimits`."""
    limits.dt = periods.dt
    limits.hold = periods.hold
    limits.longest = periods.longest
    limits.fraction = periods.fraction


@compiled
def motion_limits(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Clip the bounds of the joints to those of `MotionLimits`, whose constants these are.

    Bounds of other limits give way where they contradict: the position and velocity limits are
    kept by these bounds too. Without a control period there are none.
    """
    if not step.rate < np.inf:
        return
    limits = MotionConstants.of(constants)
    dt = 1.0 / step.rate
    periods = constant_periods(dt)
    if limits.dt > 0.0:
        periods = Periods(limits.dt, dt, limits.hold, limits.longest, limits.fraction, True, False)
    for i in range(step.q.size):
        above = limits.upper[i] - step.q[i]
        below = step.q[i] - limits.lower[i]
        rates = joint_rates(limits, i)
        lower, upper, lower_kind, upper_kind = joint_bounds(
            step.last[i], step.before[i], above, below, rates, periods
        )
        step.lower_kind[i] = upper_kind if lb[i] > upper else lower_kind
        step.upper_kind[i] = lower_kind if ub[i] < lower else upper_kind
        lb[i] = min(max(lb[i], lower), upper)
        ub[i] = min(max(ub[i], lower), upper)


@dataclass(frozen=True)
class MotionLimits(Limit):
    """All acceleration and jerk limits of a scheme, as the one block that is compiled.

    Attributes:
        limits: The scheme's `AccelerationLimits` and `JerkLimits`; the tightest of each counts.
        couplings: Its tasks that hold joints together. A joint is no quicker than the others of
            its relation let it be: else one could brake where another cannot follow.
    """

    kernel = staticmethod(motion_limits)
    limits: tuple[RateLimits, ...] = ()
    couplings: tuple[JointCouplingTask, ...] = ()

    def constants(self, robot: Robot) -> MotionConstants:
        """Return `MotionConstants`, whose stated periods are 0.

        Raises:
            InvalidInputError: A limit does not fit the robot, or a joint's range is too short to
                turn round in.
        """
        rates = np.full((3, robot.dof), np.inf)
        lower, upper, rates[0] = robot.limits[:3]
        for limit in self.limits:
            row = rates[limit.row - 2]
            np.minimum(row, limit.of(robot), out=row)
        for coupling in self.couplings * len(self.couplings):  # of chains too
            (relation,) = coupling.relations(robot)
            fractions = np.abs(relation.coefficients)
            joints = np.flatnonzero(fractions)
            for i in joints:
                others = joints[joints != i]
                rates[:, i] = np.minimum(
                    rates[:, i], rates[:, others] @ fractions[others] / fractions[i]
                )
        offset, steepness = robot.position_dependent_velocity
        with np.errstate(invalid="ignore"):  # a joint without a velocity limit
            fraction = np.where(np.isinf(rates[0]), 1.0, rates[0] / (offset + rates[0]))
        braking = np.minimum(rates[1], steepness * fraction)
        lag = offset / steepness
        distance = 0.5 * offset * lag
        stated = [np.zeros(4), lower + distance, upper - distance]
        numbers = np.concatenate([*stated, *rates, braking, steepness, lag])
        limits = MotionConstants.of(numbers)
        check_ranges(limits, np.inf)
        return limits


def check_ranges(limits: MotionConstants, rate: float) -> None:
    """Raise InvalidInputError if a joint's range is too short to reverse in.

    Args:
        limits: The limits of the joints.
        rate: Control periods a second [1/s]; inf for a jerk limit that braking may use in full.
    """
    lag = limits.lag
    braking = limits.deceleration
    with np.errstate(invalid="ignore"):  # a joint without a position-dependent velocity limit
        lost = np.where(lag > 0.0, lag**2 * limits.slope * braking / (limits.slope - braking), 0.0)
        rates = [joint_rates(limits, i) for i in range(lag.size)]
        usable = np.array([usable_jerk(own, 1.0 / rate) for own in rates])
    steepest = np.minimum(braking, np.sqrt(2.0 * usable * limits.velocity))
    distance = limits.upper - limits.lower - lost
    short = (limits.jerk < np.inf) & (steepest**3 > usable**2 * distance)
    if short.any():
        i = int(np.flatnonzero(short)[0])
        step = f", and more cannot be used at {1.0 / rate:g} s a step" if rate < np.inf else ""
        problem = f"joint {i + 1}: {usable[i]:g} rad/s^3 is too little to stop in its range{step}"
        raise InvalidInputError("jerk", problem, limits.jerk)


def largest_gain(limits: MotionConstants, rate: float) -> float:
    """Compute the feedback gain up to which a loop with these limits is stable [1/s].

    It is one over the loop's delay: a period, and the mean time that an acceleration takes to turn
    from one limit to the other (docs/limits.md).

    Args:
        limits: The limits of the joints.
        rate: Control periods a second [1/s].
    """
    with np.errstate(invalid="ignore"):  # a joint without limits
        turn = np.sqrt(limits.velocity / limits.jerk)
        delay = np.fmin(limits.acceleration / limits.jerk, turn)
    return float(1.0 / (delay.max() + 1.0 / rate))


def merged(limits: Sequence[Limit], tasks: Sequence[Task]) -> list[Limit]:
    """Merge the limits on acceleration and jerk into one block, the last.

    Of the tasks those count that hold joints together.
    """
    rates = tuple(
        limit
        for limit in limits
        if isinstance(limit, RateLimits) and (limit.limit is None or np.isfinite(limit.limit).any())
    )
    others = [limit for limit in limits if not isinstance(limit, RateLimits)]
    couplings = tuple(t for t in tasks if isinstance(t, JointCouplingTask) and t.weight is None)
    return [*others, MotionLimits(rates, couplings)] if rates else others


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
        eased = max(min(upper, max(_easing(above - rest, periods.hold), lb)), lower)
        lower = min(max(lower, min(-_easing(below - rest, periods.hold), ub)), eased)
        upper = eased
    lower_kind = _rate_kind(lb, down, slowest, LimitKind.JERK)
    upper_kind = _rate_kind(ub, up, quickest, LimitKind.JERK)
    if lower != lb:
        lower_kind = _position_kind(rates)
    if upper != ub:
        upper_kind = _position_kind(rates)
    return lower, upper, lower_kind, upper_kind


@compiled
def _easing(distance: float, hold: float) -> float:
    """Compute the velocity [rad/s] over a distance [rad] that is left; 0 if it is rounding."""
    if abs(distance) <= ROUNDING:
        return 0.0
    return EASE * distance / hold


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
    eased = _easing(left, periods.hold)
    turn = max(abs(eased - 2.0 * last + before), abs((EASE + 1.0) * eased - last))
    most = min(jerk * dt * dt, accel * dt)
    if jerk < np.inf and max(turn, abs(eased)) <= most and abs(eased - last) <= accel * dt:
        return eased
    return wanted


@compiled
def braking(last: float, lb: float, ub: float, jerk: float, periods: Periods) -> float:
    """Compute the command in [lb, ub] that comes to rest quickest, without turning round."""
    wanted = 0.0
    unit = jerk * periods.dt * periods.dt
    if jerk < np.inf and abs(last) > AT_REST:
        wanted = last - math.copysign(unit * approach(abs(last) / unit, periods.vary), last)
    return min(max(wanted, lb), ub)


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
def usable_jerk(rates: Rates, period: float) -> float:
    """Compute J' [rad/s^3], with which braking reaches a deceleration in `JERK_PERIODS` or more."""
    steepest = min(rates.deceleration / period, rates.velocity / (period * period))
    return min(rates.jerk, steepest / JERK_PERIODS)


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


@compiled
def tip_speed_bounds(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Tighten the bounds to those of `TipSpeedLimit`, whose constants these are."""
    own = TipSpeedConstants.of(constants)
    frame = own.frame
    gain = min(own.gain, step.rate)
    point = triple(Placement.of(step.placements[frame]).position)
    velocity = (0.0, 0.0, 0.0)
    for j in range(step.q.size):
        fraction = step.last[j] * step.support[frame, j]
        velocity = combined(1.0, velocity, fraction, point_rate(step.jacobian, j, point))
    speed = math.sqrt(dot(velocity, velocity))
    if not (speed > 0.0 and step.rate < np.inf):
        return
    direction = scaled(1.0 / speed, velocity)
    along = np.empty(step.q.size)
    total = 0.0
    for j in range(step.q.size):
        along[j] = step.support[frame, j] * rate_along(step.jacobian, j, point, direction)
        total += abs(along[j])
    growth = gain / step.rate * (own.limit - speed) / total
    for j in range(step.q.size):
        if along[j] > NEGLIGIBLE:
            ub[j] = max(min(ub[j], step.last[j] + growth), lb[j])
        elif along[j] < -NEGLIGIBLE:
            lb[j] = min(max(lb[j], step.last[j] - growth), ub[j])


@dataclass(frozen=True)
class TipSpeedLimit(Limit):
    r"""Joint velocity bounds that keep the speed of a frame's origin; beside acceleration limits.

    A frame that the joints move at :math:`v = J \dot q` with the last command has the speed
    :math:`s = \|v\|`, to which joint j contributes :math:`g_j \dot q_j`, :math:`g = J^T v / s`.
    Each joint may add an equal part of what is left to the limit V,

    .. math::

        \operatorname{sign}(g_j)\,(\dot q_j - \dot q_j^{last}) \;\le\;
            \gamma\,dt\,\frac{V - s}{\sum_i |g_i|},

    so that the speed along v grows by at most :math:`\gamma\,dt\,(V - s)` in a step, and shrinks by
    as much above the limit. What is left shrinks exponentially, as the distance to a position limit
    does.

    The bounds give way to those of acceleration and jerk, without which nothing ties a command to
    the last one, and to position limits. The speed may then be above V for a while: by what the
    pose adds, :math:`\dot J \dot q / \gamma`, and by what jerk takes to turn an acceleration. A
    limit of 0.9 times the robot's own covers both.

    Attributes:
        limit: Largest speed [m/s], above 0.
        frame: The frame; None takes the tip.
        gain: Rate at which the speed may come near to the limit [1/s], above 0.
    """

    kernel = staticmethod(tip_speed_bounds)
    _checks: ClassVar[checks.Checks] = {"limit": checks.positive, "gain": checks.positive}
    limit: float
    frame: str | None = None
    gain: float = 100.0

    def constants(self, robot: Robot) -> Vector:
        """Return the index of the frame, the limit [m/s] and the gain [1/s], (3,)."""
        return np.array([robot.frame_id(self.frame_name(robot)), self.limit, self.gain])
