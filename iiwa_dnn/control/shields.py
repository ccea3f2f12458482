"""Shields of many arms in one call, for vector environments and fleets."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Mapping, Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.control.arm_layout import ArmLayout
from iiwa_dnn.control.chunks import KEEPS, check_clock, checked_times, stream_mode
from iiwa_dnn.control.many import ManyArms
from iiwa_dnn.control.requests import one_request
from iiwa_dnn.control.shield import Shield, check_held, place
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.periods import stated_periods
from iiwa_dnn.step.memory import ArmInput, follow_arm, motion_of, scale_speed
from iiwa_dnn.step.samples import Mode


class ShieldsCommand(NamedTuple):
    """Decisions of one step of N shields.

    Attributes:
        dq: Joint velocities [rad/s], (N, n), within the limits.
        next_q: Joint positions at the end of the period [rad], (N, n).
        clipped: Whether each command differs from its request, (N,).
        reason: The first `Reason` of each command, (N,).
        shields: The shields.
    """

    dq: Matrix
    next_q: Matrix
    clipped: NDArray[np.bool_]
    reason: NDArray[np.int64]
    shields: Shields

    def active_limits(self, i: int) -> tuple[str, ...]:
        """Name the active limits of the last command of arm i."""
        return self.shields.active_limits(i)


class Shields(ManyArms):
    """Shields of N arms of one kind, whose steps are one call.

    Each arm is answered as by a `Shield` whose kinematics are those of the exported C
    (`write_kinematics`), to the last bit.

    Attributes:
        frame: Frame of twists.
    """

    frame: str

    def __init__(
        self,
        robot: Robot | Shield,
        count: int = 1,
        *,
        frame: str | None = None,
        threads: int | None = None,
        **settings: Any,
    ) -> None:
        """Take a robot and a number of arms.

        Args:
            robot: The robot; or a `Shield`, whose limits and settings all arms have.
            count: Number of arms.
            frame: Frame whose twists will be requested; None stands for the tip.
            threads: Threads of a step; None: as many as there are processors.
            settings: Arguments of `Shield`, with a robot; `samples` are 0 if they are not stated.

        Raises:
            InvalidInputError: An argument is out of range, or the step of many arms would call a
                limit or an obstacle in Python; the message names it.
            NotFoundError: There is no setting, frame, link or obstacle of a name.
        """
        checks.known("setting of a shield", settings, inspect.signature(Shield).parameters)
        if isinstance(robot, Shield) and not settings:
            shield = copy.deepcopy(robot)
        else:
            shield = Shield(robot, **({"samples": 0} | settings))  # type: ignore[arg-type]
        checks.fix(self, frame=frame or shield.robot.tip)
        self._begin(shield, count, threads)

    @property
    def _layout(self) -> ArmLayout:
        return self._made.layout(self.frame)  # type: ignore[no-any-return]

    def step(
        self,
        q: ArrayLike,
        dq: ArrayLike | None = None,
        *,
        twist: ArrayLike | None = None,
        position: ArrayLike | None = None,
        time: float | None = None,
        lead: int | None = None,
        given: ArrayLike | None = None,
        obstacles: ArrayLike | Mapping[str, Any] | None = None,
        people: ArrayLike | Sequence[Any] | None = None,
        age: float | None = None,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> ShieldsCommand:
        """Compute the commands that are closest to requests.

        For an arm without a new request the last one counts, until it is older than `timeout`. An
        arm whose request or joint positions are not finite brakes.

        Args:
            q: Measured joint positions [rad], (N, n).
            dq: Requested joint velocities [rad/s], (N, n).
            twist: Or the requested linear [m/s] and angular [rad/s] velocities of the frame,
                (N, 6).
            position: Or the requested joint positions [rad], (N, n).
            time: Time at which they were sampled [s], for a stream, as for `Shield.step`.
            lead: Samples by which a stream is continued beyond the last one.
            given: Whether each arm has a new request, (N,); None: all have.
            obstacles: Present centres of the k obstacles [m], (k, 3) or (N, k, 3); None: they are
                where they were, or where their velocities have led them. Or the place of bodies
                with a speed by their names, as for `Shield.step`.
            people: A frame of people, as for `Shield.step`, for all arms; or a list of N frames,
                each or None for an arm.
            age: Time since they were seen [s]; None: the latency.
            dt: Period for which the commands will be held [s].
            elapsed: Time since the last step [s].

        Raises:
            InvalidInputError: An array has a wrong shape, there are several requests, or a period
                is wrong; no arm has then taken a step.
        """
        shape = (self.count, self.robot.dof)
        kind, request = one_request(shape, dq, twist, position)
        stated_periods(self.dt, self.longest_period, dt, elapsed)
        check_held(self, dt)
        measured = checks.array("q", q, shape)
        inputs = ArmInput(measured.ravel(), kind, request.ravel(), dt or 0.0, elapsed or 0.0, 0.0)
        kinds = self._flags("given", given) * kind
        layout = self._layout
        with self._made._lock:
            if kind in self._made._unseen:
                self._made._warn(measured[0], kind, request[0])
            if isinstance(obstacles, Mapping):
                self._see(people, obstacles, age)
            elif people is not None:
                self._see(people, None, age)
            if obstacles is not None and not isinstance(obstacles, Mapping):
                place(layout, self._memories, obstacles)
            if not time is lead is None:
                mode = stream_mode(kind, lead, self._made.samples)
                stamp = None if time is None else np.full(1, checks.finite("time", time))
                self._keep(stamp, request, mode, kinds > 0)
                kinds = 0 * kinds
            self._take_steps(inputs, kinds)
            arms = layout.state(self._memories)
            return ShieldsCommand(
                motion_of(layout.plan, arms).last.copy(),
                arms.positions.copy(),
                np.asarray(arms.is_clipped),
                np.argmax(arms.reasons, axis=1),
                self,
            )

    def follow(
        self,
        times: ArrayLike,
        positions: ArrayLike,
        keep: Literal["time", "path"] = "time",
        *,
        now: float | None = None,
        given: ArrayLike | None = None,
    ) -> None:
        """Follow a chunk of timed joint positions from the next steps on, as `Shield.follow`.

        Args:
            times: Time of each sample [s], (m,), rising.
            positions: Joint positions of each arm at each [rad], (N, m, n).
            keep: What is kept where the samples are too quick for the joints.
            now: Present time on the clock of `times` [s]; None: they are on each arm's clock.
            given: Whether each arm has a chunk, (N,); None: all have.

        Raises:
            InvalidInputError: A shape is wrong, times do not rise, or samples are too many. Nothing
                is then changed.
        """
        t = checked_times(times, self._made.samples)
        mode = KEEPS[checks.one_of("keep", keep, tuple(KEEPS))]
        points = checks.array("positions", positions, (self.count, t.size, self.robot.dof))
        each = points.reshape(-1, self.robot.dof)
        self._made._warn_of_degrees(each[np.abs(each).max(axis=1).argmax()])
        with self._made._lock:
            self._keep(t, points, mode, self._flags("given", given) > 0, now)

    def _keep(
        self, times: Vector | None, points: Any, mode: int, given: Any, now: float | None = None
    ) -> None:
        """Let arms follow samples; without times that of the present."""
        layout = self._layout
        for i in np.flatnonzero(given):
            memory = self._memories[i]
            clock = float(layout.state(memory).time)
            own = np.full(1, clock) if times is None else times
            own = own + (0.0 if now is None else clock - now)
            if mode < Mode.STREAM:
                check_clock(own, clock)
            follow_arm(layout.plan, memory, own, points[i].reshape(own.size, -1), mode)

    def scale_speed(self, scale: float, mask: ArrayLike | None = None) -> None:
        """Let requests use a part of the joints' velocity limits, as `Shield.scale_speed`.

        Args:
            scale: The part, from 0 to 1.
            mask: Whether each arm is meant, (N,); None: all are.
        """
        part = checks.fraction("scale", scale)
        with self._made._lock:
            for i in np.flatnonzero(self._flags("mask", mask)):
                scale_speed(self._layout.plan, self._memories[i], part)
