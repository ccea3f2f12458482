"""The control loop beside its peers', whole runs, and the parts of a step."""

import importlib.util
import json
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack, suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin

from iiwa_dnn.control.controller import Controller
from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.files import one_line
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.crosscheck import OPTIONS, CrossCheck
from iiwa_dnn.qp.program import Vector
from iiwa_dnn.references import Heart
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes import DoubleIndicator
from iiwa_dnn.simulation import simulate
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot
from scripts import own_parts

CHUNK = 250
"""Steps that one takes before it is the next one's turn."""


class Loop(NamedTuple):
    """A loop that is measured.

    Attributes:
        name: Its name in the report.
        module: The module that its Python has to have.
        driver: File in ``loops``, without its ending.
        variant: Argument of the driver.
    """

    name: str
    module: str
    driver: str
    variant: str = ""


LOOPS = (
    Loop("iiwa_dnn, Controller.step", "iiwa_dnn", "own_loop", "command"),
    Loop("iiwa_dnn, with q + dt dq", "iiwa_dnn", "own_loop", "euler"),
    Loop("iiwa_dnn, with midpoint", "iiwa_dnn", "own_loop", "midpoint"),
    Loop("PlaCo", "placo", "placo_loop"),
    Loop("Pink, daqp", "pink", "pink_loop", "daqp"),
    Loop("Pink, daqp, target one step ahead", "pink", "pink_loop", "daqp, ahead"),
    Loop("Pink, proxqp", "pink", "pink_loop", "proxqp"),
    Loop("mink, daqp", "mink", "mink_loop", "daqp"),
    Loop("Drake", "pydrake", "drake_loop"),
)


@dataclass
class Taken:
    """Times [us] and joint positions [rad] of a loop's steps, and the error that ended it."""

    us: list[float] = field(default_factory=list)
    q: list[list[float]] = field(default_factory=list)
    problem: str = ""


class Driver:
    """A process that takes the steps of a loop, in the Python that has its library."""

    def __init__(self, loop: Loop, python: Path, task: Path) -> None:
        file = Path(__file__).with_name("loops") / f"{loop.driver}.py"
        self._loop = loop
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115
        try:
            self._process = subprocess.Popen(
                [python, file, task, loop.variant],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=self._errors,
                text=True,
            )
        except OSError as error:
            self._errors.close()
            raise IiwaDnnError(f"{loop.name}: {python}: {one_line(error)}") from error

    def take(self, first: int, last: int) -> dict[str, Any]:
        """Take steps; returns the time ``us`` [us] and the joint positions ``q`` of each.

        Raises:
            IiwaDnnError: The driver ended; the message has its last line on standard error.
        """
        answer = ""
        with suppress(BrokenPipeError):
            if self._process.stdin and self._process.stdout:
                self._process.stdin.write(f"{first} {last}\n")
                self._process.stdin.flush()
                answer = self._process.stdout.readline()
        if not answer:
            self._errors.seek(0)
            reason = self._errors.read().strip().rpartition("\n")[2]
            raise IiwaDnnError(f"{self._loop.name}: {reason or 'the driver ended'}")
        taken: dict[str, Any] = json.loads(answer)
        return taken

    def close(self) -> None:
        """End the process."""
        self._process.communicate()
        self._errors.close()


def take_turns(
    loops: Mapping[Loop, Path],
    task: Path,
    steps: int,
    progress: Callable[[int], object],
    tolerant: bool = False,
) -> dict[Loop, Taken]:
    """Let loops take their steps in turns, each in a process of its Python interpreter.

    Raises:
        IiwaDnnError: A loop ended with an error; if `tolerant`, the others go on.
    """
    taken = {loop: Taken() for loop in loops}
    with ExitStack() as stack:
        drivers: dict[Loop, Driver] = {}
        for loop, python in loops.items():
            drivers[loop] = driver = Driver(loop, python, task)
            stack.callback(driver.close)
        for first in range(0, steps, CHUNK):
            last = min(first + CHUNK, steps)
            for loop, driver in drivers.items():
                if taken[loop].problem:
                    continue
                try:
                    answer = driver.take(first, last)
                except IiwaDnnError as error:
                    if not tolerant:
                        raise
                    taken[loop].problem = str(error)
                else:
                    taken[loop].us += answer["us"]
                    taken[loop].q += answer["q"]
            progress(last - first)
    return taken


def measure_steps(
    steps: int,
    dt: float,
    pythons: Mapping[str, Path | None] | None = None,
    progress: Callable[[int], object] = lambda done: None,
    scene: Mapping[str, Any] | None = None,
    loops: Sequence[Loop] = LOOPS,
) -> tuple[list[dict[str, Any]], list[str]]:
    """Let all loops follow the beginning of the heart, in turns, each in a process of its own.

    Args:
        steps: Control steps of each.
        dt: Control period [s].
        pythons: Python interpreter by module, for libraries that this one does not have.
        progress: Called with the number of steps done since the last call.
        scene: Further arrays of the task, such as obstacles; with `poses`, of another one.
        loops: Loops to measure.

    Returns:
        Of each loop the times per step [us] and the largest distance to the reference [m] after a
        step, with a scene also the joint positions; and the modules that no Python was found for.
    """
    robot = paper_robot()
    given = pythons or {}
    reference = Heart().anchored(Configuration(robot, paper.START))
    targets = reference.sample(np.arange(max(steps, 20) + 1) * dt)
    found: dict[str, Path] = {}
    for module in dict.fromkeys(loop.module for loop in loops):
        python = given.get(module) or (importlib.util.find_spec(module) and Path(sys.executable))
        if python:
            found[module] = python
    data = robot.model.createData()
    with tempfile.TemporaryDirectory() as folder:
        task = Path(folder) / "task.npz"
        heart = {
            "urdf": str(robot.path),
            "tip": robot.tip,
            "names": robot.joint_names,
            "dt": dt,
            "q0": paper.START,
            "lower": robot.q_lower,
            "upper": robot.q_upper,
            "velocity": robot.dq_max,
            "poses": [pin.SE3(t.rotation.copy(), t.position.copy()).homogeneous for t in targets],
        }
        np.savez(task, **{**heart, **(scene or {})})
        there = {loop: found[loop.module] for loop in loops if loop.module in found}
        taken = take_turns(there, task, steps, progress)
    rows = []
    for loop, each in taken.items():
        us = each.us
        q = each.q
        on_heart = [] if scene and "poses" in scene else q
        tips = [Configuration(robot, at, data).position for at in on_heart]
        errors = [float(np.linalg.norm(at - targets[k].position)) for k, at in enumerate(tips, 1)]
        row = {
            "name": loop.name,
            "median_us": float(np.median(us)),
            "p99_us": float(np.percentile(us, 99.0)),
            "p999_us": float(np.percentile(us, 99.9)),
            "max_position_error_m": max(errors, default=0.0),
        }
        rows.append({**row, **({"q": q} if scene else {})})
    return rows, sorted({loop.module for loop in loops} - set(found))


def measure_own_part(duration: float, dt: float, rounds: int = 3) -> dict[str, float]:
    """Time checked runs with and without the limit of ``scripts/own_parts.py``, in turns.

    Returns:
        Median wall times [s] ``built_in`` and ``own_part``, and their ratio.
    """
    robot = paper_robot()
    heart = Heart().anchored(Configuration(robot, own_parts.START))
    limit = own_parts.Clearance(own_parts.ELBOW, own_parts.POINT, 0.20)
    schemes = {"built_in": own_parts.scheme(), "own_part": own_parts.scheme(limit)}
    walls: dict[str, list[float]] = {name: [] for name in schemes}
    for k in range(rounds + 1):
        for name, scheme in schemes.items():
            length = duration if k else min(duration, 20 * dt)  # the first round compiles
            began = time.perf_counter()
            simulate(robot, scheme, heart, own_parts.START, dt=dt, duration=length)
            if k:
                walls[name].append(time.perf_counter() - began)
    medians = {name: float(np.median(values)) for name, values in walls.items()}
    return {**medians, "ratio": medians["own_part"] / medians["built_in"]}


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
    scheme = DoubleIndicator().anchored(start)
    reference = Heart().anchored(start)
    walls: dict[str, list[float]] = {
        name: [] for name in ("unchecked", "checked", "proxqp", "proxqp_with_problem")
    }
    for _ in range(rounds):
        for name, check in (("unchecked", CrossCheck(())), ("checked", CrossCheck())):
            began = time.perf_counter()
            record = simulate(
                robot, scheme, reference, paper.START, dt=dt, duration=duration, check=check
            )
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

    # Through qpsolvers, as others ask it: that does not hand all settings on.
    handed = {key: value for key, value in OPTIONS["proxqp"].items() if not key.endswith("_inf")}
    options = {"backend": "dense", **handed}
    data = robot.model.createData()
    solving = 0.0
    making = 0.0
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


def profile_step(dt: float, steps: int) -> list[tuple[str, float]]:
    """Measure the parts of a step on their own [us], called in a row from Python."""
    robot = paper_robot()
    start = Configuration(robot, paper.START)
    scheme = DoubleIndicator().anchored(start)
    reference = Heart().anchored(start)

    def run() -> Record:
        return simulate(
            robot, scheme, reference, paper.START, dt=dt, duration=steps * dt, check=CrossCheck(())
        )

    record = run()
    targets = reference.sample(record.t[:-1])
    data = robot.model.createData()
    solver = DNNSolver()
    confs = [Configuration(robot, q, data) for q in record.q[:-1]]
    programs = [scheme.build_qp(conf, targets[k]) for k, conf in enumerate(confs)]
    controller = Controller(robot, scheme, dt=dt)

    def answer(k: int) -> None:
        controller.step(confs[k].arrays[0], k * dt, targets[k])

    check = CrossCheck()
    block = min(steps, 500)
    rows = np.stack([qp.data for qp in programs[:block]])
    x = np.stack([solver.solve(qp).x for qp in programs[:block]])
    return [
        (
            "kinematics: Configuration",
            _per_call(lambda k: Configuration(robot, record.q[k], data), steps),
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
        ("kinematics, program and network: Controller.answer", _per_call(answer, steps)),
        ("reference: sample, per target", _each(lambda: reference.sample(record.t[:-1]), steps)),
        ("the whole loop, per step", _each(run, steps)),
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
