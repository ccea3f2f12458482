"""Exported controllers: C's commands beside Python's, and the time, size and memory of a step.

``python -m benchmarks export`` prints the table of docs/export.md: every kind of controller in
closed loop, C and Python side by side from the same start.
"""

import argparse
import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from benchmarks.control import LOOPS, measure_steps
from benchmarks.report import environment, made_on, tabulate
from iiwa_dnn.export import c99, load
from iiwa_dnn.export.load import find_compiler
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
    "C median [us]": "{median:.2f}",
    "p99": "{p99:.2f}",
    "p99.9": "{p999:.1f}",
    "Python median [us]": "{python:.2f}",
    "text -Os [bytes]": "{text}",
    "struct [bytes]": "{size}",
}


class Closeness(NamedTuple):
    """Comparison of a run in C with one in Python.

    Attributes:
        difference: Largest difference of a command, in units of the velocity limits.
        differing: Number of steps with another action.
        python: Median time of `Controller.step` [us].
    """

    difference: float
    differing: int
    python: float


def compare(made: Made, folder: Path, steps: int) -> Closeness:
    """Run a controller and its export side by side, each in its own closed loop."""
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
    return Closeness(largest, differing, 1e6 * float(np.median(times)))


def compiled(folder: Path, output: Path, flags: Sequence[str], *sources: Path) -> Path:
    """Compile C files beside a controller's header."""
    words = [find_compiler(), *flags, f"-I{folder}", "-o", output, *sources, "-lm"]
    subprocess.run(words, check=True)
    return output


def text_size(folder: Path, place: Path) -> int:
    """Return the size of a controller's code [bytes], optimized for size."""
    file = compiled(folder, place / "controller.o", (*SMALL, "-c"), folder / "controller.c")
    said = subprocess.run(["size", file], check=True, capture_output=True, text=True).stdout
    return int(said.splitlines()[1].split()[0])


def step_times(folder: Path, place: Path, q0: Any, steps: int) -> dict[str, float]:
    """Measure the steps of a controller; the quietest of a few rounds, times in [us]."""
    driver = Path(__file__).parent / "loops" / "exported_loop.c"
    program = compiled(folder, place / "loop", FAST, driver, folder / "controller.c")
    words = [str(program), str(steps), *map(repr, q0.tolist())]
    rounds = []
    for _ in range(ROUNDS):
        said = subprocess.run(words, check=True, capture_output=True, text=True).stdout
        rounds.append([float(word) for word in said.split()])
    names = ("median", "p99", "p999", "longest", "idle", "idle_p99", "idle_p999", "idle_longest")
    return dict(zip(names, min(rounds), strict=True))


def bench_export(arguments: Sequence[str] | None = None, prog: str = "export") -> int:
    """Measure and print the tables; returns 0."""
    parser = argparse.ArgumentParser(prog, description=bench_export.__doc__)
    parser.add_argument("--steps", type=int, default=100_000, help="steps of each comparison")
    parser.add_argument("--timed", type=int, default=10_000, help="steps of each round of times")
    parser.add_argument("--only", nargs="*", default=list(SETTINGS), help="names of controllers")
    parser.add_argument("--placo-python", type=Path, dest="placo", help="interpreter with PlaCo")
    options = parser.parse_args(arguments)
    print(made_on(environment()), "\n")
    print(tabulate(_COLUMNS, []), flush=True)
    rows = []
    for name in options.only:
        with tempfile.TemporaryDirectory() as place:
            made = SETTINGS[name]()
            folder = c99(made[0], Path(place) / "c", made[1], verify=False)
            times = step_times(folder, Path(place), made[1], options.timed)
            size = load(folder).size
            text = text_size(folder, Path(place))
            row = {"name": name, "steps": options.steps, "size": size, "text": text, **times}
            rows.append(row | compare(made, folder, options.steps)._asdict())
            print(tabulate(_COLUMNS, rows[-1:]).splitlines()[-1], flush=True)
    first = rows[0]
    print(
        f"\nThe tail of {first['name']}: longest step {first['longest']:.1f} us. Two readings of "
        f"the clock with nothing in between: median {first['idle']:.3f}, "
        f"p99.9 {first['idle_p999']:.2f}, longest {first['idle_longest']:.1f} us."
    )
    if options.placo is not None:
        loops = [loop for loop in LOOPS if loop.name in ("iiwa_dnn, with q + dt dq", "PlaCo")]
        peers, _ = measure_steps(options.timed, 1e-3, {"placo": options.placo}, loops=loops)
        for peer in peers:
            print(f"the heart with {peer['name']}: median {peer['median_us']:.2f} us")
    return 0
