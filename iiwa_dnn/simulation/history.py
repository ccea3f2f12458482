"""The arrays of a run while it is being made."""

from collections.abc import Mapping
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.answers import FIGURES, Answers
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.control.paths import References
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled, larger
from iiwa_dnn.results.record import RATES
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.simulation.frames import TrackedFrames

COMPLETED = "completed"

MAX_STEPS = 20_000_000
"""More would not fit into the memory of a usual machine: a record takes 0.4 kB a step."""


class History:
    """Arrays of a record, written step by step or block by block.

    Attributes:
        q: Joint positions [rad], (N+1, n).
        dq: Joint velocities that moved the robot [rad/s], (N, n).
        dq_solver: Joint velocities that the controller answered [rad/s], (N, n).
        ddq: Joint accelerations [rad/s^2], (N, n), of a scheme of the acceleration level.
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
        self.ddq = np.zeros((steps, n)) if controller.plan.accelerates else None
        self._position, self._rotation = np.empty((steps + 1, 3)), np.empty((steps + 1, 3, 3))
        self._position_desired = np.empty((steps + 1, 3))
        self._rotation_desired = np.empty((steps + 1, 3, 3))
        self._kinetic_index, self._kkt_residual = np.zeros(steps), np.empty(steps)
        self._iterations = np.empty(steps, dtype=np.int64)
        self._frames = TrackedFrames(steps, controller.robot, controller.plan.frames)

    def stay(self, k: int) -> None:
        """Let the robot stay where it is in step k."""
        self.stops.add(k)
        self.dq[k] = 0.0
        self.q[k + 1] = self.q[k]

    def add_block(self, first: int, steps: int, stages: int, answers: Answers) -> None:
        """Take in the answers of a stretch of steps, each of so many stages."""
        rows = slice(first, first + steps)
        take_in(
            answers.rows[: steps * stages], stages, answers.at_figures, answers.at_targets,
            self._position[rows], self._rotation[rows], self._position_desired[rows],
            self._rotation_desired[rows], self._kkt_residual[rows], self._iterations[rows],
        )  # fmt: skip
        self._frames.add(first, self.q[rows], answers.targets[: steps * stages : stages])
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

    def end(self, steps: int, targets: Matrix) -> None:
        """Take in where the frames ended and where they should have, (1, 18 frames)."""
        place, target = self._controller.place(self.q[steps]), targets[0]
        self._position[steps], self._rotation[steps] = place[9:], place[:9].reshape(3, 3).T
        self._position_desired[steps] = target[:3]
        self._rotation_desired[steps] = target[3:12].reshape(3, 3)
        self._frames.add(steps, self.q[steps : steps + 1], targets)

    def arrays(self, steps: int) -> dict[str, Any]:
        """Return the record's arrays by name, protected and cut to the steps that were taken."""
        samples = {
            "q": self.q,
            "position": self._position,
            "rotation": self._rotation,
            "position_desired": self._position_desired,
            "rotation_desired": self._rotation_desired,
            **self._frames.arrays,
        }
        of_steps = {
            "dq": self.dq,
            "dq_solver": self.dq_solver,
            "kinetic_index": self._kinetic_index,
            "kkt_residual": self._kkt_residual,
            "iterations": self._iterations,
        }
        optional = {"torque": self.torque, "ddq": self.ddq}
        of_steps |= {name: array for name, array in optional.items() if array is not None}
        for array in (*samples.values(), *of_steps.values()):
            array.setflags(write=False)  # so that the record need not copy it
        cut = {name: array[: steps + 1] for name, array in samples.items()}
        return cut | {name: array[:steps] for name, array in of_steps.items()}


@compiled
def take_in(
    rows: Matrix, stages: int, at_figures: int, at_targets: int, position: Matrix,
    rotation: NDArray[np.float64], position_desired: Matrix,
    rotation_desired: NDArray[np.float64], residual: Vector, iterations: NDArray[np.int64],
) -> None:  # fmt: skip
    """Copy what `Answers.rows` say of N steps, each of so many stages, into arrays of a record.

    Args:
        rows: Answers, (N stages, width).
        stages: Rows of a step; poses and targets are the first one's.
        at_figures: Column of the figures, the tip's placement after them.
        at_targets: Column of the targets.
        position: Position of the tip [m], (N, 3).
        rotation: Its orientation, (N, 3, 3).
        position_desired: Desired position [m], (N, 3).
        rotation_desired: Desired orientation, (N, 3, 3).
        residual: Largest KKT residual of the stages, (N,).
        iterations: Linear systems or sub-steps of all stages, (N,).
    """
    at_place = at_figures + FIGURES
    for k in range(len(position)):
        row = rows[k * stages]
        for i in range(3):
            position[k, i] = row[at_place + 9 + i]
            position_desired[k, i] = row[at_targets + i]
            for j in range(3):
                # A placement holds the rotation column by column, a target row by row.
                rotation[k, i, j] = row[at_place + 3 * j + i]
                rotation_desired[k, i, j] = row[at_targets + 3 + 3 * i + j]
        residual[k], iterations[k] = 0.0, 0
        for stage in range(stages):
            figures = rows[k * stages + stage, at_figures:]
            iterations[k] += int(figures[0])
            for i in range(2, FIGURES):
                residual[k] = larger(residual[k], figures[i])


def settings_of(controller: Controller, q0: Vector) -> dict[str, Any]:
    """Return what a record says of robot, scheme and network of a run from q0 (n,) [rad]."""
    robot, solver = controller.robot, controller.solver
    integrator = solver.settler if controller.mode == "converged" else solver.follower
    rates, layout = controller.plan.rates, controller.plan.layout
    own: dict[str, Any] = {"rows": [], "bounding": [type(controller.scheme).__name__]}
    return {
        "robot": robot.name,
        "tip": controller.plan.frames[0],
        "frames": list(controller.plan.frames[1:]),
        "q_lower": robot.q_lower,
        "q_upper": robot.q_upper,
        "dq_max": robot.dq_max,
        **({} if rates is None else dict(zip(RATES, rates, strict=True))),
        "q0": q0,
        "tol": solver.tol,
        "rho": solver.network.rho,
        "network": solver.network.settings(),
        "integrator": integrator.settings(),
        "scheme": controller.scheme.settings(),
        "reference": _settings_of(controller.reference),
        **(own if layout is None else {"rows": layout.row_names(), **layout.culprits}),
    }


def versions(packages: tuple[str, ...]) -> dict[str, str]:
    """Return the versions of what a run computes with, and of further packages."""
    return {name: version(name) for name in (*_PACKAGES, *packages)}


_PACKAGES = ("iiwa-dnn", "numpy", "numba", "pin", "qpsolvers", "proxsuite", "osqp")


def _settings_of(reference: References | None) -> dict[str, Any]:
    """Name and parameters of a reference, or of each frame's."""
    if not isinstance(reference, Mapping):
        return {} if reference is None else reference.settings()
    return {"name": "frames"} | {name: path.settings() for name, path in reference.items()}


def step_count(duration: float, dt: float) -> int:
    """Count the whole steps in a run; raise InvalidInputError where there are none or too many."""
    steps = duration / dt
    if not 0.5 < steps <= MAX_STEPS:
        name, value = ("dt", dt) if steps > 1.0 and dt < 1e-6 else ("duration", duration)
        problem = f"{steps:.3g} steps of {dt:g} s; there must be from 1 to {MAX_STEPS:,}"
        raise InvalidInputError(name, problem, value)
    return max(1, round(steps))
