"""A LeRobot robot that wraps another one: its actions pass a shield that iiwa_dnn exported.

LeRobot finds it by its name, so that its commands take ``--robot.type=shielded``.
docs/integrations.md has the lines to type.
"""

import logging
import math
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
        gripper_speed: Largest speed of what is no joint [1/s], in its own unit.
        lead: Actions are a stream, which the motors pass through, continued by 0, 1 or 2 of them
            beyond the last one; none: each is a rest.
    """

    robot: dict[str, Any]  # a choice of RobotConfig would contain itself
    shield: str
    joints: list[str] = field(default_factory=list)
    record: str = ""
    following_error: float = 0.3
    gripper_speed: float = math.inf
    lead: int | None = None


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
        if config.lead not in (None, 0, 1, 2):
            raise ValueError(f"lead: {config.lead} is none of 0, 1, 2")
        try:
            self._shield: Any = armstep.Shield(config.shield)
            joints = self._shield.tables.joint_names
            self._motors = config.joints or [*joints]
            keys = [f"{each}.pos" for each in self._motors]
            known = [*self.robot.action_features]
            if len({*keys} & {*known}) != len(joints):
                raise ValueError(f"joints: {keys} are not {len(joints)} different ones of {known}")
            self._recorded: Any = None
            if config.record:
                self._recorded = self._shield = armstep.recorded(self._shield, config.record)
            self._restart()
        except armstep.ArmstepError as error:
            raise ValueError(f"shield: {error}") from error

    def _restart(self) -> None:
        """Begin anew, where the robot is observed next."""
        joints = armstep.Joints(self._motors, math.radians(1.0))
        error = self.config.following_error
        about = {"following_error": error, "joints": joints, "stands": True}
        self._drive = armstep.Drive(self._shield, takes_velocity=False, **about)
        self._others: dict[str, armstep.Channel] = {}
        self._observed: dict[str, Any] = {}  # since the last action
        self._sent: dict[str, Any] = {}
        self._time = 0.0  # of the last action [s]
        self._now = 0.0  # time of the periods [s]
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
        """Return the robot's observation, and keep it for the next action."""
        self._observed = self.robot.get_observation()
        return self._observed

    def _radians(self, values: dict[str, Any]) -> Any:
        """Return the joint positions (n,) [rad] among values.

        Raises:
            InputError: One of them is no finite number, or not there.
        """
        return self._drive.joints.ordered(
            (key.removesuffix(".pos") for key in values), values.values()
        )

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        """Send the goal positions closest to an action that keep every limit; return what is sent.

        An action that comes sooner than the shield's period admits does not count.
        """
        now = time.perf_counter()
        if now - self._time >= EARLY * self._shield.dt:
            self._time = now
            self._step(action)
        return self._sent

    def _step(self, action: dict[str, Any]) -> None:
        """Take a step towards an action, or brake."""
        drive = self._drive
        observed = self._observed
        if not drive.has_begun:
            observed = self.get_observation()
        self._observed = {}
        dt = self._shield.dt
        self._now += dt  # goals are where the robot is a period later, whenever it is observed
        reasons = {"blind": "" if observed else "no observation since the last action"}
        request: dict[str, Any] = {}
        measured = np.full(len(self._motors), np.nan)
        try:
            if observed:
                measured = self._radians(observed)
                drive.see(self._now, measured)
        except armstep.InputError:
            reasons["blind"] = "no observed number for each joint"
        if self._recorded:
            self._recorded.measured = measured
        try:
            request = {"position": self._radians(action), "lead": self.config.lead}
        except armstep.InputError:
            reasons["idle"] = "no number for each joint"
        command = drive.step(self._now, dt, request, **reasons)
        if command is None:
            raise ValueError(f"the robot does not begin: {drive.fault}")
        words = drive.fault or [*command.active_limits, "follows the actions"][0]
        words = re.sub(r"\bjoint (\d+)", lambda found: self._motors[int(found[1]) - 1], words)
        if words != self._said:
            logging.info("shield: %s", words)
        self._said = words
        goals = {f"{name}.pos": goal for name, goal in drive.joints.goals(command.next_q).items()}
        for key, value in action.items():
            if key not in goals:
                start = observed.get(key, math.nan)
                channel = armstep.Channel(self.config.gripper_speed, start)
                goals[key] = self._others.setdefault(key, channel).step(float(value), dt)
        self._sent = self.robot.send_action(goals)

    def disconnect(self) -> None:
        """Bring the arm to rest, and disconnect the robot."""
        drive = self._drive
        drive.hold("disconnects")
        stopping = drive.command.stopping_time if drive.command is not None else 0.0
        end = time.perf_counter() + 1.0 + 2.0 * stopping
        while not drive.is_at_rest and time.perf_counter() < end:
            time.sleep(self._shield.dt)
            self._step(self._sent)
        if self._recorded:
            self._recorded.close()
        self.robot.disconnect()
