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
from iiwa_dnn.results.record import RATES
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes import Scheme

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
        blocks = answers.rows[: steps * stages].reshape(steps, stages, -1)
        figures = blocks[..., answers.at_figures :]
        self._iterations[rows] = figures[..., 0].sum(axis=1)
        self._kkt_residual[rows] = figures[..., 2:FIGURES].max(axis=(1, 2))
        # Pose and target are the first stage's.
        targets = answers.targets[: steps * stages : stages]
        self._add_samples(first, figures[:, 0, FIGURES : FIGURES + 12], targets)
        scheme = self._controller.scheme
        # A scheme of one's own may have an index of its own, or none.
        index = getattr(type(scheme), "kinetic_index", None)
        if index is None or (index is Scheme.kinetic_index and scheme.kinetic == "identity"):
            self._kinetic_index[rows] = np.square(self.dq[rows]).sum(axis=1)
            return
        robot = self._controller.robot
        for k in range(first, first + steps):
            if k not in self.stops:
                conf = Configuration(robot, self.q[k])
                self._kinetic_index[k] = scheme.kinetic_index(conf, self.dq[k])

    def end(self, steps: int, targets: Matrix) -> None:
        """Take in where the frames ended and where they should have, (1, 18 frames)."""
        self._add_samples(steps, self._controller.place(self.q[steps])[np.newaxis], targets)

    def _add_samples(self, first: int, places: Matrix, targets: Matrix) -> None:
        """Take in samples from number `first` on: placements (k, 12) and targets (k, 18 frames)."""
        samples = slice(first, first + len(places))
        self._position[samples] = places[:, 9:]
        # A placement holds the rotation column by column, a target row by row.
        self._rotation[samples] = places[:, :9].reshape(-1, 3, 3).swapaxes(1, 2)
        self._position_desired[samples] = targets[:, :3]
        self._rotation_desired[samples] = targets[:, 3:12].reshape(-1, 3, 3)
        self._frames.add(first, self.q[samples], targets)

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


class TrackedFrames:
    """Arrays of a record with the poses of f further frames, actual and desired.

    Attributes:
        arrays: By their names in `iiwa_dnn.Record`; none where f = 0.
    """

    def __init__(self, steps: int, robot: Robot, names: tuple[str, ...]) -> None:
        """Allocate for so many steps; the first of the frames has its own arrays."""
        self._kinematics = Kinematics(robot, names)
        self._ids = [robot.frame_id(name) for name in names[1:]]
        shape = (steps + 1, len(self._ids))
        self.arrays: dict[str, NDArray[np.float64]] = {}
        if self._ids:
            for suffix in ("", "_desired"):
                self.arrays["frame_position" + suffix] = np.empty((*shape, 3))
                self.arrays["frame_rotation" + suffix] = np.empty((*shape, 3, 3))

    def add(self, first: int, q: Matrix, targets: Matrix) -> None:
        """Take in k samples from number `first` on: q (k, n) [rad] and targets (k, 18 frames)."""
        if not self._ids:
            return
        samples, arrays = slice(first, first + len(q)), self.arrays
        desired = targets.reshape(len(q), -1, 18)[:, 1:]
        turned = desired[..., 3:12].reshape(len(q), -1, 3, 3)
        arrays["frame_position_desired"][samples] = desired[..., :3]
        arrays["frame_rotation_desired"][samples] = turned
        for k, posture in enumerate(q, first):
            self._kinematics.update(posture)
            places = self._kinematics.placements[self._ids]
            arrays["frame_position"][k] = places[:, 9:]
            # A placement holds the rotation column by column.
            arrays["frame_rotation"][k] = places[:, :9].reshape(-1, 3, 3).swapaxes(1, 2)


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
