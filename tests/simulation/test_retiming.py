"""Retimed paths: limits by finite differences, the closed form of a line, and the file."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import paper_robot, paper_start
from iiwa_dnn import Record, Trajectory, retime, simulate
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Heart
from iiwa_dnn.schemes import DoubleIndicator

ACCELERATION = np.array([8.65, 5.44, 5.69, 11.01, 11.78, 13.76, 13.17])


def heart(duration: float | None = None) -> Record:
    return simulate(
        paper_robot(), DoubleIndicator(tracking="next"), Heart().anchored(paper_start()), PAPER_Q0,
        dt=5e-3, duration=duration, check=CrossCheck(()),
    )  # fmt: skip


def along_a_line(record: Record, way: float) -> Record:
    """The record with joint 1 alone moving, to and fro along a smooth time law."""
    q = np.zeros_like(record.q)
    q[:, 0] = way * np.sin(0.5 * np.pi * record.t / record.t[-1]) ** 2
    return dataclasses.replace(record, q=q)


def test_the_limits_hold_by_finite_differences_and_the_path_stays() -> None:
    record = heart()
    timed = retime(record, ACCELERATION)
    assert timed.t[-1] < 0.13 * record.t[-1]
    h = np.diff(timed.t)[:, None]
    speed = np.diff(timed.q, axis=0) / h
    fastest = np.array(record.settings["dq_max"])
    assert (np.abs(speed) <= fastest * (1 + 1e-9)).all()
    jumps = np.diff(timed.dq, axis=0) / h
    assert (np.abs(jumps) <= ACCELERATION * (1 + 1e-6)).all()
    assert np.abs(timed.ddq / ACCELERATION).max() > 0.99  # somewhere a limit is reached
    np.testing.assert_allclose(timed.q[[0, -1]], record.q[[0, -1]], rtol=0, atol=1e-9)
    assert not timed.dq[[0, -1]].any()
    # In the plane of two joints, each sample lies on the record's polygon.
    gaps = timed.q[::20, None] - record.q[None]
    along = np.diff(record.q, axis=0)
    nearest = np.linalg.norm(gaps, axis=2).min(axis=1)
    assert nearest.max() < np.linalg.norm(along, axis=1).max()


@pytest.mark.parametrize(("way", "time"), [(0.5, 2 * np.sqrt(0.5 / 2.0)), (2.0, 1.0 / 2.0 + 2.0)])
def test_one_joint_takes_the_time_of_the_textbook(way: float, time: float) -> None:
    # Limits 1 rad/s and 2 rad/s^2: a triangle of velocity, and a trapezium.
    timed = retime(along_a_line(heart(0.5), way), 2.0, 1.0)
    assert time <= timed.t[-1] < 1.01 * time + 2e-3


def test_a_reference_is_followed_first() -> None:
    start = paper_start()
    timed = retime(Heart().anchored(start), ACCELERATION, robot=paper_robot(), q0=PAPER_Q0, dt=0.01)
    np.testing.assert_allclose(timed.q[0], PAPER_Q0, rtol=0, atol=1e-12)
    assert timed.t[-1] < 1.3
    with pytest.raises(InvalidInputError, match=r"^robot"):
        retime(Heart(), ACCELERATION)


@pytest.mark.parametrize(
    ("change", "argument"),
    [
        ({"acceleration": 0.0}, "acceleration"),
        ({"acceleration": np.inf}, "acceleration"),
        ({"velocity": -1.0}, "velocity"),
        ({"dt": 0.0}, "dt"),
        ({"points": 3}, "points"),
    ],
)
def test_a_bad_argument_is_named(change: dict[str, Any], argument: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{argument}"):
        retime(along_a_line(heart(0.1), 1.0), **{"acceleration": 1.0, "velocity": 1.0} | change)


def test_an_arm_that_stands_still_has_no_path() -> None:
    record = heart(0.1)
    with pytest.raises(InvalidInputError, match="does not move"):
        retime(dataclasses.replace(record, q=np.zeros_like(record.q)), ACCELERATION)


def test_the_file_holds_every_digit(tmp_path: Path) -> None:
    timed = retime(along_a_line(heart(0.1), 1.0), 2.0, 1.0, dt=0.05)
    timed.save(tmp_path / "path.csv")
    back = Trajectory.load(tmp_path / "path.csv")
    for name in ("t", "q", "dq", "ddq"):
        np.testing.assert_array_equal(getattr(back, name), getattr(timed, name))
    first = (tmp_path / "path.csv").read_text().splitlines()[0].split(",")
    assert first[:3] == ["t", "q1", "q2"]
    assert len(first) == 22


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("", "not a trajectory"),
        ("t,q1\n0,0\n", "header"),
        ("t,q1,dq1,ddq1\n0,0,0,0\n1,x,0,0\n", "could not convert"),
        ("t,q1,dq1,ddq1\n0,0,0,0\n1,1,0,0\n", "not the rate"),
        ("t,q1,dq1,ddq1\n0,0,0,0\n0,0,0,0\n", "increasing"),
        ("t,q1,dq1,ddq1\n0,0,0,0\n1,nan,0,0\n", "finite"),
    ],
)
def test_a_bad_file_is_told(text: str, problem: str, tmp_path: Path) -> None:
    (tmp_path / "path.csv").write_text(text)
    with pytest.raises(FileError, match=problem):
        Trajectory.load(tmp_path / "path.csv")
    with pytest.raises(FileError):
        Trajectory.load(tmp_path / "none.csv")
