"""Plants: robots that move under velocity commands and show their joint positions by encoders."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, NamedTuple

from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot import Robot


class PlantState(NamedTuple):
    """The state of a plant after a control period.

    Attributes:
        q: True joint positions [rad], (n,), an array that stays as it is.
        torque: Largest torques of the period [N m], (n,), signed; None for joints without motors.
        fault: Reason for which the plant ends the run; None while it moves.
    """

    q: Vector
    torque: Vector | None = None
    fault: str | None = None


class Plant(ABC):
    """A robot that a run moves: `start` once, then `read` and `move` at every control step.

    Attributes:
        exact: Whether the joints move as commanded and are read as they are.
    """

    exact: ClassVar[bool] = False

    @abstractmethod
    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> Mapping[str, Any]:
        """Put a robot at rest at joint positions `q0` (n,) [rad].

        Args:
            robot: The robot, n joints.
            q0: Joint positions at the start [rad], (n,).
            dt: Control period [s].
            seed: Seed of everything random.

        Returns:
            Entries for the settings of the record, values that JSON can hold.
        """

    @abstractmethod
    def read(self) -> Vector:
        """Measure the joint positions [rad], (n,); every call is a new reading."""

    @abstractmethod
    def move(self, command: Vector) -> PlantState:
        """Follow a velocity command (n,) [rad/s] for one control period."""


class IdealPlant(Plant):
    """Joints without mass or friction, at q + dt dq after each control period."""

    exact: ClassVar[bool] = True

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> Mapping[str, Any]:
        """Put the arm at q0 (n,) [rad]."""
        self._q = q0.copy()
        self._dt = dt
        return {}

    def read(self) -> Vector:
        """Measure the joint positions [rad], (n,), exactly."""
        return self._q

    def move(self, command: Vector) -> PlantState:
        """Move by dt times the command (n,) [rad/s]."""
        self._q = self._q + self._dt * command
        return PlantState(self._q)
