"""Singular poses: the tool vertical, where the block sees no tilt, and the arm stretched."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import rotation_angle
from helpers_simulation import paper_robot
from iiwa_dnn.references import Target
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.studies.singular import stretched_run, tilted_run, vertical_start


def tilt(record: Record) -> np.ndarray:
    return rotation_angle(record.rotation, record.rotation_desired)


def test_the_start_has_its_tool_vertical() -> None:
    conf = vertical_start()
    assert conf.rotation[2, 2] == pytest.approx(-1.0, abs=1e-12)
    target = conf  # any target at rest here: its rows are what is looked at
    ranks = {}
    for form in ("so3", "block"):
        scheme = DoubleIndicator(orientation=form)
        qp = scheme.build_qp(conf, Target(target.position, target.rotation))
        ranks[form] = int(np.linalg.matrix_rank(qp.A[3:], tol=1e-9))
    assert ranks == {"so3": 3, "block": 1}


def test_the_block_sees_a_tilt_at_second_order_only() -> None:
    # Settled, so3 takes the tilt back at the rate nu, the block, which sees half its square, at
    # nu / 2. At the paper's own pace the block's weak rows lag further behind.
    left = {
        (form, mode): tilt(tilted_run(form, mode))[-1] / 0.05
        for form in ("so3", "block")
        for mode in ("converged", "continuous")
    }
    assert left["so3", "converged"] == pytest.approx(np.exp(-5.1), rel=0.02)
    assert left["block", "converged"] == pytest.approx(np.exp(-2.55), rel=0.02)
    assert left["so3", "continuous"] == pytest.approx(np.exp(-5.1), rel=0.2)
    assert left["block", "continuous"] > 1.5 * left["block", "converged"]


@pytest.mark.parametrize("dt", [1e-3, 1e-2])
def test_an_arm_pulled_beyond_its_reach_stretches_and_comes_back(dt: float) -> None:
    record = stretched_run("relax", dt)
    robot = paper_robot()
    least = min(
        np.linalg.svd(Configuration(robot, q).jacobian[:3], compute_uv=False)[-1]
        for q in record.q[:: max(1, round(0.01 / dt))]
    )
    assert least < 0.05  # it was stretched
    assert (np.abs(record.dq) <= robot.dq_max + 1e-12).all()
    error = np.linalg.norm(record.position - record.position_desired, axis=1)
    assert error.max() > 0.05  # out of reach
    assert error[-1] < 1e-3  # and back
    # Changes of the velocities in a second: shaking at every step would make 1e3 and more.
    assert np.abs(np.diff(record.dq, axis=0)).sum() / record.t[-1] < 50.0


@pytest.mark.parametrize("dt", [1e-3, 1e-2])
def test_the_slow_policy_comes_to_rest_before_the_singular_pose(dt: float) -> None:
    record = stretched_run("slow", dt)
    assert record.fraction is not None
    assert record.fraction[-1] < 0.01
    assert np.abs(record.dq[-1]).max() < 0.1
    assert np.linalg.norm(record.position - record.position_desired, axis=1).max() < 2e-3
    # Changes of the velocities in a second: shaking at every step would make 1e3 and more.
    assert np.abs(np.diff(record.dq, axis=0)).sum() / record.t[-1] < 50.0
