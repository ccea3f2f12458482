"""``iiwa-dnn``: help, wrong words, signals, closed pipes; what a set-up compiles."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import iiwa_dnn
from helpers_commands import QUICK, call
from iiwa_dnn.app.main import COMMANDS

ROOT = Path(__file__).parents[2]


def test_the_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    for words in ((), ("--help",), ("-h",)):
        assert call(*words) == 0
        text = capsys.readouterr().out
        assert all(re.search(rf"^│? +• {name} +\w", text, re.MULTILINE) for name in COMMANDS)
    assert list(COMMANDS) == ["track", "physics", "export", "paper", "atlas", "view"]
    assert call("--version") == 0
    assert capsys.readouterr().out == f"iiwa-dnn {iiwa_dnn.__version__}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_the_quantity_of_every_word_and_the_unit_of_every_number(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "100")
    assert call(name, "--help") == 0
    text = capsys.readouterr().out
    assert text.startswith(f"usage: iiwa-dnn {name} ")
    assert "\x1b" not in text
    assert text.count("\n") < 70
    rows = [line.strip("│ ") for line in text.splitlines()]
    options = [row for row in rows if re.match(r"--?\w", row)]
    assert all(len(row.split("  ", 1)) == 2 for row in options), options
    numbers = [row for row in options if re.match(r"--[\w-]+ X\b", row)]
    assert all(re.search(r"\[.+\]", row) for row in numbers), numbers


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("trakc",), ("trakc", "track")),
        (("track", "--wieght", "3"), ("--wieght", "--weight")),
        (("track", "--dt", "fast"), ("--dt", "'fast'")),
        (("track", "--seed", "1.5"), ("--seed", "'1.5'")),
        (("track", "--q0", "0", "up"), ("--q0", "'up'")),
        (("track", "--weight"), ("--weight",)),
        (("track", "heart", "circle"), ("circle",)),
        (("view",), ("PATH",)),
    ],
)
def test_a_wrong_word_is_named_with_the_nearest_option(words, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert call(*words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert all(word in captured.err for word in said), captured.err
    assert list(tmp_path.iterdir()) == []


def start(folder: Path, *words: str, **options: object) -> subprocess.Popen[str]:
    """A command in a process of its own."""
    command = [sys.executable, "-m", "iiwa_dnn", *words]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    return subprocess.Popen(command, cwd=folder, text=True, env=environment, **pipes)


@pytest.mark.parametrize("words", [("track", *QUICK), ("track", "--help")])
def test_a_reader_that_has_read_enough_ends_the_command_quietly(words, tmp_path) -> None:
    reader, writer = os.pipe()
    os.close(reader)  # as `head` does after its lines
    process = start(tmp_path, *words, stdout=writer)
    os.close(writer)
    assert process.communicate(timeout=120)[1] == ""
    assert process.returncode == 141
    assert (tmp_path / "runs" / "heart" / "metrics.json").exists() == (words[1] != "--help")


@pytest.mark.parametrize(
    ("words", "until", "number", "code", "message"),
    [
        ("track --dt 1e-3 --duration 1000", "run", signal.SIGTERM, 143, ""),
        ("track --check none --duration 1000", "run", signal.SIGINT, 130, "interrupted\n"),
        ("paper --quick --workers 2", "run/cells/*", signal.SIGINT, 130, "interrupted\n"),
    ],
    ids=["checked by workers", "unchecked", "sweep"],
)
def test_a_command_that_is_ended_leaves_no_half_files(
    words: str, until: str, number: signal.Signals, code: int, message: str, tmp_path: Path
) -> None:
    process = start(tmp_path, *words.split(), "-q", "--out", "run", start_new_session=True)
    for _ in range(6000):
        if any(tmp_path.glob(until)):
            break
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    time.sleep(0.3)
    process.send_signal(number)
    _, err = process.communicate(timeout=60)
    # loky's resource tracker, a process of its own, now and then says that a lock is gone already.
    own = [line for line in err.splitlines(True) if "resource_tracker" not in line]
    assert "".join(line for line in own if not line.startswith("  warnings.")) == message
    assert process.returncode == code
    assert {path.name for path in (tmp_path / "run").iterdir()} <= {"settings.toml", "cells"}
    for path in (tmp_path / "run" / "cells").rglob("*.json"):
        assert json.loads(path.read_text())  # finished cells are whole
