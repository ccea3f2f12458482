"""The runner: controller, plant, noise and check in one loop, which ends in a Record."""

import time
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.controller import Controller, Mode
from iiwa_dnn.control.estimation import NoiseModel
from iiwa_dnn.control.feedback import IntegralFeedback
from iiwa_dnn.control.paths import References, by_frame
from iiwa_dnn.control.policies import Action, Policy
from iiwa_dnn.errors import InvalidInputError, NoSolutionError
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.compiling import WATCH
from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck
from iiwa_dnn.references import Target
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.schemes.collisions import recorded, stated
from iiwa_dnn.simulation.chain import SignalChain
from iiwa_dnn.simulation.history import COMPLETED, History, settings_of, step_count, versions
from iiwa_dnn.simulation.incidents import Incidents
from iiwa_dnn.simulation.judgement import Judgement
from iiwa_dnn.simulation.motion import MOTIONS, Motion, accelerated, check_motion
from iiwa_dnn.simulation.noise import NoiseEntry, VelocityDisturbance
from iiwa_dnn.simulation.plants import IdealPlant, Plant

BLOCK = 1000
"""Steps between two hand-overs to the record and to the check."""

Progress = Callable[[int], object]


class Simulation:
    """One run, its arguments checked; `run` carries it out.

    Step k: the joints are read, the scheme builds the program at that reading and ``t[k]`` (and at
    the stages between), the network answers, every reference solver is asked the same, noise and
    filter act on the velocity, and the plant follows the result for dt. An altered command is
    clipped to the limits at the true joint positions, as by a drive that watches its own limits. At
    a step that the network cannot solve a policy decides; it is an Euler step, whatever the motion.
    If a policy slows down, the record's desired positions are those of the slowed clock.
    """

    def __init__(
        self,
        robot: Robot,
        scheme: Scheme,
        reference: References,
        q0: ArrayLike,
        *,
        plant: Plant | None = None,
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
        """Check the arguments, those of `simulate`, and draw the noise; q0 has the shape (n,)."""
        checks.positive("dt", dt)
        start = Configuration(robot, q0)
        paths = by_frame(reference, robot.tip).values()
        asked = max((path.duration for path in paths), default=dt) if duration is None else duration
        length = checks.positive("duration", asked)
        self._ideal = plant is None or isinstance(plant, IdealPlant)
        checks.not_negative("integral_gain", integral_gain)
        checks.integer("seed", seed, 0)
        self.steps = steps = step_count(length, dt)
        self._plant = IdealPlant() if plant is None else plant
        checks.offers("plant", self._plant, "start", "read", "move", "packages", "settings")
        self._check = checks.instance("check", CrossCheck() if check is None else check, CrossCheck)
        self._robot, self._dt, self._seed = robot, dt, seed
        self._q0 = start.arrays[0]
        solver = DNNSolver(tol=tol) if solver is None else solver
        self._controller = Controller(
            robot, scheme, reference, dt=dt, mode=mode, policy=policy, solver=solver
        )
        self._controller.anchor(start)
        plan = self._controller.plan
        check_motion(motion, mode != "converged" or not self._ideal, bool(plan.ahead))
        self._plant.start(robot, self._q0, dt, seed)
        self._controller.warn_if_far(start, 0.0, stacklevel=4)
        if integral_gain and len(plan.frames) > 1:
            raise InvalidInputError("integral_gain", "is for one tracked frame", integral_gain)
        self._motion = MOTIONS[motion]
        self._integral = IntegralFeedback(integral_gain) if integral_gain else None
        self._chain = chain = SignalChain(
            steps, robot.dof, dt, noise, noise_at, disturbance, filter_window, estimator, seed
        )
        if plan.accelerates and (chain.changes or integral_gain):
            problem = "is of the acceleration level: it takes no noise but of measurements"
            raise InvalidInputError("scheme", problem, scheme)
        self._misled = chain.misleads or not self._ideal
        self._altered = (chain.alters or motion != "euler") and not plan.accelerates
        shared = {
            "dt": dt, "duration": length, "mode": mode, "noise": noise, "noise_at": noise_at,
            "motion": motion if self._ideal else "physics", "filter_window": filter_window,
            "integral_gain": integral_gain, "policy": policy, "seed": seed,
            "disturbance": None if disturbance is None else disturbance.settings(),
            "estimator": None if estimator is None else estimator.settings(),
            "check": self._check.settings(), **stated(scheme, robot),
            "versions": versions(self._plant.packages),
        }  # fmt: skip
        self._settings = shared | settings_of(self._controller, self._q0) | self._plant.settings()

    def run(self, progress: Progress | None = None) -> Record:
        """Take every step, or those until a policy stops or the plant diverges; see `simulate`."""
        began = time.perf_counter() - WATCH.seconds
        self._restart()
        status, done, room = COMPLETED, 0, BLOCK
        stages, history = self._motion.stages, self._history
        cascade = self._controller.plan.cascade
        with Judgement(self._check, self.steps, stages, cascade) as self._judgement:
            while done < self.steps and status == COMPLETED:
                count = min(room, self.steps - done)
                # One target a stage, in the order in which the method of motion asks.
                times = np.add.outer(done + np.arange(count), self._motion.nodes) * self._dt
                times -= self._controller.delay
                self._answers = self._controller.answers(self._controller.sample(times.ravel()))
                taken, slowed = 0, False
                while taken < count and status == COMPLETED and not slowed:
                    taken += self._take_plain_steps(done, taken, count)
                    if taken < count:
                        delay = self._controller.delay
                        status = self._step(done + taken)
                        slowed = self._controller.delay != delay
                        taken += 1
                # A step that slows the clock down ends its block; so do the next ones, most likely.
                room = 1 if slowed else min(2 * room, BLOCK)
                answers = self._answers
                history.add_block(done, taken, stages, answers)
                self._incidents.multipliers(slice(done, done + taken), answers, stages)
                self._judgement.submit(answers)
                done += taken
                if progress is not None:
                    progress(taken)
            agreement = self._judgement.finish()
        last = self._controller.sample(np.array([done * self._dt - self._controller.delay]))
        history.end(done, last)
        return self._record(done, status, agreement, time.perf_counter() - WATCH.seconds - began)

    def _restart(self) -> None:
        """Put everything that a run changes back to where it begins."""
        self._controller.reset()
        self._plant.start(self._robot, self._q0, self._dt, self._seed)
        self._chain.restart()
        if self._integral is not None:
            self._integral.reset()
        self._incidents = Incidents(self.steps, self._robot, self._settings)
        with_torques = self._plant.torque is not None
        self._history = History(self.steps, self._controller, self._q0, with_torques)

    def _take_plain_steps(self, done: int, taken: int, count: int) -> int:
        """Take Euler steps of the ideal plant that nothing alters, as many as compiled code can."""
        plant = self._plant
        plain = not (self._altered or self._misled or self._integral or self._incidents.pending)
        if not plain or not isinstance(plant, IdealPlant):
            return 0
        if not (steps := self._controller.follow(plant.state, self._answers, count - taken)):
            return 0
        history, answers, rows = self._history, self._answers, slice(taken, taken + steps)
        to = slice(done + taken, done + taken + steps)
        history.q[to], history.q[to.stop] = answers.q[rows], plant.state
        history.dq[to] = history.dq_solver[to] = answers.all_dq[rows]
        return steps

    def _step(self, k: int) -> str:
        """Take step k and return the status that the run has after it."""
        history, answers, plan, dt = self._history, self._answers, self._controller.plan, self._dt
        q, t, first, ask = history.q[k], k * dt, answers.count, self._velocity_at
        before = mean = plan.begin()
        seen = self._chain.see(k, self._plant.read()) if self._misled else q
        try:
            if plan.accelerates:
                velocity, mean = accelerated(self._motion, ask, plan.last, seen, t, dt)
            else:
                velocity = self._motion.step(ask, seen, t, dt)
        except NoSolutionError as error:
            raise NoSolutionError(f"step {k}: {error}", error.problem, error.solution, k) from error
        if self._misled:
            answers.places[first] = self._controller.place(q)
        if answers.resolved or self._incidents.pending:
            velocity = self._resolved(k, first, velocity)
        history.dq_solver[k] = velocity
        if k in history.stops:
            history.stay(k)
            return self._incidents.status(k, t)
        plan.rewind()
        command = self._command(k, first, velocity) if self._altered else velocity
        if plan.yielding is not None or plan.accelerates:
            plan.tell(command)
        if history.ddq is not None:
            history.ddq[k] = (velocity - before) / dt
            if self._ideal:
                command = 0.5 * (before + velocity) if self._incidents.pending else mean
        self._plant.move(command)
        if history.torque is not None:
            history.torque[k] = self._plant.torque
        if self._plant.diverged:
            history.stay(k)
            return f"stopped at step {k} (t = {t:g} s): the physics diverged"
        history.q[k + 1] = self._plant.q
        # Of an arm with mass the mean velocity of the period.
        history.dq[k] = command if self._ideal else (history.q[k + 1] - q) / self._dt
        return COMPLETED

    def _velocity_at(self, q: Vector, t: float) -> Vector:
        """The controller's answer at the next stage of a step."""
        answers, index = self._answers, self._answers.count
        if self._integral is not None:
            target = Target.from_data(answers.targets[index])
            # Not while the arm cannot follow: the integral would wind up.
            if index % self._motion.stages == 0 and not self._incidents.pending:
                self._integral.observe(Configuration(self._robot, q), target, self._dt)
            answers.targets[index] = self._integral.apply(target).data
        self._controller.plan.rewind()
        velocity = self._controller.answer(q, answers, t)
        self._judgement.note()
        return velocity

    def _resolved(self, k: int, first: int, velocity: Vector) -> Vector:
        """Note what a policy decided in step k, if it did; returns the velocity of the step."""
        answers, incidents = self._answers, self._incidents
        incidents.pending = any(i >= first for i in answers.resolved)
        if not incidents.pending:
            return velocity
        # An Euler step; if only a later stage has no solution, the answer at its start will do.
        resolution = answers.resolved.get(first)
        answers.repeat(first)
        if resolution is None:
            incidents.act(k, Action.EULER)
        else:
            incidents.note(k, resolution)
            self._controller.delay += self._dt * (1.0 - resolution.fraction)
            if resolution.action is Action.STOP:
                self._controller.plan.halt(resolution)
                if not answers.dq(first).any():
                    self._history.stops.add(k)
        return answers.dq(first)

    def _command(self, k: int, first: int, velocity: Vector) -> Vector:
        """The velocity of step k on its way to the plant, kept within the limits at its true q."""
        controller, qp = self._controller, self._answers.qp(first)
        if self._misled:
            q, targets = self._history.q[k], self._answers.targets[first]
            qp = controller.program_at(q, targets, k * self._dt)
        command, clipped = self._chain.act(k, velocity, qp, controller.solver)
        self._incidents.clip(k, clipped)
        return command

    def _record(self, steps: int, status: str, agreement: Agreement, wall_time: float) -> Record:
        """Make the record of the steps that were taken."""
        t, history = self._dt * np.arange(steps + 1, dtype=np.float64), self._history
        return Record(
            t=t,
            **history.arrays(steps),
            solution_gap=agreement.solution_gap,
            objective_gap=agreement.objective_gap,
            reference_residual=agreement.reference_residual,
            settings={**self._settings, "status": status},
            **self._incidents.arrays(steps),
            **self._judgement.arrays(steps),
            **recorded(self._controller.scheme, self._robot, history.q[: steps + 1], t),
            wall_time_s=wall_time,
        )


def simulate(
    robot: Robot,
    scheme: Scheme,
    reference: References,
    q0: ArrayLike,
    *,
    plant: Plant | None = None,
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
    progress: Progress | None = None,
) -> Record:
    """Let a robot follow a reference, each step's program solved by the network and checked.

    Args:
        robot: The robot, n joints, with the limits that the scheme keeps.
        scheme: Builds the programs; where it has no home, `q0` becomes it.
        reference: Path of the tip, or paths by frame name; anchored by the caller.
        q0: Joint positions at the start [rad], (n,).
        plant: The arm that moves; None: the ideal one (`MujocoPlant` has masses and motors).
        dt: Control period [s].
        duration: Length of the run [s], rounded to whole steps; None takes the reference's.
        mode: ``"converged"`` or ``"continuous"`` (`iiwa_dnn.Controller`).
        motion: ``"euler"``, ``"midpoint"`` or ``"rk4"``; ``continuous`` and physics take ``euler``.
        noise: Standard deviation of white noise on each joint, in the unit of the quantity it is
            added to: [rad/s], or [rad] for ``measurement``.
        noise_at: ``"velocity"``, commanded; ``"network"``, its x; ``"measurement"``, read joints.
        disturbance: Added to every joint's velocity beside the noise.
        filter_window: Samples of the moving average; 1: no filter.
        integral_gain: Feedback of the error's integral [1/s^2] (`iiwa_dnn.control.feedback`).
        estimator: Noise model of a Kalman filter of the joint positions, whose bias the controller
            takes off its command; None: it sees what is measured.
        policy: At steps without solution: ``"slow"``, ``"relax"``, ``"stop"`` or ``"raise"``.
        seed: Seed of the noise; the same seed gives the same record, bit for bit, but for the last
            digits of the gap to ProxQP, which does not repeat itself.
        tol: Absolute tolerance on the KKT residuals in ``converged`` mode.
        check: Reference solvers; None asks ProxQP, ``CrossCheck(())`` nobody.
        solver: The network and its integrators, reset before the run; None takes the paper's
            network with `tol`.
        progress: Called now and then with the number of steps done since the last call.

    Returns:
        The record of the run.

    Raises:
        InvalidInputError: An argument is out of range; the message names it.
        NoSolutionError: A step has no solution and the policy is ``raise``.
    """
    return Simulation(
        robot, scheme, reference, q0,
        plant=plant, dt=dt, duration=duration, mode=mode, motion=motion, noise=noise,
        noise_at=noise_at, disturbance=disturbance, filter_window=filter_window,
        integral_gain=integral_gain, estimator=estimator, policy=policy, seed=seed, tol=tol,
        check=check, solver=solver,
    ).run(progress)  # fmt: skip
