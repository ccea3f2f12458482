"""An arm of Universal Robots behind a shield, by a robot that its documents describe."""

import sys
from pathlib import Path
from typing import Any

import armstep
import numpy as np
import pytest
from armstep_drivers.ur import UR

import iiwa_dnn
from fake_ur import Robot
from judge_limits import breaches

DT = 8e-3
ROBOT = iiwa_dnn.load_robot("ur5").with_limits(acceleration=8.0, jerk=80.0)
START = ROBOT.start_posture()


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("ur") / "ur5.json"
    iiwa_dnn.export.tables(iiwa_dnn.Shield(ROBOT, DT, obstacles=[]), path)
    iiwa_dnn.export.tables(iiwa_dnn.Shield(ROBOT, 0.05), path.with_name("slow.json"))
    varying = iiwa_dnn.Shield(ROBOT, DT, longest_period=2.0 * DT)
    iiwa_dnn.export.tables(varying, path.with_name("varying.json"))
    return path


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> Robot:
    robot = Robot(START.tolist())
    for name, module in robot.modules().items():
        monkeypatch.setitem(sys.modules, name, module)
    monkeypatch.setattr(UR, "now", lambda _: robot.t)
    return robot


def connect(tables: Path, **settings: Any) -> UR:
    return UR(armstep.Shield(tables), "192.168.1.2", **settings)


@pytest.mark.parametrize("lookahead", [0.03, 0.1, 0.2])
def test_goals_of_a_slow_hostile_policy_keep_the_limits_and_the_robot_follows(
    tables: Path, robot: Robot, lookahead: float
) -> None:
    random = np.random.default_rng(0)
    wanted: dict[str, Any] = {}

    def ask() -> dict[str, Any]:
        if len(robot.path) % 12 == 0:  # 10 Hz
            kind = random.choice(["dq", "position"])
            wanted.clear()
            wanted[kind] = random.choice([0.3, 3.0, 30.0]) * random.normal(size=6)
        return wanted

    assert connect(tables, lookahead_time=lookahead).run(ask, 20.0) == "the time is over"
    assert robot.mode == 1
    goals = np.array(robot.goals)
    assert abs(len(goals) - 22.0 / DT) < 100  # one each period, and to rest
    assert np.ptp(goals, axis=0).min() > 0.3
    assert breaches(np.vstack([START, goals]), DT, *ROBOT.limits) == []
    assert np.abs(robot.dq).max() < 1e-3
    np.testing.assert_allclose(robot.q, goals[-1], atol=1e-3)


def test_the_arm_does_not_stop_between_goals_at_a_low_rate(tables: Path, robot: Robot) -> None:
    slow = connect(tables.with_name("slow.json"))
    slow.run(lambda: {"dq": [0.0, 0.0, 0.0, 0.5, 0.0, 0.0]}, 2.0)
    speeds = np.diff(np.array(robot.path)[20:36, 3]) / 0.05
    assert 0.4 < speeds.min() <= speeds.max() < 0.6


def test_nothing_is_sent_after_a_protective_stop_and_it_begins_anew_where_it_is(
    tables: Path, robot: Robot
) -> None:
    arm = connect(tables)

    def ask() -> dict[str, Any]:
        if len(robot.path) == 100:
            robot.stop()
        return {"dq": np.full(6, 0.5)}

    assert arm.run(ask, 5.0) == "protective stop"
    sent = np.array(robot.goals)
    assert 60 < len(sent) <= 100
    assert np.abs(robot.dq).max() < 0.01
    assert np.abs(arm.command.next_q - robot.q).max() > 0.01  # there it would jump
    robot.release()
    arm.reset()
    assert arm.run(lambda: {"dq": np.zeros(6)}, 1.0) == "the time is over"
    assert robot.mode == 1
    np.testing.assert_allclose(np.array(robot.goals), [robot.q] * len(robot.goals), atol=1e-4)


@pytest.mark.parametrize("fault", ["silence", "program", "safeguard", "refusal"])
def test_the_arm_brakes_and_says_why(tables: Path, robot: Robot, fault: str) -> None:
    arm = connect(tables)
    faults = set()
    reason = {
        "silence": "no joint states",
        "program": "program ended",
        "safeguard": "safeguard stop",
        "refusal": "servoJ refused",
    }[fault]

    def ask() -> dict[str, Any]:
        faults.add(arm.fault)
        if len(robot.path) == 100:
            robot.is_silent = fault == "silence"
            robot.has_program = fault != "program"
            robot.mode = 5 if fault == "safeguard" else 1
            if fault == "refusal":
                robot.servoJ = lambda *_: False
        return {"dq": np.full(6, 0.2)}

    ended = arm.run(ask, 2.0)
    assert reason in (faults if fault == "silence" else {ended})
    assert arm.is_at_rest
    assert breaches(np.vstack([START, *robot.goals]), DT, *ROBOT.limits) == []


@pytest.mark.parametrize(
    ("table", "settings", "words"),
    [
        ("ur5.json", {"lookahead_time": 0.02}, "lookahead_time: must be 0.03 to 0.2"),
        ("ur5.json", {"gain": 50.0}, "gain: must be 100 to 2000"),
        ("slow.json", {"lookahead_time": 0.04}, "at least the shield's period"),
        ("varying.json", {}, "longest_period: servoJ's is constant"),
    ],
)
def test_a_number_out_of_range_is_refused(
    tables: Path, robot: Robot, table: str, settings: dict[str, float], words: str
) -> None:
    with pytest.raises(armstep.InputError, match=words):
        connect(tables.with_name(table), **settings)
