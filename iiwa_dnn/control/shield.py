r"""A shield: the command closest to a requested motion that keeps every limit.

The request is a joint velocity w, a twist v of a frame, or joint positions to reach. The command
answers the program of a `Controller` whose task is soft,

.. math::

    \min_x \; \tfrac12 \|x - w\|^2 \qquad \text{or} \qquad
    \min_x \; \tfrac12 \|W (J x - v)\|^2 + \tfrac12 \lambda^2 \|x\|^2 ,

within the bounds and rows of its limits; W weighs an error perpendicular to v `SIDEWAYS` times as
much as one along it. The rest of a step is the controller's: the verified stopping motion that is
always available, and the fallback where the limits leave no answer. A request that the limits
admit, and from which the arm can stop, is the command to the last bit. If acceleration or jerk
limits, or the stopping motion, keep the command from the program's answer, it lies on the line from
the braking command to that answer, at the largest of the fractions 1, 1/2, 1/4, ... from which the
arm can stop; other commands within the limits may be closer to the request. For requested positions
w is the largest velocity from which each joint can still come to rest there. Without a request w is
zero.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.compiling.trigonometry import LARGEST
from iiwa_dnn.control.arm_layout import ArmLayout, Margin, lay_out_arm, own_movers, reasons_of, see
from iiwa_dnn.control.chunks import KEEPS, SAMPLES, check_clock, checked_times, stream_mode
from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import ACTION_OF, periods_of_step
from iiwa_dnn.control.desk import finish_step
from iiwa_dnn.control.news import News, separation_in, split_bodies
from iiwa_dnn.control.paths import long_times, setup_warnings, warn_of_bodies
from iiwa_dnn.control.preview import Preview, Rehearsal
from iiwa_dnn.control.requests import RequestCost, one_request
from iiwa_dnn.control.step_layout import ControlLayout
from iiwa_dnn.errors import InvalidInputError, warn_caller
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.posing import PoseChunk, Poses, solve_poses
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.obstacles import names_of
from iiwa_dnn.schemes import (
    CollisionAvoidance,
    JointLimits,
    Limit,
    Obstacle,
    Scheme,
    own_rate_limits,
)
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.periods import SLACK, Periods, checked_longest
from iiwa_dnn.schemes.separation import PEOPLE_SPEED, Separation
from iiwa_dnn.schemes.step import TARGET_SIZE
from iiwa_dnn.schemes.torque import own_torque_limits
from iiwa_dnn.step.arms import send_arm
from iiwa_dnn.step.cycle import INVALID
from iiwa_dnn.step.inputs import add_pending, begin_step, is_refused
from iiwa_dnn.step.memory import (
    ArmInput,
    ArmPlan,
    ArmSettings,
    ArmState,
    follow_arm,
    follow_of,
    halt_arm,
    motion_of,
    place_arm,
    rest_arm,
    scale_speed,
)
from iiwa_dnn.step.policies import Action
from iiwa_dnn.step.requests import TWIST, Request
from iiwa_dnn.step.samples import FollowState

DISTANCE = 0.02
"""Least distance from obstacles where none is stated [m]."""


LATENCY = 0.15
"""Age of people that a camera of 30 Hz and a tracker of 0.1 s exceed by lost frames alone [s]."""

FARTHEST = LARGEST * LARGEST
"""Squared length of joint positions above which they may have no meaning [rad^2]."""

NO_TARGETS = np.zeros((0, TARGET_SIZE))
"""Targets of a shield, which tracks no frame, (0, 18)."""

OWN_NETWORK = np.zeros(0)
"""Argument of `finish_step` for an arm whose memory holds the state of its network."""


def lay_out_shield(shield: Shield, frame: str) -> ArmLayout:
    """Lay out the step of a shield's arm, for requests of joints and of one frame's twist.

    Raises:
        InvalidInputError: The shield's limits do not fit.
        NotFoundError: The robot has no frame of that name.
    """
    program = Scheme([RequestCost(frame)], [], shield.limits).program(shield.robot)
    if program.joint_limits.gain == 0.0:
        raise InvalidInputError("limits", "need a JointLimits: every command keeps it", program)
    if len(program.places_of(CollisionAvoidance)) > 1:
        problem = "have several CollisionAvoidance: put their obstacles into one"
        raise InvalidInputError("limits", problem, program)
    solver = DNNSolver(tol=1e-9)
    longest = shield.longest_period
    step = ControlLayout(program, {}, solver, shield.dt, Action.RELAX, longest)
    return lay_out_arm(step, solver, shield.settings, shield.samples)


def place(layout: ArmLayout, memories: Matrix, obstacles: ArrayLike) -> None:
    """Place the centres of the obstacles of N arms, whose memories (N, k) are overwritten.

    Args:
        layout: Layout of the arms' steps.
        memories: The memories.
        obstacles: Present centres [m], (j, 3) for all arms or (N, j, 3).

    Raises:
        InvalidInputError: They have another shape, are not finite, or move in a way of their own.
    """
    if movers := own_movers(layout.step.program):
        problem = f"move in a way of their own: {', '.join(names_of(movers))}"
        raise InvalidInputError("obstacles", problem, obstacles)
    shape = (len(memories), layout.plan.sizes.obstacles, 3)
    given = shape if np.ndim(obstacles) == len(shape) else shape[1:]
    centers = checks.finite_array("obstacles", obstacles, given)
    for memory, own in zip(memories, np.broadcast_to(centers, shape), strict=True):
        place_arm(layout.plan, memory, own)


class Kept(NamedTuple):
    """State of a shield from step to step; a step makes new arrays.

    Attributes:
        memory: Memory of the arm, (k,).
        frame: Frame of its twists.
    """

    memory: Vector
    frame: str


class ShieldCommand(Command):
    """Decision of one step of a shield."""

    __slots__ = ("_arm", "_memory")

    def __init__(
        self, data: Vector, layout: ArmLayout, action: Action, periods: Periods, memory: Vector
    ) -> None:
        """Take what a `Command` takes, and the arm's layout and memory, which are not copied."""
        super().__init__(data, layout.step.log_layout, action, periods)
        memory.setflags(False)  # write=False: the shield keeps it
        self._arm = layout
        self._memory = memory

    @property
    def layout(self) -> ArmLayout:
        """Layout of the arm's step."""
        return self._arm

    @property
    def memory(self) -> Vector:
        """Memory of the arm after the step, (k,), read-only."""
        return self._memory

    @property
    def state(self) -> ArmState:
        """State of the arm after the step, a view."""
        return self.layout.state(self.memory)

    @property
    def clipped(self) -> bool:
        """Test whether the command differs from the request.

        For positions, from the quickest approach to them that the joints' own limits allow; for a
        twist, whether more than `SHORT` of it is missing, or a limit is active.
        """
        return self.state.is_clipped

    @property
    def reasons(self) -> tuple[str, ...]:
        """Reasons, other than limits, for a command that differs from the request, in words."""
        return reasons_of(self.state)

    @property
    def _followed(self) -> FollowState | None:
        """State of the samples that the arm follows; None without samples."""
        plan = self.layout.plan
        own = follow_of(plan, self.state) if plan.sizes.following else None
        return own if own is not None and own.count else None

    @property
    def late(self) -> float:
        """Time by which the clock of what is followed is behind at the end of the period [s]."""
        followed = self._followed
        return 0.0 if followed is None else float(followed.late)

    @property
    def off(self) -> float:
        """Largest distance of a joint from what is followed, at the end of the period [rad]."""
        followed = self._followed
        if followed is None:
            return 0.0
        return float(np.abs(self.state.positions - followed.reference).max())

    @property
    def active_limits(self) -> tuple[str, ...]:
        """Reasons, bounds and rows that keep the command from the request, in words."""
        return self.layout.active_limits(self.memory)

    @property
    def margin(self) -> Margin:
        """Distances from the limits at the joint positions that the command starts from."""
        return self.layout.margin(self.memory)

    @property
    def stopping_time(self) -> float:
        """Time of the stopping motion from the command [s]."""
        return self.layout.stopping_time(self.memory)

    def __repr__(self) -> str:
        dq = np.array2string(self.dq, precision=4, separator=", ")
        return f"<ShieldCommand dq = {dq} rad/s; clipped = {self.clipped}>"


class Shield(checks.Whole):
    """Safety filter for the commands of another controller: keeps the limits of a robot.

    The shield integrates the velocities that it commands. Measured positions within
    `tracking_error` of those commanded `delay` ago do not change the integrated ones, unless
    periods vary and are not stated. Threads may share a shield: steps wait for each other.

    What has no meaning is refused, and an arm never stops dead for it. Requests that are not finite
    brake the arm, with a reason; so do, in C and for an arm of `Shields`, all others. An argument
    that raises an error changes nothing: `step` with None for the joint positions then brakes.

    Attributes:
        robot: The robot, n joints, whose limits hold.
        dt: Control period [s].
        longest_period: Longest control period where periods vary [s]; None: they are constant.
        delay: Time by which the arm is behind its commands [s].
        samples: Largest number of samples of a chunk to follow.
        settings: These and the other numbers, for kernels. All of these are set when the shield is
            made; `limits` alone may be set later.
    """

    robot: Robot
    dt: float
    longest_period: float | None
    delay: float
    samples: int
    settings: ArmSettings

    def __init__(
        self,
        robot: Robot,
        dt: float = 1e-3,
        obstacles: Sequence[Obstacle] | CollisionAvoidance | None = None,
        distance: float = DISTANCE,
        timeout: float = 0.1,
        tracking_error: float = 0.02,
        delay: float = 0.0,
        longest_period: float | None = None,
        people: int = 0,
        field: float | None = None,
        latency: float = LATENCY,
        contact_speed: float = 0.0,
        people_speed: float = PEOPLE_SPEED,
        samples: int = SAMPLES,
    ) -> None:
        """Take a robot, and the obstacles and people to keep away from.

        Args:
            robot: The robot, with limits on position and velocity; those on acceleration and jerk
                hold where it has them, and `TorqueLimits` if it has a payload and its torques are
                its maker's.
            dt: Control period [s].
            obstacles: Obstacles that the links keep away from, as they do from each other; or a
                `CollisionAvoidance`; None: no distance is watched.
            distance: Least distance between links and obstacles [m]; a `CollisionAvoidance` has its
                own.
            timeout: Age up to which a request counts [s]; inf: until the next one.
            tracking_error: Difference of measured and commanded positions [rad] above which the
                shield is resynchronised to the measured ones. It has to exceed the largest velocity
                times the uncertainty of the delay, and twice the noise.
            delay: Time by which the arm is behind its commands [s]: from a step to the reading of
                the encoders at which its command begins to show, less one period.
            longest_period: Longest control period where periods vary [s]; None: they are constant.
            people: Largest number of bodies that a sensor's frame shows; 0: none are told of.
            field: Radius about the base within which the sensor sees everybody [m].
            latency: Largest age of a frame before the next one comes [s]. An older one brakes
                the arm earlier; the promise does not depend on it.
            contact_speed: Speed of a link's points up to which people may touch it [m/s].
            people_speed: Bound on their speed [m/s].
            samples: Largest number of samples of a chunk to follow, at least 4; 0: none is.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
            NotFoundError: There is no link or obstacle of a name in the `CollisionAvoidance`.
        """
        checks.instance("robot", robot, Robot)
        settings = ArmSettings.make(
            dt=checks.positive("dt", dt),
            longest=checked_longest(longest_period, dt) or 0.0,
            timeout=timeout if timeout == math.inf else checks.positive("timeout", timeout),
            tracking_error=checks.not_negative("tracking_error", tracking_error),
            delay=checks.not_negative("delay", delay),
        )
        settings.setflags(write=False)
        checks.fix(
            self,
            robot=robot,
            dt=settings.dt,
            longest_period=longest_period,
            delay=settings.delay,
            settings=settings,
            samples=samples and checks.integer("samples", samples, 4),
        )
        self._shape = (robot.dof,)
        self._warned: set[str] = set()
        self._unseen = tuple(Request)  # kinds whose first request has warnings
        self._speed_scale = 1.0
        self._halted = False
        self._is_within = False
        self._kept: Kept
        limits: list[Limit] = [JointLimits(), *own_rate_limits(robot)]
        checks.positive("distance", distance)
        free: list[Obstacle] = []
        if isinstance(obstacles, CollisionAvoidance):
            if distance not in (DISTANCE, obstacles.distance):
                raise InvalidInputError("distance", "is stated by the CollisionAvoidance", distance)
            limits.append(obstacles)
            distance = obstacles.distance
        elif obstacles is not None:
            free, others = split_bodies(obstacles)
            limits.append(CollisionAvoidance(others, distance=distance))
        told = (people, people_speed, field, latency, contact_speed)
        limits += _separation(tuple(free), told, distance, settings)
        if longest_period is None:  # which torques need
            limits += own_torque_limits(robot)
        self._limits = tuple(limits)
        self._begin()
        self.reset()
        warn_of_bodies(robot, self._limits, self._warned)

    def __setattr__(self, name: str, value: Any) -> None:
        checks.settable("the shield", name, value, ("limits",))
        super().__setattr__(name, value)

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Limits that every command keeps.

        They are set while the arm is at rest: a moving arm may be unable to keep the new ones. The
        next step then begins at the measured positions; a halt stays.

        Raises:
            InvalidInputError: They are set while the arm moves.
        """
        return self._limits

    @limits.setter
    def limits(self, limits: Sequence[Limit]) -> None:
        with self._turn():
            memory, frame = self._kept
            layout = self.layout(frame)
            if motion_of(layout.plan, layout.state(memory)).last.any():
                raise InvalidInputError("limits", "are set at rest: halt the arm first", limits)
            halted = self._halted
            before = self._limits
            self._limits = checks.instances("limits", limits, Limit)
            self._layouts.clear()
            try:
                self.reset()
            except BaseException:
                self._limits = before
                raise
            self._halted = halted
            warn_of_bodies(self.robot, self._limits, self._warned)

    def _begin(self) -> None:
        self._lock = threading.RLock()
        self._layouts: dict[str, ArmLayout] = {}

    def _turn(self) -> threading.RLock:
        """Return the lock of the arm's memory.

        Raises:
            InvalidInputError: This thread takes a step: a limit or obstacle in Python that it calls
                has called the shield.
        """
        if self._is_within and self._lock._is_owned():  # type: ignore[attr-defined]
            problem = "is within a step: what the step calls may only read it, or halt it"
            raise InvalidInputError("shield", problem, self)
        return self._lock

    def __getstate__(self) -> dict[str, Any]:
        with self._lock:
            own = vars(self).items()
            return {name: value for name, value in own if name not in ("_lock", "_layouts")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._begin()

    def layout(self, frame: str) -> ArmLayout:
        """Return the layout of the steps for requests of joints and of a frame's twist."""
        with self._lock:
            if frame not in self._layouts:
                self._layouts[frame] = lay_out_shield(self, frame)
            return self._layouts[frame]

    def reset(self, q: ArrayLike | None = None) -> None:
        """Reset to an arm at rest: requests, a halt and the last commands no longer count.

        Args:
            q: Joint positions of the arm [rad], (n,); None: those that the next step measures.
        """
        positions = np.zeros(0) if q is None else checks.joint_positions("q", q, self.robot.dof)
        with self._turn():
            tip = self.robot.tip
            layout = self.layout(tip)
            memory = layout.memory.copy()
            rest_arm(layout.plan, memory, positions)
            scale_speed(layout.plan, memory, self._speed_scale)
            self._kept = Kept(memory, tip)
            self._halted = False

    def halt(self) -> None:
        """Brake at every step from now on, whatever is requested, until `reset`."""
        self._halted = True  # without the lock: a signal handler may interrupt a step

    def scale_speed(self, scale: float) -> None:
        """Let requests use a part of the joints' velocity limits from the next step on.

        The arm comes to that speed within its rates. It stays until the next call, and is no limit:
        joints that answer a twist may be quicker near a singular posture or beside a limit.

        Args:
            scale: The part, from 0, at which the arm comes to rest, to 1.
        """
        self._speed_scale = checks.fraction("scale", scale)
        with self._turn():
            kept = self._kept
            memory = kept.memory.copy()
            scale_speed(self.layout(kept.frame).plan, memory, scale)
            self._kept = kept._replace(memory=memory)

    def send(self, dq: ArrayLike, dt: float | None = None) -> None:
        """Count a velocity as sent to the arm, in place of a step's command.

        Args:
            dq: Joint velocity [rad/s], (n,).
            dt: Period for which it is held [s]; None: the control period.

        Raises:
            InvalidInputError: `dq` has another size, or is not finite; or `dt` is not above 0.
        """
        sent = checks.finite_array("dq", dq, (self.robot.dof,))
        period = self.dt if dt is None else checks.positive("dt", dt)
        with self._turn():
            kept = self._kept
            memory = kept.memory.copy()
            send_arm(self.layout(kept.frame).plan, memory, sent, period, 1.0)
            self._kept = kept._replace(memory=memory)

    @property
    def time(self) -> float:
        """Time of the next step since the first one [s], the clock of the chunks to follow."""
        with self._lock:
            return float(self._state().time)

    def _state(self) -> ArmState:
        """State of the arm after the last step, a view."""
        return self.layout(self._kept.frame).state(self._kept.memory)

    def follow(
        self,
        times: ArrayLike,
        positions: ArrayLike | None = None,
        keep: Literal["time", "path"] = "time",
        *,
        poses: Poses | None = None,
        frame: str | None = None,
        now: float | None = None,
    ) -> dict[int, str]:
        """Follow a chunk of timed joint positions from the next steps on, which need no request.

        The reference is the cubic spline through them. It replaces what was followed from its first
        time on; until then one chunk waits. The arm comes to rest at its last sample. A chunk that
        is all in the past changes nothing: the next command's `reasons` say so.

        Args:
            times: Time of each sample [s], (m,), rising, m at most 64.
            positions: Joint positions of each [rad], (m, n). If some are not finite, the arm
                brakes.
            keep: What is kept where the samples are too quick for the joints: their ``"time"``, or
                their ``"path"``, later.
            poses: Or a frame's positions [m], (m, 3), with quaternions w, x, y, z, (m, 7), or as
                homogeneous matrices, (m, 4, 4); or a mapping of several frames' names to theirs.
                Joint positions are found from those of the pose before, in about 1 ms each.
            frame: Name of the poses' frame; None stands for the tip.
            now: Present time on the clock of `times` [s]; None: they are on the clock `time`.

        Returns:
            Numbers of the poses that are left out, and why: out of reach, or from the one before
            too fast for a joint's velocity limit.

        Raises:
            InvalidInputError: A shape is wrong, times do not rise, samples are too many, or poses
                come before the first step and `reset`. Nothing is then changed.
            NotFoundError: The robot has no frame of that name.
        """
        mode = KEEPS[checks.one_of("keep", keep, tuple(KEEPS))]
        chunk = self._chunk(times, positions, poses, frame)
        if poses is None:
            self._warn_of_degrees(chunk.positions[np.abs(chunk.positions).max(axis=1).argmax()])
        with self._turn():
            if now is not None:
                ahead = self.time - checks.finite("now", now)
                chunk = chunk._replace(times=chunk.times + ahead)
            self._keep(chunk, mode)
        return chunk.left_out

    def _chunk(
        self,
        times: ArrayLike,
        positions: ArrayLike | None,
        poses: Poses | None,
        frame: str | None,
    ) -> PoseChunk:
        """Return the samples of a chunk as joint positions; those of poses are solved for."""
        t = checked_times(times, self.samples)
        if positions is not None and poses is None:
            points = checks.array("positions", positions, (t.size, self.robot.dof))
            return PoseChunk(t, points, np.arange(t.size), {})
        if positions is not None or poses is None:
            raise InvalidInputError("positions, poses", "pass exactly one", (positions, poses))
        arm = self._state()
        if not arm.has_begun:
            problem = "need a step, or a reset to a posture, before"
            raise InvalidInputError("poses", problem, poses)
        return solve_poses(self.robot, t, poses, arm.positions.copy(), frame)

    def _keep(self, chunk: PoseChunk, mode: int) -> None:
        """Keep the samples of a chunk, if there are any, for the next steps."""
        if chunk.times.size == 0:
            return
        check_clock(chunk.times, self.time)
        kept = self._kept
        plan = self.layout(kept.frame).plan
        memory = kept.memory.copy()
        follow_arm(plan, memory, chunk.times, chunk.positions, mode)
        self._kept = kept._replace(memory=memory)

    def preview(
        self,
        times: ArrayLike,
        positions: ArrayLike | None = None,
        keep: Literal["time", "path"] = "time",
        *,
        poses: Poses | None = None,
        frame: str | None = None,
    ) -> Preview:
        """Forecast lag and errors of a chunk, by taking its steps without an arm.

        Nothing changes. It takes as long as that many steps (20 to 100 us each); other steps wait
        for it. Bodies of bounded speed grow older meanwhile, as without news of them.

        Args:
            times: Time of each sample [s], (m,), as for `follow`.
            positions: Joint positions of each [rad], (m, n).
            keep: What is kept where the samples are too quick.
            poses: Or the poses of a frame, as for `follow`.
            frame: Name of the frame.

        Raises:
            InvalidInputError: As for `follow`; or no step has been taken nor a posture `reset` to.
            NotFoundError: The robot has no frame of that name.
        """
        mode = KEEPS[checks.one_of("keep", keep, tuple(KEEPS))]
        chunk = self._chunk(times, positions, poses, frame)
        with self._turn():
            kept = self._kept
            rehearsal = Rehearsal(chunk.times, chunk.positions)
            dt = None if self.longest_period is None else self.dt
            try:  # steps that do not count
                self._keep(chunk, mode)
                while rehearsal.goes_on:
                    arm = self._state()
                    pending = np.zeros(self.robot.dof)
                    add_pending(arm, self.delay, pending)
                    command = self.step(arm.positions - pending, dt=dt)
                    own = follow_of(command.layout.plan, command.state)
                    rehearsal.take(own, arm, command.state, command.active_limits)
            finally:
                self._kept = kept
        return rehearsal.result.among(chunk.places, chunk.left_out)

    def warm_up(self, q: ArrayLike, frames: Sequence[str] = ()) -> None:
        """Lay the programs out ahead, so that the first step is as quick as the others.

        Args:
            q: Joint positions of the first step [rad], (n,).
            frames: Names of the frames whose twists will be requested.
        """
        with self._turn():
            kept = self._kept
            try:  # steps that do not count
                self.step(q, np.zeros(self.robot.dof))
                for frame in checks.names("frames", frames):
                    self.step(q, twist=np.zeros(TWIST), frame=frame)
            finally:
                self._kept = kept

    def step(
        self,
        q: ArrayLike | None,
        dq: ArrayLike | None = None,
        *,
        twist: ArrayLike | None = None,
        position: ArrayLike | None = None,
        time: float | None = None,
        lead: int | None = None,
        frame: str | None = None,
        people: ArrayLike | Sequence[Any] | None = None,
        obstacles: ArrayLike | Mapping[str, Any] | None = None,
        age: float | None = None,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> ShieldCommand:
        """Compute the command that is closest to a request.

        Without a request the last one counts, until it is older than `timeout`. Periods are stated
        as for `Controller.step`.

        Args:
            q: Measured joint positions [rad], (n,); None: they could not be read; the arm brakes.
            dq: Requested joint velocity [rad/s], (n,).
            twist: Or the requested linear [m/s] and angular [rad/s] velocity of a frame along the
                base's axes, (6,).
            position: Or the requested joint positions [rad], (n,). A joint is there where its
                commanded or its measured position is, or between them. With a time or a lead they
                are those of a stream, which the arm passes through.
            time: Time at which they were sampled [s], on a clock of their sender; None: now.
            lead: Samples by which a stream is continued beyond the last one, 0, 1 (also None) or 2:
                the arm is 2 - lead sampling periods late.
            frame: Name of the twist's frame; None stands for the tip.
            people: All bodies in the field as a sensor saw them: both ends and the radius, with the
                error of the place, of each [m], tuples (a, b, radius) or (k, 7). [] is nobody in
                the field, None no news. What has no meaning is none: the arm comes to rest.
            obstacles: Present centres of the k obstacles [m], (k, 3); None: they are where they
                were, or where their velocities have led them. Or the place of each body with a
                speed that was seen, by its name: the center of a sphere or a box [m], (3,), center
                and rotation of a box, a capsule's ends.
            age: Time since they were seen [s]; None: the latency.
            dt: Period for which this command will be held [s]; without a `longest_period` at most
                the control period.
            elapsed: Time since the last step [s], for which the last command was held.

        Raises:
            InvalidInputError: `q` or a request has a wrong shape, `q` is not finite, or None at the
                first step, there are several requests, or a period is wrong. Nothing is then
                changed.
            NotFoundError: The robot has no frame of that name.
        """
        kind, request = one_request(self._shape, dq, twist, position)
        measured = self._measured(q)
        with self._lock:
            kept = self._kept
            memory = kept.memory.copy()
            last = kept.frame
            seen = (frame or self.robot.tip) if kind is Request.TWIST else last
            layout = self._layouts.get(seen) or self.layout(seen)
            plan = layout.plan
            step = layout.step
            if kind in self._unseen:
                self._warn(measured, kind, request)
            periods = step.plan.timing
            if step.varies or not dt is elapsed is None:
                periods = periods_of_step(self, self._warned, dt, elapsed)
                check_held(self, dt)
            if self._halted:
                halt_arm(plan, memory)
            if not obstacles is people is None:
                self._see(layout, memory, people, obstacles, age)
            if not time is lead is None:
                self._stream(plan, memory, kind, request, time, lead)
                kind = Request.NONE
            inputs = ArmInput(measured, kind, request, dt or 0.0, elapsed or 0.0, 0.0)
            data, action = self._answer(layout, memory, inputs, periods)
            command = ShieldCommand(data, layout, ACTION_OF[action], periods, memory)
            # Last: an interrupted step changes nothing.
            object.__setattr__(self, "_kept", Kept(memory, seen))
            return command

    def _see(
        self, layout: ArmLayout, memory: Vector, people: Any, obstacles: Any, age: Any
    ) -> None:
        """Take where obstacles are, or what was seen of bodies of bounded speed."""
        bodies = None
        if isinstance(obstacles, Mapping):
            bodies = obstacles
        elif obstacles is not None:
            place(layout, memory[np.newaxis], obstacles)
        if people is not None or bodies is not None:
            see(layout.plan, memory, News(separation_in(self._limits), people, bodies, age))

    def _stream(
        self,
        plan: ArmPlan,
        memory: Vector,
        kind: Request,
        request: Vector,
        time: float | None,
        lead: int | None,
    ) -> None:
        """Take a sample of a stream (n,) [rad], of a time [s] or of now, into an arm's memory."""
        mode = stream_mode(kind, lead, self.samples)
        stamp = np.array([self.time if time is None else checks.finite("time", time)])
        follow_arm(plan, memory, stamp, request[np.newaxis], mode)

    def _answer(
        self, layout: ArmLayout, memory: Vector, inputs: ArmInput, periods: Periods
    ) -> tuple[Vector, int]:
        """Take a step of a memory, which is overwritten; return its log and the action."""
        plan = layout.plan
        begin_step(plan, memory, inputs)
        kinematics = layout.step.program.kinematics
        positions = memory[layout.positions]
        kinematics.update(positions)
        # A step that is refused brakes whatever the parts say, which may be what is broken.
        if layout.called and not is_refused(layout.state(memory)):
            self._call_parts(layout, memory, periods)
        data = np.empty(plan.width)
        action = finish_step(plan, memory, inputs, data, OWN_NETWORK)
        if action == INVALID:
            checks.joint_positions("q", positions, self.robot.dof)
        return data, action

    def _call_parts(self, layout: ArmLayout, memory: Vector, periods: Periods) -> None:
        """Call the limits and obstacles in Python of a step whose kinematics are computed."""
        plan = layout.plan
        arm = layout.state(memory)
        t = float(arm.time)
        self._turn()
        self._is_within = True
        try:
            last = motion_of(plan, arm).last.copy()
            program = layout.step.program
            program.refresh(arm.positions.copy(), last, NO_TARGETS, t, periods.expected)
            if own_movers(program):
                avoidance = avoidance_of(self) or CollisionAvoidance()
                begun = layout.state(layout.memory).obstacles
                shifts = [obstacle.shift(t) for obstacle in avoidance.obstacles]
                place_arm(plan, memory, begun + np.array(shifts))
        finally:
            self._is_within = False

    def _measured(self, q: ArrayLike | None) -> Vector:
        """Return measured joint positions (n,); NaN for None, which the first step refuses."""
        if checks.is_plain(q, self._shape) and q.dot(q) <= FARTHEST:
            return q
        if q is not None:
            return checks.joint_positions("q", q, self.robot.dof)
        if not self._state().has_begun:
            raise InvalidInputError("q", "is needed at the first step")
        return np.full(self.robot.dof, np.nan)

    def _warn(self, measured: Vector, kind: Request, request: Vector) -> None:
        """Warn of what is most likely wrong at the first step, and at the first one of positions.

        Args:
            measured: Measured joint positions [rad], (n,).
            kind: Kind of the request.
            request: Its numbers.
        """
        found: list[str] = []
        if len(self._unseen) > 1 and np.isfinite(measured).all():
            start = Configuration(self.robot, measured)
            program = self.layout(self.robot.tip).step.program
            found += setup_warnings(program, start, 0.0, self.dt, "converged")
            self._unseen = tuple({Request.POSITION} & {*self._unseen})
            found += long_times({"timeout": self.settings.timeout, "delay": self.delay})
        for message in found:
            warn_caller(message)
        if kind is Request.POSITION:
            self._warn_of_degrees(request)

    def _warn_of_degrees(self, request: Vector) -> None:
        """Warn of requested joint positions (n,) if they are the first, and likely in degrees."""
        if Request.POSITION not in self._unseen:
            return
        self._unseen = tuple({*self._unseen} - {Request.POSITION})
        problem = self.robot.outside(request)
        if problem and self.robot.in_degrees(request):
            warn_caller(f"the requested posture {problem}")


def check_held(loop: Any, dt: float | None) -> None:
    """Refuse a stated period [s] above that of a shield or shields whose periods are constant."""
    if dt is None or loop.longest_period is not None:
        return
    if checks.positive("dt", dt) > loop.dt * (1.0 + SLACK):
        problem = f"must be at most {loop.dt:g} s, the control period, without a longest_period"
        raise InvalidInputError("dt", problem, dt)


def _separation(
    free: tuple[Obstacle, ...],
    told: tuple[int, float, float | None, float, float],
    distance: float,
    settings: ArmSettings,
) -> list[Limit]:
    """Return the limit that keeps away from bodies of bounded speed, if there are any.

    Args:
        free: Bodies that are named.
        told: `Shield`'s people, people_speed, field, latency and contact_speed.
        distance: Distance to keep [m].
        settings: Settings of the shield.
    """
    people, people_speed, field, latency, contact_speed = told
    if not (checks.integer("people", people, 0) or free):
        return []
    if people and field is None:
        problem = "is needed with people: how far from the base the sensor sees everybody"
        raise InvalidInputError("field", problem)
    if contact_speed and settings.longest:
        problem = "needs a constant period, for the time in which an arm is quick"
        raise InvalidInputError("contact_speed", problem, contact_speed)
    radius = checks.positive("field", field) if people else math.inf
    delay = settings.delay
    return [Separation(free, people, people_speed, radius, latency, contact_speed, distance, delay)]
