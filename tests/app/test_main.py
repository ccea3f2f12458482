"""``iiwa-dnn``: help, wrong words, signals, closed pipes; what a set-up compiles."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

import iiwa_dnn
from helpers_commands import QUICK, call, results
from iiwa_dnn.app.main import COMMANDS
from iiwa_dnn.results.failures import completed

ROOT = Path(__file__).parents[2]


def test_the_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    for words in ((), ("--help",), ("-h",)):
        assert call(*words) == 0
        text = capsys.readouterr().out
        assert all(re.search(rf"^│? +• {name} +\w", text, re.MULTILINE) for name in COMMANDS)
    usual = ["track", "physics", "export", "paper", "atlas", "view", "replay", "collisions"]
    assert list(COMMANDS) == usual
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
        (("track", "--q0", "0", "up"), ("--q0", "'up'")),
        (("paper", "--table", "3"), ("--table", "'3'")),
        (("view",), ("PATH",)),
        (("export", "--push", "0", "1", "0"), ("--push",)),  # a controller has no plant
        (("export", "--noise", "0.1"), ("--noise",)),
    ],
)
def test_a_wrong_word_is_named_with_the_nearest_option(words, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert call(*words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert all(word in captured.err for word in said), captured.err
    assert list(tmp_path.iterdir()) == []


BAD = [
    ("track --robot robot.urdf", "not XML"),
    ("track --q0 0 0", "q0: must have shape (7,)"),
    ("track --duration 1e12", "duration: 1e+16 steps"),
    ("track --joint-limit 0", "joint-limit: must be"),
    ("track --speed 0", "speed: must be"),
    (
        "track --acceleration-limit -1",
        "limits.acceleration (--acceleration-limit): limit: must be",
    ),
    ("track circle --smooth 1", "no setting in [reference] (--smooth) 'noise'"),
    ("track --weight 3", "scheme (--weight): weight: must be in [0, 1]"),
    ("track --seed -1", "seed: must be"),
    ("track hart", "reference: must be one of heart, circle, "),
    ("track bad.csv", "bad.csv: a header must name t, x, y, z"),
    ("track --set reference.radius=1", "no setting in [reference] 'radius'"),
    (
        "track tilting-circle --set reference.along.radius=0",
        "reference.along: radius: must be a finite number",
    ),
    ("track --set robot.nam=ur5", "no setting in [robot] 'nam'; did you mean: name"),
    ("track --set scheme.wieght=1", "no setting in [scheme] 'wieght'; did you mean: weight"),
    ("track --set limits.tipspeed=1", "no setting in [limits] 'tipspeed'"),
    ("physics --set plant.disturbances.fricton=1", "did you mean: friction"),
    ("track --plant franka", "plant: must be one of ideal, mujoco, not 'franka'"),
    ("track --set run.progress=3", "no setting in [run] 'progress'"),
    ("track --set schema.weight=1", "table: must be one of robot, reference, scheme, limits, run"),
    ("track --set run=1", "run: must be a table, not 1"),
    ("track --config bad.csv --dt 1e-3", "run: must be a table, not [{"),
    ("track --set limits.obstacles.distance=1", "limits.obstacles: must be a name or a file"),
    ("track --check foo", "run.check: solvers: must be one of clarabel, "),
    ("track --config none.toml", "none.toml: cannot be read as TOML"),
    ("track --out bad.csv/run", "bad.csv/run: cannot be written"),
    ("paper --workers 0", "workers: must be a whole number of at least 1"),
    ("paper --out bad.csv/run", "bad.csv/run: cannot be written to"),
    ("atlas --networks nowhere:My", "network: nowhere:My cannot be had in "),
    ("atlas --networks math:pi", "network: math:pi is no Network: 3.14"),
    ("atlas --networks zeroing,Eular", "no network 'zeroing,Eular'; did you mean: 'zeroing, E"),
    ("atlas --disturbances wihte", "disturbances: must be one of none, constant, ramp"),
    ("atlas --work -1", "work: must be a finite number above 0"),
    ("view nowhere", "nowhere: cannot be read as a record: No such file"),
]


@pytest.mark.parametrize(("words", "said"), BAD)
def test_bad_input_is_one_clear_line_and_leaves_no_file(words, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bad.csv").write_text("[[run]]\ndt = 1\n")  # bad TOML too
    (tmp_path / "robot.urdf").write_text("solid robot\n")
    assert call(*words.split()) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert captured.err.startswith(f"iiwa-dnn {words.split()[0]}: error: ")
    assert said in captured.err
    assert {path.name for path in tmp_path.iterdir()} == {"bad.csv", "robot.urdf"}


def start(folder: Path, *words: str, code: str = "", **options: object) -> Any:
    """A command in a process of its own, after some code."""
    code += "import sys; from iiwa_dnn.app.main import main; sys.exit(main())"
    command = [sys.executable, "-c", code, *words]
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


def own_lines(err: str) -> list[str]:
    """Lines that are not of loky's resource tracker, which now and then misses a lock."""
    lines = [line for line in err.splitlines() if "resource_tracker" not in line]
    return [line for line in lines if not line.startswith("  warnings.")]


REPORTING = """
from iiwa_dnn.simulation.loop import Loop
run = Loop.run
def report(*arguments):
    print(arguments[1], flush=True)
    return run(*arguments)
Loop.run = report
"""
"""Prints the number of each block's first step."""


@pytest.mark.parametrize(
    ("words", "number", "code"),
    [
        ("track --dt 1e-3 --duration 1000", signal.SIGTERM, 143),
        ("track --dt 1e-3 --duration 1000", signal.SIGINT, 130),
        ("track --check none --duration 1000", signal.SIGINT, 130),
    ],
    ids=["checked, ended", "checked", "unchecked"],
)
def test_a_run_that_is_ended_leaves_its_steps_and_says_so(
    words: str, number: signal.Signals, code: int, tmp_path: Path
) -> None:
    """As a terminal does it, the signal goes to the workers too, while they start."""
    words += " -q --out run"
    process = start(tmp_path, *words.split(), code=REPORTING, start_new_session=True)
    while process.stdout.readline() != "3000\n":
        assert process.poll() is None
    os.killpg(process.pid, number)
    _, err = process.communicate(timeout=60)
    assert process.returncode == code
    record, metrics = results(tmp_path / "run")
    steps = metrics["steps"]
    assert 2000 < steps < metrics["settings"]["duration"] / metrics["dt_s"]
    ended = f"ended after {steps:,} of {1000 / metrics['dt_s']:,.0f} steps: interrupted"
    assert own_lines(err) == [f"path completed {completed(metrics)}", ended, "interrupted"]
    assert f"- {ended}" in (tmp_path / "run" / "report.md").read_text()
    assert record["q"].shape == (steps + 1, 7)
    assert (metrics["crosscheck"]["steps_checked"] == steps) == ("none" not in words)
    names = {"settings.toml", "record.npz", "metrics.json", "report.md"}
    assert {path.name for path in (tmp_path / "run").iterdir()} == names


def test_a_sweep_that_is_ended_leaves_no_half_files(tmp_path: Path) -> None:
    words = ("paper", "--quick", "--workers", "2", "-q", "--out", "run")
    process = start(tmp_path, *words, start_new_session=True)
    for _ in range(6000):
        if any(tmp_path.glob("run/cells/*")):
            break
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert (process.returncode, own_lines(err)) == (130, ["interrupted"])
    assert {path.name for path in (tmp_path / "run").iterdir()} == {"settings.toml", "cells"}
    for path in (tmp_path / "run" / "cells").rglob("*.json"):
        assert json.loads(path.read_text())  # finished cells are whole
