"""Hostile targets, obstacles, acceleration limits: ``python -m benchmarks.braking STEPS``.

Arms among random obstacles, with random control periods and limits, are asked for targets that jump
behind, into and past what is in the way, and in the end back to their start. coal judges the
distances, at every step and half-way between steps; finite differences judge the limits.
"""

import sys
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import iiwa_dnn
from benchmarks.random_motion import Judge
from iiwa_dnn.qp import Matrix, Vector

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))
from judge_limits import breaches

DISTANCE = 0.02
"""Least distance that is promised [m]."""

SLACK = 1e-6
"""Distance that coal's own tolerance may cost [m]."""

BACK = 20.0
"""Time that an arm has for the way back to its start [s]."""


class Case(NamedTuple):
    """A robot among obstacles, its limits, and how its controller is set up."""

    robot: iiwa_dnn.Robot
    avoidance: iiwa_dnn.CollisionAvoidance
    limits: tuple[Any, ...]
    orientation: Any
    policy: Any
    dt: float


def draw_obstacle(random: np.random.Generator, tip: Vector) -> Any:
    """Draw an obstacle around a point (3,) [m]."""
    kind = random.integers(4)
    center = tip + 0.35 * random.standard_normal(3)
    if kind == 0:
        return iiwa_dnn.Sphere(center, 0.08)
    if kind == 1:
        return iiwa_dnn.Capsule(center, center + 0.2 * random.standard_normal(3), 0.05)
    if kind == 2:
        return iiwa_dnn.Box(center, [0.08, 0.1, 0.06])
    normal = random.standard_normal(3)
    normal /= np.linalg.norm(normal)
    return iiwa_dnn.HalfSpace(normal, float(normal @ tip) - random.uniform(0.1, 0.4))


def draw_case(seed: int) -> Case:
    """Draw a case from a seed."""
    random = np.random.default_rng(seed)
    robot = iiwa_dnn.load_robot(("iiwa7", "panda")[random.integers(2)])
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    obstacles = [draw_obstacle(random, start.position) for _ in range(random.integers(1, 4))]
    avoidance = iiwa_dnn.CollisionAvoidance(
        obstacles, self_collision=bool(random.random() < 0.5), distance=DISTANCE, nearest=64
    )
    limits: tuple[Any, ...] = (iiwa_dnn.AccelerationLimits(),)
    if random.random() < 0.5:
        limits += (iiwa_dnn.JerkLimits(float(10.0 ** random.uniform(2.5, 4.0))),)
    orientation = ("none", "so3")[random.integers(2)]
    policy = ("slow", "relax")[random.integers(2)]
    return Case(robot, avoidance, limits, orientation, policy, 10.0 ** random.uniform(-3.3, -1.8))


def drive(case: Case, seed: int, times: list[float]) -> tuple[Matrix, float]:
    """Drive an arm for 6 s and ask it back; joint positions (k, n) and what is left [m]."""
    random = np.random.default_rng(seed)
    robot, avoidance, limits, orientation, policy, dt = case
    scheme = iiwa_dnn.DoubleIndicator(orientation=orientation, extra_limits=(*limits, avoidance))
    controller = iiwa_dnn.Controller(robot, scheme, dt=dt, policy=policy)
    controller.warm_up()
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    q = start.q
    path = [q]
    hostile = int(6.0 / dt)
    left = np.inf
    for k in range(hostile + int(BACK / dt)):
        if k < hostile and k % max(1, int(0.4 / dt)) == 0:
            goal = start.position + random.choice([0.1, 0.5, 2.0]) * random.standard_normal(3)
        elif k >= hostile:
            goal = start.position
        began = time.perf_counter()
        command = controller.step(q, k * dt, iiwa_dnn.Target(goal, start.rotation))
        times.append(time.perf_counter() - began)
        q = q + dt * command.dq
        path.append(q)
        left = float(np.linalg.norm(iiwa_dnn.Configuration(robot, q).position - start.position))
        if k >= hostile and left < 1e-3:
            break
    return np.array(path), left


def main(steps: int = 100_000, first: int = 0) -> int:
    """Drive until so many steps are done; print what was broken, and the times of a step."""
    times: list[float] = []
    least = np.inf
    broken = stranded = runs = 0
    seed = first
    while len(times) < steps:
        seed += 1
        case = draw_case(seed)
        judge = Judge(case.robot, case.avoidance)
        if judge.distance(case.robot.start_posture(), 0.0) < DISTANCE + 1e-3:
            continue
        path, left = drive(case, seed, times)
        runs += 1
        halves = 0.5 * (path[1:] + path[:-1])
        near = min(judge.distance(q, 0.0) for q in np.vstack([path, halves]))
        robot = case.robot
        jerk = case.limits[1].limit if len(case.limits) > 1 else np.inf
        kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, jerk)
        wrong = breaches(path, case.dt, *kinds)
        broken += bool(wrong) or near < DISTANCE - SLACK
        stranded += left > 1e-2
        least = min(least, near)
        if wrong or left > 1e-2 or near < DISTANCE - SLACK:
            print(
                f"seed {seed}: {near:.6f} m, {wrong[:2]}, {left:.3f} m from the start", flush=True
            )
    median, p99, slow, longest = 1e6 * np.percentile(times, [50.0, 99.0, 99.9, 100.0])
    print(f"{len(times):,} steps, {runs} runs: {broken} broken, {stranded} not back in {BACK:g} s")
    print(f"least distance {least:.7f} m, promised {DISTANCE} m")
    print(f"a step: {median:.0f} us, p99 {p99:.0f}, p99.9 {slow:.0f}, longest {longest:.0f}")
    return int(broken > 0)


if __name__ == "__main__":
    sys.exit(main(*(int(word) for word in sys.argv[1:])))
