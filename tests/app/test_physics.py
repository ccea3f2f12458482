"""The command ``physics``: what it writes, what it refuses, how it exits."""

import sys
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from helpers_commands import call, results
from helpers_physics import needs_opengl
from helpers_records import draw_only
from iiwa_dnn import Record
from iiwa_dnn.results import pictures
from iiwa_dnn.simulation.disturbances import Disturbances

DRY = ("physics", "--duration", "0.05", "--quiet", "--no-plots")

needs_mujoco = pytest.mark.usefixtures("mujoco")


@pytest.fixture
def mujoco() -> object:
    return pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")


@needs_mujoco
@needs_opengl
def test_everything_is_written(tmp_path, capsys, monkeypatch) -> None:
    # What the pictures show is a matter of tests/results/test_pictures.py.
    draw_only(monkeypatch, "overview")
    monkeypatch.setattr(pictures, "MOMENTS", 2)
    monkeypatch.setattr(pictures, "FRAME_RATE", 10)
    monkeypatch.setattr(pictures, "SIZE", (480, 270))
    words = ("physics", "--duration", "0.2", "--out", tmp_path, "--disturb", "--push", 0, 10, 0)
    later = ("push.start=0.1", "push.duration=0.05")
    assert call(*words, *(f"--set=plant.disturbances.{text}" for text in later)) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    for name in ("moments.png", "overview.png", "video.mp4"):
        assert (tmp_path / name).stat().st_size > 1000, name
    assert "largest torque, of its limit" in captured.out
    record, metrics = results(tmp_path)
    push = {"force": [0.0, 10.0, 0.0], "start": 0.1, "duration": 0.05}
    assert metrics["settings"]["physics"]["disturbances"]["push"] == push
    assert metrics["physics"]["max_torque_fraction"] < 0.5
    assert record["torque"].shape == (200, 7)
    report = (tmp_path / "report.md").read_text()
    assert "(moments.png)" in report
    assert "(overview.png)" in report


@needs_mujoco
def test_disturbances_one_by_one_and_a_run_again(tmp_path: Path) -> None:
    words = (*DRY, "--check", "none", "--out", tmp_path / "run", "--seed", "3")
    chosen = ("--set", "plant.disturbances.friction=0.02", "--disturb")
    assert call(*words, *chosen) == 0
    settings = Record.load(tmp_path / "run" / "record.npz").settings["physics"]["disturbances"]
    assert settings == asdict(replace(Disturbances.typical(), friction=0.02))
    file = tmp_path / "run" / "settings.toml"
    assert call("track", "--config", file, "-q", "--no-plots", "--out", tmp_path / "again") == 0
    first, again = (results(tmp_path / name)[0]["q"] for name in ("run", "again"))
    np.testing.assert_array_equal(first, again)
    assert call(*words) == 2  # another run lies there
    assert call(*words, "--overwrite") == 0
    settings = Record.load(tmp_path / "run" / "record.npz").settings["physics"]["disturbances"]
    assert not any(settings.values())


@needs_mujoco
def test_what_is_not_installed_is_named_before_the_run(tmp_path, capsys, monkeypatch) -> None:
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("MUJOCO_GL", "of_nobody")
    assert call("physics", "--out", tmp_path / "run") == 2
    assert "apt-get install libegl1" in capsys.readouterr().err
    assert call(*DRY, "--out", tmp_path / "physics") == 0  # physics needs none
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert call("track", "--push", 0, 1, 0, "--no-plots", "--out", tmp_path / "run") == 2
    said = capsys.readouterr().err
    assert "pip install 'iiwa-dnn[sim]'" in said
    assert said.count("\n") == 1
    assert not (tmp_path / "run").exists()
