"""A LeRobot robot that wraps another one: its actions pass a shield that iiwa_dnn exported.

LeRobot finds it by its name, so that its commands take ``--robot.type=shielded``.
docs/integrations.md has the lines to type.
"""

import importlib
import logging
import time
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import draccus
import numpy as np
from lerobot.robots import Robot, RobotConfig, make_robot_from_config

EARLY = 0.8
"""Share of the shield's period before which a next action is not yet taken."""


@RobotConfig.register_subclass("shielded")
@dataclass(kw_only=True)
class ShieldedConfig(RobotConfig):
    """Settings of a shielded robot.

    Attributes:
        robot: Settings of the robot that is wrapped, with its type.
        shield: Name of the exported package, whose period is 1 / fps.
        joints: Names of the robot's motors in the order of the shield's joints; none: its own.
        delay: Time by which the motors are behind their goals [s].
    """

    robot: dict[str, Any]  # a choice of RobotConfig would contain itself
    shield: str
    joints: list[str] = field(default_factory=list)
    delay: float = 0.0


class Shielded(Robot):
    """A robot whose goal positions keep the limits of a shield; other keys go through.

    Attributes:
        robot: The robot that is wrapped.
        shield: The shield.
    """

    config_class = ShieldedConfig
    name = "shielded"

    def __init__(self, config: ShieldedConfig) -> None:
        """Make the robot and its shield.

        Raises:
            ValueError: The robot takes no position of one of the shield's joints.
        """
        super().__init__(config)
        self.config = config
        self.robot = make_robot_from_config(draccus.decode(RobotConfig, config.robot))
        package = importlib.import_module(config.shield)
        self.shield = package.Shield()
        self._dt = package.DT
        self._period = {"dt": package.DT} if package.LONGEST_PERIOD else {}
        self._keys = [f"{each}.pos" for each in config.joints or package.JOINT_NAMES]
        missing = [each for each in self._keys if each not in self.robot.action_features]
        if missing or len(self._keys) != len(package.JOINT_NAMES):
            known = ", ".join(self.robot.action_features)
            raise ValueError(f"joints: {missing or self._keys} do not fit to {known}")
        self._restart()

    def _restart(self) -> None:
        self.shield.reset()
        self._measured: Any = None
        self._command: Any = None
        self._sent: dict[str, Any] = {}
        self._pending: list[Any] = []
        self._time = 0.0
        self._said = ""

    def __getattr__(self, name: str) -> Any:
        """Return what the robot that is wrapped has beside LeRobot's interface, as cameras."""
        if name.startswith("__") or name == "robot":
            raise AttributeError(name)
        return getattr(self.robot, name)

    @cached_property
    def observation_features(self) -> dict[str, Any]:
        """Features of the robot's observations."""
        return self.robot.observation_features

    @cached_property
    def action_features(self) -> dict[str, Any]:
        """Features of the robot's actions."""
        return self.robot.action_features

    @property
    def is_connected(self) -> bool:
        """Test whether the robot is connected."""
        return self.robot.is_connected

    @property
    def is_calibrated(self) -> bool:
        """Test whether the robot is calibrated; its offsets are its own."""
        return self.robot.is_calibrated

    def connect(self, calibrate: bool = True) -> None:
        """Connect the robot, which stands."""
        self.robot.connect(calibrate)
        self._restart()

    def calibrate(self) -> None:
        """Calibrate the robot."""
        self.robot.calibrate()

    def configure(self) -> None:
        """Configure the robot."""
        self.robot.configure()

    def get_observation(self) -> dict[str, Any]:
        """Return the robot's observation, and keep its joint positions for the next action."""
        found = self.robot.get_observation()
        measured = np.radians([found[key] for key in self._keys])
        self._measured = measured if np.isfinite(measured).all() else None
        return found

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Send the goal positions closest to an action that keep every limit; return what is sent.

        An action that comes sooner than the shield's period admits does not count.
        """
        now = time.perf_counter()
        if now - self._time < EARLY * self._dt:
            return self._sent
        if self._command is None and self._measured is None:
            self.get_observation()
        self._time = now
        goal = np.radians([action.get(key, np.nan) for key in self._keys])
        self._step(goal)
        self._sent = self.robot.send_action(action | self._goals())
        return self._sent

    def _step(self, goal: Any) -> None:
        """Take a step of the shield towards joint positions [rad]."""
        pending = self._pending[: int(np.ceil(self.config.delay / self._dt))]
        shares = np.clip(self.config.delay / self._dt - np.arange(len(pending)), 0.0, 1.0)
        way = sum(share * self._dt * dq for share, dq in zip(shares, pending, strict=True))
        if self._measured is not None:
            q = self._measured + way
        elif self._command is not None:  # no measured positions: it brakes on its own
            q = self._command.next_q
            goal = goal + np.nan
        else:
            raise ValueError("the robot's joint positions are not finite")
        self._command = self.shield.step(q, position=goal, **self._period)
        self._measured = None
        self._pending = [self._command.dq, *pending]
        words = "; ".join(self._command.active_limits)
        if words != self._said:
            logging.info("shield: %s", words or "follows the actions")
        self._said = words

    def _goals(self) -> dict[str, float]:
        return dict(zip(self._keys, np.degrees(self._command.next_q).tolist(), strict=True))

    def disconnect(self) -> None:
        """Bring the arm to rest, and disconnect the robot."""
        self.shield.halt()
        count = 0 if self._command is None else int(2.0 * self._command.stopping_time / self._dt)
        for _ in range(count + 10):
            if self._command is None or not self._command.dq.any():
                break
            time.sleep(self._dt)
            self.get_observation()
            self._step(self._command.next_q)
            self._sent = self.robot.send_action(self._sent | self._goals())
        self.robot.disconnect()
