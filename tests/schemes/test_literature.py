"""Schemes of the literature against their objectives, other solvers and a linear program."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
import scipy.optimize

from helpers_kinematics import PAPER_Q0, Array
from helpers_simulation import heart, near_target, paper_robot, paper_start, solve_by
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.problems import solve_problem
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.program import QP
from iiwa_dnn.references import Target
from iiwa_dnn.results.failures import failures
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.schemes.literature import bi_criteria
from iiwa_dnn.simulation import simulate

WEIGHTS = (0.0, 0.2, 0.7, 1.0)
HOME = tuple(np.add(PAPER_Q0, (0.3, -0.1, 0.2, -0.4, 0.05, 0.6, -0.2)))


def inertia(q: Array) -> Array:
    """The inertia matrix, column by column through inverse dynamics at rest."""
    model = paper_robot().model
    data = model.createData()
    rest = np.zeros(7)
    gravity = pin.rnea(model, data, q, rest, rest).copy()
    return np.column_stack([pin.rnea(model, data, q, rest, e) - gravity for e in np.eye(7)])


def paper_objective(scheme: DoubleIndicator, q: Array, dq: Array) -> float:
    """Equation (6) as the paper writes it, before it is expanded."""
    metric = inertia(q) if scheme.kinetic == "inertia" else np.eye(7)
    drift = dq + scheme.drift_gain * (q - np.array(scheme.home))
    return 0.5 * (scheme.weight * dq @ metric @ dq + (1.0 - scheme.weight) * drift @ drift)


def qp_objective(qp: QP, dq: Array) -> float:
    return 0.5 * dq @ qp.P @ dq + qp.q @ dq


@pytest.mark.parametrize("kinetic", ["identity", "inertia"])
@pytest.mark.parametrize("weight", WEIGHTS)
def test_objective_is_the_papers_up_to_a_constant(weight: float, kinetic: str) -> None:
    scheme = DoubleIndicator(weight=weight, kinetic=kinetic, drift_gain=3.7, home=HOME)
    rng = np.random.default_rng(1)
    for q in rng.uniform(-2.5, 2.5, (5, 7)):
        qp = scheme.build_qp(Configuration(paper_robot(), q), near_target(q, seed=2))
        for one, other in rng.normal(size=(10, 2, 7)):
            expected = paper_objective(scheme, q, one) - paper_objective(scheme, q, other)
            difference = qp_objective(qp, one) - qp_objective(qp, other)
            assert difference == pytest.approx(expected, rel=1e-10, abs=1e-10)


def test_without_a_home_nothing_pulls_and_anchoring_gives_one() -> None:
    elsewhere = Configuration(paper_robot(), np.array(PAPER_Q0) + 0.2)
    target = near_target(elsewhere.q, seed=4)
    scheme = DoubleIndicator()
    np.testing.assert_array_equal(scheme.build_qp(elsewhere, target).q, np.zeros(7))
    anchored = scheme.anchored(paper_start())
    assert anchored.home == PAPER_Q0
    np.testing.assert_allclose(anchored.build_qp(elsewhere, target).q, 0.8 * 10.2 * 0.2, rtol=1e-12)
    assert scheme.home is None
    assert anchored.anchored(elsewhere) == anchored
    assert DoubleIndicator(home=HOME).anchored(paper_start()).home == HOME


@pytest.mark.parametrize(("orientation", "rows"), [("so3", 6), ("block", 7), ("none", 3)])
def test_rows_are_the_position_task_then_the_orientation(orientation: str, rows: int) -> None:
    rng = np.random.default_rng(5)
    q = rng.uniform(-2.0, 2.0, 7)
    conf, target = Configuration(paper_robot(), q), near_target(q, seed=6)
    qp = DoubleIndicator(position_gain=4.0, orientation=orientation).build_qp(conf, target)
    assert qp.A.shape == (rows, 7)
    assert qp.G.shape == (0, 7)
    np.testing.assert_allclose(qp.A[:3], conf.jacobian[:3], rtol=0, atol=1e-15)
    expected = target.linear_velocity + 4.0 * (target.position - conf.position)
    np.testing.assert_allclose(qp.b[:3], expected, rtol=1e-14)
    assert (qp.lb < qp.ub).all()
    qp.check_values()


def test_other_solvers_give_the_networks_answer_where_velocity_bounds_bind() -> None:
    scheme = DoubleIndicator(orientation="none", home=PAPER_Q0)
    rng = np.random.default_rng(9)
    bound = 0
    for seed in range(10):
        q = np.array(PAPER_Q0) + 0.02 * rng.standard_normal(7)
        target = near_target(q, seed, size=0.01)
        free = solve_problem(scheme.build_qp(Configuration(paper_robot(), q), target)).x
        robot = paper_robot().with_limits(velocity=0.8 * np.abs(free).max())
        qp = scheme.build_qp(Configuration(robot, q), target)
        answer = DNNSolver().solve(qp)
        assert answer.found
        bound += int((np.abs(answer.x) >= qp.ub[0] - 1e-9).sum())
        for solver in ("proxqp", "osqp"):
            np.testing.assert_allclose(answer.x, solve_by(solver, qp), rtol=0, atol=1e-7)
    assert bound >= 10


def test_the_papers_rows_are_dependent_and_still_solved() -> None:
    # Seven rows of rank six: J' has four rows of rank three.
    qp = DoubleIndicator(orientation="block", home=HOME).build_qp(
        paper_start(), near_target(PAPER_Q0, seed=10, size=0.0)
    )
    values = np.linalg.svd(qp.A, compute_uv=False)
    assert values[6] < 1e-14
    assert values[5] == pytest.approx(0.075, abs=5e-4)  # PAPER: at theta(0)
    assert values[0] == pytest.approx(2.54, abs=5e-3)
    answer = DNNSolver().solve(qp)
    assert answer.found
    # Least squares on the null space of the rows, through numpy alone.
    null = np.linalg.svd(qp.A)[2][6:].T
    expected = -null @ (null.T @ qp.q)
    np.testing.assert_allclose(answer.x, expected, rtol=0, atol=1e-8)


@pytest.mark.parametrize("kinetic", ["identity", "inertia"])
def test_kinetic_index(kinetic: str) -> None:
    dq = np.random.default_rng(11).normal(size=7)
    model = paper_robot().model
    energy = pin.computeKineticEnergy(model, model.createData(), np.array(PAPER_Q0), dq)
    expected = 2.0 * energy if kinetic == "inertia" else dq @ dq
    index = DoubleIndicator(kinetic=kinetic).kinetic_index(paper_start(), dq)
    assert index == pytest.approx(expected, rel=1e-12)


def test_settings_are_plain_values_and_make_the_scheme_again() -> None:
    scheme = DoubleIndicator(weight=0.4, kinetic="inertia", home=HOME)
    settings = scheme.settings()
    assert settings.pop("name") == "double-indicator"
    assert DoubleIndicator(**settings) == scheme


MOVING = Target(
    paper_start().position, paper_start().rotation, np.array([0.02, -0.03, 0.01]), np.zeros(3)
)


def test_the_largest_speed_is_that_of_a_linear_program() -> None:
    qp = bi_criteria(paper_robot(), 0.0).build_qp(paper_start(), MOVING)
    speed = np.abs(DNNSolver().solve(qp).x[:7]).max()
    rows = np.hstack([np.vstack([np.eye(7), -np.eye(7)]), -np.ones((14, 1))])
    best = scipy.optimize.linprog(
        np.eye(8)[-1], A_ub=rows, b_ub=np.zeros(14), A_eq=qp.A, b_eq=qp.b,
        bounds=[*zip(qp.lb[:7], qp.ub[:7], strict=True), (0.0, None)],
    )  # fmt: skip
    assert best.success
    # The little of the norm that makes the answer unique costs a little of the speed.
    assert best.fun <= speed + 1e-9
    assert speed <= 1.01 * best.fun


def test_between_both_criteria_neither_is_the_best() -> None:
    velocity = DoubleIndicator(weight=1.0)
    schemes = [bi_criteria(paper_robot(), 0.0), bi_criteria(paper_robot(), 0.5), velocity]
    answers = [
        DNNSolver(tol=1e-11).solve(each.build_qp(paper_start(), MOVING)).x[:7] for each in schemes
    ]
    largest = [np.abs(dq).max() for dq in answers]
    norms = [np.linalg.norm(dq) for dq in answers]
    assert largest[0] <= largest[1] + 1e-9 < largest[2]
    assert norms[2] < norms[1] <= norms[0] + 1e-9


def test_the_heart_is_drawn_and_a_weight_outside_is_named() -> None:
    record = simulate(
        paper_robot(),
        bi_criteria(paper_robot(), 0.0),
        heart(),
        paper_start().q,
        dt=1e-2,
        duration=2.0,
    )
    assert failures(record) == []
    with pytest.raises(InvalidInputError, match=r"^weight"):
        bi_criteria(paper_robot(), 1.5)
