"""Velocity bounds of the joints' limits, by the paper's formula, and of the tip's speed."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

import iiwa_dnn as d
from helpers_kinematics import Array
from helpers_simulation import driven, paper_robot, paper_start, rows_of

DT = 2e-3
LAST = np.array([0.3, -0.2, 0.1, 0.4, -0.3, 0.2, 0.5])

joints = arrays(np.float64, 7, elements=st.floats(-1e3, 1e3))
limits = arrays(np.float64, 7, elements=st.one_of(st.floats(0.01, 1e3), st.just(np.inf)))


@settings(max_examples=50)
@given(
    q=joints,
    lower=limits,
    upper=limits,
    speed=limits,
    gain=st.floats(1e-3, 1e4),
    dt=st.sampled_from([np.inf, 1e-2]),
)
def test_bounds_are_the_papers_formula(q, lower, upper, speed, gain, dt) -> None:
    robot = paper_robot().with_limits(lower=-lower, upper=upper, velocity=speed)
    qp = rows_of(d.JointLimits(gain=gain), d.Configuration(robot, q), dt=dt)
    kappa = min(gain, 1.0 / dt) if dt < np.inf else gain
    assert_array_equal(qp.lb, np.clip(kappa * (-lower - q), -speed, speed))
    assert_array_equal(qp.ub, np.clip(kappa * (upper - q), -speed, speed))


def test_the_fr3s_velocity_limits_end_before_its_position_limits() -> None:
    # libfranka's rate_limiting.h: sqrt(2 d (upper - q)) - offset, none below it.
    robot = d.load_robot("fr3")
    offset, deceleration = robot.position_dependent_velocity
    for left in (0.0, 1e-4, 5e-3, 0.05, 0.5):
        qp = rows_of(d.JointLimits(gain=20.0), d.Configuration(robot, robot.q_upper - left))
        ramp = np.maximum(np.sqrt(2.0 * deceleration * left) - offset, 0.0)
        expected = np.minimum(robot.dq_max, np.minimum(ramp, 20.0 * left))
        assert_allclose(qp.ub, expected, atol=1e-12)
        assert_array_equal(qp.lb, -robot.dq_max)


@pytest.mark.parametrize("fraction", [0.5, 2.0])
def test_each_joint_may_add_an_equal_part_of_what_is_left(fraction: float) -> None:
    jacobian = paper_start().jacobian[:3]
    speed = np.linalg.norm(jacobian @ LAST)
    along = jacobian.T @ jacobian @ LAST / speed
    qp = rows_of(d.TipSpeedLimit(fraction * speed, gain=50.0), paper_start(), dt=DT, dq=LAST)
    # At their bounds the joints close the gain's part of the gap in one step.
    growth = 50.0 * DT * (fraction - 1.0) * speed / np.abs(along).sum()
    moves = np.abs(along) > 1e-12
    expected = LAST + np.sign(along) * growth
    assert_allclose(qp.ub, np.where(moves & (along > 0.0), expected, np.inf), rtol=1e-12)
    assert_allclose(qp.lb, np.where(moves & (along < 0.0), expected, -np.inf), rtol=1e-12)


@pytest.mark.parametrize("dq", [np.zeros(7), np.eye(7)[6]])
def test_a_tip_at_rest_has_no_bounds(dq: Array) -> None:
    qp = rows_of(d.TipSpeedLimit(0.1), d.Configuration(paper_robot(), np.zeros(7)), dt=DT, dq=dq)
    assert np.isinf([qp.lb, qp.ub]).all()


def test_the_tip_is_no_quicker_where_its_target_jumps() -> None:
    # Without its limit it reaches 0.6 m/s.
    extra = (d.AccelerationLimits(10.0), d.JerkLimits(1000.0), d.TipSpeedLimit(0.4))
    scheme = d.DoubleIndicator(position_gain=50.0, orientation_gain=50.0, extra_limits=extra)
    controller = d.Controller(paper_robot(), scheme, dt=DT)
    start = paper_start()

    def jumping(t: float) -> d.Target:
        side = 0.3 if round(t / DT) % 150 < 75 else -0.3
        return d.Target(start.position + [side, 0.0, 0.1], start.rotation)

    path, _ = driven(controller, start.q, 300, jumping)
    tip = [d.Configuration(paper_robot(), q).position for q in path]
    fastest = np.linalg.norm(np.diff(tip, axis=0), axis=1).max() / DT
    assert 0.36 < fastest < 0.44
