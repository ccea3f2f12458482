"""Limits of the joints: position, velocity, acceleration and jerk, kept by one part of a program.

A scheme has them as `JointLimits`, `AccelerationLimits` and `JerkLimits`. `merged` makes one
`MotionLimits` of all, whose block of constants (`MotionConstants`, `motion_constants`) is the one
place of their numbers: bounds, fallback programs, stopping motions and requests read it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import LimitKind
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Limit, Task
from iiwa_dnn.schemes.periods import Periods, constant_periods
from iiwa_dnn.schemes.profiles import Rates, usable_jerk
from iiwa_dnn.schemes.program import ProgramArrays, block_constants
from iiwa_dnn.schemes.rest import SLACK, Motion, end_displacement, turning_velocity, velocity_at
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.schemes.tasks import JointCouplingTask
from iiwa_dnn.schemes.viability import joint_bounds


class MotionConstants(Record):
    """Constants of `MotionLimits` for n joints, as its kernels read them.

    `dt`, `hold`, `longest` and `fraction` are those of the step's `Periods`; all four are 0 where
    periods are constant.

    Attributes:
        gain: kappa of `JointLimits` [1/s]; 0: the scheme has none.
        rated: Whether accelerations or jerks are limited.
        cubic: Whether the jerk of a joint is limited.
        dt: Period by which a change of the command is divided for its acceleration [s].
        hold: Longest time for which the command may be held [s].
        longest: Longest period of a later step [s].
        fraction: Factor for distances to position limits.
        lower: Lower position limits [rad], (n,).
        upper: Upper position limits [rad], (n,).
        velocity: Largest velocities [rad/s], (n,); inf for none, as for all others.
        acceleration: Largest accelerations [rad/s^2], (n,).
        jerk: Largest jerks [rad/s^3], (n,).
        offset: Offsets o of the position-dependent velocity limits [rad/s], (n,).
        slope: Decelerations D of these limits [rad/s^2], (n,).
    """

    gain: float
    rated: bool
    cubic: bool
    dt: float
    hold: float
    longest: float
    fraction: float
    lower: Vector = part()
    upper: Vector = part()
    velocity: Vector = part()
    acceleration: Vector = part()
    jerk: Vector = part()
    offset: Vector = part()
    slope: Vector = part()


@compiled
def motion_constants(arrays: ProgramArrays) -> MotionConstants:
    """Return the limits of the joints in a program's constants, those of its last part, a view."""
    return MotionConstants.of(block_constants(arrays, len(arrays.table) - 1))


@compiled
def joint_rates(limits: MotionConstants, i: int) -> Rates:
    """Return the rate limits of joint i."""
    velocity = limits.velocity[i]
    accel = limits.acceleration[i]
    slope = limits.slope[i]
    if not slope < np.inf:
        return Rates(velocity, accel, limits.jerk[i], accel, np.inf, 0.0)
    offset = limits.offset[i]
    fraction = velocity / (offset + velocity) if velocity < np.inf else 1.0
    deceleration = min(accel, slope * fraction)
    return Rates(velocity, accel, limits.jerk[i], deceleration, slope, offset / slope)


@compiled
def joint_range(limits: MotionConstants, i: int) -> tuple[float, float]:
    """Return the positions between which joint i may move [rad].

    They are its position limits; with a position-dependent velocity limit, where that is zero.
    """
    lost = 0.0
    if limits.slope[i] < np.inf:
        lost = 0.5 * limits.offset[i] * (limits.offset[i] / limits.slope[i])
    return limits.lower[i] + lost, limits.upper[i] - lost


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
    """Tighten the bounds lb and ub (n,) [rad/s] to those of `JointLimits`; clip them to the rates.

    A bound of another limit that is outside of what acceleration and jerk admit is moved to the
    nearer end; they keep position and velocity limits too. Without a control period they have no
    bounds. `constants` are a `MotionConstants`. Writes lb, ub, step.lower_kind and step.upper_kind;
    G and h have no rows.
    """
    limits = MotionConstants.of(constants)
    if limits.gain > 0.0:
        _tighten_to_range(step, limits, lb, ub)
    if limits.rated and step.rate < np.inf:
        _clip_to_rates(step, limits, lb, ub)


@compiled
def _tighten_to_range(step: StepViews, limits: MotionConstants, lb: Vector, ub: Vector) -> None:
    """Tighten bounds lb and ub (n,) [rad/s] to those of `JointLimits`, and write their kinds."""
    gain = min(limits.gain, step.rate)
    for i in range(step.q.size):
        above = limits.upper[i] - step.q[i]
        below = step.q[i] - limits.lower[i]
        fastest = limits.velocity[i]
        up = min(fastest, position_dependent_speed(above, limits.offset[i], limits.slope[i]))
        down = min(fastest, position_dependent_speed(below, limits.offset[i], limits.slope[i]))
        lower = min(max(-gain * below, -down), up)
        upper = min(max(gain * above, -down), up)
        if lower > lb[i]:
            lb[i] = lower
            step.lower_kind[i] = _speed_kind(-lower, down, fastest)
        if upper < ub[i]:
            ub[i] = upper
            step.upper_kind[i] = _speed_kind(upper, up, fastest)


@compiled
def _clip_to_rates(step: StepViews, limits: MotionConstants, lb: Vector, ub: Vector) -> None:
    """Clip bounds lb and ub (n,) [rad/s] to those of acceleration and jerk, and write the kinds.

    Kinds of bounds that stay are left as they are.
    """
    dt = 1.0 / step.rate
    periods = constant_periods(dt)
    if limits.dt > 0.0:
        periods = Periods(limits.dt, dt, limits.hold, limits.longest, limits.fraction, True, False)
    for i in range(step.q.size):
        first, end = joint_range(limits, i)
        above = end - step.q[i]
        below = step.q[i] - first
        rates = joint_rates(limits, i)
        if not min(rates.acceleration, rates.jerk) < np.inf:
            continue
        lower, upper, lower_kind, upper_kind = joint_bounds(
            step.last[i], step.before[i], above, below, rates, periods
        )
        # Outside of the range other limits may ask for a return that ends far within it.
        least = min(max(lower if below < 0.0 else lb[i], lower), upper)
        most = min(max(upper if above < 0.0 else ub[i], lower), upper)
        if least != lb[i]:
            step.lower_kind[i] = upper_kind if lb[i] > upper else lower_kind
            lb[i] = least
        if most != ub[i]:
            step.upper_kind[i] = lower_kind if ub[i] < lower else upper_kind
            ub[i] = most


@compiled
def _speed_kind(bound: float, speed: float, fastest: float) -> int:
    """Tell which limit sets a joint's bound towards one side, its `LimitKind`.

    Args:
        bound: The bound [rad/s], positive towards that side: ub, or -lb.
        speed: Velocity limit towards that side at the joint's position [rad/s].
        fastest: Velocity limit far from the position limits [rad/s].
    """
    if bound < speed:
        return LimitKind.POSITION
    return LimitKind.POSITION_DEPENDENT_VELOCITY if speed < fastest else LimitKind.VELOCITY


@compiled
def position_dependent_speed(distance: float, offset: float, deceleration: float) -> float:
    """Compute a joint's velocity limit [rad/s] at a distance from its position limit.

    Args:
        distance: The distance d [rad].
        offset: Offset o [rad/s].
        deceleration: Deceleration D [rad/s^2]; inf for a joint without such a limit.

    Returns:
        sqrt(2 D d) - o, at least 0; inf for a joint without such a limit.
    """
    if not deceleration < np.inf:
        return np.inf
    return max(math.sqrt(2.0 * deceleration * max(distance, 0.0)) - offset, 0.0)


@compiled
def keeps_joint_limits(step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Test whether the joints keep position and velocity limits on a motion to rest.

    A joint outside its position limits must not move further out. `constants` are a
    `MotionConstants`; without limits of rates the rows of the step suffice.
    """
    q = step.q
    limits = MotionConstants.of(constants)
    if not limits.rated:
        return True
    for i in range(q.size):
        x = motion.first[i]
        b = motion.coefficient[i]
        top = q[i] - min(end_displacement(motion, -x, -b), 0.0)
        bottom = q[i] + min(end_displacement(motion, x, b), 0.0)
        lower, upper = joint_range(limits, i)
        if top > max(upper, q[i]) or bottom < min(lower, q[i]):
            return False
        if abs(turning_velocity(x, b)) > limits.velocity[i] * (1.0 + SLACK):
            return False
        if limits.offset[i] > 0.0 and not keeps_varying_limit(motion, q, limits, i):
            return False
    return True


@compiled
def keeps_varying_limit(motion: Motion, q: Vector, limits: MotionConstants, i: int) -> bool:
    """Test whether joint i keeps its position-dependent velocity limit on a motion to rest.

    The joints are at q (n,) [rad].
    """
    at = q[i]
    dt = motion.period
    lower, upper = joint_range(limits, i)
    rates = joint_rates(limits, i)
    for k in range(int(motion.periods)):
        x = velocity_at(motion.first[i], motion.coefficient[i], k / motion.periods, motion.cubic)
        left = upper - at if x > 0.0 else at - lower
        if motion.varies:  # the velocity may be held for one period more
            left -= dt * abs(x)
        needed = x * x / (2.0 * rates.slope) + abs(x) * rates.lag
        if needed > max(left, 0.0) * (1.0 + SLACK):
            return False
        at += dt * x
    return True


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

    kernel = staticmethod(motion_limits)
    rows_suffice = True
    _checks: ClassVar[checks.Checks] = {"gain": checks.positive}
    gain: float = 20.0


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

    kernel = staticmethod(motion_limits)
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
    the task yields (`iiwa_dnn.step.policies`); the bounds never do.

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


@dataclass(frozen=True)
class MotionLimits(Limit):
    """All limits of the joints of a scheme, as one part of its program.

    Attributes:
        limits: The scheme's `AccelerationLimits` and `JerkLimits`; of several, the tightest holds.
        couplings: The scheme's hard `JointCouplingTask`. The rates of a joint are lowered to those
            at which the other joints of its relation can follow.
        gain: kappa of the scheme's `JointLimits` [1/s], the least of several; 0: it has none.
    """

    kernel = staticmethod(motion_limits)
    rest_kernel = staticmethod(keeps_joint_limits)
    rows_suffice = True
    limits: tuple[RateLimits, ...] = ()
    couplings: tuple[JointCouplingTask, ...] = ()
    gain: float = 0.0

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
        offset, slope = robot.position_dependent_velocity
        head = [self.gain, bool(self.limits), (rates[2] < np.inf).any(), *[0.0] * 4]
        limits = MotionConstants.of(np.concatenate([head, lower, upper, *rates, offset, slope]))
        check_ranges(limits, np.inf)
        return limits


def check_ranges(limits: MotionConstants, rate: float) -> None:
    """Raise InvalidInputError if a joint's range is too short to reverse in.

    Args:
        limits: The limits of the joints.
        rate: Control rate, 1 / dt [1/s]; inf if braking may use the jerk limits in full.
    """
    for i in np.flatnonzero(limits.jerk < np.inf).tolist():
        rates = joint_rates(limits, i)
        lower, upper = joint_range(limits, i)
        B = rates.deceleration
        lost = 0.0
        if rates.lag > 0.0:
            left = rates.slope - B
            lost = rates.lag**2 * rates.slope * B / left if left > 0.0 else math.inf
        jerk = usable_jerk(rates, 1.0 / rate)
        steepest = min(B, math.sqrt(2.0 * jerk * rates.velocity))
        if steepest**3 > jerk**2 * (upper - lower - lost):
            step = f", and more cannot be used at {1.0 / rate:g} s a step" if rate < np.inf else ""
            problem = f"joint {i + 1}: {jerk:g} rad/s^3 is too little to stop in its range{step}"
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


def is_of_joints(limit: Limit) -> bool:
    """Test whether a limit is one of those that `MotionLimits` keeps in its place."""
    return limit.kernel is motion_limits


def merged(limits: Sequence[Limit], tasks: Sequence[Task]) -> list[Limit]:
    """Merge the limits of the joints of a list into one `MotionLimits`, the last.

    Rate limits that are inf for all joints are left out. `tasks` are those of the scheme.
    """
    own = [limit for limit in limits if is_of_joints(limit)]
    rates = tuple(
        limit
        for limit in own
        if isinstance(limit, RateLimits) and (limit.limit is None or np.isfinite(limit.limit).any())
    )
    gains = [limit.gain for limit in own if isinstance(limit, JointLimits)]
    couplings = tuple(t for t in tasks if isinstance(t, JointCouplingTask) and t.weight is None)
    others = [limit for limit in limits if not is_of_joints(limit)]
    return [*others, MotionLimits(rates, couplings if rates else (), min(gains, default=0.0))]
