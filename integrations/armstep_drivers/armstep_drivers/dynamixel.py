"""Dynamixel servos of the X series on one bus, in position control by Protocol 2.0.

Addresses, ranges and bits are those of https://emanual.robotis.com/docs/en/dxl/x/xl330-m288/ and
https://emanual.robotis.com/docs/en/dxl/protocol2/. A servo in error lets its load go until it is
rebooted, and neither a sync write nor a sync read of dynamixel-sdk tells: the byte is read.
"""

import math
import time
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import armstep
import numpy as np
from armstep.drive import TURN
from armstep.tables import Array

TICKS = 4096  # of a turn
CENTER = 2048  # [ticks]
POSITION_CONTROL = 3
# Addresses and lengths [bytes]
MODE = (11, 1)
TORQUE = (64, 1)
ERROR = (70, 1)
WATCHDOG = (98, 1)  # [20 ms]; 0 clears its error
PROFILE_ACCELERATION = (108, 4)
PROFILE_VELOCITY = (112, 4)
GOAL = (116, 4)
POSITION = (132, 4)
ERRORS = {0: "input voltage", 2: "overheating", 3: "encoder", 4: "electrical shock", 5: "overload"}
SILENCE = 10  # of the program, after which servos stop by themselves [20 ms]


class Dynamixel(armstep.Drive):
    """Arm of servos that stand when it begins; they hold their places at the end."""

    def __init__(
        self,
        shield: armstep.Shield,
        port: str,
        ids: Sequence[int],
        zeros: Any = CENTER,
        signs: Any = 1,
        baud: int = 1_000_000,
        following_error: float = 0.3,
    ) -> None:
        """Open the bus, and switch the torque on where the servos are.

        Args:
            shield: The shield, of n joints.
            port: Serial port.
            ids: Identifiers of the servos in the order of the joints.
            zeros: Where each joint is at 0 [ticks].
            signs: 1, or -1 where ticks fall while the joint's angle rises.
            baud: Bits a second.
            following_error: Distance from its goal beyond which the goal waits for a servo [rad].

        Raises:
            InputError: A servo is silent, in error, in another mode, or cannot reach the limits.
        """
        import dynamixel_sdk as sdk

        super().__init__(shield, False, following_error=following_error, stands=True)
        self._sdk = sdk
        self._ids = [*ids]
        self._next = -math.inf  # beginning of the next period [s]
        self._zeros = np.asarray(zeros)
        self._scale = np.asarray(signs) * TICKS / TURN
        limits = shield.tables.limits
        ends = self._ticks(np.array([limits["lower"], limits["upper"]]))
        if not ((ends >= 0) & (ends < TICKS)).all():
            raise armstep.InputError("limits: beyond the 4096 ticks of a turn, or without end")
        self._port = sdk.PortHandler(port)
        self._packet = sdk.PacketHandler(2.0)
        if not (self._port.openPort() and self._port.setBaudRate(baud)):
            raise armstep.InputError(f"port: {port} does not open")
        modes = self._read(MODE)
        place = self.read()
        if modes is None or place is None or self.held:
            raise armstep.InputError(self.held or "a servo is silent")
        if (modes != POSITION_CONTROL).any():
            raise armstep.InputError("operating mode: must be position control, 3")
        for where in (WATCHDOG, PROFILE_ACCELERATION, PROFILE_VELOCITY):
            self._write(where, np.zeros(len(self._ids)))
        self._write(GOAL, self._ticks(place))
        self._write(TORQUE, np.ones(len(self._ids)))

    def _ticks(self, q: Array) -> Array:
        return np.round(self._zeros + self._scale * q)

    def _read(self, where: tuple[int, int]) -> Array | None:
        """Return a number of each servo; None: not all have answered."""
        group = self._sdk.GroupSyncRead(self._port, self._packet, *where)
        for each in self._ids:
            group.addParam(each)
        if group.txRxPacket() != self._sdk.COMM_SUCCESS:
            return None
        found = np.array([group.getData(each, *where) for each in self._ids], dtype=np.uint32)
        return found.view(np.int32).astype(float)

    def _write(self, where: tuple[int, int], numbers: Array) -> None:
        """Write a number to each servo, which does not answer."""
        address, size = where
        group = self._sdk.GroupSyncWrite(self._port, self._packet, address, size)
        for each, number in zip(self._ids, numbers.astype(int).tolist(), strict=True):
            group.addParam(each, [*number.to_bytes(size, "little", signed=True)])
        group.txPacket()

    def read(self) -> Array | None:
        """Return measured positions (n,) [rad]; None: not all servos have answered."""
        time.sleep(max(self._next - self.now(), 0.0))
        self._next = max(self._next, self.now() - self.shield.dt) + self.shield.dt
        errors = self._read(ERROR)
        for name, error in zip(self.joints.names, [] if errors is None else errors, strict=False):
            found = [word for bit, word in ERRORS.items() if int(error) >> bit & 1]
            if error:
                self.hold(f"{name}: {', '.join(found) or 'hardware error'}")
        ticks = self._read(POSITION)
        return None if ticks is None else (ticks - self._zeros) / self._scale

    def send(self, command: armstep.ShieldCommand) -> None:
        """Send the goals of the next period."""
        self._write(GOAL, self._ticks(command.next_q))

    def run(self, ask: Callable[[], Mapping[str, Any]], duration: float = math.inf) -> str:
        """Drive as `Drive.run` does; meanwhile servos stop by themselves if the program does."""
        count = len(self._ids)
        self._write(WATCHDOG, np.full(count, SILENCE))
        try:
            return super().run(ask, duration)
        finally:
            self._write(WATCHDOG, np.zeros(count))
