"""When an arm behind a shield begins and brakes, of drivers without an arm."""

import math
import signal
from pathlib import Path
from typing import Any

import armstep
import numpy as np
import pytest
from armstep.drive import Channel, Drive, Following, Joints, Recent

import iiwa_dnn
from judge_limits import breaches

DT = 4e-3
LIMITS = {"lower": np.array([-np.inf, -2.0]), "upper": np.array([np.inf, 2.0])}
START = np.array([3.0, 0.3])


def wrapped(q: np.ndarray) -> np.ndarray:
    """Return positions as an encoder of the first joint counts them, from -pi to pi."""
    return np.array([(q[0] + np.pi) % (2.0 * np.pi) - np.pi, q[1]])


def test_late_states_beyond_the_seam_of_an_encoder_are_where_the_commands_were() -> None:
    following = Following(LIMITS, 2.0 * DT, 0.1, True)
    following.begin(0.0, START, 0.0 * START)
    path = [START]
    random = np.random.default_rng(0)
    for k in range(1, 500):
        dq = np.array([0.5, np.sin(k)])
        following.command(dq)
        following.advance(k * DT, DT, DT)
        path.append(path[-1] + DT * dq)
        seen = random.integers(0, 20)
        following.see((k - seen) * DT, wrapped(path[max(k - seen - 2, 0)]))
        np.testing.assert_allclose(following.error, 0.0, atol=1e-9)
        turns = following.measured(k * DT) - path[max(k - 2, 0)]
        np.testing.assert_allclose(wrapped(turns), 0.0, atol=1e-9)
    assert path[-1][0] > np.pi


@pytest.mark.parametrize(
    ("noise", "dq", "expected"),
    [
        (2e-5, [0.0, 0.0], [0.0, 0.0]),  # exactly: noise is no motion
        (2e-5, [0.5, 0.0], [0.5, 0.0]),
        (7e-4, [0.0, 0.0], [0.0, 0.0]),  # after the longer time
        (2e-3, [0.0, 0.0], None),
    ],
)
def test_velocity_of_an_arm_that_is_not_commanded(noise: float, dq: list, expected: list) -> None:
    recent = Recent(LIMITS, 0.1)
    random = np.random.default_rng(0)
    for k in range(300):
        q = START + k * DT * np.array(dq) + noise * random.uniform(-1.0, 1.0, 2)
        recent.see(k * DT, wrapped(q))
        assert k * DT >= 0.1 or recent.velocity() is None
    if expected is None:
        assert recent.velocity() is None
    else:
        tolerance = 1e-3 * np.array(np.any(expected))
        np.testing.assert_allclose(recent.velocity(), expected, atol=float(tolerance))


def test_an_arm_that_accelerates_has_no_velocity_to_begin_with() -> None:
    recent = Recent(LIMITS, 0.1)
    for k in range(150):
        recent.see(k * DT, START + 0.5 * (k * DT) ** 2)
    assert recent.velocity() is None


ROBOT = iiwa_dnn.load_robot("so101").with_limits(acceleration=10.0, jerk=200.0)


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the tables of a shield whose periods vary."""
    path = tmp_path_factory.mktemp("drive") / "arm.json"
    iiwa_dnn.export.tables(iiwa_dnn.Shield(ROBOT, 0.02, longest_period=0.03), path)
    iiwa_dnn.export.tables(iiwa_dnn.Shield(ROBOT, 0.02), path.with_name("fixed.json"))
    return path


class Ideal(Drive):
    """An arm that is where it was told to be, by a clock that its periods make."""

    def __init__(self, tables: Path, **settings: Any) -> None:
        super().__init__(armstep.Shield(tables), **settings)
        self.q = np.zeros(ROBOT.dof)
        self.path: list[np.ndarray] = []
        self.t = 0.0

    def now(self) -> float:
        return self.t

    def read(self) -> np.ndarray | None:
        self.t += self.shield.dt
        self.path.append(self.q)
        return self.q

    def send(self, command: armstep.ShieldCommand) -> None:
        self.q = self.q + self.shield.dt * command.dq


def test_ctrl_c_brings_the_arm_to_rest_within_its_limits(tables: Path) -> None:
    arm = Ideal(tables)

    def ask() -> dict[str, Any]:
        if len(arm.path) == 60:
            signal.raise_signal(signal.SIGINT)
        return {"dq": np.full(ROBOT.dof, 0.5)} if len(arm.path) > 20 else {}

    before = signal.getsignal(signal.SIGINT)
    assert arm.run(ask) == "interrupted"
    assert signal.getsignal(signal.SIGINT) is before
    assert arm.is_at_rest
    assert arm.q.min() > 0.2
    assert breaches(np.array(arm.path), arm.shield.dt, *ROBOT.limits) == []


def test_an_error_of_the_request_is_raised_once_the_arm_rests(tables: Path) -> None:
    arm = Ideal(tables)

    def ask() -> dict[str, Any]:
        if len(arm.path) == 60:
            raise ValueError("the stick is gone")
        return {"dq": np.full(ROBOT.dof, 0.5)}

    with pytest.raises(ValueError, match="the stick is gone"):
        arm.run(ask)
    assert arm.is_at_rest
    assert len(arm.path) > 65
    assert breaches(np.array(arm.path), arm.shield.dt, *ROBOT.limits) == []


@pytest.mark.parametrize(
    "request_", [{"dq": np.ones(2)}, {"dq": "up"}, {"torque": 1.0}, {"dq": []}]
)
def test_a_request_that_no_shield_takes_is_raised_once_the_arm_rests(
    tables: Path, request_: dict[str, Any]
) -> None:
    arm = Ideal(tables)
    usual = {"dq": np.full(ROBOT.dof, 0.5)}
    with pytest.raises((armstep.InputError, TypeError)):
        arm.run(lambda: request_ if len(arm.path) > 60 else usual)
    assert arm.is_at_rest
    assert len(arm.path) > 65
    assert breaches(np.array(arm.path), arm.shield.dt, *ROBOT.limits) == []


@pytest.mark.parametrize(
    "wrong", [np.full(ROBOT.dof, np.nan), np.zeros(2), np.full(ROBOT.dof, 1e9)]
)
def test_readings_that_are_no_positions_are_raised_once_the_arm_rests(
    tables: Path, wrong: np.ndarray
) -> None:
    arm = Ideal(tables)

    def ask() -> dict[str, Any]:
        if len(arm.path) == 60:
            arm.read = lambda: wrong if Ideal.read(arm) is not None else None
        return {"dq": np.full(ROBOT.dof, 0.5)}

    with pytest.raises(armstep.InputError, match=r"measured: .* are not the positions of"):
        arm.run(ask)
    assert arm.is_at_rest
    assert breaches(np.array(arm.path), arm.shield.dt, *ROBOT.limits) == []


@pytest.mark.parametrize(
    ("q", "reason"),
    [(None, "no joint states"), (np.full(ROBOT.dof, 0.4), "does not follow its commands")],
)
def test_an_arm_that_is_not_seen_or_does_not_follow_brakes(
    tables: Path, q: np.ndarray | None, reason: str
) -> None:
    arm = Ideal(tables)
    faults = set()

    def ask() -> dict[str, Any]:
        faults.add(arm.fault)
        if len(arm.path) == 60:
            arm.read = lambda: q if Ideal.read(arm) is not None else None
        return {"dq": np.full(ROBOT.dof, 0.5)}

    arm.run(ask, 2.0)
    assert any(reason in fault for fault in faults)
    assert breaches(np.array(arm.path), arm.shield.dt, *ROBOT.limits) == []


def test_after_a_stall_nobody_was_seen(tmp_path: Path) -> None:
    """People were as old as a usual period had made them, and arms that went on met them."""
    robot = ROBOT.with_limits(jerk=np.inf)
    about = {"people": 1, "field": 9.0, "people_speed": 1.6, "longest_period": 0.05}
    made = iiwa_dnn.Shield(robot, 0.02, [], **about)
    iiwa_dnn.export.tables(made, tmp_path / "people.json")
    with pytest.raises(armstep.InputError, match="need velocity"):
        Drive(armstep.Shield(tmp_path / "people.json"), takes_velocity=False)
    drive = Drive(armstep.Shield(tmp_path / "people.json"))
    q = robot.start_posture()
    path = [q]
    t = 0.0
    moved = []
    for k in range(200):
        elapsed = 0.9 if k == 100 else 0.02
        t += elapsed
        drive.see(t, q)
        if drive.has_begun and not 100 <= k < 150:
            drive.shield.see(people=[[4.0, 0.0, 0.3, 4.0, 0.0, 0.3, 0.1]], age=0.0)
        command = drive.step(t, elapsed, {"dq": np.full(robot.dof, 0.2 if k > 50 else 0.0)})
        dq = command.dq if command else 0.0 * q
        q = q + 0.02 * dq
        path.append(q)
        moved.append(bool(np.any(dq)))
    assert moved[99]
    assert not any(moved[110:150])
    assert moved[-1]
    assert breaches(np.array(path), 0.02, *robot.limits) == []


def test_servos_in_degrees_wait_for_one_that_is_stuck(tables: Path) -> None:
    names = [f"motor_{k}" for k in range(ROBOT.dof)]
    joints = Joints(names, math.radians(1.0))
    about = {"takes_velocity": False, "following_error": 0.2, "joints": joints, "stands": True}
    servos = Drive(armstep.Shield(tables), **about)
    goals = dict.fromkeys(names, 0.0)
    wanted = joints.ordered(names[::-1], [60.0] * ROBOT.dof)
    for k in range(100):
        shown = goals | {"motor_1": 0.0, "gripper": 7.0}
        servos.see(0.02 * k, joints.ordered(shown, shown.values()))
        command = servos.step(0.02 * k, 0.02, {"position": wanted})
        goals = joints.goals(command.next_q)
    assert servos.fault == "motor_1 does not follow"
    assert np.degrees(0.2) < goals["motor_1"] < 30.0  # and the way to rest
    assert goals["motor_2"] == pytest.approx(60.0)


def test_a_driver_is_refused_by_name(tables: Path) -> None:
    shield = armstep.Shield(tables)
    with pytest.raises(armstep.InputError, match="joints"):
        Drive(shield, joints=Joints("a" * ROBOT.dof))
    with pytest.raises(armstep.InputError, match="longest_period"):
        Drive(armstep.Shield(tables.with_name("fixed.json")))
    for names, values, words in (
        ("abcd", [0.0] * 4, "without joint 'e'"),
        ("abcdee", [0.0] * 6, "twice"),
        ("abcde", [0.0, 0.0, 0.0, 0.0, np.nan], "not finite"),
        ("abcde", ["open"] * 5, "not numbers"),
    ):
        with pytest.raises(armstep.InputError, match=words):
            Joints("abcde").ordered(names, values)


def test_a_gripper_goes_through_at_a_limited_speed() -> None:
    gripper = Channel(50.0, 10.0)
    passed = [gripper.step(wanted, 0.02) for wanted in (10.5, 100.0, np.nan, 0.0)]
    assert passed == [10.5, 11.5, 11.5, 10.5]
    assert Channel(math.inf).step(3.0, 0.02) == 3.0
