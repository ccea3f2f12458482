"""Velocity bounds: never crossed, the paper's formula inside the limits, a way back outside."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import arrays

from helpers_kinematics import Array
from helpers_simulation import paper_robot, rows_of, velocity_bounds
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
