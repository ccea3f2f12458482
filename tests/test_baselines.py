"""Baselines of the benchmarks, which a comparison has to be fair to."""

import numpy as np
import pytest
from scipy.optimize import linprog

import iiwa_dnn
from benchmarks import sns
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot


def test_saturation_keeps_its_bounds_and_the_direction_of_the_task() -> None:
    rng = np.random.default_rng(0)
    whole = []
    for _ in range(200):
        n = int(rng.integers(3, 9))
        m = int(rng.integers(1, n))
        J, task = rng.standard_normal((m, n)), rng.standard_normal(m)
        lower, upper = -rng.uniform(0.1, 1.0, n), rng.uniform(0.1, 1.0, n)
        dq, scale = sns.saturate(J, task, lower, upper)
        np.testing.assert_allclose(J @ dq, scale * task, atol=1e-8)
        assert (lower <= dq).all()
        assert (dq <= upper).all()
        # The largest scale that any joint velocity has.
        best = linprog(
            np.append(np.zeros(n), -1.0),
            A_eq=np.column_stack([J, -task]),
            b_eq=np.zeros(m),
            bounds=[*zip(lower, upper, strict=True), (0.0, 1.0)],
        )
        assert scale <= -best.fun + 1e-9
        whole.append((scale, -best.fun))
    found, possible = np.transpose(whole)
    # Its first form does not always find the largest scale; wherever the whole task fits, it does.
    assert np.median(found / possible) > 0.99
    assert (found[possible > 1.0 - 1e-9] > 1.0 - 1e-9).mean() > 0.95
    assert (possible < 0.99).sum() > 50


def test_saturation_in_one_redundant_joint_by_hand() -> None:
    # Two joints in line: the first is limited to 0.2, the second takes over what is left of 1.
    dq, scale = sns.saturate(
        np.array([[1.0, 1.0]]), np.array([1.0]), np.full(2, -2.0), np.array([0.2, 2.0])
    )
    np.testing.assert_allclose(dq, [0.2, 0.8])
    assert scale == 1.0
    dq, scale = sns.saturate(
        np.array([[1.0, 1.0]]), np.array([1.0]), np.full(2, -2.0), np.array([0.2, 0.3])
    )
    np.testing.assert_allclose(dq, [0.2, 0.3])
    assert scale == pytest.approx(0.5)


def test_without_active_bounds_saturation_is_the_pseudo_inverse() -> None:
    robot = paper_robot()
    conf = iiwa_dnn.Configuration(robot, paper.START)
    target = iiwa_dnn.Heart().anchored(conf).at(1.0)
    J, task = sns.task_of(conf, target, 6)
    dq, _ = sns.saturate(J, task, *sns.bounds(robot, conf.q, 1e-3))
    qp = iiwa_dnn.PseudoInverse().build_qp(conf, target)
    np.testing.assert_allclose(dq, iiwa_dnn.solve_problem(qp).x, atol=1e-8)


def test_a_hostile_run_of_both_is_judged(monkeypatch) -> None:
    monkeypatch.setattr(sns, "RUNS", 1)
    monkeypatch.setattr(sns, "STEPS", 30)
    cases = sns.draw_cases()
    own, other = (
        sns.hostile_row(make, cases) for make in (sns.hostile_controller, sns.hostile_saturation)
    )
    assert own["acceleration"] == 0
    assert other["jerk"] >= own["jerk"]


def test_arrival_counts_the_last_period_away_from_the_goal(monkeypatch) -> None:
    pytest.importorskip("ruckig")
    pytest.importorskip("pylibfranka")
    from benchmarks import arrivals

    goal = np.ones(2)
    path = [np.zeros(2), goal, np.array([1.0, 0.99]), goal + 5e-4, goal]
    assert arrivals.arrival(path, goal, 0.1) == pytest.approx(0.3)
    assert arrivals.arrival([goal], goal, 0.1) == 0.0
    # Nothing is quicker than a time-optimal motion by the same rule.
    monkeypatch.setattr(arrivals, "GOALS", 3)
    found = arrivals.arrivals("iiwa7")
    assert 1.0 <= found["least"] <= found["median"] <= found["most"] < 1.02
