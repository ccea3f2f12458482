"""``iiwa-dnn``: the right command runs, a wrong one is told, nothing is coloured when piped."""

from __future__ import annotations

import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from numba.core import event

import iiwa_dnn
from iiwa_dnn.app.main import main
from iiwa_dnn.app.options import COMMANDS

SCRIPTS = {"track": "track_heart"}


def test_the_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    for arguments in ([], ["--help"], ["-h"]):
        assert main(arguments) == 0
        text = capsys.readouterr().out
        assert all(re.search(rf"^│? +• {name} +\w", text, re.MULTILINE) for name in COMMANDS)
        assert text.count("\n") < 32
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"iiwa-dnn {iiwa_dnn.__version__}\n"


@pytest.mark.parametrize("name", COMMANDS)
def test_a_command_and_its_script_have_one_help(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(SystemExit) as end:
        main([name, "--help"])
    assert end.value.code == 0
    text = capsys.readouterr().out
    assert text.startswith(f"usage: iiwa-dnn {name} ")
    if name in SCRIPTS:
        script = Path(__file__).parents[2] / "scripts" / f"{SCRIPTS[name]}.py"
        monkeypatch.setenv("TERM", "xterm-256color")
        monkeypatch.setattr(sys, "argv", [str(script), "--help"])
        with pytest.raises(SystemExit) as end:
            runpy.run_path(str(script), run_name="__main__")
        assert end.value.code == 0
        said = capsys.readouterr().out
        assert "\x1b" not in said  # no terminal, so without colour
        # Frames are drawn where the stream's encoding has them.
        words = [re.findall(r"\w[\w/|,.:-]*", said) for said in (said, text)]
        assert words[0][2:] == words[1][3:]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["trakc"], "no command 'trakc'; did you mean: track"),
        (
            ["track", "--robot", "iiwa8"],
            "iiwa-dnn track: error: no robot 'iiwa8'; did you mean: iiwa7\n",
        ),
        (["completion"], "there are: bash, zsh, tcsh"),
        (["completion", "bsh"], "did you mean: bash"),
    ],
)
def test_an_unknown_command_is_one_line(
    arguments: list[str], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(arguments) == 2
    error = capsys.readouterr().err
    assert words in error
    assert error.count("\n") == 1


def test_completion_knows_commands_and_options(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    bash = shutil.which("bash")
    assert bash is not None
    checked = subprocess.run([bash, "-n"], input=script, text=True, capture_output=True)
    assert (checked.returncode, checked.stderr) == (0, "")
    assert all(name in script for name in (*COMMANDS, "--filter-window"))


def test_after_the_warm_up_runs_compile_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["warm-up"]) == 0
    said = capsys.readouterr()
    assert re.fullmatch(r"compiled in \d+ s\n", said.out)
    assert said.err == ""  # the progress line is for terminals
    short = ("--dt", "1e-3", "--duration", "0.02", "-q", "--no-plots", "--overwrite")
    runs = (
        ((), 0),
        (("--noise", "0.01", "--filter-window", "10", "--orientation", "none"), 0),
        (("--mode", "continuous", "--orientation", "block"), 0),
        (("--motion", "rk4", "--kinetic", "inertia", "--reference", "circle"), 0),
        (("--reference", "cone", "--check", "proof"), 0),
        (("--scale", "0.1", "--speed", "0.01"), 1),  # steps without a solution
        (("--acceleration-limit", "10", "--obstacles", str(tmp_path / "ball.toml")), 0),
    )
    ball = '[[obstacle]]\nshape = "sphere"\ncenter = [9.0, 9.0, 9.0]\nradius = 0.1\n'
    (tmp_path / "ball.toml").write_text(ball)
    with event.install_recorder("numba:compile") as compiled:
        for arguments, code in runs:
            assert main(["track", *short, *arguments, "--out", str(tmp_path)]) == code
    assert [entry.data["dispatcher"] for _, entry in compiled.buffer] == []
