"""The plant of a run: the part that moves under the controller's velocity commands."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from iiwa_dnn.qp import Vector
from iiwa_dnn.robot import Robot


class Plant(ABC):
    """An arm that follows joint velocity commands, one control period after the other.

    Attributes:
        packages: Installed packages whose versions belong into the record.
    """

    packages: ClassVar[tuple[str, ...]] = ()

    @abstractmethod
    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Put the arm at rest at joint positions q0 (n,) [rad].

        Args:
            robot: The robot, n joints.
            q0: Joint positions [rad], (n,).
            dt: Control period [s].
            seed: Seed of whatever is random; the same seed gives the same run.

        Raises:
            InvalidInputError: The plant cannot take the robot or the control period.
        """

    @property
    @abstractmethod
    def q(self) -> Vector:
        """True joint positions [rad], (n,), a new array."""

    @abstractmethod
    def read(self) -> Vector:
        """Measure the joint positions [rad], (n,); every call is a new reading."""

    @abstractmethod
    def move(self, command: Vector) -> Vector:
        """Follow a joint velocity command (n,) [rad/s] for one control period.

        Returns:
            The mean joint velocity of the period [rad/s], (n,).
        """

    @property
    def torque(self) -> Vector | None:
        """Largest joint torques of the last period [N m], (n,); None for a plant without masses."""
        return None

    @property
    def diverged(self) -> bool:
        """Whether the plant has left the range in which its model makes sense."""
        return False

    def settings(self) -> dict[str, Any]:
        """Return what the record says of the plant, as values that JSON can hold."""
        return {}
