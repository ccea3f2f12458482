"""Options of the benchmarks: one dataclass a command, its fields the options."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

from iiwa_dnn.app.options import Count, Folder, RunOptions, Time


@dataclass(frozen=True)
class BenchSettings(RunOptions):
    """Measure this package's solver beside DAQP, quadprog, PIQP, ProxQP and OSQP."""

    command: ClassVar[str] = "solvers"
    out: Folder = Path("runs/bench")  # folder that the results are written to
    steps: Count = 5000  # number of steps in a stream of programs
    cold: Count = 1000  # number of random programs of each size
    batch: Count = 100_000  # number of programs in the batch


@dataclass(frozen=True)
class BenchLoopSettings(RunOptions):
    """Measure the control loop beside its peers', whole runs, start-up and memory."""

    command: ClassVar[str] = "loop"
    out: Folder = Path("runs/bench_loop")  # folder that the results are written to
    steps: Count = 10_000  # number of steps beside the peers
    period: Time = 1e-3  # control period of these steps [s]
    placo_python: Path | None = None  # Python interpreter of an environment with PlaCo
    mink_python: Path | None = None  # Python interpreter with mink; by default this one
    drake_python: Path | None = None  # Python interpreter of an environment with Drake
    duration: Time = 10.0  # length of a whole run [s]
    dt: Time = 1e-4  # control period of a whole run [s]
    rounds: Count = 3  # number of repetitions of all that is not a step
