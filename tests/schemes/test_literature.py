"""Schemes of the literature: their largest joint speed beside a linear program's."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.optimize

from helpers_simulation import heart, paper_robot, paper_start
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.references import Target
from iiwa_dnn.results.failures import failures
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.schemes.literature import bi_criteria
from iiwa_dnn.simulation import simulate

ROBOT, START = paper_robot(), paper_start()
MOVING = Target(START.position, START.rotation, np.array([0.02, -0.03, 0.01]), np.zeros(3))


def test_the_largest_speed_is_that_of_a_linear_program() -> None:
    qp = bi_criteria(ROBOT, 0.0).build_qp(START, MOVING)
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
    schemes = [bi_criteria(ROBOT, 0.0), bi_criteria(ROBOT, 0.5), velocity]
    answers = [DNNSolver(tol=1e-11).solve(each.build_qp(START, MOVING)).x[:7] for each in schemes]
    largest = [np.abs(dq).max() for dq in answers]
    norms = [np.linalg.norm(dq) for dq in answers]
    assert largest[0] <= largest[1] + 1e-9 < largest[2]
    assert norms[2] < norms[1] <= norms[0] + 1e-9


def test_the_heart_is_drawn_and_a_weight_outside_is_named() -> None:
    record = simulate(ROBOT, bi_criteria(ROBOT, 0.0), heart(), START.q, dt=1e-2, duration=2.0)
    assert failures(record) == []
    with pytest.raises(InvalidInputError, match=r"^weight"):
        bi_criteria(ROBOT, 1.5)
