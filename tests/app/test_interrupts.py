"""Ctrl-C and SIGTERM in the middle of a run: whole files, the usual exit code, nothing left."""

from __future__ import annotations

import ctypes
import json
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from iiwa_dnn.app.interrupts import ended_by_signals
from iiwa_dnn.app.main import main
from iiwa_dnn.results.record import Record

ENDS = {signal.SIGINT: (130, "interrupted\n"), signal.SIGTERM: (143, "terminated\n")}
LONG = ["--duration", "1000", "--dt", "1e-3", "--quiet", "--out"]


def start(name: str, folder: Path, *arguments: str) -> subprocess.Popen[str]:
    """The script, its workers in a group of their own."""
    command = [sys.executable, "-m", "iiwa_dnn", name, *arguments]
    return subprocess.Popen(
        command,
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def wait_for(folder: Path, process: subprocess.Popen[str], pattern: str) -> None:
    """Until the script has made a file or folder."""
    for _ in range(6000):
        if any(folder.glob(pattern)):
            return
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    raise AssertionError(f"no {pattern} after a minute")


def end(process: subprocess.Popen[str], number: signal.Signals) -> tuple[int, str, str]:
    """Exit code, standard output and standard error of a script that was sent a signal.

    loky's resource tracker, a process of its own, now and then outlives the workers and says that a
    lock of theirs is gone already; those lines are not the script's.
    """
    process.send_signal(number)
    out, err = process.communicate(timeout=60)
    lines = [
        line
        for line in err.splitlines(keepends=True)
        if "resource_tracker" not in line and not line.startswith("  warnings.warn(")
    ]
    return process.returncode, out, "".join(lines)


@pytest.mark.parametrize(
    ("name", "options", "number"),
    [
        ("track", LONG, signal.SIGTERM),
        (
            "paper",
            ["--quick", "--duration", "0.3", "--workers", "2", "--quiet", "--out"],
            signal.SIGINT,
        ),
    ],
    ids=["checked by workers", "sweep"],
)
def test_a_run_that_is_ended_leaves_no_half_files(
    name: str, options: list[str], number: signal.Signals, tmp_path: Path
) -> None:
    process = start(name, tmp_path, *options, str(tmp_path / "run"))
    # Of a sweep the first cell: while its workers start, they complain in their own words.
    wait_for(tmp_path, process, "run/cells/*.json" if name == "paper" else "run")
    time.sleep(0.3)
    code, message = ENDS[number]
    assert end(process, number) == (code, "", message)
    for path in (tmp_path / "run").rglob("*"):
        # Of a sweep, finished cells; of a run, nothing.
        assert path.name == "cells" or json.loads(path.read_text())["values"]


def end_here(folder: Path, pattern: str, number: signal.Signals, *words: str) -> object:
    """Exit code of a command in this process, sent a signal once a file or folder is there."""
    returned = threading.Event()

    def send() -> None:
        for _ in range(6000):
            if any(folder.glob(pattern)) or returned.wait(0.01):
                break
        if not returned.wait(0.1):
            os.kill(os.getpid(), number)

    sender = threading.Thread(target=send)
    sender.start()
    try:
        with pytest.raises(SystemExit) as caught:
            main(words)
    finally:
        returned.set()
        sender.join()
    return caught.value.code


@pytest.mark.filterwarnings("default")  # put back what the script switches off
def test_an_unchecked_run_in_physics_leaves_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")
    words = ["physics", "--no-pictures", "--no-video", "--check", "none", *LONG]
    code = end_here(tmp_path, "run", signal.SIGINT, *words, str(tmp_path / "run"))
    assert (code, capsys.readouterr()) == (130, ("", "interrupted\n"))
    assert not any((tmp_path / "run").iterdir())


@pytest.mark.filterwarnings("default")
def test_what_was_written_before_is_whole(tmp_path: Path) -> None:
    words = ["track", "--dt", "1e-3", "--duration", "0.05", "--check", "none", "--quiet", "--out"]
    code = end_here(tmp_path, "metrics.json", signal.SIGTERM, *words, str(tmp_path))
    assert code == 143  # while it draws
    assert Record.load(tmp_path / "record.npz").steps == 50
    assert json.loads((tmp_path / "metrics.json").read_text())["steps"] == 50
    assert not (tmp_path / "report.md").exists()
    assert not list(tmp_path.glob(".*"))
    for path in tmp_path.glob("*.png"):
        assert path.read_bytes().endswith(b"IEND\xaeB`\x82")


@pytest.mark.filterwarnings("default")  # put back what the script switches off
@pytest.mark.parametrize("number", ENDS)
def test_what_goes_wrong_on_the_way_out_changes_nothing(
    number: signal.Signals, capsys: pytest.CaptureFixture[str]
) -> None:
    @ended_by_signals()
    def run() -> None:
        try:
            signal.raise_signal(number)
        finally:
            raise AssertionError("no process is started")

    with pytest.raises(SystemExit) as caught:
        run()
    assert (caught.value.code, capsys.readouterr().err) == ENDS[number]


@pytest.mark.parametrize("number", ENDS)
def test_a_signal_in_a_callback_of_c_is_not_lost(
    number: signal.Signals, capsys: pytest.CaptureFixture[str]
) -> None:
    """C code drops an exception that its callback raises, as LLVM's compiler does."""
    callback = ctypes.CFUNCTYPE(None)(lambda: signal.raise_signal(number))
    hook = sys.unraisablehook
    before = signal.getsignal(signal.SIGALRM)
    gone_on = []

    @ended_by_signals()
    def run() -> None:
        callback()
        time.sleep(10.0)
        gone_on.append(True)

    with pytest.raises(SystemExit) as ended:
        run()
    assert not gone_on
    assert (ended.value.code, capsys.readouterr().err) == ENDS[number]
    assert sys.unraisablehook is hook
    assert signal.getsignal(signal.SIGALRM) is before


def test_other_errors_pass_and_the_handlers_before_are_put_back() -> None:
    before = {number: signal.getsignal(number) for number in ENDS}

    @ended_by_signals()
    def run() -> None:
        assert all(signal.getsignal(number) is not before[number] for number in ENDS)
        raise SystemExit(2)

    with pytest.raises(SystemExit) as caught:
        run()
    assert caught.value.code == 2
    assert {number: signal.getsignal(number) for number in ENDS} == before


def test_other_threads_may_call_a_script_too() -> None:
    seen: list[int] = []

    def call() -> None:
        with ended_by_signals():
            seen.append(1)

    thread = threading.Thread(target=call)
    thread.start()
    thread.join()
    assert seen == [1]
