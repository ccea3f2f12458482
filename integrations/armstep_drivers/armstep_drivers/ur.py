"""An arm of Universal Robots: positions by ur_rtde's servoJ.

Names and ranges are those of https://sdurobotics.gitlab.io/ur_rtde/api/api.html (ur_rtde 1.6.5) and
https://www.universal-robots.com/articles/ur/programming/servoj-command.
"""

import math
from collections.abc import Callable, Mapping
from typing import Any

import armstep
import numpy as np

RANGES = {"lookahead_time": (0.03, 0.2), "gain": (100.0, 2000.0)}
SAFE_MODES = (1, 2)  # normal and reduced
STOPS = {3: "protective stop", 5: "safeguard stop", 6: "emergency stop", 7: "emergency stop"}
CATCH_UP = 2.0  # time in which the robot comes to its last goal [s]
SLACK = 0.05  # following error beside the delay of servoJ [rad]
SILENCE = 0.05  # age of a state above which it is not known [s]


class UR(armstep.Drive):
    """Arm that begins where it is. A stop of its own ends the motion: nothing is sent after it."""

    def __init__(
        self, shield: armstep.Shield, host: str, lookahead_time: float = 0.1, gain: float = 300.0
    ) -> None:
        """Connect to a robot in remote control.

        Args:
            shield: The shield, whose period is that of the goals: 2 ms, 8 ms of a CB3.
            host: Address of the robot.
            lookahead_time: Time by which servoJ smooths, 0.03 to 0.2 s; at least a period.
            gain: Gain of servoJ, 100 to 2000.

        Raises:
            InputError: A number is out of range, or the shield's periods vary.
        """
        import rtde_control
        import rtde_receive

        for name, value in (("lookahead_time", lookahead_time), ("gain", gain)):
            least, most = RANGES[name]
            if not least <= value <= most:
                raise armstep.InputError(f"{name}: must be {least:g} to {most:g}")
        if shield.tables.longest_period is not None:
            raise armstep.InputError("longest_period: servoJ's is constant; export without one")
        if shield.dt > lookahead_time:
            raise armstep.InputError("lookahead_time: must be at least the shield's period")
        way = (lookahead_time + 2.0 * shield.dt) * float(shield.tables.limits["velocity"].max())
        super().__init__(shield, takes_velocity=False, following_error=SLACK + way)
        self._smoothing = (shield.dt, lookahead_time, gain)
        self._control = rtde_control.RTDEControlInterface(host, 1.0 / shield.dt)
        self._receive = rtde_receive.RTDEReceiveInterface(host)
        self._period: Any = None
        self._stamp = (math.nan, self.now())  # of the robot's clock, and when it came [s]

    def reset(self) -> None:
        """Forget a stop too; the robot is to be released, and its script sent again, before."""
        super().reset()
        self._is_stopped = False

    def read(self) -> Any:
        """Return measured positions (n,) [rad]; None: the robot is silent."""
        if self._period is not None:
            self._control.waitPeriod(self._period)
        self._period = self._control.initPeriod()
        stamp = self._receive.getTimestamp()
        if stamp != self._stamp[0]:
            self._stamp = (stamp, self.now())
        self._stop(self._reason())
        is_known = self.now() - self._stamp[1] <= SILENCE
        return np.array(self._receive.getActualQ()) if is_known else None

    def _reason(self) -> str:
        """Return why the robot does not move; "": it does."""
        mode = self._receive.getSafetyMode()
        if mode not in SAFE_MODES:
            return STOPS.get(mode, f"safety mode {mode}")
        return "" if self._control.isProgramRunning() else "program ended"

    def _stop(self, reason: str) -> None:
        if reason:
            self._is_stopped = True
            self.hold(reason)

    def send(self, command: armstep.ShieldCommand) -> None:
        """Send the positions of the next period."""
        if not self._is_stopped:
            goal = command.next_q.tolist()
            if not self._control.servoJ(goal, 0.0, 0.0, *self._smoothing):
                self._stop(self._reason() or "servoJ refused")

    def run(self, ask: Callable[[], Mapping[str, Any]], duration: float = math.inf) -> str:
        """Drive as `Drive.run` does, let the robot catch up, and leave servo mode."""
        try:
            ended = super().run(ask, duration)
            end = self.now() + CATCH_UP
            while self.command is not None and not self._is_stopped and self.now() < end:
                self.read()
                self.send(self.command)
            return ended
        finally:
            self._control.servoStop()
