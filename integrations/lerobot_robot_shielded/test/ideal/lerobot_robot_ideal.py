"""An SO-101 without motors, and a teleoperator like a policy with bad seams."""

import os
from dataclasses import dataclass

import numpy as np
from lerobot.robots import Robot, RobotConfig
from lerobot.teleoperators import Teleoperator, TeleoperatorConfig

MOTORS = ("shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper")
KEYS = [f"{each}.pos" for each in MOTORS]
CHUNK = 15  # actions of a policy


class Idle:
    """Parts of LeRobot's interfaces without motors."""

    observation_features = action_features = feedback_features = dict.fromkeys(KEYS, float)
    is_connected = is_calibrated = True
    cameras = ()

    def nothing(self, *_):
        pass

    connect = calibrate = configure = send_feedback = disconnect = nothing


@RobotConfig.register_subclass("ideal")
@dataclass(kw_only=True)
class IdealConfig(RobotConfig):
    """Settings of a robot without motors."""


class Ideal(Idle, Robot):
    """A robot that is where it was told to be; one motor is stuck for a while."""

    config_class = IdealConfig
    name = "ideal"

    def __init__(self, config):
        super().__init__(config)
        self.goals = [[0.0] * len(MOTORS)]

    def get_observation(self):
        shown = dict(zip(KEYS, self.goals[-1], strict=True))
        if 50 < len(self.goals) < 100:
            shown[KEYS[0]] = self.goals[50][0]
        return shown

    def send_action(self, action):
        self.goals.append([action[key] for key in KEYS])
        return action

    def disconnect(self):
        np.save(os.environ.get("GOALS_FILE", "goals.npy"), self.goals)


@TeleoperatorConfig.register_subclass("chunks")
@dataclass(kw_only=True)
class ChunksConfig(TeleoperatorConfig):
    """Settings of a policy that replans without regard to where the arm is, or is smooth."""

    smooth: bool = False


class Chunks(Idle, Teleoperator):
    """Chunks of smooth actions that begin anywhere; some are no numbers."""

    config_class = ChunksConfig
    name = "chunks"

    def __init__(self, config):
        super().__init__(config)
        self.config = config
        self.random = np.random.default_rng(0)
        self.count = 0

    def get_action(self):
        if self.config.smooth:
            self.count += 1
            return dict.fromkeys(KEYS, 20.0 * np.sin(np.pi / 25.0 * self.count))
        if self.count % CHUNK == 0:
            self.base, self.slope = self.random.normal(size=(2, len(MOTORS)))
        self.count += 1
        numbers = 60.0 * self.base + self.slope * (self.count % CHUNK)
        if self.count % 100 == 0:
            numbers[0] = np.nan
        return dict(zip(KEYS, [*numbers[:-1], float(self.count % 100)], strict=True))
