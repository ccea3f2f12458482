"""Contenders in processes of their own, and a run of one of them."""

import json
import select
import subprocess
import sys
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.hostile.arms import Arm, urdf
from benchmarks.hostile.families import FRAME, WALK, Family, smooth
from benchmarks.hostile.judges import DISTANCE, Run

ADAPTERS = Path(__file__).with_name("adapters")
ROOT = Path(__file__).parents[2]
RADIUS = 0.08
"""Radius of a sphere [m]."""

PERSON = 0.1
"""Radius of a person's hand [m]."""

PATIENCE = 60.0
"""Time after which there is no answer any more [s]: libraries compile at their first step."""


class Contender:
    """A filter that runs in its own process.

    Raises:
        RuntimeError: It ended; the text is the end of what it wrote on standard error. Or it does
            not answer.
    """

    def __init__(self, file: Path, python: str = sys.executable) -> None:
        """Start it: a file that ends with ``serve(make)``, and the Python that has its library."""
        self._process = subprocess.Popen(
            [python, str(file)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            cwd=ROOT,
            env={"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin", "OPENBLAS_NUM_THREADS": "1"},
        )

    def tell(self, words: dict[str, Any]) -> dict[str, Any]:
        """Tell it something, and return its answer."""
        assert self._process.stdin
        assert self._process.stdout
        try:
            self._process.stdin.write(json.dumps(words) + "\n")
            self._process.stdin.flush()
            if not select.select([self._process.stdout], [], [], PATIENCE)[0]:
                self._process.kill()
                raise RuntimeError(f"no answer in {PATIENCE:g} s")
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            assert self._process.stderr
            raise RuntimeError(self._process.stderr.read()[-400:] or "it ended without an answer")
        answer: dict[str, Any] = json.loads(line)
        return answer

    def close(self) -> None:
        """End it."""
        self._process.kill()
        self._process.communicate()


def setup_of(arm: Arm, dt: float, centers: Any, radii: Any, **about: Any) -> dict[str, Any]:
    """Return what a contender is told at first (`benchmarks.hostile.serve`)."""
    told: dict[str, Any] = {"arm": arm.data, "urdf": urdf(arm.data), "limits": arm.limits.tolist()}
    told |= {"dt": dt, "spheres": centers.tolist(), "radii": radii.tolist(), "distance": DISTANCE}
    return told | {"person": False, "late": 0.0, "jitter": 0.0, "payload": 0.0} | about


def drive(
    contender: Contender, arm: Arm, family: Family, seed: int, steps: int, dt: float = 2e-3
) -> Run:
    """Drive an arm by a family's requests through a contender."""
    random = np.random.default_rng([seed, 7])
    requests = family.requests(arm, np.random.default_rng(seed), dt)
    spheres = _spheres(arm, random, family.spheres)
    person = arm.tip(arm.start[np.newaxis])[0] + np.array([0.0, 1.2, 0.0])
    centers = person[np.newaxis] if family.person else spheres
    radii = np.full(len(centers), PERSON if family.person else RADIUS)
    about = {"late": family.late * dt, "jitter": family.jitter, "person": family.person}
    payload = arm.data["payload"] * family.payload
    contender.tell(setup_of(arm, dt, centers, radii, payload=payload, **about))
    q = arm.start.copy()
    last = np.zeros(arm.dof)
    waiting = [last] * family.late
    t = 0.0
    at = smooth(arm, np.random.default_rng(seed)) if family.admissible else None
    rows: dict[str, list[Any]] = {name: [] for name in ("dq", "wanted", "periods", "seconds")}
    path, desired, seen = [q], [at(0.0) if at else arm.start], [centers]
    frame, taken = centers, 0.0
    problem = ""
    for request in islice(requests, steps):
        period = dt * (1.0 + family.jitter * random.uniform(-1.0, 1.0))
        if int(t / FRAME) != int((t - period) / FRAME):  # a camera's frame of the person
            frame, taken = centers, t
        state = {"q": q, "last": last, "t": t, "spheres": frame, "age": t - taken}
        told = {
            "state": {name: np.asarray(value).tolist() for name, value in state.items()},
            "request": request and {name: _listed(value) for name, value in request.items()},
            "dt": period,
        }
        try:
            answer = contender.tell(told)
        except RuntimeError as error:
            problem = str(error)
            break
        last = np.array(answer["dq"], dtype=float)
        if last.shape != q.shape or not np.isfinite(last).all():
            problem = f"{answer['dq']} is no velocity of {arm.dof} joints"
            break
        waiting.append(last)
        carried = waiting.pop(0)
        rows["wanted"].append(_wanted(request, q, period, arm))
        rows["dq"].append(carried)
        rows["periods"].append(period)
        rows["seconds"].append(answer["seconds"])
        q = q + period * carried
        t += period
        if family.person:
            centers = _pursue(arm, q, centers, period)
        path.append(q)
        seen.append(centers)
        desired.append(at(t) if at else arm.start)
    return Run(
        np.array(path),
        np.array(rows["dq"]),
        np.array(rows["wanted"]),
        np.array(desired if at else []),
        np.array(rows["periods"]),
        np.array(seen),
        radii,
        np.array(rows["seconds"]),
        problem,
    )


def _listed(value: Any) -> Any:
    return [each.tolist() for each in value] if isinstance(value, tuple) else value.tolist()


def _wanted(request: dict[str, Any] | None, q: Any, period: float, arm: Arm) -> Any:
    """Return the velocity that is asked for, within its limits; NaN where none is."""
    if request is None:
        return np.full(arm.dof, np.nan)
    dq = request["velocity"] if "velocity" in request else (request["position"] - q) / period
    return np.clip(dq, -arm.limits[2], arm.limits[2])


def _spheres(arm: Arm, random: np.random.Generator, count: int) -> Any:
    """Draw spheres that are 6 cm or more from the arm in its start posture, (count, 3) [m]."""
    tip = arm.tip(arm.start[np.newaxis])[0]
    found: list[Any] = []
    while len(found) < count:
        center = tip + random.normal(scale=0.25, size=3)
        gap = arm.distances(arm.start[np.newaxis], center[None, None], np.array([RADIUS])).min()
        found += [center] * (gap > 0.06)
    return np.array(found).reshape(count, 3)


def _pursue(arm: Arm, q: Any, centers: Any, period: float) -> Any:
    """Move the person towards the tip, at `WALK` at most."""
    way = arm.tip(q[np.newaxis])[0] - centers[0]
    length = np.linalg.norm(way)
    return centers + min(1.0, WALK * period / max(length, 1e-9)) * way
