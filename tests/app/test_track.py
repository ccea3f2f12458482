"""The command ``track``: what it writes, what it says, and its exit codes."""

import os
import re
import subprocess
import sys
from functools import wraps
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from helpers_commands import QUICK, SHORT, call, results, track
from helpers_kinematics import PAPER_Q0, dh_pose
from helpers_records import draw_only
from iiwa_dnn.app import track as command
from iiwa_dnn.app.settings import PATHS
from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.simulation import runner

ROOT = Path(__file__).parents[2]
IIWA7 = next((ROOT / "robots" / "iiwa7").glob("*.urdf"))


def test_a_run_writes_record_metrics_report_settings_and_figures(tmp_path, capsys, monkeypatch):
    draw_only(monkeypatch, "convergence")
    folder = tmp_path / "new" / "runs"
    assert call("track", *SHORT, "--out", folder) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    assert "verdict" in captured.out
    assert captured.out.endswith(f"written to {folder}\n")
    files = {"record.npz", "metrics.json", "report.md", "settings.toml"}
    assert {path.name for path in folder.iterdir()} == {
        *files,
        "convergence.png",
        "convergence.pdf",
    }
    assert "(convergence.png)" in (folder / "report.md").read_text()


def test_words_and_tables_reach_the_run(tmp_path: Path) -> None:
    q0 = np.delete(PAPER_Q0, 2)
    file = tmp_path / "mine.toml"
    file.write_text(
        "[scheme]\nweight = 0.1\nkinetic = 'inertia'\n[run]\nseed = 1\nnoise_at = 'measurement'\n"
        "[limits]\nposition = 2.4\nspeed = 0.5\ntip_speed = 1.5\n"
    )
    words = ("--weight", "0.7", "--orientation", "none", "--scale", "1e-3", "--seed", "8")
    words += ("--noise", "1e-8", "--filter-window", "3", "--check", "osqp", "--tolerance", "1e-5")
    words += ("--acceleration-limit", "800", "--jerk-limit", "3e6", "--motion", "midpoint")
    words += ("--set", "scheme.drift_gain=5", "--tip", "iiwa7_link_7")
    words += ("--robot", IIWA7, "--lock", "iiwa7_joint_3")
    record, metrics = track(tmp_path / "run", "--config", file, "--q0", *q0, *words)
    settings = metrics["settings"]
    expected = {
        "robot": "iiwa7",
        "tip": "iiwa7_link_7",
        "q0": q0.tolist(),
        "q_lower": [-2.4] * 6,
        "q_upper": [2.4] * 6,
        "dt": 1e-3,
        "duration": 0.05,
        "motion": "midpoint",
        "noise": 1e-8,
        "noise_at": "measurement",
        "filter_window": 3,
        "seed": 8,
    }
    assert expected.items() <= settings.items()
    np.testing.assert_allclose(settings["dq_max"][0], 0.5 * np.deg2rad(98), rtol=1e-12)
    scheme = {"weight": 0.7, "kinetic": "inertia", "orientation": "none", "drift_gain": 5.0}
    assert scheme.items() <= settings["scheme"].items()
    limits = [limit["limit"] for limit in settings["scheme"]["extra_limits"]]
    assert limits == [800.0, 3e6, 1.5]
    assert settings["reference"]["scale"] == 1e-3
    assert settings["check"]["tolerance"] == 1e-5
    assert record["q"].shape == (51, 6)


@pytest.mark.parametrize(
    ("words", "dt"),
    [((), 1e-4), (("circle",), 1e-3), (("--reference", "circle"), 1e-3)],
)
def test_defaults_are_the_papers_experiment(words, dt, tmp_path, monkeypatch) -> None:
    asked: dict[str, Any] = {}

    def take(robot: Any, scheme: Any, reference: Any, q0: Any, run: Any, progress: Any) -> None:
        progress(0)
        asked.update(robot=robot, scheme=scheme, reference=reference, q0=q0, run=run)
        raise IiwaDnnError("seen enough")

    monkeypatch.setattr(command, "simulate", wraps(command.simulate)(take))
    monkeypatch.setattr(command, "check_folder", lambda folder, *_: asked.update(folder=folder))
    monkeypatch.chdir(tmp_path)
    assert call("track", *words) == 2
    assert asked["run"].dt == dt
    assert asked["folder"] == Path("runs") / ("circle" if words else "heart")
    assert not list(tmp_path.iterdir())
    degrees = [170, 120, 170, 120, 170, 120, 175]  # of the data sheet, not the paper's 2.5 rad
    np.testing.assert_allclose(asked["robot"].q_upper, np.deg2rad(degrees), rtol=1e-8)
    np.testing.assert_array_equal(asked["robot"].q_lower, -asked["robot"].q_upper)
    np.testing.assert_array_equal(asked["q0"], PAPER_Q0)
    scheme = asked["scheme"]
    gains = (scheme.drift_gain, scheme.position_gain, scheme.orientation_gain, scheme.limit_gain)
    assert gains == (10.2, 10.2, 10.2, 20.0)
    assert (scheme.weight, scheme.orientation, scheme.kinetic) == (0.2, "so3", "identity")
    first = asked["reference"].at(0.0).position
    np.testing.assert_allclose(first, dh_pose(PAPER_Q0)[0], rtol=0, atol=1e-12)
    if not words:
        assert (asked["reference"].scale, asked["reference"].period) == (3.45e-3, 10.0)
    assert asked["run"].check.solvers == ("proxqp",)


def test_a_robots_own_limits(tmp_path: Path) -> None:
    words = ("--joint-limit", "datasheet", "--acceleration-limit", "robot", "--check", "none")
    _, metrics = track(tmp_path, *words)
    assert metrics["settings"]["q_upper"][1] == np.deg2rad(120)
    assert metrics["settings"]["scheme"]["extra_limits"][0]["limit"] is None
    words = (
        "--joint-limit",
        "2.5",
        "--set",
        "limits.lower=-2.4",
        "--set",
        "limits.velocity=1.2",
        "--speed",
        "0.5",
    )
    _, metrics = track(tmp_path / "table", *words)
    assert metrics["settings"]["q_lower"] == [-2.4] * 7
    assert metrics["settings"]["q_upper"] == [2.5] * 7
    assert metrics["settings"]["dq_max"] == [0.6] * 7


@pytest.mark.parametrize("name", PATHS)
def test_a_path_goes_by_its_name(name: str, tmp_path: Path) -> None:
    record, metrics = track(tmp_path, name, "--sample", "end", "--check", "none")
    own = metrics["settings"]["reference"]["name"]
    assert own == ("tilting" if name == "tilting-circle" else name)
    turns = np.ptp(record["rotation_desired"], axis=0).max() > 1e-9
    assert turns == (name in ("cone", "tilting-circle"))
    assert 0.0 <= metrics["max_orientation_error_rad"] < 1e-6


def test_a_path_from_a_csv_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = ["t,x,y,z", "0,0,0,0", "0.1,0.002,0,-0.001", "0.2,0.003,0.001,0"]
    (tmp_path / "path.csv").write_text("\n".join(rows))
    monkeypatch.chdir(tmp_path)
    assert call("track", "path.csv", "--no-plots") == 0
    record, metrics = results(tmp_path / "runs" / "path")
    assert metrics["steps"] == 200  # its own duration
    moved = record["position"][[100, -1]] - record["position"][0]
    np.testing.assert_allclose(moved, [[2e-3, 0, -1e-3], [3e-3, 1e-3, 0]], rtol=0, atol=1e-5)
    # From anywhere: the file's path is kept in full.
    monkeypatch.chdir(tmp_path / "runs" / "path")
    assert call("track", "--config", "settings.toml", "-q", "--no-plots") == 0


def test_a_run_is_repeated_bit_for_bit_by_its_settings_and_quietly(tmp_path, capsys) -> None:
    # OSQP repeats itself to the last digit, ProxQP does not.
    words = ("circle", "--noise", "0.01", "--seed", "5", "--filter-window", "4", "--check", "osqp")
    words += ("--acceleration-limit", "none")
    track(tmp_path / "a", *words, "--weight", "0.3", "--lock", "iiwa7_joint_3")
    capsys.readouterr()
    file = tmp_path / "a" / "settings.toml"
    assert call("track", "--config", file, "-q", "--no-plots", "--out", tmp_path / "b") == 0
    assert capsys.readouterr() == ("", "")
    assert not list(tmp_path.rglob("*.p[nd]*"))
    for name in ("record.npz", "settings.toml"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    before = (tmp_path / "a" / "record.npz").read_bytes()
    assert call("track", "--config", file, "-q", "--no-plots") == 0  # again, in its folder
    assert (tmp_path / "a" / "record.npz").read_bytes() == before


def test_another_run_is_overwritten_only_if_it_is_said_and_done(tmp_path, capsys, monkeypatch):
    folder = tmp_path / "run"
    track(folder, "--check", "none")
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    (tmp_path / "notes.txt").write_text("mine")
    capsys.readouterr()
    assert call("track", *QUICK, "--policy", "foo", "--out", folder) == 2
    assert "policy: must be one of" in capsys.readouterr().err  # the bad word is blamed
    for out in (folder, tmp_path):
        assert call("track", *QUICK, "--seed", "1", "--out", out) == 2
        assert f"{out}: holds another run or other files: choose" in capsys.readouterr().err
    with monkeypatch.context() as patch:
        patch.setattr(runner, "CheckPool", Mock(side_effect=KeyboardInterrupt))
        assert call("track", *QUICK, "--seed", "1", "--overwrite", "--out", folder) == 130
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before
    (folder / "video.mp4").touch()
    track(folder, "--seed", "1", "--overwrite")
    assert not (folder / "video.mp4").exists()  # of another run
    assert "seed = 1" in (folder / "settings.toml").read_text()


@pytest.mark.parametrize("quiet", [False, True])
def test_a_broken_limit_is_said_and_exits_1(quiet, tmp_path, capsys) -> None:
    words = ("--joint-limit", "2.35", "--out", tmp_path, *["-q"] * quiet)
    assert call("track", *QUICK, *words) == 1
    captured = capsys.readouterr()
    assert "joint position limit broken by 0.007 rad" in (captured.err if quiet else captured.out)
    assert (captured.out == "") == quiet
    # The start is outside; a warning says so, but not to the quiet.
    assert captured.err.startswith("iiwa-dnn track: the start posture ") != quiet


def test_the_robots_own_rates_hold_unless_the_words_say_none(tmp_path, capsys) -> None:
    """A motion that a hand recorded, twice as quick, beside the limits of libfranka."""
    t = np.linspace(0.0, 1.2, 61)
    sideways = 0.04 * np.sin(2.0 * np.pi * t / 1.2) ** 2 * np.sin(2.0 * np.pi * t / 0.4)
    rows = [f"{time},0,{y},0" for time, y in zip(t, sideways, strict=True)]
    (tmp_path / "hand.csv").write_text("\n".join(["t,x,y,z", *rows]))
    words = ("track", tmp_path / "hand.csv", "--robot", "fr3", "--stretch", "0.5", "--no-plots")
    none = ("--acceleration-limit", "none", "--jerk-limit", "none")
    again = ("--config", tmp_path / "beyond" / "settings.toml")
    found = {}
    for name, more in {"kept": (), "beyond": none, "again": again}.items():
        code = call(*words, *more, "--check", "none", "--out", tmp_path / name)
        record, _ = results(tmp_path / name)
        padded = np.vstack([np.zeros((2, 7)), record["dq"]])
        acceleration = np.abs(np.diff(padded, axis=0)).max() / 1e-3
        jerk = np.abs(np.diff(padded, 2, axis=0)).max() / 1e-6
        found[name] = (code, acceleration, jerk, capsys.readouterr().out.splitlines()[0])
    code, acceleration, jerk, verdict = found["kept"]
    assert acceleration <= 10.0
    assert jerk <= 5000.0
    assert code == 1
    assert re.match(r"verdict +path completed \d", verdict)  # the path yields
    assert found["beyond"] == found["again"]
    code, acceleration, jerk, verdict = found["beyond"]
    assert code == 0
    assert acceleration > 20.0
    said = f"acceleration was not limited: up to {acceleration:.3g} rad/s.2 at joint\\d"
    assert re.match(f"verdict +{said}", verdict)


def test_wider_positions_and_velocities_than_the_robots_are_said_first(tmp_path, capsys) -> None:
    """A tip that comes 30 cm nearer bends the elbow beyond its 120 degrees, if it may."""
    words = ("track", "line", "--set", "reference.offset=[-0.3, 0, -0.1]", "--no-plots")
    words += ("--period", "3", "--check", "none")
    found = {}
    for name, more in {"kept": (), "beyond": ("--joint-limit", "2.5", "--speed", "2")}.items():
        code = call(*words, *more, "--out", tmp_path / name)
        elbow = results(tmp_path / name)[0]["q"][:, 3].max()
        found[name] = (code, elbow, capsys.readouterr().out.splitlines()[0])
    code, elbow, verdict = found["kept"]
    assert elbow <= np.deg2rad(120) + 1e-9
    code, elbow, verdict = found["beyond"]
    assert code == 0
    assert elbow > np.deg2rad(121)
    said = f"upper position was limited to 2.5: up to {elbow:.3g} rad at iiwa7_joint_4, "
    assert re.match(f"verdict +{said}the robot's limit is 2.09; ", verdict)


BALL = """distance = 0.03
[[obstacle]]
shape = "sphere"
center = [0.36, 0.16, 0.64]
radius = 0.05
"""


def test_obstacles_are_kept_away_from(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "ball.toml"
    file.write_text(BALL)
    words = ("--obstacles", file, "--dt", "5e-3", "--duration", "3", "--acceleration-limit", "none")
    record, metrics = track(tmp_path / "run", *words)
    assert record["distance"].min() >= 0.03
    assert "Sphere 1" in (metrics["collisions"]["first"], metrics["collisions"]["second"])
    assert re.search("nearest pair, .+ iiwa7_link_4\n", capsys.readouterr().out)


def test_the_script_from_anywhere_and_as_in_this_process(tmp_path: Path) -> None:
    words = (*QUICK, "--check", "osqp", "--noise", "0.01")
    command = [sys.executable, ROOT / "scripts" / "track_heart.py", *words, "--out", "here"]
    environment = os.environ | {"TERM": "xterm-256color"}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    # No terminal, no progress bar; and any warning would be on standard error.
    assert (done.returncode, done.stderr) == (0, "")
    assert "\x1b" not in done.stdout  # piped, so without colour
    # Its limits are the paper's.
    paper = ("--joint-limit", "2.5", "--acceleration-limit", "none", "--jerk-limit", "none")
    track(tmp_path / "there", *paper, *words)
    # The same seed gives the same record, bit for bit, in another process too.
    here, there = (tmp_path / name / "record.npz" for name in ("here", "there"))
    assert here.read_bytes() == there.read_bytes()
