"""What stands between a shield and an arm's driver: when to begin, when to brake, and why."""

import math
import signal
import time
from bisect import bisect_right
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armstep.arms import FARTHEST
from armstep.errors import InputError
from armstep.shield import Shield, ShieldCommand
from armstep.tables import Array

TURN = 2.0 * np.pi
"""Turn after which a joint without position limits is at the same place [rad]."""

FORGOTTEN = 1.0
"""Time constant with which a velocity-controlled arm's following error is forgotten [s]."""

WINDOWS = (0.1, 1.0)
"""Times for which an arm moves steadily before it is commanded [s]; coarse encoders need the last.
"""

STEADY = 2e-3
"""Velocity that counts as noise [rad/s]: the jerk of a jump by it is within usual limits."""

REST = 1e-9
"""Commanded velocity that counts as rest [rad/s]: at a limit a joint may back off by rounding."""


def without_turns(difference: Array, limits: Mapping[str, Array]) -> Array:
    """Return differences of positions (..., n) [rad], without whole turns of unlimited joints."""
    is_unlimited = np.isinf(limits["upper"] - limits["lower"])
    return difference - TURN * is_unlimited * np.round(difference / TURN)


class Recent:
    """Joint positions of the last moments, for the velocity from which an arm is commanded."""

    def __init__(self, limits: Mapping[str, Array], longest: float) -> None:
        """Take the limits of n joints, and the longest time between two states [s]."""
        self._limits = limits
        self._longest = longest
        self._states: list[tuple[float, Array]] = []

    def see(self, t: float, q: Array) -> None:
        """Take positions q (n,) [rad] that were measured at a time [s]."""
        if self._states and not 0.0 < t - self._states[-1][0] <= self._longest:
            self._states.clear()
        self._states.append((t, q))
        while t - self._states[0][0] > max(WINDOWS) + self._longest:
            del self._states[0]

    def velocity(self, stands: bool = False) -> Array | None:
        """Return the velocities (n,) [rad/s] of an arm in steady motion; None: it is not.

        Noise is no motion: an arm at rest has those of 0; `stands`: it is known to be.
        """
        if not self._states:
            return None
        if stands:
            return np.zeros_like(self._states[-1][1])
        t, q = (np.array(each, dtype=float) for each in zip(*self._states, strict=True))
        for window in WINDOWS:
            first = np.searchsorted(t, t[-1] - window, side="right") - 1
            if first < 0:
                return None
            ages = (t[-1] - t[first:])[:, None]
            way = without_turns(q[-1] - q[first:], self._limits)
            mean: Array = way[0] / ages[0]
            for dq in (0.0 * mean, mean):
                if (np.abs(way - ages * dq) <= window * STEADY).all():
                    return dq
        return None

    def extended(self, t: float, dq: Array) -> Array:
        """Return the positions (n,) [rad] of a time [s] by the last ones and a velocity."""
        last, q = self._states[-1]
        return q + (t - last) * dq


class Following:
    """Commanded joint positions of the last moments, and how the measured ones differ from them.

    Attributes:
        error: Following error: measured less commanded positions at the last state's time [rad],
            (n,); of an arm that takes velocities, less what is forgotten of it.
        forgets: Whether the arm takes velocities: what it has lost it does not make up for.
    """

    def __init__(
        self,
        limits: Mapping[str, Array],
        delay: float,
        span: float,
        forgets: bool,
        most: float = math.inf,
    ) -> None:
        """Take the limits of n joints.

        Args:
            limits: Limits of n joints.
            delay: Time by which the arm is behind its commands [s].
            span: Largest age of a state [s].
            forgets: Whether the arm takes velocities.
            most: Following error above which a joint does not follow [rad].
        """
        self._limits = limits
        self._delay = delay
        self._span = span + delay
        self.forgets = forgets
        self._most = most

    def begin(self, t: float, q: Array, dq: Array) -> None:
        """Begin at a time [s] with positions q (n,) [rad], that change by dq (n,) [rad/s] before.

        That is where the arm is measured; its commands are ahead by the delay.
        """
        ahead = q + self._delay * dq
        self._times = [t - self._span, t]
        self._positions = [ahead - self._span * dq, ahead]
        self._velocities = [dq, dq]
        self._offset = q - self.commanded(t - self._delay)
        self._forgotten = 0.0 * q
        self.error = 0.0 * q
        self._seen = t

    def command(self, dq: Array) -> None:
        """Give a velocity (n,) [rad/s] from the time of the last `advance` on."""
        self._velocities[-1] = dq

    def advance(self, t: float, elapsed: float, held: float) -> None:
        """Begin a period.

        Args:
            t: Present time [s]; if the clock has jumped, times before are counted from it.
            elapsed: Time since the last period began [s].
            held: Time for which its velocity moved the arm [s].
        """
        jump = t - elapsed - self._times[-1]
        self._times = [*(each + jump for each in self._times), t]
        self._positions.append(self._positions[-1] + held * self._velocities[-1])
        self._velocities.append(self._velocities[-1])
        if self._times[1] < t - self._span:
            for each in (self._times, self._positions, self._velocities):
                del each[0]

    def commanded(self, t: float) -> Array:
        """Return the commanded positions of a time [s], (n,) [rad]."""
        k = max(bisect_right(self._times, t) - 1, 0)
        return self._positions[k] + (t - self._times[k]) * self._velocities[k]

    def see(self, t: float, q: Array) -> None:
        """Take positions q (n,) [rad] that were measured at a time [s]."""
        self._offset = q - self.commanded(t - self._delay)
        self.error = without_turns(self._offset - self._forgotten, self._limits)
        if self.forgets:
            part = min(max(t - self._seen, 0.0) / FORGOTTEN, 1.0)
            self._forgotten = self._forgotten + part * self.error
        self._seen = t

    @property
    def lost(self) -> NDArray[np.bool_]:
        """Which joints do not follow, (n,)."""
        return np.abs(self.error) > self._most

    def measured(self, t: float) -> Array:
        """Return the positions of a time [s] that the last state and the commands since tell."""
        return self.commanded(t - self._delay) + self._offset


class Channel:
    """A number beside the joints, as a gripper's opening: it goes through at a limited speed."""

    def __init__(self, speed: float, start: float = math.nan) -> None:
        """Take the largest speed [1/s], and what it begins with; NaN: the first wanted one."""
        self._speed = speed
        self._last = start

    def step(self, wanted: float, elapsed: float) -> float:
        """Return the number nearest to a wanted one after a time [s]; of NaN the last one."""
        if math.isnan(self._last):
            self._last = wanted
        most = self._speed * elapsed
        if math.isfinite(wanted):
            self._last += min(max(wanted - self._last, -most), most)
        return self._last


class Joints(NamedTuple):
    """A driver's joints.

    Attributes:
        names: Its names for the shield's joints, in their order.
        unit: Its unit of positions [rad]; that of degrees is math.radians(1.0).
    """

    names: Sequence[str]
    unit: float = 1.0

    def ordered(self, names: Iterable[str], values: Iterable[Any]) -> Array:
        """Return the driver's positions by their names as those of the shield's joints [rad].

        Raises:
            InputError: One of them is not there, or twice, or not finite.
        """
        pairs = [*zip(names, values, strict=False)]
        found = dict(pairs)
        if len(found) != len(pairs):
            raise InputError("with a joint twice")
        for each in self.names:
            if each not in found:
                raise InputError(f"without joint {each!r}")
        try:
            q = self.unit * np.array([found[each] for each in self.names], dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError("not numbers") from None
        if not (np.abs(q) <= FARTHEST).all():
            raise InputError("not finite")
        return q

    def goals(self, q: Array) -> dict[str, float]:
        """Return positions of the shield's joints [rad] as the driver's, by their names."""
        return dict(zip(self.names, (q / self.unit).tolist(), strict=True))


class Drive:
    """A shield between requests and an arm's driver, which says what is measured and sends.

    The arm begins once its velocity is known, after a reset too; then commands never jump. It
    brakes for each reason that a step is given or finds, and is held for some until `reset`.
    A driver of one's own has `read` and `send`, and is driven by `run`.

    Attributes:
        shield: The shield.
        joints: The driver's joints.
        command: Its last command, or None.
        fault: Why the arm brakes, or is not commanded yet; else "".
        error: What the last request raised, for which the arm brakes, or None.
        held: Why it brakes until `reset`, or "".
        has_begun: Whether the arm is commanded.
        worst: Longest period since this was last set [s].
    """

    def __init__(
        self,
        shield: Shield,
        takes_velocity: bool = True,
        timeout: float = 0.1,
        following_error: float = 0.1,
        joints: Joints | None = None,
        stands: bool = False,
    ) -> None:
        """Take a shield.

        Args:
            shield: The shield.
            takes_velocity: Whether the driver takes velocities; or positions.
            timeout: Age up to which joint states count [s].
            following_error: Difference of measured and commanded positions at which a joint counts
                as one that does not follow [rad].
            joints: The driver's joints; None: the shield's, in rad.
            stands: Whether the arm stands when it begins, and a requested position waits for a
                joint that does not follow, as of servos; others are held.

        Raises:
            InputError: The shield does not fit to such a driver.
        """
        tables = shield.tables
        if takes_velocity and tables.longest_period is None:
            raise InputError("velocity needs a shield with a longest_period")
        if not takes_velocity and tables.delay:
            raise InputError("positions need a shield without a delay")
        self._watches = bool(tables.people or tables.bodies)
        if self._watches and not takes_velocity:  # whose periods all count as the shield's
            raise InputError("people and bodies with a speed need velocity")
        self.shield = shield
        self.joints = joints or Joints(tables.joint_names)
        count = len(tables.joint_names)
        if not len({*self.joints.names}) == len(self.joints.names) == count:
            raise InputError(f"joints: are not {count} different ones")
        self.command: ShieldCommand | None = None
        self.fault = "no joint states"
        self.error: Exception | None = None
        self.worst = 0.0
        self._timeout = timeout
        self._stands = stands
        about = (tables.delay, timeout, takes_velocity, following_error)
        self._following = Following(tables.limits, *about)
        self._recent = Recent(tables.limits, timeout)
        self._fresh: tuple[float, Array] | None = None  # a state that no command was compared with
        self._chunk: Mapping[str, Any] | None = None  # that is followed
        self.reset()

    def reset(self) -> None:
        """Forget why the arm is held, and begin anew; until then the last command goes on."""
        self.held = ""
        self.has_begun = self._is_unsure = False

    @property
    def is_at_rest(self) -> bool:
        """Test whether the last command was one to rest, or there was none."""
        return self.command is None or bool(np.abs(self.command.dq).max() <= REST)

    @property
    def deviation(self) -> Array | None:
        """Measured joint positions less those of what is followed [rad], (n,), or None."""
        reference = None if self.command is None else self.command.followed
        if self.command is None or reference is None:
            return None
        return self.command.next_q - reference + self._following.error

    def hold(self, reason: str) -> None:
        """Brake for a reason until `reset`."""
        self.held = self.held or reason

    def see(self, t: float, q: Array) -> None:
        """Take joint positions q (n,) [rad] that were measured at a time [s], the last ones.

        Raises:
            InputError: They are others, or not finite, and do not count.
        """
        if np.shape(q) != (len(self.joints.names),) or not (np.abs(q) <= FARTHEST).all():
            raise InputError(
                f"measured: {q} are not the positions of {len(self.joints.names)} joints"
            )
        self._fresh = (t, q)
        self._recent.see(t, q)

    def step(
        self,
        t: float,
        elapsed: float,
        request: Mapping[str, Any],
        fault: str = "",
        blind: str = "",
        idle: str = "",
    ) -> ShieldCommand | None:
        """Return the command of a period, or the last one before the arm begins.

        Args:
            t: Present time [s].
            elapsed: Time since the last period began [s].
            request: Request as an argument of `Shield.step`; or of `Shield.follow`, `times` being
                on this clock. An object that is the same again goes on as a chunk or a stream.
            fault: Reason to brake.
            blind: Reason why joint states do not count.
            idle: Reason why the request does not count.
        """
        late = ""
        if self.has_begun:
            late, elapsed = self._advance(t, elapsed)
            if not blind:
                self._compare()
        else:
            elapsed = self.shield.dt
            blind = blind or self._begin(t)
        self.worst = max(self.worst, elapsed)
        unsure = "nobody was seen since the clock jumped" if self._is_unsure else ""
        self.fault = self.held or fault or late or unsure or blind or idle
        self.error = None
        if self.has_begun:
            try:
                self.command = self._answer(t, elapsed, request, blind)
            except Exception as error:  # whatever is asked, the arm brakes
                self.error = error
                self.fault = f"{error}"
                self.command = self._answer(t, elapsed, {}, blind)
            self._following.command(self.command.dq)
            # A shield that begins anew has seen nobody yet.
            if self._is_unsure and self.is_at_rest:
                self.has_begun = self._is_unsure = False
        return self.command

    def _advance(self, t: float, elapsed: float) -> tuple[str, float]:
        """Begin a period; return what is wrong with the last one, or "", and its length [s].

        That of a clock that has jumped is not known, nor how old is what was seen of people.
        """
        dt = self.shield.dt
        longest = self.shield.tables.longest_period or self._timeout
        late = "" if 0.0 < elapsed <= longest else f"period not within {longest:g} s"
        length = elapsed if 0.0 < elapsed <= self._timeout else dt
        self._following.advance(t, length, length if self._following.forgets else dt)
        self._is_unsure |= self._watches and length != elapsed
        return late, length

    def _begin(self, t: float) -> str:
        """Begin with the velocity that the arm has; return why that is not possible, or ""."""
        dq = self._recent.velocity(self._stands)
        if dq is None:
            return "waits until the arm is at rest or moves steadily"
        dt = self.shield.dt
        self._fresh = None
        self._chunk = None
        self._following.begin(t, self._recent.extended(t, dq), dq)
        count = 2 + math.ceil(self.shield.tables.delay / dt)  # commands that the shield remembers
        self.shield.reset(self._following.commanded(t - count * dt))
        for _ in range(count):
            self.shield.send(dq, dt)
        self.has_begun = True
        return ""

    def _compare(self) -> None:
        """Compare a new state with the commands of its time; hold an arm that does not follow."""
        if self._fresh is None:
            return
        self._following.see(*self._fresh)
        self._fresh = None
        lost = self._following.lost
        if lost.any() and not self._stands:
            self.hold(
                f"joint {self.joints.names[int(lost.argmax())]!r} does not follow its commands"
            )

    def _answer(
        self, t: float, elapsed: float, request: Mapping[str, Any], blind: str
    ) -> ShieldCommand:
        """Return the shield's command for a request, or one to brake.

        Commanded positions never jump, so they are told as measured ones: the shield is then never
        resynchronised.
        """
        if {"times", "time"} & {*request} and not self.fault:
            request = self._followed(request, t)
        asked = {"dq": np.zeros(len(self._following.error))} if self.fault else request
        if self._following.forgets:
            measured = None if blind else self._following.measured(t)
            return self.shield.step(measured, **asked, elapsed=elapsed)
        q = self._following.commanded(t)
        if self._stands and "position" in asked:
            asked = {**asked, "position": self._awaited(q, asked["position"])}
        return self.shield.step(q, **asked, dt=self.shield.dt)

    def _followed(self, chunk: Mapping[str, Any], t: float) -> Mapping[str, Any]:
        """Let the shield follow a chunk, or return a sample of a stream, that is new."""
        is_new = chunk is not self._chunk
        self._chunk = chunk
        if "time" in chunk:
            return chunk if is_new else {}
        try:
            if is_new:
                self.shield.follow(**chunk, now=t)
        except InputError as error:
            self.fault = f"{error}"
        return {}

    def _awaited(self, q: Array, goal: Array) -> Array:
        """Return requested positions that do not lead joints away that do not follow."""
        waits = self._following.lost & ((goal - q) * self._following.error < 0.0)
        late = [name for name, each in zip(self.joints.names, waits, strict=True) if each]
        self.fault = "; ".join(f"{name} does not follow" for name in late)
        return np.where(waits, q, goal)

    def now(self) -> float:
        """Return the time [s] of a clock that never jumps."""
        return time.monotonic()

    def read(self) -> Array | None:
        """Wait for the next period and return what is measured (n,) [rad]; None: it is not known.

        A driver's own.
        """
        raise NotImplementedError

    def send(self, command: ShieldCommand) -> None:
        """Send a command. A driver's own."""
        raise NotImplementedError

    def run(self, ask: Callable[[], Mapping[str, Any]], duration: float = math.inf) -> str:
        """Drive until a time [s] is over, or until Ctrl-C, and come to rest; return why it ended.

        Args:
            ask: Returns the request of a period as an argument of `Shield.step`; none: it brakes.
            duration: Length of the motion [s].

        Raises:
            Exception: `ask` raised it, or a step for what it returned or `read` measured; the arm
                came to rest first.
        """
        failures: list[Exception] = []
        before = signal.signal(signal.SIGINT, lambda *_: self.hold("interrupted"))
        try:
            start = last = self.now()
            while not (self.held and self.is_at_rest):
                q = self.read()
                now = self.now()
                if now - start > duration:
                    self.hold("the time is over")
                request: Mapping[str, Any] = {}
                try:
                    if q is not None:
                        self.see(now, q)
                    request = {} if failures else ask()
                except Exception as error:
                    failures.append(error)
                idle = "" if request else "no request"
                blind = "" if q is not None else "no joint states"
                command = self.step(now, now - last, request, blind=blind, idle=idle)
                failures += [self.error] if self.error else []
                if failures:
                    self.hold("no request")
                last = now
                if command is not None:
                    self.send(command)
            if failures:
                raise failures[0]
            return self.held
        finally:
            signal.signal(signal.SIGINT, before)
