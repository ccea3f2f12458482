"""A LeRobot robot that wraps another one: its actions pass a shield that iiwa_dnn exported.

LeRobot finds it by its name, so that its commands take ``--robot.type=shielded``.
docs/integrations.md has the lines to type.
"""

import importlib
import logging
import time
from dataclasses import dataclass, field
from typing import Any

import draccus
import numpy as np
from lerobot.robots import Robot, RobotConfig, make_robot_from_config

EARLY = 0.8
"""Fraction of the shield's period before which a next action is not yet taken."""

REST = 1e-9
"""Velocity of a joint at rest [rad/s]: at a position limit it may back off by rounding."""


@RobotConfig.register_subclass("shielded")
@dataclass(kw_only=True)
class ShieldedConfig(RobotConfig):
    """Settings of a shielded robot.

    Attributes:
        robot: Settings of the robot that is wrapped, with its type.
        shield: Name of the exported package, whose period is 1 / fps.
        joints: Names of the robot's motors in the order of the shield's joints; none: its own.
    """

    robot: dict[str, Any]  # a choice of RobotConfig would contain itself
    shield: str
    joints: list[str] = field(default_factory=list)


def wrapped(name: str) -> Any:
    """Return a property that is the one of the robot that is wrapped."""
    return property(lambda own: getattr(own.robot, name))


class Shielded(Robot):
    """A robot whose goal positions keep the limits of a shield; other keys go through.

    Attributes:
        robot: The robot that is wrapped.
        shields: The shield, of one arm.
    """

    config_class = ShieldedConfig
    name = "shielded"
    observation_features = wrapped("observation_features")
    action_features = wrapped("action_features")
    is_connected = wrapped("is_connected")
    is_calibrated = wrapped("is_calibrated")
    calibrate = wrapped("calibrate")
    configure = wrapped("configure")

    def __init__(self, config: ShieldedConfig) -> None:
        """Make the robot and its shield.

        Raises:
            ValueError: The robot takes no position of one of the shield's joints.
        """
        super().__init__(config)
        self.config = config
        self.robot = make_robot_from_config(draccus.decode(RobotConfig, config.robot))
        package = importlib.import_module(config.shield)
        # Of one arm: it brakes at joint positions that are not finite, where `Shield` raises.
        self.shields = package.Shields(1)
        self._dt = package.DT
        self._keys = [f"{each}.pos" for each in config.joints or package.JOINT_NAMES]
        missing = [each for each in self._keys if each not in self.robot.action_features]
        if missing or len(self._keys) != len(package.JOINT_NAMES):
            known = ", ".join(self.robot.action_features)
            raise ValueError(f"joints: {missing or self._keys} do not fit to {known}")
        self._restart()

    def _restart(self) -> None:
        self.shields.reset()
        self._measured: Any = None
        self._command: Any = None
        self._sent: dict[str, Any] = {}
        self._time = 0.0
        self._said = ""

    def __getattr__(self, name: str) -> Any:
        """Return what the robot that is wrapped has beside LeRobot's interface, as cameras."""
        if name.startswith("__") or name == "robot":
            raise AttributeError(name)
        return getattr(self.robot, name)

    def connect(self, calibrate: bool = True) -> None:
        """Connect the robot, which stands."""
        self.robot.connect(calibrate)
        self._restart()

    def get_observation(self) -> dict[str, Any]:
        """Return the robot's observation, and keep its joint positions for the next action."""
        found = self.robot.get_observation()
        self._measured = np.radians([[found[key] for key in self._keys]])
        return found

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Send the goal positions closest to an action that keep every limit; return what is sent.

        An action that comes sooner than the shield's period admits does not count.
        """
        now = time.perf_counter()
        if now - self._time < EARLY * self._dt:
            return self._sent
        self._time = now
        self._step(action)
        words = "; ".join(self.shields.active_limits(0))
        if words != self._said:
            logging.info("shield: %s", words or "follows the actions")
        self._said = words
        return self._sent

    def _step(self, action: dict[str, Any]) -> None:
        """Take a step towards an action; it brakes without joint positions since the last one."""
        if self._command is None:
            self.get_observation()
            if not np.isfinite(self._measured).all():
                raise ValueError("the robot's joint positions are not finite")
        goal = np.radians([[action.get(key, np.nan) for key in self._keys]])
        q = np.full_like(goal, np.nan) if self._measured is None else self._measured
        self._command = self.shields.step(q, position=goal, dt=self._dt)
        self._measured = None
        goals = np.degrees(self._command.next_q[0]).tolist()
        self._sent = self.robot.send_action(action | dict(zip(self._keys, goals, strict=True)))

    def disconnect(self) -> None:
        """Bring the arm to rest, and disconnect the robot."""
        self.shields.halt()
        end = time.perf_counter() + 1.0 + 2.0 * self.shields.stopping_time(0)
        while self._command is not None and np.abs(self._command.dq).max() > REST:
            if time.perf_counter() > end:
                break
            time.sleep(self._dt)
            self.get_observation()
            self._step(self._sent)
        self.robot.disconnect()
