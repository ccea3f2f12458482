"""robots/iiwa7/iiwa7.urdf against facts typed in here a second time and other implementations."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.robot.arms import TIPS
from iiwa_dnn.robot.loading import robots_folder


@pytest.fixture(scope="module")
def robot() -> Robot:
    return load_robot("iiwa7")


def test_check_pose(robot: Robot) -> None:
    conf = Configuration(robot, PAPER_Q0)
    rotation = [
        [0.685264, 0.717982, 0.122129],
        [0.702680, -0.695883, 0.148283],
        [0.191452, -0.015795, -0.981375],
    ]
    np.testing.assert_allclose(conf.position, [0.373145, 0.388717, 0.301206], rtol=0, atol=5.1e-7)
    np.testing.assert_allclose(conf.rotation, rotation, rtol=0, atol=5.1e-7)
    assert np.degrees(np.arccos(-conf.rotation[2, 2])) == pytest.approx(11.08, abs=0.005)


def test_limits_are_the_data_sheets(robot: Robot) -> None:
    position = np.radians([170, 120, 170, 120, 170, 120, 175])
    np.testing.assert_array_equal(robot.q_upper, position)
    np.testing.assert_array_equal(robot.q_lower, -position)
    np.testing.assert_array_equal(robot.dq_max, np.radians([98, 98, 100, 130, 140, 180, 180]))
    np.testing.assert_array_equal(robot.model.effortLimit, [176, 176, 110, 110, 110, 40, 40])


def test_robots_of_the_package_need_no_file_of_another_package() -> None:
    assert {path.stem for path in robots_folder().glob("*/*.urdf")} == set(TIPS)
    for name in TIPS:
        root = ET.fromstring(load_robot(name).urdf)
        assert root.get("name") == name
        assert root.findall(".//visual")
        assert root.findall(".//collision")
        assert not root.findall(".//mesh")
