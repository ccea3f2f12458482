"""Velocity bounds of the joints' position and velocity limits, by the formulas of their sources."""

import numpy as np
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose, assert_array_equal

import iiwa_dnn as d
from helpers_simulation import paper_robot, rows_of

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
