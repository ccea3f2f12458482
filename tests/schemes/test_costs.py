"""Costs: the gradient of manipulability by finite differences, and slack variables left out."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import finite_difference
from helpers_simulation import paper_robot
from iiwa_dnn import (
    Configuration,
    CyclicMotion,
    JointLimits,
    Manipulability,
    PoseTask,
    Scheme,
    Target,
)

ROBOT = paper_robot()
START = Configuration(ROBOT, [-1.2, -0.6, 0.3, 1.4, 0.2, -0.9, 0.4])


def measure(q: np.ndarray) -> float:
    J = Configuration(ROBOT, q).jacobian
    return float(np.sqrt(np.linalg.det(J @ J.T)))


def test_manipulability_gradient_is_that_of_finite_differences() -> None:
    qp = Scheme([Manipulability(weight=2.0)]).build_qp(START, Target(START.position))
    expected = finite_difference(lambda q: np.array([measure(q)]), START.q)[0]
    np.testing.assert_allclose(qp.q, -2.0 * expected, atol=1e-7)
    assert not qp.P.any()


def test_parts_leave_slack_variables_out() -> None:
    scheme = Scheme([CyclicMotion(), Manipulability()], [PoseTask()], [JointLimits()], slack=2)
    qp = scheme.build_qp(START, Target(START.position, START.rotation))
    np.testing.assert_array_equal(qp.A[:, 7:], 0.0)
    np.testing.assert_allclose(qp.A[:, :7], START.jacobian, rtol=0, atol=1e-15)


@pytest.mark.parametrize("weight", [0.5, 2.0])
def test_the_pull_home_is_the_gradient_of_a_square(weight: float) -> None:
    home = tuple(START.q - 0.1)
    cost = CyclicMotion(weight=weight, gain=3.0, home=home)
    qp = Scheme([cost]).build_qp(START, Target(START.position))
    np.testing.assert_array_equal(qp.P, weight * np.eye(7))
    np.testing.assert_allclose(qp.q, weight * 3.0 * 0.1, rtol=1e-12)
