"""What the benchmarks can be told: one dataclass a command, its fields the options."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from tyro.conf import arg

from iiwa_dnn.app.settings import Folder, Quiet, SettingsFile, Verbose


@dataclass(frozen=True)
class BenchSettings:
    """Measure this package's solver beside DAQP, quadprog, PIQP, ProxQP and OSQP, and write a
    report. Exit code 0: done; 2: bad input, or a package is missing.
    """  # noqa: D205

    settings: SettingsFile = None
    """take what is not given here from a TOML file"""
    steps: Annotated[int, arg(metavar="N")] = 5000
    """steps of a stream"""
    cold: Annotated[int, arg(metavar="N")] = 1000
    """random programs of each size"""
    batch: Annotated[int, arg(metavar="N")] = 100_000
    """size of the batch"""
    out: Folder = Path("runs/bench")
    """where to"""
    quiet: Quiet = False
    """no progress bar, no summary"""
    verbose: Verbose = False
    """tell what is written, and where an error is"""


@dataclass(frozen=True)
class BenchLoopSettings:
    """Measure the control loop beside Pink's, whole runs, start-up and memory, and write a report.
    Exit code 0: done; 2: bad input, or a package is missing.
    """  # noqa: D205

    settings: SettingsFile = None
    """take what is not given here from a TOML file"""
    steps: Annotated[int, arg(metavar="N")] = 20_000
    """steps beside Pink"""
    duration: Annotated[float, arg(metavar="S")] = 10.0
    """length of a whole run"""
    dt: Annotated[float, arg(metavar="S")] = 1e-4
    """control period"""
    rounds: Annotated[int, arg(metavar="N")] = 3
    """repetitions of what is not a step"""
    out: Folder = Path("runs/bench_loop")
    """where to"""
    quiet: Quiet = False
    """no progress bar"""
    verbose: Verbose = False
    """tell what is written, and where an error is"""
