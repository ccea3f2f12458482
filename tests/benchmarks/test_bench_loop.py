"""The benchmark of the control loop: everyone follows the heart, and the script writes."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from benchmarks import control, process
from benchmarks.cli import bench_loop
from benchmarks.control import LOOPS, measure_own_part, measure_runs, measure_steps
from benchmarks.loop_report import markdown
from helpers_bench import loops_in_this_process
from iiwa_dnn import IiwaDnnError


@pytest.fixture(scope="module")
def measured() -> tuple[list[dict[str, Any]], list[str]]:
    """A hundred steps of everyone that is installed."""
    with loops_in_this_process():
        return measure_steps(100, 1e-3)


def test_everyone_follows_the_heart(measured: tuple[list[dict[str, Any]], list[str]]) -> None:
    rows = {row["name"]: row for row in measured[0]}
    missing = measured[1]
    assert set(missing) <= {"placo", "mink", "pydrake"}
    error = {name: row["max_position_error_m"] for name, row in rows.items()}
    # One period late is dt times the speed; the others have their methods' own errors.
    assert error["Pink, daqp"] > 5.0 * error["Pink, daqp, target one step ahead"]
    assert error["Pink, daqp"] == pytest.approx(error["Pink, proxqp"], rel=0.05)
    assert error["iiwa_dnn, with midpoint"] < 0.1 * error["iiwa_dnn, with q + dt dq"] < 1e-5
    assert error["iiwa_dnn, with q + dt dq"] == error["iiwa_dnn, Controller.step"]
    assert all(0.0 < row["median_us"] <= row["p99_us"] <= row["p999_us"] for row in rows.values())


@pytest.mark.parametrize(
    ("python", "reason"),
    [(sys.executable, "PlaCo: ModuleNotFoundError"), ("no/python", "PlaCo: no/python: ")],
)
def test_a_python_without_the_library_is_named(python: str, reason: str) -> None:
    placo = [loop for loop in LOOPS if loop.module == "placo"]
    with pytest.raises(IiwaDnnError, match=reason):
        measure_steps(10, 1e-3, {"placo": Path(python)}, loops=placo)


def test_a_limit_of_ones_own_is_measured_beside_the_built_in_parts() -> None:
    walls = measure_own_part(0.02, 1e-3, rounds=1)
    assert min(walls.values()) > 0.0
    assert walls["ratio"] == pytest.approx(walls["own_part"] / walls["built_in"])


def test_runs_are_measured_against_proxqp_on_the_same_programs() -> None:
    runs = measure_runs(0.02, 1e-3, rounds=1)
    assert runs["steps"] == 20
    walls = runs["wall_s"]
    assert 0.0 < walls["proxqp"] < walls["proxqp_with_problem"]
    assert runs["realtime_factor"]["checked"] == pytest.approx(0.02 / walls["checked"])


def test_a_long_runs_memory_is_measured() -> None:
    memory = process.measure_memory(0.4)
    short, long = memory["record_bytes"]
    assert long == pytest.approx(10 * short, rel=0.01)
    # Nothing but the record grows.
    assert 0.8 < memory["growth_over_record"] < 1.2


def test_the_script_writes_its_report(
    measured: tuple[list[dict[str, Any]], list[str]],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(control, "measure_steps", lambda *arguments, **options: measured)
    # Compiling everything anew takes a minute, and is nothing that a test could judge.
    times = {"import_s": 0.5, "first_step_s": 0.5}
    monkeypatch.setattr(process, "measure_startup", lambda rounds: times)
    memory = {"peak_bytes": [2e8, 3e8], "record_bytes": [1e7, 1e8], "growth_over_record": 1.1}
    monkeypatch.setattr(process, "measure_memory", lambda duration: memory)
    arguments = ["--steps", "50", "--duration", "0.02", "--rounds", "1", "--quiet"]
    assert bench_loop([*arguments, "--out", str(tmp_path)]) == 0
    results = json.loads((tmp_path / "results.json").read_text())
    report = (tmp_path / "report.md").read_text()
    assert f"{results['steps'][0]['median_us']:.1f}" in report
    assert "pin-pink" in report
    assert "grows by 1.10 times" in report
    assert all(f"no Python has it: {name}." in report for name in results["missing"])
    assert "The checked run of `scripts/own_parts.py`" in report
    results["steps"].append({**results["steps"][0], "name": "PlaCo", "median_us": 1000.0})
    results["runs"]["wall_s"]["unchecked"] = 1e-3 * results["runs"]["steps"]
    assert "takes 1000.00 µs, 1.00 of PlaCo's" in markdown(results)
    assert (tmp_path / "steps.png").stat().st_size > 5000


@pytest.mark.parametrize(
    "option", ["--steps=1", "--duration=0", "--rounds=0", "--dt=nan", "--period=0"]
)
def test_bad_numbers_are_refused_by_name(
    option: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert bench_loop([option, "--out", str(tmp_path / "out")]) == 2
    assert option.split("=")[0] in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
