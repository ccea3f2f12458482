"""A second reader and writer of FRI's messages, by the wire rules of protobuf, and a lossy network.

Wire rules: https://protobuf.dev/programming-guides/encoding. Field numbers: KUKA's client SDK. It
shares nothing with the package, and does not need the package protobuf.
"""

from __future__ import annotations

import random
import socket
import struct
import threading
from select import select

VARINT = 0
FIXED64 = 1
DELIMITED = 2


def read_varint(data, i):
    """The number at byte i, and the index behind it."""
    number = 0
    for shift in range(0, 70, 7):
        number |= (data[i] & 0x7F) << shift
        i += 1
        if data[i - 1] < 0x80:
            return number, i
    raise ValueError("a varint without an end")


def read_fields(data):
    """Field number -> values of a message: ints, floats, or bytes."""
    fields: dict[int, list] = {}
    i = 0
    while i < len(data):
        key, i = read_varint(data, i)
        if key & 7 == VARINT:
            value, i = read_varint(data, i)
        elif key & 7 == FIXED64:
            (value,) = struct.unpack_from("<d", data, i)
            i += 8
        elif key & 7 == DELIMITED:
            size, i = read_varint(data, i)
            value = data[i : i + size]
            i += size
        else:
            raise ValueError(f"wire type {key & 7}")
        fields.setdefault(key >> 3, []).append(value)
    return fields


def inner(fields, number):
    """Fields of the one message that a field holds; {} if it is not there."""
    contents = fields.get(number)
    if contents is None:
        return {}
    (content,) = contents
    return read_fields(content)


def read_monitoring(data):
    """What the tests look at in a robot's message."""
    message = read_fields(data)
    header = inner(message, 1)
    robot = inner(message, 2)
    monitor = inner(message, 3)
    connection = inner(message, 4)
    return {
        "identifier": header[1][0],
        "sequence": header[2][0],
        "reflected": header[3][0],
        "joints": robot[1][0],
        "drives": robot[5],
        "measured": inner(monitor, 1)[1],
        "commanded": inner(monitor, 3)[1],
        "state": connection[1][0],
        "quality": connection[2][0],
        "period": connection[3][0],
        "multiplier": connection[4][0],
        "held": inner(inner(message, 5), 1).get(1, []),
    }


def read_command(data):
    """Identifier, counter, reflected counter and joint positions of a client's message."""
    message = read_fields(data)
    header = inner(message, 1)
    q = inner(inner(message, 2), 1)[1]
    return header[1][0], header[2][0], header[3][0], q


def varint(number):
    encoded = b""
    while number > 0x7F:
        encoded += bytes([number & 0x7F | 0x80])
        number >>= 7
    return encoded + bytes([number])


def delimited(number, content):
    return varint(number << 3 | DELIMITED) + varint(len(content)) + content


def write_command(counter, reflected, q=None, identifier=0x34001):
    """A client's message; q None: without joint positions."""
    values = (identifier, counter, reflected)
    header = b"".join(varint(n << 3 | VARINT) + varint(v) for n, v in enumerate(values, 1))
    data = delimited(1, header)
    if q is not None:
        doubles = b"".join(varint(1 << 3 | FIXED64) + struct.pack("<d", value) for value in q)
        data += delimited(2, delimited(1, doubles))
    return data


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(("127.0.0.1", 0))
        return link.getsockname()[1]


class Network(threading.Thread):
    """A UDP proxy between a robot, which sends to `port`, and a client at `client_port`.

    A seeded share of the packets, in both directions, is lost, doubled, kept back until the next
    one has gone, or garbled.
    """

    def __init__(self, client_port, share=0.0, kinds=("lose", "double", "delay", "garble"), seed=0):
        super().__init__(daemon=True)
        self.share = share
        self.kinds = kinds
        self.counts = dict.fromkeys(kinds, 0)
        self._random = random.Random(seed)
        self._client = ("127.0.0.1", client_port)
        self._robot = None
        self._links = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2)]
        for link in self._links:
            link.bind(("127.0.0.1", 0))
        self.port = self._links[0].getsockname()[1]
        self._late: list = [None, None]
        self._ended = threading.Event()

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *error):
        self._ended.set()
        self.join(5.0)
        for link in self._links:
            link.close()

    def run(self):
        while not self._ended.is_set():
            for link in select(self._links, [], [], 0.05)[0]:
                data, sender = link.recvfrom(2000)
                from_robot = link is self._links[0]
                if from_robot:
                    self._robot = sender
                self._pass_on(int(from_robot), data)

    def _pass_on(self, side, data):
        link = self._links[side]
        address = (self._robot, self._client)[side]
        packets = [data]
        if self.share and self._random.random() < self.share:
            kind = self._random.choice(self.kinds)
            self.counts[kind] += 1
            if kind == "lose":
                packets = []
            elif kind == "double":
                packets = [data, data]
            elif kind == "delay":
                self._late[side] = data
                return
            else:
                # Cut between two fields it would be a message, without what the second one holds.
                packets = [data[:-1]]
        if self._late[side] is not None:
            packets.append(self._late[side])
            self._late[side] = None
        for packet in packets:
            link.sendto(packet, address)
