"""Programs composed of parts: built-in ones, parts of one's own, slack variables, costs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from helpers_kinematics import PAPER_Q0, Array, finite_difference
from helpers_simulation import heart, near_target, paper_robot, paper_start, run
from iiwa_dnn import (
    Configuration,
    Cost,
    CrossCheck,
    CyclicMotion,
    DoubleIndicator,
    JointLimits,
    KineticEnergy,
    Limit,
    Manipulability,
    OrientationTask,
    PoseTask,
    PositionTask,
    PseudoInverse,
    Scheme,
    Step,
    Target,
    Task,
    failures,
    load_robot,
)

ELBOW = "iiwa7_link_4"


def composed(**gains: Any) -> Scheme:
    return Scheme(
        costs=[KineticEnergy(weight=0.2), CyclicMotion(weight=0.8, gain=10.2, home=PAPER_Q0)],
        tasks=[PositionTask(), OrientationTask()],
        limits=[JointLimits(gain=20.0)],
    )


@dataclass(frozen=True)
class NumpyPosition(Task):
    """The position task once more, with numpy."""

    rows: int = 3
    gain: float = 10.2
    weight: float | None = None

    def equations(self, step: Step) -> tuple[Array, Array]:
        tip, target = step.frame(), step.target()
        error = target.position - tip.position
        return tip.jacobian[:3], target.linear_velocity + self.gain * error


class NumpyEnergy(Cost):
    def quadratic(self, step: Step) -> tuple[Array, Array]:
        return 0.7 * step.inertia, np.zeros(step.q.size)


class NumpyBounds(Limit):
    """Bounds alone: no joint is faster than 0.1 rad/s."""

    def bounds(self, step: Step) -> tuple[Array, Array]:
        return np.full(step.q.size, -0.1), np.full(step.q.size, 0.1)


class Clearance(Limit):
    """Keep the elbow away from a point, as a velocity damper: -n' J dq <= gain (d - distance)."""

    rows = 1

    def __init__(self, point: Array, distance: float, gain: float = 20.0) -> None:
        self.point, self.distance, self.gain = point, distance, gain

    def inequalities(self, step: Step) -> tuple[Array, Array]:
        elbow = step.frame(ELBOW)
        away = elbow.position - self.point
        distance = np.linalg.norm(away)
        row = -(away / distance) @ elbow.jacobian[:3]
        return row[np.newaxis], np.array([self.gain * (distance - self.distance)])


def elbow_distance(q: Array, point: Array) -> Array:
    robot = paper_robot()
    places = [Configuration(robot, posture).frame(ELBOW).position for posture in q]
    return np.linalg.norm(np.array(places) - point, axis=1)


def test_the_papers_scheme_is_its_parts() -> None:
    conf, target = paper_start(), near_target(PAPER_Q0, 1)
    whole = DoubleIndicator(home=PAPER_Q0).build_qp(conf, target)
    parts = composed().build_qp(conf, target)
    assert_array_equal(parts.data, whole.data)
    assert parts.sizes == whole.sizes == (7, 0, 6)
    pinv = Scheme([KineticEnergy()], [PositionTask(), OrientationTask()]).build_qp(conf, target)
    assert_array_equal(pinv.data, PseudoInverse().build_qp(conf, target).data)


@pytest.mark.parametrize("task", [PositionTask(weight=3.0), NumpyPosition(weight=3.0)])
def test_a_soft_task_is_a_term_of_the_cost(task: Task) -> None:
    conf, target = paper_start(), near_target(PAPER_Q0, 1)
    qp = Scheme([KineticEnergy(weight=0.5)], [task]).build_qp(conf, target)
    hard = Scheme([KineticEnergy(weight=0.5)], [PositionTask()]).build_qp(conf, target)
    assert qp.sizes == (7, 0, 0)
    assert_allclose(qp.P, 0.5 * np.eye(7) + 3.0 * hard.A.T @ hard.A, rtol=0, atol=1e-14)
    assert_allclose(qp.q, -3.0 * hard.A.T @ hard.b, rtol=0, atol=1e-14)


def test_costs_and_bounds_of_ones_own_join_the_others() -> None:
    conf, target = paper_start(), near_target(PAPER_Q0, 1)
    scheme = Scheme(
        [CyclicMotion(weight=0.3, home=PAPER_Q0), NumpyEnergy()],
        [PositionTask()],
        [JointLimits(), NumpyBounds()],
    )
    qp = scheme.build_qp(conf, target)
    assert_allclose(qp.P, 0.3 * np.eye(7) + 0.7 * conf.inertia, rtol=0, atol=1e-13)
    assert_array_equal(qp.ub, np.full(7, 0.1))
    assert_array_equal(qp.lb, np.full(7, -0.1))


def test_an_inequality_row_is_kept_over_a_whole_run_and_every_step_checked() -> None:
    point = paper_start().frame(ELBOW).position + [0.08, 0.06, 0.0]
    nearest = float(np.linalg.norm(paper_start().frame(ELBOW).position - point))
    limit = Clearance(point, nearest - 0.004)
    base = composed()
    scheme = Scheme(base.costs, base.tasks, [*base.limits, limit])
    free = run(base, reference=heart(period=4.0), duration=4.0, dt=1e-2)
    assert elbow_distance(free.q, point).min() < limit.distance - 1e-3
    record = run(scheme, reference=heart(period=4.0), duration=4.0, dt=2e-3, check=CrossCheck())
    assert failures(record) == []
    assert elbow_distance(record.q, point).min() > limit.distance - 1e-6
    active = record.row_multiplier[:, 0] > 0.0
    assert 50 < active.sum() < 2000
    assert record.settings["rows"] == [{"part": "Clearance", "row": 1}]


def test_parts_serve_another_robot() -> None:
    robot = load_robot("iiwa7", locked=("iiwa7_joint_3",))
    q0 = np.delete(PAPER_Q0, 2)
    conf = Configuration(robot, q0)
    scheme = Scheme([KineticEnergy()], [PositionTask(), NumpyPosition(weight=0.1)], [JointLimits()])
    qp = scheme.build_qp(conf, Target(conf.position, conf.rotation))
    assert qp.sizes == (6, 0, 3)
    assert_allclose(qp.A, conf.jacobian[:3], rtol=0, atol=1e-15)


def test_anchoring_gives_every_part_its_home_and_leaves_the_scheme_alone() -> None:
    scheme = Scheme([KineticEnergy(), CyclicMotion()], [PositionTask()])
    anchored = scheme.anchored(paper_start())
    assert anchored.costs[1].home == PAPER_Q0
    assert scheme.costs[1].home is None
    assert anchored.anchored(paper_start()) is anchored
    assert anchored.settings()["costs"][1] == {
        "name": "CyclicMotion", "weight": 1.0, "gain": 10.2, "home": PAPER_Q0
    }  # fmt: skip


ROBOT = paper_robot()
START = Configuration(ROBOT, [-1.2, -0.6, 0.3, 1.4, 0.2, -0.9, 0.4])


def measure(q: np.ndarray) -> float:
    J = Configuration(ROBOT, q).jacobian
    return float(np.sqrt(np.linalg.det(J @ J.T)))


def test_manipulability_gradient_is_that_of_finite_differences() -> None:
    qp = Scheme([Manipulability(weight=2.0)]).build_qp(START, Target(START.position))
    expected = finite_difference(lambda q: np.array([measure(q)]), START.q)[0]
    np.testing.assert_allclose(qp.q, -2.0 * expected, atol=1e-7)
    assert not qp.P.any()


def test_parts_leave_slack_variables_out() -> None:
    scheme = Scheme([CyclicMotion(), Manipulability()], [PoseTask()], [JointLimits()], slack=2)
    qp = scheme.build_qp(START, Target(START.position, START.rotation))
    np.testing.assert_array_equal(qp.A[:, 7:], 0.0)
    np.testing.assert_allclose(qp.A[:, :7], START.jacobian, rtol=0, atol=1e-15)


@pytest.mark.parametrize("weight", [0.5, 2.0])
def test_the_pull_home_is_the_gradient_of_a_square(weight: float) -> None:
    home = tuple(START.q - 0.1)
    cost = CyclicMotion(weight=weight, gain=3.0, home=home)
    qp = Scheme([cost]).build_qp(START, Target(START.position))
    np.testing.assert_array_equal(qp.P, weight * np.eye(7))
    np.testing.assert_allclose(qp.q, weight * 3.0 * 0.1, rtol=1e-12)
