"""Shields of many arms in one call, for vector environments and fleets."""

from __future__ import annotations

import copy
import os
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from itertools import count as counter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.control.arms import (
    ArmInputs,
    ArmOutputs,
    ArmPlan,
    ArmProgram,
    ArmSettings,
    ArmState,
    Request,
    halt_arm,
    margin_of,
    rest_arm,
    step_arms,
    stopping_time_of,
)
from iiwa_dnn.control.controller import EXCEEDED, Controller
from iiwa_dnn.control.shield import (
    IS_CUT,
    JOINTS,
    REASONS,
    RESYNCHRONISED,
    SINGULAR,
    TWIST,
    Margin,
    Reason,
    Shield,
)
from iiwa_dnn.control.state import MotionState
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.naming import KINDS, active_limits, describe
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.robot.kinematics_kernel import model_tables
from iiwa_dnn.schemes.collisions import avoidance_of
from iiwa_dnn.schemes.limits import MotionLimits, stated_periods
from iiwa_dnn.schemes.scene import Body, scene_views

BLOCK = 64
"""Arms that a thread takes at a time."""

WORDS = (*REASONS, "q not finite", RESYNCHRONISED, IS_CUT, EXCEEDED, SINGULAR)
"""Reasons in words, by their codes."""


def arm_plan(shield: Shield, frame: str) -> tuple[ArmPlan, Vector]:
    """Lay the step of an arm out, for requests of joints and of one frame's twist.

    Returns:
        The plan, and the memory of an arm that has not begun.
    """
    robot = shield.robot
    joint = shield.controller(JOINTS)
    twist = shield.controller(frame)
    programs = [joint.program, twist.program]
    frames = dict.fromkeys(k for each in programs for k in each.kinematics.frame_ids)
    own = _arm_program(joint)
    other = _arm_program(twist)
    places = _places(shield)
    n, m, _ = programs[0].sizes
    sizes = [
        robot.dof,
        max(robot.dof, TWIST),
        joint.control_layout.width,
        joint.solver.state_for(programs[0].sizes).size,
        own.step.fallback.size,
        other.step.fallback.size,
        places.size,
        n + m,
    ]
    longest = shield.longest_period or 0.0
    own_settings = shield.settings
    settings = np.array([shield.dt, longest, own_settings.timeout, own_settings.tracking_error])
    plan = ArmPlan(
        model_tables(robot, [*frames]),
        own,
        other,
        shield.motion,
        np.array(robot.limits[:2]),
        ArmSettings.of(settings),
        np.array(sizes, dtype=np.int64),
    )
    memory = ArmState.zeros(*sizes)
    memory.obstacles[:] = places
    rest_arm(plan, memory.numbers, np.zeros(0))
    return plan, memory.numbers


def _arm_program(controller: Controller) -> ArmProgram:
    """Lay the step of one controller of a shield out."""
    step = controller.control_layout
    parts = step.program.parts
    rates = [k for k, part in enumerate(parts) if isinstance(part, MotionLimits)]
    return ArmProgram(step.plan, step.log_layout.width, *(rates or [-1]))


def _places(shield: Shield) -> Vector:
    """Return the centres of a shield's obstacles at the beginning [m], three numbers each."""
    avoidance = avoidance_of(shield)
    if avoidance is None:
        return np.zeros(0)
    bodies = scene_views(avoidance.scene(shield.robot).constants, shield.robot.dof).bodies
    first = len(bodies) - len(avoidance.obstacles)
    return np.array([Body.of(body).center for body in bodies[first:]]).ravel()


def limit_words(shield: Shield) -> list[str]:
    """Name what may keep a shield's command from a request, by codes.

    They are the reasons, then for each joint the lower and the upper bound of each of
    `naming.KINDS`, then the rows.
    """
    settings: dict[str, Any] = shield.controller(JOINTS).program.settings()
    rows = settings["rows"]
    codes = [sign * kind for kind in range(1, 1 + len(KINDS)) for sign in (-1, 1)]
    n = shield.robot.dof
    bounds = [
        limit
        for joint in range(n)
        for code in codes
        for limit in active_limits(
            settings, code * np.eye(n, dtype=int)[joint], np.zeros(len(rows))
        )
    ]
    return [*WORDS, *map(describe, [*bounds, *rows])]


class ShieldsCommand(NamedTuple):
    """Decisions of one step of N shields.

    Attributes:
        dq: Joint velocities [rad/s], (N, n), within the limits.
        next_q: Joint positions at the end of the period [rad], (N, n).
        clipped: Whether each command differs from its request, (N,).
        reason: The first `Reason` of each command beside limits, (N,).
        shields: The shields.
    """

    dq: Matrix
    next_q: Matrix
    clipped: NDArray[np.bool_]
    reason: NDArray[np.int64]
    shields: Shields

    def active_limits(self, i: int) -> tuple[str, ...]:
        """Name what keeps the last command of arm i from its request."""
        return self.shields.active_limits(i)


class Shields:
    """Shields of N arms of one kind, whose steps are one call.

    Each arm is answered as by a `Shield` of its own whose kinematics are those of the exported C
    (`write_kinematics`), to the last bit. The calls of several threads wait for each other.

    Attributes:
        robot: The robot, n joints.
        count: Number of arms, N.
        dt: Control period [s].
        frame: Frame of twists.
        threads: Threads that a step takes at most.
    """

    def __init__(
        self,
        robot: Robot,
        count: int,
        *,
        frame: str | None = None,
        threads: int | None = None,
        **settings: Any,
    ) -> None:
        """Take a robot and a number of arms.

        Args:
            robot: The robot.
            count: Number of arms.
            frame: Frame of the twists that will be requested; None stands for the tip.
            threads: Threads of a step; None: as many as there are processors.
            settings: As for `Shield`, without `delay`.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
            NotFoundError: There is no frame, link or obstacle of a name.
        """
        self._set(Shield(robot, **settings), count, frame, threads)

    @classmethod
    def of(cls, shield: Shield, count: int, frame: str | None = None) -> Shields:
        """Return shields with the settings of one, at rest."""
        own = cls.__new__(cls)
        own._set(shield, count, frame, None)
        return own

    def _set(self, shield: Shield, count: int, frame: str | None, threads: int | None) -> None:
        if shield.delay > 0.0:
            raise InvalidInputError("delay", "is for one shield", shield.delay)
        self._shield = copy.deepcopy(shield)
        self.robot = robot = shield.robot
        self.count = checks.integer("count", count, 1)
        self.dt = self._shield.dt
        self.frame = frame or robot.tip
        self.threads = checks.integer("threads", threads or os.cpu_count() or 1, 1)
        self._begin()
        # Rows of whole cache lines: no two threads write into one.
        width = -(-self._memory.size // 8) * 8
        self._memories = np.zeros((self.count, width))
        self._memories[:, : self._memory.size] = self._memory
        self._none = np.zeros((self.count, 1))
        self._given = np.ones(self.count, dtype=np.int64)
        self._clipped = np.zeros(self.count, dtype=np.int64)

    def _begin(self) -> None:
        self._plan, self._memory = arm_plan(self._shield, self.frame)
        self._lock = threading.RLock()
        self._pool: tuple[int, ThreadPoolExecutor] | None = None

    def __getstate__(self) -> dict[str, Any]:
        with self._lock:
            own = {**vars(self), "_memories": self._memories.copy()}
        return {name: own[name] for name in own if name not in ("_plan", "_lock", "_pool")}

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        self._begin()

    def step(
        self,
        q: ArrayLike,
        dq: ArrayLike | None = None,
        *,
        twist: ArrayLike | None = None,
        position: ArrayLike | None = None,
        given: ArrayLike | None = None,
        obstacles: ArrayLike | None = None,
        dt: float | None = None,
        elapsed: float | None = None,
        out: ShieldsCommand | None = None,
    ) -> ShieldsCommand:
        """Compute the commands that are closest to requests.

        An arm without a new request goes on with its last one, until that is older than `timeout`.
        An arm whose request is not finite, or whose joint positions are not, brakes.

        Args:
            q: Measured joint positions [rad], (N, n).
            dq: Joint velocities that are requested [rad/s], (N, n).
            twist: Or linear [m/s] and angular [rad/s] velocities of the frame, (N, 6).
            position: Or joint positions to reach [rad], (N, n).
            given: Whether each arm has a new request, (N,); None: all have.
            obstacles: Where the centres of the k obstacles are [m], (k, 3) or (N, k, 3); None:
                where they were.
            dt: Period for which the commands will be held [s].
            elapsed: Time since the last step [s].
            out: A command of these shields whose arrays are overwritten; None: new ones are made.

        Raises:
            InvalidInputError: An array has a wrong shape, there pass exactly one of dq, twist,
                position, or a period is wrong; no arm has then taken a step.
        """
        shape = (self.count, self.robot.dof)
        kinds = {Request.VELOCITY: dq, Request.TWIST: twist, Request.POSITION: position}
        found = [(kind, own) for kind, own in kinds.items() if own is not None]
        if len(found) > 1:
            raise InvalidInputError("dq, twist, position", "pass exactly one of them")
        kind, request = found[0] if found else (Request.NONE, self._none)
        width = {Request.NONE: 1, Request.TWIST: TWIST}.get(kind, shape[1])
        stated_periods(self.dt, self._shield.longest_period, dt, elapsed)
        inputs = ArmInputs(
            _numbers("q", q, shape),
            int(kind),
            _numbers("request", request, (self.count, width)),
            self._flags("given", given),
            dt or 0.0,
            elapsed or 0.0,
        )
        if out is None:
            empty = np.zeros(self.count, dtype=bool)
            reasons = np.zeros(self.count, dtype=np.int64)
            out = ShieldsCommand(np.empty(shape), np.empty(shape), empty, reasons, self)
        with self._lock:
            if obstacles is not None:
                self._place(obstacles)
            self._run(inputs, ArmOutputs(out.dq, out.next_q, self._clipped, out.reason))
            np.not_equal(self._clipped, 0, out=out.clipped)
        return out

    def _flags(self, name: str, value: ArrayLike | None) -> NDArray[np.int64]:
        """Return truths (N,) as integers."""
        if value is None:
            return self._given
        flags = np.asarray(value)
        if flags.shape != (self.count,) or flags.dtype.kind != "b":
            raise InvalidInputError(name, f"must be booleans of shape ({self.count},)", value)
        return flags.astype(np.int64)

    def _place(self, obstacles: ArrayLike) -> None:
        size = int(self._plan.sizes[6])
        places = np.asarray(obstacles, dtype=np.float64)
        if places.shape not in ((size // 3, 3), (self.count, size // 3, 3)):
            problem = f"must have shape ({size // 3}, 3), or that for each arm"
            raise InvalidInputError("obstacles", f"{problem}, not {places.shape}", obstacles)
        if not np.isfinite(places).all():
            raise InvalidInputError("obstacles", "must be finite", obstacles)
        start = ArmState.columns(*self._plan.sizes.tolist())["obstacles"]
        self._memories[:, start] = places.reshape(-1, size)

    def _run(self, inputs: ArmInputs, out: ArmOutputs) -> None:
        """Let threads take the blocks of arms one after another."""
        workers = min(self.threads, -(-self.count // BLOCK))
        blocks = counter(0, BLOCK if workers > 1 else self.count)

        def work() -> None:
            for first in iter(lambda: next(blocks), None):
                last = min(first + (BLOCK if workers > 1 else self.count), self.count)
                if first >= self.count:
                    return
                step_arms(self._plan, self._memories, inputs, out, first, last)

        if workers > 1:
            others = [self._executor().submit(work) for _ in range(workers - 1)]
            work()
            for each in others:
                each.result()
        else:
            work()

    def _executor(self) -> ThreadPoolExecutor:
        """Return the threads of this process."""
        if self._pool is None or self._pool[0] != os.getpid():
            self._pool = (os.getpid(), ThreadPoolExecutor(self.threads))
        return self._pool[1]

    def _chosen(self, mask: ArrayLike | None) -> Iterator[int]:
        return iter(np.flatnonzero(self._flags("mask", mask)).tolist())

    def reset(self, mask: ArrayLike | None = None, q: ArrayLike | None = None) -> None:
        """Let arms stand at joint positions q (N, n) [rad]; None: where they are measured next.

        Requests and halts are forgotten.

        Args:
            mask: Whether each arm is meant, (N,); None: all are.
            q: The positions.
        """
        positions: Matrix = np.zeros((self.count, 0))
        if q is not None:
            positions = checks.array("q", q, (self.count, self.robot.dof))
        with self._lock:
            for i in self._chosen(mask):
                rest_arm(self._plan, self._memories[i, : self._memory.size], positions[i])

    def halt(self, mask: ArrayLike | None = None) -> None:
        """Let arms brake from now on, whatever is requested, until `reset`."""
        with self._lock:
            for i in self._chosen(mask):
                halt_arm(self._plan, self._memories[i, : self._memory.size])

    def _arm(self, i: int) -> tuple[Vector, ArmState]:
        memory = self._memories[i, : self._memory.size]
        return memory, ArmState.of(memory, *self._plan.sizes.tolist())

    def active_limits(self, i: int) -> tuple[str, ...]:
        """Name the active limits of arm i's last command, as `ShieldCommand.active_limits`."""
        with self._lock:
            _, own = self._arm(i)
            if not own.is_clipped:
                return ()
            reasons = _reasons(own)
            step = self._shield.controller(JOINTS).control_layout
            program = step.program
            names = step.log_layout.names
            n = self.robot.dof
            codes = own.limiting[:n].astype(int)
            words = map(describe, active_limits(names.settings, codes, own.limiting[n:]))
            motion = MotionState.of(own.motion, n, len(program.pairs))
            return (*reasons, *words, *names.conditions(motion.q, motion.least))

    def margin(self, i: int) -> Margin:
        """Return the distances of arm i at the positions that its last command starts from."""
        with self._lock:
            return Margin(*margin_of(self._plan, self._arm(i)[0]))

    def stopping_time(self, i: int) -> float:
        """Return the time of arm i's motion to rest from its last command [s]."""
        with self._lock:
            return float(stopping_time_of(self._plan, self._arm(i)[0]))


def _reasons(own: ArmState) -> list[str]:
    """Return all reasons of an arm's last command, in words."""
    codes = [
        own.asked.reason,
        Reason.Q_NOT_FINITE * own.is_blind,
        Reason.RESYNCHRONISED * own.asked.resynchronised,
        Reason.CUT * own.asked.is_cut,
        Reason.PERIOD_EXCEEDED * own.is_late,
        Reason.SINGULAR * own.is_singular,
    ]
    return [WORDS[code] for code in codes if code]


def _numbers(name: str, value: ArrayLike, shape: Sequence[int]) -> Matrix:
    """Return numbers of a shape as float64 without gaps; they may be NaN."""
    found = np.asarray(value)
    if found.dtype.kind not in "fiu" or found.shape != tuple(shape):
        problem = f"must be numbers of shape {tuple(shape)}, not {found.shape}"
        raise InvalidInputError(name, problem, value)
    return np.ascontiguousarray(found, dtype=np.float64)
