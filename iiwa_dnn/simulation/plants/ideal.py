"""An ideal plant: joints that move as they are told."""

from iiwa_dnn.qp.program import Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.simulation.plants.base import Plant


class IdealPlant(Plant):
    """Joints without mass or friction, q + dt dq after each control period.

    The command is the mean velocity of a step, by the method of `iiwa_dnn.simulation.motion`.
    """

    def start(self, robot: Robot, q0: Vector, dt: float, seed: int) -> None:
        """Put the arm at q0 (n,) [rad]."""
        self._q, self._dt = q0.copy(), dt

    @property
    def q(self) -> Vector:
        """Joint positions [rad], (n,), a new array."""
        return self._q.copy()

    @property
    def state(self) -> Vector:
        """The joint positions themselves [rad], (n,): compiled code moves them in place."""
        return self._q

    def read(self) -> Vector:
        """Measure the joint positions [rad], (n,), exactly."""
        return self._q.copy()

    def move(self, command: Vector) -> None:
        """Move by dt times the command (n,) [rad/s]."""
        self._q += self._dt * command
