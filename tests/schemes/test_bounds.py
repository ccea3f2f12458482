"""Velocity bounds of the joints' limits, by the paper's formula, and of the tip's speed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import arrays

import iiwa_dnn
from helpers_kinematics import Array
from helpers_simulation import paper_robot, paper_start, rows_of, velocity_bounds
from iiwa_dnn import JointLimits, load_robot
from iiwa_dnn.robot.configuration import Configuration

joints = arrays(np.float64, 7, elements=st.floats(-1e3, 1e3))
limits = arrays(np.float64, 7, elements=st.one_of(st.floats(0.01, 1e3), st.just(np.inf)))


@settings(max_examples=50)
@given(q=joints, lower=limits, upper=limits, speed=limits, gain=st.floats(1e-3, 1e4))
def test_lower_never_exceeds_upper(
    q: Array, lower: Array, upper: Array, speed: Array, gain: float
) -> None:
    robot = paper_robot().with_limits(lower=-lower, upper=upper, velocity=speed)
    lb, ub = velocity_bounds(Configuration(robot, q), gain)
    assert (lb <= ub).all()
    assert (np.abs(np.concatenate([lb, ub])) <= np.tile(speed, 2)).all()
    # A joint outside its range is sent back, one inside may always stop.
    assert (ub[q > upper] < 0.0).all()
    assert (lb[q < -lower] > 0.0).all()
    inside = (-lower <= q) & (q <= upper)
    assert (lb[inside] <= 0.0).all()
    assert (ub[inside] >= 0.0).all()


def test_the_fr3s_velocity_limits_end_before_its_position_limits() -> None:
    # libfranka's rate_limiting.h: sqrt(2 d (upper - q)) - offset, none below it.
    robot = load_robot("fr3")
    offset, deceleration = robot.ramps
    for left in (0.0, 1e-4, 5e-3, 0.05, 0.5):
        lb, ub = velocity_bounds(Configuration(robot, robot.q_upper - left), 20.0)
        ramp = np.maximum(np.sqrt(2.0 * deceleration * left) - offset, 0.0)
        expected = np.minimum(robot.dq_max, np.minimum(ramp, 20.0 * left))
        np.testing.assert_allclose(ub, expected, atol=1e-12)
        np.testing.assert_array_equal(lb, -robot.dq_max)


def test_the_papers_formula_inside_the_limits() -> None:
    robot = paper_robot()
    rng = np.random.default_rng(31)
    # Half of the postures close to a limit, where kappa (limit - q) is what binds.
    postures = np.vstack([rng.uniform(-2.5, 2.5, (50, 7)), rng.choice([-2.49, 2.48], (50, 7))])
    binding = 0
    for q in postures:
        lb, ub = velocity_bounds(Configuration(robot, q), 20.0)
        for i in range(7):
            lower, upper = 20.0 * (-2.5 - q[i]), 20.0 * (2.5 - q[i])
            assert lb[i] == pytest.approx(max(-robot.dq_max[i], lower), rel=1e-14)
            assert ub[i] == pytest.approx(min(robot.dq_max[i], upper), rel=1e-14)
            binding += lb[i] > -robot.dq_max[i] or ub[i] < robot.dq_max[i]
    assert binding >= 300


def test_a_gain_beyond_one_over_the_period_is_cut_to_it() -> None:
    conf = Configuration(paper_robot(), np.full(7, 2.5 - 1e-3))
    qp = rows_of(JointLimits(gain=1e4), conf, dt=1e-2)
    np.testing.assert_allclose(qp.ub, 0.1, rtol=1e-9)


DT = 2e-3
LAST = np.array([0.3, -0.2, 0.1, 0.4, -0.3, 0.2, 0.5])


def test_each_joint_may_add_an_equal_part_of_what_is_left() -> None:
    jacobian = paper_start().jacobian[:3]
    speed = np.linalg.norm(jacobian @ LAST)
    along = jacobian.T @ jacobian @ LAST / speed
    for limit in (0.5 * speed, 2.0 * speed):
        limited = iiwa_dnn.TipSpeedLimit(limit, gain=50.0)
        qp = rows_of(limited, paper_start(), dt=DT, dq=LAST)
        lb, ub = qp.lb, qp.ub
        growth = 50.0 * DT * (limit - speed) / np.abs(along).sum()
        moves = np.abs(along) > 1e-12
        assert np.isinf(lb[(along > 0.0) | ~moves]).all()
        assert np.isinf(ub[(along < 0.0) | ~moves]).all()
        bound = np.where(along > 0.0, ub, lb)[moves]
        expected = (LAST + np.sign(along) * growth)[moves]
        np.testing.assert_allclose(bound, expected, rtol=1e-12)
        # A command at the bounds closes the gain's part of the gap in one step.
        command = np.where(moves, LAST + np.sign(along) * growth, LAST)
        reached = along @ command
        assert reached == pytest.approx(speed + 50.0 * DT * (limit - speed), rel=1e-12)


@pytest.mark.parametrize("dq", [np.zeros(7), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
def test_a_tip_at_rest_has_no_bounds(dq: np.ndarray) -> None:
    conf = iiwa_dnn.Configuration(paper_robot(), np.zeros(7))
    qp = rows_of(iiwa_dnn.TipSpeedLimit(0.1), conf, dt=DT, dq=dq)
    assert np.isinf([qp.lb, qp.ub]).all()


@pytest.mark.parametrize("wanted", [None, 0.4])
def test_the_tip_is_no_quicker_where_its_target_jumps(wanted: float | None) -> None:
    limits = [iiwa_dnn.AccelerationLimits(10.0), iiwa_dnn.JerkLimits(1000.0)]
    if wanted is not None:
        limits.append(iiwa_dnn.TipSpeedLimit(wanted))
    scheme = iiwa_dnn.DoubleIndicator(
        position_gain=50.0, orientation_gain=50.0, extra_limits=tuple(limits)
    )
    controller = iiwa_dnn.Controller(paper_robot(), scheme, dt=DT)
    q = np.array(paper_start().q)
    tip = [paper_start().position]
    for k in range(300):
        side = 0.3 if k % 150 < 75 else -0.3
        target = iiwa_dnn.Target(paper_start().position + [side, 0.0, 0.1], paper_start().rotation)
        q = q + DT * controller.step(q, k * DT, target).dq
        tip.append(iiwa_dnn.Configuration(paper_robot(), q).position)
    fastest = np.linalg.norm(np.diff(tip, axis=0), axis=1).max() / DT
    if wanted is None:
        assert fastest > 0.6
    else:
        assert 0.36 < fastest < 0.44
