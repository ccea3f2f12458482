"""A task so small that a sweep of it is quick, and that says when it is computed."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from helpers_records import make_record
from iiwa_dnn.studies.sweeps import Outcome, Sweep


def draw(settings: Mapping[str, Any]) -> Outcome:
    """The mean of some seeded numbers; leaves a line in the file that the settings name."""
    with Path(settings["log"]).open("a", encoding="utf-8") as file:
        file.write(f"{settings['seed']} {os.environ.get('OMP_NUM_THREADS')}\n")
    time.sleep(settings.get("sleep", 0.0))
    samples = np.random.default_rng(settings["seed"]).standard_normal(1000)
    record = make_record(q=np.full((11, 7), samples[0])) if settings.get("keep") else None
    return Outcome({"mean": samples.mean(), "none": np.nan}, record)


def cells(log: Path, count: int, **others: Any) -> list[dict[str, Any]]:
    """Settings of `draw`, one for each seed."""
    return [{"seed": seed, "log": str(log), **others} for seed in range(count)]


def main() -> None:
    """A sweep in a process of its own, so that a test can kill it."""
    folder, log, count, sleep, workers = sys.argv[1:]
    Sweep(draw, Path(folder)).run(
        cells(Path(log), int(count), sleep=float(sleep)), workers=int(workers), quiet=True
    )
