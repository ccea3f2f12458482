"""The shield beside a clamp and beside Ruckig, on the same hostile wishes (tests/hostile.py)."""

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import ruckig

import hostile
import iiwa_dnn
from benchmarks.report import show
from iiwa_dnn.qp import Vector
from judge_distances import Judge
from judge_limits import breaches

RUNS = 40
STEPS = 2000
"""Runs, each of so many steps at most, among obstacles that stand still."""

Step = Callable[[Vector, Vector, dict[str, Any]], Vector]
"""Returns the command at joint positions q, for a velocity wished for, or the wish itself."""


def shield(case: hostile.Case) -> Step:
    """Return the step of a shield."""
    made = iiwa_dnn.Shield(case.robot, case.dt, case.avoidance.obstacles, hostile.DISTANCE)
    return lambda q, dq, wish: made.step(q, **wish).dq


def clamp(case: hostile.Case) -> Step:
    """Return a clamp of the velocities, and of the next positions, to their limits."""
    robot = case.robot

    def step(q: Vector, dq: Vector, wish: dict[str, Any]) -> Vector:
        goal = q + case.dt * np.clip(dq, -robot.dq_max, robot.dq_max)
        taken: Vector = (np.clip(goal, robot.q_lower, robot.q_upper) - q) / case.dt
        return taken

    return step


def with_ruckig(case: hostile.Case) -> Step:
    """Return Ruckig's way to a velocity; its free edition knows no range of positions for it."""
    robot = case.robot
    otg = ruckig.Ruckig(robot.dof, case.dt)
    given = ruckig.InputParameter(robot.dof)
    found = ruckig.OutputParameter(robot.dof)
    given.control_interface = ruckig.ControlInterface.Velocity
    given.synchronization = ruckig.Synchronization.No
    given.max_acceleration = robot.ddq_max
    if np.isfinite(robot.dddq_max).any():
        given.max_jerk = robot.dddq_max
    given.current_velocity = np.zeros(robot.dof)

    def step(q: Vector, dq: Vector, wish: dict[str, Any]) -> Vector:
        given.current_position = q
        given.target_velocity = np.clip(dq, -robot.dq_max, robot.dq_max)
        otg.update(given, found)
        given.current_velocity = found.new_velocity
        given.current_acceleration = found.new_acceleration
        return np.array(found.new_velocity)

    return step


def velocity_of(wish: dict[str, Any], q: Vector, last: Vector, case: hostile.Case) -> Vector:
    """Return the joint velocity that a wish asks for; `last` where there is none."""
    dq = last
    if "dq" in wish:
        dq = wish["dq"]
    elif "position" in wish:
        dq = (wish["position"] - q) / case.dt
    elif "twist" in wish:
        J = iiwa_dnn.Configuration(case.robot, q).jacobian
        dq = J.T @ np.linalg.solve(J @ J.T + 4e-4 * np.eye(6), wish["twist"])
    return dq if np.isfinite(dq).all() else last


def run(make: Callable[[hostile.Case], Step], seeds: list[int]) -> dict[str, Any]:
    """Drive the cases of some seeds; return a row of the table."""
    broken: dict[str, int] = dict.fromkeys(("position", "velocity", "acceleration", "jerk"), 0)
    times = []
    misses = []
    near = 0
    least = np.inf
    for seed in seeds:
        case = hostile.draw_case(seed)
        robot = case.robot
        step = make(case)
        wishes = hostile.wishes(case, seed)
        path = [robot.start_posture()]
        dq = np.zeros(robot.dof)
        for _ in range(min(case.steps, STEPS)):
            wish = next(wishes)
            dq = velocity_of(wish, path[-1], dq, case)
            began = time.perf_counter()
            taken = step(path[-1], dq, wish)
            times.append(time.perf_counter() - began)
            misses.append(np.linalg.norm(taken - np.clip(dq, -robot.dq_max, robot.dq_max)))
            path.append(path[-1] + case.dt * taken)
        driven = np.array(path)
        kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max)
        for breach in breaches(driven, case.dt, *kinds):
            broken[breach.quantity] += 1
        found = Judge(robot, case.avoidance).verdict(driven, case.dt)
        near += found.broken > 0
        least = min(least, found.least)
    about = {"near": near, "least": 1e3 * least, "miss": np.mean(misses)}
    return broken | about | {"us": 1e6 * np.median(times), "p99": 1e6 * np.percentile(times, 99)}


def report() -> None:
    """Print the table."""
    seeds: list[int] = []
    seed = 0
    while len(seeds) < RUNS:
        seed += 1
        case = hostile.draw_case(seed)
        if case and not case.moving and np.isfinite(case.robot.ddq_max).all():
            seeds.append(seed)
    filters = {"shield": shield, "clamp": clamp, "Ruckig, velocities": with_ruckig}
    columns = {
        "filter": "{name}",
        "position": "{position}",
        "velocity": "{velocity}",
        "acceleration": "{acceleration}",
        "jerk": "{jerk}",
        "distance": "{near}",
        "least distance": "{least:.1f} mm",
        "from the wish": "{miss:.2f} rad/s",
        "median": "{us:.0f} us",
        "p99": "{p99:.0f} us",
    }
    rows = ({"name": name} | run(make, seeds) for name, make in filters.items())
    show(f"Runs of {RUNS} in which a limit is broken, hostile wishes", columns, rows)
