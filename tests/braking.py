"""Hostile targets, obstacles, acceleration limits: ``python tests/braking.py STEPS [SEED]``.

With ``--exported`` C that `iiwa_dnn.export` wrote drives the arms, each ten times as long, among
obstacles that stand still.

Arms among random obstacles, still and moving, with random control periods and limits, are asked for
targets that jump behind, into and past what is in the way and beyond the joints' limits, and in the
end back to their start. coal judges the distances, at every step and half-way between steps; finite
differences judge the limits. Where an arm is not back in time, it is led back along the path that
it came by: if it comes to its start, its state was no trap, and the tip's own way ended in a local
minimum. An obstacle that has moved may bar that path; then a state is a trap if no posture nearby
can be had.
"""

import argparse
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from typing import Any, NamedTuple

import numpy as np

import iiwa_dnn
from iiwa_dnn.control.policies import Action
from iiwa_dnn.qp import Matrix, Vector
from judge_limits import breaches
from random_motion import Judge, swinging

ARMS = ("iiwa7", "panda", "ur5", "xarm7", "kinova")
ACCELERATION = 10.0
"""Acceleration limit of arms that have none of their own [rad/s^2]."""

DISTANCE = 0.02
"""Least distance that is promised [m]."""

SLACK = 1e-6
"""Distance that coal's own tolerance may cost [m]."""

HOSTILE = 6.0
MOST = 20_000
"""Time for hostile targets [s], and steps at most."""

LONGER = 10
"""Factor of that time for exported controllers."""

BACK = 20.0
"""Time that an arm has for the way back to its start [s]."""

ARRIVED = 1e-3
"""Distance of the tip from its start at which it is back [m]."""

LINK = 0.55
"""Distance of the last link's points from its joint at most [m]."""

AHEAD = (16, 2000)
"""Samples for which it is looked whether a distance has to be computed again."""

TURN = 0.02
PATIENCE = 3.0
"""Way of a joint to the next posture when an arm is led back [rad], and the time for it [s]."""


class Case(NamedTuple):
    """A robot among obstacles, its limits, and how its controller is set up."""

    robot: iiwa_dnn.Robot
    avoidance: iiwa_dnn.CollisionAvoidance
    limits: tuple[Any, ...]
    orientation: Any
    policy: Any
    dt: float
    hostile: int
    moving: bool


Stepper = Callable[[Vector, float, iiwa_dnn.Target], tuple[Vector, bool]]
"""``step(q, t, target)``, which returns a command [rad/s] and whether the step had a solution."""


class Drive(NamedTuple):
    """What an arm did.

    Attributes:
        path: Joint positions [rad], (k + 1, n).
        ok: Whether each step had a solution, (k,).
        left: Distance of the tip from its start in the end [m].
    """

    path: Matrix
    ok: Any
    left: float


@cache
def arm(name: str) -> iiwa_dnn.Robot:
    """Load an arm, with accelerations."""
    robot = iiwa_dnn.load_robot(name)
    if np.isinf(robot.ddq_max).any():
        robot = robot.with_limits(acceleration=ACCELERATION)
    return robot


Sway = tuple[Vector, float, float]
"""Velocity [m/s], (3,), rate [1/s] and end [s] of an obstacle that swings."""


def sway(random: np.random.Generator, until: float) -> Sway:
    """Draw how an obstacle swings up to a time [s]."""
    direction = random.standard_normal(3)
    direction /= np.linalg.norm(direction)
    speed = float(random.uniform(0.02, 0.2))
    rate = float(random.uniform(0.5, 2.0))
    return speed * direction, rate, until


def draw_obstacle(random: np.random.Generator, tip: Vector, swing: Sway | None) -> Any:
    """Draw an obstacle around a point (3,) [m] that swings, or stands still."""
    velocity, *rest = (np.zeros(3), 1.0, np.inf) if swing is None else swing
    move = {"velocity": velocity}
    kind = random.integers(4)
    center = tip + 0.35 * random.standard_normal(3)
    if kind == 0:
        return swinging(iiwa_dnn.Sphere, *rest)(center, 0.08, **move)
    if kind == 1:
        end = center + 0.2 * random.standard_normal(3)
        return swinging(iiwa_dnn.Capsule, *rest)(center, end, 0.05, **move)
    if kind == 2:
        return swinging(iiwa_dnn.Box, *rest)(center, [0.08, 0.1, 0.06], **move)
    normal = random.standard_normal(3)
    normal /= np.linalg.norm(normal)
    offset = float(normal @ tip) - random.uniform(0.1, 0.4)
    return swinging(iiwa_dnn.HalfSpace, *rest)(normal, offset, **move)


def draw_case(seed: int, exported: bool = False) -> Case:
    """Draw a case from a seed, for an exported controller a longer one, without motion."""
    random = np.random.default_rng(seed)
    robot = arm(ARMS[random.integers(len(ARMS))])
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    dt = float(10.0 ** random.uniform(-4.0, np.log10(2e-2)))
    hostile = min(int(HOSTILE / dt), MOST) * (LONGER if exported else 1)
    moving = bool(random.random() < 0.3) and not exported
    obstacles = [
        draw_obstacle(random, start.position, sway(random, hostile * dt) if moving else None)
        for _ in range(random.integers(1, 4))
    ]
    nearest = (24, 64)[random.integers(2)]
    avoidance = iiwa_dnn.CollisionAvoidance(
        obstacles, self_collision=bool(random.random() < 0.5), distance=DISTANCE, nearest=nearest
    )
    limits: tuple[Any, ...] = (iiwa_dnn.AccelerationLimits(),)
    if random.random() < 0.5:
        limits += (iiwa_dnn.JerkLimits(float(10.0 ** random.uniform(2.7, 4.0))),)
    orientation = ("none", "so3")[random.integers(2)]
    policy = ("slow", "relax")[random.integers(2)]
    return Case(robot, avoidance, limits, orientation, policy, dt, hostile, moving)


def hostile_targets(case: Case, seed: int) -> Iterator[iiwa_dnn.Target]:
    """Yield targets: past the arm's reach, into and behind obstacles, at the joints' limits."""
    random = np.random.default_rng(seed)
    robot = case.robot
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    tip = start.position
    places = [
        obstacle.offset * np.array(obstacle.normal)
        if isinstance(obstacle, iiwa_dnn.HalfSpace)
        else obstacle.box.center
        for obstacle in case.avoidance.obstacles
    ]
    while True:
        kind = random.integers(5)
        one = places[random.integers(len(places))]
        other = places[random.integers(len(places))]
        goal = tip + random.choice([0.1, 0.5, 2.0]) * random.standard_normal(3)
        if kind == 1:
            goal = one
        elif kind == 2:
            goal = tip + random.uniform(1.0, 3.0) * (one - tip)
        elif kind == 3:
            goal = 0.5 * (one + other)
        elif kind == 4:
            at_limit = np.where(random.random(robot.dof) < 0.5, robot.q_lower, robot.q_upper)
            some = (random.random(robot.dof) < 0.4) & np.isfinite(at_limit)
            pressed = iiwa_dnn.Configuration(robot, np.where(some, at_limit, start.q))
            goal = tip + 1.5 * (pressed.position - tip)
        yield iiwa_dnn.Target(goal, start.rotation)


def stepper(case: Case, times: list[float]) -> Stepper:
    """Return the step of a controller; the times of its steps [s] are appended."""
    controller = controller_of(case)

    def step(q: Vector, t: float, target: iiwa_dnn.Target) -> tuple[Vector, bool]:
        began = time.perf_counter()
        command = controller.step(q, t, target)
        times.append(time.perf_counter() - began)
        return command.dq, command.ok

    return step


def exported_stepper(case: Case, times: list[float]) -> Stepper:
    """Return the step of an exported controller; the times of its steps [s] are appended."""
    with tempfile.TemporaryDirectory() as folder:
        iiwa_dnn.export.c99(controller_of(case), folder, verify=False)
        exported = iiwa_dnn.export.load(folder)

    def step(q: Vector, t: float, target: iiwa_dnn.Target) -> tuple[Vector, bool]:
        began = time.perf_counter()
        dq, action = exported.step(q, target.data)
        times.append(time.perf_counter() - began)
        return dq, action == Action.NONE

    return step


def controller_of(case: Case) -> iiwa_dnn.Controller:
    """Return the controller of a case."""
    limits = (*case.limits, case.avoidance)
    scheme = iiwa_dnn.DoubleIndicator(orientation=case.orientation, extra_limits=limits)
    return iiwa_dnn.Controller(case.robot, scheme, dt=case.dt, policy=case.policy)


def drive(case: Case, seed: int, step: Stepper) -> Drive:
    """Drive an arm among hostile targets, and ask it back."""
    robot = case.robot
    dt = case.dt
    hostile = case.hostile
    start = iiwa_dnn.Configuration(robot, robot.start_posture())
    home = iiwa_dnn.Target(start.position, start.rotation)
    targets = hostile_targets(case, seed)
    target = next(targets)
    hold = max(1, int(0.4 / dt))
    look = max(1, int(0.02 / dt))
    q = start.q
    path = [q]
    ok = []
    left = np.inf
    for k in range(hostile + int(BACK / dt)):
        if k == hostile:
            target = home
        elif k < hostile and k % hold == 0:
            target = next(targets)
        if k >= hostile and k % look == 0:
            tip = iiwa_dnn.Configuration(robot, q).position
            left = float(np.linalg.norm(tip - start.position))
            if left < ARRIVED:
                break
        dq, solved = step(q, k * dt, target)
        q = q + dt * dq
        path.append(q)
        ok.append(solved)
    return Drive(np.array(path), np.array(ok), left)


class Toward(iiwa_dnn.Task):
    """Joint velocities towards a posture that may be changed in motion."""

    tracks = False
    row_weight = 0.1

    def __init__(self, robot: iiwa_dnn.Robot) -> None:
        """Begin without a posture."""
        self.rows = robot.dof
        self.posture: Vector = np.zeros(robot.dof)

    def equations(self, step: iiwa_dnn.Step) -> tuple[Matrix, Vector]:
        """Return the identity, and 20 1/s times what is left."""
        return np.eye(self.rows), 20.0 * (self.posture - step.q)


def way_back(path: Matrix) -> list[Vector]:
    """Return postures `TURN` apart from the end of a path (k, n) [rad] to its start, no loops."""
    here = len(path) - 1
    postures = []
    while here > 0:
        near = np.abs(path[: here + 1] - path[here]).max(axis=1) < TURN
        here = min(int(near.argmax()), here - 1)
        postures.append(path[here])
    return postures


def lead(case: Case, path: Matrix, postures: Iterable[Vector]) -> Vector:
    """Lead an arm from the end of a path (k, n) [rad] from posture to posture.

    Returns:
        Where it ends, at the last posture or at one that it does not reach, (n,).
    """
    robot, avoidance, limits, _, _, dt, _, _ = case
    start = iiwa_dnn.Configuration(robot, path[0])
    target = iiwa_dnn.Target(start.position, start.rotation)  # no task asks for it
    task = Toward(robot)
    parts = [iiwa_dnn.JointLimits(), *limits, avoidance]
    scheme = iiwa_dnn.Scheme([iiwa_dnn.KineticEnergy()], [task], parts)
    controller = iiwa_dnn.Controller(robot, scheme, dt=dt, policy="relax")
    q = path[-1]
    t = len(path) * dt
    for posture in postures:
        task.posture = posture
        for _ in range(int(PATIENCE / dt)):
            if np.abs(posture - q).max() < TURN:
                break
            q = q + dt * controller.step(q, t, target).dq
            t += dt
        else:
            break
    return q


def name_stop(case: Case, path: Matrix) -> str:
    """Name why a tip is not back at the end of a path (k, n) [rad].

    The arm is led back along the path, which an obstacle that has moved may bar meanwhile, and if
    it does not come to its start, to a hundred postures about its own.
    """
    q = lead(case, path, way_back(path))
    if np.abs(path[0] - q).max() < 2.0 * TURN:
        return "minima"
    random = np.random.default_rng(0)
    robot = case.robot
    for _ in range(100):
        aside = path[-1] + random.uniform(-0.2, 0.2, robot.dof)
        q = lead(case, path, [np.clip(aside, robot.q_lower, robot.q_upper)])
        if np.abs(q - path[-1]).max() > 0.1:
            return "barred ways"
    return "traps"


def reach_of(robot: iiwa_dnn.Robot) -> Vector:
    """Bound the distance of the points that each joint of an arm moves from its axis, (n,) [m]."""
    lengths = [np.linalg.norm(place.translation) for place in robot.model.jointPlacements[2:]]
    reach: Vector = np.cumsum([LINK, *lengths[::-1]])[::-1]
    return reach


class Verdict(NamedTuple):
    """What coal says of a path: the least distance [m], and steps that broke the promise."""

    least: float
    broken: int


def judge_distances(case: Case, judge: Judge, driven: Drive) -> Verdict:
    """Judge the distances of a path, at its samples and half-way between.

    Between two distances that are computed, others are left out where none of the arm's points has
    gone so far, nor an obstacle, that the distance can be below the promised one. Below it, a
    moving obstacle has broken no promise if the step said so and the arm itself did not come
    nearer.
    """
    path = driven.path
    dt = case.dt
    doubled = np.empty((2 * len(path) - 1, path.shape[1]))
    doubled[::2] = path
    doubled[1::2] = 0.5 * (path[1:] + path[:-1])
    clock = 0.5 * dt * np.arange(len(doubled))
    reach = reach_of(case.robot)
    fastest = max(obstacle.speed for obstacle in case.avoidance.obstacles)
    least = np.inf
    broken = 0
    i = 0
    while i < len(doubled):
        distance = judge.distance(doubled[i], clock[i])
        least = min(least, distance) if not case.moving else least
        if distance < DISTANCE - SLACK:
            excused = case.moving and i > 0 and not driven.ok[(i - 1) // 2]
            if excused:
                stood = judge.distance(doubled[i - 1], clock[i])
                excused = distance >= stood - SLACK
            broken += not excused
        spare = max(distance - DISTANCE, 0.0)
        for count in AHEAD:
            ahead = slice(i + 1, i + 1 + count)
            taken = np.abs(doubled[ahead] - doubled[i]) @ reach
            near = np.flatnonzero(taken + fastest * (clock[ahead] - clock[i]) > spare)
            if near.size:
                break
        i += 1 + (int(near[0]) if near.size else len(taken))
    return Verdict(least, broken)


def main(steps: int, first: int, report: int, exported: bool) -> int:
    """Drive until so many steps are done; print what was broken, and the times of a step."""
    make = exported_stepper if exported else stepper
    times: list[float] = []
    spent = Counter[str]()
    counts = Counter[str]()
    least = np.inf
    seed = first
    done = 0
    while done < steps:
        seed += 1
        case = draw_case(seed, exported)
        robot = case.robot
        judge = Judge(robot, case.avoidance)
        if judge.distance(robot.start_posture(), 0.0) < DISTANCE + 1e-3:
            continue
        driven = drive(case, seed, make(case, times))
        found = judge_distances(case, judge, driven)
        jerk = case.limits[1].limit if len(case.limits) > 1 else np.inf
        kinds = (robot.q_lower, robot.q_upper, robot.dq_max, robot.ddq_max, jerk)
        wrong = breaches(driven.path, case.dt, *kinds)
        done += len(driven.ok)
        spent[robot.name] += len(driven.ok)
        least = min(least, found.least)
        counts["runs"] += 1
        counts["with moving obstacles"] += case.moving
        counts["limits broken"] += len(wrong)
        counts["distances broken"] += found.broken
        about = f"seed {seed}, {robot.name}, {case.dt:.2g} s"
        if wrong or found.broken:
            print(
                f"{about}: {wrong[:2]}, {found.broken} distances, {found.least:.7f} m", flush=True
            )
        ended = case.hostile * case.dt
        covered = judge.distance(robot.start_posture(), ended) < DISTANCE + 1e-3
        if driven.left > 1e-2 and not covered:
            counts["tips not back"] += 1
            what = name_stop(case, driven.path)
            counts[what] += 1
            print(f"{about}: {driven.left:.3f} m left, of the {what}", flush=True)
        if counts["runs"] % report == 0:
            print(f"{done:,} steps, {dict(counts)}, least {least:.7f} m", flush=True)
    median, p99, slow, longest = 1e6 * np.percentile(times, [50.0, 99.0, 99.9, 100.0])
    print(f"{done:,} steps, {dict(counts)}, by arm {dict(spent)}")
    print(f"least distance from a still obstacle {least:.7f} m, promised {DISTANCE} m")
    print(f"a step: {median:.0f} us, p99 {p99:.0f}, p99.9 {slow:.0f}, longest {longest:.0f}")
    return int(counts["limits broken"] + counts["distances broken"] + counts["traps"] > 0)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("steps", type=int, nargs="?", default=100_000)
    parser.add_argument("first", type=int, nargs="?", default=0, help="seed before the first one")
    parser.add_argument("report", type=int, nargs="?", default=25, help="runs between two lines")
    parser.add_argument("--exported", action="store_true")
    sys.exit(main(**vars(parser.parse_args())))
