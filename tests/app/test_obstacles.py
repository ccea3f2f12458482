"""``track --obstacles``: the arm keeps away, the report says so, a bad file is one line."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import iiwa_dnn
from helpers_records import draw_only
from iiwa_dnn import Record
from iiwa_dnn.app.main import main

FILE = """distance = 0.03
[[obstacle]]
shape = "sphere"
center = [0.36, 0.16, 0.64]
radius = 0.05
"""


def test_a_run_keeps_away_and_its_report_says_so(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    draw_only(monkeypatch, "convergence")
    (tmp_path / "obstacles.toml").write_text(FILE, encoding="utf-8")
    words = ["track", "--obstacles", str(tmp_path / "obstacles.toml"), "--dt", "5e-3"]
    assert main([*words, "--duration", "3", "--out", str(tmp_path / "run")]) == 0
    text = capsys.readouterr().out
    assert "nearest pair: iiwa7_link_4 and Sphere 1" in text
    record = Record.load(tmp_path / "run" / "record.npz")
    assert record.distance.min() >= 0.03
    report = (tmp_path / "run" / "report.md").read_text(encoding="utf-8")
    assert "nearest pair: " in report
    again = ["track", "--settings", str(tmp_path / "run" / "settings.toml"), "--no-plots"]
    assert main([*again, "--out", str(tmp_path / "again")]) == 0
    repeated = Record.load(tmp_path / "again" / "record.npz")
    assert (repeated.q == record.q).all()


def test_links_without_collision_geometry_are_told_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = Path(str(iiwa_dnn.load_robot("iiwa7").path)).read_text(encoding="utf-8")
    root = ET.fromstring(text)
    for name in ("iiwa7_link_5", "iiwa7_link_6"):
        link = root.find(f"link[@name='{name}']")
        assert link is not None
        for shape in link.findall("collision"):
            link.remove(shape)
    (tmp_path / "arm.urdf").write_text(ET.tostring(root, encoding="unicode"), encoding="utf-8")
    (tmp_path / "obstacles.toml").write_text(FILE, encoding="utf-8")
    words = ["track", "--robot", str(tmp_path / "arm.urdf"), "--no-plots", "--dt", "5e-3"]
    words += ["--obstacles", str(tmp_path / "obstacles.toml"), "--duration", "0.01"]
    main([*words, "--check", "none", "--out", str(tmp_path / "run")])
    told = "nothing keeps these links clear, they have no <collision> geometry: iiwa7_link_5, iiwa7"
    out, err = capsys.readouterr()
    assert err.count(told) == 1
    assert f"Beware: {told}" in out.partition("\nverdict ")[2]
    assert told in (tmp_path / "run" / "report.md").read_text(encoding="utf-8")


def test_a_start_that_is_too_near_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    robot = iiwa_dnn.load_robot("iiwa7")
    elbow = iiwa_dnn.Configuration(robot, robot.start_posture()).frame("iiwa7_link_4").position
    ball = f'[[obstacle]]\nshape = "sphere"\ncenter = {elbow.tolist()}\nradius = 0.05\n'
    (tmp_path / "near.toml").write_text(ball, encoding="utf-8")
    words = ["track", "--dt", "5e-3", "--duration", "0.01", "--check", "none", "--no-plots"]
    words += ["--obstacles", str(tmp_path / "near.toml"), "--out", str(tmp_path / "run")]
    assert main(words) == 1
    assert "begin farther away: another start posture" in capsys.readouterr().out


def test_a_bad_file_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "bad.toml").write_text(FILE.replace("0.05", "-1"), encoding="utf-8")
    out = str(tmp_path / "run")
    assert main(["track", "--obstacles", str(tmp_path / "bad.toml"), "--out", out]) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert "bad.toml: obstacle 1: radius: must be a finite number above 0" in message
    assert not (tmp_path / "run").exists()
