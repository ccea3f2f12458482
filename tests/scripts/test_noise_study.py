"""Countermeasures against noise: what each is for shows in the script's numbers."""

from pathlib import Path

import numpy as np
import pytest

from iiwa_dnn.studies import paper
from scripts import noise_study
from scripts.noise_study import measure


@pytest.fixture(autouse=True)
def shorter(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(paper, "DT", 1e-3)
    monkeypatch.setattr(noise_study, "SETTLED_AFTER", 0.1)


def test_a_higher_gain_makes_the_papers_noise_smaller_and_the_command_rougher(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(paper, "DT", 1e-4)
    plain, helped = (measure(("white, the paper's", name, 1, 0.4)) for name in ("none", "gain"))
    assert helped[0] < 0.2 * plain[0]
    assert helped[3] > 5.0 * plain[3]
    # The next command changes by 2 % of the noise, whose changes are sigma sqrt(4 / pi) on average.
    assert helped[3] < 0.02 * 0.01 * np.sqrt(4.0 / np.pi) / 1e-4


def test_a_constant_bias_is_taken_off_by_the_filter_that_knows_of_it() -> None:
    assert measure(("constant", "none", 0, 1.3))[2] > 1e-3
    assert measure(("constant", "Kalman with bias", 0, 2.0))[2] < 5e-5


def test_it_writes_its_tables(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    few = {"COUNTERMEASURES": ("none", "gain"), "DISTURBANCES": ("constant", "encoder")}
    for table, names in few.items():
        whole = getattr(noise_study, table)
        monkeypatch.setattr(noise_study, table, {name: whole[name] for name in names})
    noise_study.main(str(tmp_path), seeds=2, duration=0.2, workers=1)
    first = capsys.readouterr().out
    assert first.count("| gain ") == 2
    assert (tmp_path / "noise.md").read_text(encoding="utf-8") == first
