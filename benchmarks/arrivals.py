"""Arrivals of a shield at postures beside Ruckig's, with the same limits."""

from typing import Any

import numpy as np
import ruckig

import iiwa_dnn
from benchmarks.report import show
from iiwa_dnn.qp import Vector

GOALS = 20
ARRIVED = 1e-3
"""Postures to arrive at, and what every joint may lack of them [rad]."""


def arrival(path: list[Vector], goal: Vector, dt: float) -> float:
    """Return the time after which a path of positions, `dt` [s] apart, stays at its goal [s]."""
    away = np.flatnonzero(np.abs(np.array(path) - goal).max(axis=1) > ARRIVED)
    return dt * float(away[-1] + 1) if away.size else 0.0


def arrivals(name: str) -> dict[str, Any]:
    """Let an arm arrive at random postures, by the shield and by Ruckig; return a row.

    Both arrive by the same rule, `arrival`, from rest, at 1 ms and with the same limits. Without
    obstacles and in free space Ruckig's way is the quickest there is.
    """
    dt = 1e-3
    robot = iiwa_dnn.load_robot(name)
    jerk = np.where(np.isfinite(robot.dddq_max), robot.dddq_max, 500.0)
    robot = robot.with_limits(jerk=jerk)
    random = np.random.default_rng(0)
    ratios = []
    for _ in range(GOALS):
        start = robot.start_posture()
        lower = np.maximum(robot.q_lower, -3.0)
        upper = np.minimum(robot.q_upper, 3.0)
        goal = random.uniform(0.9 * lower + 0.1 * upper, 0.1 * lower + 0.9 * upper)
        given = ruckig.InputParameter(robot.dof)
        given.synchronization = ruckig.Synchronization.No
        given.current_position = start
        given.target_position = goal
        given.max_velocity = robot.dq_max
        given.max_acceleration = robot.ddq_max
        given.max_jerk = robot.dddq_max
        trajectory = ruckig.Trajectory(robot.dof)
        ruckig.Ruckig(robot.dof).calculate(given, trajectory)
        steps = int(trajectory.duration / dt) + 2
        best = [np.array(trajectory.at_time(k * dt)[0]) for k in range(steps)]
        shield = iiwa_dnn.Shield(robot, dt)
        path = [start]
        arrived = False
        while len(path) < 4 * steps and not arrived:
            command = shield.step(path[-1], position=goal)
            path.append(path[-1] + dt * command.dq)
            arrived = not command.dq.any()
        ratios.append(arrival(path, goal, dt) / arrival(best, goal, dt))
    return {"name": name, "least": min(ratios), "median": np.median(ratios), "most": max(ratios)}


def report() -> None:
    """Print the table."""
    columns = {"arm": "{name}", **{key: f"{{{key}:.3f}}" for key in ("least", "median", "most")}}
    rows = (arrivals(name) for name in ("iiwa7", "fr3", "panda"))
    show(f"Arrival at {GOALS} postures, in units of Ruckig's time", columns, rows)
