"""The robot's side of FRI: its messages read by hand, its states, and what it refuses."""

from __future__ import annotations

import numpy as np
import pytest

from fri_robot import MIRRORED_PERIODS, READY_PERIODS, WINDOW, FriController
from helpers_fri import read_monitoring, write_command
from helpers_simulation import paper_start
from iiwa_dnn import InvalidInputError, load_robot
from iiwa_dnn.simulation import IdealPlant

pytest.importorskip("google.protobuf")

PERIOD = 5e-3
IDLE, MONITORING_WAIT, MONITORING_READY, COMMANDING_WAIT, COMMANDING_ACTIVE = range(5)
POOR, FAIR, GOOD, EXCELLENT = range(4)


@pytest.fixture(scope="module")
def robot():
    return load_robot("iiwa7")


@pytest.fixture
def q0():
    return np.array(paper_start().q)


@pytest.fixture
def controller(robot, q0):
    return FriController(robot, IdealPlant(), q0, PERIOD)


class HandClient:
    """A client that reads and writes bytes by the wire rules, and answers as it is told."""

    def __init__(self, controller):
        self.controller = controller
        self.counter = 0
        self.seen = []

    def answer(self, q=None, lag=0):
        """The answer to the last message, or to one `lag` messages before; q None: its own."""
        message = self.seen[-1]
        q = message["commanded"] if q is None else q
        data = write_command(self.counter, message["sequence"] - lag, q)
        self.counter += 1
        return data

    def period(self, *datagrams):
        """One period in which the robot gets these bytes; with none given, its own position."""
        for data in datagrams:
            self.controller.receive(data)
        self.controller.advance()

    def look(self):
        self.seen.append(read_monitoring(self.controller.message()))
        return self.seen[-1]

    def follow(self, periods, velocity=0.0):
        for _ in range(periods):
            q = np.array(self.look()["commanded"]) + PERIOD * velocity
            self.period(self.answer(q))

    def activate(self):
        while self.look()["state"] != COMMANDING_ACTIVE:
            self.period(self.answer())
            assert len(self.seen) < 1000


@pytest.fixture
def client(controller):
    return HandClient(controller)


@pytest.fixture
def active(client):
    client.activate()
    return client


def test_a_message_holds_the_sdk_s_fields(client, q0) -> None:
    message = client.look()
    assert message["identifier"] == 0x245142
    assert message["joints"] == 7
    assert message["drives"] == [2] * 7
    assert (message["state"], message["quality"]) == (MONITORING_WAIT, POOR)
    assert (message["period"], message["multiplier"]) == (5, 1)
    assert message["measured"] == message["commanded"] == q0.tolist()
    assert message["held"] == []  # the SDK takes it for a sign of commanding


def test_the_states_follow_one_another_as_in_fri(client, q0) -> None:
    client.activate()
    states = [message["state"] for message in client.seen]
    changes = [i for i in range(1, len(states)) if states[i] != states[i - 1]]
    assert [states[i] for i in changes] == [MONITORING_READY, COMMANDING_WAIT, COMMANDING_ACTIVE]
    ready, wait, begun = changes
    assert ready == 0.9 * WINDOW  # the first messages had no answer before them
    assert wait - ready == READY_PERIODS
    assert begun - wait == MIRRORED_PERIODS
    assert all(message["quality"] >= GOOD for message in client.seen[ready:])
    assert all(message["held"] == q0.tolist() for message in client.seen[wait:])
    assert [m["sequence"] for m in client.seen] == list(range(len(client.seen)))
    # Each message repeats the counter of the answer to the one before.
    assert [m["reflected"] for m in client.seen[1:]] == list(range(len(client.seen) - 1))


def test_commands_are_not_followed_before_they_repeat_the_position(client, q0) -> None:
    while client.look()["state"] != COMMANDING_WAIT:
        client.period(client.answer())
    for _ in range(3 * MIRRORED_PERIODS):
        client.period(client.answer(q0 + 1e-3))
        assert client.look()["state"] == COMMANDING_WAIT
        assert client.seen[-1]["measured"] == q0.tolist()


def test_commands_move_the_arm(active, q0) -> None:
    velocity = np.array([0.5, -0.5, 1.0, 0.2, 2.0, -3.0, 3.0])
    active.follow(20, velocity)
    np.testing.assert_allclose(active.look()["measured"], q0 + 20 * PERIOD * velocity, atol=1e-14)
    assert active.controller.fault is None


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda q, full: q + 1.01 * PERIOD * full * np.eye(7)[3], "joint 4 jumps, 1.01 times"),
        (lambda q, full: q - np.pi * np.eye(7)[0], "joint 1 is at"),
        (lambda q, full: q * np.where(np.arange(7) == 2, np.nan, 1.0), "7 finite joint positions"),
        (lambda q, full: q + np.inf, "7 finite joint positions"),
        (lambda q, full: q[:6], "7 finite joint positions"),
        (lambda q, full: [], "7 finite joint positions"),
    ],
)
def test_what_is_unsafe_is_refused_and_ends_the_session(active, robot, q0, change, reason) -> None:
    active.period(active.answer(np.asarray(change(q0, robot.dq_max)).tolist()))
    assert active.look()["state"] == IDLE
    assert reason in active.controller.fault
    active.follow(5, np.ones(7))
    assert active.look()["measured"] == q0.tolist()


def test_full_speed_is_followed(active, robot, q0) -> None:
    active.follow(10, robot.dq_max * np.sign(-q0))
    assert active.look()["state"] == COMMANDING_ACTIVE


def test_without_a_command_the_arm_keeps_its_position(active) -> None:
    active.follow(3, np.full(7, 0.5))
    before = active.look()["measured"]
    active.period()
    assert active.look()["measured"] == before
    assert active.seen[-1]["reflected"] == active.seen[-2]["reflected"]


def test_doubled_overtaken_and_garbled_packets_change_nothing(active) -> None:
    active.follow(5, np.full(7, 0.1))
    active.look()
    older = active.answer(np.array(active.seen[-1]["commanded"]) + 4e-4)
    newer = active.answer(np.array(active.seen[-1]["commanded"]) + 3e-4)
    wanted = np.array(active.seen[-1]["commanded"]) + 3e-4
    foreign = write_command(active.counter + 9, 0, np.zeros(7), identifier=0x34002)
    active.period(newer, newer, older, newer[:-3], b"", b"\xff" * 40, foreign)
    np.testing.assert_array_equal(active.look()["commanded"], wanted)
    packets = active.controller.connection.packets
    assert packets["repeated"] == 2
    assert packets["garbled"] == 4


def test_a_late_answer_is_followed_but_not_in_time(active) -> None:
    active.look()
    late = active.answer(np.array(active.seen[-1]["commanded"]) + 1e-4)
    active.period()
    wanted = np.array(active.look()["commanded"]) + 1e-4
    active.period(late)
    np.testing.assert_array_equal(active.look()["commanded"], wanted)
    packets = active.controller.connection.packets
    assert (packets["late"], packets["missing"]) == (1, 1)


@pytest.mark.parametrize(("velocity", "fault"), [(0.3, "became FAIR in motion"), (0.0, None)])
def test_a_client_that_falls_silent_ends_the_session(active, velocity, fault) -> None:
    active.follow(WINDOW, np.full(7, velocity))
    stood = active.look()["commanded"]
    lost = 0
    while active.controller.state != IDLE:
        lost += 1
        active.period()
        assert (active.look()["quality"] >= GOOD) == (lost <= 0.1 * WINDOW)
    assert lost == 0.1 * WINDOW + 1
    assert active.seen[-1]["quality"] == FAIR
    assert active.seen[-1]["measured"] == stood
    shown = active.controller.fault
    assert shown is None if fault is None else fault in shown


def test_silence_before_commands_leads_back_to_monitoring(client) -> None:
    while client.look()["state"] != COMMANDING_WAIT:
        client.period(client.answer())
    for _ in range(WINDOW // 5):
        client.period()
    assert client.look()["state"] == MONITORING_WAIT
    client.activate()


def test_a_client_may_begin_anew_while_it_is_monitored(client) -> None:
    for _ in range(10):
        client.look()
        client.period(client.answer())
    assert client.look()["state"] != COMMANDING_ACTIVE
    client.counter = 0
    client.activate()
    assert client.look()["state"] == COMMANDING_ACTIVE


@pytest.mark.parametrize(
    ("period", "q0", "name"),
    [
        (1.5e-3, None, "period"),
        (0.2, None, "period"),
        (-1.0, None, "period"),
        (5e-3, np.full(7, 3.0), "q0"),
        (5e-3, np.zeros(6), "q0"),
    ],
)
def test_arguments_are_checked(robot, period, q0, name) -> None:
    with pytest.raises(InvalidInputError) as refused:
        FriController(robot, IdealPlant(), np.zeros(7) if q0 is None else q0, period)
    assert refused.value.argument == name


def test_fri_is_for_seven_joints() -> None:
    with pytest.raises(InvalidInputError, match="must have 7 joints, not 14"):
        FriController(load_robot("iiwa7_dual"), IdealPlant(), np.zeros(14), PERIOD)
