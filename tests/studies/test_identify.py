"""The grid of what the paper leaves out: a second program, a hidden setting, the tables."""

import json
from argparse import Namespace
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks import independent
from helpers_commands import call
from iiwa_dnn.studies import identify, paper
from iiwa_dnn.studies.identify import GRID, INFERRED, ROWS
from iiwa_dnn.studies.runs import HeartRun, Scope, measure

HIDDEN = replace(INFERRED, scale=2e-3, period=5.0, limit_gain=0.24, phase=0.25)
"""Four entries away from the inferred setting: no pair of them is there."""


@pytest.mark.parametrize(
    "run",
    [
        INFERRED,
        replace(INFERRED, orientation="none", weight=0.6, phase=0.25, limit_gain=0.24),
        replace(INFERRED, orientation="none", start=0.1, velocity=0.3, substeps=1, period=5.0),
    ],
    ids=["inferred", "phase", "unstable"],
)
def test_a_second_program_has_the_same_numbers(run: HeartRun) -> None:
    run = replace(run, duration=0.03)
    ours = measure(run)
    theirs = independent.run(Namespace(**asdict(run)))
    assert set(theirs) < set(ours)
    for name, value in theirs.items():
        # The block's rows, as they are printed, contradict each other by the error's square.
        assert value == pytest.approx(ours[name], rel=1e-6), name


def made_up(run: HeartRun) -> dict[str, Any]:
    """The paper's own numbers at the hidden setting, and a factor away for each other entry."""
    wrong = sum(getattr(run, name) != getattr(HIDDEN, name) for name in GRID)
    error, mse = (values[0] for values in paper.TABLE2.values())
    column = paper.WEIGHTS.index(run.weight)
    drift = paper.TABLE1["joint_drift_rad"][column]
    return {
        "max_position_error_m": 7.0 * error,
        "max_axis_error_m": error * 1.5**wrong,
        "mse_position_error_m2": mse / 3.0 * 1.5**wrong,
        "max_kinetic_index_times_dt": 4.54e-10 * 1.5**wrong,  # Table I's, times the period
        "joint_drift_rad": (drift or 1.0) * 1.5**wrong,
        "time_of_max_error_s": 0.5,
    }


def found() -> list[dict[str, Any]]:
    """The settings of a walk through made-up numbers, the nearest first."""
    return identify.search(lambda runs: [made_up(run) for run in runs], INFERRED)


def test_a_hidden_setting_is_found_by_pairs_and_single_steps() -> None:
    fits = found()
    assert HeartRun(**fits[0]["run"]) == HIDDEN
    assert fits[0]["changes"] == "scale 0.002, period 5, phase 0.25, limit_gain 0.24"
    assert fits[0]["readings"] | {"drift": "", "time": ""} == {
        "error": "largest axis",
        "square": "sum over the axes",
        "index": "index as defined",
        "drift": "",
        "time": "",
    }
    assert fits[0]["rows"]["Table I, drift"] == pytest.approx(0.0, abs=1e-12)
    # Table I has another number than Table II for the same run.
    assert fits[0]["rows"]["Table I, MAX E"] == pytest.approx(np.log10(6.70 / 5.59))
    distances = [each["distance"] for each in fits]
    assert distances == sorted(distances)
    runs = [HeartRun(**each["run"]) for each in fits]
    assert len(runs) == len(set(runs))
    assert set(identify.neighbours(INFERRED, 2)) < set(runs)
    sizes = [len(values) - 1 for values in GRID.values()]
    pairs = (sum(sizes) ** 2 - sum(size**2 for size in sizes)) // 2
    assert len(identify.neighbours(INFERRED, 2)) == 1 + sum(sizes) + pairs


def test_the_inferred_setting_is_the_first_of_every_entry() -> None:
    assert [getattr(INFERRED, name) for name in GRID] == [values[0] for values in GRID.values()]
    assert all(len(set(values)) == len(values) for values in GRID.values())


def test_bounds_are_one_sided_and_cells_that_cannot_be_read_do_not_count() -> None:
    values = made_up(HIDDEN)
    early = identify.fit(HIDDEN, {0.2: values | {"time_of_max_error_s": 0.0}})
    late = identify.fit(HIDDEN, {0.2: values | {"time_of_max_error_s": 10.0}})
    assert early["rows"]["time of MAX E, at most"] == 0.0
    assert late["rows"]["time of MAX E, at most"] == pytest.approx(1.0)
    whole = {weight: made_up(replace(HIDDEN, weight=weight)) for weight in paper.WEIGHTS}
    assert len(identify.fit(HIDDEN, whole)["ours"]["Table I, drift"]) == 3
    off = whole | {0.6: whole[0.6] | {"joint_drift_rad": 8.71e-1}}
    expected = np.sqrt(1.0 / 3.0)  # a decade in one of three cells
    assert identify.fit(HIDDEN, off)["rows"]["Table I, drift"] == pytest.approx(expected)


def test_tables_show_rows_that_no_setting_reaches_together(tmp_path: Path) -> None:
    fits = found()
    full = identify.fit(
        HIDDEN, {weight: made_up(replace(HIDDEN, weight=weight)) for weight in (0.2, 0.6)}
    )
    text = identify.report(tmp_path, fits, full, {"velocity": [[7e-5, 6e-5], [3e-10, 2e-10]]})
    assert (tmp_path / "identify.md").read_text(encoding="utf-8") == text
    assert (tmp_path / "identify.png").stat().st_size > 10_000
    lines = [line.strip("|").split(" | ") for line in text.splitlines() if line.startswith("|")]
    cells = {tuple(part.strip() for part in line) for line in lines}
    (pair,) = (line for line in cells if line[0] == "Table I, MAX E" and len(line) == 1 + len(ROWS))
    apart = [max(each["rows"]["Table I, MAX E"], each["rows"]["Table I, index"]) for each in fits]
    assert pair[3] == f"{min(apart):.3g}"
    assert ("paper", "7.07e-05, 6.87e-05", "3.28e-10, 2.49e-10") in cells
    stored = json.loads((tmp_path / "identify.json").read_text(encoding="utf-8"))
    assert stored["settings"][0]["changes"] == fits[0]["changes"]


def test_the_command_walks_the_grid_and_resumes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    first = {name: values[:1] for name, values in GRID.items()}
    monkeypatch.setattr(identify, "GRID", first | {"phase": (0.0, 0.25), "mode": GRID["mode"]})
    monkeypatch.setattr(identify, "SEEDS", 1)
    words = ("paper", "--identify", "--duration", "0.002", "--workers", "1", "--out", str(tmp_path))
    assert call(*words) == 0
    text = capsys.readouterr().out
    assert "4 settings without noise" in text
    assert len([line for line in text.splitlines() if "| velocity |" in line]) == 1
    monkeypatch.setattr("iiwa_dnn.studies.runs.simulate", lambda *a, **k: pytest.fail("again"))
    assert call(*words) == 0
    assert capsys.readouterr().out == text


def test_every_entry_of_the_noise_runs_without_and_with_the_filter() -> None:
    asked: list[HeartRun] = []

    def compute(runs: list[HeartRun]) -> list[dict[str, Any]]:
        asked.extend(runs)
        return [made_up(run) | {"mse_position_error_m2": float(run.filter_window)} for run in runs]

    _, noisy = identify.in_full(compute, HIDDEN, 2)
    assert list(noisy) == ["velocity", "network", "measurement"]
    assert all(columns[1] == [1.0, 10.0] for columns in noisy.values())
    assert {run.noise for run in asked} == {0.0, paper.NOISE}
    assert {run.seed for run in asked if run.noise} == {0, 1}
    assert Scope().seeds > identify.SEEDS
