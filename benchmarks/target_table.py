"""Six kinds of targets beside Pink and mink: tracking error, largest jerk, frozen steps, times."""

import json
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.control import Loop, take_turns
from benchmarks.report import tabulate
from benchmarks.targets import STREAMS
from iiwa_dnn.robot import Configuration, load_robot

JERK = 500.0
"""Jerk limit of this package's loop [rad/s^3]."""

LOOPS = (
    Loop("iiwa_dnn, filter and jerk limit", "iiwa_dnn", "target_loop", "filtered"),
    Loop("iiwa_dnn, jerk limit", "iiwa_dnn", "target_loop", "raw"),
    Loop("Pink, AccelerationLimit", "pink", "pink_loop", "daqp, ahead, acceleration"),
    Loop("mink", "mink", "mink_loop", "daqp"),
)


_COLUMNS = {
    "target": "{kind}",
    "loop": "{loop}",
    "error, median [m]": "{median_error_m:.1e}",
    "largest jerk [rad/s^3]": "{largest_jerk:.4g}",
    "acceleration / limit": "{acceleration_share:.3g}",
    "frozen": "{frozen:.1f} %",
    "p50 [us]": "{p50_us:.0f}",
    "p99 [us]": "{p99_us:.0f}",
    "": "{problem}",
}


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
    q0 = robot.start_posture()
    rows = []
    data = robot.model.createData()
    for kind, stream in STREAMS.items():
        rng = np.random.default_rng(11)
        poses = np.tile(np.eye(4), (steps + 1, 1, 1))
        for pose, (place, turn) in zip(poses, stream(robot, rng, steps + 1, dt), strict=True):
            pose[:3, :3] = turn
            pose[:3, 3] = place
        with tempfile.TemporaryDirectory() as folder:
            task = Path(folder) / "task.npz"
            np.savez(
                task,
                urdf=str(robot.path),
                tip=robot.tip,
                names=robot.joint_names,
                dt=dt,
                q0=q0,
                lower=robot.q_lower,
                upper=robot.q_upper,
                velocity=robot.dq_max,
                acceleration=robot.ddq_max,
                jerk=JERK,
                poses=poses,
            )
            here = Path(sys.executable)
            loops = {loop: mink_python or here if loop.module == "mink" else here for loop in LOOPS}
            taken = take_turns(loops, task, steps, progress, tolerant=True)
        for loop, each in taken.items():
            row: dict[str, Any] = {"kind": kind, "loop": loop.name, "problem": each.problem}
            if len(each.q) > 3:
                path = np.vstack([q0, each.q])
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
                    "p50_us": float(np.median(each.us)),
                    "p99_us": float(np.percentile(each.us, 99.0)),
                }
            rows.append(row)
    return rows


def markdown(rows: list[dict[str, Any]], dt: float) -> str:
    """Return the table, with the conditions that it holds under."""
    about = (
        f"iiwa 7 at {1e3 * dt:g} ms, accelerations of Drake's model; the jerk limit of this "
        f"package's rows is {JERK:g} rad/s^3, mink has limits on velocity alone. The error is the "
        "tip's distance from the raw target; a step is frozen where no joint moves by 1e-4 rad/s "
        "and the target is 1 mm away or more, which an arm at the edge of its reach has to be."
    )
    unknown = dict.fromkeys(
        ("median_error_m", "largest_jerk", "acceleration_share", "frozen", "p50_us", "p99_us")
    )
    shares = ({"frozen": 100 * row["frozen_share"]} if "p50_us" in row else {} for row in rows)
    filled = [unknown | row | share for row, share in zip(rows, shares, strict=True)]
    return "\n\n".join(["# Six kinds of targets", about, tabulate(_COLUMNS, filled)]) + "\n"


def save(rows: list[dict[str, Any]], dt: float, folder: Path) -> Path:
    """Write results.json and report.md into a folder; returns the report's path."""
    (folder / "results.json").write_text(json.dumps(rows, indent=1), encoding="utf-8")
    report = folder / "report.md"
    report.write_text(markdown(rows, dt), encoding="utf-8")
    return report
