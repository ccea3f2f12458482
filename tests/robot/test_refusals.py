"""Arguments of robots that are refused by name, one line each."""

from typing import Any

import numpy as np
import pinocchio as pin
import pytest

import iiwa_dnn as d
from iiwa_dnn.robot.obstacles import make_obstacles

ROBOT = d.load_robot("iiwa7")
ODD = (np.nan, np.inf, True, "a", 1j, 10**400)
BALL = {"shape": "sphere", "center": [0.0, 0.0, 1.0], "radius": 0.1}

POSES = ([0, 0, 1], [np.nan] * 6, "pen", np.eye(3), pin.SE3(np.eye(3), np.array([0, 0, np.nan])))

REFUSED = [
    *[
        (d.Configuration, {"robot": ROBOT, "q": q}, "q")
        for q in (np.zeros(6), np.zeros((7, 1)), 0.0, None, *([0] * 6 + [x] for x in ODD))
    ],
    (d.Configuration, {"robot": ROBOT, "q": np.zeros(7, np.complex64)}, "q"),
    (ROBOT.with_limits, {"lower": 3.0}, "lower"),
    (ROBOT.with_limits, {"lower": np.nan}, "lower"),
    (ROBOT.with_limits, {"upper": -3.0}, "lower"),
    (ROBOT.with_limits, {"upper": [1.0, 2.0]}, "upper"),
    *[(ROBOT.with_limits, {"velocity": v}, "velocity") for v in (True, [1, 1, 1, -1, 1, 1, 1])],
    (ROBOT.with_limits, {"acceleration": np.nan}, "acceleration"),
    (ROBOT.with_limits, {"jerk": -1.0}, "jerk"),
    *[(ROBOT.with_tool, {"tool": t}, "tool") for t in POSES],
    (d.load_robot, {"source": "iiwa7", "locked": ROBOT.joint_names}, "tip"),
    *[(d.load_robot, {"source": "iiwa7", name: [3]}, name) for name in ("locked", "frames")],
    (d.robot_from_dh, {"table": np.zeros((2, 3))}, "table"),
    (d.robot_from_dh, {"table": [[0, 0, 1, 0]], "prismatic": [2]}, "prismatic"),
    (d.robot_from_dh, {"table": [[0, 0, 1, 0]], "convention": "classic"}, "convention"),
    (d.robot_from_dh, {"table": [[0, 0, 1, 0]], "lower": 1, "upper": 0}, "lower"),
    (d.robot_from_dh, {"table": [[0, 0, 1, 0]], "velocity": [1, 2]}, "velocity"),
    (make_obstacles, {"tables": [3]}, "obstacle 1"),
    (make_obstacles, {"tables": [BALL, {"radius": 1.0}]}, "obstacle 2"),
    (make_obstacles, {"tables": [BALL, BALL | {"radius": -1.0}]}, "obstacle 2"),
    (make_obstacles, {"tables": [BALL | {"colour": "red"}]}, "obstacle 1"),
    (d.Box, {"center": [0, 0, 0], "half_extents": [0.1, 0.1, 0.0]}, "half_extents"),
]


@pytest.mark.parametrize(("call", "arguments", "named"), REFUSED)
def test_a_bad_argument_is_named(call: Any, arguments: dict[str, Any], named: str) -> None:
    with pytest.raises(d.InvalidInputError) as caught:
        call(**arguments)
    assert caught.value.argument == named
    assert "\n" not in str(caught.value)
    assert "__init__" not in str(caught.value)


def test_an_unknown_name_lists_those_that_are_near() -> None:
    with pytest.raises(d.NotFoundError, match="no frame 'iiwa7_link4'; did you mean: iiwa7_link_"):
        d.Configuration(ROBOT, np.zeros(7)).frame("iiwa7_link4")
    with pytest.raises(d.NotFoundError, match="no joint 'iiwa7_joint_9'"):
        d.load_robot("iiwa7", locked=["iiwa7_joint_9"])
    with pytest.raises(d.NotFoundError, match="no robot 'iiwa14'; did you mean: iiwa7"):
        d.load_robot("iiwa14")
