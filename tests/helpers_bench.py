"""Loops of the benchmarks without processes, each of which takes seconds to import its libraries.

That of tests/benchmarks/test_arrivals.py is a process, as in the benchmarks.
"""

from __future__ import annotations

import runpy
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks import control
from benchmarks.control import Loop

LOOPS = Path(control.__file__).with_name("loops")


class Driver:
    """A stand-in of `control.Driver` that takes the steps in this process."""

    def __init__(self, loop: Loop, python: Path, task: Path) -> None:
        make = runpy.run_path(str(LOOPS / f"{loop.driver}.py"))["make"]
        with np.load(task) as file:
            self._step, self._posture = make(dict(file), loop.variant)

    def take(self, first: int, last: int) -> dict[str, Any]:
        """Take steps, as ``loops/serve.py`` does in a process."""
        times = []
        q = []
        for k in range(first, last):
            began = time.perf_counter_ns()
            self._step(k)
            times.append(1e-3 * (time.perf_counter_ns() - began))
            q.append(np.asarray(self._posture()).tolist())
        return {"us": times, "q": q}

    def close(self) -> None:
        """End nothing."""


@contextmanager
def loops_in_this_process() -> Iterator[pytest.MonkeyPatch]:
    """Let `measure_steps` start no process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(LOOPS))
        patch.setattr(control, "Driver", Driver)
        yield patch
