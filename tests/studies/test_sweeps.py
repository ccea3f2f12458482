"""Sweeps: nothing computed twice, nothing stale, and the same numbers whoever computes them."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_commands import marked
from helpers_sweeps import cells, draw
from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.studies import sweeps
from iiwa_dnn.studies.runs import HeartRun, measure
from iiwa_dnn.studies.sweeps import sweep

TESTS = Path(__file__).parents[1]
RUNS = [
    HeartRun(duration=2e-3),
    HeartRun(mode="converged", orientation="so3", duration=2e-3),
    *(HeartRun(duration=2e-3, noise=0.01, seed=seed, filter_window=3) for seed in (0, 1)),
]


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
    return [{"mean": float(mean)} for mean in means]


def finished(folder: Path) -> dict[str, bytes]:
    """Bytes of each finished cell's file by the name of its folder."""
    return {path.parent.name: path.read_bytes() for path in folder.rglob("output.pkl")}


def test_versions_and_sources_are_in_the_fingerprint(tmp_path, monkeypatch) -> None:
    package = tmp_path / "iiwa_dnn"
    (package / "studies").mkdir(parents=True)
    task = tmp_path / "task.py"
    monkeypatch.setattr(sweeps, "__file__", str(package / "studies" / "sweeps.py"))
    monkeypatch.setattr(sweeps.inspect, "getfile", lambda function: str(task))
    seen = set()
    for path in (task, package / "one.py", package / "studies" / "two.py"):
        for text in ("x = 1", "x = 2"):
            task.touch()
            path.write_text(text, encoding="utf-8")
            sweeps.fingerprint.cache_clear()
            seen.add(sweeps.fingerprint(draw))
    monkeypatch.setattr(sweeps, "version", lambda name: "99")
    sweeps.fingerprint.cache_clear()
    seen.add(sweeps.fingerprint(draw))
    sweeps.fingerprint.cache_clear()
    assert len(seen) == 7


def test_two_workers_bring_the_bytes_of_one(tmp_path: Path) -> None:
    found = [sweep(measure, RUNS, tmp_path / str(k), workers=k, quiet=True) for k in (1, 2)]
    assert json.dumps(found[0]) == json.dumps(found[1])
    assert finished(tmp_path / "1").keys() == finished(tmp_path / "2").keys()


def test_after_kill_9_the_sweep_goes_on_where_it_was(tmp_path: Path, log: Path) -> None:
    count, folder, gate = 8, tmp_path / "cells", tmp_path / "gate"
    main = "import helpers_sweeps; helpers_sweeps.main()"
    command = [sys.executable, "-c", main, *map(str, (folder, log, count, gate, 2))]
    mark = f"IIWA_DNN_TEST={tmp_path}"
    process = subprocess.Popen(command, env=os.environ | dict([mark.split("=")]))
    deadline = time.monotonic() + 60.0
    while len(finished(folder)) < 3 and time.monotonic() < deadline:
        time.sleep(0.02)
    process.kill()
    assert process.wait() == -signal.SIGKILL
    while marked(mark) and time.monotonic() < deadline:  # its workers
        time.sleep(0.02)
    kept = finished(folder)
    assert 3 <= len(kept) < count
    log.write_text("", encoding="utf-8")
    gate.touch()

    assert sweep(
        draw, cells(log, count, gate=str(gate)), folder, workers=1, quiet=True
    ) == expected(8)
    assert len(computed(log)) == count - len(kept)
    assert finished(folder).items() >= kept.items()

    # An uninterrupted sweep leaves the same bytes.
    sweep(draw, cells(log, count, gate=str(gate)), tmp_path / "whole", workers=1)
    assert finished(tmp_path / "whole") == finished(folder)


def test_an_error_names_the_cell(tmp_path: Path) -> None:
    bad = [HeartRun(duration=1e-3, weight=weight) for weight in (2.0, 3.0)]
    for workers in (1, 2):
        with pytest.raises(IiwaDnnError, match=r"weight: must be in \[0, 1\].*at HeartRun\(weight"):
            sweep(measure, bad, tmp_path, workers=workers, quiet=True)
    assert finished(tmp_path) == {}


def test_a_worker_with_another_version_refuses() -> None:
    with pytest.raises(IiwaDnnError, match="another version"):
        sweeps._compute(draw, {}, "other")
