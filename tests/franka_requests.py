"""Hostile requests of a slow policy, sent by UDP as the client's cycles count, not as a clock does.

A clock would let the requests meet other cycles on each machine, and other cycles are lost: what a
test finds would be another motion each time.
"""

import json
import socket
from collections.abc import Iterator

import numpy as np

CYCLES = 33
"""Cycles of 1 ms between two requests."""


def packets() -> Iterator[bytes | None]:
    """Draw packets, in runs of a kind; None: there is none."""
    random = np.random.default_rng(0)
    bad = (b"", b"{}", b'{"dq": [1]}', b'{"twist": "up"}', b'{"dq": [1e999, 0, 0, 0, 0, 0, 0]}')
    while True:
        kind = random.choice(["dq", "twist", "position", "bad", "silence"])
        size = random.choice([1.0, 3.0, 30.0])
        for _ in range(random.integers(1, 30)):
            numbers = size * random.normal(size=6 if kind == "twist" else 7)
            packet = json.dumps({str(kind): numbers.tolist()}).encode()
            if kind == "bad":
                packet = bad[random.integers(len(bad))]
            yield None if kind == "silence" else packet


class Sender:
    """Sends the packets to a port of this machine, one at every so many cycles."""

    def __init__(self, port: int) -> None:
        self._place = ("127.0.0.1", port)
        self._link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._packets = packets()

    def cycle(self, number: int) -> None:
        """Send the next packet if this is its cycle."""
        packet = next(self._packets) if number % CYCLES == 0 else None
        if packet is not None:
            self._link.sendto(packet, self._place)
