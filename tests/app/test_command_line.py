"""Arguments, settings files, and what a wrong one says."""

from __future__ import annotations

import dataclasses
import io
import re
from itertools import pairwise
from pathlib import Path

import pytest

from iiwa_dnn.app.command_line import parse, run_command
from iiwa_dnn.app.folders import save_settings
from iiwa_dnn.app.main import run
from iiwa_dnn.app.options import COMMANDS, TrackOptions

SHORT = ("--dt", "1e-3", "--duration", "0.05", "--no-plots", "--quiet")


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The one line that a refusal prints."""
    code = run_command(TrackOptions, "track", lambda _: pytest.fail("not refused"), arguments)
    assert code == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("track: error: ")
    assert captured.err.count("\n") == 1
    return captured.err


@pytest.mark.parametrize("name", COMMANDS)
def test_help_names_the_quantity_and_the_unit_of_every_option(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit) as end:
        parse(COMMANDS[name], "x", ["--help"])
    assert end.value.code == 0
    text = capsys.readouterr().out
    assert "\x1b" not in text
    lines = [line for line in text.splitlines() if line.strip("│╭╰╮╯─- ")]
    rows = [line.strip("│ ") for line in lines]
    # An option's row, and the rows of its help that follow: at most two of them.
    starts = [i for i, row in enumerate(rows) if row.startswith("-")]
    shown = {}
    for start, end_ in pairwise([*starts, len(rows)]):
        assert end_ - start <= 3, rows[start]
        option, _, words = rows[start].partition("  ")
        shown[option] = " ".join([words.strip(), *rows[start + 1 : end_]])
    for field in dataclasses.fields(COMMANDS[name]):
        option = field.name.replace("_", "-")
        if field.name in ("run", "file", "shell"):
            assert any(row.startswith(("PATH  ", "SHELL  ", "[RUN]  ")) for row in rows)
            # What may be left out stands in brackets in the first line.
            assert ("[RUN]" in rows[0]) == (field.name == "run")
            continue
        (words,) = [shown[k] for k in shown if re.search(rf"--(no-)?{option}(?![\w-])", k)]
        assert words
        assert not words.startswith("(default"), option
        if "float" in str(field.type) and option != "normal":
            assert re.search(r"\[.+\]", words), (option, words)


def test_settings_come_back_from_their_file(tmp_path: Path) -> None:
    settings = parse(
        TrackOptions,
        "track",
        [
            "--q0",
            "-1e-3",
            "-.5",
            "2",
            "--lock",
            "a b",
            'c"d',
            "--robot",
            "x/ö.urdf",
            "--no-plots",
            "--joint-limit",
            "datasheet",
            "--noise",
            "1e-300",
            "--seed",
            "7",
            "--out",
            "elsewhere",
        ],
    )
    file = save_settings(settings, tmp_path)
    again = parse(TrackOptions, "track", ["--settings", str(file)])
    expected = dataclasses.replace(
        settings, settings=file, robot=str(Path("x/ö.urdf").resolve()), out=tmp_path
    )
    assert again == expected


def test_what_is_given_counts_more_than_the_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('weight = 0.7\nfilter-window = 3\nq0 = [1, 2.5]\nplots = false\nout = "here"\n')
    settings = parse(TrackOptions, "track", ["--weight", "0.1", "--settings", str(file)])
    assert (settings.weight, settings.filter_window, settings.q0) == (0.1, 3, (1.0, 2.5))
    assert (settings.plots, settings.out) == (False, Path("here"))
    assert parse(TrackOptions, "track", [f"--settings={file}", "--plots"]).plots
    # Without a place of its own, a run is written beside its file.
    file.write_text("quiet = true")
    settings = parse(TrackOptions, "track", [f"--settings={file}", "-q", "-v", "--no-plots"])
    assert (settings.out, settings.quiet, settings.verbose) == (tmp_path, True, True)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("wieght = 1", ("wieght", "did you mean: weight")),
        ('weight = "much"', ("--weight", "'much'")),
        ("weight = ", ("TOML",)),
        ("[weight]\nxi = 1", ("weight must be",)),
        ("weight = true", ("weight must be",)),
        ("plots = 1", ("plots must be true or false",)),
        ("seed = 1.5", ("--seed", "'1.5'")),
        ('command = "noise"', ("'noise'", "'track'")),
        ("overwrite = true", ("no setting", "'overwrite'")),
        ('mode = "slow"', ("'slow'", "--mode")),
        ("help = true", ("no setting", "'help'")),
        ('settings = "x"', ("no setting", "'settings'")),
    ],
)
def test_a_wrong_file_is_named(
    text: str, words: tuple[str, ...], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(text)
    line = refused(capsys, "--settings", str(file))
    assert all(word in line for word in (str(file), *words)), line


def test_a_missing_file_and_one_that_is_no_text(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "No such file" in refused(capsys, "--settings", str(tmp_path / "none.toml"))
    (tmp_path / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    assert "TOML" in refused(capsys, "--settings", str(tmp_path / "bytes.toml"))


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--wieght", "3"], ("no option '--wieght'; did you mean: --weight",)),
        (["--wieght=3"], ("no option '--wieght'; did you mean: --weight",)),
        (["--zzz"], ("no option '--zzz'",)),
        (["--mode", "konverged"], ("--mode", "'konverged'", "'converged', 'continuous'")),
        (["--dt", "fast"], ("--dt", "float: 'fast'")),
        (["--duration", "long"], ("--duration", "FLOAT", "'long'")),
        (["--seed", "1.5"], ("--seed", "int", "'1.5'")),
        (["--q0", "0", "up"], ("--q0", "'up'")),
        (["--offset", "1", "2", "--reference", "line"], ("offset: must have shape (3,)",)),
        (["--weight"], ("Missing value", "--weight")),
        (["--weight", "-q"], ("Missing value", "--weight")),
        (["--weight", "--dt", "1e-3"], ("Missing value", "--weight")),
        (["--weight", "-x"], ("Missing value", "--weight")),
        (["--no-plots", "3"], ("no option '3'",)),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
def test_a_wrong_word_is_named_in_one_line(
    arguments: list[str],
    words: tuple[str, ...],
    encoding: str,
    tmp_path: Path,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # tyro frames its messages for the encoding and the width of a terminal.
    monkeypatch.setattr("sys.stdout", io.TextIOWrapper(io.BytesIO(), encoding=encoding))
    monkeypatch.setenv("COLUMNS", "60")
    assert run("track", [*arguments, "--out", str(tmp_path / "run")], prog="track") == 2
    captured = capfd.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("track: error: ")
    assert all(word in captured.err for word in words), captured.err
    assert not re.search("[│╭╰─]|--{3}", captured.err)
    assert captured.err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_run_is_repeated_bit_for_bit(tmp_path: Path) -> None:
    # OSQP repeats itself to the last digit, ProxQP does not.
    chosen = ("--noise", "0.01", "--seed", "5", "--filter-window", "4", "--check", "osqp")
    assert run("track", [*SHORT, *chosen, "--weight", "0.3", "--out", str(tmp_path / "a")]) == 0
    file = str(tmp_path / "a" / "settings.toml")
    assert run("track", ["--settings", file, "-q", "--out", str(tmp_path / "b")]) == 0
    for name in ("record.npz", "settings.toml"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_quiet_and_verbose(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    loud = [argument for argument in SHORT if argument != "--quiet"]
    out = ("--out", str(tmp_path), "--check", "none")
    said = []
    for more in ("-q", "--seed=0", "-v"):
        assert run("track", [*loud, *out, more]) == 0
        captured = capsys.readouterr()
        assert captured.err == ""
        said.append(captured.out)
    assert said[0] == ""
    assert "verdict" in said[1]
    assert "record.npz" not in said[1]
    assert "verdict" in said[2]
    assert "record.npz" in said[2]
    assert "initial joint positions" in said[2]
    assert run("track", ["--robot", "iiwa8", "-v"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("Traceback")
    assert error.splitlines()[-1] == "iiwa-dnn track: error: no robot 'iiwa8'; did you mean: iiwa7"
