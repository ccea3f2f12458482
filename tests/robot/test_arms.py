"""Arms by name: the chain, its gripper, and the heart drawn with it, whatever its redundancy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from helpers_kinematics import example_urdf
from iiwa_dnn import (
    Configuration,
    DoubleIndicator,
    Heart,
    MissingDependencyError,
    compute_metrics,
    failures,
    load_robot,
    simulate,
)
from iiwa_dnn.robot import arms
from iiwa_dnn.robot.arms import ARMS

JOINTS = {"panda": 7, "talos_left_arm": 6, "ur5": 6, "xarm7": 7}


@pytest.fixture(autouse=True)
def installed() -> None:
    example_urdf("panda_description/urdf/panda.urdf")


@pytest.mark.parametrize("name", ARMS)
def test_an_arm_by_its_name_is_the_file_without_the_gripper(name: str) -> None:
    robot, arm = load_robot(name), ARMS[name]
    assert (robot.name, robot.dof, robot.tip) == (name, JOINTS[name], arm.tip)
    assert robot.locked == arm.locked
    # By its file, everything said by hand.
    by_hand = load_robot(example_urdf(arm.file), tip=arm.tip, locked=arm.locked)
    q = np.array(arm.start)
    for one, other in (
        (robot.limits, by_hand.limits),
        (Configuration(robot, q).pose, Configuration(by_hand, q).pose),
    ):
        np.testing.assert_array_equal(one, other)
    # The start is inside the limits and not singular: all six directions of the tip can be moved.
    assert (q > robot.q_lower).all()
    assert (q < robot.q_upper).all()
    assert np.linalg.svd(Configuration(robot, q).jacobian, compute_uv=False)[5] > 0.02


def test_locked_and_tip_can_be_chosen_besides() -> None:
    robot = load_robot("panda", tip="panda_link8", locked=("panda_joint3",))
    assert (robot.dof, robot.tip) == (6, "panda_link8")
    assert robot.locked == (*ARMS["panda"].locked, "panda_joint3")


@pytest.mark.parametrize("orientation", ["so3", "none"])
@pytest.mark.parametrize("name", ARMS)
def test_the_heart_with_redundancy_zero_one_three_and_four(name: str, orientation: str) -> None:
    robot, q0 = load_robot(name), ARMS[name].start
    reference = Heart().anchored(Configuration(robot, q0))
    scheme = DoubleIndicator(orientation=orientation)
    record = simulate(robot, scheme, reference, q0, dt=1e-2)
    assert failures(record) == []
    metrics = compute_metrics(record)
    assert metrics["crosscheck"]["steps_checked"] == 1000
    # Euler's error is of first order: a hundred times that of 1e-4 s, which is 3.4e-7 m.
    assert metrics["max_position_error_m"] < 1e-4
    assert (metrics["max_orientation_error_rad"] < 1e-3) == (orientation == "so3")
    # Pinocchio's own forward kinematics of the whole robot ends where the record says.
    full = pin.buildModelFromUrdf(str(example_urdf(ARMS[name].file)))
    data, q = full.createData(), pin.neutral(full)
    q[[full.joints[full.getJointId(joint)].idx_q for joint in robot.joint_names]] = record.q[-1]
    pin.framesForwardKinematics(full, data, q)
    tip = data.oMf[full.getFrameId(robot.tip, pin.FrameType.BODY)].translation
    np.testing.assert_allclose(record.position[-1], tip, atol=1e-12)


def test_without_the_package_one_line_says_what_to_install(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def missing(name: str) -> None:
        raise arms.PackageNotFoundError(name)

    monkeypatch.setattr(arms, "distribution", missing)
    with pytest.raises(MissingDependencyError, match=r"pip install 'iiwa-dnn\[robots\]'"):
        load_robot("panda")
