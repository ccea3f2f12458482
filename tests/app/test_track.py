"""The script: what it writes, what it says, and its exit codes."""

from __future__ import annotations

import errno
import json
import os
import re
import resource
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from helpers_kinematics import PAPER_Q0, dh_pose
from helpers_records import draw_only
from iiwa_dnn.app import track as cli
from iiwa_dnn.app.main import run as run_command
from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Solution
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Configuration, load_robot
from iiwa_dnn.simulation import runner as loop

SCRIPT = Path(__file__).parents[2] / "scripts" / "track_heart.py"
IIWA7 = next((SCRIPT.parents[1] / "robots" / "iiwa7").glob("*.urdf"))
SHORT = ["--dt", "1e-3", "--duration", "0.05"]
QUICK = [*SHORT, "--no-plots"]


def call(arguments: list[str]) -> int:
    """The exit code, whether the parser ends the process or the function returns."""
    try:
        return run_command("track", arguments, prog="track_heart")
    except SystemExit as end:
        return int(str(end.code))


def results(folder: Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Record and metrics, read with numpy and json alone."""
    with np.load(folder / "record.npz", allow_pickle=False) as archive:
        arrays = dict(archive)
    return arrays, json.loads((folder / "metrics.json").read_text())


def run(folder: Path, *arguments: str) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    assert call([*QUICK, *arguments, "--out", str(folder)]) == 0
    return results(folder)


# What a run leaves


def test_a_run_writes_record_metrics_report_and_figures(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    draw_only(monkeypatch, "convergence")
    folder = tmp_path / "new" / "runs"
    assert call([*SHORT, "--out", str(folder)]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    assert str(folder) in captured.out
    assert "verdict" in captured.out
    files = {path.name for path in folder.iterdir()}
    assert {"record.npz", "metrics.json", "report.md"} <= files
    figures = {path.stem for path in folder.glob("*.png")}
    assert figures == {path.stem for path in folder.glob("*.pdf")}
    assert figures == {"convergence"}
    assert all((folder / name).stat().st_size > 0 for name in files)
    report = (folder / "report.md").read_text()
    assert all(f"({figure}.png)" in report for figure in figures)


def test_a_run_beyond_the_data_sheets_limits_is_told_of_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # The heart's joints stay inside; these go to 2.118 rad, within the paper's 2.5.
    words = ["--reference", "circle", "--radius", "0.08", "--period", "5", "--dt", "5e-3"]
    words += ["--no-plots", "--check", "none", "--out"]
    assert call([*words, str(tmp_path / "papers")]) == 0
    said = capsys.readouterr().err
    assert "joint 4 is at 2.11" in said
    assert "--joint-limit datasheet" in said
    assert call([*words, str(tmp_path / "own"), "--joint-limit", "2.5"]) == 0
    assert capsys.readouterr().err == ""
    call([*words, str(tmp_path / "sheet"), "--joint-limit", "datasheet"])
    arrays, _ = results(tmp_path / "sheet")
    assert arrays["q"][:, 3].max() <= 2.0944 + 1e-5


def test_no_plots_and_quiet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert call([*QUICK, "--quiet", "--out", str(tmp_path)]) == 0
    captured = capsys.readouterr()
    assert (captured.out, captured.err) == ("", "")
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"record.npz", "metrics.json", "report.md", "settings.toml"}


def test_csv_writes_all_samples_beside_the_record(tmp_path: Path) -> None:
    assert call([*QUICK, "--quiet", "--csv", "--out", str(tmp_path)]) == 0
    record = Record.load(tmp_path / "record.npz")
    table = np.genfromtxt(tmp_path / "record.csv", delimiter=",", names=True)
    np.testing.assert_array_equal(table["t"], record.t)
    np.testing.assert_array_equal(table["kkt_residual"][:-1], record.kkt_residual)


def test_no_network_is_needed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*args: object, **options: object) -> None:
        raise AssertionError("a connection was opened")

    monkeypatch.setattr(socket.socket, "connect", refuse)
    monkeypatch.setattr(socket, "getaddrinfo", refuse)
    assert call([*QUICK, "--quiet", "--out", str(tmp_path)]) == 0


@pytest.mark.parametrize(
    "arguments",
    [
        (),
        ("--noise", "0.01", "--filter-window", "10", "--seed", "4"),
        ("--motion", "rk4", "--check", "both"),
        ("--mode", "continuous", "--orientation", "block", "--dt", "1e-4", "--duration", "0.02"),
        ("--joint-limit", "2.3571", "--weight", "1"),
    ],
    ids=["default", "noise", "rk4", "continuous", "limit"],
)
def test_metrics_can_be_recomputed_from_the_record_alone(
    arguments: tuple[str, ...], tmp_path: Path
) -> None:
    record, metrics = run(tmp_path, *arguments)
    position, rotation = dh_pose(record["q"])
    error = position - record["position_desired"]
    # tr(R_d' R) = 1 + 2 cos(angle) is useless near zero; ||R - R_d||_F = 2 sqrt(2) sin(angle / 2).
    desired = np.broadcast_to(dh_pose(record["q"][0])[1], rotation.shape)
    chord = np.sqrt(((rotation - desired) ** 2).sum(axis=(1, 2)))
    settings = json.loads(str(record["settings"]))
    lower = np.array(settings["q_lower"])
    upper = np.array(settings["q_upper"])
    excess = np.maximum(lower - record["q"], record["q"] - upper)
    dq = np.diff(record["q"], axis=0) / settings["dt"]
    expected = {
        "max_position_error_m": np.sqrt((error**2).sum(axis=1)).max(),
        "mse_position_error_m2": (error**2).mean(),
        "max_orientation_error_rad": (2.0 * np.arcsin(chord / np.sqrt(8.0))).max(),
        "joint_drift_rad": np.abs(record["q"][-1] - record["q"][0]).max(),
        "max_kinetic_index": (dq**2).sum(axis=1).max(),
        "position_limit_violation_rad": max(excess.max(), 0.0),
        "velocity_limit_violation_rad_s": max((np.abs(dq) - settings["dq_max"]).max(), 0.0),
        "max_kkt_residual": record["kkt_residual"].max(),
    }
    for name, value in expected.items():
        assert metrics[name] == pytest.approx(value, rel=1e-9, abs=1e-9), name
    assert metrics["steps"] == len(record["dq"]) == round(settings["duration"] / settings["dt"])
    assert metrics["dt_s"] == settings["dt"]
    assert metrics["duration_s"] == pytest.approx(record["t"][-1])
    assert metrics["wall_time_s"] > 0.0
    assert metrics["realtime_factor"] == pytest.approx(
        metrics["duration_s"] / metrics["wall_time_s"]
    )
    check = metrics["crosscheck"]
    gap = record["solution_gap"].max(axis=1)
    np.testing.assert_array_equal(record["crosscheck_gap"], gap)
    believed = record["reference_residual"] <= 1e-8
    assert believed.any()
    assert check["steps_checked"] == metrics["steps"]
    assert check["max_solution_gap"] == record["solution_gap"][believed].max()
    assert check["max_objective_gap"] == record["objective_gap"][believed].max()
    residual = record["reference_residual"]
    assert check["max_reference_residual"] == residual[np.isfinite(residual)].max()
    assert check["reference_failures"] == (record["reference_residual"] > 1e-8).sum()
    if settings["mode"] == "converged":
        assert check["disagreements"] == (gap > 1e-6).sum()


@pytest.mark.parametrize(
    ("check", "solver", "columns"),
    [
        ("proxqp", "proxqp", 1),
        ("osqp", "osqp", 1),
        ("both", "proxqp+osqp", 2),
        ("proof", "proof", 1),
        ("none", "none", 0),
    ],
)
def test_references(check: str, solver: str, columns: int, tmp_path: Path) -> None:
    record, metrics = run(tmp_path, "--check", check)
    assert record["solution_gap"].shape == (50, columns)
    assert metrics["crosscheck"]["solver"] == solver
    assert metrics["crosscheck"]["steps_checked"] == (50 if columns else 0)
    assert metrics["crosscheck"]["disagreements"] == 0
    assert metrics["crosscheck"]["reference_failures"] == 0
    if columns:
        assert 0.0 < metrics["crosscheck"]["max_solution_gap"] <= 1e-6


def test_options_reach_the_run(tmp_path: Path) -> None:
    q0 = [0.1, 0.5, -0.2, 1.2, 0.3, -0.8, 0.0]
    _, metrics = run(
        tmp_path,
        *("--q0", *map(str, q0)),
        *("--weight", "0.7", "--kinetic", "inertia", "--orientation", "none"),
        *("--joint-limit", "2", "--scale", "1e-3", "--motion", "midpoint"),
        *("--noise", "1e-4", "--noise-at", "measurement", "--filter-window", "3", "--seed", "8"),
        *("--check", "osqp", "--tolerance", "1e-5", "--tip", "iiwa7_link_7"),
    )
    settings = metrics["settings"]
    expected = {
        "robot": "iiwa7",
        "tip": "iiwa7_link_7",
        "q0": q0,
        "q_lower": [-2.0] * 7,
        "q_upper": [2.0] * 7,
        "dt": 1e-3,
        "duration": 0.05,
        "mode": "converged",
        "motion": "midpoint",
        "noise": 1e-4,
        "noise_at": "measurement",
        "filter_window": 3,
        "seed": 8,
    }
    assert expected.items() <= settings.items()
    scheme = {"weight": 0.7, "kinetic": "inertia", "orientation": "none", "home": q0}
    assert scheme.items() <= settings["scheme"].items()
    assert settings["reference"]["scale"] == 1e-3
    assert settings["check"]["tolerance"] == 1e-5


def test_defaults_are_the_papers_experiment_without_noise(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: dict[str, Any] = {}

    def take(robot: Any, scheme: Any, reference: Any, q0: Any, **options: Any) -> None:
        asked.update(options, robot=robot, scheme=scheme, reference=reference, q0=q0)
        raise IiwaDnnError("seen enough")

    monkeypatch.setattr(cli, "simulate", take)
    assert call([]) == 2
    assert asked["robot"].name == "iiwa7"
    np.testing.assert_array_equal(asked["robot"].q_lower, np.full(7, -2.5))
    np.testing.assert_array_equal(asked["robot"].q_upper, np.full(7, 2.5))
    np.testing.assert_array_equal(asked["q0"], PAPER_Q0)
    scheme = asked["scheme"]
    gains = (scheme.drift_gain, scheme.position_gain, scheme.orientation_gain, scheme.limit_gain)
    assert gains == (10.2, 10.2, 10.2, 20.0)
    assert (scheme.weight, scheme.orientation, scheme.kinetic) == (0.2, "so3", "identity")
    assert (asked["reference"].scale, asked["reference"].period) == (3.45e-3, 10.0)
    np.testing.assert_allclose(
        asked["reference"].at(0.0).position, dh_pose(PAPER_Q0)[0], rtol=0, atol=1e-12
    )
    expected = {
        "dt": 1e-4,
        "duration": None,  # the reference's
        "mode": "converged",
        "motion": "euler",
        "noise": 0.0,
        "filter_window": 1,
        "seed": 0,
    }
    assert expected.items() <= asked.items()
    assert asked["reference"].duration == 10.0
    assert (asked["check"].solvers, asked["check"].tolerance) == (("proxqp",), 1e-6)


def test_limits_on_acceleration_and_jerk(tmp_path: Path) -> None:
    arrays, metrics = run(tmp_path, "--acceleration-limit", "robot", "--jerk-limit", "300")
    limits = metrics["settings"]["scheme"]["extra_limits"]
    assert [limit["limit"] for limit in limits] == [None, 300.0]
    assert np.abs(np.diff(arrays["q"], 3, axis=0)).max() < 300.0 * 1e-9


def test_datasheet_limits(tmp_path: Path) -> None:
    _, metrics = run(tmp_path, "--joint-limit", "datasheet", "--check", "none")
    degrees = np.rad2deg(metrics["settings"]["q_upper"])
    np.testing.assert_allclose(degrees, [170, 120, 170, 120, 170, 120, 175], atol=1e-6)


def test_negative_numbers_are_taken_in_every_notation(tmp_path: Path) -> None:
    q0 = ["-1e-3", "-.5", "-2e-1", "1.2", "-3E-1", "-0.8", "0"]
    _, metrics = run(tmp_path, "--q0", *q0, "--check", "none")
    assert metrics["settings"]["q0"] == [float(value) for value in q0]


def test_another_robot_by_its_file_and_a_locked_joint(tmp_path: Path) -> None:
    q0 = map(str, np.delete(PAPER_Q0, 2))
    record, metrics = run(
        tmp_path,
        *("--robot", str(IIWA7), "--lock", "iiwa7_joint_3", "--q0", *q0, "--scale", "1e-3"),
    )
    assert record["q"].shape == (51, 6)
    position, _ = dh_pose(np.insert(record["q"], 2, 0.0, axis=1))
    np.testing.assert_allclose(record["position"], position, rtol=0, atol=1e-12)
    assert metrics["max_position_error_m"] < 1e-5
    report = (tmp_path / "report.md").read_text(encoding="utf-8")
    assert "| locked [rad] | iiwa7_joint_3 = 0 |" in report
    assert " | iiwa7_joint_1 iiwa7_joint_2 iiwa7_joint_4 iiwa7_joint_5" in report


def test_a_second_arm_draws_too_and_report_and_figures_tell_its_errors(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    draw_only(monkeypatch, "convergence")
    right = "right_iiwa7_flange"
    assert call([*SHORT, "--robot", "iiwa7_dual", "--frames", right, "--out", str(tmp_path)]) == 0
    record, metrics = results(tmp_path)
    moved = np.ptp(record["frame_position_desired"][:, 0], axis=0)
    np.testing.assert_allclose(moved, np.ptp(record["position_desired"], axis=0), atol=1e-12)
    largest = np.linalg.norm(record["frame_position"] - record["frame_position_desired"], axis=2)
    assert metrics["frames"][right]["max_position_error_m"] == pytest.approx(largest.max())
    assert largest.max() < 1e-5
    report = (tmp_path / "report.md").read_text()
    assert f"| largest position error, {right} | {largest.max():.4g} | m |" in report


@pytest.mark.parametrize(
    ("name", "arguments", "far"),
    [
        ("circle", {"radius": 0.03}, [-0.06, 0.0, 0.0]),
        ("line", {"offset": [0.0, -0.05, 0.02]}, [0.0, -0.05, 0.02]),
        ("lissajous", {"amplitudes": [0.02, 0.01, 0.03]}, [0.0, 0.0, 0.0]),
        ("heart", {"scale": 1e-3}, [0.0, -0.022, 0.0]),
    ],
)
def test_paths(name: str, arguments: dict[str, Any], far: list[float], tmp_path: Path) -> None:
    words = [
        word
        for key, value in arguments.items()
        for word in (f"--{key}", *map(str, value if isinstance(value, list) else [value]))
    ]
    slow = ("--dt", "2e-3", "--duration", "2.5", "--check", "none")
    record, metrics = run(tmp_path, "--reference", name, "--period", "5", *words, *slow)
    expected = {"name": name, "period": 5.0, **arguments}
    assert expected.items() <= metrics["settings"]["reference"].items()
    # Half a period from the start, as each path's own formula has it.
    moved = record["position"][-1] - record["position"][0]
    np.testing.assert_allclose(moved, far, rtol=0, atol=2e-5)
    # The run is repeated from its settings, beside which it is written.
    again = call(["--settings", str(tmp_path / "settings.toml"), "-q"])
    assert again == 0
    np.testing.assert_array_equal(results(tmp_path)[0]["q"], record["q"])


def test_a_path_from_a_csv_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    rows = ["t,x,y,z", "0,0,0,0", "0.1,0.002,0,-0.001", "0.2,0.003,0.001,0"]
    (tmp_path / "path.csv").write_text("\n".join(rows))
    monkeypatch.chdir(tmp_path)
    csv = ["--dt", "1e-3", "--no-plots", "--reference", "path.csv", "--out", "run"]
    assert call(csv) == 0
    record, metrics = results(tmp_path / "run")
    assert metrics["steps"] == 200  # its own duration
    moved = record["position"][[100, -1]] - record["position"][0]
    np.testing.assert_allclose(moved, [[2e-3, 0, -1e-3], [3e-3, 1e-3, 0]], rtol=0, atol=1e-5)
    # From anywhere: the file's path is kept in full.
    monkeypatch.chdir(tmp_path / "run")
    assert call(["--settings", "settings.toml", "-q"]) == 0


# Exit code 1


def test_a_tolerance_that_nothing_meets_names_step_gap_and_solver(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert call([*QUICK, "--tolerance", "1e-18", "--out", str(tmp_path)]) == 1
    record, metrics = results(tmp_path)
    step = int(np.flatnonzero(record["crosscheck_gap"] > 1e-18)[0])
    gap = f"{record['crosscheck_gap'][step]:.3g}"
    output = capsys.readouterr().out
    for text in (output, (tmp_path / "report.md").read_text()):
        (line,) = [line for line in text.splitlines() if "differs by" in line]
        assert f"step {step} " in line
        assert "proxqp" in line
        assert gap in line
    assert metrics["crosscheck"]["disagreements"] == (record["crosscheck_gap"] > 1e-18).sum() > 40


def test_the_reasons_are_told_even_when_quiet(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["--quiet", "--check", "both", "--tolerance", "1e-18", "--out", str(tmp_path)]
    assert call([*QUICK, *arguments]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert "differs by" in captured.err


def test_one_wrong_answer_of_the_network_is_caught(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    class Liar(DNNSolver):
        calls = 0

        def solve(self, qp: QP) -> Solution:
            solution = super().solve(qp)
            Liar.calls += 1
            if Liar.calls != 24:
                return solution
            return solution._replace(point=solution.point + 1e-5)

    monkeypatch.setattr(loop, "DNNSolver", Liar)
    assert call([*QUICK, "--check", "both", "--out", str(tmp_path)]) == 1
    output = capsys.readouterr().out
    assert "step 23 (t = 0.023 s)" in output
    assert "1e-05 rad/s" in output
    record, metrics = results(tmp_path)
    assert np.flatnonzero(record["crosscheck_gap"] > 1e-6).tolist() == [23]
    assert metrics["crosscheck"]["disagreements"] == 1
    assert metrics["crosscheck"]["first_disagreement"]["step"] == 23


def test_a_broken_limit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # The start itself is outside.
    assert call([*QUICK, "--joint-limit", "2.35", "--out", str(tmp_path)]) == 1
    assert "joint position limit broken by 0.007 rad; iiwa7_joint_1" in capsys.readouterr().out
    _, metrics = results(tmp_path)
    assert metrics["position_limit_violation_rad"] == pytest.approx(0.007)


def test_a_step_that_is_not_solved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    # A heart of 3 m: out of the arm's reach.
    far = [*QUICK, "--scale", "0.1", "--duration", "2", "--policy", "stop"]
    assert call([*far, "--out", str(tmp_path)]) == 1
    record, metrics = results(tmp_path)
    steps = len(record["dq"])
    assert steps < 2000
    assert metrics["settings"]["status"].startswith(f"stopped at step {steps - 1} ")
    output = capsys.readouterr().out
    assert f"ended after {steps} of 2,000 steps" in output
    assert "against iiwa7_joint_4 lower velocity limit" in output
    np.testing.assert_array_equal(record["dq"][-1], np.zeros(7))


def test_programs_without_a_solution_are_no_lag(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["--mode", "continuous", "--dt", "1e-3", "--duration", "0.2", "--no-plots"]
    fast = ["--scale", "0.008", "--period", "1"]
    assert call([*words, *fast, "--out", str(tmp_path / "fast")]) == 1
    said = re.match(r"no joint velocity inside .* step (\d+) ", capsys.readouterr().out)
    assert said is not None
    record, metrics = results(tmp_path / "fast")
    assert not record["reference_residual"][int(said[1])] <= 1e-8  # ProxQP finds none either
    assert metrics["settings"]["infeasible_step"] == int(said[1])
    before = record["reference_residual"][: int(said[1])]
    assert (before <= 1e-8).all()  # it is the first one
    assert call([*words, "--out", str(tmp_path / "slow")]) == 0


@pytest.mark.parametrize("policy", ["slow", "relax"])
def test_slow_joints_draw_as_far_as_they_can(policy: str, tmp_path: Path) -> None:
    far = [*QUICK, "--scale", "0.008", "--speed", "0.06", "--duration", "1", "--policy", policy]
    assert call([*far, "--out", str(tmp_path)]) == 1
    record, metrics = results(tmp_path)
    assert metrics["settings"]["status"] == "completed"
    assert len(record["dq"]) == 1000
    limits = 0.06 * np.deg2rad([98, 98, 100, 130, 140, 180, 180])
    assert (np.abs(record["dq"]) <= limits + 1e-12).all()
    assert metrics["incidents"][f"{policy}_steps"] > 300
    assert metrics["incidents"]["blocking"][0]["joint"] == 4
    report = (tmp_path / "report.md").read_text()
    assert "iiwa7_joint_4 lower velocity limit" in report
    if policy == "slow":  # exactly along the path, later
        assert metrics["max_position_error_m"] < 1e-4
        assert metrics["incidents"]["path_time_s"] < 0.9
    else:  # in time, beside the path
        assert metrics["max_position_error_m"] > 1e-3
        assert metrics["incidents"]["path_time_s"] == pytest.approx(1.0)


# Exit code 2


# What robots, paths, schemes and the simulation refuse is tested in their own rooms.


def bad_csv(folder: Path) -> list[str]:
    (folder / "path.csv").write_text("x,y,z\n0,0,0\n")
    return ["--reference", str(folder / "path.csv")]


def not_xml(folder: Path) -> list[str]:
    (folder / "robot.urdf").write_text("solid robot\n")
    return ["--robot", str(folder / "robot.urdf")]


def below_a_file(folder: Path) -> list[str]:
    (folder / "file").write_text("in the way")
    return ["--out", str(folder / "file" / "run")]


def a_file(folder: Path) -> list[str]:
    (folder / "file").write_text("in the way")
    return ["--out", str(folder / "file")]


BAD: dict[str, tuple[list[str] | Callable[[Path], list[str]], str]] = {
    "unknown robot": (["--robot", "iiwa14"], "'iiwa14'; did you mean: iiwa7"),
    "missing file": (["--robot", "none/robot.urdf"], "none/robot.urdf"),
    "not XML": (not_xml, "not XML"),
    "unknown frame": (["--tip", "iiwa7_link_77"], "'iiwa7_link_77'; did you mean: iiwa7_link_7"),
    "q0 NaN": (["--q0", "nan", *"000000"], "--q0"),
    "q0 outside": (["--q0", "18", *"000000"], "--q0: must be within"),
    "q0 too short": (["--q0", "0", "0"], "--q0: must have shape (7,)"),
    "dt NaN": (["--dt", "nan"], "dt"),
    "duration for more steps than memory": (["--duration", "1e12"], "duration"),
    "weight above 1": (["--weight", "1.5"], "weight"),
    "noise negative, in powers of ten": (["--noise", "-1e-2"], "noise"),
    "joint limit a word": (["--joint-limit", "abc"], "--joint-limit"),
    "joint limit 0": (["--joint-limit", "0"], "--joint-limit"),
    "joint limit NaN": (["--joint-limit", "nan"], "--joint-limit"),
    "speed 0": (["--speed", "0"], "speed"),
    "unknown policy": (["--policy", "hope"], "'hope'"),
    "acceleration limit a word": (["--acceleration-limit", "fast"], "above 0 or 'robot'"),
    "jerk limit negative": (["--jerk-limit=-1"], "above 0 or 'robot'"),
    "no jerk limit of the robot": (["--jerk-limit", "robot"], "no dddq_max"),
    "idle noise entry": (["--noise-at", "network"], "--noise-at: has no effect but beside --noise"),
    "idle next gain": (["--next-gain", "5"], "--next-gain: has no effect but beside --tracking n"),
    "idle gain": (["--tracking", "next", "--gain", "5"], "--gain: has no effect but"),
    "idle tolerance": (["--check", "none", "--tolerance", "1"], "--tolerance: has no effect but"),
    "continuous and RK4": (["--mode", "continuous", "--motion", "rk4"], "continuous"),
    "unknown path": (["--reference", "hart"], "no path 'hart'; did you mean: heart"),
    "no file of points": (["--reference", "none.csv"], "none.csv: No such file"),
    "a bad file of points": (bad_csv, "the header must be t,x,y,z"),
    "another path's option": (["--radius", "0.1"], "--radius: is no option of the path 'heart'"),
    "out below a file": (below_a_file, "file"),
    "out a file": (a_file, "file"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_input_exits_2_with_one_clear_line_and_leaves_nothing(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    bad, said = BAD[case]
    arguments = bad(tmp_path) if callable(bad) else bad
    before = {path: path.read_bytes() for path in tmp_path.rglob("*")}
    assert call(["--out", str(tmp_path / "new" / "run"), *QUICK, *arguments]) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.count("\n") == 1
    assert captured.err.startswith("track_heart: error: ")
    assert captured.err.endswith("\n")
    assert said in captured.err
    assert "Traceback" not in captured.err
    assert {path: path.read_bytes() for path in tmp_path.rglob("*")} == before


@pytest.mark.parametrize("case", ["weight above 1", "dt NaN", "unknown robot"])
def test_bad_input_leaves_earlier_results_alone(case: str, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    (bad, _) = BAD[case]
    run(folder)
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert call([*QUICK, *(bad(tmp_path) if callable(bad) else bad), "--out", str(folder)]) == 2
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EIO])
def test_a_full_or_broken_disk_is_one_line_and_keeps_the_old_run(
    code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    run(tmp_path)
    capsys.readouterr()
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def fail(descriptor: int) -> None:
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(os, "fsync", fail)  # where the system tells of it at the latest
    assert call([*QUICK, "--seed", "1", "--overwrite", "--out", str(tmp_path)]) == 2
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert os.strerror(code) in captured.err
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_a_file_that_the_system_cuts_off(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # No mock: the process may write no file above 4 kB, the record is larger.
    run(tmp_path, "--check", "none")
    capsys.readouterr()
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, hard))
    try:
        code = call([*QUICK, "--check", "none", "--out", str(tmp_path)])
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert code == 2
    said = f"track_heart: error: {tmp_path}/record.npz: cannot be written (File too large)\n"
    assert capsys.readouterr().err == said
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.parametrize("name", ["two\nlines", "nul\0"])
def test_an_out_folder_with_a_strange_name_makes_one_line_too(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("in the way")
    assert call([*QUICK, "--out", f"{tmp_path}/file/{name}"]) == 2
    assert capsys.readouterr().err.count("\n") == 1


# The script itself


def test_the_script_from_anywhere_and_as_in_this_process(tmp_path: Path) -> None:
    # That figures are drawn in a process without a display is shown by tests/results/test_plots.py.
    arguments = [*QUICK, "--check", "osqp", "--noise", "0.01"]
    done = subprocess.run(
        [sys.executable, str(SCRIPT), *arguments, "--out", "here"],
        cwd=tmp_path,
        env=os.environ | {"TERM": "xterm-256color"},
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
    )
    # No terminal, no progress bar; and any warning would be on standard error.
    assert (done.returncode, done.stderr) == (0, "")
    assert "verdict" in done.stdout
    assert "\x1b" not in done.stdout  # piped, so without colour
    call([*arguments, "--quiet", "--out", str(tmp_path / "there")])
    # The same seed gives the same record, bit for bit, in another process too.
    here, there = (tmp_path / name / "record.npz" for name in ("here", "there"))
    assert here.read_bytes() == there.read_bytes()


# Paths that turn


@pytest.mark.parametrize("name", ["cone", "tilting-circle"])
def test_a_path_that_turns_is_drawn_and_its_orientation_error_shown(
    name: str, tmp_path: Path
) -> None:
    out = tmp_path / "run"
    arguments = ["--reference", name, "--duration", "0.02", "--dt", "1e-3", "--no-plots", "-q"]
    assert call([*arguments, "--tracking", "next", "--out", str(out)]) == 0
    metrics = json.loads((out / "metrics.json").read_text())
    assert 0.0 <= metrics["max_orientation_error_rad"] < 1e-6
    record = Record.load(out / "record.npz")
    assert np.ptp(record.rotation_desired, axis=0).max() > 1e-9


def test_poses_of_a_file_are_where_they_are_and_a_start_elsewhere_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    start = Configuration(load_robot("iiwa7"), PAPER_Q0)
    x, y, z, w = pin.Quaternion(start.rotation).coeffs()
    place = start.position
    for shift in (0.0, 0.02):
        rows = [[*(place + [shift + step, 0.0, 0.0]), w, x, y, z] for step in (0.0, 0.01)]
        text = "\n".join(",".join(map(repr, map(float, row))) for row in rows)
        (tmp_path / "poses.csv").write_text(f"x,y,z,qw,qx,qy,qz\n{text}\n")
        out = tmp_path / f"run{shift}"
        arguments = ["--reference", str(tmp_path / "poses.csv"), "--tool-speed", "0.01"]
        call([*arguments, "--duration", "0.01", "--dt", "1e-3", "--no-plots", "--out", str(out)])
        told = capsys.readouterr().err
        assert ("m, 0.02 m from the tip: the arm goes there first" in told) == (shift > 0.0)
        assert ("run again with --overwrite --q0" in told) == (shift > 0.0)
        desired = Record.load(out / "record.npz").position_desired[0]
        np.testing.assert_allclose(desired, place + [shift, 0.0, 0.0], rtol=0, atol=1e-15)
    # Begun where it says, the run has nothing to say, and begins there.
    posture = told.split("--q0 ")[1].split("\n")[0].split()
    out = tmp_path / "there"
    more = ["--duration", "0.01", "--dt", "1e-3", "--no-plots", "--out", str(out)]
    assert call([*arguments, "--q0", *posture, *more]) == 0
    assert "begins" not in capsys.readouterr().err
    record = Record.load(out / "record.npz")
    np.testing.assert_allclose(record.position[0], desired, rtol=0, atol=2e-6)


# What goes wrong for somebody new


def test_a_file_with_several_ends_is_drawn_with_and_exported_by_its_tip(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = IIWA7.read_text(encoding="utf-8").replace(
        "</robot>",
        '<link name="probe"/><joint name="probe_mount" type="fixed">'
        '<parent link="iiwa7_link_6"/><child link="probe"/></joint></robot>',
    )
    file = tmp_path / "iiwa7.urdf"
    file.write_text(text, encoding="utf-8")
    words = ["--robot", str(file), "--out", str(tmp_path / "run")]
    assert call([*QUICK, *words]) == 2
    assert "several ends" in capsys.readouterr().err
    assert call([*QUICK, *words, "--tip", "iiwa7_flange"]) == 0
    assert "verdict" in capsys.readouterr().out
    words = ["--robot", str(file), "--tip", "iiwa7_flange", "--out", str(tmp_path / "c")]
    assert run_command("export", [*words, "--dt", "1e-3"]) == 0


def test_a_reader_that_has_read_enough_ends_the_command_quietly(tmp_path: Path) -> None:
    script = f"import sys; from iiwa_dnn.app.main import main; sys.exit(main({['track', *QUICK]}))"
    reader, writer = os.pipe()
    os.close(reader)  # as `head` does after its lines
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=tmp_path, stdout=writer, stderr=subprocess.PIPE
    )
    os.close(writer)
    assert (done.returncode, done.stderr) == (141, b"")
    assert (tmp_path / "runs" / "heart" / "metrics.json").exists()


def test_too_few_joints_for_a_pose_are_said_once_before_the_run(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [*QUICK, "--lock", "iiwa7_joint_3", "iiwa7_joint_5", "--scale", "1e-3"]
    assert call([*words, "--out", str(tmp_path / "pose")]) == 1
    said = capsys.readouterr().err
    assert said.count("5 joints cannot hold a pose") == 1
    assert "--orientation none" in said
    assert call([*words, "--orientation", "none", "--out", str(tmp_path / "position")]) == 0
    assert "cannot" not in capsys.readouterr().err
