"""Hostile wishes for a shield: ``python tests/shielding.py STEPS [SEED]``.

The arms, obstacles, limits and judges are those of `braking`; a shield is asked for velocities,
positions and twists that jump, change their signs, drift, fall silent, are no numbers, lead into
singular poses, and press the arm against obstacles and joint limits, in the end back to its start.
"""

import argparse
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import braking
import iiwa_dnn
from iiwa_dnn.qp import Vector
from judge_limits import Breach, breaches
from random_motion import Judge

Wish = dict[str, Any]


def hostile_wishes(case: braking.Case, seed: int) -> Iterator[Wish]:
    """Yield the wish of each step."""
    random = np.random.default_rng(seed)
    robot = case.robot
    n = robot.dof
    fastest = np.where(np.isfinite(robot.dq_max), robot.dq_max, 3.0)
    lower = np.where(np.isfinite(robot.q_lower), robot.q_lower, -3.0)
    upper = np.where(np.isfinite(robot.q_upper), robot.q_upper, 3.0)
    while True:
        kind = random.integers(9)
        steps = int(random.choice([0.02, 0.1, 0.4]) / case.dt) + 1
        wish = random.choice([0.1, 1.0, 10.0]) * fastest * random.standard_normal(n)
        goal = random.uniform(lower - 0.2, upper + 0.2)
        twist = random.choice([0.1, 1.0, 5.0]) * random.standard_normal(6)
        for k in range(steps):
            if kind == 0:  # held
                yield {"dq": wish}
            elif kind == 1:  # noise
                yield {"dq": fastest * random.standard_normal(n)}
            elif kind == 2:  # its sign changes
                yield {"dq": wish * (-1.0) ** k}
            elif kind == 3:  # a policy that drifts
                wish = wish + 0.1 * fastest * random.standard_normal(n)
                yield {"dq": wish}
            elif kind == 4:  # a chunk's goal, then silence
                yield {"position": goal} if k == 0 else {}
            elif kind == 5:
                yield {"position": goal}
            elif kind == 6:
                yield {"twist": twist}
            elif kind == 7:  # not a number, now and then
                yield {"dq": np.where(random.random(n) < 0.02, np.nan, wish)}
            else:
                yield {}


Filter = Callable[[Vector, Wish], tuple[Vector, bool]]
"""``step(q, wish)``, which returns a command [rad/s] and whether it answers a program."""


def shield(case: braking.Case) -> Filter:
    """Return the step of a shield."""
    made = iiwa_dnn.Shield(case.robot, case.dt, case.avoidance.obstacles, braking.DISTANCE)

    def step(q: Vector, wish: Wish) -> tuple[Vector, bool]:
        command = made.step(q, **wish)
        return command.dq, command.command.ok

    return step


def exported(case: braking.Case) -> Filter:
    """Return the step of a shield in C, which takes joint velocities alone."""
    made = iiwa_dnn.Shield(case.robot, case.dt, case.avoidance.obstacles, braking.DISTANCE)
    with tempfile.TemporaryDirectory() as folder:
        iiwa_dnn.export.c99(made, folder, verify=False)
        step_in_c = iiwa_dnn.export.load(folder).shield_step

    def step(q: Vector, wish: Wish) -> tuple[Vector, bool]:
        dq = wish.get("dq")
        if "position" in wish:
            dq = (wish["position"] - q) / case.dt
        elif "twist" in wish:
            dq = np.linalg.pinv(iiwa_dnn.Configuration(case.robot, q).jacobian) @ wish["twist"]
        command = step_in_c(q, dq)
        return command.dq, command.action == 0

    return step


def drive(
    case: braking.Case, seed: int, times: list[float], make: Callable[[braking.Case], Filter]
) -> braking.Drive:
    """Drive an arm by hostile wishes, and ask it back."""
    robot = case.robot
    dt = case.dt
    step = make(case)
    start = robot.start_posture()
    wishes = hostile_wishes(case, seed)
    q = start
    path = [q]
    ok = []
    left = np.inf
    for k in range(case.hostile + int(braking.BACK / dt)):
        if k >= case.hostile:
            left = float(np.abs(q - start).max())
            if left < braking.ARRIVED:
                break
        wish = next(wishes) if k < case.hostile else {"position": start}
        began = time.perf_counter()
        dq, solved = step(q, wish)
        times.append(time.perf_counter() - began)
        q = q + dt * dq
        path.append(q)
        # A moving obstacle may come too near; the arm's own motion must not bring it nearer.
        ok.append(solved and not case.moving)
    return braking.Drive(np.array(path), np.array(ok), left)


def drawn(seed: int, in_c: bool = False) -> braking.Case:
    """Draw a case, with its jerk limit as the robot's own and the arm's links watched too."""
    case = braking.draw_case(seed, in_c)
    robot = case.robot
    if len(case.limits) > 1:
        robot = robot.with_limits(jerk=case.limits[1].limit)
    avoidance = iiwa_dnn.CollisionAvoidance(case.avoidance.obstacles, distance=braking.DISTANCE)
    return case._replace(robot=robot, avoidance=avoidance)


def judged(
    case: braking.Case,
    seed: int,
    times: list[float] | None = None,
    make: Callable[[braking.Case], Filter] = shield,
) -> tuple[braking.Drive, list[Breach], int, float]:
    """Drive a case, and return what coal and differences say of it.

    Returns:
        What the arm did, limits broken, distances broken, and the least distance of still
        obstacles [m].
    """
    robot = case.robot
    driven = drive(case, seed, [] if times is None else times, make)
    found = braking.judge_distances(case, Judge(robot, case.avoidance), driven)
    kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, robot.dddq_max)
    return driven, breaches(driven.path, case.dt, *kinds), found.broken, found.least


def main(steps: int, first: int, in_c: bool) -> int:
    """Drive until so many steps are done; print what was broken, and the times of a step."""
    times: list[float] = []
    counts = Counter[str]()
    spent = Counter[str]()
    least = np.inf
    seed = first
    done = 0
    while done < steps:
        seed += 1
        case = drawn(seed, in_c)
        robot = case.robot
        if (
            Judge(robot, case.avoidance).distance(robot.start_posture(), 0.0)
            < braking.DISTANCE + 1e-3
        ):
            continue
        driven, wrong, broken, nearest = judged(case, seed, times, exported if in_c else shield)
        done += len(driven.ok)
        spent[robot.name] += len(driven.ok)
        least = min(least, nearest)
        counts["runs"] += 1
        counts["with moving obstacles"] += case.moving
        counts["limits broken"] += len(wrong)
        counts["distances broken"] += broken
        about = f"seed {seed}, {robot.name}, {case.dt:.2g} s"
        if wrong or broken:
            print(f"{about}: {wrong[:2]}, {broken} distances, {nearest:.7f} m", flush=True)
        if not driven.left < braking.ARRIVED:
            why = braking.name_stop(case, driven.path)
            counts[why] += 1
            if why == "traps":
                print(f"{about}: a trap", flush=True)
    print(f"{done} steps: {dict(counts)}, least distance of still obstacles {least:.7f} m")
    print(dict(spent), f"median {1e6 * np.median(times):.1f} us, longest {1e3 * max(times):.1f} ms")
    return counts["limits broken"] + counts["distances broken"] + counts["traps"]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("steps", type=int)
    parser.add_argument("seed", type=int, nargs="?", default=0)
    parser.add_argument("--exported", action="store_true", help="the shield in C")
    given = parser.parse_args()
    sys.exit(main(given.steps, given.seed, given.exported) > 0)
