"""The closed loop: reference, controller, check, noise, filter, motion; ends in a Record."""

from __future__ import annotations

import time
from collections.abc import Callable
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks, kernels
from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.controller import Controller, Mode
from iiwa_dnn.control.estimation import JointEstimator, NoiseModel
from iiwa_dnn.control.feedback import IntegralFeedback
from iiwa_dnn.control.filters import MovingAverage
from iiwa_dnn.control.policies import POLICIES, Action, Policy
from iiwa_dnn.errors import InvalidInputError, NoSolutionError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.checkpool import CheckPool
from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.references import Reference
from iiwa_dnn.references.targets import Target, Targets
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes import Scheme, compiled_program
from iiwa_dnn.simulation.incidents import Incidents
from iiwa_dnn.simulation.motion import MOTIONS, Motion
from iiwa_dnn.simulation.noise import (
    NOISE_ENTRIES,
    NoiseEntry,
    VelocityDisturbance,
    gaussian_noise,
)

COMPLETED = "completed"
MAX_STEPS = 20_000_000
"""More would not fit into the memory of a usual machine: a record takes 0.4 kB a step."""

BLOCK = 1000
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

    At a step that the network cannot solve a policy decides (`iiwa_dnn.control.policies`), and the
    record says so. Such a step is an Euler step, whatever the motion. Where a policy slows down,
    the reference's clock does, and the record's desired positions are those of that clock.
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
            mode: ``"converged"`` or ``"continuous"`` (`iiwa_dnn.control.controller.Controller`).
            motion: ``"euler"``, ``"midpoint"`` or ``"rk4"``; ``continuous`` takes ``euler`` only.
            noise: Standard deviation of white noise on each joint, in the unit of what it is
                added to: [rad/s], or [rad] for ``measurement``.
            noise_at: ``"velocity"``, the one commanded; ``"network"``, x of the network's state;
                ``"measurement"``, the joint angles that the controller sees.
            disturbance: What is added to every joint's velocity beside the noise.
            filter_window: Samples that the moving average takes; 1 is no filter.
            integral_gain: Feedback of the error's integral [1/s^2] (`iiwa_dnn.control.feedback`).
            estimator: The controller sees the joint angles through a Kalman filter that is told
                this of the noise (`iiwa_dnn.control.estimation`), and takes the estimated bias off
                its command; None: it sees what is measured.
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
        program = compiled_program(self._controller.scheme, robot)
        self._is_plain = program is not None and not program.inertia  # so G = I
        self._dt, self._motion = dt, MOTIONS[motion]
        self._stages = self._motion.stages
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
        # The network's own answers keep the bounds; what is made of them may not.
        altered = self._noise is not None or disturbance is not None or estimator is not None
        altered = altered or filter_window > 1 or motion != "euler"
        gain = self._controller.scheme.limit_gain
        self._clips, self._gain = altered and gain is not None, gain or 0.0
        self.steps = steps
        self._q0 = start.q

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
        self._allocate()
        self._solver.reset()
        for part in (self._integral, self._estimator):
            if part is not None:
                part.reset()
        self._incidents = incidents = Incidents(self.steps, self._robot, self._dt)
        # A window longer than the run never fills; so none is too long for the memory.
        self._average = MovingAverage(min(self._filter_window, self.steps))
        status, done, room = COMPLETED, 0, BLOCK
        with CheckPool(self._check, self.steps * self._stages) as pool:
            while done < self.steps and status == COMPLETED:
                count = min(room, self.steps - done)
                # One target a stage, in the order in which the method of motion asks.
                times = np.add.outer(done + np.arange(count), self._motion.nodes) * self._dt
                times -= incidents.delay
                targets = self._reference.sample(times.ravel())
                self._block = block = _Block(targets, self._controller.answers(times.size))
                taken = 0
                while taken < count and status == COMPLETED and block.fraction == 1.0:
                    status = self._step(done + taken)
                    taken += 1
                # A step that slows the clock down ends its block; so do the next ones, most likely.
                room = 1 if block.fraction != 1.0 else min(2 * room, BLOCK)
                self._record_block(done, taken)
                pool.submit(block.answers.programs, block.answers.sizes, block.answers.all_x)
                done += taken
                if progress is not None:
                    progress(taken)
            agreement = pool.finish().worst_of(self._stages)
        last = Configuration(self._robot, self._q[done], self._scratch)
        self._position[done], self._rotation[done] = last.position, last.rotation
        desired = self._reference.sample([done * self._dt - incidents.delay])
        self._position_desired[done] = desired.position[0]
        self._rotation_desired[done] = desired.rotation[0]
        return self._record(done, status, agreement, time.perf_counter() - began)

    def _allocate(self) -> None:
        steps, n = self.steps, self._robot.dof
        self._q = np.empty((steps + 1, n))
        self._q[0] = self._q0
        self._dq, self._dq_solver = np.empty((steps, n)), np.empty((steps, n))
        self._position, self._rotation = np.empty((steps + 1, 3)), np.empty((steps + 1, 3, 3))
        self._position_desired = np.empty((steps + 1, 3))
        self._rotation_desired = np.empty((steps + 1, 3, 3))
        self._kinetic_index, self._kkt_residual = np.empty(steps), np.empty(steps)
        self._iterations = np.empty(steps, dtype=np.int64)

    def _velocity_at(self, q: Vector, t: float) -> Vector:
        """The controller's answer at the next stage, noted in the block; t is in the targets."""
        block = self._block
        answers = block.answers
        conf = Configuration.from_checked(self._robot, q, self._scratch)
        count = answers.count
        if count % self._stages == 0:
            block.start = conf
            # Not while the arm cannot follow: the integral would wind up.
            if self._integral is not None and not self._incidents.pending:
                self._integral.observe(conf, block.targets[count], self._dt)
        target = block.rows[count]
        if self._integral is not None:
            target = self._integral.apply(Target.from_data(target)).data
        return self._controller.answer(conf, target, answers)

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
            velocity = self._motion.step(self._velocity_at, seen, k * dt, dt)
        except NoSolutionError as error:
            raise NoSolutionError(f"step {k}: {error}", error.problem, error.solution, k) from error
        if seen is not q:  # the controller saw another posture than the robot has
            block.start = Configuration.from_checked(self._robot, q, self._scratch)
            block.answers.poses[-self._stages] = block.start.pose
        if block.answers.resolved or self._incidents.pending:
            velocity = self._resolved(k, velocity)
            if block.stopped:
                return self._incidents.status(k)
        answer = velocity
        if self._estimator is not None:
            velocity = velocity - self._estimator.bias
            self._estimator.predict(velocity)
        if noise is not None:
            if self._noise_at == "velocity":
                velocity = velocity + noise
            elif self._noise_at == "network":
                self._solver.disturb(noise)
        if self._disturbance is not None:
            velocity = velocity + self._disturbance[k]
        if self._filter_window > 1:
            velocity = self._average(velocity)
        if self._clips:
            velocity = self._incidents.clipped(k, q, self._gain, velocity)
        kernels.move(self._q, self._dq, self._dq_solver, k, velocity, answer, dt)
        if not self._is_plain:
            index = self._controller.scheme.kinetic_index
            self._kinetic_index[k] = index(block.start, velocity)
        return COMPLETED

    def _resolved(self, k: int, velocity: Vector) -> Vector:
        """Note what a policy decided in step k, if it did; returns the velocity of the step."""
        block, answers = self._block, self._block.answers
        first = answers.count - self._stages
        self._incidents.pending = any(i >= first for i in answers.resolved)
        if not self._incidents.pending:
            return velocity
        # An Euler step; if only a later stage has no solution, the answer at its start will do.
        answers.repeat(first)
        resolution = answers.resolved.get(first)
        if resolution is not None:
            self._incidents.note(k, resolution)
            block.fraction = resolution.fraction
            block.stopped = resolution.action is Action.STOP
        if block.stopped:
            self._dq_solver[k] = self._dq[k] = self._kinetic_index[k] = 0.0
            self._q[k + 1] = self._q[k]
        return answers.x(first)

    def _record_block(self, first: int, steps: int) -> None:
        """Write the block's steps into the arrays of the run."""
        block, stages = self._block, self._stages
        answers, rows = block.answers, slice(first, first + steps)
        if self._is_plain:
            self._kinetic_index[rows] = np.square(self._dq[rows]).sum(axis=1)
        poses = answers.poses[::stages]
        self._position[rows], self._rotation[rows] = poses[:, :3, 3], poses[:, :3, :3]
        at_steps = slice(0, steps * stages, stages)
        self._position_desired[rows] = block.targets.position[at_steps]
        self._rotation_desired[rows] = block.targets.rotation[at_steps]
        self._kkt_residual[rows] = answers.residuals.reshape(steps, -1).max(axis=1)
        self._iterations[rows] = answers.iterations.reshape(steps, stages).sum(axis=1)
        self._incidents.multipliers(rows, answers.bound_multipliers[::stages])

    def _record(self, steps: int, status: str, agreement: Agreement, wall_time: float) -> Record:
        """What was recorded, cut to the steps that were taken."""
        for array in (
            self._q, self._dq, self._dq_solver, self._position, self._rotation,
            self._position_desired, self._rotation_desired, self._kinetic_index,
            self._kkt_residual, self._iterations,
        ):  # fmt: skip
            array.setflags(write=False)  # so that the record need not copy it
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
    """What a stretch of steps starts from and leaves behind, one entry a stage.

    Attributes:
        targets: Where the tip should be.
        rows: The same, one `Target.data` a row.
        answers: What the controller decided; recorded and checked at the block's end.
        start: Where the step that is being taken began.
        fraction: How far the reference's clock went in the last step, in control periods.
        stopped: Whether a policy ends the run.
    """

    __slots__ = ("answers", "fraction", "rows", "start", "stopped", "targets")
    start: Configuration

    def __init__(self, targets: Targets, answers: Answers) -> None:
        self.targets, self.answers, self.rows = targets, answers, targets.data
        self.fraction, self.stopped = 1.0, False
