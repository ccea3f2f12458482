"""Rows of all tasks: derivatives by finite differences, moving targets, closed loops."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

import iiwa_dnn as d
from helpers_kinematics import Array, finite_difference
from helpers_simulation import block_map, block_vector, near_target, paper_robot, rows_of
from iiwa_dnn.schemes.tasks import project_on_range

ROBOT = paper_robot()
START = d.Configuration(ROBOT, [-1.2, -0.6, 0.3, 1.4, 0.2, -0.9, 0.4])
POSTURES = np.random.default_rng(21).uniform(-2.5, 2.5, (30, 7))
AXIS = np.array([0.2, -0.5, 1.0])
RAY = START.rotation.T @ (START.frame("iiwa7_link_2").position - START.position)
SHAFT = START.position + 0.1 * START.rotation[:, 2]
LINK = "iiwa7_link_6"

TASKS: dict[str, Any] = {
    "position": d.PositionTask(gain=1.0),
    "position of a link": d.PositionTask(gain=1.0, frame=LINK),
    "orientation": d.OrientationTask(gain=1.0),
    "block": d.OrientationTask(gain=1.0, form="block"),
    "block of a link": d.OrientationTask(gain=1.0, form="block", frame=LINK),
    "pose": d.PoseTask(gain=1.0),
    "axis": d.AxisTask(axis=AXIS, gain=1.0),
    "axis in the world": d.AxisTask(axis=AXIS, direction=START.rotation @ AXIS, gain=1.0),
    "relative pose": d.RelativePoseTask("iiwa7_link_7", "iiwa7_link_1", gain=1.0).anchored(START),
    "remote center": d.RemoteCenterTask(SHAFT, gain=1.0),
    "looking at a frame": d.RemoteCenterTask("iiwa7_link_2", RAY, gain=1.0),
    "posture": d.PostureTask({"iiwa7_joint_3": 0.3, "iiwa7_joint_1": -1.2}, gain=1.0),
    "coupling": d.JointCouplingTask({"iiwa7_joint_2": 2.0, "iiwa7_joint_4": -1.0}, -2.6, gain=1.0),
}


def target_of(task: Any, dq: Any = 0.0) -> Any:
    """The target that the task's frame is at in START, moving with joint velocities."""
    name = task.frame_name(ROBOT) if task.tracks else ROBOT.tip
    frame = START.frame(name)
    twist = frame.jacobian @ np.broadcast_to(dq, 7)
    return {name: d.Target(frame.position, frame.rotation, twist[:3], twist[3:])}


def rows(task: Any, q: Any, target: Any, **options: Any) -> tuple[Array, Array]:
    qp = rows_of(task, d.Configuration(ROBOT, q), target, **options)
    return qp.A, qp.b


@pytest.mark.parametrize("name", TASKS)
def test_rows_are_the_derivative_of_the_error(name: str) -> None:
    # With gain 1 the right-hand side is the error, and A minus its derivative where it is zero.
    task = TASKS[name]
    target = target_of(task)
    A, b = rows(task, START.q, target)
    assert_allclose(b, 0.0, atol=1e-12)
    change = finite_difference(lambda q: rows(task, q, target)[1], START.q)
    assert_allclose(A, -change, rtol=0, atol=1e-8)
    assert np.linalg.matrix_rank(A, tol=1e-9) == (3 if "block" in name else len(A))
    # A joint velocity follows a target that moves with it.
    dq = np.random.default_rng(1).standard_normal(7)
    if task.tracks:
        A, b = rows(task, START.q, target_of(task, dq))
        assert_allclose(A @ dq, b, rtol=0, atol=1e-12)
    # A gain beyond one over the period is cut to it.
    q = START.q + 0.01
    quickest = rows(replace(task, gain=np.inf), q, target, dt=1e-2)[1]
    assert_allclose(quickest, 100.0 * rows(task, q, target)[1], rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("weight", [None, 10.0])
@pytest.mark.parametrize("name", TASKS)
def test_hard_and_soft_tasks_bring_the_error_to_rest(name: str, weight: float | None) -> None:
    target = target_of(TASKS[name])
    task = replace(TASKS[name], gain=10.0, weight=weight)
    scheme = d.Scheme([d.KineticEnergy(weight=1e-6)], [task], [d.JointLimits()])
    q = START.q + np.array([0.03, -0.02, 0.03, 0.02, -0.03, 0.02, 0.01])
    first = np.abs(rows(TASKS[name], q, target)[1]).max()
    solver = d.DNNSolver()
    for _ in range(100):
        q = q + 0.01 * solver.solve(scheme.build_qp(d.Configuration(ROBOT, q), target)).x
    assert np.abs(rows(TASKS[name], q, target)[1]).max() < 1e-4 * first


def test_block_right_hand_side_is_projected_so_that_all_rows_can_be_fulfilled() -> None:
    # Its feed-forward is the rate of r_d along a turning target, here by finite differences.
    for seed, q in enumerate(POSTURES):
        conf = d.Configuration(ROBOT, q)
        target = near_target(q, seed, size=0.5)

        def turned(t: Array, target: d.Target = target) -> Array:
            turn = Rotation.from_rotvec(target.angular_velocity * t[0]).as_matrix()
            return block_vector(turn @ target.rotation)

        rate = finite_difference(turned, [0.0])[:, 0]
        error = block_vector(target.rotation - conf.rotation)
        qp = rows_of(d.OrientationTask(gain=3.0, form="block"), conf, target)
        basis = scipy.linalg.orth(qp.A, rcond=1e-9)  # the four contradict each other off the path
        assert_allclose(qp.b, basis @ (basis.T @ (rate + 3.0 * error)), rtol=0, atol=1e-9)


@pytest.mark.parametrize("tilt", [0.0, 1e-12, 1e-7, 1e-3, 1.0, 2.0, np.pi - 1e-3, np.pi])
def test_projection_on_the_range_of_the_blocks_rows_is_scipys(tilt: float) -> None:
    rng = np.random.default_rng(0)
    for yaw, spin in rng.uniform(-np.pi, np.pi, (50, 2)):
        rotation = Rotation.from_euler("ZYZ", [yaw, tilt, spin]).as_matrix()
        vector = rng.standard_normal(4)
        basis = scipy.linalg.orth(block_map(rotation), rcond=1e-9)
        expected = basis @ (basis.T @ vector)
        project_on_range(np.ascontiguousarray(rotation.T), vector)
        assert_allclose(vector, expected, rtol=0, atol=1e-8)


@pytest.mark.parametrize("angle", [1e-9, 0.5, 2.0, 3.1])
def test_the_axis_is_to_turn_by_the_angle_that_it_is_off(angle: float) -> None:
    here = START.rotation @ AXIS / np.linalg.norm(AXIS)
    normal = np.cross(here, [1.0, 0.0, 0.0])
    turn = Rotation.from_rotvec(angle * normal / np.linalg.norm(normal)).as_matrix()
    _, b = rows(d.AxisTask(axis=AXIS, direction=turn @ here, gain=1.0), START.q, None)
    assert np.linalg.norm(b) == pytest.approx(angle, rel=1e-7)
