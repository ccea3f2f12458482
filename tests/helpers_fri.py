"""A second reader and writer of FRI's messages, by the wire rules of protobuf.

Wire rules: https://protobuf.dev/programming-guides/encoding. Field numbers: KUKA's client SDK. It
shares nothing with the package, and does not need the package protobuf.
"""

from __future__ import annotations

import struct

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
