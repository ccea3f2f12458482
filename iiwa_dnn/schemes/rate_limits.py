"""Acceleration and jerk limits of the joints, and the one part of a program that keeps them all."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Limit, Task
from iiwa_dnn.schemes.periods import Periods, constant_periods
from iiwa_dnn.schemes.profiles import Rates, usable_jerk
from iiwa_dnn.schemes.rest import SLACK, Motion, end_displacement, turning_velocity, velocity_at
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.schemes.tasks import JointCouplingTask
from iiwa_dnn.schemes.viability import joint_bounds


def positive_rates(argument: str, value: ArrayLike) -> float | tuple[float, ...]:
    """Return a number above 0 (or inf), or several as a tuple; refuse any other value."""
    given = np.ravel(value).tolist()
    rates = [rate if rate == np.inf else checks.positive(argument, rate) for rate in given]
    return tuple(rates) if np.ndim(value) else rates[0]


@dataclass(frozen=True)
class RateLimits(Limit):
    """Base of the limits on a derivative of the joint velocities.

    Attributes:
        limit: The limit, one number or one a joint, above 0; None takes the robot's, inf states
            that there is none.
        quantity: Name of the quantity, an argument of `Robot.with_limits`.
        row: Row of `Robot.limits` that has it.
    """

    rows_suffice = True
    _checks: ClassVar[checks.Checks] = {"limit": positive_rates}
    limit: ArrayLike | None = None
    quantity: ClassVar[str]
    row: ClassVar[int]

    def of(self, robot: Robot) -> Vector:
        """Return the limit of each joint, (n,).

        Raises:
            InvalidInputError: `limit` has neither one number nor n, or is None and the robot has no
                such limit.
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

    Within them a joint can always stop before its position limit. If a task conflicts with them,
    the task yields (`iiwa_dnn.control.policies`); the bounds never do.

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
    """Return the robot's acceleration and jerk limits, an empty tuple if it has none.

    `Shield` and ``iiwa-dnn track`` keep them where no rate limits are given.
    """
    return tuple(
        limit
        for limit in (AccelerationLimits(), JerkLimits())
        if np.isfinite(robot.limits[limit.row]).any()
    )


class MotionConstants(Record):
    """Constants of `MotionLimits` for n joints, as its kernel reads them.

    `dt`, `hold`, `longest` and `fraction` are those of the step's `Periods`; all four are 0 where
    periods are constant.

    Attributes:
        dt: Period by which a change of the command is divided for its acceleration [s].
        hold: Longest time for which the command may be held [s].
        longest: Longest period of a later step [s].
        fraction: Factor for distances to position limits.
        lower: Lower position limits [rad], (n,); of a joint with a position-dependent velocity
            limit, the position at which that is zero.
        upper: Upper position limits [rad], (n,), in the same way.
        velocity: Largest velocities [rad/s], (n,); inf for none, as for all others.
        acceleration: Largest accelerations [rad/s^2], (n,).
        jerk: Largest jerks [rad/s^3], (n,).
        deceleration: Decelerations with which the joints brake before position limits
            [rad/s^2], (n,).
        slope: Deceleration D of each position-dependent velocity limit [rad/s^2], (n,).
        lag: Offset o of each position-dependent velocity limit over D [s], (n,).
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


@compiled
def joint_rates(limits: MotionConstants, i: int) -> Rates:
    """Return the rate limits of joint i."""
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
    """Write the periods of a step to the first four numbers of `limits`."""
    limits.dt = periods.dt
    limits.hold = periods.hold
    limits.longest = periods.longest
    limits.fraction = periods.fraction


@compiled
def motion_limits(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Clip the bounds lb and ub (n,) [rad/s] to those of `MotionLimits`.

    A bound of another limit that is outside of them is moved to the nearer one; they keep position
    and velocity limits too. Without a control period there are no bounds. `constants` are a
    `MotionConstants`. Writes lb, ub, step.lower_kind and step.upper_kind; G and h have no rows.
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
        # Outside of the range other limits may ask for a return that ends far within it.
        if below < 0.0:
            lb[i] = lower
        if above < 0.0:
            ub[i] = upper
        lb[i] = min(max(lb[i], lower), upper)
        ub[i] = min(max(ub[i], lower), upper)


@compiled
def keeps_joint_limits(step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Test whether the joints keep position and velocity limits on a motion to rest.

    A joint outside its position limits must not move further out. `constants` are a
    `MotionConstants`.
    """
    q = step.q
    limits = MotionConstants.of(constants)
    for i in range(q.size):
        x = motion.first[i]
        b = motion.coefficient[i]
        top = q[i] - min(end_displacement(motion, -x, -b), 0.0)
        bottom = q[i] + min(end_displacement(motion, x, b), 0.0)
        if top > max(limits.upper[i], q[i]) or bottom < min(limits.lower[i], q[i]):
            return False
        if abs(turning_velocity(x, b)) > limits.velocity[i] * (1.0 + SLACK):
            return False
        if limits.lag[i] > 0.0 and not keeps_varying_limit(motion, q, limits, i):
            return False
    return True


@compiled
def keeps_varying_limit(motion: Motion, q: Vector, limits: MotionConstants, i: int) -> bool:
    """Test whether joint i keeps its position-dependent velocity limit on a motion to rest.

    The joints are at q (n,) [rad].
    """
    at = q[i]
    dt = motion.period
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


@dataclass(frozen=True)
class MotionLimits(Limit):
    """All acceleration and jerk limits of a scheme, as one part of its program.

    Attributes:
        limits: The scheme's `AccelerationLimits` and `JerkLimits`; of several, the tightest holds.
        couplings: The scheme's hard `JointCouplingTask`. The rates of a joint are lowered to those
            at which the other joints of its relation can follow.
    """

    kernel = staticmethod(motion_limits)
    rest_kernel = staticmethod(keeps_joint_limits)
    rows_suffice = True
    limits: tuple[RateLimits, ...] = ()
    couplings: tuple[JointCouplingTask, ...] = ()

    def constants(self, robot: Robot) -> MotionConstants:
        """Return the `MotionConstants` of a robot; their periods are 0.

        Raises:
            InvalidInputError: A limit does not fit the robot, or a joint's range is too short to
                reverse in.
        """
        rates = np.full((3, robot.dof), np.inf)
        lower, upper, rates[0] = robot.limits[:3]
        for limit in self.limits:
            row = rates[limit.row - 2]
            np.minimum(row, limit.of(robot), out=row)
        for coupling in self.couplings * len(self.couplings):  # of chains too
            fractions = np.abs(coupling.constants(robot).coefficients)
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
        rate: Control rate, 1 / dt [1/s]; inf if braking may use the jerk limits in full.
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
    """Compute the largest feedback gain [1/s] with which a loop within rate limits is stable.

    It is one over the loop's delay: a control period plus the mean time in which an acceleration
    changes from one limit to the other (docs/limits.md).

    Args:
        limits: The limits of the joints.
        rate: Control rate, 1 / dt [1/s].
    """
    with np.errstate(invalid="ignore"):  # a joint without limits
        turn = np.sqrt(limits.velocity / limits.jerk)
        delay = np.fmin(limits.acceleration / limits.jerk, turn)
    return float(1.0 / (delay.max() + 1.0 / rate))


def merged(limits: Sequence[Limit], tasks: Sequence[Task]) -> list[Limit]:
    """Merge the acceleration and jerk limits of a list into one `MotionLimits`, the last.

    Rate limits that are inf for all joints are left out. `tasks` are those of the scheme.
    """
    rates = tuple(
        limit
        for limit in limits
        if isinstance(limit, RateLimits) and (limit.limit is None or np.isfinite(limit.limit).any())
    )
    others = [limit for limit in limits if not isinstance(limit, RateLimits)]
    couplings = tuple(t for t in tasks if isinstance(t, JointCouplingTask) and t.weight is None)
    return [*others, MotionLimits(rates, couplings)] if rates else others
