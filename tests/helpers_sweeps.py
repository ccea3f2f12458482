"""A task so small that a sweep of it is quick, and that says when it is computed."""

import os
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from iiwa_dnn.studies.sweeps import sweep

EARLY = 5  # cells that wait for no gate


def draw(cell: Mapping[str, Any]) -> dict[str, Any]:
    """The mean of some seeded numbers; leaves a line in the file that the cell names.

    A late cell waits for the file `gate`, where the settings name one.
    """
    with Path(cell["log"]).open("a", encoding="utf-8") as file:
        file.write(f"{cell['seed']} {os.environ.get('OMP_NUM_THREADS')} {os.getpid()}\n")
    time.sleep(cell.get("sleep", 0.0))
    while "gate" in cell and cell["seed"] >= EARLY and not Path(cell["gate"]).exists():
        time.sleep(0.01)
    return {"mean": float(np.random.default_rng(cell["seed"]).standard_normal(1000).mean())}


def cells(log: Path, count: int, **others: Any) -> list[dict[str, Any]]:
    """Settings of `draw`, one for each seed."""
    return [{"seed": seed, "log": str(log), **others} for seed in range(count)]


def main() -> None:
    """A sweep in a process of its own, so that a test can kill it."""
    folder, log, count, gate, workers = sys.argv[1:]
    settings = cells(Path(log), int(count), gate=gate)
    sweep(draw, settings, Path(folder), workers=int(workers), quiet=True)
