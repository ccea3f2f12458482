"""Exported controllers: their times in closed loop, and their sizes."""

import re
import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from benchmarks.kinds import cases
from benchmarks.report import show
from iiwa_dnn import Controller
from iiwa_dnn.compiling.build import run_compiler
from iiwa_dnn.export import c99
from iiwa_dnn.studies import paper

FAST = ("-std=c99", "-O2")
SMALL = ("-std=c99", "-Os", "-fno-asynchronous-unwind-tables")
"""Without tables for unwinding the stack, which no function in C needs."""

NAMES = (
    "the heart",
    "a limit active",
    "acceleration and jerk limits",
    "21 pairs of collisions",
    "no solution, `slow`",
)
"""Kinds of steps (`benchmarks.kinds`) whose controllers are exported."""

ROUNDS = 5
"""Times that the steps are timed; the quietest round counts."""

_COLUMNS = {
    "controller": "{name}",
    "C median [µs]": "{median:.2f}",
    "p99": "{p99:.2f}",
    "p99.9": "{p999:.1f}",
    "text -Os [bytes]": "{text}",
    "memory [bytes]": "{size}",
}


def run(program: Path, *numbers: float) -> list[float]:
    """Return the numbers that a program prints."""
    words = [str(program), *map(repr, numbers)]
    said = subprocess.run(words, check=True, capture_output=True, text=True).stdout
    return [float(word) for word in said.split()]


def text_size(folder: Path, build: Path) -> int:
    """Return the size of a controller's code [bytes], optimized for size."""
    file = build / "armstep.o"
    run_compiler([*SMALL, "-c"], [folder / "armstep.c"], file)
    said = subprocess.run(["size", file], check=True, capture_output=True, text=True).stdout
    return int(said.splitlines()[1].split()[0])


def memory_of(folder: Path) -> int:
    """Return the size of a controller's memory [bytes]."""
    found = re.search(r"_MEMORY = (\d+)", (folder / "arm.h").read_text(encoding="utf-8"))
    assert found
    return 8 * int(found[1])


def compared(steps: int) -> Iterator[dict[str, Any]]:
    """Measure each controller in closed loop."""
    driver = Path(__file__).parent / "loops" / "exported_loop.c"
    for name in NAMES:
        case = cases()[name]
        controller = Controller(case.robot, case.scheme, case.reference, policy=case.policy)
        with tempfile.TemporaryDirectory() as build:
            folder = c99(controller, Path(build) / "c", paper.START, name="arm")
            row = {"name": name, "size": memory_of(folder)}
            row["text"] = text_size(folder, Path(build))
            program = Path(build) / "loop"
            run_compiler(
                [*FAST, f"-I{folder}"], [driver, folder / "armstep.c", folder / "arm.c"], program
            )
            quietest = min(run(program, steps, *paper.START) for _ in range(ROUNDS))
            yield row | dict(zip(("median", "p99", "p999"), quietest, strict=True))


def report(steps: int) -> None:
    """Print the table."""
    show(f"Controllers in C, {steps} steps", _COLUMNS, compared(steps))
