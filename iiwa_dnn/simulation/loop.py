"""The closed loop: reference, controller, check, noise, filter, motion; ends in a Record."""

from __future__ import annotations

import time
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks, kernels
from iiwa_dnn.checkpool import CheckPool, Job
from iiwa_dnn.configuration import Configuration
from iiwa_dnn.controller import Command, Controller, Mode
from iiwa_dnn.crosscheck import Agreement, CrossCheck
from iiwa_dnn.estimation import JointEstimator, NoiseModel
from iiwa_dnn.exceptions import InvalidInputError, NoSolutionError
from iiwa_dnn.feedback import IntegralFeedback
from iiwa_dnn.policies import POLICIES, Action, Policy
from iiwa_dnn.qp import Vector
from iiwa_dnn.record import Record
from iiwa_dnn.references import Reference, Target
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.simulation.filters import MovingAverage
from iiwa_dnn.simulation.incidents import Incidents
from iiwa_dnn.simulation.motion import MOTIONS, Motion
from iiwa_dnn.simulation.noise import (
    NOISE_ENTRIES,
    NoiseEntry,
    VelocityDisturbance,
    gaussian_noise,
)
from iiwa_dnn.solver import DNNSolver

COMPLETED = "completed"
MAX_STEPS = 20_000_000
"""More would not fit into the memory of a usual machine: a record takes 0.4 kB a step."""

BLOCK = 500
"""Steps between two hand-overs to the record and to the check."""
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
    Noise may enter elsewhere instead (`iiwa_dnn.simulation.noise.NOISE_ENTRIES`).

    What leaves the controller is clipped to the scheme's velocity bounds at the robot's true joint
    angles, as a drive does that watches its own limits; so noise cannot break a limit.

    At a step that the network cannot solve a policy decides (`iiwa_dnn.policies`), and the record
    says so. Such a step is an Euler step, whatever the motion. Where a policy slows down, the
    reference's clock does, and the record's desired positions are those of that clock.
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
        noise_at: NoiseEntry = "velocity",
        disturbance: VelocityDisturbance | None = None,
        filter_window: int = 1,
        integral_gain: float = 0.0,
        estimator: NoiseModel | None = None,
        policy: Policy = "slow",
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
            noise: Standard deviation of white noise on each joint, in the unit of what it is
                added to: [rad/s], or [rad] for ``measurement``.
            noise_at: ``"velocity"``, the one commanded; ``"network"``, x of the network's state;
                ``"measurement"``, the joint angles that the controller sees.
            disturbance: What is added to every joint's velocity beside the noise.
            filter_window: Samples that the moving average takes; 1 is no filter.
            integral_gain: Feedback of the error's integral [1/s^2] (`iiwa_dnn.feedback`).
            estimator: The controller sees the joint angles through a Kalman filter that is told
                this of the noise (`iiwa_dnn.estimation`), and takes the estimated bias off its
                command; None: it sees what is measured.
            policy: What to do at a step without a solution: ``"slow"``, ``"relax"``, ``"stop"`` or
                ``"raise"``.
            seed: Seed of the noise; the same seed gives the same record, bit for bit, but for the
                last digits of what ProxQP is said to be off by: it does not repeat itself.
            tol: Absolute tolerance on the KKT residuals in ``converged`` mode.
            check: Reference solvers; None asks ProxQP, ``CrossCheck(())`` nobody.
            solver: The network and its integrators, reset before the run; None takes the paper's
                network with `tol`.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
        """
        checks.positive("dt", dt)
        length = reference.duration if duration is None else duration
        checks.positive("duration", length)
        checks.one_of("motion", motion, tuple(MOTIONS))
        if mode == "continuous" and motion != "euler":
            raise InvalidInputError(
                "motion", "must be euler in continuous mode: the network has one clock", motion
            )
        checks.one_of("policy", policy, POLICIES)
        steps = _step_count(length, dt)
        self._solver = DNNSolver(tol=tol) if solver is None else solver
        self._check = CrossCheck() if check is None else check
        self._scratch = robot.model.createData()
        start = Configuration(robot, q0, self._scratch)
        self._controller = Controller(scheme.anchored(start), self._solver, mode, dt, policy)
        self._robot, self._reference = robot, reference
        self._dt, self._motion = dt, MOTIONS[motion]
        checks.one_of("noise_at", noise_at, NOISE_ENTRIES)
        self._noise_at = noise_at
        drawn = gaussian_noise(noise, steps, robot.dof, seed)
        self._noise = drawn if noise > 0.0 else None
        times = dt * np.arange(steps, dtype=np.float64)
        self._disturbance = None if disturbance is None else disturbance.at(times)
        checks.not_negative("integral_gain", integral_gain)
        self._integral = IntegralFeedback(integral_gain) if integral_gain else None
        self._estimator = None if estimator is None else JointEstimator(estimator, dt)
        checks.integer("filter_window", filter_window, 1)
        self._filter_window = filter_window
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
            "noise_at": noise_at,
            "disturbance": None if disturbance is None else disturbance.settings(),
            "filter_window": filter_window,
            "integral_gain": integral_gain,
            "estimator": None if estimator is None else estimator.settings(),
            "policy": policy,
            "seed": seed,
            "tol": self._solver.tol,
            "rho": self._solver.network.rho,
            "scheme": self._controller.scheme.settings(),
            "reference": reference.settings(),
            "check": self._check.settings(),
            "versions": {name: version(name) for name in _PACKAGES},
        }
        self.steps = steps
        # The network's own answers keep the bounds; what is made of them may not.
        altered = self._noise is not None or disturbance is not None or estimator is not None
        altered = altered or filter_window > 1 or motion != "euler"
        gain = self._controller.scheme.limit_gain
        self._clips, self._gain = altered and gain is not None, gain or 0.0
        self._allocate(start.q)

    def run(self, progress: Progress | None = None) -> Record:
        """Take every step, or those until a policy stops.

        Args:
            progress: Called now and then with the number of steps done since the last call.

        Returns:
            The record of the steps taken, with the wall time of this call [s].

        Raises:
            NoSolutionError: A step has no solution and the policy is ``raise``.
        """
        began = time.perf_counter()
        self._solver.reset()
        for part in (self._integral, self._estimator):
            if part is not None:
                part.reset()
        self._incidents = Incidents(self.steps, self._robot, self._dt)
        # A window longer than the run never fills; so none is too long for the memory.
        self._average = MovingAverage(min(self._filter_window, self.steps))
        pool = CheckPool(self._check, self.steps * self._motion.stages)
        status, done = COMPLETED, 0
        while done < self.steps and status == COMPLETED:
            count = min(BLOCK, self.steps - done)
            # After a step that slowed the clock down a new block begins, with its own targets.
            clock = done * self._dt - self._incidents.delay
            self._block = block = _Block(self._reference, clock, count, self._dt)
            while block.taken < count and status == COMPLETED and block.fraction == 1.0:
                status = self._step(done + block.taken)
                block.taken += 1
            taken = block.taken
            self._record_block(done, taken)
            pool.submit(*block.job())
            done += taken
            if progress is not None:
                progress(taken)
        last = Configuration(self._robot, self._q[done], self._scratch)
        self._position[done], self._rotation[done] = last.position, last.rotation
        desired = self._reference.sample([done * self._dt - self._incidents.delay])
        self._position_desired[done] = desired.position[0]
        self._rotation_desired[done] = desired.rotation[0]
        agreement = pool.finish().worst_of(self._motion.stages)
        return self._record(done, status, agreement, time.perf_counter() - began)

    def _allocate(self, q0: Vector) -> None:
        steps, n = self.steps, q0.size
        self._q = np.empty((steps + 1, n))
        self._q[0] = q0
        self._dq, self._dq_solver = np.empty((steps, n)), np.empty((steps, n))
        self._position, self._rotation = np.empty((steps + 1, 3)), np.empty((steps + 1, 3, 3))
        self._position_desired = np.empty((steps + 1, 3))
        self._rotation_desired = np.empty((steps + 1, 3, 3))
        self._kinetic_index, self._kkt_residual = np.empty(steps), np.empty(steps)
        self._iterations = np.empty(steps, dtype=np.int64)

    def _velocity_at(self, q: Vector, t: float) -> Vector:
        """The controller's answer at a stage, `t` [s] after the block's start; noted there."""
        block = self._block
        conf = Configuration.from_checked(self._robot, q, self._scratch)
        target = block.target(t)
        if self._integral is not None:
            # Once a step, and not while the arm cannot follow: the integral would wind up.
            first_stage = len(block.commands) == block.taken * self._motion.stages
            if first_stage and not self._incidents.pending:
                self._integral.observe(conf, target, self._dt)
            target = self._integral.apply(target)
        command = self._controller.step(conf, target)
        block.confs.append(conf)
        block.commands.append(command)
        if command.resolution is not None and block.unsolved is None:
            block.unsolved = command
        return command.dq

    def _step(self, k: int) -> str:
        """Take step k, note it in the block, and return the status that the run has after it."""
        q, dt, block, noise = self._q[k], self._dt, self._block, None
        seen = q
        if self._noise is not None:
            noise = self._noise[k]
            if self._noise_at == "measurement":
                seen = q + noise
        if self._estimator is not None:
            seen = self._estimator.update(seen)
        try:
            velocity = self._motion.step(self._velocity_at, seen, block.taken * dt, dt)
        except NoSolutionError as error:
            raise NoSolutionError(f"step {k}: {error}", error.problem, error.solution, k) from error
        self._incidents.pending = block.unsolved is not None
        if block.unsolved is not None:
            velocity = self._unsolved(k)
        if seen is not q:  # the controller saw another posture than the robot has
            true = Configuration.from_checked(self._robot, q, self._scratch)
            block.confs[-self._motion.stages] = true
        self._dq_solver[k] = velocity
        if block.stopped:
            self._dq[k], self._q[k + 1] = 0.0, q
            return self._incidents.status(k)
        if self._estimator is not None:
            velocity = velocity - self._estimator.bias
            self._estimator.predict(velocity)
        if noise is not None and self._noise_at == "velocity":
            velocity = velocity + noise
        elif noise is not None and self._noise_at == "network":
            self._solver.disturb(noise)
        if self._disturbance is not None:
            velocity = velocity + self._disturbance[k]
        velocity = self._average(velocity)
        if self._clips:
            velocity = self._incidents.clipped(k, q, self._gain, velocity)
        kernels.move(self._q, self._dq, k, velocity, dt)
        return COMPLETED

    def _unsolved(self, k: int) -> Vector:
        """Note what the policy decided in step k; returns the velocity of this Euler step."""
        block, stages = self._block, self._motion.stages
        first = block.taken * stages
        # If only a later stage has no solution, the answer at the step's start will do.
        command = block.commands[first]
        block.commands[first:] = [command] * stages
        block.confs[first:] = [block.confs[first]] * stages
        block.unsolved = None
        if command.resolution is not None:
            self._incidents.note(k, command.resolution)
            block.fraction = command.resolution.fraction
            block.stopped = command.resolution.action is Action.STOP
        return command.dq

    def _record_block(self, first: int, steps: int) -> None:
        """Write the block's steps into the arrays of the run."""
        block, stages = self._block, self._motion.stages
        rows = slice(first, first + steps)
        starts = block.confs[::stages]
        # Not np.stack, which takes three times as long over small arrays.
        poses = np.concatenate([conf.arrays[1] for conf in starts]).reshape(steps, 4, 4)
        self._position[rows], self._rotation[rows] = poses[:, :3, 3], poses[:, :3, :3]
        at_steps = slice(0, 2 * steps, 2)
        self._position_desired[rows] = block.targets.position[at_steps]
        self._rotation_desired[rows] = block.targets.rotation[at_steps]
        index = self._controller.scheme.kinetic_index
        self._kinetic_index[rows] = [
            index(conf, dq) for conf, dq in zip(starts, self._dq[rows], strict=True)
        ]
        solutions = [command.solution for command in block.commands]
        residuals = np.array([solution[-3:] for solution in solutions])
        self._kkt_residual[rows] = residuals.reshape(steps, -1).max(axis=1)
        iterations = np.array([solution.iterations for solution in solutions])
        self._iterations[rows] = iterations.reshape(steps, stages).sum(axis=1)
        n = self._robot.dof
        bounds = np.concatenate([solution.point[-n:] for solution in solutions[::stages]])
        self._incidents.multipliers(rows, bounds.reshape(steps, n))

    def _record(self, steps: int, status: str, agreement: Agreement, wall_time: float) -> Record:
        """What was recorded, cut to the steps that were taken."""
        return Record(
            t=self._dt * np.arange(steps + 1, dtype=np.float64),
            q=self._q[: steps + 1],
            dq=self._dq[:steps],
            dq_solver=self._dq_solver[:steps],
            position=self._position[: steps + 1],
            rotation=self._rotation[: steps + 1],
            position_desired=self._position_desired[: steps + 1],
            rotation_desired=self._rotation_desired[: steps + 1],
            kinetic_index=self._kinetic_index[:steps],
            kkt_residual=self._kkt_residual[:steps],
            iterations=self._iterations[:steps],
            solution_gap=agreement.solution_gap,
            objective_gap=agreement.objective_gap,
            reference_residual=agreement.reference_residual,
            settings={**self._settings, "status": status},
            **self._incidents.arrays(steps),
            wall_time_s=wall_time,
        )


def _step_count(duration: float, dt: float) -> int:
    """Whole steps in a run; an InvalidInputError where there is none, or far too many."""
    steps = duration / dt
    if not 0.5 < steps <= MAX_STEPS:
        name, value = ("dt", dt) if steps > 1.0 and dt < 1e-6 else ("duration", duration)
        problem = f"{steps:.3g} steps of {dt:g} s; there must be from 1 to {MAX_STEPS:,}"
        raise InvalidInputError(name, problem, value)
    return max(1, round(steps))


class _Block:
    """What a stretch of steps leaves behind, one entry a stage, until it is recorded."""

    def __init__(self, reference: Reference, start: float, steps: int, dt: float) -> None:
        """Take the targets of a stretch that starts at a time of the reference's clock [s]."""
        self._dt = dt
        # Two targets a step: the methods of motion ask at its ends and at its middle.
        self.targets = reference.sample(start + np.arange(2 * steps + 1) * (0.5 * dt))
        self.confs: list[Configuration] = []
        self.commands: list[Command] = []
        self.taken = 0
        self.unsolved: Command | None = None
        self.fraction = 1.0
        self.stopped = False

    def target(self, t: float) -> Target:
        """The target at a stage's time since the block's start [s]."""
        return self.targets[round(2.0 * t / self._dt)]

    def job(self) -> Job:
        """The programs and the answers, for the check."""
        count, sizes = len(self.commands), self.commands[0].qp.sizes
        programs = np.concatenate([command.qp.data for command in self.commands])
        answers = np.concatenate([command.dq for command in self.commands])
        return programs.reshape(count, -1), sizes, answers.reshape(count, -1)
