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
from iiwa_dnn.control.policies import Action
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
    follower, robot = ExplicitEuler(substeps), paper_robot()
    compiled, asked = (
        Controller(robot, scheme, mode=mode, dt=1e-4, solver=solver)
        for solver in (DNNSolver(follower=follower), Asked(follower=follower))
    )
    rng = np.random.default_rng(7)
    postures = np.array(PAPER_Q0) + 1e-3 * rng.standard_normal((20, 7))
    targets = [near_target(q, seed, size=2e-3) for seed, q in enumerate(postures)]
    data = np.stack([target.data for target in targets])
    answers, others = compiled.answers(data), asked.answers(data)
    for k, q in enumerate(postures):
        x, y = compiled.answer(q, answers), asked.answer(q, others)
        # The compiler may round a product and its sum in one place once, in another twice.
        np.testing.assert_allclose(x, y, rtol=0, atol=1e-11)
        conf = Configuration(robot, q)
        np.testing.assert_array_equal(answers.qp(k).data, scheme.build_qp(conf, targets[k]).data)
        one, other = answers.solution(k), others.solution(k)
        assert one.status is other.status
        assert one.status is (Status.SOLVED if mode == "converged" else Status.ADVANCED)
        np.testing.assert_allclose(one.point, other.point, rtol=0, atol=1e-9)
        np.testing.assert_allclose(one.residuals, other.residuals, rtol=1e-9, atol=1e-11)
        assert one.network_time == pytest.approx(other.network_time)
        np.testing.assert_array_equal(answers.places[k][:9].reshape(3, 3).T, conf.rotation)
        np.testing.assert_array_equal(answers.places[k][9:], conf.position)
        np.testing.assert_array_equal(answers.q[k], q)
        np.testing.assert_array_equal(answers.all_x[k], one.x)
        assert list(answers.solution(k).residuals) == list(one.residuals)
        assert answers.solution(k).iterations == one.iterations
    np.testing.assert_array_equal(answers.programs, others.programs)
    np.testing.assert_allclose(compiled.solver.state, asked.solver.state, rtol=0, atol=1e-9)


def test_steps_that_move_the_joints_are_the_same_steps() -> None:
    dt, times = 1e-3, 1e-3 * np.arange(50)
    moved, stepped = (Controller(paper_robot(), SCHEMES["so3"], heart(), dt=dt) for _ in range(2))
    answers, others = (c.answers(c.sample(times)) for c in (moved, stepped))
    q, other = np.array(PAPER_Q0), np.array(PAPER_Q0)
    q = q + dt * moved.answer(q, answers)
    assert moved.follow(q, answers, 49) == 49
    for _ in times:
        other = other + dt * stepped.answer(other, others)
    np.testing.assert_array_equal(q, other)
    np.testing.assert_array_equal(answers.rows, others.rows)


def test_only_the_first_step_is_not_compiled(monkeypatch: pytest.MonkeyPatch) -> None:
    controller = Controller(paper_robot(), SCHEMES["so3"], heart(), dt=1e-4)
    solved = []
    ask = DNNSolver.solve
    monkeypatch.setattr(
        DNNSolver, "solve", lambda self, qp: solved.append(qp) or ask(self, qp)
    )  # fmt: skip
    for k in range(5):
        assert controller.step(PAPER_Q0, 1e-4 * k).ok
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
    target = heart().at(0.5)
    controller = Controller(paper_robot(), Halved(home=PAPER_Q0))
    whole = SCHEMES["so3"].build_qp(paper_start(), target)
    for _ in range(3):
        command = controller.step(PAPER_Q0, 0.0, target)
        np.testing.assert_allclose(whole.A @ command.dq, 0.5 * whole.b, rtol=0, atol=1e-9)
        np.testing.assert_array_equal(command.qp.b, 0.5 * whole.b)
    controller = Controller(paper_robot(), SCHEMES["so3"], solver=Fixed())
    for _ in range(3):
        np.testing.assert_array_equal(controller.step(PAPER_Q0, 0.0, target).dq, np.full(7, 0.25))


def test_a_changed_scheme_and_another_robot_count_from_the_next_step_on() -> None:
    target = heart().at(0.5)
    controller = Controller(paper_robot(), SCHEMES["so3"])
    controller.step(PAPER_Q0, 0.0, target)
    controller.step(PAPER_Q0, 0.0, target)
    controller.scheme = DoubleIndicator(home=PAPER_Q0, position_gain=1.0)
    expected = controller.scheme.build_qp(paper_start(), target)
    np.testing.assert_array_equal(controller.step(PAPER_Q0, 0.0, target).qp.data, expected.data)
    controller.robot = paper_robot().with_limits(velocity=0.5)
    assert (controller.step(PAPER_Q0, 0.0, target).qp.ub <= 0.5).all()


@pytest.mark.parametrize("name", ["tol", "mode", "dt", "solver"])
def test_a_changed_parameter_counts_from_the_next_step_on(name: str) -> None:
    # What was compiled for the first steps held the old value, and said SOLVED at 6.6e-6.
    controller = Controller(
        paper_robot(), SCHEMES["so3"], heart(), dt=1e-4, solver=DNNSolver(tol=1e-4)
    )
    for k in range(3):
        controller.step(PAPER_Q0, 0.1 * k)
    if name == "tol":
        controller.solver.tol = 1e-12
    elif name == "solver":
        controller.solver = DNNSolver(tol=1e-12)
    elif name == "mode":
        controller.mode = "continuous"
    else:
        controller.mode, controller.dt = "continuous", 3e-4
    solution = controller.step(PAPER_Q0, 1.0).solution
    if name in ("tol", "solver"):
        assert solution.found
        assert solution.residuals.largest <= 1e-12
    else:
        assert solution.status is Status.ADVANCED
        assert solution.network_time == pytest.approx(controller.dt / 9e-5)


def test_a_step_that_is_not_solved_is_told_apart() -> None:
    controller = Controller(paper_robot(), SCHEMES["so3"], dt=1e-4)
    near, far = heart().at(0.0), near_target(PAPER_Q0, 3, size=3.0)
    answers = controller.answers(np.stack([near.data, far.data, near.data]))
    for _ in range(3):
        controller.answer(np.array(PAPER_Q0), answers)
    assert list(answers.resolved) == [1]
    assert answers.resolved[1].action is Action.SLOW
    assert answers.solution(0).found
    assert answers.solution(2).found
    np.testing.assert_allclose(answers.dq(2), answers.dq(0), rtol=0, atol=1e-9)


def test_programs_of_two_shapes_are_refused_by_name() -> None:
    answers = Answers((2, 0, 0), 2, Status.SOLVED, np.zeros((2, 18)))
    solver, place = DNNSolver(), np.zeros(12)
    first, second = QP(np.eye(2), np.ones(2)), QP(np.eye(2), np.ones(2), A=[[1.0, 1.0]], b=[0.0])
    answers.add(first, solver.solve(first), place, np.zeros(2))
    with pytest.raises(InvalidInputError, match="scheme"):
        answers.add(second, solver.solve(second), place, np.zeros(2))


@pytest.mark.parametrize("status", [status for status in Status if status is not Status.SOLVED])
def test_an_answer_of_another_status_keeps_it(status: Status) -> None:
    answers = Answers((2, 0, 0), 2, Status.SOLVED, np.zeros((2, 18)))
    qp = QP(np.eye(2), np.ones(2))
    solution = DNNSolver().solve(qp)
    answers.add(qp, solution, np.zeros(12), np.zeros(2))
    answers.add(qp, solution._replace(status=status), np.zeros(12), np.zeros(2))
    assert list(answers.unsolved) == [1]
    assert [answers.solution(i).status for i in range(2)] == [Status.SOLVED, status]
