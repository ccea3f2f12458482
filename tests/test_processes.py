"""Processes of a run that is killed by SIGKILL, which it cannot answer: none is left."""

import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from helpers_commands import marked

ROOT = Path(__file__).parents[1]


def wait(condition: Callable[[], object]) -> None:
    """Wait until a condition holds, a minute at most."""
    deadline = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.05)


@pytest.mark.parametrize(
    ("words", "workers"), [("track --dt 1e-3", 1), ("paper --quick --workers 2", 2)]
)
def test_a_run_that_is_killed_leaves_no_process(words: str, workers: int, tmp_path: Path) -> None:
    mark = f"IIWA_DNN_TEST={tmp_path}"
    environment = os.environ | dict([mark.split("=")]) | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "iiwa_dnn", *words.split(), "-q", "--out", tmp_path / "run"]
    process = subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL)
    wait(lambda: sum("popen_loky" in each for each in marked(mark)) == workers)
    assert process.poll() is None
    assert len(marked(mark)) > 1 + workers  # trackers of their resources too
    process.kill()
    process.wait()
    assert (tmp_path / "run").exists() == ("paper" in words)  # nothing, in place of an empty folder
    started = time.monotonic()
    wait(lambda: not marked(mark))
    assert time.monotonic() - started < 30.0  # idle workers of loky end after 60 s
