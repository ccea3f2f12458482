"""A LeRobot robot that wraps another one: its actions pass a shield that iiwa_dnn exported.

LeRobot finds it by its name, so that its commands take ``--robot.type=shielded``.
docs/integrations.md has the lines to type.
"""

import logging
import re
import time
from dataclasses import dataclass, field
from typing import Any

import armstep
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
        shield: File of the shield's tables, whose period is 1 / fps.
        joints: Names of the robot's motors in the order of the shield's joints; none: its own.
        record: Folder that the last minutes are recorded in; none: they are not.
        following_error: Distance of a motor from its goal [rad] beyond which the goal waits.
    """

    robot: dict[str, Any]  # a choice of RobotConfig would contain itself
    shield: str
    joints: list[str] = field(default_factory=list)
    record: str = ""
    following_error: float = 0.3


def wrapped(name: str) -> Any:
    """Return a property that is the one of the robot that is wrapped."""
    return property(lambda own: getattr(own.robot, name))


class Shielded(Robot):
    """A robot whose goal positions keep the limits of a shield; other keys go through."""

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
            ValueError: The shield is none, or does not fit to the robot.
        """
        super().__init__(config)
        self.config = config
        self.robot = make_robot_from_config(draccus.decode(RobotConfig, config.robot))
        try:
            # Of one arm: it brakes at positions that are not finite, where `Shield` raises.
            self._shields: Any = armstep.Shields(config.shield, 1)
        except armstep.ArmstepError as error:
            raise ValueError(f"shield: {error}") from error
        tables = self._shields.tables
        self._recorded: Any = None
        if config.record:
            self._recorded = self._shields = armstep.recorded(self._shields, config.record)
        if tables.delay:
            raise ValueError("shield: goal positions need one without a delay")
        self._dt = tables.dt
        self._motors = config.joints or list(tables.joint_names)
        self._keys = [f"{each}.pos" for each in self._motors]
        known = self.robot.action_features
        count = len(tables.joint_names)
        if len(self._keys) != count or len({*self._keys} & {*known}) != count:
            raise ValueError(f"joints: {self._keys} are not {count} different ones of {[*known]}")
        self._restart()

    def _restart(self) -> None:
        self._shields.reset()
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
        self._measured = self._radians(found)
        return found

    def _radians(self, values: dict[str, Any]) -> Any:
        """Return the positions (1, n) [rad] among values; None if one is no finite number."""
        try:
            found = np.radians([[float(values[key]) for key in self._keys]])
        except (KeyError, TypeError, ValueError):
            return None
        return found if np.isfinite(found).all() else None

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Send the goal positions closest to an action that keep every limit; return what is sent.

        An action that comes sooner than the shield's period admits does not count.
        """
        now = time.perf_counter()
        if now - self._time >= EARLY * self._dt:
            self._time = now
            goal = self._radians(action)
            self._step(action, goal, "" if goal is not None else "no number for each joint")
        return self._sent

    def _step(self, action: dict[str, Any], goal: Any, reason: str) -> None:
        """Take a step towards a goal (1, n) [rad], or brake for a reason."""
        if self._command is None:
            self.get_observation()
            if self._measured is None:
                raise ValueError("the robot's joint positions are not finite")
        measured, self._measured = self._measured, None
        if measured is None:
            reason = reason or "no observation since the last action, or no number for each joint"
        # Goals never jump: the shield is told its own, and a motor that does not follow is awaited.
        q = measured if self._command is None else self._command.next_q
        request = {"dq": np.zeros_like(q)}
        if not reason:
            away = q - measured
            waits = (np.abs(away) > self.config.following_error) & ((goal - q) * away > 0.0)
            request = {"position": np.where(waits, q, goal)}
            reason = "; ".join(f"{self._motors[i]} does not follow" for i in waits[0].nonzero()[0])
        if self._recorded:
            self._recorded.measured = np.nan * q if measured is None else measured
        self._command = self._shields.step(q, dt=self._dt, **request)
        words = reason or [*self._shields.active_limits(0), "follows the actions"][0]
        words = re.sub(r"\bjoint (\d+)", lambda found: self._motors[int(found[1]) - 1], words)
        if words != self._said:
            logging.info("shield: %s", words)
        self._said = words
        goals = np.degrees(self._command.next_q[0]).tolist()
        self._sent = self.robot.send_action(action | dict(zip(self._keys, goals, strict=True)))

    def disconnect(self) -> None:
        """Bring the arm to rest, and disconnect the robot."""
        end = time.perf_counter() + 1.0 + 2.0 * self._shields.stopping_time(0)
        while self._command is not None and np.abs(self._command.dq).max() > REST:
            if time.perf_counter() > end:
                break
            time.sleep(self._dt)
            self._step(self._sent, None, "disconnects")
        if self._recorded:
            self._recorded.close()
        self.robot.disconnect()
