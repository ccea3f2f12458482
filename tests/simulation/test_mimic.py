"""Joints that follow others, beside Pinocchio's own mimic joints."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from iiwa_dnn import Circle, Configuration, DoubleIndicator, InvalidInputError, load_robot, simulate
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


def test_a_follower_of_a_locked_joint_is_refused(file: Path) -> None:
    with pytest.raises(InvalidInputError, match=f"'{FOURTH}' follows '{SECOND}' .*lock it too"):
        load_robot(file, locked=[SECOND])
    assert load_robot(file, locked=[SECOND, FOURTH]).mimics == ()
