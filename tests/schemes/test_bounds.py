"""Velocity bounds: never crossed, the paper's formula inside the limits, a way back outside."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from hypothesis.extra.numpy import arrays

from helpers_kinematics import Array
from helpers_qp import bounds_as_rows
from helpers_simulation import near_target, paper_robot, paper_start, rows_of, velocity_bounds
from iiwa_dnn import JointLimits, load_robot
from iiwa_dnn.qp.program import QP
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator

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


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_from_outside_every_admissible_velocity_leads_back(side: float) -> None:
    robot = paper_robot()
    rng = np.random.default_rng(32)
    q = np.full(7, side * 3.0)
    dt = 0.01
    excess = [0.5]
    for _ in range(200):
        lb, ub = velocity_bounds(Configuration(robot, q), 20.0)
        # Anything that the bounds allow, the slowest way back included.
        share = rng.choice([0.0, 0.5, 1.0], 7)
        slowest, fastest = (ub, lb) if side > 0 else (lb, ub)
        q = q + dt * (slowest + 0.02 * share * (fastest - slowest))
        excess.append(float((side * q - 2.5).max()))
    assert (np.diff(excess[:20]) < 0.0).all()
    assert max(excess[-10:]) < 1e-9


def test_just_outside_where_the_papers_formula_crosses() -> None:
    # 0.5 rad outside, kappa asks for 10 rad/s: the paper's lb > ub, and nothing is feasible.
    q = np.full(7, 3.0)
    robot = paper_robot()
    assert (np.maximum(-robot.dq_max, 20.0 * (-2.5 - q)) > np.minimum(robot.dq_max, -10.0)).all()
    lb, ub = velocity_bounds(Configuration(robot, q), 20.0)
    np.testing.assert_array_equal(lb, -robot.dq_max)
    np.testing.assert_array_equal(ub, -robot.dq_max)


@pytest.mark.long
@pytest.mark.parametrize("gain", [20.0, 200.0])
def test_steps_never_pass_a_limit_while_gain_times_dt_is_at_most_one(gain: float) -> None:
    robot = paper_robot()
    q = np.array([2.49, -2.49, 2.3, -2.3, 2.0, -2.0, 0.0])
    dt = 5e-3
    for _ in range(600):
        lb, ub = velocity_bounds(Configuration(robot, q), gain)
        q = q + dt * np.where(np.arange(7) % 2 == 0, ub, lb)
        assert (np.abs(q) <= 2.5 + 1e-12).all()
    np.testing.assert_allclose(np.abs(q), 2.5, rtol=0, atol=1e-6)


def test_without_limits_there_are_no_bounds() -> None:
    free = paper_robot().with_limits(lower=-np.inf, upper=np.inf, velocity=np.inf)
    lb, ub = velocity_bounds(Configuration(free, np.zeros(7)), 20.0)
    np.testing.assert_array_equal(lb, np.full(7, -np.inf))
    np.testing.assert_array_equal(ub, np.full(7, np.inf))


def paper_qp() -> QP:
    return DoubleIndicator().build_qp(paper_start(), near_target(paper_start().q, seed=1))


def test_bounds_as_inequalities_are_the_box() -> None:
    qp = paper_qp()
    omega, chi = bounds_as_rows(qp)
    np.testing.assert_array_equal(omega, np.vstack([np.eye(7), -np.eye(7)]))
    width = qp.ub - qp.lb
    points = np.random.default_rng(33).uniform(qp.lb - 0.05 * width, qp.ub + 0.05 * width, (500, 7))
    in_box = ((points >= qp.lb) & (points <= qp.ub)).all(axis=1)
    np.testing.assert_array_equal((points @ omega.T <= chi).all(axis=1), in_box)
    assert 100 < in_box.sum() < 400


def test_the_chi_that_the_paper_prints_is_another_set() -> None:
    # PAPER, slip 2: with chi = [ub; lb] standing still would be forbidden.
    qp = paper_qp()
    omega, _ = bounds_as_rows(qp)
    printed = np.concatenate([qp.ub, qp.lb])
    assert (qp.lb < 0.0).all()
    assert (qp.ub > 0.0).all()
    assert not (omega @ np.zeros(7) <= printed).all()
