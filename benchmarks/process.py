"""Time of a new process until its first step, and the memory of a short and a long run."""

import json
import subprocess
import sys
import time
from typing import Any

import numpy as np

_IMPORT = """
import time; began = time.perf_counter()
import iiwa_dnn
print(time.perf_counter() - began)
"""

_FIRST_STEP = """
import iiwa_dnn
from iiwa_dnn.studies import paper
robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
conf = iiwa_dnn.Configuration(robot, paper.START)
reference = iiwa_dnn.Heart().anchored(conf)
scheme = iiwa_dnn.DoubleIndicator().anchored(conf)
controller = iiwa_dnn.Controller(robot, scheme, reference, dt=1e-4)
for k in range(2):
    command = controller.step(conf.q, 1e-4 * k)
print(command.dq[0], flush=True)
"""

_RUN = """
import json, sys
from pathlib import Path
import iiwa_dnn
from iiwa_dnn.studies import paper
robot = iiwa_dnn.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)
conf = iiwa_dnn.Configuration(robot, paper.START)
reference = iiwa_dnn.Heart(period=1.0).anchored(conf)
def run(duration):
    scheme, check = iiwa_dnn.DoubleIndicator(), iiwa_dnn.CrossCheck(())
    return iiwa_dnn.simulate(
        robot, scheme, reference, paper.START, duration=duration, check=check
    )
run(0.01)  # loading compiled code takes more memory for a moment than it keeps
Path("/proc/self/clear_refs").write_text("5")  # forget the largest memory so far
record = run(float(sys.argv[1]))
status = Path("/proc/self/status").read_text().split()
peak = 1024 * int(status[status.index("VmHWM:") + 1])
size = sum(v.nbytes for v in vars(record).values() if hasattr(v, "nbytes"))
print(json.dumps([peak, size]))
"""


def measure_startup(rounds: int = 5) -> dict[str, float]:
    """Seconds to import the package, and from process start to the first step.

    The operating system has the files in its memory.
    """
    first = [_first_step() for _ in range(1 + rounds)]
    imports = [float(_python(_IMPORT)) for _ in range(rounds)]
    return {
        "import_s": float(np.median(imports)),
        "first_step_s": float(np.median(first[1:])),
    }


def measure_memory(duration: float = 2.0) -> dict[str, Any]:
    """Largest memory of a run and of one ten times as long, and the size of their records.

    As Linux counts it: resident, of the whole process.
    """
    (short, short_record), (long, long_record) = (
        json.loads(_python(_RUN, str(length))) for length in (duration, 10 * duration)
    )
    return {
        "peak_bytes": [short, long],
        "record_bytes": [short_record, long_record],
        "growth_over_record": (long - short) / (long_record - short_record),
    }


def _first_step() -> float:
    began = time.perf_counter()
    _python(_FIRST_STEP)
    return time.perf_counter() - began


def _python(code: str, *arguments: str) -> str:
    """Standard output of a script."""
    return subprocess.run(
        [sys.executable, "-c", code, *arguments],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
