"""Plants: robots that move under velocity commands and show their joint angles by encoders.

A `RealPlant` is a robot in the world. It has a clock of its own and goes on without the loop.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, get_args

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.robot import Robot

Feedback = Literal["commanded", "measured"]
"""Joint angles of a real arm that its controller gets: summed commands, or encoders."""

JOINTS = 7
"""Number of joints of a real arm."""

NEAR = 0.01
"""Largest distance of a joint of a real arm from the start posture of a run [rad]."""


class Plant(ABC):
    """A robot that a run moves: `start` once, then `read` and `move` at every control step.

    Attributes:
        packages: Installed packages whose versions belong into the record.
        exact: Whether the joints move as they are told and are read as they are.
        is_real: Whether it is a robot in the world, which goes on by a clock of its own.
    """

    packages: ClassVar[tuple[str, ...]] = ()
    exact: ClassVar[bool] = False
    is_real: ClassVar[bool] = False

    @abstractmethod
    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Put a robot at rest at joint angles `q0` (n,) [rad].

        Args:
            robot: The robot, n joints.
            q0: Joint angles at the start [rad], (n,).
            dt: Control period [s].
            seed: Seed of everything random.
        """

    @property
    @abstractmethod
    def q(self) -> Vector:
        """True joint angles [rad], (n,), a copy."""

    @abstractmethod
    def read(self) -> Vector:
        """Measure the joint angles [rad], (n,); every call is a new reading."""

    @abstractmethod
    def move(self, command: Vector) -> None:
        """Follow a velocity command (n,) [rad/s] for one control period."""

    @property
    def torque(self) -> Vector | None:
        """Largest torques of the last `move` [N m], (n,); None for a plant without motors."""
        return None

    @property
    def fault(self) -> str | None:
        """Reason for which the plant ended the run; None while it moves."""
        return None

    @property
    def time(self) -> float:
        """Time since the motion began, by the clock of a plant that has one [s]."""
        return 0.0

    @property
    def substitutes(self) -> Matrix | None:
        """Last command and the one before, (2, n) [rad/s], as the plant itself has gone on.

        None if it got every command in time.
        """
        return None

    def stop(self) -> None:  # noqa: B027
        """Let the robot brake if it still moves, end the motion and release the robot."""

    def settings(self) -> dict[str, Any]:
        """Return the plant's entries in the settings of a record."""
        return {}


@dataclass
class RealMotion:
    """Progress of a motion of a real arm.

    Attributes:
        commanded: Sum of the commands, from the position at the beginning [rad], (7,).
        command: Last command [rad/s], (7,).
        previous: Command before it, as the robot has it [rad/s], (7,).
        substitutes: `Plant.substitutes`, (2, 7).
        time: Time since the motion began, by the robot's clock [s].
        late: Times at which commands were found to have come too late [s].
        began: Whether it has begun.
        fault: `Plant.fault`.
    """

    commanded: Vector = field(default_factory=lambda: np.zeros(JOINTS))
    command: Vector = field(default_factory=lambda: np.zeros(JOINTS))
    previous: Vector = field(default_factory=lambda: np.zeros(JOINTS))
    substitutes: Matrix | None = None
    time: float = 0.0
    late: list[float] = field(default_factory=list)
    began: bool = False
    fault: str | None = None


class RealPlant(Plant):
    """A robot of 7 joints that stands somewhere before a run begins.

    `start` connects and refuses a start posture from which the robot is far; the motion begins at
    the first `read`. `move` sends a command and waits for the robot's next state.

    A lost connection or an error of the robot is no exception but a `fault`, after which nothing
    moves and the last state stays.

    Args:
        host: Address of the robot's controller.
        feedback: Joint angles that `read` returns: ``"commanded"``, the sum of the commands, has
            neither noise nor delay; ``"measured"`` are the encoders'.

    Attributes:
        name: Name of the plant in the settings of a record.
        tip_speed: Limit of the tip's speed that leaves room to the robot's own [m/s]; None: none.
    """

    is_real: ClassVar[bool] = True
    name: ClassVar[str]
    tip_speed: ClassVar[float | None] = None

    def __init__(self, host: str, feedback: Feedback) -> None:
        checks.one_of("feedback", feedback, get_args(Feedback))
        self.host = host
        self.feedback = feedback
        self._motion = RealMotion()

    @property
    @abstractmethod
    def period(self) -> float:
        """Control period of the robot [s]; connects if need be."""

    @property
    @abstractmethod
    def posture(self) -> Vector:
        """Measured joint angles of the last state [rad], (7,); connects if need be."""

    @abstractmethod
    def _begin(self) -> None:
        """Begin a motion from rest, or note the fault."""

    @abstractmethod
    def _receive(self) -> None:
        """Wait for the robot's next state and note what it says of the motion."""

    @abstractmethod
    def _send(self) -> None:
        """Send the last command."""

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Connect to the robot, which has to stand at joint angles `q0` (7,) [rad] already.

        Raises:
            MissingDependencyError: The package of the robot's protocol is not installed.
            InvalidInputError: No robot answers, it stands elsewhere, or the robot of the run has
                other joints or another control period.
        """
        if robot.dof != JOINTS:
            raise InvalidInputError("robot", f"has {robot.dof} joints, the arm {JOINTS}", robot)
        period = self.period
        if abs(dt - period) > 1e-9 * period:
            raise InvalidInputError("dt", f"must be the robot's {period:g} s, not {dt:g} s", dt)
        away = np.abs(q0 - self.posture)
        if not away.max() <= NEAR:
            joint = int(away.argmax())
            stands = f"the arm stands {away[joint]:.3g} rad from it, at {self.posture[joint]:.4g}"
            raise InvalidInputError("q0", f"joint {joint + 1}: {stands} rad", q0)
        self._motion = RealMotion(np.array(q0))

    def with_room(self, robot: Robot) -> Robot:
        """Return a robot with limits inside of which commands may also come too late."""
        return robot

    @property
    def q(self) -> Vector:
        """Measured joint angles [rad], (7,), a copy."""
        return self.posture

    @property
    def time(self) -> float:
        """Time since the motion began, by the robot's clock [s]."""
        return self._motion.time

    @property
    def substitutes(self) -> Matrix | None:
        """Last command and the one before, (2, 7) [rad/s], if the robot lost ours; else None."""
        return self._motion.substitutes

    @property
    def fault(self) -> str | None:
        """Reason for which the robot can no longer be commanded; None while it can."""
        return self._motion.fault

    def read(self) -> Vector:
        """Return the commanded or the measured joint angles [rad], (7,); the first call begins."""
        if not self._motion.began:
            self._begin()
            self._motion.began = True
        return self._motion.commanded.copy() if self.feedback == "commanded" else self.posture

    def move(self, command: Vector) -> None:
        """Send a velocity command (7,) [rad/s] for the period of the last state."""
        motion = self._motion
        if motion.fault is not None or not motion.began:
            return
        known = motion.substitutes
        motion.previous = motion.command if known is None else known[0]
        motion.command = np.array(command)
        motion.commanded = motion.commanded + self.period * motion.command
        motion.substitutes = None
        self._send()
        self._receive()

    def settings(self) -> dict[str, Any]:
        """Return the plant's entries in the settings of a record."""
        entries = {"name": self.name, "host": self.host, "feedback": self.feedback}
        return {"plant": entries | {"late_s": list(self._motion.late)}}
