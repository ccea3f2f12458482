"""Exported controllers: C beside Python in closed loop, its size and its times."""

import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.report import show
from iiwa_dnn.compiling.build import run_compiler
from iiwa_dnn.export import c99, load
from iiwa_dnn.robot import Configuration
from tests.export_settings import SETTINGS, Made

FAST = ("-std=c99", "-O3", "-march=native")
SMALL = ("-std=c99", "-Os", "-fno-asynchronous-unwind-tables")
"""Without tables for unwinding the stack, which no function in C needs."""

ROUNDS = 5
"""Times that the steps are timed; the quietest round counts."""

_COLUMNS = {
    "controller": "{name}",
    "largest difference [of dq_max]": "{difference:.1e}",
    "actions differ": "{differing} of {steps}",
    "C median [µs]": "{median:.2f}",
    "p99": "{p99:.2f}",
    "p99.9": "{p999:.1f}",
    "Python median [µs]": "{python:.2f}",
    "text -Os [bytes]": "{text}",
    "struct [bytes]": "{size}",
}


def compare(made: Made, folder: Path, steps: int) -> dict[str, Any]:
    """Run a controller and its export side by side, each in its own closed loop.

    Returns:
        The largest ``difference`` of a command, in units of the velocity limits; the number of
        steps with ``differing`` actions; the median time of `Controller.step` in ``python`` [us].
    """
    controller, q0 = made
    exported = load(folder)
    controller.anchor(Configuration(controller.robot, q0))
    limits = np.where(controller.robot.dq_max < np.inf, controller.robot.dq_max, 1.0)
    dt = controller.dt
    ours = q0.copy()
    theirs = q0.copy()
    largest = 0.0
    differing = 0
    times = np.empty(steps)
    for k in range(steps):
        targets = controller.targets(k * dt - controller.delay)
        began = time.perf_counter()
        command = controller.step(ours, k * dt)
        times[k] = time.perf_counter() - began
        dq, action = exported.step(theirs, targets)
        largest = max(largest, float((np.abs(dq - command.dq) / limits).max()))
        differing += action != command.action
        ours = ours + dt * command.dq
        theirs = theirs + dt * dq
    return {"difference": largest, "differing": differing, "python": 1e6 * np.median(times)}


def compiled(folder: Path, output: Path, flags: Sequence[str], *sources: Path) -> Path:
    """Compile C files beside a controller's header."""
    run_compiler([*flags, f"-I{folder}"], sources, output)
    return output


def run(program: Path, *numbers: float) -> list[float]:
    """Return the numbers that a program prints."""
    words = [str(program), *map(repr, numbers)]
    said = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    return [float(word) for word in said.split()]


def text_size(folder: Path, place: Path) -> int:
    """Return the size of a controller's code [bytes], optimized for size."""
    file = compiled(folder, place / "controller.o", (*SMALL, "-c"), folder / "controller.c")
    said = subprocess.run(["size", file], check=True, capture_output=True, text=True).stdout
    return int(said.splitlines()[1].split()[0])


def compared(steps: int) -> Iterator[dict[str, Any]]:
    """Measure each controller in closed loop."""
    driver = Path(__file__).parent / "loops" / "exported_loop.c"
    for name, make in SETTINGS.items():
        with tempfile.TemporaryDirectory() as place:
            made = make()
            folder = c99(made[0], Path(place) / "c", made[1])
            row = {"name": name, "steps": steps, "size": load(folder).size}
            row["text"] = text_size(folder, Path(place))
            program = compiled(folder, Path(place) / "loop", FAST, driver, folder / "controller.c")
            quietest = min(run(program, steps, *made[1].tolist()) for _ in range(ROUNDS))
            row |= dict(zip(("median", "p99", "p999"), quietest, strict=True))
            yield row | compare(made, folder, steps)


def report(steps: int) -> None:
    """Print the table."""
    show(f"Controllers in C, {steps} steps beside Python's", _COLUMNS, compared(steps))
