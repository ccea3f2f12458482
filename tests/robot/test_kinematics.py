"""Kinematics of a control loop: the joints that move each frame."""

import numpy as np
import pinocchio as pin
import pytest

from iiwa_dnn.robot import load_robot
from iiwa_dnn.robot.kinematics import Kinematics


@pytest.mark.parametrize("name", ["iiwa7", "iiwa7_dual"])
def test_a_joint_moves_a_frame_where_the_jacobian_has_a_column(name: str) -> None:
    robot = load_robot(name)
    moves = Kinematics(robot).moves
    assert moves.flags.c_contiguous
    assert moves.dtype == np.float64
    q = np.random.default_rng(0).uniform(-1.0, 1.0, robot.dof)
    data = robot.model.createData()
    for index, row in enumerate(moves):
        jacobian = pin.computeFrameJacobian(robot.model, data, q, index, pin.LOCAL_WORLD_ALIGNED)
        np.testing.assert_array_equal(row, np.any(jacobian != 0.0, axis=0))
    np.testing.assert_array_equal(robot.moves, moves)
