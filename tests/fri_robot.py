"""A robot's side of KUKA's Fast Robot Interface (FRI), with an arm that follows every command.

The robot sends a monitoring message in every period, and the client answers it by a command; both
are in protobuf's wire format. Field numbers are those of KUKA's client SDK 1.11 to 2.5. KUKA
publishes states and messages, but no numbers: the length of the waiting states is this module's.
It is for programs, not for safety.
"""

import socket
import struct
from collections.abc import Iterator
from itertools import islice
from typing import Any

import numpy as np

from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.robot import Robot

CLIENT = ("127.0.0.1", 30200)
"""Address of the client; KUKA's port is fixed."""

MONITORING_ID = 0x245142
COMMAND_ID = 0x34001

IDLE, MONITORING_WAIT, MONITORING_READY, COMMANDING_WAIT, COMMANDING_ACTIVE = range(5)

WAITING = 20
"""Periods in MONITORING_READY, and in COMMANDING_WAIT, where positions have to be repeated."""

ROUNDING = 1e-6
"""Rounding of a repeated position [rad], and of a velocity limit, relative to it."""


def varint(value: int) -> bytes:
    """Encode a whole number."""
    low = value & 0x7F
    return bytes([low]) if value == low else bytes([low | 0x80]) + varint(value >> 7)


def encode(fields: dict[int, Any]) -> bytes:
    """Encode a message by its fields' numbers: whole numbers, joint values (7,), or messages."""
    data = b""
    for number, value in fields.items():
        if isinstance(value, int):
            data += varint(8 * number) + varint(value)
        else:
            if isinstance(value, dict):
                inner = encode(value)
            else:
                inner = b"".join(struct.pack("<Bd", 9, joint) for joint in value)
            data += varint(8 * number + 2) + varint(len(inner)) + inner
    return data


def number_at(data: Iterator[int]) -> int:
    """Decode the whole number that comes next."""
    byte = next(data)
    return byte if byte < 0x80 else byte - 0x80 + (number_at(data) << 7)


def decode(message: bytes) -> dict[int, Any]:
    """Decode a message into whole numbers and bytes by their fields' numbers."""
    found: dict[int, Any] = {}
    data = iter(message)
    for tag in data:
        value = number_at(data)
        found[tag >> 3] = bytes(islice(data, value)) if tag & 7 == 2 else value
    return found


def monitoring(state: int, sequence: int, reflected: int, q: Vector, period: float) -> bytes:
    """Encode a monitoring message for joint position control, of an arm that is at q (7,) [rad]."""
    zeros = np.zeros(7)
    message = {
        1: {1: MONITORING_ID, 2: sequence, 3: reflected},
        2: {1: 7},  # joints
        3: {1: q, 2: zeros, 3: q, 4: zeros, 5: zeros, 15: {1: 0, 2: 0}},  # measured and commanded
        4: {1: state, 2: 3, 3: round(1e3 * period), 4: 1},  # an excellent connection
    }
    if state >= COMMANDING_WAIT:
        message[5] = {1: q, 10: 1, 11: 1}  # an overlay of joint positions, by positions
    return encode(message)


def serve(robot: Robot, q0: Vector, period: float, periods: int) -> Matrix:
    """Let a client command a robot, not in real time; a fault is an AssertionError.

    Returns:
        The start and the commanded joint positions [rad], (periods, 7).
    """
    path = [q0]
    state = MONITORING_WAIT
    sequence = reflected = since = 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.settimeout(1.0)
        try:
            while len(path) < periods:
                link.sendto(monitoring(state, sequence, reflected, path[-1], period), CLIENT)
                try:
                    answer = decode(link.recv(1500))
                except TimeoutError:  # the client may not have begun
                    since += 1 if state == MONITORING_WAIT else 10
                    assert since < 10, "no answer"
                    continue
                header = decode(answer[1])
                assert (header[1], header[3]) == (COMMAND_ID, sequence)
                reflected = header[2]
                sequence += 1
                since += 1
                if state >= COMMANDING_WAIT:
                    joints = struct.iter_unpack("<xd", decode(answer[2])[1])  # without their tags
                    q = np.ravel(list(joints))
                    ratio = np.abs(q - path[-1]) / (period * robot.dq_max)
                    assert ratio.max() < 1.0 + ROUNDING, f"{ratio} times the velocity limits"
                    assert not robot.outside(q), robot.outside(q)
                    if state == COMMANDING_ACTIVE:
                        path.append(q)
                    elif np.abs(q - q0).max() > ROUNDING:
                        since = 0
                if state < COMMANDING_ACTIVE and (since > WAITING or state == MONITORING_WAIT):
                    state += 1
                    since = 0
        finally:
            for _ in range(3):  # some may be lost
                link.sendto(monitoring(IDLE, sequence, reflected, path[-1], period), CLIENT)
    return np.array(path)
