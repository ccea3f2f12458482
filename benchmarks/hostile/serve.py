"""The side of a contender: ``serve(make)`` at the end of a file of its own.

``make(setup)`` returns ``filter(state, request, dt)``, which returns joint velocities (n,) [rad/s]
that are held for dt [s]. The file runs in any Python that has numpy.
"""

import json
import os
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

Filter = Callable[[dict[str, Any], dict[str, Any] | None, float], Any]
"""state: "q" measured (n,), "last" command (n,), "t" [s], "spheres" as they were seen (s, 3) [m],
at an "age" [s]; requests as in `benchmarks.hostile.families`; dt: its period [s]."""


def serve(make: Callable[[dict[str, Any]], Filter]) -> None:
    """Answer until standard input ends: a line that is a setup begins anew.

    A setup has the arm's data (``arm``), its limits as rows (``limits``: lower, upper, velocity,
    acceleration, jerk, torque), ``dt``, ``spheres`` with ``radii``, ``distance``, ``late`` [s],
    ``jitter``, ``payload`` [kg], ``person`` and a ``urdf`` as text.
    """
    answers = os.fdopen(os.dup(1), "w")  # libraries print to standard output
    os.dup2(2, 1)
    act: Filter | None = None
    for line in sys.stdin:
        told = json.loads(line)
        if act is None or "arm" in told:
            told["limits"] = np.array(told["limits"])
            act = make(told)
            print("{}", file=answers, flush=True)
            continue
        state = {name: np.array(value) for name, value in told["state"].items()}
        request = told["request"]
        if request is not None:
            request = {name: _array(value) for name, value in request.items()}
        began = time.perf_counter()
        dq = act(state, request, told["dt"])
        seconds = time.perf_counter() - began
        said = {"dq": np.asarray(dq, dtype=float).tolist(), "seconds": seconds}
        print(json.dumps(said), file=answers, flush=True)


def _array(value: Any) -> Any:
    if isinstance(value, list) and len(value) == 2 and isinstance(value[1][0], list):
        return np.array(value[0]), np.array(value[1])
    return np.array(value, dtype=float)


def velocity_of(request: dict[str, Any] | None, state: dict[str, Any], dt: float) -> Any:
    """Return the velocity that a request means, for filters that take no other: 0 for none."""
    if request is None:
        return np.zeros_like(state["q"])
    if "velocity" in request:
        return request["velocity"]
    return (request["position"] - state["q"]) / dt


def softly(
    request: dict[str, Any] | None, state: dict[str, Any], dt: float, acceleration: Any
) -> Any:
    """Return `velocity_of`, but no quicker towards a position than half the deceleration stops."""
    dq = velocity_of(request, state, dt)
    if request is None or "position" not in request:
        return dq
    left = np.abs(dt * dq)
    return np.clip(dq, -np.sqrt(acceleration * left), np.sqrt(acceleration * left))
