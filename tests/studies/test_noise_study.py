"""The study of means against noise, in small, and the two claims that it is for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from iiwa_dnn.app.main import main
from iiwa_dnn.studies import noise_study, paper


def values(kind: str, means: str, duration: float) -> dict[str, float]:
    cell = {"disturbance": kind, "countermeasure": means, "seed": 0, "duration": duration}
    return noise_study.measure(cell).values


def test_the_chosen_gain_cuts_the_papers_noise_at_little_roughness(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(noise_study, "SETTLED_AFTER", 0.3)  # three times 1 / gain
    kind = "white, the paper's"
    plain = values(kind, "none", duration=0.6)
    helped = values(kind, "gain", duration=0.6)
    assert helped["mse_m2"] < 0.1 * plain["mse_m2"]
    # Beside the noise's own roughness: sigma sqrt(4 / pi) / dt.
    assert helped["command_roughness"] < 0.02 * 0.01 * np.sqrt(4.0 / np.pi) / 1e-4


def test_a_constant_bias_is_gone_after_two_seconds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(paper, "DT", 1e-3)
    assert values("constant", "none", duration=1.3)["last_error_m"] > 1e-3
    for means, dt in (("Kalman with bias", 2.5e-4),):
        monkeypatch.setattr(paper, "DT", dt)
        assert values("constant", means, duration=2.0)["last_error_m"] < 1e-6


def test_the_script_writes_a_report_and_goes_on_where_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(paper, "DT", 1e-3)
    monkeypatch.setattr(noise_study, "SETTLED_AFTER", 0.1)
    few = {"COUNTERMEASURES": ("none", "gain"), "DISTURBANCES": ("constant", "white, the paper's")}
    for table, names in few.items():
        whole = getattr(noise_study, table)
        monkeypatch.setattr(noise_study, table, {name: whole[name] for name in names})
    arguments = ["--seeds", "2", "--duration", "0.2", "--workers", "1", "--out", str(tmp_path)]
    assert main(["noise", *arguments]) == 0
    first = capsys.readouterr().out
    assert first.count("| gain |") == len(noise_study.DISTURBANCES)
    assert (tmp_path / "report.md").read_text() == first
    cells = len(list((tmp_path / "cells").glob("*.json")))
    assert cells == 2 * (1 + 2)  # with chance in it, one a seed
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "cells").iterdir()}
    assert main(["noise", *arguments]) == 0
    assert capsys.readouterr().out == first
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "cells").iterdir()} == before


@pytest.mark.parametrize(
    "bad", [["--seeds", "1"], ["--duration", "0.5"], ["--duration", "nan"], ["--workers", "0"]]
)
def test_bad_input_is_one_line(
    bad: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["noise", *bad, "--out", str(tmp_path / "run")]) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert not (tmp_path / "run").exists()
    assert captured.err.startswith("iiwa-dnn noise: error: ")
