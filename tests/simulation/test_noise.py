"""Noise: its statistics, its seed, and where it enters the loop."""

from typing import Any

import numpy as np
import pytest
import scipy.stats

from helpers_kinematics import PAPER_Q0, dh_pose
from helpers_simulation import heart, paper_robot, run
from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import gaussian_noise


def test_it_is_white_and_normal() -> None:
    steps, sigma = 20_000, 0.01
    noise = gaussian_noise(sigma, steps, 7, seed=5)
    assert noise.shape == (steps, 7)
    assert (noise != gaussian_noise(sigma, steps, 7, seed=4)).all()
    for joint in range(7):  # against the distribution of that very sigma
        assert scipy.stats.kstest(noise[:, joint] / sigma, "norm").pvalue > 1e-3
    correlation = np.corrcoef(np.hstack([noise[1:], noise[:-1]]).T)
    assert np.abs(correlation - np.eye(14)).max() < 4.5 / np.sqrt(steps)


def test_at_the_network_it_disturbs_the_state_and_not_the_velocity() -> None:
    quiet = run(mode="continuous", dt=1e-4, duration=0.01)
    record = run(mode="continuous", dt=1e-4, duration=0.01, noise=0.01, noise_at="network")
    np.testing.assert_array_equal(record.dq, record.dq_solver)
    # It enters after the answer was taken: the first answer is the quiet one, the next is not.
    np.testing.assert_array_equal(record.dq[0], quiet.dq[0])
    spread = np.abs(record.dq[1:] - quiet.dq[1:])
    assert (spread.max(axis=1) > 1e-4).all()
    assert spread.max() < 0.1


def test_at_the_measurement_the_controller_sees_other_angles_and_the_record_the_true_ones() -> None:
    sigma, seed = 1e-3, 9
    record = run(noise=sigma, seed=seed, noise_at="measurement", duration=0.02)
    seen = record.q[:-1] + gaussian_noise(sigma, 20, 7, seed)
    scheme = DoubleIndicator(home=PAPER_Q0)
    for k in range(20):
        target = heart().at(record.t[k])
        answer = DNNSolver().solve(scheme.build_qp(Configuration(paper_robot(), seen[k]), target)).x
        np.testing.assert_allclose(record.dq[k], answer, rtol=0, atol=1e-7)
    np.testing.assert_allclose(record.position, dh_pose(record.q)[0], rtol=0, atol=1e-12)


def test_a_command_that_was_handed_out_stays_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    """The loop wrote the true arm's placement over the one that the command was computed at."""
    handed = []
    compute = Controller.compute

    def noted(*arguments: Any) -> Command:
        command = compute(*arguments)
        handed.append((command, command.data.copy()))
        return command

    monkeypatch.setattr(Controller, "compute", noted)
    record = run(noise=1e-3, noise_at="measurement", duration=0.02)
    assert len(handed) == 20
    for k, (command, row) in enumerate(handed):
        np.testing.assert_array_equal(command.data, row)
        seen = Configuration(paper_robot(), command.log.q).position
        np.testing.assert_allclose(command.log.placement[9:], seen, rtol=0, atol=1e-12)
        true = Configuration(paper_robot(), record.q[k]).position
        np.testing.assert_allclose(record.position[k], true, rtol=0, atol=1e-12)
