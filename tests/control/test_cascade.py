"""Strict priorities beside a lexicographic solution by another solver."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import qpsolvers
import scipy.linalg
import scipy.sparse

from benchmarks.priorities import KINDS, PRIORITIES, SCHEME, compare, programs
from helpers_simulation import paper_robot
from iiwa_dnn.control.cascade import Cascade
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.references import Heart, Target
from iiwa_dnn.results.failures import failures
from iiwa_dnn.results.metrics import compute_metrics
from iiwa_dnn.results.report import write_report
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes import (
    ElbowAngleTask,
    JointLimits,
    KineticEnergy,
    OrientationTask,
    PositionTask,
    PostureTask,
    Scheme,
)
from iiwa_dnn.simulation import simulate

ROBOT = paper_robot()


def lexicographic(qp: QP, priorities: Vector) -> list[float] | None:
    """Level by level with another solver; returns the residual of each, None where it fails."""
    A, b, missing = np.zeros((0, 7)), np.zeros(0), []
    for level in (1, 2, 3):
        rows = priorities == level
        P, q = scipy.sparse.csc_matrix(qp.A[rows].T @ qp.A[rows]), -qp.A[rows].T @ qp.b[rows]
        equal = {"A": scipy.sparse.csc_matrix(A), "b": b} if len(A) else {}
        x = qpsolvers.solve_qp(
            P, q, **equal, lb=qp.lb, ub=qp.ub, solver="clarabel",
            tol_gap_abs=1e-12, tol_gap_rel=0.0, tol_feas=1e-12,
        )  # fmt: skip
        if x is None:
            return None
        missing.append(float(np.linalg.norm(qp.A[rows] @ x - qp.b[rows])))
        A = scipy.linalg.orth(qp.A[(priorities <= level)].T, rcond=1e-9).T
        b = A @ x
    return missing


def test_levels_of_conflicting_tasks_are_those_of_another_solver() -> None:
    rng, conflicts, compared = np.random.default_rng(11), 0, 0
    chosen, priorities = SCHEME, PRIORITIES
    for _ in range(60):
        q = rng.uniform(0.8 * ROBOT.q_lower, 0.8 * ROBOT.q_upper)
        conf = Configuration(ROBOT, q)
        far = conf.position + rng.uniform(-0.03, 0.03, 3)
        turned = Configuration(ROBOT, q + rng.uniform(-0.03, 0.03, 7)).rotation
        qp = chosen.build_qp(conf, Target(far, turned))
        expected = lexicographic(qp, priorities)
        if expected is None:
            continue
        cascade = Cascade(priorities, qp.sizes, 1e-10)
        cascade.resolve(qp)
        for level, residual in zip(cascade.levels, expected, strict=True):
            assert np.linalg.norm(level.missing) == pytest.approx(residual, abs=1e-8)
        compared += 1
        conflicts += sum(residual > 1e-3 for residual in expected)
        final = DNNSolver(tol=1e-9).solve(qp)
        assert final.found
        # A lower level disturbs no higher one.
        given = chosen.build_qp(conf, Target(far, turned))
        attained = [
            np.linalg.norm((given.A @ final.x - given.b)[priorities == k]) for k in (1, 2, 3)
        ]
        np.testing.assert_allclose(attained, expected, rtol=0, atol=1e-8)
    assert conflicts > 50
    assert compared > 50


def test_a_run_records_its_levels_and_checks_their_programs(tmp_path: Path) -> None:
    conf = Configuration(ROBOT, ROBOT.start_posture())
    wanted = ElbowAngleTask().angle_of(conf) + 0.5
    tasks = [
        PositionTask(priority=1),
        OrientationTask(priority=2),
        ElbowAngleTask(wanted, gain=1.0, priority=3),
        PostureTask({"iiwa7_joint_7": 1.0}, gain=1.0, priority=4),
    ]
    lexi = Scheme([KineticEnergy(weight=1.0)], tasks, [JointLimits()])
    record = simulate(ROBOT, lexi, Heart().anchored(conf), conf.q, dt=1e-3, duration=0.3)
    assert failures(record) == []
    assert record.level_residual is not None
    assert record.level_residual.shape == (300, 4)
    # Position and orientation fit, and leave one freedom for the elbow until its joints are at
    # their limits; nothing is left below.
    assert record.level_residual[:, :2].max() < 1e-8
    assert record.level_residual[:20, 2].max() < 1e-8
    assert record.level_residual[:, 3].min() > 0.05
    assert record.crosscheck_gap.max() < 1e-6
    metrics = compute_metrics(record)
    write_report(record, metrics, tmp_path)
    largest = record.level_residual[:, 3].max()
    assert metrics["level_residual"][3] == largest
    report = (tmp_path / "report.md").read_text()
    assert f"| largest residual, priority 4 | {largest:.6g} |" in report


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_levels_in_random_and_singular_poses_are_those_of_daqp(kind: str) -> None:
    compared = [compare(qp, PRIORITIES) for qp in programs(40, *KINDS[kind])]
    assert all(each.solved for each in compared)
    known = [each for each in compared if each.expected.size]
    assert len(known) >= 39  # DAQP gives up now and then
    assert max(each.gap for each in known) <= 1e-8
    assert sum((each.expected > 1e-3).sum() for each in known) > 40


def test_limits_that_a_level_uses_up_hold_for_the_levels_below() -> None:
    rng, priorities = np.random.default_rng(3), np.repeat([1, 2, 3], 3)
    held = known = unknown = 0
    for _ in range(100):
        A, x = rng.normal(size=(9, 7)), rng.uniform(-1.0, 1.0, 7)
        if rng.random() < 0.5:
            A[5] = A[:3].T @ rng.normal(size=3)  # a level that repeats a part of the one above
        G = rng.normal(size=(4, 7))
        h = G @ x + rng.uniform(0.0, 1.0, 4)
        qp = QP(np.eye(7), np.zeros(7), G, h, A, 4.0 * rng.normal(size=9), -np.ones(7), np.ones(7))
        lb, ub = qp.lb.copy(), qp.ub.copy()
        compared = compare(qp, priorities)
        assert compared.solved
        known += compared.gap <= 1e-8
        unknown += np.isnan(compared.gap)
        held += int((qp.lb == qp.ub).sum())
        assert (qp.lb >= lb).all()
        assert (qp.ub <= ub).all()
    assert known == 100 - unknown >= 98  # DAQP gives up now and then
    assert held > 100
