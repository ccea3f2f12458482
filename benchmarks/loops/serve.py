"""The side of a driver: steps on demand, their times and the joint positions as JSON.

A driver runs in the Python of its library and imports nothing but numpy and that library. It is
started with the path of a task file and the name of a variant, reads lines ``first last`` and
answers each with one line.
"""

import json
import os
import sys
import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

Task = Mapping[str, Any]
"""urdf, tip, names, q0, lower, upper, velocity, dt, and poses (steps + 1, 4, 4), dt apart; with
balls also links, a, b, radii, balls, ball_radii and distance, see `benchmarks.loop.make_scene`."""

Loop = tuple[Callable[[int], object], Callable[[], Any]]
"""``step(k)``, which is timed, and ``posture()``, the joint positions (n,) [rad] after it."""


def serve(make: Callable[[Task, str], Loop]) -> None:
    """Answer until standard input ends; the first steps of a loop of their own warm up."""
    # Libraries print to standard output; the answers go where it led.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    with np.load(sys.argv[1]) as file:
        task = {name: file[name] for name in file.files}
    step, posture = make(task, sys.argv[2])
    for k in range(20):
        step(k)
        posture()
    step, posture = make(task, sys.argv[2])
    for line in sys.stdin:
        first, last = map(int, line.split())
        times = []
        q = []
        for k in range(first, last):
            began = time.perf_counter_ns()
            step(k)
            times.append(1e-3 * (time.perf_counter_ns() - began))
            q.append(np.asarray(posture()).tolist())
        print(json.dumps({"us": times, "q": q}), file=answers, flush=True)
