"""The torque loop alone, on an arm that is integrated here with Pinocchio's forward dynamics."""

import numpy as np
import pinocchio as pin
import pytest

from helpers_physics import START
from iiwa_dnn import load_robot
from iiwa_dnn.robot.mujoco_model import JointDynamics, torque_limits
from iiwa_dnn.simulation.plants.torque_control import TorqueController, TorqueGains

PERIOD, TIMESTEP = 1e-3, 2.5e-4
DYNAMICS = JointDynamics()


class Arm:
    """An arm in Pinocchio: no MuJoCo, the same physics."""

    def __init__(self, robot, q):
        self.model = robot.model.copy()
        self.model.armature = np.full(robot.dof, DYNAMICS.armature)
        self.data = self.model.createData()
        self.q, self.dq = q.copy(), np.zeros(robot.dof)

    def step(self, torque):
        free = torque - DYNAMICS.damping * self.dq
        acceleration = pin.aba(self.model, self.data, self.q, self.dq, free)
        self.dq = self.dq + TIMESTEP * acceleration
        self.q = self.q + TIMESTEP * self.dq


@pytest.fixture
def robot():
    return load_robot("iiwa7")


def loop(robot, q=START):
    torques = TorqueController(robot, PERIOD, TIMESTEP, TorqueGains(), JointDynamics(), q)
    return torques, Arm(robot, q)


def test_it_reaches_what_the_commands_add_up_to(robot):
    torques, arm = loop(robot)
    time = PERIOD * np.arange(1000)
    commands = 0.3 * np.sin(np.pi * time)[:, None] * np.array([1, -0.5, 1, 0.5, -1, 0.5, 2.0])
    for command in commands:
        torques.command(command)
        for _ in range(4):
            arm.step(torques.torque(arm.q))
    # From one command to the next the velocity is a straight line: the trapezoidal rule.
    steps = np.vstack([np.zeros(7), commands])
    wanted = START + PERIOD * 0.5 * (steps[1:] + steps[:-1]).sum(axis=0)
    np.testing.assert_allclose(arm.q, wanted, atol=2e-5)
    np.testing.assert_allclose(arm.dq, commands[-1], atol=2e-3)


def test_an_offset_dies_out_at_the_stated_bandwidth(robot):
    offset = 1e-3 * np.array([1, -1, 1, -1, 1, -1, 1.0])
    torques, arm = loop(robot, START + offset)
    torques._q_desired = START.copy()
    fractions = []
    for _ in range(800):
        arm.step(torques.torque(arm.q))
        fractions.append(np.abs((arm.q - START) / offset).max())
    # Critically damped: (1 + w t) exp(-w t).
    at = TIMESTEP * np.arange(1, 801)
    w = torques.gains.bandwidth
    ideal = (1.0 + w * at) * np.exp(-w * at)
    assert np.abs(np.array(fractions) - ideal).max() < 0.03
    assert fractions[-1] < 1e-4


def test_torques_stay_within_the_limits_and_it_does_not_wind_up(robot):
    torques, _ = loop(robot)
    limit = torque_limits(robot)
    largest = np.zeros(7)
    for _ in range(1000):  # held fast, while it is told to go on and on
        torques.command(np.full(7, 1.5))
        for _ in range(4):
            largest = np.maximum(largest, np.abs(torques.torque(START)))
    assert (largest <= limit).all()
    assert largest[1] == limit[1]
    arm = Arm(robot, START)
    for _ in range(1000):  # let go: it comes to rest within the leash
        torques.command(np.zeros(7))
        for _ in range(4):
            arm.step(torques.torque(arm.q))
    assert np.abs(arm.dq).max() < 1e-3
    assert np.abs(arm.q - START).max() < 0.3
