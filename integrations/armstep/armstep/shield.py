"""Shields: any request for a motion in, the command closest to it that keeps every limit out."""

from __future__ import annotations

import copy
import ctypes
import os
from enum import IntEnum
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from armstep._library import ONE
from armstep.arms import FARTHEST, TWIST, Answer, Arms, Decision, Decisions, numbers, pointed
from armstep.errors import InputError, LibraryError
from armstep.tables import Array, Path, Tables

KINDS = ("dq", "twist", "position")
"""Arguments that are requests, in the order of their codes from 1 on."""

KEEPS = ("time", "path")
"""What a chunk keeps where its samples are too quick, in the order of their codes from 0 on."""

STREAM = 2
"""Code of a stream with a lead of 0."""

MISSED = 1e-3
"""Distance from a sample up to which it counts as reached [rad]."""

PATIENCE = 10.0
"""Time after its last sample until which a preview waits for a chunk [s]."""

NEAR = 1e-4
"""Time before the last sample at which its clock, which comes to rest there, is there [s]."""

REACHED = 1e-4
"""Norm of the error of a pose [m], [rad] up to which it counts as reached."""

SEARCH = 50
"""Largest number of steps of a search for a posture."""

TURN = 0.5
"""Largest change of a joint in one of them [rad]."""

DAMPING = 0.1
"""Ratio of the damping of a step to the squared error."""

AHEAD = 600.0
"""Time from now on up to which a chunk may reach [s]; beyond, its times are of another clock."""

TICK = 1e-9
"""Time that counts as rounding [s]."""

Reason = IntEnum(
    "Reason",
    [
        "NONE",
        "NO_REQUEST",
        "TIMED_OUT",
        "NOT_FINITE",
        "HALTED",
        "Q_NOT_FINITE",
        "RESYNCHRONISED",
        "CUT",
        "PERIOD_EXCEEDED",
        "SINGULAR",
        "UNKNOWN_KIND",
        "PERIOD_REFUSED",
        "PLACE_NOT_FINITE",
        "FRAME_REFUSED",
        "SEPARATION",
        "SPEED_SCALE",
        "STALE",
    ],
    start=0,
)
"""Reasons, other than limits, for a command that differs from the request."""


class Margin(NamedTuple):
    """Distances to what the shield keeps away from.

    Attributes:
        joint: Least distance of a joint from its position limits [rad].
        distance: Distance of the nearest pair less the least one [m]; inf if none is watched.
        separation: That of the nearest person, who may have moved since; inf if there is none.
        torque: Least part of a torque limit that the command leaves; inf if none is limited.
    """

    joint: Any
    distance: Any
    separation: Any
    torque: Any


class ShieldCommand(Decision):
    """Command of one step of a shield."""

    @property
    def reason(self) -> Reason:
        """The first reason beside limits for another command than the request."""
        return Reason(self.result)

    @property
    def late(self) -> float:
        """Time by which the clock of what is followed is behind at the end of the period [s]."""
        return self._followed()[0]

    @property
    def followed(self) -> Array | None:
        """Joint positions of what is followed there [rad], (n,); None: nothing is."""
        return self._followed()[1]

    @property
    def off(self) -> float:
        """Largest distance of a joint from what is followed there [rad]."""
        reference = self.followed
        return 0.0 if reference is None else float(np.abs(self.next_q - reference).max())

    def _followed(self) -> tuple[float, Array | None]:
        """Return by how much the clock of what is followed is late, and where that is."""
        late = ctypes.c_double()
        place = ONE.armstep_followed(self.tables.arm, self.memory.ctypes, ctypes.byref(late))
        if place is None:
            return 0.0, None
        joints = (ctypes.c_double * len(self.next_q)).from_address(place)
        return late.value, np.array(joints)

    @property
    def margin(self) -> Margin:
        """Distances at the joint positions that the command starts from."""
        scratch = np.empty(self.tables.scratch)
        joint, distance = np.empty((2, 1))
        given = (self.memory.ctypes, scratch.ctypes, joint.ctypes, distance.ctypes)
        ONE.armstep_margin(self.tables.arm, *given)
        separation = ONE.armstep_separation(self.tables.arm, *given[:2])
        torque = ONE.armstep_torque(self.tables.arm, *given[:2])
        return Margin(joint.item(), distance.item(), separation, torque)

    @property
    def stopping_time(self) -> float:
        """Time of the motion to rest from the command [s]."""
        scratch = np.empty(self.tables.scratch).ctypes
        return float(ONE.armstep_stopping_time(self.tables.arm, self.memory.ctypes, scratch))


class Preview(NamedTuple):
    """Forecast of a chunk before the arm moves.

    Attributes:
        sample: Number of the first sample that is missed by more than `MISSED`; None: none is.
        active_limits: What kept the arm off until then; none: the samples are too quick.
        late: Largest time by which a sample is reached after its own [s].
        off: Largest distance of a joint from each sample when it is due by the clock [rad], (m,).
    """

    sample: int | None
    active_limits: tuple[str, ...]
    late: float
    off: Array


def rotation_vector(rotation: Array) -> Array:
    """Return the rotation vector (3,) [rad] of a rotation (3, 3)."""
    twice = (rotation - rotation.T)[[2, 0, 1], [1, 2, 0]]
    sine, cosine = float(np.linalg.norm(twice)), float(np.trace(rotation)) - 1.0
    if sine > 1e-9 or cosine > 0.0:
        return twice * (np.arctan2(sine, cosine) / sine if sine > 0.0 else 0.5)
    column = (rotation + np.eye(3))[:, int(np.diag(rotation).argmax())]  # half a turn
    return column * (np.pi / np.linalg.norm(column))


class _Shields(Arms[Answer]):
    """What a shield and many have in common."""

    _kind = "shield"
    _decision = ShieldCommand

    def _request(self, *values: Any, read: Any = numbers) -> tuple[int, Any]:
        """Return code and numbers of the one request that is given, or 0 and None."""
        given = [k for k, value in enumerate(values) if value is not None]
        if not given:
            return 0, None
        if len(given) > 1:
            raise InputError(f"pass exactly one of {', '.join(KINDS)}")
        name = KINDS[given[0]]
        shape = (*self._many, TWIST) if name == "twist" else self._shape
        return 1 + given[0], read(name, values[given[0]], shape)

    def step(
        self,
        q: ArrayLike | None,
        dq: ArrayLike | None = None,
        *,
        twist: ArrayLike | None = None,
        position: ArrayLike | None = None,
        time: float | None = None,
        lead: int | None = None,
        given: ArrayLike | None = None,
        obstacles: ArrayLike | None = None,
        dt: float | None = None,
        elapsed: float | None = None,
    ) -> Answer:
        """Compute the command that is closest to a request; for N arms, arrays have N rows.

        Without a request the last one counts, until it is too old.

        Args:
            q: Measured joint positions [rad], (n,); None: they could not be read; the arm brakes.
                Of many, those whose positions are not finite brake.
            dq: Joint velocity that is requested [rad/s], (n,).
            twist: Or linear [m/s] and angular [rad/s] velocity of the frame along the base's axes.
            position: Or joint positions to reach [rad], (n,); with a time or a lead those of a
                stream, which the arm passes through.
            time: Time at which they were sampled [s], on a clock of their sender; None: now.
            lead: Samples by which a stream is continued beyond the last one, 0, 1 (also None) or 2:
                the arm is 2 - lead sampling periods late.
            given: Whether each of many arms has a new request, (N,); None: all have.
            obstacles: Where the centres of the obstacles are [m], (k, 3), of many or (N, k, 3);
                None: where they were.
            dt: Period for which the command will be held [s].
            elapsed: Time since the last step [s].

        Raises:
            InputError: An argument has a wrong shape, `q` of one arm is not finite, there are
                several requests, or a period is wrong; nothing is changed.
        """
        most = None if self._many else FARTHEST
        joints = np.nan if q is None else numbers("q", q, self._shape, most)
        request = self._request(dq, twist, position)
        periods = self._periods(dt, elapsed)
        mask = None if given is None else self._mask("given", given)
        centers = None if obstacles is None else self._centers(obstacles)
        with self._lock:
            if time is not None or lead is not None:
                self._pass(position, time, 1 if lead is None else lead, mask)
                request = 0, None
            if centers is not None:
                self._place(centers)
            self._batch.given = None if mask is None else self._given
            if mask is not None:
                self._buffers.given[...] = mask
            return self._take(joints, *request, periods)

    def scale_speed(self, scale: float, mask: ArrayLike | None = None) -> None:
        """Let requests use a part, from 0 to 1, of the joints' velocity limits until the next call.

        Of many arms those of a mask (N,).

        Raises:
            InputError: It is no such part; nothing is changed.
        """
        for _, memory in self._each(mask):
            if ONE.armstep_scale_speed(self.tables.arm, memory, scale):
                raise InputError("scale: must be from 0 to 1")

    @property
    def time(self) -> float:
        """Time of the next step since the first one [s], of the first of many arms."""
        with self._lock:
            return float(ONE.armstep_time(self.tables.arm, self._memory[0].ctypes))

    def follow(
        self,
        times: ArrayLike,
        positions: ArrayLike,
        keep: Literal["time", "path"] = "time",
        *,
        now: float | None = None,
        given: ArrayLike | None = None,
    ) -> None:
        """Follow a chunk of timed joint positions from the next steps on, which need no request.

        Args:
            times: Time of each sample [s], (m,), rising.
            positions: Joint positions of each [rad], (m, n); for N arms (N, m, n). If some are not
                finite, the arm brakes.
            keep: What is kept where the samples are too quick for the joints: their ``"time"``, or
                their ``"path"``, later.
            now: Present time on the clock of `times` [s]; None: they are on each arm's clock.
            given: Which of many arms have a chunk, (N,); None: all.

        Raises:
            InputError: A shape is wrong, times do not rise, or samples are too many; nothing is
                then changed.
        """
        if keep not in KEEPS:
            raise InputError(f"keep: must be one of {', '.join(KEEPS)}")
        t = pointed("times", times, np.shape(times)[:1])
        points = pointed("positions", positions, (*self._many, t.size, self._shape[-1]))
        rows = points.reshape(self.count, t.size, self._shape[-1])
        for i, memory in self._each(given):
            clock = ONE.armstep_time(self.tables.arm, memory)
            ahead = 0.0 if now is None else clock - now
            if t.size and t[-1] + ahead - clock > AHEAD:
                raise InputError("times: state now= for another clock, and seconds")
            self._keep(memory, t + ahead, rows[i], KEEPS.index(keep))

    def _pass(self, position: ArrayLike | None, time: float | None, lead: int, given: Any) -> None:
        """Take joint positions as the next samples of streams."""
        if position is None or lead not in (0, 1, 2):
            raise InputError("time, lead: belong to a position, and a lead is 0, 1 or 2")
        if time is not None and not np.isfinite(time):
            raise InputError(f"time: must be finite, not {time!r}")
        rows = pointed("position", position, self._shape).reshape(self.count, -1)
        for i, memory in self._each(given):
            stamp = ONE.armstep_time(self.tables.arm, memory) if time is None else time
            self._keep(memory, np.array([stamp], np.float64), rows[i], STREAM + lead)

    def _keep(self, memory: Any, times: Array, rows: Array, mode: int) -> None:
        """Let an arm follow samples."""
        given = (times.ctypes, rows.ctypes, times.size, mode)
        if ONE.armstep_follow(self.tables.arm, memory, *given):
            raise InputError("times: must rise, and be no more than the shield has samples")

    def margin(self, i: int | None = None) -> Margin:
        """Return the distances of arm i at the positions that its last command starts from.

        If i is None, those of all arms, as arrays (N,).
        """
        if i is None:
            return Margin(*np.array([self.margin(k) for k in range(self.count)]).T)
        found: Margin = self._last(i).margin
        return found

    def stopping_time(self, i: int = 0) -> float:
        """Return the time of arm i's motion to rest from its last command [s]."""
        return float(self._last(i).stopping_time)


class Shield(_Shields[ShieldCommand]):
    """Shield of one arm."""

    def __init__(self, tables: Path | Tables, own: Path | None = None) -> None:
        """Begin, with the arm at rest where it is measured first.

        Args:
            tables: File that ``iiwa_dnn.export.tables`` wrote, or what `load_tables` read.
            own: Library of the parts of a user's own, if the arm has such.

        Raises:
            TablesError: The tables cannot be read, or are those of a controller.
        """
        super().__init__(tables, None, 1, own)

    def reset(self, q: ArrayLike | None = None) -> None:  # type: ignore[override]
        """Stand at joint positions q (n,) [rad]; None: where the arm is measured next."""
        super().reset(None, q)

    def preview(
        self, times: ArrayLike, positions: ArrayLike, keep: Literal["time", "path"] = "time"
    ) -> Preview:
        """Forecast lag and errors of a chunk, by taking its steps with a copy.

        Raises:
            InputError: As for `follow`; or no step has been taken, or the shield has a delay.
        """
        if self.tables.delay or self.time == 0.0:
            raise InputError("preview: needs a step before, and a shield without a delay")
        waits = self._last().followed is not None
        other = copy.copy(self)
        other.follow(times, positions, keep)
        t, goals = np.asarray(times, np.float64), np.asarray(positions, np.float64)
        q = self._buffers.next_q[0].copy()
        sample: int | None = None
        words: dict[str, None] = {}
        off = np.full(t.size, np.nan)
        late, begin = 0.0, -np.inf
        while begin < t[-1] and other.time <= t[-1] + PATIENCE:
            now = other.time
            command = other.step(q, dt=self.dt)
            is_lost = command.followed is None or command.reason is Reason.STALE
            if sample is None and (is_lost or command.off > MISSED):
                words.update(dict.fromkeys(command.active_limits))
            if is_lost:
                break
            if now >= t[0] or not waits:
                begin = now if begin == -np.inf else begin
                end = min(now + self.dt, t[-1]) - command.late
                end = end if end <= t[-1] - NEAR else t[-1]
                for k in np.flatnonzero((t >= begin - TICK) & (t <= end + TICK) & np.isnan(off)):
                    part = min(max(t[k] - begin, 0.0) / max(end - begin, TICK), 1.0)
                    off[k] = np.abs(q + part * (command.next_q - q) - goals[k]).max()
                    late = max(late, float(now + part * self.dt - t[k]))
                    if sample is None and off[k] > MISSED:
                        sample = int(k)
                begin = end
            q = command.next_q
        if sample is None and begin < t[-1]:
            sample = int(np.argmax(np.isnan(off) & (t > begin)))
        return Preview(sample, tuple(words), late, off)

    def frame_at(self, q: ArrayLike) -> tuple[Array, Array, Array]:
        """Return position (3,) [m], rotation and Jacobian (6, n) of the frame of twists at q."""
        joints = pointed("q", q, self._shape, FARTHEST)
        placement = np.empty(12)
        jacobian = np.empty((TWIST, joints.size))
        given = (joints.ctypes, placement.ctypes, jacobian.ctypes)
        with self._lock:
            ONE.armstep_frame(self.tables.arm, self._call[2], *given)
        return placement[9:], placement[:9].reshape(3, 3).T, jacobian

    def solve_pose(self, position: ArrayLike, rotation: ArrayLike, q0: ArrayLike) -> Array | None:
        """Find joint positions (n,) [rad] at which the frame of twists has a pose; None: none.

        Levenberg and Marquardt's method, within the position limits; distances do not count.

        Args:
            position: Position [m], (3,).
            rotation: Orientation, (3, 3).
            q0: Joint positions to begin from [rad], (n,).
        """
        goal = pointed("position", position, (3,), FARTHEST)
        axes = pointed("rotation", rotation, (3, 3), FARTHEST)
        lower, upper = self.tables.limits["lower"], self.tables.limits["upper"]
        q = np.clip(pointed("q0", q0, self._shape, FARTHEST), lower, upper)
        for _ in range(SEARCH):
            place, turned, jacobian = self.frame_at(q)
            error = np.concatenate([goal - place, rotation_vector(axes @ turned.T)])
            size = float(error @ error)
            if size < REACHED * REACHED:
                return q
            pull = jacobian.T @ error
            own = jacobian * (((q > lower) | (pull > 0.0)) & ((q < upper) | (pull < 0.0)))
            step = own.T @ np.linalg.solve(own @ own.T + DAMPING * size * np.eye(TWIST), error)
            q = np.clip(q + step * min(1.0, TURN / max(np.abs(step).max(), TURN)), lower, upper)
        return None

    def send(self, dq: ArrayLike, dt: float | None = None) -> None:
        """Count a velocity dq (n,) [rad/s] as sent for a period [s], in place of a command."""
        self._send(dq, self._periods(self.dt if dt is None else dt, None)[0], 1.0)


class Shields(_Shields[Decisions]):
    """Shields of N arms, whose steps are one call; each is answered as by a `Shield`."""

    def __new__(cls, *arguments: Any, device: str = "cpu", **named: Any) -> Shields:
        """Take the class for a device."""
        if device == "cpu":
            return super().__new__(cls)
        try:
            from armstep.cuda import CudaShields
        except ModuleNotFoundError as error:
            raise LibraryError(f"no {error.name}: pip install 'armstep[cuda]'") from None
        return super().__new__(CudaShields)

    def __init__(
        self,
        tables: Path | Tables,
        count: int,
        threads: int | None = None,
        own: Path | None = None,
        device: str = "cpu",
    ) -> None:
        """Begin, with all arms at rest where they are measured first.

        Args:
            tables: File that ``iiwa_dnn.export.tables`` wrote, or what `load_tables` read.
            count: Number of arms, N.
            threads: Threads of a step; None: as many as there are processors.
            own: Library of the parts of a user's own, if the arm has such.
            device: ``"cpu"``, or for `armstep.cuda.CudaShields` ``"cuda"`` or ``"cuda:1"``.

        Raises:
            TablesError: The tables cannot be read, or are those of a controller.
            LibraryError: What a GPU needs is not installed.
        """
        super().__init__(tables, count, int(threads or os.cpu_count() or 1), own)
