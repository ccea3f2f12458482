"""Sweeps: nothing computed twice, nothing stale, and the same numbers whoever computes them."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pytest

from helpers_sweeps import cells, draw
from iiwa_dnn.errors import FileError, IiwaDnnError, InvalidInputError
from iiwa_dnn.studies import sweeps
from iiwa_dnn.studies.runs import HeartRun, measure
from iiwa_dnn.studies.sweeps import Outcome, Sweep

TESTS = Path(__file__).parents[1]


@pytest.fixture
def log(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Where `draw` says what it computes; worker processes can import it, too."""
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(TESTS), str(TESTS.parent)]))
    path = tmp_path / "log"
    path.touch()
    return path


def computed(log: Path) -> list[int]:
    """Seeds of the cells that were computed, in that order."""
    return [int(line.split()[0]) for line in log.read_text(encoding="utf-8").splitlines()]


def expected(count: int) -> list[dict[str, Any]]:
    means = (np.random.default_rng(seed).standard_normal(1000).mean() for seed in range(count))
    return [{"mean": mean, "none": None} for mean in means]


def files(folder: Path, suffix: str = "json") -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob(f"*.{suffix}")}


def test_answers_come_in_the_order_of_the_cells_and_are_kept(tmp_path: Path, log: Path) -> None:
    sweep = Sweep(draw, tmp_path / "cells")
    assert sweep.run(cells(log, 4)[::-1], workers=1) == expected(4)[::-1]
    kept = files(sweep.folder)
    assert len(kept) == 4
    assert sweep.run(cells(log, 6), workers=1) == expected(6)
    assert sorted(computed(log)) == [0, 1, 2, 3, 4, 5]
    assert files(sweep.folder).items() >= kept.items()


def test_equal_cells_are_computed_once(tmp_path: Path, log: Path) -> None:
    found = Sweep(draw, tmp_path / "cells").run(cells(log, 2) * 3, workers=1)
    assert found == expected(2) * 3
    assert sorted(computed(log)) == [0, 1]


def test_a_changed_setting_is_a_new_cell(tmp_path: Path, log: Path) -> None:
    sweep = Sweep(draw, tmp_path / "cells")
    sweep.run(cells(log, 2), workers=1)
    sweep.run(cells(log, 2, sleep=0.0), workers=1)
    assert sorted(computed(log)) == [0, 0, 1, 1]


@pytest.mark.parametrize("change", ["version", "source"])
def test_a_changed_package_is_a_new_cell(
    tmp_path: Path, log: Path, monkeypatch: pytest.MonkeyPatch, change: str
) -> None:
    sweep = Sweep(draw, tmp_path / "cells")
    sweep.run(cells(log, 2), workers=1)
    now = sweeps.fingerprint(draw)
    assert now["versions"]["numpy"] == np.__version__
    other = {"versions": {**now["versions"], "iiwa-dnn": "99"}} if change == "version" else {}
    other = now | (other or {"source": "0"})
    monkeypatch.setattr(sweeps, "fingerprint", lambda task: other)
    assert sweep.run(cells(log, 2), workers=1) == expected(2)
    assert sorted(computed(log)) == [0, 0, 1, 1]


def test_another_task_is_a_new_cell(tmp_path: Path, log: Path) -> None:
    (cell,) = cells(log, 1)
    assert Sweep(draw, tmp_path).name(cell) != Sweep(measure, tmp_path).name(cell)


@pytest.mark.parametrize("text", ["", '{"identity": ', "[]", '{"identity": {}, "values": {}}'])
def test_a_damaged_file_is_computed_again(tmp_path: Path, log: Path, text: str) -> None:
    sweep = Sweep(draw, tmp_path / "cells")
    sweep.run(cells(log, 2), workers=1)
    (sweep.folder / f"{sweep.name(cells(log, 2)[1])}.json").write_text(text, encoding="utf-8")
    assert sweep.run(cells(log, 2), workers=1) == expected(2)
    assert computed(log) == [0, 1, 1]


def test_a_kept_record_is_found_again(tmp_path: Path, log: Path) -> None:
    sweep = Sweep(draw, tmp_path / "cells")
    plain, kept = cells(log, 1)[0], cells(log, 1, keep=True)[0]
    sweep.run([plain, kept], workers=1)
    first = np.random.default_rng(0).standard_normal()
    np.testing.assert_array_equal(sweep.record(kept).q, first)
    with pytest.raises(FileError):
        sweep.record(plain)
    (sweep.folder / f"{sweep.name(kept)}.npz").unlink()
    sweep.run([plain, kept], workers=1)
    assert computed(log) == [0, 0, 0], "without its record a cell is not finished"
    np.testing.assert_array_equal(sweep.record(kept).q, first)


@pytest.mark.parametrize("how", [{"workers": 2}, {"workers": 1, "dask": "local"}])
def test_every_cell_is_computed_once_by_processes_of_one_thread(
    tmp_path: Path, log: Path, how: dict[str, Any]
) -> None:
    sweep = Sweep(draw, tmp_path / "draws")
    assert sweep.run(cells(log, 5), **how) == expected(5)
    assert sorted(computed(log)) == [0, 1, 2, 3, 4]
    assert {line.split()[1] for line in log.read_text(encoding="utf-8").splitlines()} == {"1"}


def test_other_processes_bring_the_same_numbers(tmp_path: Path) -> None:
    """Real runs, number by number as one process writes them."""
    short = [HeartRun(duration=2e-3), HeartRun(mode="converged", orientation="so3", duration=2e-3)]
    short += [HeartRun(duration=2e-3, noise=0.01, seed=seed, filter_window=3) for seed in (0, 1)]
    runs = [run.settings() for run in short]

    def without_time(workers: int) -> list[dict[str, Any]]:
        found = Sweep(measure, tmp_path / str(workers)).run(runs, workers=workers)
        return [{k: v for k, v in values.items() if k != "wall_time_s"} for values in found]

    assert without_time(2) == without_time(1)


def test_after_kill_9_the_sweep_goes_on_where_it_was(tmp_path: Path, log: Path) -> None:
    count, folder = 8, tmp_path / "cells"
    main = "import helpers_sweeps; helpers_sweeps.main()"
    command = [sys.executable, "-c", main, *map(str, (folder, log, count, 0.2, 2))]
    process = subprocess.Popen(command, start_new_session=True)
    deadline = time.monotonic() + 60.0
    while len(files(folder)) < 3 and time.monotonic() < deadline:
        time.sleep(0.02)
    os.killpg(process.pid, signal.SIGKILL)  # its own group: its workers with it
    assert process.wait() == -signal.SIGKILL
    finished = files(folder)
    assert 3 <= len(finished) < count
    seeds = {json.loads(text)["identity"]["settings"]["seed"] for text in finished.values()}
    log.write_text("", encoding="utf-8")

    Sweep(draw, folder).run(cells(log, count, sleep=0.2), workers=1, quiet=True)
    assert set(computed(log)) == set(range(count)) - seeds
    assert len(computed(log)) == count - len(seeds)
    assert files(folder).items() >= finished.items()

    # An uninterrupted sweep leaves the same bytes.
    whole = Sweep(draw, tmp_path / "whole")
    whole.run(cells(log, count, sleep=0.2), workers=1)
    assert files(whole.folder) == files(folder)


def test_an_error_names_the_cell(tmp_path: Path) -> None:
    bad = HeartRun(duration=1e-3).settings() | {"weight": 2.0}
    for workers in (1, 2):
        with pytest.raises(IiwaDnnError, match=r"weight: must be in \[0, 1\].*\"seed\": 0"):
            Sweep(measure, tmp_path).run([bad, {**bad, "weight": 3.0}], workers=workers, quiet=True)
    assert files(tmp_path) == {}


def test_a_worker_with_other_versions_refuses() -> None:
    with pytest.raises(IiwaDnnError, match="other versions"):
        sweeps._compute("name", draw, {}, {"versions": {}, "source": ""})


def test_bad_input_is_named(tmp_path: Path, log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweeps, "_PATIENCE", 0.5)
    sweep = Sweep(draw, tmp_path / "cells")
    with pytest.raises(InvalidInputError, match=r"^dask: no scheduler at 'tcp://127\.0\.0\.1:1'"):
        sweep.run(cells(log, 1), dask="tcp://127.0.0.1:1")
    assert computed(log) == []


def test_a_scheduler_is_found_by_its_address(tmp_path: Path, log: Path) -> None:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None
    ) as cluster:
        found = Sweep(draw, tmp_path / "cells").run(
            cells(log, 3), dask=cluster.scheduler_address, quiet=True
        )
    assert found == expected(3)


def test_a_changed_file_of_package_or_task_changes_the_source(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package = tmp_path / "iiwa_dnn"
    (package / "studies").mkdir(parents=True)
    monkeypatch.setattr(sweeps, "__file__", str(package / "studies" / "sweeps.py"))
    task = tmp_path / "task.py"
    monkeypatch.setattr(sweeps.inspect, "getfile", lambda function: str(task))
    seen = set()
    for path in (task, package / "one.py", package / "studies" / "two.py"):
        for text in ("x = 1", "x = 2"):
            task.touch()
            path.write_text(text, encoding="utf-8")
            sweeps.fingerprint.cache_clear()
            seen.add(sweeps.fingerprint(draw)["source"])
    sweeps.fingerprint.cache_clear()
    assert len(seen) == 6


def test_one_bar_for_the_whole_sweep(
    tmp_path: Path, log: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    sweep = Sweep(draw, tmp_path / "cells")
    sweep.run(cells(log, 2), workers=1)
    capsys.readouterr()
    sweep.run(cells(log, 3), workers=1)
    shown = capsys.readouterr().err
    assert "2/3" in shown
    assert "3/3" in shown
    sweep.run(cells(log, 3), workers=1, quiet=True)
    assert capsys.readouterr().err == ""


def test_every_core_unless_told(tmp_path: Path, log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    monkeypatch.setattr(joblib, "cpu_count", lambda: asked.append(1) or 1)
    assert Sweep(draw, tmp_path / "cells").run(cells(log, 2)) == expected(2)
    assert asked


def test_an_outcome_without_a_record_is_the_default() -> None:
    assert Outcome({}).record is None
