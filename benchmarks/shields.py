"""The shield beside other filters of commands, on the same hostile requests (tests/hostile.py).

The obstacles are spheres that stand still. libfranka's limiter is the one inside pylibfranka, in
units of time in which a period is 1 ms; cbfpy runs in an environment of its own.
"""

import ctypes
import json
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pylibfranka
import ruckig

import hostile
import iiwa_dnn
from benchmarks.report import show
from iiwa_dnn.qp import Vector
from iiwa_dnn.robot.collision import collision_model
from judge_distances import Judge
from judge_limits import breaches

RUNS = 10
STEPS = 1000
RADIUS = 0.08
"""Runs, each of so many steps at most, among spheres of this radius [m]."""

GOALS = 20
ARRIVED = 1e-3
"""Postures to arrive at, and what every joint may lack of them [rad]."""

Step = Callable[[Vector, Vector, dict[str, Any]], Vector]
"""Returns the command at joint positions q, for a requested velocity, or the request itself."""


def shield(case: hostile.Case) -> Step:
    """Return the step of a shield."""
    made = iiwa_dnn.Shield(case.robot, case.dt, case.avoidance.obstacles, hostile.DISTANCE)
    return lambda q, dq, request: made.step(q, **request).dq


def clamp(case: hostile.Case) -> Step:
    """Return a clamp of the way of a step, and of the next positions, to their limits."""
    robot = case.robot

    def step(q: Vector, dq: Vector, request: dict[str, Any]) -> Vector:
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

    def step(q: Vector, dq: Vector, request: dict[str, Any]) -> Vector:
        given.current_position = q
        given.target_velocity = np.clip(dq, -robot.dq_max, robot.dq_max)
        otg.update(given, found)
        given.current_velocity = found.new_velocity
        given.current_acceleration = found.new_acceleration
        return np.array(found.new_velocity)

    return step


def libfranka(case: hostile.Case) -> Step:
    """Return ``franka::limitRate`` of seven joint velocities, which pylibfranka holds inside."""
    place = Path(pylibfranka.__file__).parent / "libfranka.so"
    limit_rate = ctypes.CDLL(str(place))._ZN6franka9limitRateERKSt5arrayIdLm7EES3_S3_S3_S3_S3_S3_
    robot, n = case.robot, case.robot.dof
    unit = case.dt / 1e-3
    numbers = np.ones((8, 7))  # of the call: the command, and seven arguments
    jerk = np.minimum(robot.dddq_max, robot.ddq_max / case.dt)  # with more it is not stable
    limits = (robot.dq_max, -robot.dq_max, robot.ddq_max, jerk)
    for row, limit, power in zip(numbers[1:5], limits, (1, 1, 2, 3), strict=True):
        row[:n] = limit * unit**power
    numbers[5:] = 0.0
    pointers = [ctypes.c_void_p(row.ctypes.data) for row in numbers]

    def step(q: Vector, dq: Vector, request: dict[str, Any]) -> Vector:
        numbers[5, :n] = unit * dq
        limit_rate(*pointers)
        numbers[7] = (numbers[0] - numbers[6]) / 1e-3
        numbers[6] = numbers[0]
        return numbers[0, :n] / unit

    return step


def scene_of(case: hostile.Case) -> dict[str, Any]:
    """Describe an arm and the spheres for cbfpy, whose barriers are written in jax."""
    model = case.robot.model
    capsules = collision_model(case.robot).capsules
    frames = [model.frames[case.robot.frame_id(each.link)] for each in capsules]
    moved = [(c.shape, f) for c, f in zip(capsules, frames, strict=True) if f.parentJoint]
    axes = [np.eye(3)["XYZ".index(joint.shortname()[-1])] for joint in model.joints[1:]]
    scene: dict[str, Any] = {
        "places": [place.translation for place in model.jointPlacements[1:]],
        "turns": [place.rotation for place in model.jointPlacements[1:]],
        "axes": axes,
        "a": [frame.placement.act(np.array(capsule.a)) for capsule, frame in moved],
        "b": [frame.placement.act(np.array(capsule.b)) for capsule, frame in moved],
        "radii": [capsule.radius + RADIUS for capsule, _ in moved],
        "balls": [ball.center for ball in case.avoidance.obstacles],
        "lower": np.maximum(case.robot.q_lower, -1e3),
        "upper": np.minimum(case.robot.q_upper, 1e3),
        "velocity": case.robot.dq_max,
    }
    arrays = {name: np.array(value).tolist() for name, value in scene.items()}
    joints = [frame.parentJoint for _, frame in moved]
    return arrays | {"joints": joints, "distance": hostile.DISTANCE}


class Cbfpy:
    """cbfpy in its own Python; `seconds` is the time of the last step without the pipe."""

    def __init__(self, python: Path, case: hostile.Case) -> None:
        """Start it."""
        file = Path(__file__).with_name("loops") / "cbfpy_filter.py"
        words = [python, file, json.dumps(scene_of(case))]
        self._process = subprocess.Popen(
            words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.seconds = 0.0

    def __call__(self, q: Vector, dq: Vector, request: dict[str, Any]) -> Vector:
        """Return the command."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        asked = {"q": q.tolist(), "dq": dq.tolist()}
        print(json.dumps(asked), file=self._process.stdin, flush=True)
        answer = json.loads(self._process.stdout.readline())
        self.seconds = answer["seconds"]
        return np.array(answer["dq"])


def velocity_of(request: dict[str, Any], q: Vector, last: Vector, case: hostile.Case) -> Vector:
    """Return the joint velocity that a request asks for; `last` where there is none."""
    dq = last
    if "dq" in request:
        dq = request["dq"]
    elif "position" in request:
        dq = (request["position"] - q) / case.dt
    elif "twist" in request:
        J = iiwa_dnn.Configuration(case.robot, q).jacobian
        dq = J.T @ np.linalg.solve(J @ J.T + 4e-4 * np.eye(6), request["twist"])
    return dq if np.isfinite(dq).all() else last


def run(make: Callable[[hostile.Case], Step], cases: dict[int, hostile.Case]) -> dict[str, Any]:
    """Drive the cases by their seeds; return a row of the table."""
    broken: dict[str, int] = dict.fromkeys(("position", "velocity", "acceleration", "jerk"), 0)
    times = []
    misses = []
    near = 0
    least = np.inf
    for seed, case in cases.items():
        robot = case.robot
        step = make(case)
        requests = hostile.requests(case, seed)
        path = [robot.start_posture()]
        dq = np.zeros(robot.dof)
        for _ in range(min(case.steps, STEPS)):
            request = next(requests)
            dq = velocity_of(request, path[-1], dq, case)
            began = time.perf_counter()
            taken = step(path[-1], dq, request)
            times.append(getattr(step, "seconds", time.perf_counter() - began))
            misses.append(np.linalg.norm(taken - np.clip(dq, -robot.dq_max, robot.dq_max)))
            path.append(path[-1] + case.dt * taken)
        driven = np.array(path)
        kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max)
        for breach in breaches(driven, case.dt, *kinds):
            broken[breach.quantity] += breach.excess > 1e-4  # what a solver's tolerance may cost
        found = Judge(robot, case.avoidance).verdict(driven, case.dt)
        near += found.least < hostile.DISTANCE - 1e-4
        least = min(least, found.least)
    about = {"near": near, "least": 1e3 * least, "miss": np.mean(misses)}
    return broken | about | {"us": 1e6 * np.median(times), "p99": 1e6 * np.percentile(times, 99)}


def draw_cases() -> dict[int, hostile.Case]:
    """Draw cases whose acceleration is limited, by their seeds, with spheres as obstacles."""
    cases: dict[int, hostile.Case] = {}
    seed = 0
    while len(cases) < RUNS:
        seed += 1
        case = hostile.draw_case(seed)
        if case and np.isfinite(case.robot.ddq_max).all():
            balls = [iiwa_dnn.Sphere(place, RADIUS) for place in hostile.places_of(case)]
            avoidance = iiwa_dnn.CollisionAvoidance(balls, False, distance=hostile.DISTANCE)
            case = case._replace(avoidance=avoidance, moving=False)
            if hostile.is_clear(case, 0.0):
                cases[seed] = case
    return cases


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


def report(cbfpy: Path | None) -> None:
    """Print the tables, with cbfpy where an environment with it is given."""
    columns = {"arm": "{name}", **{key: f"{{{key}:.3f}}" for key in ("least", "median", "most")}}
    rows = (arrivals(name) for name in ("iiwa7", "fr3", "panda"))
    show(f"Arrival at {GOALS} postures, in units of Ruckig's time", columns, rows)
    cases = draw_cases()
    filters: dict[str, Callable[[hostile.Case], Step]] = {
        "shield": shield,
        "clamp": clamp,
        "Ruckig, velocities": with_ruckig,
        "libfranka, `limitRate`": libfranka,
    }
    if cbfpy:
        filters["cbfpy"] = lambda case: Cbfpy(cbfpy, case)
    columns = {
        "filter": "{name}",
        "position": "{position}",
        "velocity": "{velocity}",
        "acceleration": "{acceleration}",
        "jerk": "{jerk}",
        "distance": "{near}",
        "least distance": "{least:.1f} mm",
        "from the request": "{miss:.2f} rad/s",
        "median": "{us:.0f} us",
        "p99": "{p99:.0f} us",
    }
    rows = ({"name": name} | run(make, cases) for name, make in filters.items())
    show(f"Runs of {RUNS} in which a limit is broken, hostile requests", columns, rows)
