"""``fri-robot``: what it prints, and its exit codes; the client is written by the wire rules."""

from __future__ import annotations

import socket
import sys
import threading

import numpy as np
import pytest

from helpers_fri import free_port, read_monitoring, write_command
from iiwa_dnn.app.main import run

pytest.importorskip("google.protobuf", reason="pip install 'iiwa-dnn[fri]'")


class Client(threading.Thread):
    """A client that repeats the robot's position, and after some commands adds a jump."""

    def __init__(self, jump):
        super().__init__(daemon=True)
        self.jump = jump
        self.port = free_port()
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.bind(("127.0.0.1", self.port))
        self.link.settimeout(10.0)

    def run(self):
        active = 0
        with self.link:
            for counter in range(1000):
                data, robot = self.link.recvfrom(1500)
                message = read_monitoring(data)
                active += message["state"] == 4
                if message["state"] == 0 or (active > 20 and not self.jump):
                    return
                q = np.array(message["commanded"])
                q[2] += self.jump * (active > 10)
                self.link.sendto(write_command(counter, message["sequence"], q), robot)


def serve(capsys, jump, *words):
    client = Client(jump)
    client.start()
    code = run("fri-robot", ["--no-realtime", "--port", str(client.port), *words])
    client.join(10.0)
    return code, capsys.readouterr()


@pytest.mark.parametrize("words", [("--ideal",), ()])
def test_states_and_packets_are_printed(capsys, words) -> None:
    code, shown = serve(capsys, 0.0, *words, "--period", "0.002")
    assert code == 0
    assert shown.err == ""
    first, *states, last = shown.out.splitlines()
    assert first.startswith("iiwa7, " + ("ideal arm" if words else "arm in MuJoCo"))
    assert first.endswith("every 2 ms")
    assert states == [
        "MONITORING_WAIT",
        "MONITORING_READY",
        "COMMANDING_WAIT",
        "COMMANDING_ACTIVE",
        "IDLE",
    ]
    assert "in time, 11 missing" in last


def test_a_refused_command_is_an_error(capsys) -> None:
    code, shown = serve(capsys, 0.1, "--ideal", "--verbose")
    assert code == 1
    assert "command refused: joint 3 jumps, 11.5 times its velocity limit" in shown.err
    assert "COMMANDING_ACTIVE, connection EXCELLENT" in shown.out


def test_without_protobuf_the_remedy_is_named(capsys, monkeypatch) -> None:
    from iiwa_dnn.simulation.plants import fri_messages

    monkeypatch.setitem(sys.modules, "google.protobuf", None)
    monkeypatch.delitem(sys.modules, "google.protobuf.descriptor_pb2", raising=False)
    fri_messages.message_types.cache_clear()
    try:
        assert run("fri-robot", ["--ideal"]) == 2
    finally:
        fri_messages.message_types.cache_clear()
    assert "pip install 'iiwa-dnn[fri]'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--period", "0.0015"], "period: must be whole milliseconds from 1 to 100, not 1.5"),
        (["--robot", "iiwa7_dual"], "robot: must have 7 joints, not 14"),
        (["--q0", "0", "0", "0", "3", "0", "0", "0"], "joint 4 is at 3"),
        (["--host", "no.such.host.invalid"], "host: no.such.host.invalid"),
    ],
)
def test_wrong_options(capsys, words, message) -> None:
    assert run("fri-robot", ["--ideal", "-q", *words]) == 2
    assert message in capsys.readouterr().err
