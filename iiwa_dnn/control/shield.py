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
keep the command from the program's answer, it lies on the line from the braking command to it, at
the largest of the fractions 1, 1/2, 1/4, ... from which the arm can stop; other commands within the
limits may be closer to the request. A request for positions is one for the
quickest velocity from which each joint can still rest there. An arm without a request has one to
rest.
"""

from __future__ import annotations

import math
import threading
import warnings
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.arms import (
    ArmInput,
    ArmPlan,
    ArmSettings,
    ArmSizes,
    ArmState,
    answer_request,
    halt_arm,
    margin_of,
    motion_of,
    rest_arm,
    send_arm,
    stopping_time_of,
    take_input,
)
from iiwa_dnn.control.command import Command, LogLayout
from iiwa_dnn.control.controller import periods_of_step
from iiwa_dnn.control.cycle import INVALID, ControlLayout
from iiwa_dnn.control.paths import setup_warnings
from iiwa_dnn.control.policies import Action
from iiwa_dnn.control.requests import (
    ARGUMENTS,
    CUT,
    FASTEST,
    REASONS,
    TWIST,
    Reason,
    Request,
    RequestCost,
)
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import active_limits, describe
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics_kernel import model_tables
from iiwa_dnn.schemes import (
    CollisionAvoidance,
    JointLimits,
    Limit,
    Obstacle,
    Scheme,
    own_rate_limits,
)
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.periods import Periods, checked_longest
from iiwa_dnn.schemes.rate_limits import MotionLimits
from iiwa_dnn.schemes.scene import Body, scene_views


def one_request(
    dq: ArrayLike | None, twist: ArrayLike | None, position: ArrayLike | None
) -> tuple[Request, ArrayLike | None]:
    """Return the kind of the one request that is given, and the request; or `NONE` and None.

    Raises:
        InvalidInputError: There are several.
    """
    if (dq is not None) + (twist is not None) + (position is not None) > 1:
        raise InvalidInputError("dq, twist, position", "pass exactly one of them")
    if dq is not None:
        return Request.VELOCITY, dq
    if twist is not None:
        return Request.TWIST, twist
    return (Request.NONE if position is None else Request.POSITION), position


class ArmLayout(NamedTuple):
    """Step of an arm laid out for requests of its joints and of one frame's twist.

    Attributes:
        plan: Arrays and settings for kernels.
        step: The control step.
        memory: Memory of an arm that has not begun.
        positions: Place of the commanded joint positions in it.
    """

    plan: ArmPlan
    step: ControlLayout
    memory: Vector
    positions: slice


def lay_out_arm(shield: Shield, frame: str) -> ArmLayout:
    """Lay the step of an arm out, for requests of joints and of one frame's twist.

    Raises:
        NotFoundError: The robot has no frame of that name.
    """
    robot = shield.robot
    program = Scheme([RequestCost(frame)], [], shield.limits).program(robot)
    solver = DNNSolver(tol=1e-9)
    longest = shield.longest_period
    step = ControlLayout(program, {}, solver, shield.dt, Action.RELAX, longest)
    centers, velocities = _obstacles(shield)
    n, m, _ = program.sizes
    sizes = ArmSizes(
        n=robot.dof,
        request=max(robot.dof, TWIST),
        motion=step.width,
        network=solver.state_for(program.sizes).size,
        fallback=step.plan.fallback.size,
        obstacles=len(centers),
        limiting=n + m,
        # Two commands in a row last longer than a period, or are one.
        sent=(1 + robot.dof) * (1 + 2 * math.ceil(shield.delay / shield.dt)) * (shield.delay > 0.0),
    )
    total = np.minimum(robot.dq_max, FASTEST).sum()
    plan = ArmPlan(
        model_tables(robot, program.kinematics.frame_ids),
        step.plan,
        program.places_of(RequestCost)[0],
        [*program.places_of(CollisionAvoidance), -1][0],
        step.log_layout.width,
        MotionLimits(own_rate_limits(robot)).constants(robot),
        float(CUT * max(robot.reach, 1.0) * total),  # above what the joints can do anywhere
        robot.q_lower,
        robot.q_upper,
        velocities,
        shield.settings,
        sizes,
    )
    memory = ArmState.zeros(*sizes)
    memory.obstacles[:] = centers
    rest_arm(plan, memory.numbers, np.zeros(0))
    return ArmLayout(plan, step, memory.numbers, ArmState.columns(*sizes)["positions"])


def _obstacles(shield: Shield) -> tuple[Matrix, Matrix]:
    """Return the centres of a shield's obstacles at time 0 [m], and velocities [m/s], (k, 3)."""
    avoidance = avoidance_of(shield)
    if avoidance is None or not avoidance.obstacles:
        return np.zeros((0, 3)), np.zeros((0, 3))
    bodies = scene_views(avoidance.scene(shield.robot).constants, shield.robot.dof).bodies
    first = len(bodies) - len(avoidance.obstacles)
    centers = np.array([Body.of(body).center for body in bodies[first:]])
    return centers, np.array([each.velocity for each in avoidance.obstacles], dtype=np.float64)


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
        plan: Layout of the arm's step.
        memory: Memory of the arm after it, (k,).
        row: The log of the control step, (width,).
        layout: Layout of the log.
        periods: Periods of the step.
    """

    dq: Vector
    plan: ArmPlan
    memory: Vector
    row: Vector
    layout: LogLayout
    periods: Periods

    @property
    def state(self) -> ArmState:
        """State of the arm after the step."""
        return ArmState.of(self.memory, *self.plan.sizes)

    @property
    def command(self) -> Command:
        """The command with the program that was answered."""
        return Command(self.row, self.layout, Action(self.state.action), self.periods)

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
        return self.state.is_clipped

    @property
    def reasons(self) -> tuple[str, ...]:
        """Reasons beside limits for another command than the request, in words."""
        own = self.state
        codes = (
            own.reason,
            Reason.Q_NOT_FINITE * own.is_blind,
            Reason.RESYNCHRONISED * own.is_resynchronised,
            Reason.CUT * own.is_cut,
            Reason.PERIOD_EXCEEDED * own.is_late,
            Reason.SINGULAR * own.is_singular,
        )
        return tuple(REASONS[code] for code in codes if code)

    @property
    def active_limits(self) -> tuple[str, ...]:
        """Name the reasons, bounds and rows that keep the command from the request."""
        own = self.state
        if not own.is_clipped:
            return ()
        names = self.layout.names
        codes, rows = np.split(own.limiting.astype(int), [own.positions.size])
        words = map(describe, active_limits(names.settings, codes, rows))
        motion = motion_of(self.plan, own)
        return (*self.reasons, *words, *names.conditions(motion.q, motion.least))

    @property
    def margin(self) -> Margin:
        """Distances at the joint positions that the command starts from."""
        return Margin(*margin_of(self.plan, self.memory))

    @property
    def stopping_time(self) -> float:
        """Time of the motion to rest from the command [s]."""
        return float(stopping_time_of(self.plan, self.memory))

    def __repr__(self) -> str:
        dq = np.array2string(self.dq, precision=4, separator=", ")
        return f"<ShieldCommand dq = {dq} rad/s; clipped = {self.clipped}>"


class Shield:
    """The limits of a robot, kept for whoever drives it.

    The shield integrates its own commands; measured positions that are no further than
    `tracking_error` from those commanded `delay` ago do not change them, unless periods vary and
    are not stated. Threads may share a shield: steps wait for each other.

    Attributes:
        robot: The robot, n joints, whose limits hold.
        dt: Control period [s].
        longest_period: Longest control period where periods vary [s]; None: they do not.
        delay: Time by which the arm is behind its commands [s].
        settings: Control period, timeout and tracking error.
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
        self.delay = checks.not_negative("delay", delay)
        self.settings = ArmSettings.make(
            dt=self.dt,
            longest=longest_period or 0.0,
            timeout=timeout if timeout == math.inf else checks.positive("timeout", timeout),
            tracking_error=checks.not_negative("tracking_error", tracking_error),
            delay=self.delay,
        )
        self._warned: set[str] = set()
        self._kept: tuple[Vector, str]  # memory of the arm, never overwritten; frame of twists
        limits: list[Limit] = [JointLimits(), *own_rate_limits(robot)]
        if obstacles is not None:
            limits.append(CollisionAvoidance(obstacles, distance=distance, left_out=left_out))
        self._halted = False
        self.limits = tuple(limits)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Limits that every command keeps; a shield that is given others begins anew, at rest.

        Only a halt is kept.
        """
        return self._limits

    @limits.setter
    def limits(self, limits: tuple[Limit, ...]) -> None:
        self._limits = limits
        halted = self._halted
        self._begin()
        self.reset()
        self._halted = halted

    def _begin(self) -> None:
        self._lock = threading.RLock()
        self._layouts: dict[str, ArmLayout] = {}
        self.layout(self.robot.tip)

    def __getstate__(self) -> dict[str, Any]:
        with self._lock:
            own = vars(self) | {"_warned": set(self._warned)}
        return {name: own[name] for name in own if name not in ("_lock", "_layouts")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._begin()

    def layout(self, frame: str) -> ArmLayout:
        """Return the layout of the steps for requests of joints and of a frame's twist."""
        with self._lock:
            if frame not in self._layouts:
                self._layouts[frame] = lay_out_arm(self, frame)
            return self._layouts[frame]

    def reset(self, q: ArrayLike | None = None) -> None:
        """Forget requests, a halt and the commands: the arm stands at joint positions.

        Args:
            q: The positions [rad], (n,); None: where the arm is measured next.
        """
        none = np.zeros(0)
        at = none if q is None else checks.joint_positions("q", q, self.robot.dof)
        with self._lock:
            tip = self.robot.tip
            layout = self.layout(tip)
            memory = layout.memory.copy()
            rest_arm(layout.plan, memory, at)
            self._kept = (memory, tip)
            self._halted = False

    def halt(self) -> None:
        """Brake from now on, whatever is requested, until `reset`."""
        self._halted = True

    def send(self, dq: ArrayLike, dt: float | None = None) -> None:
        """Count a velocity as sent, in place of a step's command.

        Args:
            dq: Joint velocity [rad/s], (n,).
            dt: Period for which it is held [s]; None: the control period.

        Raises:
            InvalidInputError: `dq` has another size, or is not finite; or `dt` is not above 0.
        """
        command = checks.finite_array("dq", dq, (self.robot.dof,))
        period = self.dt if dt is None else checks.positive("dt", dt)
        with self._lock:
            memory, frame = self._next(Request.NONE, None)
            send_arm(self._layouts[frame].plan, memory, command, period)
            self._kept = (memory, frame)

    def warm_up(self, q: ArrayLike, frames: Sequence[str] = ()) -> None:
        """Lay the programs out ahead, so that the first step is as quick as the others.

        Args:
            q: Joint positions of the first step [rad], (n,).
            frames: Frames of the twists that will be requested.
        """
        start = Configuration(self.robot, q)
        with self._lock:
            self._warn_of_start(start, stacklevel=3)
            kept = self._kept
            try:  # steps that do not count
                self._step(start.q, Request.VELOCITY, np.zeros(self.robot.dof), None, None, None)
                for frame in checks.names("frames", frames):
                    self._step(start.q, Request.TWIST, np.zeros(TWIST), frame, None, None)
            finally:
                self._kept = kept

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
        kind, request = one_request(dq, twist, position)
        with self._lock:
            before = self._kept
            try:
                return self._step(q, kind, request, frame, dt, elapsed)
            except BaseException:  # interrupted before anybody got the command
                self._kept = before
                raise

    def _step(
        self,
        q: ArrayLike,
        kind: Request,
        request: ArrayLike | None,
        frame: str | None,
        dt: float | None,
        elapsed: float | None,
    ) -> ShieldCommand:
        """Take a step with a request, or none."""
        measured = checks.joint_positions("q", q, self.robot.dof)
        asked = measured if request is None else self._asked(kind, request)
        if "start" not in self._warned:
            self._warn_of_start(Configuration(self.robot, measured), stacklevel=4)
        memory, seen = self._next(kind, frame)
        layout = self._layouts[seen]
        periods = layout.step.plan.timing
        if layout.step.varies or not dt is elapsed is None:
            periods = periods_of_step(self, self._warned, dt, elapsed)
        given = ArmInput(measured, kind, asked, dt or 0.0, elapsed or 0.0)
        take_input(layout.plan, memory, given)
        log_layout = layout.step.log_layout
        kinematics = layout.step.program.kinematics
        positions = memory[layout.positions]
        kinematics.update(positions)
        row = np.empty(log_layout.width)
        action = answer_request(
            layout.plan, memory, given, kinematics.jacobian, kinematics.placements, row
        )
        if action == INVALID:
            checks.joint_positions("q", positions, positions.size)
        self._kept = (memory, seen)
        dq = row[log_layout.dq]
        return ShieldCommand(dq, layout.plan, memory, row, log_layout, periods)

    def _asked(self, kind: Request, request: ArrayLike) -> Vector:
        """Return a request of a kind as numbers, which may be NaN."""
        size = TWIST if kind is Request.TWIST else self.robot.dof
        return checks.array(ARGUMENTS[kind], request, (size,))

    def _next(self, kind: Request, frame: str | None) -> tuple[Vector, str]:
        """Return a copy of the arm's memory, and the frame of twists, for a request of a kind."""
        memory, last = self._kept
        memory = memory.copy()
        seen = frame or self.robot.tip if kind is Request.TWIST else last
        layout = self._layouts.get(seen) or self.layout(seen)
        if seen != last:
            own = ArmState.of(memory, *layout.plan.sizes)
            own.network[:] = 0.0
            own.twist_fallback[:] = 0.0
        if self._halted:
            halt_arm(layout.plan, memory)
        return memory, seen

    def _warn_of_start(self, start: Configuration, stacklevel: int) -> None:
        """Warn once of settings or a start posture that are most likely wrong."""
        if "start" in self._warned:
            return
        self._warned.add("start")
        program = self.layout(self.robot.tip).step.program
        for message in setup_warnings(program, start, 0.0, self.dt, "converged"):
            warnings.warn(message, stacklevel=stacklevel + 1)
