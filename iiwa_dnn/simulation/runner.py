"""The simulation: controller, plant, noise and check in one loop, which ends in a Record."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from functools import cache
from importlib.metadata import version
from typing import Any

from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.control.controller import Controller, Mode
from iiwa_dnn.control.paths import References, by_frame
from iiwa_dnn.control.policies import Policy
from iiwa_dnn.errors import InvalidInputError, suggestion
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import Vector
from iiwa_dnn.qp.compiling import WATCH
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.results.record import RATES, Record
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes import Scheme
from iiwa_dnn.schemes.collisions import collision_arrays, collision_settings
from iiwa_dnn.simulation.chain import SignalChain
from iiwa_dnn.simulation.judgement import Judgement
from iiwa_dnn.simulation.loop import Loop
from iiwa_dnn.simulation.motion import MOTIONS, Motion, check_motion
from iiwa_dnn.simulation.noise import Disturbance
from iiwa_dnn.simulation.plants import IdealPlant, Plant
from iiwa_dnn.simulation.recorder import Recorder

COMPLETED = "completed"

BLOCK = 1000
"""Steps between two hand-overs to the record and to the check."""

MAX_STEPS = 20_000_000
"""More would not fit into the memory of a usual machine: a record takes 0.4 kB a step."""

_PACKAGES = ("iiwa-dnn", "numpy", "numba", "pin", "qpsolvers", "proxsuite", "osqp")

_version = cache(version)  # reading the versions of all takes as long as a hundred steps

Progress = Callable[[int], object]


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """Numbers and choices of a run.

    Attributes:
        dt: Control period [s].
        duration: Length of the run [s], rounded to whole steps; None takes the reference's.
        mode: ``"converged"`` or ``"continuous"`` (`iiwa_dnn.Controller`).
        motion: ``"euler"``, ``"midpoint"`` or ``"rk4"``; ``continuous`` and physics take ``euler``.
        policy: At steps without solution: ``"slow"``, ``"relax"`` or ``"stop"``.
        disturbance: Noise, filters and estimator.
        seed: Seed of the noise; the same seed gives the same record, bit for bit, but for the last
            digits of the gap to ProxQP, which does not repeat itself.
        tol: Absolute tolerance on the KKT residuals in ``converged`` mode.
        far_start: Whether the arm may go to a path of poses that begins elsewhere than the tip;
            else such a run is refused.
    """

    dt: float = 1e-4
    duration: float | None = None
    mode: Mode = "converged"
    motion: Motion = "euler"
    policy: Policy = "slow"
    disturbance: Disturbance = field(default_factory=Disturbance)
    seed: int = 0
    tol: float = 1e-9
    far_start: bool = False

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> RunOptions:
        """Make the options of those by name, fields of `Disturbance` among them.

        A `VelocityDisturbance` as `disturbance` is that of the velocity alone.
        """
        names = [each.name for each in fields(cls)]
        known = [*names, *(each.name for each in fields(Disturbance))]
        for name in options:
            if name not in known:
                raise TypeError(f"a run has no argument {name!r}{suggestion(name, known)}")
        own = {name: options[name] for name in names if name in options}
        others = {name: options[name] for name in options if name not in own}
        disturbance = own.pop("disturbance", None)
        if not isinstance(disturbance, Disturbance):
            disturbance = Disturbance(velocity=disturbance, **others)
        elif others:
            problem = f"holds {', '.join(others)} already"
            raise InvalidInputError("disturbance", problem, disturbance)
        return cls(disturbance=disturbance, **own)


class Simulation:
    """One run, its arguments checked; `run` carries it out.

    Attributes:
        controller: The controller of the run.
        steps: Number of steps.
    """

    def __init__(
        self,
        robot: Robot,
        scheme: Scheme,
        reference: References,
        q0: ArrayLike,
        *,
        plant: Plant | None = None,
        check: CrossCheck | None = None,
        solver: DNNSolver | None = None,
        **options: Any,
    ) -> None:
        """Check the arguments.

        Args:
            robot: The robot, n joints, with the limits that the scheme keeps.
            scheme: Builds the programs; if it has no home, `q0` becomes it.
            reference: Path of the tip, or paths by frame name; anchored by the caller.
            q0: Joint positions at the start [rad], (n,).
            plant: The arm that moves; None: the ideal one (`MujocoPlant` has masses and motors).
            check: Reference solvers; None asks ProxQP, ``CrossCheck(())`` nobody.
            solver: The network and its integrators, reset before the run; None takes the paper's
                network with the option `tol`.
            **options: Fields of `RunOptions` and of `Disturbance`, for example ``noise=0.01``.

        Raises:
            InvalidInputError: An argument is out of range; the message names it.
            TypeError: There is no argument of a name.
        """
        start = Configuration(robot, q0)
        chosen = RunOptions.of(options)
        dt = chosen.dt
        self._options = chosen
        self._plant = IdealPlant() if plant is None else plant
        checks.offers("plant", self._plant, "start", "read", "move", "packages", "settings")
        self._check = checks.instance("check", CrossCheck() if check is None else check, CrossCheck)
        solver = DNNSolver(tol=chosen.tol) if solver is None else solver
        self.controller = Controller(
            robot, scheme, reference, dt=dt, mode=chosen.mode, policy=chosen.policy, solver=solver
        )
        self._q0 = start.arrays[0]
        asked = chosen.duration
        if asked is None:
            paths = by_frame(reference, robot.tip).values()
            asked = max((path.duration for path in paths), default=dt)
        length = checks.positive("duration", asked)
        self.steps = step_count(length, dt)
        self.controller.anchor(start)
        self._check_combination()
        self._plant.start(robot, self._q0, dt, chosen.seed)
        self.controller.warn_if_far(start, 0.0, 4, refuses=not chosen.far_start)
        self._settings = self._stated(length)

    def _check_combination(self) -> None:
        """Raise InvalidInputError if the arguments do not go together."""
        controller = self.controller
        program = controller.program
        one_clock = controller.mode != "converged" or not self._plant.exact
        check_motion(self._options.motion, one_clock, bool(program.ahead))

    def _stated(self, duration: float) -> dict[str, Any]:
        """Return the settings of the run, of this duration [s]."""
        controller = self.controller
        robot = controller.robot
        solver = controller.solver
        program = controller.program
        integrator = solver.settler if controller.mode == "converged" else solver.follower
        limits = program.rate_limits
        rates: list[Vector] = []
        if limits is not None:
            rates = list(limits.constants(robot).reshape(6, -1)[3:5])
        return {
            "dt": controller.dt,
            "duration": duration,
            **_end_of_path(controller.reference, duration),
            "mode": controller.mode,
            "motion": self._options.motion if self._plant.exact else "physics",
            "policy": controller.policy,
            "seed": self._options.seed,
            **self._options.disturbance.settings(),
            "check": self._check.settings(),
            **collision_settings(controller.scheme, robot),
            "versions": {name: _version(name) for name in (*_PACKAGES, *self._plant.packages)},
            "robot": robot.name,
            "joints": robot.joint_names,
            "locked": dict(zip(robot.locked, robot.q_locked, strict=True)) or None,
            "tip": program.target_frames[0],
            "frames": list(program.target_frames[1:]),
            "q_lower": robot.q_lower,
            "q_upper": robot.q_upper,
            "dq_max": robot.dq_max,
            **dict(zip(RATES, rates, strict=False)),
            "q0": self._q0,
            "tol": solver.tol,
            "rho": solver.network.rho,
            "network": solver.network.settings(),
            "integrator": integrator.settings(),
            "scheme": controller.scheme.settings(),
            "reference": _reference_settings(controller.reference),
            **program.settings(),
            **self._plant.settings(),
        }

    def run(self, progress: Progress | None = None) -> Record:
        """Take every step, or those until a policy or the plant ends the run.

        Args:
            progress: Called now and then with the number of steps done since the last call.
        """
        began = time.perf_counter() - WATCH.seconds
        controller = self.controller
        dt = controller.dt
        controller.reset()
        self._plant.start(controller.robot, self._q0, dt, self._options.seed)
        loop = self._loop()
        recorder = Recorder(self.steps, controller, loop.q, self._settings)
        stages = MOTIONS[self._options.motion].stages
        layout = recorder.layout
        done = 0
        with Judgement(self._check, self.steps, stages, layout) as judgement:
            observers = (recorder.observe,)
            while done < self.steps and recorder.last_step is None:
                taken = loop.run(min(BLOCK, self.steps - done), observers, done)
                judgement.submit(recorder.flush())
                done += taken
                if progress is not None:
                    progress(taken)
            agreement = judgement.finish()
        columns = recorder.finish()
        return Record(
            **columns,
            solution_gap=agreement.solution_gap,
            objective_gap=agreement.objective_gap,
            reference_residual=agreement.reference_residual,
            judge=agreement.judge,
            settings={
                **self._settings,
                **self._plant.settings(),
                "status": self._status(recorder),
                "infeasible_step": recorder.infeasible,
            },
            **collision_arrays(controller.scheme, controller.robot, columns["q"], columns["t"]),
            wall_time_s=time.perf_counter() - WATCH.seconds - began,
        )

    def _loop(self) -> Loop:
        """Make the loop of one run, its noise drawn."""
        controller = self.controller
        disturbance = self._options.disturbance
        chain = SignalChain(
            disturbance, self.steps, controller.robot.dof, controller.dt, self._options.seed
        )
        return Loop(controller, self._plant, self._options.motion, chain)

    def _status(self, recorder: Recorder) -> str:
        """Describe the end of a run."""
        k = recorder.last_step
        if k is None:
            return COMPLETED
        where = f"stopped at step {k} (t = {k * self.controller.dt:g} s)"
        if self._plant.fault is not None:
            return f"{where}: {self._plant.fault}"
        against = recorder.stop_reason(k)
        if self.controller.mode == "continuous" and not against:
            return f"{where}: the network diverged: take a smaller dt, larger rho or more substeps"
        return f"{where}: no solution{against}"


def simulate(
    robot: Robot,
    scheme: Scheme,
    reference: References,
    q0: ArrayLike,
    *,
    progress: Progress | None = None,
    **options: Any,
) -> Record:
    """Let a robot follow a reference, each step's program solved by the network and checked.

    Args:
        robot: The robot, n joints, with the limits that the scheme keeps.
        scheme: Builds the programs; if it has no home, `q0` becomes it.
        reference: Path of the tip, or paths by frame name; anchored by the caller.
        q0: Joint positions at the start [rad], (n,).
        progress: Called now and then with the number of steps done since the last call.
        **options: Keyword arguments of `Simulation`: plant, check, solver, and the fields of
            `RunOptions` (dt, duration, mode, motion, policy, seed, tol, far_start, disturbance) and
            of `Disturbance`.

    Returns:
        The record of the run.

    Raises:
        InvalidInputError: An argument is out of range; the message names it.
    """
    simulation = Simulation(robot, scheme, reference, q0, **options)
    return simulation.run(progress)


def _reference_settings(reference: References | None) -> dict[str, Any]:
    """Return name and parameters of a reference, or of each frame's."""
    if not isinstance(reference, Mapping):
        return {} if reference is None else reference.settings()
    return {"name": "frames"} | {name: path.settings() for name, path in reference.items()}


def _end_of_path(reference: References | None, duration: float) -> dict[str, float]:
    """Return the time of a path that is once through before the run of this duration is [s]."""
    end = max((path.duration for path in by_frame(reference, "").values()), default=duration)
    return {"path_duration": end} if end < duration else {}


def step_count(duration: float, dt: float) -> int:
    """Count the whole steps in a run; raise InvalidInputError if there are none or too many."""
    steps = duration / dt
    if not 0.5 < steps <= MAX_STEPS:
        by_dt = steps > 1.0 and dt < 1e-6
        problem = f"{steps:.3g} steps of {dt:g} s; there must be from 1 to {MAX_STEPS:,}"
        raise InvalidInputError("dt" if by_dt else "duration", problem, dt if by_dt else duration)
    return max(1, round(steps))
