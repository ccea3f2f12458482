"""Plants: robots that move under velocity commands and show their joint angles by encoders.

A `RealPlant` is a robot in the world. It has a clock of its own and goes on without the loop.
"""

from abc import ABC, abstractmethod
from typing import Any, ClassVar, Literal

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.robot import Robot

Feedback = Literal["commanded", "measured"]
FEEDBACKS: tuple[Feedback, ...] = ("commanded", "measured")
"""Joint angles of a real arm that its controller gets: summed commands, or encoders."""

NEAR = 0.01
"""Largest distance of a joint of a real arm from the start posture of a run [rad]."""


class Plant(ABC):
    """A robot that a run moves: `start` once, then `read` and `move` at every control step.

    Attributes:
        packages: Installed packages whose versions belong into the record.
        exact: Whether the joints move as they are told and are read as they are.
    """

    packages: ClassVar[tuple[str, ...]] = ()
    exact: ClassVar[bool] = False

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

    def settings(self) -> dict[str, Any]:
        """Return the plant's entries in the settings of a record."""
        return {}


class RealPlant(Plant):
    """A robot that runs by a clock of its own and stands somewhere before a run begins.

    `start` connects and refuses a start posture from which the robot is far; the motion begins at
    the first `read`. `move` sends a command. `q`, `read` and `time` are those of the robot's next
    state after it, for which they wait.

    A lost connection or an error of the robot is no exception but a `fault`, after which nothing
    moves and the last state stays.
    """

    @property
    @abstractmethod
    def period(self) -> float:
        """Control period of the robot [s]; connects if need be."""

    @property
    @abstractmethod
    def posture(self) -> Vector:
        """Measured joint angles before the run [rad], (n,); connects if need be."""

    @property
    @abstractmethod
    def time(self) -> float:
        """Time since the motion began, by the robot's clock [s]."""

    @property
    @abstractmethod
    def substitutes(self) -> Matrix | None:
        """Last command and the one before, (2, n) [rad/s], as the robot itself has gone on.

        None if it got every command in time.
        """

    def check_start(self, robot: Robot, q0: Vector, dt: float, joints: int) -> None:
        """Raise InvalidInputError unless a run of a robot fits the arm, which has so many joints.

        Args:
            robot: The robot of the run, n joints.
            q0: Its start posture [rad], (n,).
            dt: Its control period [s].
            joints: Number of the arm's joints.
        """
        if robot.dof != joints:
            raise InvalidInputError("robot", f"has {robot.dof} joints, the arm {joints}", robot)
        period = self.period
        if abs(dt - period) > 1e-9 * period:
            raise InvalidInputError("dt", f"must be the robot's {period:g} s, not {dt:g} s", dt)
        away = np.abs(q0 - self.posture)
        if not away.max() <= NEAR:
            joint = int(away.argmax())
            stands = f"the arm stands {away[joint]:.3g} rad from it, at {self.posture[joint]:.4g}"
            raise InvalidInputError("q0", f"joint {joint + 1}: {stands} rad", q0)

    def with_room(self, robot: Robot) -> Robot:
        """Return a robot with limits inside of which commands may also come too late."""
        return robot

    @abstractmethod
    def stop(self) -> None:
        """Let the robot brake if it still moves, end the motion and release the robot."""
