"""Orientation rows against finite differences, scipy's rotations and closed-form decay."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from scipy.spatial.transform import Rotation

from helpers_kinematics import Array, dh_pose, finite_difference, rotation_angle
from helpers_simulation import (
    block_map,
    block_vector,
    near_target,
    orientation_rows,
    paper_robot,
)
from iiwa_dnn.references import Target
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import OrientationTask, PseudoInverse, Scheme
from iiwa_dnn.simulation.motion import MOTIONS

POSTURES = np.random.default_rng(21).uniform(-2.5, 2.5, (30, 7))


def block_of(q: Array) -> Array:
    """The paper's r = [R11, R12, R21, R22], by the DH formula."""
    rotation = dh_pose(q)[1]
    return np.array([rotation[0, 0], rotation[0, 1], rotation[1, 0], rotation[1, 1]])


def rows_at(mode: str, q: Array, target: Target, gain: float = 10.2) -> tuple[Array, Array]:
    return orientation_rows(mode, Configuration(paper_robot(), q), target, gain)


@pytest.mark.parametrize("q", POSTURES)
def test_block_jacobian_by_finite_differences(q: Array) -> None:
    rows, _ = rows_at("block", q, near_target(q, seed=1))
    assert rows.shape == (4, 7)
    np.testing.assert_allclose(rows, finite_difference(block_of, q), rtol=0, atol=1e-6)


@pytest.mark.parametrize("q", POSTURES)
def test_block_vector_is_the_dh_formulas(q: Array) -> None:
    np.testing.assert_allclose(block_vector(dh_pose(q)[1]), block_of(q), rtol=0, atol=0)


@pytest.mark.parametrize("q", POSTURES)
def test_block_rows_have_rank_three_at_most(q: Array) -> None:
    rows, _ = rows_at("block", q, near_target(q, seed=1))
    assert np.linalg.svd(rows, compute_uv=False)[3] < 1e-14


def test_block_rows_lose_the_tilt_where_the_tool_is_vertical() -> None:
    # PAPER, slip 4: with R31 = R32 = 0 the block sees rotations about the vertical only.
    for yaw in (0.0, 0.7, -2.0):
        for flip in (np.eye(3), np.diag([1.0, -1.0, -1.0])):
            rotation = Rotation.from_euler("z", yaw).as_matrix() @ flip
            assert np.linalg.matrix_rank(block_map(rotation), tol=1e-12) == 1
    tilted = Rotation.from_euler("zy", (0.7, 0.2)).as_matrix()
    assert np.linalg.matrix_rank(block_map(tilted), tol=1e-12) == 3


def test_block_right_hand_side() -> None:
    # Its feed-forward is the rate of r_d along a turning target, here by finite differences.
    for seed, q in enumerate(POSTURES):
        target = near_target(q, seed, size=0.5)

        def turned(t: Array, target: Target = target) -> Array:
            turn = Rotation.from_rotvec(target.angular_velocity * t[0]).as_matrix()
            return (turn @ target.rotation)[:2, :2].reshape(4)

        rate = finite_difference(turned, np.zeros(1))[:, 0]
        error = target.rotation[:2, :2].reshape(4) - block_of(q)
        rows, rhs = rows_at("block", q, target, gain=3.0)
        basis = scipy.linalg.orth(rows, rcond=1e-9)  # the four contradict each other off the path
        expected = basis @ (basis.T @ (rate + 3.0 * error))
        np.testing.assert_allclose(rhs, expected, rtol=0, atol=1e-9)


def test_so3_rows_are_the_angular_jacobian_and_scipys_logarithm() -> None:
    for seed, q in enumerate(POSTURES):
        conf, target = Configuration(paper_robot(), q), near_target(q, seed, size=0.5)
        rows, rhs = orientation_rows("so3", conf, target, 3.0)
        np.testing.assert_allclose(rows, conf.jacobian[3:], rtol=0, atol=1e-15)
        turn = Rotation.from_matrix(target.rotation @ dh_pose(q)[1].T).as_rotvec()
        np.testing.assert_allclose(rhs, target.angular_velocity + 3.0 * turn, rtol=0, atol=1e-9)


@pytest.mark.parametrize("angle", [1e-9, 1e-3, 1.0, 3.0, np.pi - 1e-6, np.pi])
def test_so3_right_hand_side_at_any_angle(angle: float) -> None:
    conf = Configuration(paper_robot(), POSTURES[0])
    turn = Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix()
    target = Target(conf.position, turn @ conf.rotation, np.zeros(3), np.zeros(3))
    _, rhs = orientation_rows("so3", conf, target, 1.0)
    # The axis is only as sharp as a rotation matrix can say it near pi, its sign open at pi.
    np.testing.assert_allclose(np.abs(rhs), [0.0, 0.0, angle], rtol=0, atol=1e-7)


def test_none_has_no_rows() -> None:
    conf = Configuration(paper_robot(), POSTURES[0])
    qp = PseudoInverse(orientation="none").build_qp(conf, near_target(conf.q, seed=1))
    assert qp.A.shape == (3, 7)


@pytest.mark.parametrize("gain", [10.2, 3.0])
def test_so3_feedback_makes_the_error_decay_exponentially(gain: float) -> None:
    # On a fixed target the error's axis stands still and its angle obeys d/dt angle = -gain angle.
    q = np.array([0.3, 0.5, -0.2, -1.2, 0.4, 0.8, -0.3])
    position, rotation = dh_pose(q)
    turn = Rotation.from_rotvec([0.2, -0.3, 0.25]).as_matrix()
    target = Target(position, turn @ rotation, np.zeros(3), np.zeros(3))
    scheme = PseudoInverse(orientation_gain=gain)

    def velocity(q: Array, t: float) -> Array:
        qp = scheme.build_qp(Configuration(paper_robot(), q), target)
        return np.linalg.pinv(qp.A) @ qp.b

    dt, initial = 5e-3, float(rotation_angle(rotation, target.rotation))
    for k in range(100):
        q = q + dt * MOTIONS["rk4"].step(velocity, q, k * dt, dt)
        angle = float(rotation_angle(dh_pose(q)[1], target.rotation))
        assert angle == pytest.approx(initial * np.exp(-gain * (k + 1) * dt), rel=1e-4)
    np.testing.assert_allclose(dh_pose(q)[0], position, rtol=0, atol=1e-5)


def test_block_feedback_draws_r_to_its_target_at_first_order() -> None:
    # Four rows of rank three: they agree only to first order, so the rate is exact in the limit.
    q = POSTURES[3]
    size = 1e-4
    target = near_target(q, seed=2, size=size)
    target = Target(target.position, target.rotation, np.zeros(3), np.zeros(3))
    rows, rhs = rows_at("block", q, target)
    rate = rows @ np.linalg.lstsq(rows, rhs, rcond=1e-9)[0]
    assert np.abs(rhs).max() > size
    np.testing.assert_allclose(rate, rhs, rtol=0, atol=10.0 * 10.2 * size**2)


def test_block_rows_can_all_be_fulfilled_off_the_path() -> None:
    # The paper's right-hand side leaves 1e-8 at 1e-4 rad: it is projected on the rows' range.
    for seed, q in enumerate(POSTURES):
        rows, rhs = rows_at("block", q, near_target(q, seed, size=1e-3))
        left = rhs - rows @ np.linalg.lstsq(rows, rhs, rcond=1e-9)[0]
        np.testing.assert_allclose(left, 0.0, rtol=0, atol=1e-11)


@pytest.mark.parametrize(
    "axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (3, -2, 1), (-1, 3, 2), (1, 2, -3)]
)
@pytest.mark.parametrize("angle", [2.2, -2.9, np.pi - 1e-4])
def test_so3_right_hand_side_of_large_turns_about_any_axis(
    axis: tuple[int, int, int], angle: float
) -> None:
    # Beyond 2 pi / 3 the quaternion's largest component may be any of four.
    conf = Configuration(paper_robot(), POSTURES[1])
    vector = angle * np.array(axis) / np.linalg.norm(axis)
    turn = Rotation.from_rotvec(vector).as_matrix()
    target = Target(conf.position, turn @ conf.rotation, np.zeros(3), np.zeros(3))
    _, rhs = orientation_rows("so3", conf, target, 1.0)
    np.testing.assert_allclose(rhs, vector, rtol=0, atol=1e-11)


@pytest.mark.parametrize("frame", ["iiwa7_link_3", "iiwa7_link_6"])
def test_block_rows_of_another_frame_leave_the_joints_beyond_it_alone(frame: str) -> None:
    conf = Configuration(paper_robot(), POSTURES[2])
    state = conf.frame(frame)
    target = Target(state.position, state.rotation, np.zeros(3), np.array([0.1, -0.2, 0.3]))
    scheme = Scheme(tasks=[OrientationTask(form="block", frame=frame)])
    qp = scheme.build_qp(conf, {frame: target})

    def block(q: Array) -> Array:
        return block_vector(Configuration(paper_robot(), q).frame(frame).rotation)

    np.testing.assert_allclose(qp.A, finite_difference(block, conf.q), rtol=0, atol=1e-8)
    assert not qp.A[:, int(frame[-1]) :].any()
    expected = block_map(state.rotation) @ target.angular_velocity
    np.testing.assert_allclose(qp.b, expected, rtol=0, atol=1e-14)
