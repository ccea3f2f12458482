"""The second reader agrees on every robot here, and each kind of difference is named."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from helpers_kinematics import example_urdf
from iiwa_dnn.errors import FileError, InvalidInputError
from iiwa_dnn.robot import Robot, load_robot
from iiwa_dnn.robot.arms import ARMS
from iiwa_dnn.robot.verification import verify_robot

URDF = """<robot name="r"><link name="a"/><link name="b"/><link name="c"/>
<joint name="turn" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 3"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
<joint name="slide" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 AXIS"/>
<limit effort="1" velocity="0"/></joint></robot>"""


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("iiwa7")


@pytest.mark.parametrize("name", ["iiwa7", *ARMS])
def test_the_readers_agree_on_every_arm(name: str) -> None:
    if name in ARMS:
        example_urdf(ARMS[name].file)
    locked = ("panda_joint4",) if name == "panda" else ()  # not at zero
    assert load_robot(name, locked=locked, verify=True).name == name


def test_the_readers_agree_on_a_free_joint_that_follows_another() -> None:
    path = example_urdf("panda_description/urdf/panda.urdf")
    assert load_robot(path, tip="panda_hand_tcp", verify=True).dof == 9


def test_the_readers_agree_where_continuous_joints_are_locked() -> None:
    path = example_urdf("kinova_description/robots/kinova.urdf")
    locked = [f"j2s6s200_joint_{i}" for i in (1, 4, 6)]
    assert load_robot(path, "j2s6s200_end_effector", locked, verify=True).dof == 3


def test_a_file_that_the_readers_take_differently(tmp_path: Path) -> None:
    # Pinocchio makes an axis of a slide a unit vector, yourdfpy takes its length into account.
    path = tmp_path / "r.urdf"
    path.write_text(URDF.replace("AXIS", "1"))
    assert load_robot(path, verify=True).dof == 2
    path.write_text(URDF.replace("AXIS", "2"))
    assert load_robot(path).dof == 2
    with pytest.raises(FileError, match="yourdfpy differ: frame 'c' by") as caught:
        load_robot(path, verify=True)
    assert caught.value.path == str(path)


def renamed(robot: Robot) -> pin.Model:
    model = robot.model.copy()
    model.names[2], model.names[3] = model.names[3], model.names[2]
    return model


def moved(robot: Robot) -> pin.Model:
    model = robot.model.copy()
    model.jointPlacements[4] = model.jointPlacements[4] * pin.SE3(
        np.eye(3), np.array([0.0, 1e-8, 0.0])
    )
    return model


def stronger(robot: Robot) -> pin.Model:
    model = robot.model.copy()
    model.effortLimit[2] += 1.0
    return model


@pytest.mark.parametrize(
    ("change", "difference"),
    [
        (lambda r: r.with_limits(upper=[2, *r.q_upper[1:]]), "joint 'iiwa7_joint_1': upper limit"),
        (lambda r: r.with_limits(lower=-1), "joint 'iiwa7_joint_1': lower limit -1 or -2.96706"),
        (lambda r: r.with_limits(velocity=9), "joint 'iiwa7_joint_1': velocity limit 9 or 1.71"),
        (lambda r: dataclasses.replace(r, model=stronger(r)), "'iiwa7_joint_3': effort limit"),
        (lambda r: dataclasses.replace(r, model=renamed(r)), "hangs on iiwa7_joint_1 or on"),
        (lambda r: dataclasses.replace(r, model=moved(r)), "frame 'iiwa7_link_4' by"),
        (
            lambda r: dataclasses.replace(r, locked=("iiwa7_joint_7",), q_locked=(0.0,)),
            "joint 'iiwa7_joint_7' moves for one of them only",
        ),
    ],
)
def test_each_difference_is_named(robot: Robot, change, difference: str) -> None:
    with pytest.raises(FileError, match=difference):
        verify_robot(change(robot))


def test_what_cannot_be_compared(robot: Robot) -> None:
    with pytest.raises(InvalidInputError, match="must come from a URDF file"):
        verify_robot(dataclasses.replace(robot, path=None))
    with pytest.raises(FileError, match="yourdfpy cannot read it"):
        verify_robot(dataclasses.replace(robot, urdf="<robot>"))
