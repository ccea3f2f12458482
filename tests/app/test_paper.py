"""The whole reproduction in small: files, resumption, workers, and what bad input says."""

import json
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from helpers_commands import call
from iiwa_dnn.app import sweeps as app
from iiwa_dnn.studies import runs
from iiwa_dnn.studies.runs import QUICK

TABLES = ("table1.json", "laps.json", "table2.json")
TINY = ("--quick", "--duration", "0.002", "--seeds", "2")


@pytest.fixture(scope="module", autouse=True)
def short_laps() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runs, "QUICK", replace(QUICK, laps=1, laps_dt=0.1))
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished reproduction of runs of 2 ms, by one process."""
    out = tmp_path_factory.mktemp("paper")
    assert call("paper", *TINY, "--workers", "1", "--out", str(out), "--quiet") == 0
    return out


def cut_short_copy(folder: Path, copy: Path) -> None:
    """Copy what a sweep has left that was cut short: its finished cells, and whose they are."""
    shutil.copytree(folder / "cells", copy / "cells")
    shutil.copy(folder / "settings.toml", copy)


def test_it_writes_tables_figures_and_a_report(folder: Path) -> None:
    names = {path.name for path in folder.iterdir()} - {"cells"}
    figures = {f"{name}.{kind}" for name in ("fig1", "fig2") for kind in ("png", "pdf")}
    assert names == {*TABLES, "report.md", "settings.toml", *figures}
    assert all((folder / name).stat().st_size > 10_000 for name in figures)
    report = (folder / "report.md").read_text(encoding="utf-8")
    assert "](fig2.png)" in report
    assert "0.002 s each (the paper's: 10 s)" in report


def test_again_nothing_is_computed_and_the_tables_keep_their_bytes(folder, tmp_path, monkeypatch):
    before = {name: (folder / name).read_bytes() for name in TABLES}
    monkeypatch.setattr(runs, "simulate", lambda *a, **k: pytest.fail("computed again"))
    cut_short_copy(folder, tmp_path)
    for out in (tmp_path, folder):  # of the finished cells alone, and over the finished tables
        assert call("paper", *TINY, "--workers", "1", "--out", str(out), "--quiet") == 0
        assert {name: (out / name).read_bytes() for name in TABLES} == before


def test_one_column_of_table_1_is_run_alone(folder, tmp_path, capsys) -> None:
    cut_short_copy(folder, tmp_path)
    cells = len(list((tmp_path / "cells").rglob("output.pkl")))
    command = [*TINY, "--workers", "1", "--out", str(tmp_path), "--table", "1"]
    assert call("paper", *command, "--weights", "0.2") == 0
    said = capsys.readouterr().out
    table = json.loads((folder / "table1.json").read_text(encoding="utf-8"))
    ours = table["variants"]["continuous, block"]["rows"]["max_position_error_m"][1]
    errors = [line.split("|")[2].strip() for line in said.splitlines() if "| MAX E [m] " in line]
    assert errors[:2] == ["5.59e-05", f"{ours:.3g}"]
    assert "(erratum 8)" in said
    assert not list(tmp_path.glob("fig*"))
    assert len(list((tmp_path / "cells").rglob("output.pkl"))) == cells
    assert call("paper", *command, "--weights", "0.3") == 2
    assert "weights: must be one of 0.1, 0.2, 0.4, " in capsys.readouterr().err


def test_a_run_that_ends_early_is_said_and_exits_1(folder, tmp_path, monkeypatch) -> None:
    whole = app.start_sweep

    def ended_early(*words):
        place, compute = whole(*words)
        early = {"status": "stopped at step 7"}
        return place, lambda *given: [values | early for values in compute(*given)]

    monkeypatch.setattr(app, "start_sweep", ended_early)
    cut_short_copy(folder, tmp_path)
    command = [*TINY, "--workers", "1", "--out", str(tmp_path), "--quiet", "--table", "2"]
    assert call("paper", *command) == 1
    assert "stopped at step 7" in (tmp_path / "report.md").read_text(encoding="utf-8")
