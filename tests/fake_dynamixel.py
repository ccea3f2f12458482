"""A bus of Dynamixel servos behind a serial port, byte by byte as its documents describe it.

Protocol 2.0: packets with stuffing and CRC-16, sync read and sync write. A goal beyond a turn, or
after the watchdog's time, is passed over; a servo in error has no torque until it is rebooted.
https://emanual.robotis.com/docs/en/dxl/protocol2/, https://emanual.robotis.com/docs/en/dxl/x/xl330-m288/
"""

import numpy as np

READ, WRITE, STATUS = 0x82, 0x83, 0x55
STEP = 1e-3  # [s]
LAG = 0.02  # of a servo behind its goal [s]
FASTEST = 4096 * 103 / 60.0  # without a load [ticks/s]


def crc(data: bytes) -> int:
    """Return the CRC-16 of the polynomial 0x8005, bit by bit."""
    found = 0
    for byte in data:
        found ^= byte << 8
        for _ in range(8):
            found = (found << 1 ^ (0x8005 if found & 0x8000 else 0)) & 0xFFFF
    return found


class Servo:
    """A servo's control table, and where it is [ticks]."""

    def __init__(self, ticks: float) -> None:
        self.ticks = ticks
        self.memory = bytearray(147)
        self.memory[11] = 3
        self.silence = 0.0
        self.is_stuck = False
        self.answers = True

    def number(self, address: int, size: int) -> int:
        return int.from_bytes(self.memory[address : address + size], "little", signed=True)

    def fail(self, bit: int) -> None:
        """Set a bit of the hardware error: the torque is off."""
        self.memory[70] |= 1 << bit
        self.memory[64] = 0

    def read(self, address: int, size: int) -> bytes:
        self.memory[132:136] = round(self.ticks).to_bytes(4, "little", signed=True)
        return bytes(self.memory[address : address + size])

    def write(self, address: int, data: bytes) -> None:
        goal = int.from_bytes(data, "little", signed=True)
        if address == 116 and (self.number(98, 1) < 0 or not 0 <= goal < 4096):
            return
        if address == 64 and self.memory[70]:
            return
        self.memory[address : address + len(data)] = data

    def move(self) -> None:
        self.silence += STEP
        watchdog = self.number(98, 1)
        if self.memory[64] and watchdog > 0 and self.silence > 0.02 * watchdog:
            self.memory[98] = 0xFF
        if self.memory[64] and self.number(98, 1) >= 0 and not self.is_stuck:
            way = (self.number(116, 4) - self.ticks) * STEP / LAG
            self.ticks += float(np.clip(way, -FASTEST * STEP, FASTEST * STEP))


class Bus:
    """A serial port with servos by their identifiers, and the clock of all."""

    is_using = False

    def __init__(self, servos: dict[int, Servo]) -> None:
        self.servos = servos
        self.t = 0.0
        self._answer = b""

    def sleep(self, seconds: float) -> None:
        for _ in range(round(seconds / STEP)):
            for servo in self.servos.values():
                servo.move()
        self.t += seconds

    def openPort(self) -> bool:  # noqa: N802
        return True

    def setBaudRate(self, baud: int) -> bool:  # noqa: N802
        return baud == 1_000_000

    def clearPort(self) -> None:  # noqa: N802
        self._answer = b""

    def setPacketTimeout(self, length: int) -> None:  # noqa: N802
        pass

    def isPacketTimeout(self) -> bool:  # noqa: N802
        return not self._answer

    def readPort(self, length: int) -> bytes:  # noqa: N802
        found, self._answer = self._answer[:length], self._answer[length:]
        return found

    def writePort(self, packet: list[int]) -> int:  # noqa: N802
        data = bytes(packet)
        assert data[:5] == b"\xff\xff\xfd\x00\xfe"  # to all
        assert int.from_bytes(data[5:7], "little") == len(data) - 7
        assert int.from_bytes(data[-2:], "little") == crc(data[:-2])
        body = data[7:-2].replace(b"\xff\xff\xfd\xfd", b"\xff\xff\xfd")
        address = int.from_bytes(body[1:3], "little")
        size = int.from_bytes(body[3:5], "little")
        for servo in self.servos.values():
            servo.silence = 0.0
        if body[0] == READ:
            for each in body[5:]:
                if self.servos[each].answers:
                    self._answer += self._status(each, self.servos[each].read(address, size))
        else:
            assert body[0] == WRITE
            for k in range(5, len(body), 1 + size):
                self.servos[body[k]].write(address, body[k + 1 : k + 1 + size])
        return len(data)

    def _status(self, identifier: int, data: bytes) -> bytes:
        error = 0x80 if self.servos[identifier].memory[70] else 0
        body = bytes([STATUS, error]) + data
        stuffed = body.replace(b"\xff\xff\xfd", b"\xff\xff\xfd\xfd")
        length = (len(stuffed) + 2).to_bytes(2, "little")
        packet = b"\xff\xff\xfd\x00" + bytes([identifier]) + length + stuffed
        return packet + crc(packet).to_bytes(2, "little")
