"""An ideal plant: joints that move as they are told."""

from typing import ClassVar

from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.simulation.plants.base import Plant


class IdealPlant(Plant):
    """Joints without mass or friction, q + dt dq after each control period.

    The command is the mean velocity of a step, by the method of `iiwa_dnn.simulation.motion`.
    """

    exact: ClassVar[bool] = True

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Put the arm at q0 (n,) [rad]."""
        self._q = q0.copy()
        self._dt = dt

    @property
    def q(self) -> Vector:
        """Joint positions [rad], (n,); `move` does not change the array."""
        return self._q

    def read(self) -> Vector:
        """Measure the joint positions [rad], (n,), exactly."""
        return self._q

    def move(self, command: Vector) -> None:
        """Move by dt times the command (n,) [rad/s]."""
        self._q = self._q + self._dt * command
