"""Arguments, settings files, and what a wrong one says."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import pytest

from iiwa_dnn.app.command_line import parse, save_settings
from iiwa_dnn.app.settings import (
    NoiseSettings,
    PaperSettings,
    PhysicsSettings,
    SolveSettings,
    TrackSettings,
    ViewSettings,
)
from iiwa_dnn.app.track import track_heart

ALL = (
    NoiseSettings,
    TrackSettings,
    PaperSettings,
    PhysicsSettings,
    ViewSettings,
    SolveSettings,
)
SHORT = ("--dt", "1e-3", "--duration", "0.05", "--no-plots", "--quiet")


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The one line that a refusal prints."""
    with pytest.raises(SystemExit) as end:
        parse(TrackSettings, "track", arguments)
    assert end.value.code == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("track: error: ")
    assert captured.err.count("\n") == 1
    return captured.err


@pytest.mark.parametrize("kind", ALL)
def test_help_fits_a_screen_and_says_something_of_every_option(
    kind: type, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    with pytest.raises(SystemExit) as end:
        parse(kind, "x", ["--help"])
    assert end.value.code == 0
    text = capsys.readouterr().out
    # The description is left to the terminal to wrap.
    lines = [part for line in text.splitlines() for part in (line[i : i + 80] for i in
             range(0, max(len(line), 1), 80))]  # fmt: skip
    assert len(lines) <= 45
    assert "\x1b" not in text
    for field in dataclasses.fields(kind):
        option = field.name.replace("_", "-")
        rows = [line.strip("│ ") for line in text.splitlines()]
        shown = [row for row in rows if row.startswith("-") and f"-{option} " in row]
        assert shown or field.name in ("run", "file"), option
        assert all(len(row.split("  ", 1)) == 2 for row in shown), option


def test_settings_come_back_from_their_file(tmp_path: Path) -> None:
    settings = parse(
        TrackSettings,
        "track",
        ["--q0", "-1e-3", "-.5", "2", "--lock", "a b", 'c"d', "--robot", "x/ö.urdf", "--no-plots",
         "--joint-limit", "datasheet", "--noise", "1e-300", "--seed", "7", "--out", "elsewhere"],
    )  # fmt: skip
    file = save_settings(settings, tmp_path)
    again = parse(TrackSettings, "track", ["--settings", str(file)])
    expected = dataclasses.replace(
        settings, settings=file, robot=str(Path("x/ö.urdf").resolve()), out=Path("runs/heart")
    )
    assert again == expected


def test_what_is_given_counts_more_than_the_file(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text('weight = 0.7\nfilter-window = 3\nq0 = [1, 2.5]\nplots = false\nout = "here"\n')
    settings = parse(TrackSettings, "track", ["--weight", "0.1", "--settings", str(file)])
    assert (settings.weight, settings.filter_window, settings.q0) == (0.1, 3, (1.0, 2.5))
    assert (settings.plots, settings.out) == (False, Path("here"))
    assert parse(TrackSettings, "track", [f"--settings={file}", "--plots"]).plots


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


def test_hints(capsys: pytest.CaptureFixture[str]) -> None:
    assert "did you mean --weight?" in refused(capsys, "--wieght", "3")
    assert "'converged'" in refused(capsys, "--mode", "konverged")


def test_a_run_is_repeated_bit_for_bit(tmp_path: Path) -> None:
    # OSQP repeats itself to the last digit, ProxQP does not.
    chosen = ("--noise", "0.01", "--seed", "5", "--filter-window", "4", "--check", "osqp")
    assert track_heart([*SHORT, *chosen, "--weight", "0.3", "--out", str(tmp_path / "a")]) == 0
    file = str(tmp_path / "a" / "settings.toml")
    assert track_heart(["--settings", file, "-q", "--out", str(tmp_path / "b")]) == 0
    for name in ("record.npz", "settings.toml"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_quiet_and_verbose(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    loud = [argument for argument in SHORT if argument != "--quiet"]
    out = ("--out", str(tmp_path), "--check", "none")
    said = []
    for more in ("-q", "--seed=0", "-v"):
        assert track_heart([*loud, *out, more]) == 0
        captured = capsys.readouterr()
        assert captured.err == ""
        said.append(captured.out)
    assert said[0] == ""
    assert "verdict" in said[1]
    assert "record.npz" not in said[1]
    assert "verdict" in said[2]
    assert "record.npz" in said[2]
    assert "initial joint positions" in said[2]
    assert track_heart(["--robot", "iiwa8", "-v"]) == 2
    error = capsys.readouterr().err
    assert error.startswith("Traceback")
    assert error.splitlines()[-1] == ("track_heart: error: no robot 'iiwa8'; did you mean: iiwa7")
