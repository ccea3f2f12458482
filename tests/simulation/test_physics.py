"""The whole loop in MuJoCo: the paper's heart, nominal and disturbed, held to its figures."""

import numpy as np
import pytest

import iiwa_dnn as d
from helpers_kinematics import dh_pose
from helpers_physics import distance, heart_in_physics
from iiwa_dnn.simulation.disturbances import Disturbances, Push
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant

pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")

TORQUE_LIMITS = np.array([176.0, 176.0, 110.0, 110.0, 110.0, 40.0, 40.0])  # the data sheet's


@pytest.fixture(scope="module")
def nominal() -> d.Record:
    return heart_in_physics()


@pytest.fixture(scope="module")
def disturbed() -> d.Record:
    return heart_in_physics(Disturbances.typical(), duration=5.0, seed=1)


def limits_are_kept(record: d.Record) -> bool:
    """Position, velocity and torque limits, from the arrays alone."""
    speeds = np.radians([98, 98, 100, 130, 140, 180, 180])
    return bool(
        (np.abs(record.q) <= 2.5).all()
        and (np.abs(record.dq) <= speeds).all()
        and (np.abs(record.torque) < TORQUE_LIMITS).all()
    )


def test_nominal_heart(nominal):
    assert nominal.steps == 10_000
    assert nominal.settings["status"] == "completed"
    assert distance(nominal)[nominal.t >= 0.5].max() <= 1e-4
    assert limits_are_kept(nominal)
    assert d.failures(nominal) == []
    dt = nominal.settings["dt"]
    np.testing.assert_allclose(nominal.q[1:], nominal.q[:-1] + dt * nominal.dq, atol=1e-12)
    np.testing.assert_allclose(nominal.position, dh_pose(nominal.q)[0], atol=1e-12)
    # A real arm follows its commands, not exactly and soon.
    lag = np.abs(nominal.dq - nominal.dq_solver).max()
    assert 1e-6 < lag < 5e-3
    np.testing.assert_array_equal(nominal.settings["torque_max"], TORQUE_LIMITS)


def test_all_disturbances_but_the_push(disturbed):
    assert disturbed.settings["status"] == "completed"
    error = distance(disturbed)
    assert 2e-5 < error.max() <= 2e-3  # they do disturb
    assert limits_are_kept(disturbed)
    assert disturbed.settings["physics"]["disturbances"]["delay_periods"] == 1


def test_back_within_a_second_after_the_push(disturbed):
    force = (10.0, 10.0, -10.0)
    push = Push(force, start=0.4, duration=0.2)
    disturbances = Disturbances.typical(push)
    record = heart_in_physics(disturbances, duration=2.0, seed=1)
    error, t = distance(record), record.t
    assert error[t >= push.start + push.duration + 1.0].max() < 1e-3
    # Pushed, and not only disturbed.
    shift = np.linalg.norm(record.position - disturbed.position[: t.size], axis=1)
    assert shift[t < push.start].max() == 0.0
    assert shift.max() > 1e-4
    moved = record.position[600] - disturbed.position[600]
    assert moved @ np.array(force) > 0.0
    assert limits_are_kept(record)


def test_a_push_is_no_command_beyond_the_acceleration_limits():
    robot = d.load_robot("iiwa7")
    push = Push((20.0, 0.0, 0.0), start=0.1, duration=0.05)
    record = d.simulate(
        robot,
        d.DoubleIndicator(extra_limits=(d.AccelerationLimits(),)),
        d.Heart().anchored(d.Configuration(robot, robot.start_posture())),
        robot.start_posture(),
        dt=1e-3,
        duration=0.2,
        plant=MujocoPlant(Disturbances(push=push)),
        check=d.CrossCheck(()),
    )
    moved, sent = (
        np.abs(np.diff(np.vstack([np.zeros(7), velocities]), axis=0)) / 1e-3
        for velocities in (record.dq, record.sent)
    )
    assert (moved > robot.ddq_max).any()
    assert (sent <= robot.ddq_max).all()
    assert d.failures(record) == []


def test_a_state_that_is_not_a_number_ends_the_run(monkeypatch):
    step = MujocoPlant._step

    def break_once(plant, torque):
        if 0.1 < plant._data.time < 0.1005:
            plant._data.qvel[2] = np.nan
        step(plant, torque)

    monkeypatch.setattr(MujocoPlant, "_step", break_once)
    record = heart_in_physics(duration=1.0)
    assert record.settings["status"] == "stopped at step 100 (t = 0.1 s): the physics diverged"
    assert record.steps == 101
    assert np.isfinite(record.q).all()
