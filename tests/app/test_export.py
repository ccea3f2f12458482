"""The command ``export``: from a run's settings to a folder of C."""

from __future__ import annotations

from pathlib import Path

import pytest

from helpers_export import compile_quickly, needs
from iiwa_dnn.app.folders import save_settings
from iiwa_dnn.app.main import main
from iiwa_dnn.app.options import TrackOptions
from iiwa_dnn.export import load

pytestmark = needs("gcc")


def test_the_settings_of_a_run_become_c(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    compile_quickly(monkeypatch)
    run = tmp_path / "run"
    run.mkdir()
    settings = save_settings(TrackOptions(reference="circle", dt=2e-3, plots=False), run)
    folder = tmp_path / "controller"
    words = ["export", "--settings", str(settings), "--out", str(folder), "--speed", "0.5"]
    assert main(words) == 0
    captured = capsys.readouterr()
    assert f"written to {folder}: " in captured.out
    assert "--joint-limit datasheet" in captured.err
    exported = load(folder)
    assert (exported.dof, exported.frames, exported.dt) == (7, 1, 2e-3)
    assert "circle" in (folder / "README.md").read_text(encoding="utf-8")
    # A folder that holds another controller is not overwritten unasked.
    assert main([*words, "--weight", "0.5"]) == 2
    assert "--overwrite" in capsys.readouterr().err
    assert sorted(path.name for path in run.iterdir()) == ["settings.toml"]


@pytest.mark.parametrize(
    ("words", "named"),
    [
        (["--filter-window", "5"], "--filter-window"),
        (["--motion", "rk4"], "--motion"),
    ],
)
def test_what_is_no_part_of_a_controller_is_refused(
    words: list[str], named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["export", "--out", str(tmp_path / "none"), *words]) == 2
    assert named in capsys.readouterr().err
