"""The arrays of a run while it is being made."""

from __future__ import annotations

from typing import Any

import numpy as np

from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.qp import Vector
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes import Scheme

COMPLETED = "completed"


class History:
    """Arrays of a record, written step by step or block by block.

    Attributes:
        q: Joint positions [rad], (N+1, n).
        dq: Joint velocities that moved the robot [rad/s], (N, n).
        dq_solver: Joint velocities that the controller answered [rad/s], (N, n).
        torque: Joint torques [N m], (N, n), of a plant that has them.
        stops: Steps at which the run stopped.
    """

    def __init__(self, steps: int, controller: Controller, q0: Vector, torques: bool) -> None:
        """Allocate for so many steps; the first posture is q0 (n,) [rad]."""
        n = q0.size
        self._controller, self.stops = controller, set[int]()
        self.q = np.empty((steps + 1, n))
        self.q[0] = q0
        self.dq, self.dq_solver = np.zeros((steps, n)), np.zeros((steps, n))
        self.torque = np.zeros((steps, n)) if torques else None
        self._position, self._rotation = np.empty((steps + 1, 3)), np.empty((steps + 1, 3, 3))
        self._position_desired = np.empty((steps + 1, 3))
        self._rotation_desired = np.empty((steps + 1, 3, 3))
        self._kinetic_index, self._kkt_residual = np.zeros(steps), np.empty(steps)
        self._iterations = np.empty(steps, dtype=np.int64)

    def stay(self, k: int) -> None:
        """Let the robot stay where it is in step k."""
        self.stops.add(k)
        self.dq[k] = 0.0
        self.q[k + 1] = self.q[k]

    def add_block(self, first: int, steps: int, stages: int, answers: Answers) -> None:
        """Take in the answers of a stretch of steps, each of so many stages."""
        rows = slice(first, first + steps)
        places = answers.places[::stages]
        # A placement holds the rotation column by column.
        self._rotation[rows] = places[:, :9].reshape(-1, 3, 3).swapaxes(1, 2)
        self._position[rows] = places[:, 9:]
        at_steps = answers.targets[: steps * stages : stages]
        self._position_desired[rows] = at_steps[:, :3]
        self._rotation_desired[rows] = at_steps[:, 3:12].reshape(-1, 3, 3)
        self._kkt_residual[rows] = answers.residuals.reshape(steps, -1).max(axis=1)
        self._iterations[rows] = answers.iterations.reshape(steps, stages).sum(axis=1)
        scheme = self._controller.scheme
        # A scheme of one's own may have an index of its own, or none.
        index = getattr(type(scheme), "kinetic_index", None)
        if index is None or (index is Scheme.kinetic_index and scheme.kinetic == "identity"):
            self._kinetic_index[rows] = np.square(self.dq[rows]).sum(axis=1)
            return
        robot = self._controller.robot
        for k in range(first, first + steps):
            if k not in self.stops:
                conf = Configuration.from_checked(robot, self.q[k])
                self._kinetic_index[k] = scheme.kinetic_index(conf, self.dq[k])

    def end(self, steps: int, last: Configuration, target: Vector) -> None:
        """Take in where the tip ended and where it should have."""
        self._position[steps], self._rotation[steps] = last.position, last.rotation
        self._position_desired[steps] = target[:3]
        self._rotation_desired[steps] = target[3:12].reshape(3, 3)

    def arrays(self, steps: int) -> dict[str, Any]:
        """Return the record's arrays by name, protected and cut to the steps that were taken."""
        samples = {
            "q": self.q,
            "position": self._position,
            "rotation": self._rotation,
            "position_desired": self._position_desired,
            "rotation_desired": self._rotation_desired,
        }
        of_steps = {
            "dq": self.dq,
            "dq_solver": self.dq_solver,
            "kinetic_index": self._kinetic_index,
            "kkt_residual": self._kkt_residual,
            "iterations": self._iterations,
        }
        if self.torque is not None:
            of_steps["torque"] = self.torque
        for array in (*samples.values(), *of_steps.values()):
            array.setflags(write=False)  # so that the record need not copy it
        cut = {name: array[: steps + 1] for name, array in samples.items()}
        return cut | {name: array[:steps] for name, array in of_steps.items()}


def settings_of(controller: Controller, q0: Vector) -> dict[str, Any]:
    """Return what a record says of robot, scheme and network of a run from q0 (n,) [rad]."""
    robot, solver = controller.robot, controller.solver
    integrator = solver.settler if controller.mode == "converged" else solver.follower
    return {
        "robot": robot.name,
        "tip": robot.tip,
        "q_lower": robot.q_lower,
        "q_upper": robot.q_upper,
        "dq_max": robot.dq_max,
        "q0": q0,
        "tol": solver.tol,
        "rho": solver.network.rho,
        "network": solver.network.settings(),
        "integrator": integrator.settings(),
        "scheme": controller.scheme.settings(),
    }
