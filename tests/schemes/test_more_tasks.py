"""Tasks beyond position and orientation: Jacobians by finite differences, closed loops."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from helpers_simulation import paper_robot, paper_start
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes import (
    AxisTask,
    CyclicMotion,
    JointCouplingTask,
    JointLimits,
    KineticEnergy,
    Manipulability,
    PoseTask,
    PositionTask,
    PostureTask,
    RelativePoseTask,
    RemoteCenterTask,
    Scheme,
)
from iiwa_dnn.schemes.costs import manipulability_gradient

ROBOT = paper_robot()
START = Configuration(ROBOT, [-1.2, -0.6, 0.3, 1.4, 0.2, -0.9, 0.4])
AXIS = np.array([0.2, -0.5, 1.0])
RAY = START.rotation.T @ (START.frame("iiwa7_link_2").position - START.position)
SHAFT = START.position + 0.1 * START.rotation[:, 2]

TASKS: dict[str, Any] = {
    "pose": PoseTask(gain=1.0),
    "axis": AxisTask(axis=AXIS, gain=1.0),
    "axis in the world": AxisTask(axis=AXIS, direction=START.rotation @ AXIS, gain=1.0),
    "relative pose": RelativePoseTask("iiwa7_link_7", "iiwa7_link_1", gain=1.0).anchored(START),
    "remote center": RemoteCenterTask(SHAFT, gain=1.0),
    "looking at a frame": RemoteCenterTask("iiwa7_link_2", RAY, gain=1.0),
    "posture": PostureTask({"iiwa7_joint_3": 0.3, "iiwa7_joint_1": -1.2}, gain=1.0),
    "coupling": JointCouplingTask({"iiwa7_joint_2": 2.0, "iiwa7_joint_4": -1.0}, -2.6, gain=1.0),
}


def rows(task: Any, q: np.ndarray, target: Target) -> tuple[np.ndarray, np.ndarray]:
    qp = Scheme(tasks=[task]).build_qp(Configuration(ROBOT, q), target)
    return qp.A.copy(), qp.b.copy()


@pytest.mark.parametrize("name", TASKS)
def test_rows_are_the_derivative_of_the_error(name: str) -> None:
    # With gain 1 the right-hand side is the error, and A minus its derivative where it is zero.
    target = Target(START.position, START.rotation)
    A, b = rows(TASKS[name], START.q, target)
    np.testing.assert_allclose(b, 0.0, atol=1e-12)
    h = 1e-6
    for j in range(ROBOT.dof):
        ahead, behind = START.q.copy(), START.q.copy()
        ahead[j] += h
        behind[j] -= h
        change = (rows(TASKS[name], ahead, target)[1] - rows(TASKS[name], behind, target)[1]) / (
            2.0 * h
        )
        np.testing.assert_allclose(A[:, j], -change, rtol=0, atol=1e-8)
    assert np.linalg.matrix_rank(A) == len(A)


@pytest.mark.parametrize("name", TASKS)
def test_hard_and_soft_tasks_bring_the_error_to_rest(name: str) -> None:
    target = Target(START.position, START.rotation)
    task = replace(TASKS[name], gain=10.0)
    for chosen in (task, replace(task, weight=10.0)):
        scheme = Scheme([KineticEnergy(weight=1e-6)], [chosen], [JointLimits()])
        solver, q = DNNSolver(), START.q + np.array([0.03, -0.02, 0.03, 0.02, -0.03, 0.02, 0.01])
        first = np.abs(rows(task, q, target)[1]).max()
        for _ in range(100):
            solution = solver.solve(scheme.build_qp(Configuration(ROBOT, q), target))
            assert solution.found
            q = q + 0.01 * solution.x
        assert np.abs(rows(task, q, target)[1]).max() < 1e-4 * first


def test_manipulability_gradient_is_that_of_finite_differences() -> None:
    def measure(q: np.ndarray) -> float:
        J = Configuration(ROBOT, q).jacobian
        return float(np.sqrt(np.linalg.det(J @ J.T)))

    value, gradient = manipulability_gradient(START.jacobian)
    assert value == pytest.approx(measure(START.q), rel=1e-12)
    steps = 1e-6 * np.eye(7)
    expected = [(measure(START.q + s) - measure(START.q - s)) / 2e-6 for s in steps]
    np.testing.assert_allclose(gradient, expected, atol=1e-8)


def test_manipulability_grows_where_the_arm_is_free_to() -> None:
    home = paper_start()
    scheme = Scheme(
        [KineticEnergy(weight=1.0), Manipulability(weight=5.0)], [PositionTask()], [JointLimits()]
    )
    target, solver, q = Target(home.position, home.rotation), DNNSolver(), home.q
    before = manipulability_gradient(home.jacobian)[0]
    for _ in range(200):
        solution = solver.solve(scheme.build_qp(Configuration(ROBOT, q), target))
        q = q + 0.01 * solution.x
    end = Configuration(ROBOT, q)
    assert manipulability_gradient(end.jacobian)[0] > 1.05 * before
    np.testing.assert_allclose(end.position, home.position, atol=1e-3)


def test_parts_leave_slack_variables_out() -> None:
    scheme = Scheme([CyclicMotion(), Manipulability()], [PoseTask()], [JointLimits()], slack=2)
    qp = scheme.build_qp(START, Target(START.position, START.rotation))
    np.testing.assert_array_equal(qp.A[:, 7:], 0.0)
    np.testing.assert_allclose(qp.A[:, :7], START.jacobian, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("make", "named"),
    [
        (lambda: AxisTask(axis=(0.0, 0.0, 0.0)), "axis"),
        (lambda: PoseTask(gain=-1.0), "gain"),
        (lambda: PoseTask(weight=-1.0), "weight"),
        (lambda: RelativePoseTask("a", "b", ((1.0,),)), "pose"),
        (lambda: RemoteCenterTask((0.0, 1.0)), "point"),
        (lambda: PostureTask({"a": np.nan}), "joints"),
        (lambda: PostureTask([0.0] * 7), "joints"),  # type: ignore[arg-type]
        (lambda: Manipulability(weight=-1.0), "weight"),
    ],
)
def test_bad_parameters_are_named(make: Any, named: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{named}\b"):
        make()


def test_an_unknown_joint_is_named() -> None:
    with pytest.raises(NotFoundError, match="iiwa7_joint_33"):
        rows(PostureTask({"iiwa7_joint_33": 0.0}), START.q, Target(START.position, START.rotation))
