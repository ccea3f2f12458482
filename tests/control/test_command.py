"""Commands: the compiled control step against its parts, and the answers that they carry."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, near_target, paper_robot, paper_start
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.policies import Action
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
    robot = paper_robot()
    compiled, asked = (
        Controller(robot, scheme, mode=mode, dt=1e-4, solver=solver)
        for solver in (DNNSolver(follower=follower), Asked(follower=follower))
    )
    rng = np.random.default_rng(7)
    postures = np.array(PAPER_Q0) + 1e-3 * rng.standard_normal((20, 7))
    targets = [near_target(q, seed, size=2e-3) for seed, q in enumerate(postures)]
    for q, target in zip(postures, targets, strict=True):
        one = compiled.step(q, 0.0, target)
        other = asked.step(q, 0.0, target)
        # The compiler may round a product and its sum in one place once, in another twice.
        np.testing.assert_allclose(one.dq, other.dq, rtol=0, atol=1e-11)
        conf = Configuration(robot, q)
        np.testing.assert_array_equal(one.qp.data, other.qp.data)
        anchored = compiled.scheme
        np.testing.assert_array_equal(one.qp.data, anchored.build_qp(conf, target).data)
        assert one.solution.status is other.solution.status
        assert one.solution.status is (Status.SOLVED if mode == "converged" else Status.ADVANCED)
        np.testing.assert_allclose(one.solution.point, other.solution.point, rtol=0, atol=1e-9)
        residuals = one.solution.residuals
        np.testing.assert_allclose(residuals, other.solution.residuals, rtol=1e-9, atol=1e-11)
        assert one.solution.network_time == pytest.approx(other.solution.network_time)
        np.testing.assert_array_equal(one.placement[:9].reshape(3, 3).T, conf.rotation)
        np.testing.assert_array_equal(one.placement[9:], conf.position)
        np.testing.assert_array_equal(one.targets[0], target.data)
    np.testing.assert_allclose(compiled.solver.state, asked.solver.state, rtol=0, atol=1e-9)


def test_compiled_code_answers_every_step(monkeypatch: pytest.MonkeyPatch) -> None:
    controller = Controller(paper_robot(), SCHEMES["so3"], heart(), dt=1e-4)
    solved = []
    ask = DNNSolver.solve
    monkeypatch.setattr(
        DNNSolver, "solve", lambda self, qp: solved.append(qp) or ask(self, qp)
    )  # fmt: skip
    for k in range(5):
        assert controller.step(PAPER_Q0, 1e-4 * k).ok
    assert not solved


class Fixed(DNNSolver):
    """A subclass that solves in a way of its own."""

    def solve(self, qp: QP) -> Solution:
        n, m, p = qp.sizes
        point = np.full(2 * n + m + p, 0.25)
        return Solution(point, qp.sizes, Status.SOLVED, 1, 0.0, 0.0, 0.0, 0.0)


def test_what_a_subclass_does_in_its_own_way_is_done() -> None:
    target = heart().at(0.5)
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


@pytest.mark.parametrize("name", ["mode", "dt", "solver"])
def test_a_changed_parameter_counts_from_the_next_step_on(name: str) -> None:
    # What was compiled for the first steps held the old value, and said SOLVED at 6.6e-6.
    controller = Controller(
        paper_robot(), SCHEMES["so3"], heart(), dt=1e-4, solver=DNNSolver(tol=1e-4)
    )
    for k in range(3):
        controller.step(PAPER_Q0, 0.1 * k)
    if name == "solver":
        controller.solver = DNNSolver(tol=1e-12)
    elif name == "mode":
        controller.mode = "continuous"
    else:
        controller.mode, controller.dt = "continuous", 3e-4
    solution = controller.step(PAPER_Q0, 1.0).solution
    if name == "solver":
        assert solution.found
        assert solution.residuals.largest <= 1e-12
    else:
        assert solution.status is Status.ADVANCED
        assert solution.network_time == pytest.approx(controller.dt / 9e-5)


def test_a_step_that_is_not_solved_leaves_the_others_as_they_are() -> None:
    controller = Controller(paper_robot(), SCHEMES["so3"], dt=1e-4)
    near = heart().at(0.0)
    far = near_target(PAPER_Q0, 3, size=3.0)
    commands = [controller.step(PAPER_Q0, 0.0, target) for target in (near, far, near)]
    assert [command.action for command in commands] == [Action.NONE, Action.SLOW, Action.NONE]
    assert [command.ok for command in commands] == [True, False, True]
    np.testing.assert_allclose(commands[2].dq, commands[0].dq, rtol=0, atol=1e-9)


class Unsettled(DNNSolver):
    """A solver that says how its answers ended."""

    status = Status.NOT_SETTLED

    def advance(self, qp: QP, duration: float) -> Solution:
        return super().advance(qp, duration)._replace(status=self.status)


@pytest.mark.parametrize("status", [Status.NOT_FINITE, Status.NOT_SETTLED])
def test_an_answer_of_another_status_keeps_it(status: Status) -> None:
    solver = Unsettled()
    solver.status = status
    controller = Controller(
        paper_robot(), SCHEMES["so3"], heart(), mode="continuous", solver=solver
    )
    command = controller.step(PAPER_Q0, 0.0)
    assert not command.ok
    assert command.solution.status is status
