"""A robot without motors that notes its goals, and a teleoperator like a policy with bad seams."""

import os
from dataclasses import dataclass

import numpy as np
from lerobot.robots import Robot, RobotConfig
from lerobot.teleoperators import Teleoperator, TeleoperatorConfig

NAMES = tuple(f"joint{k}" for k in range(1, 8))
START = np.degrees([-2.357, -0.547, 0.023, 1.721, 0.005, -0.681, 0.0])
FEATURES = {f"{name}.pos": float for name in (*NAMES, "gripper")}
CHUNK = 15  # actions of a policy


class Idle:
    """Parts of LeRobot's interfaces without motors."""

    observation_features = action_features = feedback_features = FEATURES
    is_connected = is_calibrated = True
    cameras = ()

    def connect(self, calibrate=True):
        pass

    def nothing(self, *_):
        pass

    calibrate = configure = send_feedback = disconnect = nothing


@RobotConfig.register_subclass("ideal")
@dataclass(kw_only=True)
class IdealConfig(RobotConfig):
    """Settings of a robot without motors."""


class Ideal(Idle, Robot):
    """A robot that is where it was told to be."""

    config_class = IdealConfig
    name = "ideal"

    def __init__(self, config):
        super().__init__(config)
        self.goals = [[*START, 50.0]]

    def get_observation(self):
        return dict(zip(FEATURES, self.goals[-1], strict=True))

    def send_action(self, action):
        self.goals.append([action[key] for key in FEATURES])
        return action

    def disconnect(self):
        np.save(os.environ["GOALS_FILE"], self.goals)


@TeleoperatorConfig.register_subclass("chunks")
@dataclass(kw_only=True)
class ChunksConfig(TeleoperatorConfig):
    """Settings of a policy that replans without regard to where the arm is."""


class Chunks(Idle, Teleoperator):
    """Chunks of smooth actions that begin anywhere; some are no numbers."""

    config_class = ChunksConfig
    name = "chunks"

    def __init__(self, config):
        super().__init__(config)
        self.random = np.random.default_rng(0)
        self.count = 0

    def get_action(self):
        if self.count % CHUNK == 0:
            self.base = START + 60.0 * self.random.normal(size=len(NAMES))
            self.slope = self.random.normal(size=len(NAMES))
        self.count += 1
        joints = self.base + self.slope * (self.count % CHUNK)
        if self.count % 100 == 0:
            joints = joints + np.nan
        return dict(zip(FEATURES, [*joints, float(self.count % 100)], strict=True))
