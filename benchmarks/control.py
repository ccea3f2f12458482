"""One control step of this package beside one of Pink's: same URDF, heart and period."""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
import pink
import pinocchio as pin

from iiwa_dnn.control.controller import Controller
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.references import Heart, Target
from iiwa_dnn.references.targets import Targets
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import MOTIONS, Simulation
from iiwa_dnn.studies import paper

CHUNK = 50
"""Steps that one takes before it is the next one's turn."""


def paper_robot() -> Robot:
    """The iiwa 7 with the paper's position limits."""
    return load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)


class Stepper(ABC):
    """Somebody who follows the heart, one control step after the other.

    Attributes:
        name: What the report calls it.
        q: Where its robot is [rad], (n,).
    """

    name: str
    q: Vector

    @abstractmethod
    def step(self, targets: Targets, k: int) -> None:
        """Go from t_k to t_k + dt; targets lie half a period apart."""


class Ours(Stepper):
    """The classes that a person uses step by step."""

    def __init__(self, dt: float, motion: str = "euler") -> None:
        robot = paper_robot()
        start = Configuration(robot, paper.START)
        scheme = DoubleIndicator().anchored(start)
        self._controller, self._dt = Controller(robot, scheme, dt=dt), dt
        self._motion = MOTIONS[motion].step
        self.name = f"iiwa_dnn, {motion}"
        self.q = np.array(start.q)

    def step(self, targets: Targets, k: int) -> None:
        """Take one step by the method of motion."""
        dt = self._dt

        def velocity(q: Vector, t: float) -> Vector:
            target = targets[2 * k + round(2.0 * t / dt)]
            return self._controller.step(q, k * dt + t, target).dq

        self.q = self.q + dt * self._motion(velocity, self.q, 0.0, dt)


class Pink(Stepper):
    """Pink's differential inverse kinematics: a frame task and a weak posture task.

    With `ahead`, the task's target is that of the step's end; without, as in Pink's examples, that
    of its beginning.
    """

    def __init__(self, dt: float, solver: str, ahead: bool = False, **options: Any) -> None:
        robot = paper_robot()
        self._model = robot.model.copy()
        self._model.lowerPositionLimit = robot.q_lower
        self._model.upperPositionLimit = robot.q_upper
        self._model.velocityLimit = robot.dq_max
        self._configuration = pink.Configuration(
            self._model, self._model.createData(), np.array(paper.START)
        )
        self._frame = pink.FrameTask(robot.tip, position_cost=1.0, orientation_cost=1.0)
        posture = pink.PostureTask(cost=1e-3)
        posture.set_target(np.array(paper.START))
        self._tasks = [self._frame, posture]
        self._dt, self._solver, self._options, self._later = dt, solver, options, 2 * ahead
        self.name = f"Pink, {solver}{', target one step ahead' if ahead else ''}"

    @property
    def q(self) -> Vector:  # type: ignore[override]
        """Where Pink's robot is [rad], (n,)."""
        return np.asarray(self._configuration.q)

    def step(self, targets: Targets, k: int) -> None:
        """Set the frame task's target, solve and integrate, as in Pink's examples."""
        target: Target = targets[2 * k + self._later]
        self._frame.set_target(pin.SE3(np.array(target.rotation), np.array(target.position)))
        velocity = pink.solve_ik(
            self._configuration, self._tasks, self._dt, solver=self._solver, **self._options
        )
        self._configuration.integrate_inplace(velocity, self._dt)


def steppers(dt: float) -> list[Stepper]:
    """All that are compared; the first is this package."""
    return [
        Ours(dt),
        Ours(dt, "midpoint"),
        Pink(dt, "daqp"),
        Pink(dt, "daqp", ahead=True),
        Pink(dt, "proxqp", eps_abs=1e-9, eps_rel=0.0),
    ]


def measure_steps(
    steps: int, dt: float, progress: Callable[[int], object] = lambda done: None
) -> list[dict[str, Any]]:
    """Let everyone follow the beginning of the heart, in turns.

    Args:
        steps: Control steps of each.
        dt: Control period [s].
        progress: Called with the number of steps done since the last call.

    Returns:
        For each, times per step [us] and the largest distance to the reference [m] after a step.
    """
    robot = paper_robot()
    reference = Heart().anchored(Configuration(robot, paper.START))
    targets = reference.sample(np.arange(2 * steps + 1) * (0.5 * dt))
    everyone = steppers(dt)
    for somebody in steppers(dt):  # compiles, and loads what is loaded late
        for k in range(3):
            somebody.step(targets, k)
    times = {somebody.name: np.empty(steps) for somebody in everyone}
    errors = dict.fromkeys(times, 0.0)
    data = robot.model.createData()
    for first in range(0, steps, CHUNK):
        for somebody in everyone:
            for k in range(first, min(first + CHUNK, steps)):
                began = time.perf_counter_ns()
                somebody.step(targets, k)
                times[somebody.name][k] = 1e-3 * (time.perf_counter_ns() - began)
                tip = Configuration(robot, somebody.q, data).position
                error = float(np.linalg.norm(tip - targets[2 * k + 2].position))
                errors[somebody.name] = max(errors[somebody.name], error)
        progress(CHUNK)
    return [
        {
            "name": name,
            "median_us": float(np.median(samples)),
            "p99_us": float(np.percentile(samples, 99.0)),
            "p999_us": float(np.percentile(samples, 99.9)),
            "max_position_error_m": errors[name],
        }
        for name, samples in times.items()
    ]


def measure_runs(duration: float, dt: float, rounds: int = 3) -> dict[str, Any]:
    """Whole runs, unchecked and checked, and ProxQP alone on the same programs; in turns.

    ProxQP is given its programs in blocks that are built before the clock starts. "With the
    problem" counts making a `qpsolvers.Problem` of arrays, which a caller has to do as well.

    Args:
        duration: Length of the motion [s].
        dt: Control period [s].
        rounds: How often each is done; the median counts.

    Returns:
        Wall times [s], and how many times as long the motion takes.
    """
    robot = paper_robot()
    start = Configuration(robot, paper.START)
    scheme, reference = DoubleIndicator().anchored(start), Heart().anchored(start)
    walls: dict[str, list[float]] = {
        name: [] for name in ("unchecked", "checked", "proxqp", "proxqp_with_problem")
    }
    for _ in range(rounds):
        for name, check in (("unchecked", CrossCheck(())), ("checked", CrossCheck())):
            simulation = Simulation(
                robot, scheme, reference, paper.START, dt=dt, duration=duration, check=check
            )
            began = time.perf_counter()
            record = simulation.run()
            walls[name].append(time.perf_counter() - began)
        solving, making = _proxqp_alone(robot, scheme, reference, record)
        walls["proxqp"].append(solving)
        walls["proxqp_with_problem"].append(solving + making)
    medians = {name: float(np.median(values)) for name, values in walls.items()}
    return {
        "steps": record.steps,
        "duration_s": duration,
        "wall_s": medians,
        "realtime_factor": {name: duration / medians[name] for name in ("unchecked", "checked")},
        "checked_over_proxqp": medians["checked"] / medians["proxqp"],
        "checked_over_proxqp_with_problem": medians["checked"] / medians["proxqp_with_problem"],
    }


def _proxqp_alone(robot: Robot, scheme: Any, reference: Any, record: Any) -> tuple[float, float]:
    """Seconds that ProxQP takes over every program of a run, and that making them takes."""
    import qpsolvers

    options = CrossCheck().options("proxqp")
    data, solving, making = robot.model.createData(), 0.0, 0.0
    for first in range(0, record.steps, 1000):
        rows = slice(first, min(first + 1000, record.steps))
        targets = reference.sample(record.t[rows])
        programs = [
            scheme.build_qp(Configuration(robot, q, data), targets[i])
            for i, q in enumerate(record.q[rows])
        ]
        began = time.perf_counter()
        problems = [qp.to_qpsolvers() for qp in programs]
        making += time.perf_counter() - began
        began = time.perf_counter()
        for problem in problems:
            qpsolvers.solve_problem(problem, solver="proxqp", **options)
        solving += time.perf_counter() - began
    return solving, making


def profile_step(dt: float, steps: int = 2000) -> list[tuple[str, float]]:
    """What the parts of a step take on their own [us], called in a row from Python."""
    robot = paper_robot()
    start = Configuration(robot, paper.START)
    scheme, reference = DoubleIndicator().anchored(start), Heart().anchored(start)
    simulation = Simulation(
        robot, scheme, reference, paper.START, dt=dt, duration=steps * dt, check=CrossCheck(())
    )
    record = simulation.run()
    targets, data, solver = reference.sample(record.t[:-1]), robot.model.createData(), DNNSolver()
    confs = [Configuration(robot, q, data) for q in record.q[:-1]]
    programs = [scheme.build_qp(conf, targets[k]) for k, conf in enumerate(confs)]
    controller = Controller(robot, scheme, dt=dt)
    answers = controller.answers(targets.data)

    def answer(k: int) -> None:
        answers.count = k
        controller.answer(confs[k].arrays[0], answers)

    check, block = CrossCheck(), min(steps, 500)
    rows = np.stack([qp.data for qp in programs[:block]])
    x = np.stack([solver.solve(qp).x for qp in programs[:block]])
    return [
        (
            "kinematics: Configuration.from_checked",
            _per_call(lambda k: Configuration.from_checked(robot, record.q[k], data), steps),
        ),
        (
            "of that, Pinocchio's two calls",
            _per_call(lambda k: _pinocchio(robot, record.q[k], data), steps),
        ),
        (
            "program: Scheme.build_qp",
            _per_call(lambda k: scheme.build_qp(confs[k], targets[k]), steps),
        ),
        ("network: DNNSolver.solve", _per_call(lambda k: solver.solve(programs[k]), steps)),
        (
            "kinematics, program and network: Controller.answer",
            _per_call(answer, steps),
        ),
        ("reference: sample, per target", _each(lambda: reference.sample(record.t[:-1]), steps)),
        ("the whole loop, per step", _each(simulation.run, steps)),
        (
            "check: ProxQP, per step",
            _each(lambda: check.check_block(rows, programs[0].sizes, x), block),
        ),
    ]


def _pinocchio(robot: Robot, q: Vector, data: pin.Data) -> Any:
    pin.computeFrameJacobian(robot.model, data, q, robot.tip_id, pin.LOCAL_WORLD_ALIGNED)
    return pin.updateFramePlacement(robot.model, data, robot.tip_id).homogeneous


def _per_call(call: Callable[[int], object], steps: int) -> float:
    """Time of one call of many in a row [us]: the clock is not among them."""

    def all_of_them() -> None:
        for k in range(steps):
            call(k)

    return _each(all_of_them, steps)


def _each(call: Callable[[], object], count: int) -> float:
    times = []
    for _ in range(5):
        began = time.perf_counter_ns()
        call()
        times.append(time.perf_counter_ns() - began)
    return 1e-3 * float(np.median(times)) / count
