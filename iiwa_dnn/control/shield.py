r"""A shield: any request for a motion in, the command closest to it that keeps every limit out.

The request is a joint velocity w, a twist v of a frame, or joint positions to reach. The command
answers the program of a `Controller` whose task is soft,

.. math::

    \min_x \; \tfrac12 \|x - w\|^2 \qquad \text{or} \qquad
    \min_x \; \tfrac12 \|W (J x - v)\|^2 + \tfrac12 \lambda^2 \|x\|^2 ,

within the bounds and rows of its limits; W weighs what is beside v `SIDEWAYS` times as much.
Everything else is the controller's: the verified stopping motion that is always available, and what
is done where the limits leave no answer. A request that the limits admit, and from which the arm
can stop, is the command to the last bit. If acceleration or jerk limits, or the stopping motion,
keep the command from the program's answer, it is the closest one on the way there, and other
commands within the limits may be closer to the request. A request for positions is one for the
quickest velocity from which each joint can still rest there. An arm without a request has one to
rest.
"""

from __future__ import annotations

import copy
import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.state import ControllerState
from iiwa_dnn.control.stopping import least_periods
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.dense import all_finite, cholesky_factor, factor_solve
from iiwa_dnn.qp.layout import QPViews, copied, qp_views
from iiwa_dnn.references import Target
from iiwa_dnn.references.rotations import triple
from iiwa_dnn.references.targets import TargetData
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Placement, Twist
from iiwa_dnn.schemes import (
    CollisionAvoidance,
    JointLimits,
    KineticEnergy,
    Limit,
    Obstacle,
    PoseTask,
    Scheme,
    Task,
    own_rate_limits,
)
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.limits import (
    MotionLimits,
    MotionNumbers,
    Periods,
    Rates,
    arriving,
    braking,
    checked_longest,
    constant_periods,
    joint_bounds,
    joint_rates,
    stated_periods,
)
from iiwa_dnn.schemes.program import ProgramLayout
from iiwa_dnn.schemes.step import (
    TARGET_SIZE,
    FrameConstants,
    StepViews,
    point_rate,
    write_spin,
    write_velocity,
)

DAMPING = 0.02
"""Lambda of a twist's program [m/rad]: near a singular pose the joints do not race."""

SIDEWAYS = 10.0
"""Weight of the motion beside a twist: where a twist cannot be had, the frame stays rather than
slides."""

SHORT = 0.02
"""Part of a twist that may be missing where the damping alone keeps it from being fulfilled."""

CUT = 100.0
"""Velocity to which a larger request is cut, in units of the largest one that joints can do."""

FASTEST = 1e4
"""Largest velocity of a joint that has no velocity limit [rad/s], for the cut."""

TWIST = 6
"""Numbers of a twist."""

JOINTS = ""
"""Frame of requests for all joints."""

REASONS = ("", "no request", "request timed out", "request not finite", "halted")
"""Words of each `Reason`."""

RESYNCHRONISED = "resynchronised to measured positions"

IS_CUT = "request cut"

SINGULAR = "singular posture"


class Reason(IntEnum):
    """Reasons beside limits for another command than the request: those to rest come first."""

    NONE = 0
    NO_REQUEST = 1
    TIMED_OUT = 2
    NOT_FINITE = 3
    HALTED = 4
    Q_NOT_FINITE = 5
    RESYNCHRONISED = 6
    CUT = 7
    PERIOD_EXCEEDED = 8
    SINGULAR = 9


class JointsConstants(Record):
    """Number of the first joint of a `JointVelocityTask`, from 0."""

    first: int


@compiled
def velocity_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A = I and b = w for some joints; the target (18,) begins with their velocities w."""
    first = JointsConstants.of(constants).first
    for i in range(b.size):
        A[i, first + i] = 1.0
        b[i] = target.numbers[i]


@dataclass(frozen=True)
class JointVelocityTask(Task):
    """Velocities of some joints, a row each, which a step's target holds in place of a pose.

    Attributes:
        frame: The frame whose target it is.
        first: The first of the joints, of which a target holds 18.
    """

    kernel = staticmethod(velocity_rows)
    weight = 1.0
    frame: str
    first: int = 0

    def row_count(self, robot: Robot) -> int:
        """Return the number of the joints."""
        return min(TARGET_SIZE, robot.dof - self.first)

    def constants(self, robot: Robot) -> Vector:
        """Return `JointsConstants`."""
        return JointsConstants.make(first=self.first)


@compiled
def twist_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A = W J and b = W v = v; W leaves v as it is and weighs what is beside it."""
    own = FrameConstants.of(constants[: FrameConstants.width()])
    base = Placement.of(step.placements[own.relative_to])
    point = triple(Placement.of(step.placements[own.frame]).position)
    for i in range(3):
        axis = triple(base.axes[i])
        write_velocity(step, own, point, axis, A[i])
        write_spin(step, own, axis, A[3 + i])
        b[i] = target.linear_velocity[i]
        b[3 + i] = target.angular_velocity[i]
    square = 0.0
    for k in range(b.size):
        square += b[k] * b[k]
    for i in range(A.shape[1]):
        along = 0.0
        for k in range(b.size):
            along += A[k, i] * b[k]
        fraction = (1.0 - SIDEWAYS) * along / square if square > 0.0 else 0.0
        for k in range(b.size):
            A[k, i] = SIDEWAYS * A[k, i] + fraction * b[k]


@dataclass(frozen=True, kw_only=True)
class TwistTask(PoseTask):
    """Linear and angular velocity of a frame, which a step's target holds."""

    kernel = staticmethod(twist_rows)


class Flags(Record):
    """State of a request.

    Attributes:
        age: Time since it came [s].
        reason: `Reason` why it is one to rest.
        begun: Whether there was a first step.
        resynchronised: Whether it was resynchronised to measured positions.
        is_cut: Whether it is cut.
    """

    age: float
    reason: int
    begun: bool
    resynchronised: bool
    is_cut: bool


class ShieldSettings(Record):
    """Settings of a shield.

    Attributes:
        period: Last period [s].
        timeout: Time for which a request counts [s].
        tracking_error: Difference of positions above which it is resynchronised to measured ones
            [rad].
        delay: Time by which the arm is behind its commands [s].
    """

    period: float
    timeout: float
    tracking_error: float
    delay: float


class ShieldState(NamedTuple):
    """Commanded positions and the request that counts, which a step overwrites.

    Attributes:
        positions: Joint positions [rad], (n,).
        request: The request, (k,): zero without one.
        flags: State of the request.
    """

    positions: Vector
    request: Vector
    flags: Flags


@compiled
def take_request(
    q: Vector, request: Vector, given: bool, state: ShieldState, settings: ShieldSettings
) -> bool:
    """Take measured positions q (n,) [rad] and a request (k,) over.

    The positions count at the first step, or if they are far. If no request is given, the last one
    counts, or one to rest for a reason.

    Returns:
        Whether the request that counts is that of the last step.
    """
    flags = state.flags
    far = 0
    for i in range(q.size):
        far += not abs(q[i] - state.positions[i]) <= settings.tracking_error
    flags.resynchronised = False
    if far > 0 or not flags.begun:
        flags.resynchronised = flags.begun
        flags.begun = True
        copied(state.positions, q)
    flags.age += settings.period
    if given and flags.reason != Reason.HALTED:
        flags.age = 0.0
        finite = all_finite(request, 0, request.size)
        flags.reason = Reason.NONE if finite else Reason.NOT_FINITE
    if flags.reason == Reason.NONE and flags.age > settings.timeout + 0.5 * settings.period:
        flags.reason = Reason.TIMED_OUT
    other = 0
    for i in range(request.size):
        now = request[i] if flags.reason == Reason.NONE else 0.0
        other += now != state.request[i]
        state.request[i] = now
    return other == 0


@compiled
def come_nearer(
    state: ShieldState,
    last: Vector,
    before: Vector,
    limits: MotionNumbers,
    periods: Periods,
    reaches: bool,
    repeated: bool,
    dq: Vector,
) -> None:
    """Write the next velocities dq (n,) [rad/s] on the quickest path to the request that counts.

    Those on the way to positions are the quickest ones from which all joints can still rest there.
    A joint that jerk limits keep from its velocity in this step, or that is asked for the same one
    as in the last step, does not pass it.

    Args:
        state: The request, and where the joints are.
        last: Last command [rad/s], (n,).
        before: Command before it [rad/s], (n,).
        limits: Limits of the joints.
        periods: Periods of the step.
        reaches: Whether the request is one for positions.
        repeated: Whether it is that of the last step.
        dq: The velocities, overwritten.
    """
    state.flags.is_cut = False
    for i in range(dq.size):
        wanted = state.request[i]
        left = wanted - state.positions[i]
        above = limits.upper[i] - state.positions[i]
        below = state.positions[i] - limits.lower[i]
        rates = joint_rates(limits, i)
        most = CUT * min(rates.velocity, FASTEST)
        if reaches:
            above = left if left >= 0.0 else np.inf
            below = -left if left < 0.0 else np.inf
            accel = rates.acceleration
            rates = Rates(rates.velocity, accel, rates.jerk, accel, np.inf, 0.0)
            wanted = min(max(left / periods.hold, -most), most)
        elif abs(wanted) > most:
            wanted = math.copysign(most, wanted)
            state.flags.is_cut = True
        lower, upper = joint_bounds(last[i], before[i], above, below, rates, periods)
        if reaches:
            wanted = min(max(wanted, lower), upper)
            wanted = arriving(last[i], before[i], left, wanted, rates, periods)
        elif repeated or wanted < lower or wanted > upper:
            wanted += braking(last[i] - wanted, -np.inf, np.inf, limits.jerk[i], periods)
        dq[i] = wanted


@compiled
def cut_twist(
    twist: Vector, jacobian: Matrix, placement: Placement, support: Vector, limits: MotionNumbers
) -> bool:
    """Cut a twist (6,) in place to `CUT` times what the joints can do.

    Args:
        twist: The twist of a frame.
        jacobian: `Kinematics.jacobian`, (n, 6).
        placement: The frame's.
        support: 1 for the joints that move it, (n,).
        limits: Limits of the joints.

    Returns:
        Whether it was larger.
    """
    n = support.size
    size = 0.0
    for i in range(TWIST):
        size = max(size, abs(twist[i]))
    if size <= CUT:
        return False
    point = triple(placement.position)
    most = 1.0
    for i in range(TWIST):
        total = 0.0
        for j in range(n):
            linear = point_rate(jacobian, j, point)
            angular = triple(Twist.of(jacobian[j]).angular)
            rate = linear[i % 3] if i < 3 else angular[i % 3]
            total += abs(support[j] * rate) * min(limits.velocity[j], FASTEST)
        most = max(most, total)
    if size <= CUT * most:
        return False
    for i in range(TWIST):
        twist[i] *= CUT * most / size
    return True


@compiled
def falls_short(qp: QPViews, twist: Vector) -> bool:
    """Test whether the damping alone keeps a twist (6,) from being fulfilled by `SHORT` of it.

    |W (J x - v)|^2 at the least of the cost of a twist's program, whose P is (W J)^T W J +
    DAMPING^2 I.
    """
    n = qp.q.size
    K = qp.P.copy()
    x = np.zeros(n)
    if cholesky_factor(K):
        factor_solve(K, qp.q, x)
    square = 0.0
    for i in range(TWIST):
        square += twist[i] * twist[i]
    missing = square
    for i in range(n):
        missing -= x[i] * (qp.q[i] + DAMPING * DAMPING * x[i])
    return missing > SHORT * SHORT * square


def pending_displacement(sent: Matrix, delay: float) -> tuple[Vector, Matrix]:
    """Compute the displacement by the commands of the last `delay` seconds.

    Args:
        sent: Periods [s] and commands [rad/s], the last first, (k, 1 + n).
        delay: The time [s].

    Returns:
        The displacement, (n,) [rad], and the rows that it needs.
    """
    periods = sent[:, 0]
    ages = np.cumsum(periods) - periods
    displacement: Vector = np.clip(delay - ages, 0.0, periods) @ sent[:, 1:]
    return displacement, sent[ages < delay]


def _words_of(flags: Flags) -> tuple[str, ...]:
    """Return the reasons that the flags of a state hold, in words."""
    numbers: Any = flags.tolist()
    _, reason, _, resynchronised, is_cut = map(int, numbers)
    words = (REASONS[reason], RESYNCHRONISED * resynchronised, IS_CUT * is_cut)
    return tuple(filter(None, words))


class Margin(NamedTuple):
    """Distances to what the shield keeps away from.

    Attributes:
        joint: Least distance of a joint from its position limits [rad].
        distance: Least distance of a link from an obstacle or another link, less the promised
            one [m]; inf where none is watched.
    """

    joint: float
    distance: float


class ShieldCommand(NamedTuple):
    """Decision of one step of a shield.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
        request: Joint velocity that was requested [rad/s], (n,); None: positions, or a twist.
        reasons: Reasons for another command than the given request.
        command: The controller's command, with the program that was answered.
        shield: The shield.
        t: Time of the shield's clock [s].
        period: Period over which its acceleration is measured [s].
    """

    dq: Vector
    request: Vector | None
    reasons: tuple[str, ...]
    command: Command
    shield: Shield
    t: float
    period: float

    @property
    def next_q(self) -> Vector:
        """Joint positions at the end of the period, for drives that take these [rad], (n,)."""
        return self.command.next_q

    @property
    def clipped(self) -> bool:
        """Test whether the command differs from the request.

        For positions, from the quickest approach to them that the joints' own limits allow; for a
        twist, whether more than `SHORT` of it is missing, or a limit holds.
        """
        if self.request is None or self.reasons:
            return bool({*self._why} - {*self.command.conditions})
        return bool((self.dq != self.request).any())

    @property
    def active_limits(self) -> tuple[str, ...]:
        """Name the reasons, bounds and rows that keep the command from the request."""
        return self._why if self.clipped else ()

    @property
    def _why(self) -> tuple[str, ...]:
        """Reasons, a posture that is too singular for the twist, bounds and rows, in words."""
        singular = (SINGULAR,) * self._is_singular
        return tuple(dict.fromkeys((*self.reasons, *singular, *self.command.active_limits)))

    @property
    def _is_singular(self) -> bool:
        """Test whether the damping alone keeps a twist from being fulfilled."""
        v = self.command.targets[0, 12:]
        if self.request is not None or not v.any():
            return False
        qp = self.command.qp
        return bool(falls_short(qp_views(qp.data, *qp.sizes), v))

    @property
    def stopping_time(self) -> float:
        """Time of the motion to rest from the command [s]."""
        shield = self.shield
        cubic = bool(np.isfinite(shield.robot.dddq_max).any())
        last = self.command.motion_state[1]
        periods = least_periods(self.dq, last, shield.motion, self.period, cubic, False)
        return self.period * max(periods, float(self.dq.any()))

    @property
    def margin(self) -> Margin:
        """Distances at the joint positions that the command starts from."""
        q = self.command.motion_state[0]
        lower, upper = self.shield.robot.limits[:2]
        distance = math.inf
        if (avoidance := avoidance_of(self.shield)) is not None:
            scene = avoidance.scene(self.shield.robot)
            distance = scene.nearest(q[np.newaxis], np.array([self.t]))[0][0] - avoidance.distance
        return Margin(np.minimum(q - lower, upper - q).min(), distance)


class Memory(NamedTuple):
    """Keep what one step leaves for the next, beside the state that kernels overwrite.

    Attributes:
        kind: Kind of the last request.
        frame: Its frame.
        t: Time [s].
        period: Period that counts for the last command [s].
        sent: Periods [s] and commands [rad/s] that are pending, the last first, (k, 1 + n).
    """

    kind: str
    frame: str
    t: float
    period: float
    sent: Matrix


class Shield:
    """The limits of a robot, kept for whoever drives it.

    The shield integrates its own commands; measured positions that are no further than
    `tracking_error` from those commanded `delay` ago do not change them, unless periods vary and
    are not stated. Threads may share a shield: steps wait for each other.

    Attributes:
        robot: The robot, n joints, whose limits hold.
        dt: Control period [s].
        longest_period: Longest control period where periods vary [s]; None: they do not.
        limits: Limits that every command keeps.
        motion: Their numbers for the joints.
        settings: Control period, timeout, tracking error and delay.
    """

    def __init__(
        self,
        robot: Robot,
        dt: float = 1e-3,
        obstacles: Sequence[Obstacle] | None = None,
        distance: float = 0.02,
        timeout: float = 0.1,
        tracking_error: float = 0.02,
        delay: float = 0.0,
        longest_period: float | None = None,
        left_out: Sequence[tuple[str, str]] = (),
    ) -> None:
        """Take a robot, and what is to be kept clear of.

        Args:
            robot: The robot, with limits on position and velocity; those on acceleration and jerk
                hold where it has them.
            dt: Control period [s].
            obstacles: Obstacles to keep away from, beside the arm's own links; None: neither.
            distance: Least distance from them [m].
            timeout: Time for which a request counts [s]; inf: until the next one.
            tracking_error: Difference of measured and commanded positions [rad] above which the
                shield is resynchronised to the measured ones. It has to exceed the largest velocity
                times the uncertainty of the delay, and twice the noise.
            delay: Time by which the arm is behind its commands [s]: from a step to the reading of
                the encoders at which its command begins to show, less one period.
            longest_period: Longest control period where periods vary [s]; None: they do not.
            left_out: Pairs that are not watched, as in `CollisionAvoidance`.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
            NotFoundError: There is no link or obstacle of a name in `left_out`.
        """
        self.robot = checks.instance("robot", robot, Robot)
        self.dt = checks.positive("dt", dt)
        self.longest_period = checked_longest(longest_period, self.dt)
        self._periods = constant_periods(self.dt)
        self.settings = ShieldSettings.zeros()
        self.settings.period = self.dt
        if timeout != math.inf:
            checks.positive("timeout", timeout)
        self.settings.timeout = timeout
        self.settings.tracking_error = checks.not_negative("tracking_error", tracking_error)
        self.settings.delay = checks.not_negative("delay", delay)
        rates = own_rate_limits(robot)
        self.motion = MotionLimits(rates).constants(robot)
        self.limits: list[Limit] = [JointLimits(), *rates]
        if obstacles is not None:
            watched = CollisionAvoidance(obstacles, distance=distance, left_out=left_out)
            watched.scene(robot)
            self.limits.append(watched)
        self._controllers: dict[str, Controller] = {}
        self._kept = ControllerState(robot.dof)
        self._lock = threading.RLock()
        self.reset()

    def __getstate__(self) -> dict[str, Any]:
        # The controllers share one state, and are made anew to share the copy's.
        with self._lock:
            own = {name: copy.deepcopy(getattr(self, name)) for name in ("_kept", "_state")}
            return {**vars(self), **own, "_controllers": {}, "_lock": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state, _lock=threading.RLock())

    @property
    def delay(self) -> float:
        """Time by which the arm is behind its commands [s]."""
        return self.settings.delay

    def reset(self) -> None:
        """Forget requests, a halt and the commands: the arm is where it is measured next."""
        n = self.robot.dof
        with self._lock:
            self._kept.rest()
            self._state = ShieldState(np.zeros(n), np.zeros(max(n, TWIST)), Flags.zeros())
            self._state.flags.reason = Reason.NO_REQUEST
            self._memory = Memory("dq", JOINTS, 0.0, self.dt, np.zeros((0, 1 + n)))

    def halt(self) -> None:
        """Brake from now on, whatever is requested, until `reset`."""
        with self._lock:
            self._state.flags.reason = Reason.HALTED

    def send(self, dq: ArrayLike) -> None:
        """Count a velocity dq (n,) [rad/s] as sent for a control period, in place of a step's.

        Raises:
            InvalidInputError: `dq` has another size, or is not finite.
        """
        with self._lock:
            self.controller().send(np.asarray(dq))
            positions, _, flags = self._state
            kind, frame, t, period, sent = self._memory
            positions += self.dt * np.asarray(dq)
            flags.age += period
            if self.delay > 0.0:
                sent = np.vstack([np.append(self.dt, dq), sent])
            self._memory = Memory(kind, frame, t + self.dt, self.dt, sent)

    def warm_up(self, q: ArrayLike, frames: Sequence[str] = ()) -> None:
        """Lay the programs out ahead, so that the first step is as quick as the others.

        Args:
            q: Joint positions of the first step [rad], (n,).
            frames: Frames of the twists that will be requested.
        """
        start = Configuration(self.robot, q)
        with self._lock:
            for frame in (JOINTS, *checks.names("frames", frames)):
                controller = self.controller(frame)
                controller.warm_up(start.q)
                if not self._kept.begun:
                    controller.warn_of_start(start, self._memory.t, False, stacklevel=3)

    def step(
        self,
        q: ArrayLike,
        dq: ArrayLike | None = None,
        *,
        twist: ArrayLike | None = None,
        position: ArrayLike | None = None,
        frame: str | None = None,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> ShieldCommand:
        """Compute the command that is closest to a request.

        Without a request the last one counts, until it is older than `timeout`. Periods are stated
        as for `Controller.step`.

        Args:
            q: Measured joint positions [rad], (n,).
            dq: Joint velocity that is requested [rad/s], (n,).
            twist: Or linear [m/s] and angular [rad/s] velocity of a frame along the base's axes,
                (6,).
            position: Or joint positions to reach [rad], (n,).
            frame: Name of the twist's frame; None stands for the tip.
            dt: Period for which this command will be held [s].
            elapsed: Time since the last step [s], for which the last command was held.

        Raises:
            InvalidInputError: `q` or a request has a wrong shape, `q` is not finite, there are
                several requests, or a period is wrong.
            NotFoundError: The robot has no frame of that name.
        """
        requests = {"dq": dq, "twist": twist, "position": position}
        given = {kind: value for kind, value in requests.items() if value is not None}
        with self._lock:
            positions, request, flags = self._state
            kept = ShieldState(positions.copy(), request.copy(), flags.copy())
            before = (self._kept.numbers, kept, self._memory)
            try:
                return self._step(q, given, frame, dt, elapsed)
            except BaseException:  # refused, or interrupted before anybody got the command
                halted = self._state.flags.reason == Reason.HALTED
                self._kept.numbers, self._state, self._memory = before
                if halted:
                    self.halt()
                raise

    def _step(
        self,
        q: ArrayLike,
        given: dict[str, ArrayLike],
        frame: str | None,
        dt: float | None,
        elapsed: float | None,
    ) -> ShieldCommand:
        """Take a step with a request, or none."""
        measured = checks.joint_positions("q", q, self.robot.dof)
        periods = self._periods
        if self.longest_period is not None or dt is not None or elapsed is not None:
            periods = stated_periods(self.dt, self.longest_period, dt, elapsed)
            if elapsed is not None:
                self._book(periods.dt)
        self._kept.set_period(periods.dt)
        kind, seen, t, period, sent = self._memory
        settings = self.settings
        if period != self.dt:
            settings = settings.copy()
            settings.period = period
        if settings.delay > 0.0:
            displacement, sent = pending_displacement(sent, settings.delay)
            measured = measured + displacement
        if self.longest_period is not None and dt is None and elapsed is None:
            # Nobody says for how long the last command was held.
            copied(self._state.positions, measured)
        for kind in given:
            seen = frame or self.robot.tip if kind == "twist" else JOINTS
        asked = (kind, seen)
        repeated = self._take(measured, given, settings)
        positions, request, flags = self._state
        if flags.reason:
            kind, seen = "dq", JOINTS
        controller = self.controller(seen)
        target = self._target(controller, kind, repeated, periods)
        command = controller.step(positions, t, target, dt=dt, elapsed=elapsed)
        # A request that can be had again is had at once.
        self._kept.motion.yields = False
        velocity = request[: positions.size].copy() if kind == "dq" else None
        reasons = (*_words_of(flags), *command.reasons)
        decision = ShieldCommand(command.dq, velocity, reasons, command, self, t, periods.dt)
        hold = controller.control_layout.dt
        positions += hold * command.dq
        if settings.delay > 0.0:
            sent = np.vstack([np.append(hold, command.dq), sent])
        self._memory = Memory(*asked, t + hold, hold, sent)
        return decision

    def _book(self, elapsed: float) -> None:
        """Count the last command as one that was held for so long [s]."""
        kind, frame, t, period, sent = self._memory
        positions = self._state.positions
        positions += (elapsed - period) * self._kept.motion.last
        sent = sent.copy()
        sent[:1, 0] = elapsed
        self._memory = Memory(kind, frame, t + elapsed - period, elapsed, sent)

    def _take(self, q: Vector, given: dict[str, ArrayLike], settings: ShieldSettings) -> bool:
        """Take positions and a request over; return whether it is that of the last step."""
        if len(given) > 1:
            problem = "pass exactly one of dq, twist, position"
            raise InvalidInputError(" and ".join(given), problem)
        request = self._state.request.copy()
        for kind, value in given.items():
            size = TWIST if kind == "twist" else q.size
            request[:size] = checks.array(kind, value, (size,))
        repeated: bool = take_request(q, request, bool(given), self._state, settings)
        return repeated

    def controller(self, frame: str = JOINTS) -> Controller:
        """Return the controller for requests of a frame, or of all joints; they share one state."""
        if frame not in self._controllers:
            scheme = Scheme([], self._velocity_tasks(), self.limits)
            if frame != JOINTS:
                task = TwistTask(frame=frame, gain=0.0, weight=1.0)
                scheme = Scheme([KineticEnergy(weight=DAMPING * DAMPING)], [task], self.limits)
            made = Controller(self.robot, scheme, dt=self.dt, policy="relax")
            made.longest_period = self.longest_period
            made._state = self._kept
            self._controllers[frame] = made
        return self._controllers[frame]

    def _velocity_tasks(self) -> list[JointVelocityTask]:
        """Return tasks for all joints, each with the target of a frame."""
        firsts = range(0, self.robot.dof, TARGET_SIZE)
        others = [name for name in self.robot.frame_names if name != self.robot.tip]
        frames = [self.robot.tip, *others]
        return [
            JointVelocityTask(frame, first) for frame, first in zip(frames, firsts, strict=False)
        ]

    def _target(
        self, controller: Controller, kind: str, repeated: bool, periods: Periods
    ) -> dict[str, Target]:
        """Return what a step is to answer, in the form of its targets."""
        program = controller.program
        frames = program.target_frames
        if kind == "twist":
            v = self._cut_twist(program)
            return {frames[0]: Target(np.zeros(3), linear_velocity=v[:3], angular_velocity=v[3:])}
        # From here a network that has nothing to do hands the aim out as it is.
        state = controller.solver.state_for(program.sizes)
        state[:] = 0.0
        aim = state[: self.robot.dof]
        motion = self._kept.motion
        reaches = kind == "position"
        come_nearer(
            self._state, motion.last, motion.before, self.motion, periods, reaches, repeated, aim
        )
        targets = np.zeros((len(frames), TARGET_SIZE))
        targets.reshape(-1)[: aim.size] = aim
        return {name: Target.from_data(targets[i]) for i, name in enumerate(frames)}

    def _cut_twist(self, program: ProgramLayout) -> Vector:
        """Return the twist that is requested, (6,), cut where no joints can do it."""
        v = self._state.request[:TWIST].copy()
        self._state.flags.is_cut = False
        if np.abs(v).max() > CUT:
            own = program.kinematics
            own.update(self._state.positions)
            at = self.robot.frame_id(program.target_frames[0])
            support = self.robot.support[at]
            placement = Placement.of(own.placements[at])
            cuts = cut_twist(v, own.jacobian, placement, support, self.motion)
            self._state.flags.is_cut = cuts
        return v
