"""Tasks towards the next target, against their closed form, Pinocchio's log and their order."""

from __future__ import annotations

import numpy as np
import pinocchio as pin
import pytest

from helpers_kinematics import PAPER_Q0
from helpers_simulation import paper_robot, paper_start
from iiwa_dnn import simulate
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Heart, MovingTarget, Reference, Tilting
from iiwa_dnn.results.metrics import orientation_error, position_error
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes import (
    DoubleIndicator,
)

DT = 1e-3
PATH = Tilting(Heart(), 0.3, (0.3, 1.0, -0.2)).anchored(paper_start())


@pytest.mark.parametrize("gain", [np.inf, 300.0, 5e3])
def test_the_rows_ask_for_the_next_target(gain: float) -> None:
    q = np.array(PAPER_Q0) + 0.1 * np.random.default_rng(3).normal(size=7)
    conf, t = Configuration(paper_robot(), q), 1.7
    scheme = DoubleIndicator(home=PAPER_Q0, tracking="next")
    if gain < np.inf:
        scheme = DoubleIndicator(home=PAPER_Q0, position_gain=gain, orientation_gain=gain)
    qp = scheme.build_qp(conf, PATH.ahead(DT).at(t), DT)
    now, then = PATH.at(t), PATH.at(t + DT)
    left = 1.0 - min(gain * DT, 1.0)
    wanted = [
        then.position - conf.position - left * (now.position - conf.position),
        pin.log3(then.rotation @ conf.rotation.T) - left * pin.log3(now.rotation @ conf.rotation.T),
    ]
    np.testing.assert_allclose(DT * qp.b[:3], wanted[0], rtol=0, atol=1e-14)
    # Rotations do not add: the turn of a period times the error is left, here 3e-4 times 0.2 rad.
    np.testing.assert_allclose(DT * qp.b[3:], wanted[1], rtol=0, atol=6e-5)
    paper = DoubleIndicator(home=PAPER_Q0).build_qp(conf, now)
    np.testing.assert_array_equal(qp.A, paper.A)


def test_a_reference_seen_ahead_has_the_mean_twist_of_the_period() -> None:
    t = np.linspace(0.0, 10.0, 30)
    targets, nows, thens = PATH.ahead(0.05).sample(t), PATH.sample(t), PATH.sample(t + 0.05)
    np.testing.assert_array_equal(targets.data[:, :12], nows.data[:, :12])
    for target, now, then in zip(targets, nows, thens, strict=True):
        turned = pin.exp3(0.05 * target.angular_velocity) @ now.rotation
        np.testing.assert_allclose(turned, then.rotation, rtol=0, atol=1e-15)
        moved = now.position + 0.05 * target.linear_velocity
        np.testing.assert_allclose(moved, then.position, rtol=0, atol=1e-15)


def largest_errors(reference: Reference, dt: float, **gains: float) -> tuple[float, float]:
    record = simulate(
        paper_robot(), DoubleIndicator(tracking="next", **gains), reference, PAPER_Q0,
        dt=dt, duration=1.6, check=CrossCheck(()),
    )  # fmt: skip
    settled = record.t > 0.1
    distance = np.linalg.norm(position_error(record), axis=1)
    return distance[settled].max(), orientation_error(record)[settled].max()


def test_the_error_is_of_second_order_and_does_not_add_up() -> None:
    coarse, fine = largest_errors(PATH, 2e-3), largest_errors(PATH, 1e-3)
    np.testing.assert_allclose(np.divide(coarse, fine), 4.0, rtol=0.05)
    assert fine[0] < 4e-9


def test_a_controller_tracks_as_a_run_does_and_a_target_set_from_outside_too() -> None:
    robot, q = paper_robot(), np.array(PAPER_Q0)
    controller = Controller(robot, DoubleIndicator(tracking="next"), PATH, dt=DT)
    for k in range(200):
        q = q + DT * controller.step(q, k * DT).dq
    assert np.abs(Configuration(robot, q).position - PATH.at(0.2).position).max() < 1e-8
    target = MovingTarget(Configuration(robot, q), speed=0.1)
    controller.reference = target
    target.set(target.at(0.2).position + [0.01, 0.0, 0.0])
    for k in range(200, 400):
        q = q + DT * controller.step(q, k * DT).dq
    assert np.abs(Configuration(robot, q).position - target.at(0.4).position).max() < 1e-8
