"""Schemes of the literature against their objectives, other solvers, and the next target."""

import numpy as np
import pinocchio as pin
import pytest
import scipy.optimize
from numpy.testing import assert_allclose, assert_array_equal

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0, Array
from helpers_simulation import near_target, paper_robot, paper_start, run
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.schemes.literature import bi_criteria

HOME = tuple(np.add(PAPER_Q0, (0.3, -0.1, 0.2, -0.4, 0.05, 0.6, -0.2)))
MOVING = d.Target(paper_start().position, paper_start().rotation, np.array([0.02, -0.03, 0.01]))
DT = 1e-3
PATH = d.Tilting(d.Heart(), 0.3, (0.3, 1.0, -0.2)).anchored(paper_start())


def inertia(q: Array) -> Array:
    """The inertia matrix, column by column through inverse dynamics at rest."""
    model = paper_robot().model
    data = model.createData()
    rest = np.zeros(7)
    gravity = pin.rnea(model, data, q, rest, rest).copy()
    return np.column_stack([pin.rnea(model, data, q, rest, e) - gravity for e in np.eye(7)])


@pytest.mark.parametrize("kinetic", ["identity", "inertia"])
@pytest.mark.parametrize("weight", [0.0, 0.2, 0.7, 1.0])
def test_objective_is_the_papers_up_to_a_constant(weight: float, kinetic: str) -> None:
    scheme = d.DoubleIndicator(weight=weight, kinetic=kinetic, drift_gain=3.7, home=HOME)
    rng = np.random.default_rng(1)
    for q in rng.uniform(-2.5, 2.5, (5, 7)):
        qp = scheme.build_qp(d.Configuration(paper_robot(), q), near_target(q, seed=2))
        metric = inertia(q) if kinetic == "inertia" else np.eye(7)
        excess = []
        for dq in rng.normal(size=(10, 7)):
            # Equation (6) as the paper writes it, before it is expanded.
            drift = dq + 3.7 * (q - np.array(HOME))
            paper = 0.5 * (weight * dq @ metric @ dq + (1.0 - weight) * drift @ drift)
            excess.append(0.5 * dq @ qp.P @ dq + qp.q @ dq - paper)
        assert_allclose(excess, excess[0], rtol=1e-10, atol=1e-10)


def test_without_a_home_nothing_pulls_and_anchoring_gives_one() -> None:
    elsewhere = d.Configuration(paper_robot(), np.array(PAPER_Q0) + 0.2)
    target = near_target(elsewhere.q, seed=4)
    scheme = d.DoubleIndicator()
    assert_array_equal(scheme.build_qp(elsewhere, target).q, np.zeros(7))
    anchored = scheme.anchored(paper_start())
    assert anchored.home == PAPER_Q0
    assert_allclose(anchored.build_qp(elsewhere, target).q, 0.8 * 10.2 * 0.2, rtol=1e-12)
    assert scheme.home is None
    assert anchored.anchored(elsewhere) == anchored
    assert d.DoubleIndicator(home=HOME).anchored(paper_start()).home == HOME


def test_the_papers_rows_are_dependent_and_still_solved() -> None:
    # Seven rows of rank six: J' has four rows of rank three.
    target = near_target(PAPER_Q0, seed=10, size=0.0)
    qp = d.DoubleIndicator(orientation="block", home=HOME).build_qp(paper_start(), target)
    values = np.linalg.svd(qp.A, compute_uv=False)
    assert values[6] < 1e-14
    assert values[5] == pytest.approx(0.075, abs=5e-4)  # PAPER: at theta(0)
    assert values[0] == pytest.approx(2.54, abs=5e-3)
    answer = d.DNNSolver().solve(qp)
    assert answer.found
    # Least squares on the null space of the rows, through numpy alone.
    null = np.linalg.svd(qp.A)[2][6:].T
    assert_allclose(answer.x, -null @ (null.T @ qp.q), rtol=0, atol=1e-8)


@pytest.mark.parametrize("kinetic", ["identity", "inertia"])
def test_kinetic_index(kinetic: str) -> None:
    dq = np.random.default_rng(11).normal(size=7)
    model = paper_robot().model
    energy = pin.computeKineticEnergy(model, model.createData(), np.array(PAPER_Q0), dq)
    expected = 2.0 * energy if kinetic == "inertia" else dq @ dq
    index = d.DoubleIndicator(kinetic=kinetic).kinetic_index(paper_start(), dq)
    assert index == pytest.approx(expected, rel=1e-12)


def test_settings_are_plain_values_and_make_the_scheme_again() -> None:
    scheme = d.DoubleIndicator(weight=0.4, kinetic="inertia", home=HOME)
    settings = scheme.settings()
    assert settings.pop("name") == "double-indicator"
    assert d.DoubleIndicator(**settings) == scheme


def test_the_largest_speed_is_that_of_a_linear_program() -> None:
    qp = bi_criteria(paper_robot(), 0.0).build_qp(paper_start(), MOVING)
    speed = np.abs(d.DNNSolver().solve(qp).x[:7]).max()
    rows = np.hstack([np.vstack([np.eye(7), -np.eye(7)]), -np.ones((14, 1))])
    bounds = [*zip(qp.lb[:7], qp.ub[:7], strict=True), (0.0, None)]
    best = scipy.optimize.linprog(np.eye(8)[-1], rows, np.zeros(14), qp.A, qp.b, bounds)
    assert best.success
    # The little of the norm that makes the answer unique costs a little of the speed.
    assert best.fun <= speed + 1e-9
    assert speed <= 1.01 * best.fun
    between = bi_criteria(paper_robot(), 0.3).build_qp(paper_start(), MOVING)
    assert_array_equal(between.P, np.diag([0.3] * 7 + [0.7]))


@pytest.mark.parametrize("gain", [np.inf, 300.0, 5e3])
def test_the_rows_ask_for_the_next_target(gain: float) -> None:
    q = np.array(PAPER_Q0) + 0.1 * np.random.default_rng(3).normal(size=7)
    conf, t = d.Configuration(paper_robot(), q), 1.7
    scheme = d.DoubleIndicator(home=PAPER_Q0, sample="end")
    if gain < np.inf:
        scheme = d.DoubleIndicator(home=PAPER_Q0, position_gain=gain, orientation_gain=gain)
    qp = scheme.build_qp(conf, PATH.feed_forward(DT).at(t), DT)
    now, then = PATH.at(t), PATH.at(t + DT)
    left = 1.0 - min(gain * DT, 1.0)
    moved = then.position - conf.position - left * (now.position - conf.position)
    assert_allclose(DT * qp.b[:3], moved, rtol=0, atol=1e-14)
    # Rotations do not add: the turn of a period times the error is left, here 3e-4 times 0.2 rad.
    errors = [pin.log3(target.rotation @ conf.rotation.T) for target in (now, then)]
    assert_allclose(DT * qp.b[3:], errors[1] - left * errors[0], rtol=0, atol=6e-5)


def test_the_error_towards_the_next_target_is_of_second_order_and_does_not_add_up() -> None:
    largest = []
    for dt in (2e-3, 1e-3):
        record = run(d.DoubleIndicator(sample="end"), PATH, dt=dt, duration=1.6)
        settled = record.t > 0.1
        distance = np.linalg.norm(position_error(record), axis=1)
        largest.append((distance[settled].max(), orientation_error(record)[settled].max()))
    assert_allclose(np.divide(*largest), 4.0, rtol=0.05)
    assert largest[1][0] < 4e-9
