"""Arrivals at random poses, near and far, beside PlaCo, Pink and mink: how many, and when.

``python -m benchmarks arrivals`` prints a table. A pose is that of a random posture within the
joints' limits, so that it can be reached: near ones lie about the start, far ones anywhere. Every
loop begins each of them at the start posture, and has arrived once the tip stays within 1 mm and
0.01 rad of the pose until the time is over.
"""

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pinocchio as pin

import iiwa_dnn
from benchmarks.arms import write_urdf
from benchmarks.collisions import read_arguments
from benchmarks.control import LOOPS, Loop, measure_steps
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.results.markdown import markdown_table

ROBOTS = ("iiwa7", "panda")
HOLD = 10.0
"""Time for each pose [s]."""

DT = 1e-2
"""Control period [s]."""

NEAR = 0.3
"""Standard deviation of the joints of a near posture from the start [rad]."""

CLOSE = (1e-3, 1e-2)
"""Distance [m] and angle [rad] within which a pose counts as reached."""

OWN = (
    Loop("iiwa_dnn", "iiwa_dnn", "target_loop", "default"),
    Loop("iiwa_dnn, acceleration limits", "iiwa_dnn", "target_loop", "acceleration"),
)
_PEERS = ("PlaCo", "Pink, daqp, target one step ahead", "mink, daqp")


def draw_postures(robot: iiwa_dnn.Robot, count: int, seed: int) -> Matrix:
    """Draw postures, near and far in turn, (count, n) [rad]."""
    random = np.random.default_rng(seed)
    start = robot.start_posture()
    lower = np.maximum(robot.q_lower, -3.0)
    upper = np.minimum(robot.q_upper, 3.0)
    margin = 0.05 * (upper - lower)
    near = start + NEAR * random.standard_normal((count, robot.dof))
    far = random.uniform(lower, upper, (count, robot.dof))
    drawn = np.where(np.arange(count)[:, np.newaxis] % 2 == 0, near, far)
    postures: Matrix = np.clip(drawn, lower + margin, upper - margin)
    return postures


def measure_arrivals(
    robot: iiwa_dnn.Robot,
    postures: Matrix,
    hold: float,
    pythons: dict[str, Path | None],
    loops: Sequence[Loop],
) -> tuple[dict[str, Vector], list[str]]:
    """Let each loop go from the start to the pose of each posture.

    Args:
        robot: The robot.
        postures: Joint positions of the poses [rad], (count, n).
        hold: Time for each [s]; a multiple of 250 control periods.
        pythons: Python interpreter by module.
        loops: Loops that are compared.

    Returns:
        By loop, the time of each arrival [s], (count,), inf where there is none; and the modules
        that were not found.
    """
    steps = round(hold / DT)
    goals = [iiwa_dnn.Configuration(robot, q) for q in postures]
    poses = [pin.SE3(goal.rotation.copy(), goal.position.copy()).homogeneous for goal in goals]
    with tempfile.TemporaryDirectory() as folder:
        task = {
            "urdf": str(write_urdf(robot, Path(folder))),
            "tip": robot.tip,
            "names": robot.joint_names,
            "q0": robot.start_posture(),
            "lower": robot.q_lower,
            "upper": robot.q_upper,
            "velocity": robot.dq_max,
            "acceleration": robot.ddq_max,
            "poses": np.repeat(poses, steps + (np.arange(len(poses)) == 0), axis=0),
            "hold": steps,
            "soft": True,
        }
        rows, missing = measure_steps(steps * len(poses), DT, pythons, scene=task, loops=loops)
    times = {}
    for row in rows:
        q = np.array(row["q"]).reshape(len(poses), steps, -1)
        pairs = zip(q, goals, strict=True)
        times[row["name"]] = np.array([arrival(robot, path, goal) for path, goal in pairs])
    return times, missing


def arrival(robot: iiwa_dnn.Robot, path: Matrix, goal: iiwa_dnn.Configuration) -> float:
    """Return the time [s] from which joints at path (k, n) stay at a pose; inf if they do not."""
    for k in range(len(path) - 1, -1, -1):
        at = iiwa_dnn.Configuration(robot, path[k])
        off = float(np.linalg.norm(at.position - goal.position))
        turned = float(np.linalg.norm(pin.log3(at.rotation.T @ goal.rotation)))
        if off > CLOSE[0] or turned > CLOSE[1]:
            return np.inf if k == len(path) - 1 else DT * (k + 2)
    return DT


def summary(times: Vector) -> list[str]:
    """Summarize times of arrival, (count,) [s]: near and far arrivals, median and longest time."""
    arrived = np.isfinite(times)
    near = arrived[::2]
    far = arrived[1::2]
    cells = [f"{near.sum()} of {near.size}", f"{far.sum()} of {far.size}"]
    if not arrived.any():
        return [*cells, "", ""]
    return [*cells, f"{np.median(times[arrived]):.2f}", f"{times[arrived].max():.2f}"]


def bench_arrivals(arguments: Sequence[str] | None = None, prog: str = "arrivals") -> int:
    """Count arrivals and print a table; ``--steps`` is the number of poses; returns 0."""
    count, pythons = read_arguments(prog, bench_arrivals.__doc__, 60, arguments)
    loops = [*OWN, *(loop for loop in LOOPS if loop.name in _PEERS)]
    cells: list[list[str]] = []
    absent: set[str] = set()
    for name in ROBOTS:
        robot = iiwa_dnn.load_robot(name)
        postures = draw_postures(robot, count, 1)
        times, missing = measure_arrivals(robot, postures, HOLD, pythons, loops)
        absent.update(missing)
        best = max((np.isfinite(found).sum() for found in times.values()), default=0)
        for loop, found in times.items():
            arrived = np.isfinite(found)
            failed = " ".join(map(str, np.flatnonzero(~arrived)[:12]))
            cells.append([name, loop, f"{arrived.sum()} of {best}", *summary(found), failed])
    head = ["arm", "loop", "arrivals of the best", "near", "far", "median s", "longest s", "failed"]
    print(markdown_table(head, cells))
    if absent:
        print(f"not measured: {', '.join(sorted(absent))}")
    return 0
