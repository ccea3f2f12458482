"""Plants: robots that move under velocity commands and show their joint angles by encoders.

A `RealPlant` is a robot in the world. It has a clock of its own and goes on without the loop.
"""

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from iiwa_dnn.qp.program import Matrix, Vector
from iiwa_dnn.robot import Robot


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

    def with_room(self, robot: Robot) -> Robot:
        """Return a robot with limits inside of which commands may also come too late."""
        return robot

    @abstractmethod
    def stop(self) -> None:
        """Let the robot brake if it still moves, end the motion and release the robot."""
