"""Whole runs, unchecked and checked; time of a new process until its first step."""

import subprocess
import sys
import time
from collections.abc import Iterator
from typing import Any

import numpy as np

import iiwa_dnn
from benchmarks.report import show
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import paper_robot

ROUNDS = 5
"""Repetitions of each, of which the median counts."""

_IMPORT = """
import time; began = time.perf_counter()
import iiwa_dnn
print(time.perf_counter() - began)
"""

_FIRST_STEP = """
import iiwa_dnn
robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
conf = iiwa_dnn.Configuration(robot, robot.start_posture())
reference = iiwa_dnn.Heart().anchored(conf)
controller = iiwa_dnn.Controller(robot, iiwa_dnn.DoubleIndicator(), reference, dt=1e-4)
for k in range(2):
    command = controller.step(conf.q, 1e-4 * k)
print(command.dq[0])
"""


def run_python(code: str) -> str:
    """Return the standard output of a script."""
    words = [sys.executable, "-c", code]
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def measure_run(check: iiwa_dnn.CrossCheck) -> float:
    """Return the wall time of the paper's heart [s], 100,000 steps of 1e-4 s."""
    robot = paper_robot()
    heart = iiwa_dnn.Heart().anchored(iiwa_dnn.Configuration(robot, paper.START))
    scheme = iiwa_dnn.DoubleIndicator()
    began = time.perf_counter()
    iiwa_dnn.simulate(robot, scheme, heart, paper.START, dt=1e-4, duration=10.0, check=check)
    return time.perf_counter() - began


def measure_first_step() -> float:
    """Return the time from the start of a process to the end of its first steps [s]."""
    began = time.perf_counter()
    run_python(_FIRST_STEP)
    return time.perf_counter() - began


def measured() -> Iterator[dict[str, Any]]:
    """Measure one after the other."""
    timed = {
        "the heart, 100,000 steps, unchecked": lambda: measure_run(iiwa_dnn.CrossCheck(())),
        "the heart, every step checked by ProxQP": lambda: measure_run(iiwa_dnn.CrossCheck()),
        "`import iiwa_dnn`": lambda: float(run_python(_IMPORT)),
        "process start to first step": measure_first_step,
    }
    for name, measure in timed.items():
        seconds = np.median([measure() for _ in range(ROUNDS)])
        yield {"name": name, "value": f"{seconds:.2f} s"}


def report() -> None:
    """Print the table."""
    show(f"Whole runs, median of {ROUNDS}", {"": "{name}", "measured": "{value}"}, measured())
