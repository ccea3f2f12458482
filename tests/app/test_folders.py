"""Folders of runs: the same run may write again, anything else is refused in one line."""

from __future__ import annotations

from pathlib import Path

import pytest

from iiwa_dnn.app.folders import SETTINGS_FILE, claim_folder, save_settings
from iiwa_dnn.app.main import run
from iiwa_dnn.app.options import NoiseOptions, PhysicsOptions, TrackOptions
from iiwa_dnn.errors import FileError

SHORT = ("--dt", "1e-3", "--duration", "0.02", "--check", "none", "--no-plots", "-q")


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below a folder."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def refused(capsys: pytest.CaptureFixture[str], folder: Path, name: str, *words: str) -> None:
    """Assert that a command ends with 2 and one line that names the folder, and changes nothing."""
    before = contents(folder)
    assert run(name, words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert f"{folder}: holds another run or other files" in captured.err
    assert "--overwrite" in captured.err
    assert contents(folder) == before


def test_the_same_run_may_write_again_and_another_one_only_if_it_insists(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = ("--out", str(tmp_path))
    assert run("track", [*SHORT, *out]) == 0
    record = (tmp_path / "record.npz").read_bytes()
    # How a run is shown does not make it another run, nor does a default that is written out.
    assert run("track", [*SHORT, *out, "-v", "--seed", "0"]) == 0
    assert (tmp_path / "record.npz").read_bytes() == record
    refused(capsys, tmp_path, "track", *SHORT, *out, "--weight", "0.7")
    refused(capsys, tmp_path, "noise", "--seeds", "2", "--duration", "1.1", *out)
    refused(capsys, tmp_path, "paper", "--quick", *out)
    with pytest.raises(FileError, match="another run"):
        claim_folder(PhysicsOptions(out=tmp_path, dt=1e-3, duration=0.02, check="none"))
    assert run("track", [*SHORT, *out, "--weight", "0.7", "--overwrite"]) == 0
    assert (tmp_path / "record.npz").read_bytes() != record
    assert "weight = 0.7" in (tmp_path / SETTINGS_FILE).read_text()


def test_settings_are_written_beside_their_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("track", [*SHORT, "-q"]) == 0
    heart = contents(tmp_path / "runs" / "heart")
    assert run("track", [*SHORT, "--robot", "iiwa7", "--speed", "0.9", "--out", "runs/slow"]) == 0
    slow = contents(tmp_path / "runs" / "slow")
    # The slow run again: over itself, not over the heart.
    assert run("track", ["--settings", "runs/slow/settings.toml", "-q"]) == 0
    assert contents(tmp_path / "runs" / "heart") == heart
    assert contents(tmp_path / "runs" / "slow").keys() == slow.keys()
    again = contents(tmp_path / "runs" / "slow")
    assert all(again[name] == slow[name] for name in ("record.npz", "settings.toml"))
    capsys.readouterr()
    refused(
        capsys, Path("runs/slow"), "track", "--settings", "runs/slow/settings.toml", "--seed", "4"
    )


def test_a_file_that_a_person_wrote_is_no_other_run_and_stays(tmp_path: Path) -> None:
    for name in ("settings.toml", "mine.toml"):
        file = tmp_path / name.partition(".")[0] / name
        file.parent.mkdir()
        file.write_text("# slowly\nspeed = 0.9\ndt = 1e-3\nduration = 0.02\nplots = false\n")
        text = file.read_text()
        for _ in range(2):
            assert run("track", ["--settings", str(file), "-q"]) == 0
        assert (file.parent / "record.npz").is_file()
        assert file.read_text() == text


@pytest.mark.parametrize("name", ["notes.txt", "record.npz", "settings.toml", "cells"])
def test_a_folder_with_anything_else_is_refused(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("mine")
    with pytest.raises(FileError, match="other files"):
        claim_folder(TrackOptions(out=tmp_path))
    assert claim_folder(TrackOptions(out=tmp_path, overwrite=True)) == tmp_path


def test_an_empty_folder_and_hidden_files_are_no_run(tmp_path: Path) -> None:
    (tmp_path / ".0123456789abcdef.tmp").write_text("a process was killed while it wrote this")
    assert claim_folder(TrackOptions(out=tmp_path)) == tmp_path


def test_a_sweep_goes_on_in_its_own_folder_whatever_its_size(tmp_path: Path) -> None:
    (tmp_path / "cells").mkdir()  # cut short before its settings were written
    assert claim_folder(NoiseOptions(out=tmp_path), resumes=("cells",)) == tmp_path
    save_settings(NoiseOptions(seeds=5), tmp_path)
    assert claim_folder(NoiseOptions(out=tmp_path, seeds=9), resumes=("cells",)) == tmp_path
    with pytest.raises(FileError, match="other files"):
        claim_folder(TrackOptions(out=tmp_path))
