"""The arm stretched by a path beyond its reach: a singular pose."""

from typing import Any

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_simulation import UNCHECKED, paper_robot
from iiwa_dnn.step.policies import ProgramKind


def vertical_start() -> d.Configuration:
    """A bent arm whose tool points straight down."""
    # In the arm's own plane, joints 2, 4 and 6 turn the tool by q2 - q4 + q6.
    return d.Configuration(paper_robot(), [0.3, 0.5, 0.0, -1.6, 0.0, np.pi - 2.1, 0.2])


def stretched_run(policy: Any, dt: float) -> d.Record:
    """Follow a line of 4 s, 0.3 m beyond the outstretched arm and back, in steps of dt [s]."""
    start = vertical_start()
    outward = start.position * [1.0, 1.0, 0.0]
    line = d.Line(offset=(1.1 / np.linalg.norm(outward) - 1.0) * outward, period=4.0)
    options: Any = {"dt": dt, "duration": 4.0, "policy": policy, "check": UNCHECKED}
    scheme = d.DoubleIndicator(orientation="none")
    record = d.simulate(paper_robot(), scheme, line.anchored(start), start.q, **options)
    # Changes of the velocities in a second: shaking at every step would make 1e3 and more.
    assert np.abs(np.diff(record.dq, axis=0)).sum() / record.t[-1] < 50.0
    return record


@pytest.mark.parametrize("dt", [2e-3, 1e-2])
def test_an_arm_pulled_beyond_its_reach_stretches_and_comes_back(dt: float) -> None:
    record = stretched_run("relax", dt)
    robot = paper_robot()
    least = min(
        np.linalg.svd(d.Configuration(robot, q).jacobian[:3], compute_uv=False)[-1]
        for q in record.q[:: max(1, round(0.01 / dt))]
    )
    assert least < 0.05  # it was stretched
    assert (np.abs(record.dq) <= robot.dq_max + 1e-12).all()
    error = np.linalg.norm(record.position - record.position_desired, axis=1)
    assert error.max() > 0.05  # out of reach
    assert error[-1] < 1e-3  # and back


@pytest.mark.parametrize("dt", [2e-3, 1e-2])
def test_the_slow_policy_keeps_to_the_path_up_to_the_singular_pose(dt: float) -> None:
    record = stretched_run("slow", dt)
    creeps = int(np.flatnonzero(record.kind == ProgramKind.RELAXED)[0])
    assert record.fraction[:creeps].min() >= 0.1
    assert np.abs(record.dq[-1]).max() < 0.1
    error = np.linalg.norm(record.position - record.position_desired, axis=1)
    assert error[: creeps + 1].max() < 2e-3
