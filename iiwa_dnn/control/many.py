"""Many arms of one kind, whose steps are one call, shared by threads."""

from __future__ import annotations

import os
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.arm_layout import ArmLayout, Margin, see
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.desk import step_arms, write_margins
from iiwa_dnn.control.news import News, is_of_each, separation_in
from iiwa_dnn.control.shield import Shield
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix
from iiwa_dnn.qp.layout import IntVector
from iiwa_dnn.robot import Robot
from iiwa_dnn.step.memory import ArmInput, halt_arm, rest_arm

BLOCK = 64
"""Number of arms that a thread takes at a time."""


@cache
def _pool(process: int, threads: int) -> ThreadPoolExecutor:
    """Return the threads of a process, which a fork has not."""
    return ThreadPoolExecutor(threads)


class ManyArms(checks.Whole):
    """N arms of a shield's kind or a controller's. Threads may share them: calls wait.

    Attributes:
        robot: The robot, n joints.
        count: Number of arms, N.
        dt: Control period [s].
        longest_period: Longest control period where periods vary [s]; None: they are constant.
        threads: Largest number of threads of a step. It alone may be set later.
    """

    robot: Robot
    count: int
    dt: float
    longest_period: float | None
    threads: int
    _made: Any
    _memories: Matrix

    def _begin(self, made: Shield | Controller, count: int, threads: int | None) -> None:
        """Lay out the arms of a shield or controller, which nobody else has.

        Raises:
            InvalidInputError: Their step would call a part, an obstacle or a network in Python.
        """
        checks.fix(
            self,
            robot=made.robot,
            count=checks.integer("count", count, 1),
            dt=made.dt,
            longest_period=made.longest_period,
            _made=made,
        )
        self.threads = threads or os.cpu_count() or 1
        layout = self._layout
        if layout.called:
            kind = type(made).__name__
            problem = f"are in Python: {', '.join(layout.called)}; take a {kind} for each arm"
            raise InvalidInputError("parts", problem, layout.called)
        checks.fix(self, _memories=np.tile(layout.memory, (self.count, 1)))

    @property
    def _layout(self) -> ArmLayout:
        """Layout of the arms' step."""
        raise NotImplementedError

    def __setattr__(self, name: str, value: Any) -> None:
        checks.settable("the arms", name, value, ("threads",))
        super().__setattr__(name, checks.integer(name, value, 1))

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)

    def __getstate__(self) -> dict[str, Any]:
        with self._made._lock:
            return {**vars(self), "_memories": self._memories.copy()}

    def _see(self, people: Any, bodies: Mapping[str, Any] | None, age: float | None) -> None:
        """Take what was seen of people, by all arms or by each one, and of bodies by all arms."""
        layout = self._layout
        rule = separation_in(layout.step.program.parts)
        frames = people if is_of_each(people, self.count) else [people] * self.count
        all_news = [News(rule, frame, bodies, age) for frame in frames]
        for memory, news in zip(self._memories, all_news, strict=True):
            see(layout.plan, memory, news)

    def _take_steps(self, inputs: ArmInput, kinds: IntVector) -> None:
        """Take a step of all arms (`step_arms`), shared by threads."""
        plan = self._layout.plan
        if self.threads == 1 or self.count <= BLOCK:
            step_arms(plan, self._memories, inputs, kinds, 0, self.count)
            return

        def work(first: int) -> None:
            last = min(first + BLOCK, self.count)
            step_arms(plan, self._memories, inputs, kinds, first, last)

        list(_pool(os.getpid(), self.threads).map(work, range(0, self.count, BLOCK)))

    def _flags(self, name: str, value: ArrayLike | None) -> IntVector:
        """Return booleans (N,), by default all true, as 1 and 0."""
        flags = np.ones(self.count, dtype=bool) if value is None else np.asarray(value)
        if flags.shape != (self.count,) or flags.dtype.kind != "b":
            raise InvalidInputError(name, f"must be booleans of shape ({self.count},)", value)
        return flags.astype(np.int64)

    def reset(self, mask: ArrayLike | None = None, q: ArrayLike | None = None) -> None:
        """Reset arms to rest: requests, halts and the last commands no longer count.

        Args:
            mask: Whether each arm is reset, (N,); None: all are.
            q: Joint positions of the arms [rad], (N, n); None: those that the next step measures.
        """
        positions: Matrix = np.zeros((self.count, 0))
        if q is not None:
            positions = checks.array("q", q, (self.count, self.robot.dof))
        with self._made._lock:
            for i in np.flatnonzero(self._flags("mask", mask)):
                rest_arm(self._layout.plan, self._memories[i], positions[i])

    def halt(self, mask: ArrayLike | None = None) -> None:
        """Brake arms at every step from now on, whatever is asked for, until `reset`.

        Args:
            mask: Whether each arm is halted, (N,); None: all are.
        """
        with self._made._lock:
            for i in np.flatnonzero(self._flags("mask", mask)):
                halt_arm(self._layout.plan, self._memories[i])

    def active_limits(self, i: int) -> tuple[str, ...]:
        """Name the active limits of arm i's last command, as `ShieldCommand.active_limits`."""
        with self._made._lock:
            return self._layout.active_limits(self._memories[i])

    def margin(self, i: int | None = None) -> Margin:
        """Return the distances of arm i at the positions that its last command starts from.

        If i is None, those of all arms, as arrays (N,).
        """
        layout = self._layout
        with self._made._lock:
            if i is not None:
                return layout.margin(self._memories[i])
            found = np.empty((4, self.count))
            write_margins(layout.plan, self._memories, *found)
            return Margin(*found)

    def stopping_time(self, i: int) -> float:
        """Return the time of arm i's stopping motion from its last command [s]."""
        with self._made._lock:
            return self._layout.stopping_time(self._memories[i])
