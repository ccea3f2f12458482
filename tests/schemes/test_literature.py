"""Schemes of the literature: each is best at what it minimises, among all that draw the path."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest
import scipy.linalg
import scipy.optimize

from helpers_simulation import heart, paper_robot, paper_start
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.references import Target
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.record import Record
from iiwa_dnn.schemes import JointTorque, Scheme
from iiwa_dnn.schemes.literature import (
    bi_criteria,
    infinity_norm,
    minimum_acceleration_norm,
    minimum_torque,
    minimum_velocity_norm,
    repetitive_motion,
)
from iiwa_dnn.simulation import simulate

ROBOT, START = paper_robot(), paper_start()
SCHEMES = {
    "velocity": minimum_velocity_norm(),
    "repetitive": repetitive_motion(),
    "infinity": infinity_norm(ROBOT),
    "both": bi_criteria(ROBOT, 0.5),
    "acceleration": minimum_acceleration_norm(),
}


def run(scheme: Scheme) -> Record:
    record = simulate(ROBOT, scheme, heart(), START.q, dt=1e-2, duration=10.0)
    assert failures(record) == []
    return record


@pytest.mark.long
def test_each_scheme_is_the_best_at_what_it_minimises() -> None:
    records = {name: run(scheme) for name, scheme in SCHEMES.items()}
    for record in records.values():
        assert compute_metrics(record)["max_position_error_m"] < 5e-5
    moving = Target(START.position, START.rotation, np.array([0.02, -0.03, 0.01]), np.zeros(3))
    first = {
        name: DNNSolver(tol=1e-11).solve(scheme.build_qp(START, moving)).x[:7]
        for name, scheme in SCHEMES.items()
    }
    norm = {name: np.linalg.norm(dq) for name, dq in first.items()}
    largest = {name: np.abs(dq).max() for name, dq in first.items()}
    assert norm["velocity"] <= min(norm.values()) + 1e-9
    assert largest["infinity"] <= min(largest.values()) + 1e-9
    assert largest["infinity"] <= largest["both"] + 1e-9 < largest["velocity"]
    assert norm["velocity"] < norm["both"] <= norm["infinity"] + 1e-9
    drift = {name: np.abs(r.q[-1] - r.q[0]).max() for name, r in records.items()}
    assert drift["repetitive"] < 0.1 * drift["velocity"]
    change = {name: np.square(np.diff(r.dq, axis=0)).sum() for name, r in records.items()}
    assert change["acceleration"] < change["velocity"]


def test_the_largest_speed_is_that_of_a_linear_program() -> None:
    target = Target(START.position, START.rotation, np.array([0.02, -0.03, 0.01]), np.zeros(3))
    qp = infinity_norm(ROBOT).build_qp(START, target)
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


def test_a_weight_outside_is_named() -> None:
    with pytest.raises(InvalidInputError, match=r"^weight"):
        bi_criteria(ROBOT, 1.5)


def test_least_torque_is_that_of_a_least_squares_problem() -> None:
    """The torque of the velocity's change, by Pinocchio, in the null space of the tasks."""
    dt = 1e-3
    dq = 0.2 * np.random.default_rng(0).standard_normal(7)
    target = Target(START.position, START.rotation, np.array([0.02, -0.03, 0.01]), np.zeros(3))
    scheme = Scheme([JointTorque()], minimum_torque().tasks)
    x = DNNSolver(tol=1e-11).solve(scheme.build_qp(START, target, dt, dq)).x
    J = START.jacobian
    free = scipy.linalg.null_space(J)
    some = np.linalg.pinv(J) @ target.data[12:]
    model = ROBOT.model
    data = model.createData()
    torque = pin.rnea(model, data, START.q, dq, (some - dq) / dt)
    by_free = START.inertia @ free / dt
    least = some - free @ np.linalg.lstsq(by_free, torque, rcond=None)[0]
    np.testing.assert_allclose(x, least, rtol=0, atol=1e-7)
