"""The compiled control step, called by itself."""

from __future__ import annotations

import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot
from iiwa_dnn import Controller, KineticEnergy, PositionTask, Scheme
from iiwa_dnn.networks.solver import DNNSolver


def test_a_stiff_program_takes_shorter_sub_steps_in_compiled_code(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # P = 400 I: explicit Euler is stable up to 2 / 400 of rho.
    controller = Controller(
        paper_robot(), Scheme([KineticEnergy(weight=400.0)], [PositionTask()]), heart(),
        dt=1e-4, mode="continuous",
    )  # fmt: skip
    advanced = []
    ask = DNNSolver.advance
    monkeypatch.setattr(
        DNNSolver, "advance", lambda self, *args: advanced.append(args) or ask(self, *args)
    )
    commands = [controller.step(PAPER_Q0, 1e-4 * k) for k in range(4)]
    assert not advanced
    assert all(command.ok for command in commands)
    ahead = 1e-4 / controller.solver.network.rho
    assert commands[-1].solution.iterations >= ahead * 400.0 / 2.0
    assert commands[-1].solution.network_time == pytest.approx(ahead)
