"""The arm in MuJoCo as the runner sees it: start, read, move; no controller around it."""

from dataclasses import asdict

import numpy as np
import pytest

from helpers_physics import START
from iiwa_dnn import Configuration, load_robot
from iiwa_dnn.robot.mujoco_model import JointDynamics
from iiwa_dnn.simulation.disturbances import Disturbances, Push
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant
from iiwa_dnn.simulation.plants.torque_control import TorqueGains

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


@pytest.mark.parametrize("delay", [0, 1, 7])
def test_a_command_arrives_late_by_the_delay(robot, delay):
    late = drive(started(robot, disturbances=Disturbances(delay=delay)), 30)
    still = started(robot)
    for _ in range(delay):
        still.read()
        still.move(np.zeros(7))
    np.testing.assert_array_equal(late[delay:], drive(still, 30 - delay))
    assert np.abs(late[:delay] - START).max(initial=0.0) < 1e-9


def test_its_settings_say_everything(robot):
    disturbances, gains = Disturbances(friction=0.01, delay=2), TorqueGains(bandwidth=50.0)
    plant = MujocoPlant(disturbances, gains, JointDynamics(0.3, 0.07), timestep=5e-4)
    settings = dict(plant.start(robot, START, DT, 0))
    limit = settings.pop("torque_max")
    np.testing.assert_array_equal(limit, [176.0, 176.0, 110.0, 110.0, 110.0, 40.0, 40.0])
    assert settings == {
        "physics": {
            "engine": f"MuJoCo {mujoco.__version__}",
            "timestep": 5e-4,
            "damping": [0.3] * 7,
            "armature": [0.07] * 7,
            "friction": [0.01 * value for value in limit],
            "disturbances": asdict(disturbances),
            "torque_loop": asdict(gains),
        }
    }


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
