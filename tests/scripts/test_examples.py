"""The worked examples run from anywhere, end with 0 and print what they promise."""

import re
import runpy
import sys
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import pytest

SCRIPTS = Path(__file__).parents[2] / "scripts"
Example = Callable[..., str]


def call(name: str, *words: str) -> int | str | None:
    """Run a script in this process, which has imported all; returns its exit code."""
    arguments = [name, *words]
    with mock.patch.object(sys, "argv", arguments), pytest.raises(SystemExit) as end:
        runpy.run_path(str(SCRIPTS / name), run_name="__main__")
    return end.value.code


@pytest.fixture
def example(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Example:
    """Run an example in a folder of its own; returns what it prints."""
    monkeypatch.chdir(tmp_path)

    def run(name: str, *words: str) -> str:
        code = call(name, *words)
        said = capsys.readouterr()
        assert not code, said.out + said.err
        return said.out

    return run


def number(pattern: str, text: str) -> float:
    """The number that stands where the pattern has its group."""
    found = re.search(pattern, text)
    assert found is not None, text
    return float(found[1])


def test_what_an_example_takes_and_does_not_take_is_told(
    example: Example, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert "positional arguments" in example("control_loop.py", "--help")
    assert not any(tmp_path.iterdir())
    assert call("control_loop.py", "0") == 2  # the package's own error, in one line
    said = "control_loop: error: steps: must be a whole number of at least 1"
    error = capsys.readouterr().err
    assert error.startswith(said)
    assert error.count("\n") == 1
    assert call("priorities.py", "x") == 2  # a wrong word is told by tyro
    error = capsys.readouterr().err
    assert "'x'" in error
    assert "Traceback" not in error


def test_a_control_loop(example: Example) -> None:
    text = example("control_loop.py", "200")
    assert 0.0 < number(r"median ([\d.]+) us", text) <= number(r"p99 ([\d.]+) us", text)
    assert 0.0 < number(r"largest (\S+) m\b", text) < 1e-5


def test_a_control_loop_with_noise_and_a_jerk_limit(example: Example) -> None:
    text = example(
        "control_loop.py", "100", "--noise", "1e-4", "--jerk", "200", "--delay-periods", "2"
    )
    assert 0.0 < number(r"largest (\S+) m\b", text) < 1e-3


def test_priorities(example: Example) -> None:
    text = example("priorities.py", "4", "4e-3")
    left = [float(value) for value in re.findall(r"residual at most (\S+)", text)]
    assert max(left[:2]) < 1e-8
    assert left[2] > 0.1


def test_the_heart_around_an_obstacle(example: Example, tmp_path: Path) -> None:
    text = example("avoid_obstacle.py", "figures", "5e-3")
    errors = re.findall(r"error (\S+) m", text)
    nearest = [float(value) for value in re.findall(r"least distance (\S+) m", text)]
    assert float(errors[1]) < 1.1 * float(errors[0])
    assert nearest[0] < -0.03
    assert 0.02 <= nearest[1] < 0.021
    assert "failures []" in text
    assert (tmp_path / "figures" / "with.npz").exists()


def test_a_second_paper(example: Example) -> None:
    text = example("posture_obstacle.py", "1e-3", "0.1")
    assert text.count(" authors: ") == text.count(" ours: ") == 4
