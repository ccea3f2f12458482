"""The compiled control step, called by itself."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot, paper_start
from iiwa_dnn import Controller, CyclicMotion, KineticEnergy, PositionTask, Scheme, Target
from iiwa_dnn.control.step import control_step
from iiwa_dnn.networks.solver import DNNSolver

BUDGET = 1 + 3 * 7 + 1
"""Index in the work array of the most linear systems."""


@pytest.mark.parametrize(
    ("offset", "multiplier", "solved"),
    [(0.0, 0.0, True), (1e-3, 0.0, False), (0.0, 1.0, False)],
    ids=["solved", "primal residual", "dual residual"],
)
def test_one_large_residual_refuses_the_answer(
    offset: float, multiplier: float, solved: bool
) -> None:
    # Without a linear system the answer is the state's own point: at rest it is dual feasible.
    scheme = Scheme([CyclicMotion(home=PAPER_Q0)], [PositionTask()])
    controller, start = Controller(paper_robot(), scheme), paper_start()
    target = Target(start.position + offset, start.rotation)
    answers, plan = controller.answers(target.data[np.newaxis]), controller.plan
    plan.update(start.q)
    plan.compiled[1][BUDGET] = 0.0
    state = np.zeros(7 + 3 + 2 * 7)
    state[7:10] = multiplier
    before = state.copy()
    assert control_step(answers.rows, 0, *plan.compiled, state, False, 0.0) is solved
    np.testing.assert_array_equal(state, before)
    if solved:
        np.testing.assert_array_equal(answers.rows[0, answers._point], np.zeros(17))
        np.testing.assert_array_equal(plan.last, np.zeros(7))


def test_a_stiff_program_takes_shorter_sub_steps_in_compiled_code(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # P = 400 I: explicit Euler is stable up to 2 / 400 of rho.
    controller = Controller(
        paper_robot(), Scheme([KineticEnergy(400.0)], [PositionTask()]), heart(),
        dt=1e-4, mode="continuous",
    )  # fmt: skip
    advanced = []
    ask = DNNSolver.advance
    monkeypatch.setattr(
        DNNSolver, "advance", lambda self, *args: advanced.append(args) or ask(self, *args)
    )
    commands = [controller.step(PAPER_Q0, 1e-4 * k) for k in range(4)]
    assert len(advanced) == 1
    assert all(command.ok for command in commands)
    ahead = 1e-4 / controller.solver.network.rho
    assert commands[-1].solution.iterations >= ahead * 400.0 / 2.0
    assert commands[-1].solution.network_time == pytest.approx(ahead)
