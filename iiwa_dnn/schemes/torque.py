r"""Limit of the joints' torques for every payload in a range, at every step and until rest.

A command :math:`x_k` at positions q, after :math:`x_{k-1}`, takes the torques

.. math::  \tau = M(q)\,(x_k - x_{k-1}) / dt + h(q, x_{k-1})

of a rigid arm that goes on by :math:`q + dt\,x_k`. They are affine in the mass of the payload, so
both ends of its range suffice, and linear in :math:`x_k`: a step has a row for each joint, sign and
end. A row that no command within the acceleration limits reaches is idle.

Along a motion to rest the torques of the periods are samples of a smooth function of time,

.. math::  M(q)\,a + \sum_{jk} \Gamma_{jk}(q)\,v_j v_k + g(q).

M is a trigonometric polynomial of degree 2 in each angle after its joints, g one of degree 1, so
Bernstein's inequality bounds their derivatives by bounds on M and g, which follow from masses and
lengths; velocities are polynomials of time. Between two periods that are tested a torque exceeds
the larger of both by no more than an eighth of its second derivative times the squared time; the
interval is halved until that is enough. If a joint slides, every period is tested.
"""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import largest_entry, row_dot
from iiwa_dnn.qp.layout import copied
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.arms import WRONG_EFFORTS
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.schemes.dynamics import Dynamics, Link, dynamics_of, write_torques
from iiwa_dnn.schemes.parts import Limit
from iiwa_dnn.schemes.rest import Motion, displacement_after, velocity_at
from iiwa_dnn.schemes.step import StepViews

ROUNDING = 1e-9
"""Relative excess over a torque limit that counts as rounding."""

RESERVE = 1e-6
"""Part of a torque limit that the rows of a step leave to the tolerance of their solution."""

AT_REST = 0.01
"""Part of a torque limit that a posture at rest leaves, so that an arm can begin to leave it."""

DEPTH = 32
"""Largest number of nested halvings of an interval."""


class TorqueConstants(Record):
    """Constants of `TorqueLimits` for n joints.

    Attributes:
        lightest: Smallest mass of the payload [kg].
        heaviest: Its largest mass [kg].
        slides: Whether a joint slides.
        limit: Largest torque of each joint [N m], (n,).
        inertia: Square root of a bound on each diagonal entry of the links' inertia matrix, (n,).
        rotor: What the rotors add to them [kg m^2], (n,).
        weight: Bound on each torque of gravity [N m], (n,).
        dynamics: `Dynamics` of the robot.
    """

    lightest: float
    heaviest: float
    slides: bool
    limit: Vector = part()
    inertia: Vector = part()
    rotor: Vector = part()
    weight: Vector = part()
    dynamics: Vector = part("dynamics")


class Pace(Record):
    """Bounds on a joint's velocity and its derivatives by time [rad/s, rad/s^2, ...]."""

    speed: float
    change: float
    jerk: float
    snap: float


@compiled
def torque_rows(
    step: StepViews, constants: Vector, G: Matrix, h: Vector, lb: Vector, ub: Vector
) -> None:
    """Write G (2 n or 4 n, n) and h of `TorqueLimits`; lb and ub (n,) stay.

    Without a control period the rows are idle. `constants` are `TorqueConstants`.
    """
    n = step.q.size
    own = TorqueConstants.of(constants, n)
    h[:] = np.inf
    if not step.rate < np.inf:
        return
    arm = Dynamics.of(own.dynamics)
    inertia = np.empty((n, n))
    slopes = np.empty((n, n))
    bias = np.empty(n)
    slope = np.empty(n)
    doubt = np.empty(n)
    none = np.empty(n)  # of what a command changes: the test of its motion to rest has that
    rest = np.zeros(n)
    unit = np.zeros(n)
    write_torques(arm, 1.0, step.q, step.last, rest, bias, slope, doubt)
    for j in range(n):
        unit[j] = 1.0
        write_torques(arm, 0.0, step.q, rest, unit, inertia[j], slopes[j], none)
        unit[j] = 0.0
    for row in range(h.size):
        i = row // 2 % n
        sign = 1.0 - 2.0 * (row % 2)
        mass = own.heaviest if row < 2 * n else own.lightest
        torque = sign * (bias[i] + mass * slope[i]) + mass * doubt[i]
        most = torque
        length = 0.0
        for j in range(n):
            entry = sign * (inertia[j, i] + mass * slopes[j, i])
            G[row, j] = entry
            length += entry * entry
            most += abs(entry) * step.acceleration_limits[j]
        if most <= own.limit[i]:
            G[row, :] = 0.0
            continue
        length = math.sqrt(length)
        for j in range(n):
            G[row, j] /= length
        room = own.limit[i] * (1.0 - RESERVE) - torque
        h[row] = row_dot(G, row, step.last) + room / (step.rate * length)


@compiled
def write_loads(own: TorqueConstants, q: Vector, v: Vector, a: Vector, load: Vector) -> float:
    """Write the larger size of each torque with both ends of the payload [N m], load (n,).

    Args:
        own: The limit.
        q: Joint positions [rad], (n,).
        v: Joint velocities [rad/s], (n,).
        a: Joint accelerations [rad/s^2], (n,).
        load: The torques, (n,), overwritten.

    Returns:
        The largest ratio of a torque and its limit.
    """
    slope = np.empty(q.size)
    doubt = np.empty(q.size)
    write_torques(Dynamics.of(own.dynamics), 1.0, q, v, a, load, slope, doubt)
    largest = 0.0
    for i in range(q.size):
        lightest = abs(load[i] + own.lightest * slope[i]) + own.lightest * doubt[i]
        load[i] = max(lightest, abs(load[i] + own.heaviest * slope[i]) + own.heaviest * doubt[i])
        largest = max(largest, load[i] / own.limit[i])
    return largest


@compiled
def torque_margin(constants: Vector, q: Vector, before: Vector, last: Vector, dt: float) -> float:
    """Return the least part of a torque limit that a command leaves, with either payload.

    Args:
        constants: `TorqueConstants`, (k,).
        q: Joint positions [rad], (n,).
        before: The command before it [rad/s], (n,).
        last: The command [rad/s], (n,).
        dt: Control period [s].
    """
    a = np.empty(q.size)
    for i in range(q.size):
        a[i] = (last[i] - before[i]) / dt
    load = np.empty(q.size)
    return 1.0 - write_loads(TorqueConstants.of(constants, q.size), q, before, a, load)


@compiled
def _load_in_period(
    step: StepViews, own: TorqueConstants, motion: Motion, k: int, load: Vector
) -> float:
    """Write `write_loads` of a motion to rest as period k ends, from 1; k = 0 is its command's."""
    n = step.q.size
    q = np.empty(n)
    v = np.empty(n)
    a = np.empty(n)
    M = max(motion.periods, 1.0)
    for i in range(n):
        x = motion.first[i]
        b = motion.coefficient[i]
        q[i] = step.q[i] + displacement_after(motion, x, b, min(k, M))
        v[i] = step.last[i]
        if k > 0:
            v[i] = velocity_at(x, b, min((k - 1.0) / M, 1.0), motion.cubic)
        after = velocity_at(x, b, min(k / M, 1.0), motion.cubic)
        a[i] = step.rate * (after - v[i])
    return write_loads(own, q, v, a, load)


@compiled
def keeps_torque(step: StepViews, constants: Vector, motion: Motion) -> bool:
    """Test whether a command and its motion to rest keep all torques, rest included.

    `constants` are `TorqueConstants`.
    """
    n = step.q.size
    own = TorqueConstants.of(constants, n)
    load = np.empty(n)
    last = int(max(math.ceil(motion.periods), 0.0))
    most = 1.0 + ROUNDING
    if _load_in_period(step, own, motion, 1, load) > most:  # that is exceeded most often
        return False
    if _load_in_period(step, own, motion, 0, load) > most:
        return False
    whole = int(max(motion.periods, 1.0))  # the period after them, if any, is cut short
    for k in range(2 if own.slides else whole, last + 1):
        if _load_in_period(step, own, motion, max(k, 1), load) > most:
            return False
    resting = _load_in_period(step, own, motion, last + 1, load)
    if resting > most:
        return False
    if resting > 1.0 - AT_REST:  # the arm may rest there before, and leave it
        is_moving = max(largest_entry(step.last), largest_entry(step.before)) > 0.0
        if is_moving or resting > _load_here(step, own, load):
            return False
    return own.slides or _keeps_between(step, own, motion, whole)


@compiled
def _load_here(step: StepViews, own: TorqueConstants, load: Vector) -> float:
    """Write `write_loads` of an arm at rest where a step begins."""
    rest = np.zeros(load.size)
    return write_loads(own, step.q, rest, rest, load)


@compiled
def _keeps_between(step: StepViews, own: TorqueConstants, motion: Motion, last: int) -> bool:
    """Test the torques of a motion of joints that turn, those in periods 1 and `last` excepted."""
    n = step.q.size
    if last <= 2:
        return True
    paces = np.empty((n, Pace.width()))
    left = 1
    load = np.empty(n)
    _load_in_period(step, own, motion, left, load)
    loads = np.empty((DEPTH, n))
    ends = np.empty(DEPTH)
    count = 0
    _load_in_period(step, own, motion, last, loads[count])
    ends[count] = last
    count += 1
    while count > 0:
        right = int(ends[count - 1])
        is_below = right - left <= 1
        if not is_below:
            _write_paces(motion, 1.0 - (left - 1.0) / motion.periods, paces)
            width = (right - left) * motion.period
            is_below = _is_below(own, paces, load, loads[count - 1], width)
        if is_below:
            left = right
            copied(load, loads[count - 1])
            count -= 1
            continue
        middle = (left + right) // 2
        ends[count] = middle
        if _load_in_period(step, own, motion, middle, loads[count]) > 1.0 + ROUNDING:
            return False
        count += 1
    return True


@compiled
def _is_below(
    own: TorqueConstants, paces: Matrix, load: Vector, other: Vector, width: float
) -> bool:
    """Test whether all torques surely keep their limits between two periods.

    Args:
        own: The limit.
        paces: `Pace` of each joint from the first of the periods until rest, (n, 4).
        load: Torques in the first of the periods [N m], (n,).
        other: Torques in the second one [N m], (n,).
        width: Time between them [s].
    """
    bends = np.empty(load.size)
    _write_bends(own, paces, bends)
    for i in range(load.size):
        most = max(load[i], other[i]) + width * width / 8.0 * bends[i]
        if most > own.limit[i] * (1.0 + ROUNDING):
            return False
    return True


@compiled
def _write_bends(own: TorqueConstants, paces: Matrix, bends: Vector) -> None:
    r"""Write bounds on the second derivatives of the torques by time [N m/s^2], bends (n,).

    With :math:`\sigma` twice the sum of the speeds of the angles that M depends on, and
    :math:`\dot\sigma` of their changes, the second derivative of M a is at most :math:`|M|
    ((\sigma^2 + \dot\sigma) |a| + 2 \sigma |\dot a| + |\ddot a|)`, and so on for the velocities'
    part.

    Args:
        own: The limit.
        paces: `Pace` of each joint, (n, 4).
        bends: The bounds, overwritten.
    """
    n = bends.size
    total = Pace.of(np.zeros(Pace.width()))
    held = Pace.of(np.zeros(Pace.width()))  # each joint's, times the root of its inertia
    turns = np.zeros(n + 1)  # of the angles from each joint on
    changes = np.zeros(n + 1)
    turn = 0.0
    change = 0.0
    for k in range(n):
        at = n - 1 - k
        pace = Pace.of(paces[at])
        turn = turns[at + 1]  # in the end, of all but the first: it turns with gravity alone
        change = changes[at + 1]
        turns[at] = turns[at + 1] + 2.0 * pace.speed
        changes[at] = changes[at + 1] + 2.0 * pace.change
        total.speed += pace.speed
        total.change += pace.change
        total.jerk += pace.jerk
        held.speed += own.inertia[at] * pace.speed
        held.change += own.inertia[at] * pace.change
        held.jerk += own.inertia[at] * pace.jerk
    for i in range(n):
        inertia = own.inertia[i]
        # |Gamma_ijk| <= M_ij + M_ik + M_jk, each at most the product of two roots.
        squares = held.speed * (2.0 * inertia * total.speed + held.speed)
        slopes = inertia * (held.speed * total.change + total.speed * held.change)
        slopes += held.speed * held.change
        second = inertia * (held.speed * total.jerk + total.speed * held.jerk)
        second += held.speed * held.jerk
        second += held.change * (2.0 * inertia * total.change + held.change)
        second *= 2.0
        second += (turn * turn + change) * squares + 4.0 * turn * slopes
        second += own.weight[i] * (total.speed * total.speed + total.change)
        second += own.rotor[i] * Pace.of(paces[i]).snap
        for j in range(n):
            after = min(i, j) + 1
            other_pace = Pace.of(paces[j])
            bend = (turns[after] * turns[after] + changes[after]) * other_pace.change
            bend += 2.0 * turns[after] * other_pace.jerk + other_pace.snap
            second += inertia * own.inertia[j] * bend
        bends[i] = second


@compiled
def _write_paces(motion: Motion, left: float, paces: Matrix) -> None:
    """Write the `Pace` of each joint, (n, 4), while `left` or less of a motion's time is left.

    With w = 1 - u the cubic is w^2 (c - e w). Positions are sums of the velocities: by the formula
    of Euler and Maclaurin, exact for cubics, their derivative is v - dt a / 2 + dt^2 j / 12.
    """
    T = motion.periods * motion.period
    half = 0.5 * motion.period
    for i in range(motion.first.size):
        x = motion.first[i]
        speed = abs(x) * left
        change = abs(x)
        jerk = 0.0
        snap = 0.0
        if motion.cubic:
            e = 2.0 * x + motion.coefficient[i]
            c = e + x
            speed = abs(left * left * (c - e * left))
            change = abs(left * (2.0 * c - 3.0 * e * left))
            jerk = 2.0 * max(abs(c), abs(c - 3.0 * e * left))
            snap = 6.0 * abs(e)
            top = c / e if e != 0.0 else 0.0
            if 0.0 < 2.0 * top < 3.0 * left:
                speed = max(speed, 4.0 / 27.0 * top * top * abs(c))
            if 0.0 < top < 3.0 * left:
                change = max(change, abs(c) * top / 3.0)
        pace = Pace.of(paces[i])
        pace.snap = snap / (T * T * T)
        pace.jerk = jerk / (T * T) + half * pace.snap
        pace.change = change / T + half * (jerk / (T * T) + half / 3.0 * pace.snap)
        pace.speed = speed + half * (change / T + half / 3.0 * (jerk / (T * T)))


def not_negative_torques(argument: str, value: ArrayLike) -> float | tuple[float, ...]:
    """Return a number of at least 0, or several as a tuple; refuse any other value."""
    given = [checks.not_negative(argument, each) for each in np.ravel(value).tolist()]
    return tuple(given) if np.ndim(value) else given[0]


@dataclass(frozen=True)
class TorqueLimits(Limit):
    """Limits of the joints' torques for every payload of the robot's range, until the arm rests.

    Without a payload (`Robot.with_payload`) it is the robot's own masses. The robot is rigid and
    follows its commands, whose period is constant. Torques alone would admit thousands of rad/s^2
    at a wrist whose file has no rotor inertia (`Robot.with_armature`), so the scheme needs
    acceleration limits of all joints.

    Attributes:
        fraction: Part of the torque limits that may be used, in (0, 1].
        friction: Torque that friction takes from each joint [N m], one number or (n,); None: what
            is known of it (`Robot.friction`).
        effort: Torque limits [N m], one number or (n,); None: those of the robot's file, or of its
            maker (`iiwa_dnn.robot.arms`).
    """

    kernel = staticmethod(torque_rows)
    rest_kernel = staticmethod(keeps_torque)
    slower_helps = True
    _checks: ClassVar[checks.Checks] = {
        "fraction": checks.positive,
        "friction": not_negative_torques,
        "effort": not_negative_torques,
    }
    fraction: float = 0.95
    friction: ArrayLike | None = None
    effort: ArrayLike | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.fraction > 1.0:
            raise InvalidInputError("fraction", "must be at most 1", self.fraction)

    def row_count(self, robot: Robot) -> int:
        """Return 2 n, or 4 n for a range of payloads."""
        return 2 * robot.dof * len(_masses(robot))

    def row_names(self, robot: Robot) -> list[str]:
        """Return joint and payload of each row."""
        held = [f", with {mass:g} kg" * (robot.payload is not None) for mass in _masses(robot)]
        joints = np.repeat(np.arange(1, robot.dof + 1), 2)
        return [f"joint {joint} torque{mass}" for mass in held for joint in joints]

    def largest(self, robot: Robot) -> Vector:
        """Return the largest torque of each joint [N m], (n,).

        Raises:
            InvalidInputError: The robot's file gives a joint none, or wrong ones, or friction
                leaves nothing.
        """
        friction = robot.friction
        if self.friction is not None:
            friction = _of_joints("friction", self.friction, robot)
        effort = np.array(robot.model.effortLimit)
        if self.effort is not None:
            effort = _of_joints("effort", self.effort, robot)
        elif effort[0] == WRONG_EFFORTS.get(robot.name, (0.0, ""))[0] > 0.0:
            problem = f"{robot.name}: {WRONG_EFFORTS[robot.name][1]}: state TorqueLimits(effort=)"
            raise InvalidInputError("effort", problem, effort)
        left: Vector = self.fraction * effort - friction
        for name, given, own in zip(robot.joint_names, effort, left, strict=True):
            if not (0.0 < given < np.inf and own > 0.0):
                why = "leaves nothing of" if given > 0.0 else "needs"
                problem = f"joint {name!r}: TorqueLimits {why} its torque limit of {given:g} N m"
                raise InvalidInputError("effort", problem, effort)
        return left

    def constants(self, robot: Robot) -> TorqueConstants:
        """Return `TorqueConstants`; raise InvalidInputError as `largest` does."""
        dynamics = dynamics_of(robot)
        masses = _masses(robot)
        inertia, weight = _bounds(robot, dynamics, masses[0])
        return TorqueConstants.make(
            lightest=masses[-1],
            heaviest=masses[0],
            slides=bool(robot.slides),
            limit=self.largest(robot),
            inertia=np.sqrt(inertia),
            rotor=np.array([Link.of(numbers).armature for numbers in dynamics.links]),
            weight=weight,
            dynamics=dynamics.numbers,
        )

    def demands(self, robot: Robot, q: Matrix, dq: Matrix, dt: float) -> Matrix:
        """Return the larger size of each torque of a run with both ends of the payload [N m].

        Args:
            robot: The robot, n joints.
            q: Joint positions at which each of N steps begins [rad], (N, n).
            dq: Velocities of the steps [rad/s], (N, n); the first one begins at rest.
            dt: Control period [s].
        """
        own = self.constants(robot)
        load = np.empty_like(dq)
        before = np.zeros(robot.dof)
        for k, velocity in enumerate(dq):
            write_loads(own, q[k], before, (velocity - before) / dt, load[k])
            before = velocity
        return load

    def check_start(self, robot: Robot, q: Vector) -> None:
        """Raise InvalidInputError if the arm cannot leave a posture q (n,) [rad] or hold it."""
        own = self.constants(robot)
        load = np.empty(robot.dof)
        rest = np.zeros(robot.dof)
        if write_loads(own, q, rest, rest, load) > 1.0 - AT_REST:
            ratio = load / own.limit
            i = int(ratio.argmax())
            problem = f"takes {ratio[i]:.3g} of the torque limit of joint {i + 1} to be held"
            problem += f", more than {1.0 - AT_REST:g}"
            raise InvalidInputError("q", problem, q)


def own_torque_limits(robot: Robot) -> tuple[TorqueLimits, ...]:
    """Return the `TorqueLimits` of an arm with a payload, an empty tuple if they are not vetted.

    `Shield` keeps them by itself if the torque limits are its maker's (`iiwa_dnn.robot.arms`) and
    all accelerations have limits.
    """
    vetted = np.array_equal(robot.stated("effort"), robot.model.effortLimit)
    if robot.payload is None or not (vetted and np.isfinite(robot.ddq_max).all()):
        return ()
    return (TorqueLimits(),)


def _of_joints(name: str, value: ArrayLike, robot: Robot) -> Vector:
    """Return a number for each joint, (n,), of one number or (n,)."""
    own: Vector = checks.array(name, value, np.shape(value) and (robot.dof,))
    return np.full(robot.dof, own)


def _masses(robot: Robot) -> list[float]:
    """Return the ends of the range of payloads [kg], the largest first; one if both are equal."""
    ends = (0.0, 0.0) if robot.payload is None else robot.payload.mass.tolist()
    return sorted({*ends}, reverse=True)


def _bounds(robot: Robot, dynamics: Dynamics, mass: float) -> tuple[Vector, Vector]:
    """Bound the diagonal of the inertia matrix [kg m^2] and the torques of gravity [N m], (n,).

    A body is no farther from an axis than the lengths between them allow. With sliding joints,
    where they are not needed, they are none.
    """
    n = robot.dof
    inertia = np.zeros(n)
    weight = np.zeros(n)
    pull = float(np.linalg.norm(dynamics.gravity))
    links = [Link.of(numbers) for numbers in dynamics.links]
    bodies = [(j, 1.0, link.body, 0.0) for j, link in enumerate(links)]
    away = float(np.linalg.norm(dynamics.spread, axis=1).sum())  # the payload from its box's centre
    for carrier, amount, body, beyond in [
        *bodies,
        (dynamics.carrier - 1, mass, dynamics.payload, away),
    ]:
        largest = amount * max(float(np.linalg.eigvalsh(body.inertia)[-1]), 0.0)
        at = body.center
        joint = carrier
        while joint >= 0:
            distance = float(np.hypot(at[0], at[1])) + beyond
            inertia[joint] += largest + amount * body.mass * distance**2
            weight[joint] += amount * body.mass * pull * distance
            beyond += float(np.linalg.norm(at))
            at = Placement.of(links[joint].placement.numbers).position
            joint = int(links[joint].parent) - 1
    return inertia, weight
