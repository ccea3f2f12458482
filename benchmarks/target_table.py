"""Six kinds of targets beside Pink and mink: tracking error, largest jerk, frozen steps, times."""

import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.control import CHUNK, Driver, Loop
from benchmarks.targets import STREAMS
from iiwa_dnn.errors import IiwaDnnError
from iiwa_dnn.robot import Configuration, load_robot
from iiwa_dnn.robot.robot import file_of

JERK = 500.0
"""Jerk limit of this package's loop [rad/s^3]."""

LOOPS = (
    Loop("iiwa_dnn, filter and jerk limit", "iiwa_dnn", "target_loop", "filtered"),
    Loop("iiwa_dnn, jerk limit", "iiwa_dnn", "target_loop", "raw"),
    Loop("Pink, AccelerationLimit", "pink", "pink_loop", "daqp, ahead, acceleration"),
    Loop("mink", "mink", "mink_loop", "daqp"),
)


def measure_targets(
    steps: int, dt: float, mink_python: Path | None, progress: Callable[[int], object]
) -> list[dict[str, Any]]:
    """Let each loop follow each kind of target, in turns, each in a process of its own.

    Args:
        steps: Control steps of each.
        dt: Control period [s].
        mink_python: Python interpreter of an environment with mink; None: this one.
        progress: Called with the number of steps done since the last call.

    Returns:
        A row for each kind and loop. A loop that ends with an error has the error in its row.
    """
    robot = load_robot("iiwa7")
    q0, rows, data = robot.start_posture(), [], robot.model.createData()
    for kind, stream in STREAMS.items():
        rng, poses = np.random.default_rng(11), np.tile(np.eye(4), (steps + 1, 1, 1))
        for pose, (place, turn) in zip(poses, stream(robot, rng, steps + 1, dt), strict=True):
            pose[:3, :3], pose[:3, 3] = turn, place
        with tempfile.TemporaryDirectory() as folder:
            task = Path(folder) / "task.npz"
            np.savez(
                task, urdf=str(file_of(robot)), tip=robot.tip, names=robot.joint_names, dt=dt,
                q0=q0, lower=robot.q_lower, upper=robot.q_upper, velocity=robot.dq_max,
                acceleration=robot.ddq_max, jerk=JERK, poses=poses,
            )  # fmt: skip
            taken = _take_turns(task, steps, mink_python, progress)
        for loop, (us, q, problem) in taken.items():
            row: dict[str, Any] = {"kind": kind, "loop": loop.name, "problem": problem}
            if len(q) > 3:
                path = np.vstack([q0, q])
                tips = np.array([Configuration(robot, at, data).position for at in path[1:]])
                error = np.linalg.norm(tips - poses[1 : len(path), :3, 3], axis=1)
                speed = np.abs(np.diff(path, axis=0)).max(axis=1) / dt
                third = np.diff(np.vstack([q0, q0, q0, path]), 3, axis=0) / dt**3
                second = np.diff(np.vstack([q0, q0, path]), 2, axis=0) / dt**2
                row |= {
                    "median_error_m": float(np.median(error)),
                    "largest_jerk": float(np.abs(third).max()),
                    "acceleration_share": float((np.abs(second) / robot.ddq_max).max()),
                    "frozen_share": float(np.mean((speed < 1e-4) & (error > 1e-3))),
                    "p50_us": float(np.median(us)),
                    "p99_us": float(np.percentile(us, 99.0)),
                }
            rows.append(row)
    return rows


def _take_turns(
    task: Path, steps: int, mink_python: Path | None, progress: Callable[[int], object]
) -> dict[Loop, tuple[list[float], list[list[float]], str]]:
    """Times, joint positions and the error that ended it, of each loop."""
    taken: dict[Loop, tuple[list[float], list[list[float]], str]] = {}
    drivers: dict[Loop, Driver] = {}
    try:
        for loop in LOOPS:
            python = mink_python if loop.module == "mink" and mink_python else Path(sys.executable)
            drivers[loop], taken[loop] = Driver(loop, python, task), ([], [], "")
        for first in range(0, steps, CHUNK):
            last = min(first + CHUNK, steps)
            for loop, driver in drivers.items():
                us, q, problem = taken[loop]
                if problem:
                    continue
                try:
                    answer = driver.take(first, last)
                    us += answer["us"]
                    q += answer["q"]
                except IiwaDnnError as error:
                    taken[loop] = us, q, str(error)
            progress(last - first)
    finally:
        for driver in drivers.values():
            driver.close()
    return taken


def markdown(rows: list[dict[str, Any]], dt: float) -> str:
    """Return the table, with the conditions that it holds under."""
    lines = [
        "# Six kinds of targets",
        "",
        f"iiwa 7 at {1e3 * dt:g} ms, accelerations of Drake's model; the jerk limit of this "
        f"package's rows is {JERK:g} rad/s^3, mink has limits on velocity alone. The error is the "
        "tip's distance from the raw target; a step is frozen where no joint moves by 1e-4 rad/s "
        "and the target is 1 mm away or more, which an arm at the edge of its reach has to be.",
        "",
        "| target | loop | error, median [m] | largest jerk [rad/s^3] | acceleration / limit "
        "| frozen | p50 [us] | p99 [us] | |",
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- |",
    ]
    for row in rows:
        if "p50_us" not in row:
            lines.append(f"| {row['kind']} | {row['loop']} | | | | | | | {row['problem']} |")
            continue
        lines.append(
            f"| {row['kind']} | {row['loop']} | {row['median_error_m']:.1e} "
            f"| {row['largest_jerk']:.4g} | {row['acceleration_share']:.3g} "
            f"| {100 * row['frozen_share']:.1f} % | {row['p50_us']:.0f} | {row['p99_us']:.0f} "
            f"| {row['problem']} |"
        )
    return "\n".join([*lines, ""])


def save(rows: list[dict[str, Any]], dt: float, folder: Path) -> Path:
    """Write results.json and report.md into a folder; returns the report's path."""
    (folder / "results.json").write_text(json.dumps(rows, indent=1), encoding="utf-8")
    report = folder / "report.md"
    report.write_text(markdown(rows, dt), encoding="utf-8")
    return report
