"""Whole runs, unchecked and checked; time of a new process until its first step; memory."""

import json
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

_MEMORY = """
import json, sys
from pathlib import Path
import iiwa_dnn
from iiwa_dnn.studies.runs import HeartRun
def run(duration):
    return HeartRun(mode="converged", orientation="so3", duration=duration).run()
run(0.01)  # loading takes more memory for a moment than it keeps
Path("/proc/self/clear_refs").write_text("5")  # forget the largest memory so far
record = run(float(sys.argv[1]))
status = Path("/proc/self/status").read_text().split()
peak = 1024 * int(status[status.index("VmHWM:") + 1])
size = sum(v.nbytes for v in vars(record).values() if hasattr(v, "nbytes"))
print(json.dumps([peak / 1e6, size / 1e6]))
"""


def run_python(code: str, *arguments: str) -> str:
    """Return the standard output of a script."""
    words = [sys.executable, "-c", code, *arguments]
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
    for length in (2.0, 20.0):
        peak, size = json.loads(run_python(_MEMORY, str(length)))
        name = f"largest memory of a run of {length:g} s at 1e-4 s"
        yield {"name": name, "value": f"{peak:.0f} MB, of which the record {size:.0f} MB"}


def report() -> None:
    """Print the table."""
    show(f"Whole runs, median of {ROUNDS}", {"": "{name}", "measured": "{value}"}, measured())
