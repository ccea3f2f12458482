"""A step of the control loop beside PlaCo, Pink and mink, and beside PlaCo among three balls.

Each library's loop is a process in the Python that has it (`loops`), and they take turns, so that
noise of the machine falls on all alike. The same kinematics judge all postures.
"""

import importlib.util
import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pinocchio as pin

import iiwa_dnn
from benchmarks.report import show
from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.robot.collision import collision_model
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot

CHUNK = 250
"""Steps that one takes before it is the next one's turn."""

DT = 1e-3
"""Control period [s]."""

BALLS = ([0.36, 0.16, 0.64], [0.7, 0.0, 0.3], [-0.3, 0.5, 0.6])
RADII = (0.05, 0.1, 0.1)
DISTANCE = 0.03
"""Balls beside the path, their radii, and the distance to keep [m]."""

Taken = dict[str, list[Any]]
"""Times ``us`` [us] and joint positions ``q`` [rad] of a loop's steps."""


class Loop(NamedTuple):
    """A loop that is measured: a module that its Python has, a file in ``loops``, its argument."""

    name: str
    module: str
    driver: str
    variant: str = ""
    among_balls: bool = False


LOOPS = (
    Loop("iiwa_dnn, `Controller.step`", "iiwa_dnn", "own_loop", "", True),
    Loop("PlaCo", "placo", "placo_loop", "", True),
    Loop("Pink, daqp", "pink", "pink_loop"),
    Loop("Pink, daqp, target one step ahead", "pink", "pink_loop", "ahead"),
    Loop("mink, daqp", "mink", "mink_loop"),
)

_COLUMNS = {
    "step": "{name}",
    "median µs": "{median:.1f}",
    "p99 µs": "{p99:.1f}",
    "p99.9 µs": "{p999:.1f}",
    "largest position error m": "{error:.2e}",
}


class Driver:
    """A process that takes the steps of a loop, in the Python that has its library."""

    def __init__(self, loop: Loop, python: Path, task: Path) -> None:
        file = Path(__file__).with_name("loops") / f"{loop.driver}.py"
        self._name = loop.name
        self._errors = tempfile.TemporaryFile("w+")  # noqa: SIM115
        self._process = subprocess.Popen(
            [python, file, task, loop.variant],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )

    def take(self, first: int, last: int) -> Taken:
        """Take steps.

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
            raise IiwaDnnError(f"{self._name}: {reason or 'the driver ended'}")
        taken: Taken = json.loads(answer)
        return taken

    def close(self) -> None:
        """End the process."""
        self._process.communicate()
        self._errors.close()


def take_turns(loops: Mapping[Loop, Path], task: Path, steps: int) -> dict[Loop, Taken]:
    """Let loops take their steps in turns, each in a process of its Python interpreter."""
    taken: dict[Loop, Taken] = {loop: {"us": [], "q": []} for loop in loops}
    with ExitStack() as stack:
        drivers: dict[Loop, Driver] = {}
        for loop, python in loops.items():
            drivers[loop] = driver = Driver(loop, python, task)
            stack.callback(driver.close)
        for first in range(0, steps, CHUNK):
            for loop, driver in drivers.items():
                for name, values in driver.take(first, min(first + CHUNK, steps)).items():
                    taken[loop][name] += values
    return taken


def make_task(steps: int) -> dict[str, Any]:
    """Return the arrays that the drivers are given: robot, start and poses of the heart."""
    robot = paper_robot()
    reference = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, paper.START))
    targets = reference.sample(np.arange(max(steps, 20) + 1) * DT)
    return {
        "urdf": str(robot.path),
        "tip": robot.tip,
        "names": robot.joint_names,
        "dt": DT,
        "q0": paper.START,
        "lower": robot.q_lower,
        "upper": robot.q_upper,
        "velocity": robot.dq_max,
        "poses": [pin.SE3(t.rotation.copy(), t.position.copy()).homogeneous for t in targets],
    }


def make_scene() -> dict[str, Any]:
    """Return the capsules of the moving links, and the balls that they are kept away from."""
    moving = [c for c in collision_model(paper_robot()).capsules if not c.link.endswith("_0")]
    return {
        "links": [capsule.link for capsule in moving],
        "a": [capsule.shape.a for capsule in moving],
        "b": [capsule.shape.b for capsule in moving],
        "radii": [capsule.shape.radius for capsule in moving],
        "balls": BALLS,
        "ball_radii": RADII,
        "distance": DISTANCE,
    }


def find_pythons(given: Mapping[str, Path | None]) -> dict[str, Path]:
    """Return the Python interpreter that has each module; those are left out that none has."""
    found = {}
    for module in dict.fromkeys(loop.module for loop in LOOPS):
        python = given.get(module) or (importlib.util.find_spec(module) and Path(sys.executable))
        if python:
            found[module] = python
    return found


def measure(task: Mapping[str, Any], taken: Mapping[Loop, Taken]) -> list[dict[str, Any]]:
    """Return the percentiles of each loop's times [us] and its errors, largest [m]."""
    robot = paper_robot()
    rows = []
    for loop, own in taken.items():
        tips = [iiwa_dnn.Configuration(robot, q).position for q in own["q"]]
        wanted = np.array([pose[:3, 3] for pose in task["poses"][1 : len(tips) + 1]])
        median, p99, p999 = np.percentile(own["us"], [50.0, 99.0, 99.9])
        error = np.linalg.norm(np.array(tips) - wanted, axis=1).max()
        row = {"name": loop.name, "median": median, "p99": p99, "p999": p999, "error": error}
        rows.append({**row, "q": np.array(own["q"])})
    return rows


def report(steps: int, pythons: Mapping[str, Path | None]) -> None:
    """Print the steps of all loops on the heart, alone and among the balls."""
    found = find_pythons(pythons)
    there = {loop: found[loop.module] for loop in LOOPS if loop.module in found}
    few = {loop: python for loop, python in there.items() if loop.among_balls}
    task = make_task(steps)
    balls = list(map(iiwa_dnn.Sphere, BALLS, RADII))
    judge = iiwa_dnn.CollisionAvoidance(balls, self_collision=False).scene(paper_robot())
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "task.npz"
        np.savez(file, **task)
        rows = measure(task, take_turns(there, file, steps))
        np.savez(file, **task, **make_scene())
        others = measure(task, take_turns(few, file, steps))
    for row in others:
        row["near"] = judge.nearest(row["q"], np.zeros(len(row["q"])))[0].min()
    show(f"The heart, {steps} steps of {DT:g} s", _COLUMNS, rows)
    title = f"Among balls, {len(judge.pairs)} pairs kept {DISTANCE:g} m apart, {steps} steps"
    show(title, {**_COLUMNS, "least distance m": "{near:.5f}"}, others)
    missing = sorted({loop.module for loop in LOOPS} - found.keys())
    if missing:
        print(f"\nNot measured, since no Python has it: {', '.join(missing)}.")
