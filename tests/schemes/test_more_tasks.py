"""Tasks beyond position and orientation: Jacobians by finite differences, closed loops."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pinocchio as pin
import pytest

from helpers_simulation import paper_robot, paper_start
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.references import Target
from iiwa_dnn.robot import Configuration, load_robot
from iiwa_dnn.schemes import (
    AxisTask,
    CenterOfMassTask,
    CyclicMotion,
    ElbowAngleTask,
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
SIX = Configuration(load_robot("ur5"), np.zeros(6))
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
    "elbow": ElbowAngleTask(gain=1.0).anchored(START),
    "elbow, other reference": ElbowAngleTask(reference=(1.0, 0.2, 0.0), gain=1.0).anchored(START),
    "center of mass": CenterOfMassTask(axes="xz", gain=1.0).anchored(START),
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


def test_the_elbow_angle_is_that_of_a_geometric_construction() -> None:
    task = ElbowAngleTask()
    points = [START.frame(f"iiwa7_joint_{k}").position for k in (2, 4, 6)]
    w = (points[2] - points[0]) / np.linalg.norm(points[2] - points[0])
    # The plane's normal and the reference plane's normal, the signed angle between them about w.
    up = np.cross(w, [0.0, 0.0, 1.0])
    plane = np.cross(w, points[1] - points[0])
    angle = np.arctan2(w @ np.cross(up, plane), up @ plane)
    assert task.angle_of(START) == pytest.approx(angle, abs=1e-12)


def test_the_elbow_swings_while_the_tool_stays() -> None:
    scheme = Scheme(
        [KineticEnergy(weight=1.0)],
        [PoseTask(gain=20.0), ElbowAngleTask(ElbowAngleTask().angle_of(START) + 0.3, gain=2.0)],
        [JointLimits()],
    )
    target, solver, q = Target(START.position, START.rotation), DNNSolver(), START.q
    for _ in range(400):
        solution = solver.solve(scheme.build_qp(Configuration(ROBOT, q), target))
        assert solution.found
        q = q + 0.01 * solution.x
    end = Configuration(ROBOT, q)
    assert ElbowAngleTask().angle_of(end) - ElbowAngleTask().angle_of(START) == pytest.approx(
        0.3, abs=1e-3
    )
    np.testing.assert_allclose(end.position, START.position, atol=1e-4)


def test_center_of_mass_is_the_mean_over_the_links() -> None:
    place, _ = START.center_of_mass
    model, data = ROBOT.model, ROBOT.model.createData()
    pin.forwardKinematics(model, data, START.q)
    moved = [
        (inertia.mass, data.oMi[i].act(inertia.lever))
        for i, inertia in enumerate(model.inertias)
        if i
    ]
    mass = sum(m for m, _ in moved)
    np.testing.assert_allclose(place, sum(m * c for m, c in moved) / mass, atol=1e-12)


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
        (lambda: CenterOfMassTask(axes="xw"), "axes"),
        (lambda: RelativePoseTask("a", "b", ((1.0,),)), "pose"),
        (lambda: RemoteCenterTask((0.0, 1.0)), "point"),
        (lambda: PostureTask({"a": np.nan}), "joints"),
        (lambda: PostureTask([0.0] * 7), "joints"),  # type: ignore[arg-type]
        (lambda: Manipulability(weight=-1.0), "weight"),
        (
            lambda: ElbowAngleTask().angle_of(SIX),
            "joints",
        ),
    ],
)
def test_bad_parameters_are_named(make: Any, named: str) -> None:
    with pytest.raises(InvalidInputError, match=rf"^{named}\b"):
        make()


def test_an_unknown_joint_is_named() -> None:
    with pytest.raises(NotFoundError, match="iiwa7_joint_33"):
        rows(PostureTask({"iiwa7_joint_33": 0.0}), START.q, Target(START.position, START.rotation))
