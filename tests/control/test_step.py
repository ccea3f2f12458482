"""The compiled control step, called by itself."""

from __future__ import annotations

import numpy as np
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import heart, paper_robot
from iiwa_dnn import Controller, KineticEnergy, PositionTask, Scheme
from iiwa_dnn.control.command import ADVANCED, NOT_FINITE, NOT_SETTLED, SOLVED
from iiwa_dnn.control.step import status_of
from iiwa_dnn.networks.integrators.base import DURATION, TOLERANCE
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


@pytest.mark.parametrize("duration", [0.0, 1.0])
def test_no_residual_may_be_infinite(duration: float) -> None:
    own = np.zeros(DURATION + 1)
    own[TOLERANCE] = 1e-9
    own[DURATION] = duration
    state = np.zeros(2)
    assert status_of(0.0, 0.0, 0.0, own, state) == (ADVANCED if duration else SOLVED)
    assert status_of(1.0, 1.0, 1.0, own, state) == (ADVANCED if duration else NOT_SETTLED)
    for wrong in (np.inf, np.nan):
        for residuals in ((wrong, 0.0, 0.0), (0.0, wrong, 0.0), (0.0, 0.0, wrong)):
            assert status_of(*residuals, own, state) == NOT_FINITE
