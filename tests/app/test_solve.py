"""``solve FILE``: the answer, its residuals, and files that hold no program."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import qpsolvers

from iiwa_dnn.app.main import run

# min ||x - c||^2 / 2 on a line with bounds.
PROGRAM: dict[str, Any] = {
    "P": np.eye(3),
    "q": [-1.0, 0.0, 1.0],
    "A": [[1.0, 1.0, 1.0]],
    "b": [0.5],
    "lb": np.full(3, -0.2),
    "ub": np.full(3, 0.6),
}


def saved(folder: Path, **arrays: Any) -> str:
    path = folder / "qp.npz"
    np.savez(path, **arrays)
    return str(path)


def test_the_answer_is_printed_and_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "answer"
    file = saved(tmp_path, **PROGRAM)
    assert run("solve", [file, "--check", "both", "-v", "--out", str(out)]) == 0
    lines = dict(line.split(None, 1) for line in capsys.readouterr().out.splitlines())
    problem = qpsolvers.Problem(**{name: np.array(part) for name, part in PROGRAM.items()})
    expected = qpsolvers.solve_problem(problem, solver="proxqp", eps_abs=1e-11)
    np.testing.assert_allclose(np.fromstring(lines["x"], sep=" "), expected.x, atol=1e-9)
    np.testing.assert_allclose(np.fromstring(lines["y"], sep=" "), expected.y, atol=1e-9)
    assert lines["status"].startswith("solved")
    assert all(lines[name].startswith("gap ") for name in ("proxqp", "osqp"))
    with np.load(out) as answer:
        np.testing.assert_allclose(answer["x"], expected.x, atol=1e-9)
        assert set(answer.files) == {"x", "y", "z_box"}


def test_the_answer_is_proven(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("solve", [saved(tmp_path, **PROGRAM), "--check", "proof"]) == 0
    words = capsys.readouterr().out.splitlines()[-1].split()
    assert words[:2] == ["proof", "within"]
    assert 0.0 < float(words[2]) < 1e-8
    flat = saved(tmp_path, P=np.zeros((1, 1)), q=np.zeros(1), lb=np.zeros(1), ub=np.ones(1))
    assert run("solve", [flat, "--check", "proof"]) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith("proof      none; the active rows")


def test_inequalities_alone(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = saved(tmp_path, P=np.eye(2), q=np.zeros(2), G=[[-1.0, -1.0]], h=[-2.0])
    assert run("solve", [file]) == 0
    assert "x          1 1\n" in capsys.readouterr().out


def test_no_solution_is_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = saved(tmp_path, **{**PROGRAM, "b": [5.0]})
    out = tmp_path / "answer"
    assert run("solve", [file, "--out", str(out)]) == 1
    assert "not an answer" in capsys.readouterr().out
    assert not out.exists()
    assert run("solve", [file, "-q"]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("primal infeasible: primal ")


def test_that_there_is_no_solution_is_proven(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    unbounded = {"P": np.zeros((3, 3)), "lb": [-np.inf] * 3, "ub": [np.inf] * 3}
    for change in ({"b": [5.0]}, unbounded):
        assert run("solve", [saved(tmp_path, **{**PROGRAM, **change}), "--check", "proof"]) == 1
        words = "the status is proven by a certificate, rounding counted"
        assert f"\nproof      {words}\n" in capsys.readouterr().out


def test_both_solvers_say_what_they_make_of_a_program_without_a_solution(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    crossed = {"P": np.eye(1), "q": [0.0], "G": [[1.0], [-1.0]], "h": [-1.0, -1.0]}
    assert run("solve", [saved(tmp_path, **crossed), "--check", "both"]) == 1
    lines = dict(line.split(None, 1) for line in capsys.readouterr().out.splitlines())
    assert lines["proxqp"] == "primal infeasible"
    assert lines["osqp"] == "primal infeasible"


def test_quiet_prints_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("solve", [saved(tmp_path, **PROGRAM), "-q"]) == 0
    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"Aeq": np.eye(3)}, "'Aeq'"),
        ({"P": -np.eye(3)}, "not convex"),
        ({"P": np.eye(2)}, "P: has shape (2, 2)"),
        ({"q": [np.nan, 0.0, 0.0]}, "q"),
        ({"b": np.zeros(2)}, "b"),
        ({"P": np.array([None])}, "cannot be read"),
        ({"lb": np.array(["a", "b", "c"])}, "lb"),
    ],
)
def test_bad_programs_are_one_line_and_2(
    change: dict[str, Any], words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("solve", [saved(tmp_path, **{**PROGRAM, **change})]) == 2
    error = capsys.readouterr().err
    assert error.startswith("iiwa-dnn solve: error: ")
    assert words in error
    assert error.count("\n") == 1


def test_what_is_no_archive(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    np.save(tmp_path / "one.npy", np.eye(2))
    (tmp_path / "text.npz").write_text("P = 1")
    whole = Path(saved(tmp_path, **PROGRAM))
    (tmp_path / "half.npz").write_bytes(whole.read_bytes()[:200])
    (tmp_path / "empty.npz").write_bytes(b"")
    saved(tmp_path, P=np.eye(2))
    for name in ("one.npy", "text.npz", "half.npz", "empty.npz", "none.npz", ".", "qp.npz"):
        assert run("solve", [str(tmp_path / name)]) == 2, name
        assert capsys.readouterr().err.count("\n") == 1, name
    for arguments, words in (
        ([str(whole), "--tol", "0"], "tol"),
        ([], "FILE: is missing"),
        ([str(whole), str(whole)], "no option"),
        ([str(whole), "--out", str(tmp_path / "." / "qp.npz")], "the program's own file"),
    ):
        assert run("solve", arguments) == 2
        error = capsys.readouterr().err
        assert words in error
        assert error.count("\n") == 1
