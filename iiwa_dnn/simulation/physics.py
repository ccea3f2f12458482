"""The controller closed around an arm with mass, motors and disturbances; ends in a Record.

Two loops. The outer one is the package's velocity controller: at every control step it gets the
measured joint angles, the network solves the program, reference solvers check it. The inner one
turns the commanded velocity into torques at the rate of the physics (`torque_control`). MuJoCo
moves the arm (`plant`).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.controller import Command, Controller
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.checkpool import CheckPool
from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck
from iiwa_dnn.references import Reference
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.mujoco_model import JointDynamics
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.simulation.disturbances import Disturbances
from iiwa_dnn.simulation.plants.mujoco import MujocoPlant
from iiwa_dnn.simulation.plants.torque_control import TorqueGains

COMPLETED = "completed"
_BLOCK = 500  # steps between two hand-overs to the check
_PACKAGES = ("iiwa-dnn", "numpy", "numba", "pin", "qpsolvers", "proxsuite", "osqp", "mujoco")

Progress = Callable[[int], object]


def simulate_physics(
    robot: Robot,
    scheme: Scheme,
    reference: Reference,
    q0: ArrayLike,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Record:
    """Let an arm with mass and motors follow a reference under the network's velocity commands.

    Args:
        robot: See `PhysicsSimulation`, as for the other arguments.
        scheme: Builds the programs.
        reference: What the tip follows.
        q0: Joint positions at the start [rad], (n,).
        progress: Called now and then with the number of steps done since the last call.
        **options: The other arguments of `PhysicsSimulation`.

    Returns:
        The record of the run, with torques.

    Raises:
        MissingDependencyError: MuJoCo is not installed.
        InvalidInputError: An argument is out of range; the message names it.
    """
    return PhysicsSimulation(robot, scheme, reference, q0, **options).run(progress)


class PhysicsSimulation:
    """One run in physics, its arguments checked; `run` carries it out.

    Step k: the encoders are read, the scheme builds the program at that reading and ``t[k]``, the
    network answers, every reference solver is asked the same, and the torque loop makes the arm
    follow the answer for one control period.

    In the record, ``q`` and the tip's pose are the arm's true ones, ``dq`` is the mean velocity of
    a step (so that ``q[k + 1] = q[k] + dt dq[k]`` as in every record), ``dq_solver`` the network's
    answer, and ``torque`` of each joint the largest that its motor gave during the step.
    """

    def __init__(
        self,
        robot: Robot,
        scheme: Scheme,
        reference: Reference,
        q0: ArrayLike,
        *,
        dt: float = 1e-3,
        timestep: float = 2.5e-4,
        duration: float | None = None,
        disturbances: Disturbances | None = None,
        gains: TorqueGains | None = None,
        dynamics: JointDynamics | None = None,
        seed: int = 0,
        tol: float = 1e-9,
        check: CrossCheck | None = None,
    ) -> None:
        """Check the arguments and compile the arm; nothing moves yet.

        Args:
            robot: The robot, n joints, with the limits that the scheme keeps.
            scheme: Builds the programs; where it has no home, `q0` becomes it.
            reference: What the tip follows; anchored by the caller.
            q0: Joint positions at the start [rad], (n,); the arm is at rest there.
            dt: Control period [s].
            timestep: Physics step [s], at most 1e-3; a whole number of them makes `dt`.
            duration: Length of the run [s], rounded to whole steps; None takes the reference's.
            disturbances: How the arm differs from the controller's idea of it; None: not at all.
            gains: How stiff the torque loop is.
            dynamics: Joint damping and rotor inertia, of the arm and of its nominal model.
            seed: Of the mass errors and the encoder noise.
            tol: Absolute tolerance on the KKT residuals.
            check: Reference solvers; None asks ProxQP, ``CrossCheck(())`` nobody.

        Raises:
            MissingDependencyError: MuJoCo is not installed.
            InvalidInputError: An argument is out of range; the message names it.
        """
        length = reference.duration if duration is None else duration
        for name, value in (("dt", dt), ("duration", length)):
            checks.positive(name, value)
        checks.integer("seed", seed, 0)
        self.steps = max(1, round(length / dt))
        self._robot, self._dt = robot, dt
        self._scratch = robot.model.createData()
        start = Configuration(robot, q0, self._scratch)
        self._q0 = start.q
        self._seed = seed
        self._plant = MujocoPlant(disturbances, gains, dynamics, timestep)
        self._plant.start(robot, start.q, dt, seed)
        self._solver = DNNSolver(tol=tol)
        self._check = CrossCheck() if check is None else check
        self._controller = Controller(scheme.anchored(start), self._solver, "converged", dt)
        self._targets = reference.sample(dt * np.arange(self.steps + 1))
        self._settings: dict[str, Any] = {
            "robot": robot.name,
            "tip": robot.tip,
            "q_lower": robot.q_lower,
            "q_upper": robot.q_upper,
            "dq_max": robot.dq_max,
            "q0": start.q,
            "dt": dt,
            "duration": length,
            "mode": "converged",
            "motion": "physics",
            "seed": seed,
            "tol": tol,
            "rho": self._solver.network.rho,
            "scheme": self._controller.scheme.settings(),
            "reference": reference.settings(),
            "check": self._check.settings(),
            **self._plant.settings(),
            "versions": {name: version(name) for name in _PACKAGES},
        }

    def run(self, progress: Progress | None = None) -> Record:
        """Take every step, or stop at the first that was not solved or where the physics diverged.

        Args:
            progress: Called now and then with the number of steps done since the last call.

        Returns:
            The record of the steps taken, with the wall time of this call [s].
        """
        began = time.perf_counter()
        self._allocate()
        self._solver.reset()
        self._plant.start(self._robot, self._q0, self._dt, self._seed)
        status, done = COMPLETED, 0
        with CheckPool(self._check, self.steps) as pool:
            while done < self.steps and status == COMPLETED:
                commands: list[Command] = []
                while len(commands) < min(_BLOCK, self.steps - done) and status == COMPLETED:
                    status = self._step(done + len(commands), commands)
                programs = np.stack([command.qp.data for command in commands])
                answers = np.stack([command.dq for command in commands])
                pool.submit(programs, commands[0].qp.sizes, answers)
                done += len(commands)
                if progress is not None:
                    progress(len(commands))
            agreement = pool.finish()
        last = Configuration(self._robot, self._q[done], self._scratch)
        self._position[done], self._rotation[done] = last.position, last.rotation
        return self._record(done, status, agreement, time.perf_counter() - began)

    def _allocate(self) -> None:
        steps, n = self.steps, self._q0.size
        self._q = np.empty((steps + 1, n))
        self._q[0] = self._q0
        self._dq, self._dq_solver = np.zeros((steps, n)), np.zeros((steps, n))
        self._torque = np.zeros((steps, n))
        self._position = np.empty((steps + 1, 3))
        self._rotation = np.empty((steps + 1, 3, 3))
        self._kinetic_index, self._kkt_residual = np.zeros(steps), np.zeros(steps)
        self._iterations = np.zeros(steps, dtype=np.int64)

    def _step(self, k: int, commands: list[Command]) -> str:
        """Take step k, add its command, and return the status that the run has after it."""
        true = Configuration(self._robot, self._q[k], self._scratch)
        self._position[k], self._rotation[k] = true.position, true.rotation
        self._q[k + 1] = self._q[k]  # unless it moves
        reading = self._plant.read()
        measured = Configuration(self._robot, reading, self._scratch)
        command = self._controller.step(measured, self._targets[k])
        commands.append(command)
        self._kkt_residual[k] = residual = command.solution.residuals.largest
        self._iterations[k] = command.solution.iterations
        here = f"stopped at step {k} (t = {k * self._dt:g} s)"
        if not command.solution.found:
            return f"{here}: the network did not settle, KKT residual {residual:.1e}"
        self._dq_solver[k] = command.dq
        self._plant.move(command.dq)
        self._torque[k] = self._plant.torque
        if self._plant.diverged:
            return f"{here}: the physics diverged"
        self._q[k + 1] = self._plant.q
        self._dq[k] = (self._q[k + 1] - self._q[k]) / self._dt
        self._kinetic_index[k] = self._controller.scheme.kinetic_index(true, self._dq[k])
        return COMPLETED

    def _record(self, steps: int, status: str, agreement: Agreement, wall_time: float) -> Record:
        """What was recorded, cut to the steps that were taken."""
        return Record(
            t=self._dt * np.arange(steps + 1, dtype=np.float64),
            q=self._q[: steps + 1],
            dq=self._dq[:steps],
            dq_solver=self._dq_solver[:steps],
            position=self._position[: steps + 1],
            rotation=self._rotation[: steps + 1],
            position_desired=self._targets.position[: steps + 1],
            rotation_desired=self._targets.rotation[: steps + 1],
            kinetic_index=self._kinetic_index[:steps],
            kkt_residual=self._kkt_residual[:steps],
            iterations=self._iterations[:steps],
            solution_gap=agreement.solution_gap,
            objective_gap=agreement.objective_gap,
            reference_residual=agreement.reference_residual,
            torque=self._torque[:steps],
            settings={**self._settings, "status": status},
            wall_time_s=wall_time,
        )
