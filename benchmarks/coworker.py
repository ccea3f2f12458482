"""How much an arm moves beside a co-worker: a shield's rule, a stop at 1 m, ISO's fixed distance.

Trunk, head and two forearms walk about the arm and reach in, whatever it does; all policies meet
the same people. Distances, and contacts in motion, are by the kinematics of tests/judge_people.py.
"""

from typing import Any

import numpy as np
from numba import njit

import iiwa_dnn
from benchmarks.report import show
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.schemes import own_rate_limits
from iiwa_dnn.schemes.joint_limits import MotionLimits
from iiwa_dnn.step.stopping import least_periods
from tests.judge_people import apart, judge, place, skeleton_of

DT = 1e-3
SECONDS = 30.0
ARMS = 6
RADII = np.array([0.2, 0.12, 0.06, 0.06])
SPEED = 1.6  # [m/s]; people walk at 1 m/s, forearms move at 1.55 m/s
DISTANCE = 0.02
SENSORS = {"30 Hz, 100 ms, 50 mm": (30.0, 0.1, 0.05), "100 Hz, 20 ms, 20 mm": (100.0, 0.02, 0.02)}


def walk(seed: int, steps: int) -> Matrix:
    """Return the ends of the four capsules at each step, (steps + 1, 4, 2, 3) [m]."""
    random = np.random.default_rng(seed)
    ends = np.zeros((4, 2, 3))
    ends[..., 0] = 2.0
    ends[..., 2] = [[0.7, 1.3], [1.6, 1.65], [0.9, 1.0], [0.9, 1.0]]
    spot, reaches, hand = np.array([2.0, 0.0]), False, np.zeros(2)
    path = [ends.copy()]
    for k in range(steps):
        if k % round(2.0 / DT) == 0 and random.random() < 0.6:
            angle = random.uniform(0.0, 2.0 * np.pi)
            spot = random.uniform(0.8, 2.8) * np.array([np.cos(angle), np.sin(angle)])
        if k % round(0.5 / DT) == 0:
            reaches = random.random() < 0.3
            hand = random.uniform([0.3, 0.2], [0.7, 0.8])  # distance and height
        here = ends[0, 0, :2]
        there = moved(here, spot, DT)
        there = moved(here, there * max(1.0, 0.75 / np.linalg.norm(there)), DT)
        away = max(float(np.linalg.norm(there)), 1e-6)
        x, y = there / away
        ends[:2, :, :2] = there
        for arm, side in ((2, 0.25), (3, -0.25)):
            elbow = np.array([*(there - side * np.array([y, -x]) - 0.1 * np.array([x, y])), 0.9])
            if reaches and arm == 2 and away < 1.35:
                elbow = np.array([hand[0] * x, hand[0] * y, hand[1]])
            for end in range(2):
                goal = elbow + end * np.array([0.25 * x, 0.25 * y, 0.1])
                ends[arm, end] = moved(ends[arm, end], goal, 1.55 * DT)
        path.append(ends.copy())
    return np.array(path)


def moved(here: Vector, there: Vector, most: float) -> Vector:
    """Return a point moved towards another one by no more than a distance [m]."""
    way = there - here
    return np.array(here + way * min(1.0, most / max(float(np.linalg.norm(way)), 1e-12)))


@njit(cache=True)
def separation(arm: Any, q: Any, bodies: Any, radii: Any) -> float:
    """Return the least distance of the links from bodies (4, 2, 3) [m]."""
    links = np.empty(arm.ends.shape)
    place(arm, q, links)
    least = 1e9
    for link in range(len(links)):
        for k in range(len(bodies)):
            found = apart(links[link], bodies[k])[0] - arm.radii[link] - radii[k]
            least = min(least, found)
    return least


def fixed_distance(robot: Any, arm: Any, late: float, error: float) -> float:
    """Return ISO/TS 15066's distance for the longest stop and the quickest point [m]."""
    limits = MotionLimits(own_rate_limits(robot)).constants(robot)
    fastest = np.array(robot.dq_max)
    stop = DT * least_periods(fastest, fastest, limits, DT, False)
    random = np.random.default_rng(0)
    speed = 0.0
    ends, after = np.empty((2, *arm.ends.shape))
    for q, other in zip(robot.draw(random, 1500), robot.draw(random, 1500), strict=True):
        way = other - q
        place(arm, q, ends)
        place(arm, q + 1e-6 * way / np.abs(way / fastest).max(), after)
        speed = max(speed, np.linalg.norm(after - ends, axis=-1).max() / 1e-6)
    return float(SPEED * (late + stop) + speed * (late + 0.5 * stop) + error + DISTANCE)


def play(robot: Any, policy: str, sensor: tuple[float, float, float], paths: list[Matrix]) -> Any:
    """Return share of time moving, mean speed of the tip [m/s], and periods with a contact."""
    rate, latency, error = sensor
    arm = skeleton_of(robot)
    every, late = round(1.0 / rate / DT), round(latency / DT)
    about: dict[str, Any] = {"people": 4, "field": 4.0, "people_speed": SPEED}
    about["latency"] = latency + 1.0 / rate
    rule = policy == "this rule"
    shields = iiwa_dnn.Shields(
        robot, ARMS, dt=DT, obstacles=[], threads=1, **(about if rule else {})
    )
    stop_at = {"a stop at 1 m": 1.0, "nobody": -np.inf}.get(
        policy, 0.0 if rule else fixed_distance(robot, arm, latency + 1.0 / rate + DT, error)
    )
    goals, noise = np.random.default_rng(7), np.random.default_rng(3)
    lower, upper = np.maximum(robot.q_lower, -3.0), np.minimum(robot.q_upper, 3.0)
    q = np.tile(robot.start_posture(), (ARMS, 1))
    goal, frames = q.copy(), []
    seen: Any = None
    links = np.empty((2, *arm.ends.shape))
    moving, tip, contacts = 0, 0.0, 0
    steps = len(paths[0]) - 1
    of_judge = (DT, 0.0, SPEED, DISTANCE, 0.0)
    for k in range(steps):
        if k % every == 0:
            off = noise.standard_normal((ARMS, 4, 2, 3))
            off *= error / np.linalg.norm(off, axis=-1, keepdims=True)
            frames.append((k, np.array([path[k] for path in paths]) + off))
        told: dict[str, Any] = {}
        if frames and frames[0][0] + late <= k:
            at, seen = frames.pop(0)
            capsules = [np.c_[own.reshape(-1, 6), RADII + error] for own in seen]
            told = {"people": capsules, "age": (k - at) * DT} if rule else {}
        if k % round(0.033 / DT) == 0:
            near = np.abs(goal - q).max(axis=1) < 0.05
            new = (noise.random(ARMS) < 0.02) | near
            drawn = lower + goals.uniform(0.05, 0.95, q.shape) * (upper - lower)
            goal = np.where(new[:, None], drawn, goal)
        gap = goal - q
        most = (np.abs(gap) / robot.dq_max).max(axis=1, keepdims=True)
        request = gap / np.maximum(most, 1e-9) * np.minimum(1.0, 6.0 * most)
        if stop_at > 0.0:
            near = [
                seen is None or separation(arm, q[i], seen[i], RADII) < stop_at for i in range(ARMS)
            ]
            request[near] = 0.0
        dq = shields.step(q, request, **told).dq
        for i in range(ARMS):
            place(arm, q[i], links[0])
            place(arm, q[i] + DT * dq[i], links[1])
            tip += float(np.linalg.norm(links[1, -1, 1] - links[0, -1, 1]))
            for k_body in range(4 if dq[i].any() and policy != "nobody" else 0):
                own = paths[i][k : k + 2, k_body : k_body + 1]
                least, _ = judge(arm, q[i], dq[i], *own, of_judge, 0.0)
                contacts += least - RADII[k_body] < DISTANCE - 1e-9
        moving += int(dq.any(axis=1).sum())
        q = q + DT * dq
    return moving / (ARMS * steps), tip / (ARMS * steps * DT), contacts


def report(seconds: float = SECONDS) -> None:
    """Print share of time moving and speed relative to nobody there, of three arms."""
    paths = [walk(seed, round(seconds / DT)) for seed in range(ARMS)]
    iiwa7 = iiwa_dnn.load_robot("iiwa7")
    robots = {
        "iiwa7, 10 rad/s², 500 rad/s³": iiwa7.with_limits(acceleration=10.0, jerk=500.0),
        "fr3": iiwa_dnn.load_robot("fr3"),
        "iiwa7, 4 rad/s², 40 rad/s³": iiwa7.with_limits(acceleration=4.0, jerk=40.0),
    }
    columns = {"arm, sensor": "{name}", "policy": "{policy}", "moving": "{moving:.2f}"}
    columns |= {"speed": "{speed:.2f}", "periods in contact": "{contacts}"}

    def rows() -> Any:
        for name, robot in robots.items():
            for words, sensor in SENSORS.items():
                _, alone, _ = play(robot, "nobody", sensor, paths)
                for policy in ("this rule", "a stop at 1 m", "ISO's fixed distance"):
                    moving, speed, contacts = play(robot, policy, sensor, paths)
                    own = {"moving": moving, "speed": speed / alone, "contacts": contacts}
                    yield own | {"name": f"{name}; {words}", "policy": policy}

    show("Beside a co-worker", columns, rows())
