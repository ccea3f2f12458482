"""A Franka arm as a plant: against a stand-in here, against an independent server elsewhere."""

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

import iiwa_dnn
from helpers_franka import Arm, listening, module
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Motion
from iiwa_dnn.results.failures import failures
from iiwa_dnn.schemes.motion_limits import braking_room
from iiwa_dnn.simulation.plants import franka

ROBOT = iiwa_dnn.load_robot("fr3")
START = ROBOT.start_posture()
LIMITS = (iiwa_dnn.AccelerationLimits(), iiwa_dnn.JerkLimits())
SCHEME = iiwa_dnn.DoubleIndicator(tracking="next", next_gain=100.0, extra_limits=LIMITS)


# kConnect: status kIncompatibleLibraryVersion, version 10
REFUSAL = bytes.fromhex("00000000 00000000 0f000000 01 0a00")


@pytest.fixture
def arm(monkeypatch: pytest.MonkeyPatch) -> Iterator[Arm]:
    flange = iiwa_dnn.Configuration(ROBOT, START).frame("link8").position
    made = Arm(START.copy(), flange)
    monkeypatch.setitem(sys.modules, "pylibfranka", module(made))
    monkeypatch.setattr(
        "iiwa_dnn.simulation.runner.version", lambda name: "0" if "libfranka" in name else "1"
    )
    with listening(REFUSAL) as port:
        monkeypatch.setattr(franka, "PORT", port)
        yield made


class Jumping(iiwa_dnn.Reference):
    """A pose somewhere in the joints' ranges, another one every 0.25 s."""

    duration = np.inf
    period = np.inf
    name = "jumping"

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        drawn = rng.uniform(ROBOT.q_lower, ROBOT.q_upper, (99, 7))
        self.poses = [iiwa_dnn.Configuration(ROBOT, q) for q in drawn]

    def motion(self, t: float) -> Motion:
        pose = self.poses[int(t / 0.25)]
        return Motion(pose.position, np.zeros(3), pose.rotation)


def drive(plant: iiwa_dnn.FrankaPlant, reference: Any = None, **options: Any) -> iiwa_dnn.Record:
    if reference is None:
        reference = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(ROBOT, START))
    arguments = {"dt": 1e-3, "duration": 0.05, "check": iiwa_dnn.CrossCheck(()), **options}
    robot = plant.with_room(ROBOT)
    return iiwa_dnn.simulate(robot, SCHEME, reference, START, plant=plant, **arguments)


def test_the_arm_follows_a_path_and_rests_at_its_end(arm: Arm) -> None:
    record = drive(iiwa_dnn.FrankaPlant("127.0.0.1"), duration=0.3)
    assert record.settings["status"] == "completed"
    assert failures(record) == []
    assert arm.finished
    assert not arm.dq.any()
    assert arm.broken == []
    assert_allclose(record.position, record.position_desired, atol=2e-5)


@pytest.mark.filterwarnings("ignore:the reference begins")
@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_hostile_targets_and_lost_cycles_break_no_limit(arm: Arm, policy: str) -> None:
    rng = np.random.default_rng(5)
    steps = rng.choice(np.arange(1, 1000), 40, replace=False)
    arm.lost = {int(k): int(rng.integers(1, 6)) for k in steps}
    plant = iiwa_dnn.FrankaPlant("127.0.0.1")
    record = drive(plant, Jumping(3), duration=1.0, policy=policy)
    assert arm.broken == []
    late = record.settings["plant"]["late_s"]
    assert len(late) >= 30  # an arm that goes on as it was told has not lost anything
    elapsed = np.diff(record.t)
    assert_allclose(elapsed.sum(), 1e-3 * (1000 + sum(arm.lost.values()) - len(arm.lost)))
    assert (np.abs(record.dq) < ROBOT.dq_max).all()


@pytest.mark.filterwarnings("ignore:the reference begins")
def test_without_room_lost_cycles_break_limits(arm: Arm) -> None:
    arm.lost = dict.fromkeys(range(50, 1000, 50), 5)
    plant = iiwa_dnn.FrankaPlant("127.0.0.1", lost_cycles=0)
    drive(plant, Jumping(3), duration=1.0)
    assert any("velocity" in line for line in arm.broken)


def test_the_robots_error_ends_the_run_and_the_record_is_there(arm: Arm) -> None:
    arm.fails = 20
    record = drive(iiwa_dnn.FrankaPlant("127.0.0.1"))
    assert record.steps == 20
    first = 'Move command aborted! ["test_reflex"]'
    assert record.settings["status"] == f"stopped at step 19 (t = 0.019 s): {first}"
    assert first in failures(record)[0] or first in failures(record)[1]


def test_a_robot_that_falls_silent_before_the_motion_is_given_up(arm: Arm) -> None:
    arm.states = 2  # at the connection, and one that waits in the socket
    record = drive(iiwa_dnn.FrankaPlant("127.0.0.1"))
    assert record.settings["status"] == "stopped at step 0 (t = 0 s): UDP receive: Timeout"
    assert arm.count == 0


@pytest.mark.parametrize(
    ("answer", "line"),
    [
        (None, "no answer within 0.2 s; another program may be connected"),
        (b"", "the connection was closed without an answer"),
    ],
)
def test_a_robot_that_does_not_answer_is_named(
    arm: Arm, monkeypatch: pytest.MonkeyPatch, answer: bytes | None, line: str
) -> None:
    monkeypatch.setattr(franka, "PATIENCE", 0.2)
    with listening(answer) as port, monkeypatch.context() as patch:
        patch.setattr(franka, "PORT", port)
        with pytest.raises(InvalidInputError, match=f"host: 127.0.0.1: {line}$"):
            _ = iiwa_dnn.FrankaPlant("127.0.0.1").posture
    monkeypatch.setattr(franka, "PORT", port)  # where nobody listens any more
    with pytest.raises(InvalidInputError, match=r"host: 127\.0\.0\.1: Connection refused"):
        _ = iiwa_dnn.FrankaPlant("127.0.0.1").posture


def test_a_command_that_was_taken_after_all_is_found_in_the_echo(arm: Arm) -> None:
    plant = iiwa_dnn.FrankaPlant("127.0.0.1")
    plant.start(ROBOT, START, 1e-3, 0)
    plant.read()
    for velocity in (1e-3, 3e-3):
        plant.move(np.full(7, velocity))
        plant.read()
    assert plant.substitutes is None
    # It went on without the third, took it after that, and the fourth in time.
    arm.lost = {3: 1}
    plant.move(np.full(7, 6e-3))
    assert_allclose(plant.substitutes, np.outer([5e-3, 3e-3], np.ones(7)), atol=1e-8)
    arm.dq = np.full(7, 6e-3)
    plant.move(np.full(7, 7.5e-3))
    assert_allclose(plant.substitutes, np.outer([7.5e-3, 6e-3], np.ones(7)), atol=1e-8)
    assert len(plant.settings()["plant"]["late_s"]) == 1
    # A state that shows neither: an older command was taken, and the last one is on its way.
    arm.dq = np.full(7, 6.5e-3)
    arm.ddq = np.full(7, 0.5)
    monkey = arm.step
    arm.step = lambda dq: None
    plant.move(np.full(7, 9e-3))
    assert plant.substitutes is None
    arm.step = monkey


def test_the_commanded_joints_stay_near_the_encoders(arm: Arm) -> None:
    plant = iiwa_dnn.FrankaPlant("127.0.0.1", lag=0.01)
    plant.start(ROBOT, START, 1e-3, 0)
    plant.read()
    arm.q = arm.q + np.array([0.5, -0.5, 0.005, 0.0, 0.0, 0.0, 0.0])
    plant.move(np.zeros(7))
    away = plant.read() - START
    assert_allclose(away, [0.49, -0.49, 0.0, 0.0, 0.0, 0.0, 0.0], atol=1e-6)


def test_a_lost_last_command_does_not_leave_the_arm_in_motion(arm: Arm) -> None:
    drive(iiwa_dnn.FrankaPlant("127.0.0.1"), duration=0.3)
    count = arm.count
    for lost in range(count - 4, count):
        arm.count = 0
        arm.q = START.copy()
        arm.ddq = np.zeros(7)
        arm.lost = {lost: 3}
        drive(iiwa_dnn.FrankaPlant("127.0.0.1"), duration=0.3)
        assert not arm.dq.any()
        assert arm.broken == []


def test_measured_feedback_is_the_encoders(arm: Arm) -> None:
    plant = iiwa_dnn.FrankaPlant("127.0.0.1", feedback="measured")
    plant.start(ROBOT, START, 1e-3, 0)
    arm.q = arm.q + 1e-3
    plant.read()
    plant.move(np.full(7, 0.001))
    assert_allclose(plant.read(), arm.q, atol=1e-6)


@pytest.mark.parametrize(
    ("change", "line"),
    [
        ({"host": ""}, "host: is needed"),
        ({"q0": START + 0.1}, "the arm stands 0.1 rad from it"),
        ({"dt": 2e-3}, "dt: must be the robot's 0.001 s, not 0.002 s"),
        ({"robot": iiwa_dnn.load_robot("iiwa7")}, "robot: is not that of the arm"),
        ({"lost_cycles": -1}, "lost_cycles"),
    ],
)
def test_what_cannot_move_is_refused_in_one_line(
    arm: Arm, change: dict[str, Any], line: str
) -> None:
    given = {"host": "127.0.0.1", "robot": ROBOT, "q0": START, "dt": 1e-3} | change

    def start() -> None:
        plant = iiwa_dnn.FrankaPlant(given["host"], lost_cycles=given.get("lost_cycles", 5))
        plant.start(given["robot"], given["q0"], given["dt"], 0)

    with pytest.raises(InvalidInputError, match=line) as caught:
        start()
    assert "\n" not in str(caught.value)


def test_the_room_before_a_ramp_is_the_least_one() -> None:
    acceleration = np.full(7, 10.0)
    braking, room = braking_room(ROBOT.ramps, acceleration)
    v = np.linspace(0.0, 5.0, 5001)[:, np.newaxis]
    offset, deceleration = ROBOT.ramps
    lacking = (v + offset) ** 2 / (2.0 * deceleration) - v**2 / (2.0 * braking)
    assert_allclose(lacking.max(axis=0), room, rtol=1e-5)
    assert (braking <= acceleration).all()
