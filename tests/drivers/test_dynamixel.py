"""Dynamixel servos behind a shield: the maker's own SDK on a bus that its documents describe."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import armstep
import numpy as np
import pytest
from armstep_drivers import dynamixel
from armstep_drivers.dynamixel import Dynamixel

import iiwa_dnn
from fake_dynamixel import Bus, Servo
from judge_limits import breaches

sdk = pytest.importorskip("dynamixel_sdk", reason="pip install dynamixel-sdk")

DT = 0.02
IDS = (11, 12, 13, 14, 15)
ZEROS = np.array([2048, 1900, 2200, 2048, 2048])
SIGNS = np.array([1, -1, 1, -1, 1])
ROBOT = iiwa_dnn.load_robot("so101").with_limits(
    lower=-1.5, upper=1.5, velocity=3.0, acceleration=20.0, jerk=400.0
)


def ticks(q: np.ndarray) -> np.ndarray:
    return ZEROS + SIGNS * q * 4096 / (2.0 * np.pi)


def angles(at: np.ndarray) -> np.ndarray:
    return (at - ZEROS) * SIGNS * 2.0 * np.pi / 4096


START = angles(np.round(ticks(np.array([0.3, -0.6, 0.6, 0.8, 0.0]))))


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("servos") / "arm.json"
    iiwa_dnn.export.tables(iiwa_dnn.Shield(ROBOT, DT, obstacles=[]), path)
    return path


@pytest.fixture
def bus(monkeypatch: pytest.MonkeyPatch) -> Bus:
    bus = Bus(dict(zip(IDS, map(Servo, ticks(START)), strict=True)))
    monkeypatch.setattr(sdk, "PortHandler", lambda port: bus)
    monkeypatch.setattr(dynamixel, "time", SimpleNamespace(sleep=bus.sleep))
    monkeypatch.setattr(Dynamixel, "now", lambda _: bus.t)
    return bus


class Recorded(Dynamixel):
    """An arm that keeps the positions that were sent."""

    def __init__(self, tables: Path) -> None:
        self.sent: list[np.ndarray] = []
        super().__init__(armstep.Shield(tables), "/dev/ttyUSB0", IDS, ZEROS, SIGNS)

    def send(self, command: armstep.ShieldCommand) -> None:
        self.sent.append(command.next_q)
        super().send(command)
        goals = [servo.number(116, 4) for servo in self._port.servos.values()]
        if not any(servo.number(98, 1) < 0 for servo in self._port.servos.values()):
            assert np.abs(goals - ticks(command.next_q)).max() <= 0.5


def place(bus: Bus) -> np.ndarray:
    return angles(np.array([servo.ticks for servo in bus.servos.values()]))


def test_hostile_requests_keep_the_limits_and_servos_follow(tables: Path, bus: Bus) -> None:
    random = np.random.default_rng(0)
    wanted: dict[str, Any] = {}
    arm = Recorded(tables)
    np.testing.assert_allclose(place(bus), START, atol=1e-9)  # torque on, and nothing moves

    def ask() -> dict[str, Any]:
        if random.random() < 0.1:
            kind = random.choice(["dq", "position"])
            wanted.clear()
            wanted[kind] = random.choice([0.3, 3.0, 30.0]) * random.normal(size=5)
        return wanted

    assert arm.run(ask, 20.0) == "the time is over"
    sent = np.array(arm.sent)
    assert np.abs(sent[0] - START).max() < 2e-3  # a tick, and a period's acceleration
    assert np.ptp(sent, axis=0).min() > 1.0
    assert breaches(np.vstack([START, sent]), DT, *ROBOT.limits) == []
    bus.sleep(0.2)
    np.testing.assert_allclose(place(bus), sent[-1], atol=2e-3)
    assert all(servo.number(98, 1) == 0 for servo in bus.servos.values())


@pytest.mark.parametrize(("bit", "word"), [(5, "overload"), (2, "overheating")])
def test_a_servo_in_error_holds_the_others(tables: Path, bus: Bus, bit: int, word: str) -> None:
    arm = Recorded(tables)

    def ask() -> dict[str, Any]:
        if bus.t > 1.0:
            bus.servos[13].fail(bit)
        return {"dq": [0.4, 0.0, 0.1, 0.1, 0.4]}

    assert arm.run(ask, 10.0) == f"{arm.joints.names[2]}: {word}"
    assert bus.t < 2.0
    assert arm.is_at_rest
    assert breaches(np.vstack([START, *arm.sent]), DT, *ROBOT.limits) == []


def test_servos_stop_by_themselves_if_the_program_does(tables: Path, bus: Bus) -> None:
    arm = Recorded(tables)
    still: list[np.ndarray] = []

    def ask() -> dict[str, Any]:
        if bus.t > 1.0 and not still:
            bus.sleep(0.4)
            still.append(place(bus))
            bus.sleep(0.4)
            still.append(place(bus))
        return {"dq": np.full(5, 0.3)}

    arm.run(ask, 2.0)
    np.testing.assert_array_equal(still[0], still[1])
    begun = Recorded(tables)  # clears the error of the watchdog
    assert begun.run(lambda: {"position": START}, 3.0) == "the time is over"
    np.testing.assert_allclose(place(bus), START, atol=2e-3)


def test_a_lost_packet_and_a_stuck_servo(tables: Path, bus: Bus) -> None:
    arm = Recorded(tables)
    faults = set()

    def ask() -> dict[str, Any]:
        faults.add(arm.fault)
        bus.servos[12].answers = not 0.5 < bus.t < 0.53
        bus.servos[14].is_stuck = bus.t > 0.6
        return {"position": np.full(5, -1.0)}

    assert arm.run(ask, 3.0) == "the time is over"
    assert {"", "no joint states", f"{arm.joints.names[3]} does not follow"} <= faults
    np.testing.assert_allclose(np.delete(place(bus), 3), -1.0, atol=2e-3)
    assert breaches(np.vstack([START, *arm.sent]), DT, *ROBOT.limits) == []


@pytest.mark.parametrize(
    ("fault", "words"),
    [("mode", "position control"), ("silent", "silent"), ("error", "elbow_flex: overload")],
)
def test_servos_that_cannot_be_driven_are_refused_without_torque(
    tables: Path, bus: Bus, fault: str, words: str
) -> None:
    servo = bus.servos[13]
    if fault == "error":
        servo.fail(5)
    servo.memory[11] = 4 if fault == "mode" else 3
    servo.answers = fault != "silent"
    with pytest.raises(armstep.InputError, match=words):
        Recorded(tables)
    assert not any(each.memory[64] for each in bus.servos.values())


def test_limits_beyond_a_turn_are_refused(tables: Path, bus: Bus) -> None:
    with pytest.raises(armstep.InputError, match="beyond the 4096 ticks"):
        Dynamixel(armstep.Shield(tables), "/dev/ttyUSB0", IDS, zeros=700)
