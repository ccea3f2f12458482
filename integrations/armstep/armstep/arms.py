"""Memory of one arm or of many, their steps, and what all arguments are checked for."""

from __future__ import annotations

import ctypes
import os
import threading
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any, Generic, NamedTuple, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from armstep._library import MANY, ONE, SAVED, Batch, Input
from armstep.errors import InputError, TablesError
from armstep.tables import Array, Fixed, Path, Tables, load_tables

TWIST = 6
"""Numbers of a twist: linear, then angular velocity."""

TARGET = 18
"""Numbers of a target: position, rotation row by row, linear and angular velocity."""

FARTHEST = 2.0**20
"""Largest joint position that kernels take the sine of [rad]."""

FINITE = float(np.finfo(np.float64).max)
"""Largest finite number."""

ROUNDING = 1e-9
"""Fraction by which a stated period may be above the control period."""

LONGEST = 1e3
"""Longest period that may be stated [s]."""

BLOCK = 64
"""Arms whose steps a thread takes at once."""


def numbers(name: str, value: ArrayLike, shape: tuple[int, ...], most: float | None = None) -> Any:
    """Return numbers of a shape, of any size and NaN, or up to `most`."""
    found = np.asarray(value)
    if found.dtype.kind not in "fiu" or found.shape != shape:
        raise InputError(f"{name}: must be numbers of shape {shape}, not {found.shape}")
    if most is not None and not np.abs(found).max(initial=0.0) <= most:
        raise InputError(f"{name}: must be finite, within ±{most:g}")
    return found


def pointed(
    name: str, value: ArrayLike, shape: tuple[int, ...], most: float | None = None
) -> Array:
    """Return numbers as `numbers`, as float64 without gaps, that C is pointed to."""
    return np.ascontiguousarray(numbers(name, value, shape, most), dtype=np.float64)


class Buffers(NamedTuple):
    """What a step is given and what it answers, a row for each arm, at addresses that stay.

    Attributes:
        q: Joint positions [rad].
        asked: Requests, or targets.
        given: Which arms have a new request.
        dq: Joint velocities [rad/s].
        next_q: Joint positions at the end of the period [rad].
        clipped: Whether each command differs from its request.
        results: Reason of a shield, or action of a controller.
        scratch: What a call takes for itself.
    """

    q: Array
    asked: Array
    given: NDArray[np.bool_]
    dq: Array
    next_q: Array
    clipped: NDArray[np.bool_]
    results: NDArray[np.intc]
    scratch: Array


class Decision(NamedTuple):
    """Command of one step of an arm.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
        next_q: Joint positions at the end of the period [rad], (n,).
        clipped: Whether the command differs from the request, or does less than the tasks ask.
        result: Code of the first reason of a shield, or of the action of a controller.
        tables: The arm's tables.
        memory: The arm's memory after the step.
    """

    dq: Array
    next_q: Array
    clipped: bool
    result: int
    tables: Tables
    memory: Array

    @property
    def active_limits(self) -> tuple[str, ...]:
        """Reasons, bounds and rows that keep the command from what was asked, in words."""
        codes = np.empty(len(self.tables.limit_names), np.intc)
        count = ONE.armstep_active_limits(self.tables.arm, self.memory.ctypes, codes.ctypes)
        return tuple(self.tables.limit_names[k] for k in codes[:count].tolist())

    def __repr__(self) -> str:
        limits = ", ".join(self.active_limits)
        return f"<{type(self).__name__} dq = {self.dq} rad/s{': ' * bool(limits)}{limits}>"


class Decisions(NamedTuple):
    """Commands of one step of N arms.

    Attributes:
        dq: Joint velocities [rad/s], (N, n), within the limits.
        next_q: Joint positions at the end of the period [rad], (N, n).
        clipped: Whether each command differs from its request, or does less than asked, (N,).
        reason: The first `Reason` of each shield, or the `Action` of each controller, (N,).
        arms: The shields or controllers.
    """

    dq: Array
    next_q: Array
    clipped: NDArray[np.bool_]
    reason: NDArray[np.intc]
    arms: Arms[Any]

    def active_limits(self, i: int) -> tuple[str, ...]:
        """Name what keeps the last command of arm i from what was asked."""
        return self.arms.active_limits(i)


Answer = TypeVar("Answer")
"""What a step returns: the decision of one arm, or those of many."""


class Arms(Fixed, Generic[Answer]):
    """Memory of one arm, or of N. Threads may share it; copies, pickles and forks carry it along.

    Attributes:
        tables: The tables: names and limits of the joints, the frame, periods.
        dt: Control period [s].
        count: Number of arms.
        threads: Largest number of threads of a step.
    """

    tables: Tables
    dt: float
    count: int
    threads: int
    _kind: str
    _decision: type[Decision]

    def __init__(self, tables: Path | Tables, count: int | None, threads: int, own: Any) -> None:
        """Begin, with all arms at rest where they are measured first.

        Args:
            tables: File that ``iiwa_dnn.export.tables`` wrote, or what `load_tables` read.
            count: Number of arms; None: one, whose arrays have no rows.
            threads: Largest number of threads of a step.
            own: Library of the parts of a user's own, if the arm has such.

        Raises:
            TablesError: The tables cannot be read, or are of another kind.
            InputError: There is no such number of arms.
        """
        read = tables if isinstance(tables, Tables) else load_tables(tables, own)
        if read.kind != self._kind:
            raise TablesError(f"{read.name}: has tables of a {read.kind}, not of a {self._kind}")
        if count is not None and not count >= 1:
            raise InputError(f"count: must be at least 1, not {count!r}")
        many = () if count is None else (count,)
        self._begin(read, np.zeros((*many, read.memory)), threads)
        for _, memory in self._each():
            ONE.armstep_begin(read.arm, memory, self._buffers.scratch.ctypes)

    def _begin(self, tables: Tables, memory: Array, threads: int) -> None:
        """Take memory, and make room for the arguments of a step."""
        self._memory = memory.reshape(-1, tables.memory)
        self._many = memory.shape[:-1]
        count = len(self._memory)
        vars(self).update(tables=tables, dt=tables.dt, count=count, threads=threads)
        n = len(tables.joint_names)
        self._shape = (*self._many, n)
        width = max(n, TWIST, TARGET * len(tables.frame_names))
        self._buffers = own = Buffers(
            np.zeros((count, n)),
            np.zeros(count * width),
            np.ones(count, bool),
            np.zeros((count, n)),
            np.zeros((count, n)),
            np.zeros(count, bool),
            np.zeros(count, np.intc),
            np.zeros(tables.scratch),
        )
        q, self._asked, self._given, *others, scratch = (each.ctypes.data for each in own)
        self._batch = Batch(memory.ctypes.data, tables.memory, Input(q), None, *others)
        self._input = self._batch.input
        self._call = (tables.arm, ctypes.addressof(self._batch), scratch)
        self._lock = threading.RLock()
        self._pool: tuple[int, ThreadPoolExecutor] | None = None

    def __getstate__(self) -> tuple[Any, ...]:
        """Return arguments of `_begin` for a copy."""
        with self._lock:
            return self.tables, self._memory.reshape(*self._many, -1).copy(), self.threads

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        self._begin(*state)

    def _mask(self, name: str, value: ArrayLike | None) -> Any:
        """Return which arms a mask (N,) chooses; None: all."""
        found = np.ones(self.count, bool) if value is None else np.asarray(value)
        if found.dtype != bool or found.shape != (self.count,):
            raise InputError(f"{name}: must be booleans of shape ({self.count},)")
        return found

    def _each(self, mask: ArrayLike | None = None) -> Iterator[Any]:
        """Yield each arm of a mask (N,), and its memory as C takes it, while it is locked."""
        chosen = np.flatnonzero(self._mask("mask", mask))
        with self._lock:
            yield from ((i, self._memory[i].ctypes) for i in chosen)

    def _periods(self, dt: float | None, elapsed: float | None) -> tuple[float, float]:
        """Return stated periods [s], 0 for none."""
        if dt is None and elapsed is None:
            return 0.0, 0.0
        is_fixed = self.tables.longest_period is None
        if elapsed is not None and (dt is not None or is_fixed):
            raise InputError("elapsed: must be alone, without dt, and needs a longest_period")
        most = self.dt * (1.0 + ROUNDING) if is_fixed else LONGEST
        with suppress(TypeError):
            if 0.0 < (elapsed if dt is None else dt) <= most:  # type: ignore[operator]
                return float(dt or 0.0), float(elapsed or 0.0)
        raise InputError(f"dt, elapsed: must be above 0 s, at most {most:g} s")

    def _take(
        self,
        q: Array | float,
        kind: int,
        request: Array | None,
        periods: tuple[float, float] = (0.0, 0.0),
        t: float = 0.0,
    ) -> Answer:
        """Take a step of all arms; the lock is held.

        Raises:
            InputError: A step was refused: its arm takes the next command of its motion to rest.
        """
        given = self._input
        given.kind = kind
        given.t = t
        given.dt, given.elapsed = periods
        given.request = None if request is None else self._asked
        self._buffers.q[...] = q
        if request is not None:
            self._buffers.asked[: request.size] = request.reshape(-1)
        if self._shared() if self._many else ONE.armstep_steps(*self._call, 0, 1):
            raise InputError("a step was refused: its arm brakes")
        if not self._many:
            return cast(Answer, self._last())
        dq, next_q, clipped, results = (each.copy() for each in self._buffers[3:7])
        return cast(Answer, Decisions(dq, next_q, clipped, results, self))  # type: ignore[arg-type]

    def _shared(self) -> int:
        """Take the steps of all arms, shared by threads; return the number that was refused."""
        blocks = range(0, self.count, BLOCK)
        waiting = iter(blocks)  # threads take the next one from it

        def work() -> int:
            scratch = np.empty(self.tables.scratch)
            call = (*self._call[:2], scratch.ctypes)
            ends = ((k, min(k + BLOCK, self.count)) for k in waiting)
            return sum(MANY.armstep_steps(*call, *each) for each in ends)

        if self._pool is None or self._pool[0] != os.getpid():  # threads of this process
            self._pool = (os.getpid(), ThreadPoolExecutor(self.threads))
        others = range(min(self.threads, len(blocks)) - 1)
        tasks = [self._pool[1].submit(work) for _ in others]
        return work() + sum(each.result() for each in tasks)

    def _last(self, i: int = 0) -> Any:
        """Return the decision of arm i's last step."""
        _, _, _, dq, next_q, clipped, results, _ = self._buffers
        with self._lock:
            arrays = dq[i].copy(), next_q[i].copy()
            codes = bool(clipped[i]), int(results[i])
            return self._decision(*arrays, *codes, self.tables, self._memory[i].copy())

    def active_limits(self, i: int = 0) -> tuple[str, ...]:
        """Name what keeps the last command of arm i from what was asked."""
        limits: tuple[str, ...] = self._last(i).active_limits
        return limits

    def place(self, obstacles: ArrayLike) -> None:
        """Say where the centres of the obstacles are [m], (k, 3); for many arms or (N, k, 3).

        Raises:
            InputError: They have a wrong shape, or are not finite.
        """
        self._place(self._centers(obstacles))

    def _place(self, centers: Array) -> None:
        """Place the centres of each arm's obstacles (N, k, 3) [m]."""
        for i, memory in self._each():
            ONE.armstep_place(self.tables.arm, memory, centers[i].ctypes)

    def _centers(self, obstacles: ArrayLike) -> Array:
        """Return centres of obstacles [m] as those of each arm, (N, k, 3)."""
        found = np.asarray(obstacles)
        shape = (len(self.tables.obstacle_names), 3)
        many = self._many if found.ndim == len(self._many) + len(shape) else ()
        centers = pointed("obstacles", found, (*many, *shape), FINITE)
        return np.broadcast_to(centers, (self.count, *shape))

    def see(
        self,
        people: ArrayLike | None = None,
        age: float = 0.0,
        bodies: Mapping[str, tuple[ArrayLike, ArrayLike]] | None = None,
    ) -> None:
        """Say where people or bodies are, as a sensor saw them `age` [s] before the step.

        What has no meaning is no frame (`Reason.FRAME_REFUSED`): the arm comes to rest by itself.

        Args:
            people: All in the field: both ends and the radius, with the error of the place, of each
                [m], (k, 7); [] is nobody; None: no news.
            age: Time since they were seen [s].
            bodies: Center [m], (3,), and rotation, (3, 3), of each body with a speed that was seen,
                by its name. A capsule lies along its z axis. The others grow older.

        Raises:
            InputError: They have a wrong shape, or the arm knows of none; nothing is changed.
        """
        boxes = [self._placed(name, *place) for name, place in (bodies or {}).items()]
        if people is not None and not self.tables.people:
            raise InputError("people: the arm was made without")
        seen = np.asarray([] if people is None else people, dtype=np.float64)
        frame = pointed("people", seen.reshape(-1, 7) if seen.size == 0 else seen, (len(seen), 7))
        for _, memory in self._each():
            if people is not None:
                ONE.armstep_people(self.tables.arm, memory, frame.ctypes, len(frame), age)
            for number, box in boxes:
                ONE.armstep_body(self.tables.arm, memory, number, box.ctypes, age)

    def _placed(self, name: str, center: ArrayLike, rotation: ArrayLike) -> tuple[int, Array]:
        """Return the number of a body, and its half-extents, axes and center, (15,)."""
        names = [*self.tables.bodies]
        if name not in names:
            raise InputError(f"bodies: there is no {name!r}, but {', '.join(names) or 'none'}")
        axes = numbers(name, rotation, (3, 3)).T.ravel()
        box = [self.tables.bodies[name], axes, numbers(name, center, (3,))]
        return names.index(name), np.concatenate(box, dtype=np.float64)

    def halt(self, mask: ArrayLike | None = None) -> None:
        """Brake from now on, whatever is asked, until `reset`; of many those of a mask (N,)."""
        for _, memory in self._each(mask):
            ONE.armstep_halt(self.tables.arm, memory)

    def reset(self, mask: ArrayLike | None = None, q: ArrayLike | None = None) -> None:
        """Stand at joint positions q (N, n) [rad]; None: where the arms are measured next.

        Requests, commands, a halt and a controller's path lag are forgotten, of all arms or of
        those of a mask (N,).
        """
        rows: Any = [None] * self.count
        if q is not None:
            rows = pointed("q", q, self._shape, FARTHEST).reshape(self.count, -1)
        for i, memory in self._each(mask):
            there = None if q is None else rows[i].ctypes
            ONE.armstep_rest(self.tables.arm, memory, self._call[2], there)

    def _send(self, dq: ArrayLike, period: float, fraction: float) -> None:
        """Count a velocity as sent for a period, in place of a step's command."""
        sent = pointed("dq", dq, self._shape, FINITE)
        for _, memory in self._each():
            if ONE.armstep_send(self.tables.arm, memory, sent.ctypes, period, fraction):
                raise InputError("dq: is too fast")

    def save(self) -> Array:
        """Return the state of each arm, with a digest, as numbers for `load`."""
        saved = np.zeros((self.count, self.tables.memory + SAVED))
        for i, memory in self._each():
            ONE.armstep_save(self.tables.arm, memory, saved[i].ctypes)
        return saved

    def load(self, saved: ArrayLike) -> None:
        """Take over the state that `save` returned.

        Raises:
            InputError: It has another shape.
            TablesError: It is of other tables, or damaged; no arm has changed.
        """
        rows = pointed("saved", saved, (self.count, self.tables.memory + SAVED))
        memory = np.zeros_like(self._memory)
        for row, each in zip(rows, memory, strict=True):
            if ONE.armstep_restore(self.tables.arm, each.ctypes, row.ctypes):
                raise TablesError("saved: is damaged, or of other tables")
        with self._lock:
            self._memory[...] = memory
