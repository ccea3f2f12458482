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
    arm_state,
    halt_arm,
    motion_of,
    place_arm,
    rest_arm,
    step_arms,
)
from iiwa_dnn.control.requests import TWIST, Request
from iiwa_dnn.control.shield import Margin, Shield, ShieldCommand, one_request
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.periods import stated_periods

BLOCK = 64
"""Arms that a thread takes at a time."""


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
            settings: As for `Shield`.

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
        self._shield = copy.deepcopy(shield)
        self.robot = robot = shield.robot
        self.count = checks.integer("count", count, 1)
        self.dt = self._shield.dt
        self.frame = frame or robot.tip
        self.threads = checks.integer("threads", threads or os.cpu_count() or 1, 1)
        self._begin()
        # Rows of whole cache lines: no two threads write into one.
        own = self._layout.memory
        self._memories = np.zeros((self.count, -(-own.size // 8) * 8))
        self._memories[:, : own.size] = own

    def _begin(self) -> None:
        self._layout = self._shield.layout(self.frame)
        self._lock = threading.RLock()
        self._pool: tuple[int, ThreadPoolExecutor] | None = None

    def __getstate__(self) -> dict[str, Any]:
        with self._lock:
            own = {**vars(self), "_memories": self._memories.copy()}
        return {name: own[name] for name in own if name not in ("_layout", "_lock", "_pool")}

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
            InvalidInputError: An array has a wrong shape, there are several requests, or a period
                is wrong; no arm has then taken a step.
        """
        shape = (self.count, self.robot.dof)
        kind, request = one_request(dq, twist, position)
        if request is None:
            request = np.zeros(shape)
        width = TWIST if kind is Request.TWIST else shape[1]
        stated_periods(self.dt, self._shield.longest_period, dt, elapsed)
        inputs = ArmInputs(
            _numbers("q", q, shape),
            kind,
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
            clipped = np.zeros(self.count, dtype=np.int64)
            self._run(inputs, ArmOutputs(out.dq, out.next_q, clipped, out.reason))
            np.not_equal(clipped, 0, out=out.clipped)
        return out

    def _flags(self, name: str, value: ArrayLike | None) -> NDArray[np.int64]:
        """Return truths (N,) as integers."""
        if value is None:
            return np.ones(self.count, dtype=np.int64)
        flags = np.asarray(value)
        if flags.shape != (self.count,) or flags.dtype.kind != "b":
            raise InvalidInputError(name, f"must be booleans of shape ({self.count},)", value)
        return flags.astype(np.int64)

    def _place(self, obstacles: ArrayLike) -> None:
        plan = self._layout.plan
        shape = (plan.sizes.obstacles, 3)
        places = np.asarray(obstacles, dtype=np.float64)
        if places.shape not in (shape, (self.count, *shape)):
            problem = f"must have shape {shape}, or that for each arm"
            raise InvalidInputError("obstacles", f"{problem}, not {places.shape}", obstacles)
        if not np.isfinite(places).all():
            raise InvalidInputError("obstacles", "must be finite", obstacles)
        for i, centers in enumerate(np.broadcast_to(places, (self.count, *shape))):
            place_arm(plan, self._memory(i), np.ascontiguousarray(centers))

    def _run(self, inputs: ArmInputs, out: ArmOutputs) -> None:
        """Let threads take the blocks of arms one after another."""
        workers = min(self.threads, -(-self.count // BLOCK))
        blocks = counter(0, BLOCK if workers > 1 else self.count)

        def work() -> None:
            for first in iter(lambda: next(blocks), None):
                last = min(first + (BLOCK if workers > 1 else self.count), self.count)
                if first >= self.count:
                    return
                step_arms(self._layout.plan, self._memories, inputs, out, first, last)

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
                rest_arm(self._layout.plan, self._memory(i), positions[i])

    def halt(self, mask: ArrayLike | None = None) -> None:
        """Let arms brake from now on, whatever is requested, until `reset`."""
        with self._lock:
            for i in self._chosen(mask):
                halt_arm(self._layout.plan, self._memory(i))

    def _memory(self, i: int) -> Vector:
        return self._memories[i, : self._layout.memory.size]

    def _command(self, i: int) -> ShieldCommand:
        """Return the last command of arm i without its log."""
        plan = self._layout.plan
        memory = self._memory(i)
        layout = self._layout.step.log_layout
        last = motion_of(plan, arm_state(plan, memory)).last
        return ShieldCommand(last, plan, memory, np.zeros(0), layout, plan.step.timing)

    def active_limits(self, i: int) -> tuple[str, ...]:
        """Name the active limits of arm i's last command, as `ShieldCommand.active_limits`."""
        with self._lock:
            return self._command(i).active_limits

    def margin(self, i: int) -> Margin:
        """Return the distances of arm i at the positions that its last command starts from."""
        with self._lock:
            return self._command(i).margin

    def stopping_time(self, i: int) -> float:
        """Return the time of arm i's motion to rest from its last command [s]."""
        with self._lock:
            return self._command(i).stopping_time


def _numbers(name: str, value: ArrayLike, shape: Sequence[int]) -> Matrix:
    """Return numbers of a shape as float64 without gaps; they may be NaN."""
    found = np.asarray(value)
    if found.dtype.kind not in "fiu" or found.shape != tuple(shape):
        problem = f"must be numbers of shape {tuple(shape)}, not {found.shape}"
        raise InvalidInputError(name, problem, value)
    return np.ascontiguousarray(found, dtype=np.float64)
