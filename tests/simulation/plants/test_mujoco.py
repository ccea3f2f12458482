"""The arm in MuJoCo as the runner sees it: start, read, move; no controller around it."""

import numpy as np
import pytest

from helpers_physics import START
from iiwa_dnn import Configuration, load_robot
from iiwa_dnn.simulation.disturbances import Disturbances, Push
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant

mujoco = pytest.importorskip("mujoco", reason="pip install 'iiwa-dnn[sim]'")

COMMAND = np.array([0.2, -0.1, 0.3, 0.1, -0.2, 0.1, 0.4])
DT = 1e-3


@pytest.fixture(scope="module")
def robot():
    return load_robot("iiwa7")


def started(robot, seed: int = 0, **options) -> MujocoPlant:
    plant = MujocoPlant(**options)
    plant.start(robot, START, DT, seed)
    return plant


def drive(plant: MujocoPlant, steps: int) -> np.ndarray:
    """Joint angles after each of some steps under one command."""
    angles = []
    for _ in range(steps):
        plant.read()
        angles.append(plant.move(COMMAND).q)
    return np.array(angles)


def test_a_second_start_gives_the_same_run_and_another_seed_another(robot):
    plant = started(robot, disturbances=Disturbances.typical(), seed=4)
    first = drive(plant, 50)
    plant.start(robot, START, DT, 4)
    np.testing.assert_array_equal(drive(plant, 50), first)
    plant.start(robot, START, DT, 5)
    assert not np.array_equal(drive(plant, 50), first)


@pytest.mark.parametrize("delay_periods", [0, 1, 7])
def test_a_command_arrives_late_by_the_delay(robot, delay_periods):
    late = drive(started(robot, disturbances=Disturbances(delay_periods=delay_periods)), 30)
    still = started(robot)
    for _ in range(delay_periods):
        still.read()
        still.move(np.zeros(7))
    np.testing.assert_array_equal(late[delay_periods:], drive(still, 30 - delay_periods))
    assert np.abs(late[:delay_periods] - START).max(initial=0.0) < 1e-9


def test_the_push_has_the_impulse_that_is_asked_for(robot):
    """A frozen clock would push for ever; the joints' momentum balance tells."""
    push = Push((3.0, -2.0, 1.0), start=0.01, duration=0.02)
    plant = MujocoPlant(Disturbances(push=push), timestep=1e-3)
    plant.start(robot, START, 1e-3, seed=0)
    jacobian = Configuration(robot, START).jacobian[:3]
    total = np.zeros(7)
    for _ in range(60):
        plant._step(np.zeros(7))
        total += 1e-3 * plant._data.qfrc_applied
    np.testing.assert_allclose(total, jacobian.T @ push.force * 0.02, rtol=0.02, atol=1e-3)
