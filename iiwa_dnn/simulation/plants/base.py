"""Plants: robots that move under velocity commands and show their joint angles by encoders."""

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from iiwa_dnn.qp.program import Vector
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
