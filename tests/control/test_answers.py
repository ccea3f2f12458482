"""The compiled control step against its parts, and the array that its answers are kept in."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, near_target, paper_robot, paper_start
from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.integrators import ExplicitEuler
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Solution, Status
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator, PseudoInverse, Scheme

SCHEMES: dict[str, Scheme] = {
    "so3": DoubleIndicator(home=PAPER_Q0),
    "block": DoubleIndicator(home=PAPER_Q0, orientation="block"),
    "position": DoubleIndicator(home=PAPER_Q0, orientation="none"),
    "inertia": DoubleIndicator(home=PAPER_Q0, kinetic="inertia", weight=0.7),
    "no home": DoubleIndicator(),
    "pseudo-inverse": PseudoInverse(),
}


class Asked(DNNSolver):
    """A solver that the controller has to ask, since it could solve in any way of its own."""


@pytest.mark.parametrize("substeps", [None, 5])
@pytest.mark.parametrize("mode", ["converged", "continuous"])
@pytest.mark.parametrize("scheme", SCHEMES.values(), ids=SCHEMES.keys())
def test_a_compiled_step_is_its_parts_one_after_the_other(
    scheme: Scheme, mode: Any, substeps: int | None
) -> None:
    follower = ExplicitEuler(substeps)
    compiled = Controller(scheme, DNNSolver(follower=follower), mode)
    asked = Controller(scheme, Asked(follower=follower), mode)
    rng = np.random.default_rng(7)
    answers, others = compiled.answers(20), asked.answers(20)
    for seed in range(20):
        q = np.array(PAPER_Q0) + 1e-3 * rng.standard_normal(7)
        conf, target = Configuration(paper_robot(), q), near_target(q, seed, size=2e-3)
        x, y = compiled.answer(conf, target.data, answers), asked.answer(conf, target.data, others)
        # The compiler may round a product and its sum in one place once, in another twice.
        np.testing.assert_allclose(x, y, rtol=0, atol=1e-11)
        np.testing.assert_array_equal(answers.qp(seed).data, scheme.build_qp(conf, target).data)
        one, other = answers.solution(seed), others.solution(seed)
        assert one.status is other.status
        assert one.status is (Status.SOLVED if mode == "converged" else Status.ADVANCED)
        np.testing.assert_allclose(one.point, other.point, rtol=0, atol=1e-9)
        np.testing.assert_allclose(one.residuals, other.residuals, rtol=1e-9, atol=1e-11)
        assert one.network_time == pytest.approx(other.network_time)
        np.testing.assert_array_equal(answers.poses[seed], conf.pose)
        np.testing.assert_array_equal(answers.all_x[seed], one.x)
        assert answers.residuals[seed].tolist() == list(one.residuals)
        assert answers.iterations[seed] == one.iterations
    np.testing.assert_array_equal(answers.programs, others.programs)
    np.testing.assert_allclose(compiled.solver.state, asked.solver.state, rtol=0, atol=1e-9)


def test_only_the_first_step_is_not_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    controller = Controller(SCHEMES["so3"], DNNSolver())
    solved = []
    ask = DNNSolver.solve
    monkeypatch.setattr(
        DNNSolver, "solve", lambda self, qp: solved.append(qp) or ask(self, qp)
    )  # fmt: skip
    answers = controller.answers(5)
    for k in range(5):
        controller.answer(paper_start(), heart().at(1e-4 * k).data, answers)
    assert len(solved) == 1


@dataclass(frozen=True)
class Halved(DoubleIndicator):
    """A subclass that builds in a way of its own."""

    def build_qp(self, conf: Configuration, target: Any) -> QP:
        qp = super().build_qp(conf, target)
        qp.b[:] *= 0.5
        return qp


class Fixed(DNNSolver):
    """A subclass that solves in a way of its own."""

    def solve(self, qp: QP) -> Solution:
        n, m, p = qp.sizes
        point = np.full(2 * n + m + p, 0.25)
        return Solution(point, qp.sizes, Status.SOLVED, 1, 0.0, 0.0, 0.0, 0.0)


def test_what_a_subclass_does_in_its_own_way_is_done() -> None:
    conf, target = paper_start(), heart().at(0.5)
    controller = Controller(Halved(home=PAPER_Q0), DNNSolver())
    answers = controller.answers(3)
    whole = SCHEMES["so3"].build_qp(conf, target)
    for k in range(3):
        x = controller.answer(conf, target.data, answers)
        np.testing.assert_allclose(whole.A @ x, 0.5 * whole.b, rtol=0, atol=1e-9)
        np.testing.assert_array_equal(answers.qp(k).b, 0.5 * whole.b)
    controller = Controller(SCHEMES["so3"], Fixed())
    answers = controller.answers(3)
    for _ in range(3):
        np.testing.assert_array_equal(
            controller.answer(conf, target.data, answers), np.full(7, 0.25)
        )


def test_a_changed_scheme_and_another_robot_count_from_the_next_step_on() -> None:
    conf, target = paper_start(), heart().at(0.5)
    controller = Controller(SCHEMES["so3"], DNNSolver())
    controller.step(conf, target)
    controller.step(conf, target)
    controller.scheme = DoubleIndicator(home=PAPER_Q0, position_gain=1.0)
    expected = controller.scheme.build_qp(conf, target)
    np.testing.assert_array_equal(controller.step(conf, target).qp.data, expected.data)
    slow = Configuration(paper_robot().with_limits(velocity=0.5), PAPER_Q0)
    assert (controller.step(slow, target).qp.ub <= 0.5).all()


def test_a_step_that_is_not_solved_is_told_apart() -> None:
    robot = paper_robot().with_limits(velocity=1e-6)
    controller = Controller(SCHEMES["so3"], DNNSolver(), "converged")
    answers = controller.answers(3)
    target = heart().at(0.5)
    controller.answer(paper_start(), target.data, answers)
    before = controller.solver.state
    controller.answer(Configuration(robot, PAPER_Q0), target.data, answers)
    controller.answer(paper_start(), target.data, answers)
    assert list(answers.unsolved) == [1]
    assert not answers.solution(1).found
    assert answers.solution(0).found
    assert answers.solution(2).found
    np.testing.assert_allclose(controller.solver.state, before, rtol=0, atol=1e-6)


def test_programs_of_two_shapes_are_refused_by_name() -> None:
    answers = Answers(2, Status.SOLVED)
    solver = DNNSolver()
    first, second = QP(np.eye(2), np.ones(2)), QP(np.eye(2), np.ones(2), A=[[1.0, 1.0]], b=[0.0])
    answers.add(first, solver.solve(first), np.eye(4))
    with pytest.raises(InvalidInputError, match="scheme"):
        answers.add(second, solver.solve(second), np.eye(4))
