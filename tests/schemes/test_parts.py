"""Programs composed of parts: built-in ones, parts of one's own, slack variables, costs."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0, Array, finite_difference
from helpers_simulation import beside, near_target, own, paper_robot, paper_start, run

NEAR = near_target(PAPER_Q0, 1)
START = d.Configuration(paper_robot(), [-1.2, -0.6, 0.3, 1.4, 0.2, -0.9, 0.4])
HERE = d.Target(START.position, START.rotation)
ZEROS, ROW = np.zeros(7), np.ones((1, 7))
CROSSED = own(d.Limit, bounds=(ZEROS + 5.0, ZEROS + np.inf))


def test_the_papers_scheme_is_its_parts() -> None:
    gains = {"position_gain": 4.0, "orientation_gain": 5.0}
    whole = d.DoubleIndicator(home=PAPER_Q0, limit_gain=6.0, **gains).build_qp(paper_start(), NEAR)
    costs = [d.KineticEnergy(weight=0.2), d.CyclicMotion(weight=0.8, home=PAPER_Q0)]
    tasks = [d.PositionTask(gain=4.0), d.OrientationTask(gain=5.0)]
    parts = d.Scheme(costs, tasks, [d.JointLimits(gain=6.0)]).build_qp(paper_start(), NEAR)
    assert_array_equal(parts.data, whole.data)
    assert parts.sizes == whole.sizes == (7, 0, 6)
    pinv = d.Scheme([d.KineticEnergy()], tasks).build_qp(paper_start(), NEAR)
    assert_array_equal(pinv.data, d.PseudoInverse(**gains).build_qp(paper_start(), NEAR).data)


def test_a_soft_task_is_a_term_of_the_cost() -> None:
    qp, hard = (
        d.Scheme([d.KineticEnergy(weight=0.5)], [task]).build_qp(paper_start(), NEAR)
        for task in (d.PositionTask(weight=3.0), d.PositionTask())
    )
    assert qp.sizes == (7, 0, 0)
    assert_allclose(qp.P, 0.5 * np.eye(7) + 3.0 * hard.A.T @ hard.A, rtol=0, atol=1e-14)
    assert_allclose(qp.q, -3.0 * hard.A.T @ hard.b, rtol=0, atol=1e-14)


@pytest.mark.parametrize("policy", ["slow", "relax", "stop"])
@pytest.mark.parametrize(
    ("part", "blamed"),
    [
        (
            own(d.Limit, 1, inequalities=(ROW, [-20.0])),
            "row 1 of Own, iiwa7_joint_2 lower velocity limit",
        ),
        (own(d.Limit, 1, inequalities=(0.0 * ROW, [-1.0])), "row 1 of Own"),
        (CROSSED, "iiwa7_joint_1 lower bound of Own"),
        (
            own(d.Task, 1, equations=(0.0 * ROW, [1.0])),
            "no bound, but a singular posture, a path out of reach or conflicting tasks",
        ),
    ],
)
def test_a_part_that_nothing_fulfils_is_named(part, blamed, policy, capfd) -> None:
    record = run(beside(part), duration=0.01, check=d.CrossCheck(("osqp",)), policy=policy)
    assert any(f"limited most often by {blamed}" in reason for reason in d.failures(record))
    assert capfd.readouterr().out == ""  # OSQP has its own words for such programs
    # A row that asks for motion is followed as far as the joints can; bounds that contradict each
    # other stop the arm.
    if part is CROSSED or policy == "stop":
        assert record.dq.shape == (1, 7)
        assert not record.dq.any()
    else:
        assert record.steps == 10


def test_an_active_bound_of_ones_own_is_no_position_limit() -> None:
    quick = own(d.Limit, bounds=(ZEROS + 0.1, ZEROS + 0.2))
    record = run(d.Scheme([d.KineticEnergy()], [], [d.JointLimits(), quick]), duration=0.01)
    assert_allclose(record.dq, 0.1, rtol=1e-9)
    active = d.compute_metrics(record)["incidents"]["active"]
    assert {bound["limit"] for bound in active} == {"bound of Own"}


@pytest.mark.parametrize("weight", [None, 1.0])
def test_without_a_cost_answers_agree_in_what_is_weighed(weight: float | None) -> None:
    # Four directions of seven are free: references choose other points of the same cost.
    scheme = d.Scheme([], [d.PositionTask(weight=weight)], [d.JointLimits()])
    record = run(scheme, duration=0.02, check=d.CrossCheck(("proxqp", "osqp")))
    assert d.failures(record) == []


def test_manipulability_gradient_is_that_of_finite_differences() -> None:
    def measure(q: Array) -> float:
        J = d.Configuration(paper_robot(), q).jacobian
        return float(np.sqrt(np.linalg.det(J @ J.T)))

    qp = d.Scheme([d.Manipulability(weight=2.0)]).build_qp(START, HERE)
    assert_allclose(qp.q, -2.0 * finite_difference(measure, START.q), atol=1e-7)
    assert not qp.P.any()


def test_parts_leave_slack_variables_out() -> None:
    scheme = d.Scheme(
        [d.CyclicMotion(), d.Manipulability()], [d.PoseTask()], [d.JointLimits()], slack=2
    )
    qp = scheme.build_qp(START, HERE)
    assert_array_equal(qp.A[:, 7:], 0.0)
    assert_allclose(qp.A[:, :7], START.jacobian, rtol=0, atol=1e-15)
