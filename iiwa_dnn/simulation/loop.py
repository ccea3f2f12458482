"""The closed loop: reference, controller, check, noise, filter, motion; ends in a Record."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn.configuration import Configuration
from iiwa_dnn.controller import Command, Controller, Mode
from iiwa_dnn.crosscheck import Agreement, CrossCheck
from iiwa_dnn.exceptions import InvalidInputError
from iiwa_dnn.qp import Vector
from iiwa_dnn.record import Record
from iiwa_dnn.references import Reference
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.simulation.filters import MovingAverage
from iiwa_dnn.simulation.motion import MOTIONS, Motion
from iiwa_dnn.simulation.noise import gaussian_noise
from iiwa_dnn.solver import DNNSolver

COMPLETED = "completed"
_PACKAGES = ("iiwa-dnn", "numpy", "numba", "pin", "qpsolvers", "proxsuite", "osqp")

Progress = Callable[[int], object]


def simulate(
    robot: Robot,
    scheme: Scheme,
    reference: Reference,
    q0: ArrayLike,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Record:
    """Let a robot follow a reference, each step's program solved by the network and checked.

    Args:
        robot: See `Simulation`, as for the other arguments.
        scheme: Builds the programs.
        reference: What the tip follows.
        q0: Joint positions at the start [rad], (n,).
        progress: Called now and then with the number of steps done since the last call.
        **options: The other arguments of `Simulation`.

    Returns:
        The record of the run.

    Raises:
        InvalidInputError: An argument is out of range; the message names it.
    """
    return Simulation(robot, scheme, reference, q0, **options).run(progress)


class Simulation:
    """One run, its arguments checked and its arrays laid out; `run` carries it out.

    Step k: the scheme builds the program at ``q[k]`` and ``t[k]`` (and at the stages between, for
    midpoint and RK4), the network answers, every reference solver is asked the same, noise is
    added to the velocity, the filter averages it, and the robot moves by dt times the result.

    A step that the network cannot solve ends the run there with the robot at rest; the record's
    status says so.
    """

    def __init__(
        self,
        robot: Robot,
        scheme: Scheme,
        reference: Reference,
        q0: ArrayLike,
        *,
        dt: float = 1e-4,
        duration: float | None = None,
        mode: Mode = "converged",
        motion: Motion = "euler",
        noise: float = 0.0,
        filter_window: int = 1,
        seed: int = 0,
        tol: float = 1e-9,
        check: CrossCheck | None = None,
        solver: DNNSolver | None = None,
    ) -> None:
        """Check the arguments and draw the noise; nothing runs yet.

        Args:
            robot: The robot, n joints, with the limits that the scheme keeps.
            scheme: Builds the programs; where it has no home, `q0` becomes it.
            reference: What the tip follows; anchored by the caller.
            q0: Joint positions at the start [rad], (n,).
            dt: Control period [s].
            duration: Length of the run [s], rounded to whole steps; None takes the reference's.
            mode: ``"converged"`` or ``"continuous"`` (`iiwa_dnn.controller.Controller`).
            motion: ``"euler"``, ``"midpoint"`` or ``"rk4"``; ``continuous`` takes ``euler`` only.
            noise: Standard deviation of white noise on each joint velocity [rad/s].
            filter_window: Samples that the moving average takes; 1 is no filter.
            seed: Seed of the noise; the same seed gives the same record, bit for bit.
            tol: Absolute tolerance on the KKT residuals in ``converged`` mode.
            check: Reference solvers; None asks ProxQP, ``CrossCheck(())`` nobody.
            solver: The network and its integrators, reset before the run; None takes the paper's
                network with `tol`.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
        """
        _check_positive("dt", dt)
        length = reference.duration if duration is None else duration
        _check_positive("duration", length)
        if motion not in MOTIONS:
            choices = ", ".join(MOTIONS)
            raise InvalidInputError("motion", f"must be one of {choices}, not {motion!r}", motion)
        if mode == "continuous" and motion != "euler":
            raise InvalidInputError(
                "motion", "must be euler in continuous mode: the network has one clock", motion
            )
        steps = max(1, round(length / dt))
        self._solver = DNNSolver(tol=tol) if solver is None else solver
        self._check = CrossCheck() if check is None else check
        self._scratch = robot.model.createData()
        start = Configuration(robot, q0, self._scratch)
        self._controller = Controller(scheme.anchored(start), self._solver, mode, dt)
        self._robot, self._dt, self._motion = robot, dt, MOTIONS[motion]
        self._disturbance = gaussian_noise(noise, steps, robot.dof, seed)
        self._average = MovingAverage(filter_window)
        # Two targets a step: the methods of motion ask at its ends and at its middle.
        self._targets = reference.sample(np.arange(2 * steps + 1) * (0.5 * dt))
        self._settings: dict[str, Any] = {
            "robot": robot.name,
            "tip": robot.tip,
            "q_lower": robot.q_lower,
            "q_upper": robot.q_upper,
            "dq_max": robot.dq_max,
            "q0": start.q,
            "dt": dt,
            "duration": length,
            "mode": mode,
            "motion": motion,
            "noise": noise,
            "filter_window": filter_window,
            "seed": seed,
            "tol": self._solver.tol,
            "rho": self._solver.network.rho,
            "scheme": self._controller.scheme.settings(),
            "reference": reference.settings(),
            "check": self._check.settings(),
            "versions": {name: version(name) for name in _PACKAGES},
        }
        self.steps = steps
        self._allocate(start.q)

    def run(self, progress: Progress | None = None) -> Record:
        """Take every step, or stop at the first that was not solved.

        Args:
            progress: Called now and then with the number of steps done since the last call.

        Returns:
            The record of the steps taken, with the wall time of this call [s].
        """
        began = time.perf_counter()
        self._solver.reset()
        report_every = max(1, self.steps // 1000)
        status, done, reported = COMPLETED, 0, 0
        while done < self.steps and status == COMPLETED:
            status = self._step(done)
            done += 1
            if progress is not None and done - reported >= report_every:
                progress(done - reported)
                reported = done
        if progress is not None and done > reported:
            progress(done - reported)
        last = Configuration(self._robot, self._q[done], self._scratch)
        self._position[done], self._rotation[done] = last.position, last.rotation
        return self._record(done, status, time.perf_counter() - began)

    def _allocate(self, q0: Vector) -> None:
        steps, n, k = self.steps, q0.size, len(self._check.solvers)
        self._q = np.empty((steps + 1, n))
        self._q[0] = q0
        self._dq, self._dq_solver = np.zeros((steps, n)), np.zeros((steps, n))
        self._position = np.empty((steps + 1, 3))
        self._rotation = np.empty((steps + 1, 3, 3))
        self._kinetic_index, self._kkt_residual = np.zeros(steps), np.zeros(steps)
        self._iterations = np.zeros(steps, dtype=np.int64)
        self._solution_gap = np.full((steps, k), np.nan)
        self._objective_gap = np.full((steps, k), np.nan)
        self._reference_residual = np.full((steps, k), np.nan)

    def _step(self, k: int) -> str:
        """Take step k and record it; returns the status that the run has after it."""
        stages: list[tuple[Configuration, Command]] = []

        def velocity_at(q: Vector, t: float) -> Vector:
            conf = Configuration(self._robot, q, self._scratch)
            command = self._controller.step(conf, self._targets[round(2.0 * t / self._dt)])
            stages.append((conf, command))
            return command.dq

        q, dt = self._q[k], self._dt
        velocity = self._motion(velocity_at, q, k * dt, dt)
        status = self._judge(k, [command for _, command in stages])
        if status == COMPLETED:
            self._dq_solver[k] = velocity
            self._dq[k] = self._average(velocity + self._disturbance[k])
        conf = stages[0][0]
        self._position[k], self._rotation[k] = conf.position, conf.rotation
        self._kinetic_index[k] = self._controller.scheme.kinetic_index(conf, self._dq[k])
        self._q[k + 1] = q + dt * self._dq[k]
        return status

    def _judge(self, k: int, commands: list[Command]) -> str:
        """Check the programs of step k, and say whether the run can go on."""
        solutions = [command.solution for command in commands]
        largest = float(np.max([solution.residuals.largest for solution in solutions]))
        self._kkt_residual[k] = largest
        self._iterations[k] = sum(solution.iterations for solution in solutions)
        if self._check.solvers:
            worst = Agreement.worst([self._check.check(c.qp, c.dq) for c in commands])
            self._solution_gap[k] = worst.solution_gap
            self._objective_gap[k] = worst.objective_gap
            self._reference_residual[k] = worst.reference_residual
        settled = self._controller.mode == "continuous" or all(s.found for s in solutions)
        if settled and math.isfinite(largest):
            return COMPLETED
        return (
            f"stopped at step {k} (t = {k * self._dt:g} s): "
            f"the network did not settle, KKT residual {largest:.1e}"
        )

    def _record(self, steps: int, status: str, wall_time: float) -> Record:
        """What was recorded, cut to the steps that were taken."""
        desired = slice(0, 2 * steps + 1, 2)
        return Record(
            t=self._dt * np.arange(steps + 1, dtype=np.float64),
            q=self._q[: steps + 1],
            dq=self._dq[:steps],
            dq_solver=self._dq_solver[:steps],
            position=self._position[: steps + 1],
            rotation=self._rotation[: steps + 1],
            position_desired=self._targets.position[desired],
            rotation_desired=self._targets.rotation[desired],
            kinetic_index=self._kinetic_index[:steps],
            kkt_residual=self._kkt_residual[:steps],
            iterations=self._iterations[:steps],
            solution_gap=self._solution_gap[:steps],
            objective_gap=self._objective_gap[:steps],
            reference_residual=self._reference_residual[:steps],
            settings={**self._settings, "status": status},
            wall_time_s=wall_time,
        )


def _check_positive(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0):
        raise InvalidInputError(name, f"must be a positive time in s, not {value}", value)
