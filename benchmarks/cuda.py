"""Shields of many arms on a GPU beside the same on all cores: bits, limits, distances, times."""

import importlib.util
import tempfile
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.report import show
from helpers_export import use_armstep
from hostile_arms import DT, ROBOT, START, compare, hostile_steps, make_shield
from iiwa_dnn.export import tables
from iiwa_dnn.export.cuda import cuda_code
from iiwa_dnn.qp import Matrix
from iiwa_dnn.schemes.collisions import avoidance_of
from judge_distances import Judge
from judge_limits import breaches

ARMS = (256, 1024, 4096, 16_384, 65_536)
STEPS = 100
"""Steps that are timed."""

EQUAL = (4096, 1000)
"""Arms and steps whose bits are compared."""

JUDGED = 16
"""Arms whose distances are judged."""

_COLUMNS = {
    "arms": "{arms}",
    "watched": "{watched}",
    "GPU [ms a step]": "{gpu:.3f}",
    "p99": "{p99:.3f}",
    "[µs an arm]": "{gpu_arm:.3f}",
    "alike [ms a step]": "{alike:.3f}",
    "all cores [ms a step]": "{cpu:.3f}",
    "[µs an arm] ": "{cpu_arm:.3f}",
}


def missing() -> str:
    """Say what a GPU's run lacks on this machine; nothing if it lacks nothing."""
    if not importlib.util.find_spec("cupy"):
        return "cupy is missing: pip install cupy-cuda13x nvidia-cuda-nvrtc"
    import cupy

    try:
        cupy.cuda.runtime.getDeviceCount()
    except RuntimeError as error:
        return str(error)
    return ""


def timed(package: Any, count: int, alike: bool) -> Iterator[tuple[float, float]]:
    """Time hostile steps on the GPU and on all cores [ms]; `alike`: all arms do the same."""
    import cupy

    cpu, gpu = package(count), package(count, device="cuda")
    start, end = cupy.cuda.Event(), cupy.cuda.Event()
    q = np.tile(START, (count, 1))
    for own in hostile_steps(q, STEPS, 1):
        if alike:
            own = {name: np.repeat(each[:1], count, axis=0) for name, each in own.items()}
        there = {name: cupy.asarray(each) for name, each in own.items()}
        start.record()
        found = gpu.step(**there)
        end.record()
        end.synchronize()
        began = time.perf_counter()
        expected = cpu.step(**own)
        yield cupy.cuda.get_elapsed_time(start, end), 1e3 * (time.perf_counter() - began)
        q[:] = expected.next_q
        assert found.dq.get().tobytes() == expected.dq.tobytes()


def compared(packages: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Return rows of the table; the first step, which loads the kernels, does not count."""
    for watched, package in packages.items():
        for count in ARMS:
            gpu, cpu = np.array([*timed(package, count, False)])[1:].T
            alike = np.median(np.array([*timed(package, count, True)])[1:, 0])
            row = {"arms": count, "watched": watched, "alike": alike, "p99": np.percentile(gpu, 99)}
            row |= {"gpu": np.median(gpu), "cpu": np.median(cpu)}
            yield row | {f"{name}_arm": 1e3 * row[name] / count for name in ("gpu", "cpu")}


def judge(path: Matrix) -> str:
    """Count arms that break a limit, and some that come too near, on paths (k, N, n) [rad]."""
    limits = (ROBOT.q_lower, ROBOT.q_upper, ROBOT.dq_max, ROBOT.ddq_max, ROBOT.dddq_max)
    broken = sum(bool(breaches(path[:, i], DT, *limits)) for i in range(path.shape[1]))
    avoidance = avoidance_of(make_shield())
    assert avoidance
    scene = Judge(ROBOT, avoidance)
    near = sum(scene.verdict(path[:, i], DT).broken > 0 for i in range(JUDGED))
    return f"limits broken by {broken} of {path.shape[1]} arms, distances by {near} of {JUDGED}"


def report() -> None:
    """Print what is equal, what the judges say, and the table; or what a run lacks."""
    if lacks := missing():
        print(f"no GPU to run on: {lacks}")
        return
    import cupy

    packages = {}
    with tempfile.TemporaryDirectory() as folder:
        armstep = use_armstep()
        source = Path(armstep.__file__).with_name("shields.cu")
        source.write_text(cuda_code(), encoding="utf-8")
        for watched in (True, False):
            name = "watching" if watched else "unwatching"
            path = tables(make_shield(watched), Path(folder) / f"{name}.json")
            packages[name] = partial(armstep.Shields, path)
        first = packages["watching"]
        count, steps = EQUAL
        began = time.perf_counter()
        gpu = first(count, device="cuda")
        about = cupy.cuda.runtime.getDeviceProperties(0)
        print(f"{about['name'].decode()}, kernels in {time.perf_counter() - began:.0f} s")
        both = first(count), gpu
        differing, path = compare(*both, steps, cupy.asarray, cupy.asnumpy)
        print(f"{count} arms, {steps} hostile steps: {differing} commands differ; {judge(path)}")
        rows = compared({"a ball, itself": first, "nothing": packages["unwatching"]})
        show(f"Shields of many arms, {STEPS} hostile steps", _COLUMNS, rows)
