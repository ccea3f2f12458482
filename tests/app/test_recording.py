"""A recording of a shield's steps on an arm, and its replay by judges that are not the shield's."""

import json
import threading
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_commands import call
from helpers_export import needs, use_armstep
from iiwa_dnn import Box, Configuration, Shield, Sphere, TipSpeedLimit, export, load_robot
from iiwa_dnn.app.recording import _distances, read_recording
from iiwa_dnn.robot.collision import collision_model

pytestmark = needs("gcc")

DT = 4e-3
SECONDS = 26.0
ROBOT = load_robot("panda")
START = ROBOT.start_posture()
SWING = 0.25 * np.array([1.0, 0.5, 1.0, 0.5, 1.0, 1.0, 1.0])
AWAY = [0.3, 0.0, 0.0]


def among(t: float, first: float, length: float) -> bool:
    return first <= t < first + length


def drive(shield: Any, clock: list[float], faults: bool) -> None:
    """Drive an arm along sinusoids; with faults of its own, not of the shield."""
    path = [START]
    tip = Configuration(ROBOT, START).position
    for k in range(round(SECONDS / DT)):
        t = DT * k
        elapsed = 4.0 * DT if faults and among(t, 19.0, 0.2) and k % 10 == 0 else DT
        behind = 20 if faults and among(t, 6.0, 4.0) else 1
        measured = path[max(0, len(path) - behind)].copy()
        if faults and among(t, 14.0, 0.2):
            measured[3] = ROBOT.q_lower[3] - 0.02
        place = tip + AWAY
        if faults and among(t, 22.0, 0.2):
            place = Configuration(ROBOT, measured).position + [0.05, 0.0, 0.05]
        goal = START + SWING * np.sin(0.9 * t + np.arange(7))
        given = {"position": goal, "elapsed": elapsed, "obstacles": [place]}
        shield.measured = measured
        path.append(shield.step(path[-1], **given).next_q)
        clock[0] += elapsed


def record(shield: Any, folder: Path, clock: list[float], **own: Any) -> Any:
    """Record a shield's steps on a clock of their own."""
    return use_armstep().recorded(shield, folder, now=lambda: clock[0], **own)


@pytest.fixture(scope="module")
def tables(tmp_path_factory: pytest.TempPathFactory) -> Path:
    ball = Sphere(Configuration(ROBOT, START).position + AWAY, 0.05)
    shield = Shield(ROBOT, DT, [ball], longest_period=0.02)
    return export.tables(shield, tmp_path_factory.mktemp("tables") / "arm.json")


@pytest.mark.parametrize("faults", [True, False])
def test_lag_a_limit_late_cycles_and_a_near_pair_are_found_where_they_are(
    faults: bool,
    tables: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    armstep = use_armstep()
    clock = [100.0]
    with record(armstep.Shield(tables), tmp_path / "day1", clock) as shield:
        drive(shield, clock, faults)
        assert shield.tables.name == "arm"
    assert call("replay", tmp_path / "day1") == int(faults)
    *found, last = capsys.readouterr().out.splitlines()
    assert last.endswith(f"to attach: {tmp_path / 'day1.zip'}")
    expected = (
        "period [of the stated one] 4 1.5 19.",
        "following error [rad]",
        "lag [s] 0.07",
        "measured position [rad outside] 0.02",
        "measured velocity [of the limit]",
        "lack of distance [m]",
    )
    assert len(found) == faults * len(expected)
    for line, words in zip(found, expected, strict=faults):
        assert line.startswith(f"found {words}")
    report = (tmp_path / "day1" / "report.md").read_text(encoding="utf-8")
    assert "- not judged: none of its limits\n" in report
    assert ("Sphere 1 and panda_" in report) == faults or "lack of distance" in report
    with zipfile.ZipFile(tmp_path / "day1.zip") as own:
        assert {"day1/report.md", "day1/recording.png", "day1/head.json"} < {*own.namelist()}


def test_periods_that_vary_delays_and_silence_are_judged_as_they_were(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Periods are stated by what has elapsed; the arm is as late as its shield was told."""
    armstep = use_armstep()
    late = 8
    shield = Shield(ROBOT, DT, [], longest_period=0.02, delay=late * DT)
    shield.limits = (*shield.limits, TipSpeedLimit(3.0))
    clock, path = [0.0], [START] * (late + 1)
    random = np.random.default_rng(0)
    made = armstep.Shield(export.tables(shield, tmp_path / "arm.json"))
    with record(made, tmp_path / "day2", clock) as arm:
        for k in range(900):
            elapsed = DT * random.uniform(0.8, 1.2)
            blind = 500 <= k < 520
            seen = None if blind else path[-1 - late]
            dq = np.sign(np.sin(0.02 * k + np.arange(7)))
            path.append(path[-1] + elapsed * arm.step(seen, dq=dq, elapsed=elapsed).dq)
            clock[0] += elapsed
    assert call("replay", tmp_path / "day2") == 1
    found, _ = capsys.readouterr().out.splitlines()
    assert found.startswith("found steps without positions 1 0 2.")
    assert " 20, " in found
    report = (tmp_path / "day2" / "report.md").read_text(encoding="utf-8")
    assert "- not judged: tip speed limit\n" in report


def test_boxes_that_stand_for_links_beside_links_are_not_judged_beside_obstacles() -> None:
    robot = load_robot("iiwa7_dual")
    model = collision_model(robot)
    box = next(each for each in model.bodies if isinstance(each.shape, Box))
    capsule = next(each.shape for each in model.capsules if each.link == box.link)
    q = robot.start_posture()
    link = Configuration(robot, q).frame(box.link)
    shape, place = box.shape.box.grown(0.0)
    signs = 1.0 - 2.0 * np.indices((2, 2, 2)).reshape(3, 8).T
    corners = [place.act(sign * shape.halfSide) - capsule.b for sign in signs]
    corner = max(corners, key=lambda each: each[2])  # away from the link before
    away = (capsule.radius + 0.0201 + 0.05) / np.linalg.norm(corner)
    ball = Sphere((link.position + link.rotation @ (capsule.b + away * corner)).tolist(), 0.05)
    scene = {"distance": 0.02, "obstacles": [ball.settings()]}
    rows = np.zeros(2, [("measured", float, 14), ("places", float, (1, 3))])
    rows["measured"] = q
    tables = {"dt": DT, "scene": scene, "obstacle_names": ["Sphere 1"]}
    found = _distances(tables, rows, np.zeros(2), robot)
    assert (found.value < 0.0).all()
    assert found.words[0].endswith(f"Sphere 1 and {box.link}")


def test_the_ring_keeps_the_last_chunks_whole(tables: Path, tmp_path: Path) -> None:
    armstep = use_armstep()
    folder = tmp_path / "ring"
    clock = [100.0]
    shield = record(armstep.Shields(tables, 1), folder, clock, minutes=1 / 6)
    for k in range(6000):
        command = shield.step(START[np.newaxis], dq=np.full((1, 7), 0.1 * (k % 2)), dt=DT)
        clock[0] += DT
    shield.close()
    shield.close()
    assert len([*folder.glob("*.npz")]) == 1
    assert not [*folder.glob("*.part")]
    head, rows = read_recording(folder)
    assert head["tables"]["digest"] == shield.tables.digest
    assert len(rows) == 1000
    assert rows["dq"][-1].tobytes() == command.dq[0].tobytes()
    assert rows["request"][-1][:7].tolist() == [0.1] * 7
    assert (rows["kind"][-1], rows["dt"][-1]) == (1, DT)
    with pytest.raises(FileExistsError):
        armstep.recorded(armstep.Shield(tables), folder)


def test_a_disk_that_is_slow_at_first_loses_no_chunk(
    tables: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    armstep = use_armstep()
    save, ready = np.savez_compressed, threading.Event()

    def save_when_ready(*arguments: Any, **given: Any) -> None:
        assert ready.wait(60.0)
        save(*arguments, **given)

    monkeypatch.setattr(np, "savez_compressed", save_when_ready)
    clock = [100.0]
    with record(armstep.Shield(tables), tmp_path / "slow", clock) as shield:
        for _ in range(6000):
            shield.step(START, dq=np.zeros(7))
            clock[0] += DT
        threading.Timer(0.2, ready.set).start()
    _, rows = read_recording(tmp_path / "slow")
    assert len(rows) == 6000


def test_what_is_no_recording_is_said_in_a_line(
    tables: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with record(use_armstep().Shield(tables), tmp_path / "short", [0.0]) as shield:
        shield.step(START, dq=np.zeros(7))
    assert call("replay", tmp_path / "short") == 2
    assert "recording: lasts 0.00 s, less than 2.25 s" in capsys.readouterr().err
    assert call("replay", tmp_path) == 2
    (tmp_path / "head.json").write_text(json.dumps({"tables": {}}), encoding="utf-8")
    assert call("replay", tmp_path) == 2
    (tmp_path / "1.npz").write_bytes(b"no chunk")
    assert call("replay", tmp_path) == 2
    said = capsys.readouterr().err.splitlines()
    assert len(said) == 3
    assert all("holds no recording: " in line for line in said)
