"""Joints that follow others, beside Pinocchio's own mimic joints."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from iiwa_dnn import (
    AccelerationLimits,
    Circle,
    Configuration,
    Controller,
    DoubleIndicator,
    InvalidInputError,
    Target,
    load_robot,
    simulate,
    solve_pose,
)
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics

SECOND, FOURTH = "iiwa7_joint_2", "iiwa7_joint_4"
MIMIC = f'<mimic joint="{SECOND}" multiplier="-0.5" offset="0.1"/>'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """The iiwa 7, its fourth joint made to follow the second."""
    text = (Path(__file__).parents[2] / "robots" / "iiwa7" / "iiwa7.urdf").read_text()
    head = f'<joint name="{FOURTH}" type="revolute">'
    assert text.count(head) == 1
    path = tmp_path / "arm.urdf"
    path.write_text(text.replace(head, head + MIMIC))
    return path


def test_the_coupling_holds_over_a_run_and_pinocchios_own_mimic_is_where_the_tip_is(
    file: Path,
) -> None:
    robot = load_robot(file)
    assert robot.mimics == ((FOURTH, SECOND, -0.5, 0.1),)
    q0 = robot.start_posture()
    assert q0[3] == pytest.approx(-0.5 * q0[1] + 0.1, abs=1e-15)
    circle = Circle(radius=0.02, period=2.0).anchored(Configuration(robot, q0))
    scheme = DoubleIndicator(orientation="none")
    record = simulate(robot, scheme, circle, q0, dt=1e-3, duration=2.0)
    assert failures(record) == []
    assert compute_metrics(record)["max_position_error_m"] < 1e-4
    assert np.ptp(record.q[:, 1]) > 1e-3
    np.testing.assert_allclose(record.q[:, 3], -0.5 * record.q[:, 1] + 0.1, rtol=0, atol=1e-9)
    # Pinocchio's own: six coordinates, the seventh joint follows.
    other = pin.buildModelFromXML(file.read_text(), mimic=True)
    assert other.nq == 6
    data, tip = other.createData(), other.getFrameId(robot.tip)
    for k in (0, 700, 2000):
        pin.framesForwardKinematics(other, data, np.delete(record.q[k], 3))
        np.testing.assert_allclose(data.oMf[tip].translation, record.position[k], rtol=0, atol=1e-8)


@pytest.mark.parametrize("policy", ["slow", "relax"])
@pytest.mark.parametrize("limited", [False, True])
def test_a_task_that_yields_does_not_pull_the_linkage_apart(
    file: Path, policy: Any, limited: bool
) -> None:
    # With `relax`, or acceleration limits, it was commanded apart by up to 0.45 rad.
    robot = load_robot(file)
    limits = (AccelerationLimits(10.0),) if limited else ()
    start = Configuration(robot, robot.start_posture())
    scheme = DoubleIndicator(orientation="none", extra_limits=limits)
    controller = Controller(robot, scheme, policy=policy)
    q = start.q
    apart = []
    for k in range(1000):
        side = 0.5 if k % 500 < 250 else -0.3
        target = Target(start.position + [0.1, side, side], start.rotation)
        command = controller.step(q, 1e-3 * k, target)
        q = q + 1e-3 * command.dq
        apart.append(abs(q[3] + 0.5 * q[1] - 0.1))
    assert max(apart) < 1e-6


def test_a_follower_of_a_locked_joint_is_refused(file: Path) -> None:
    with pytest.raises(InvalidInputError, match=f"'{FOURTH}' follows '{SECOND}', .*lock it too"):
        load_robot(file, locked=[SECOND])
    assert load_robot(file, locked=[SECOND, FOURTH]).mimics == ()


def test_a_posture_for_a_pose_keeps_the_coupling(file: Path) -> None:
    robot = load_robot(file)
    q = robot.draw(np.random.default_rng(0), 1)[0]
    conf = Configuration(robot, q)
    answer = solve_pose(robot, Target(conf.position, conf.rotation))
    assert answer.q is not None
    assert answer.position_error <= 1e-9
    assert answer.q[3] == pytest.approx(-0.5 * answer.q[1] + 0.1, abs=1e-9)
