"""Hostile motion of controllers and shields: ``python tests/hostile.py shield STEPS [SEED]``.

Five arms among random obstacles, still and moving, with random control periods and limits, are
asked for what they must not do: targets that jump behind, into and beyond obstacles and
beyond the joints' limits; velocities, positions and twists that jump, change their signs, drift,
fall silent and are no numbers. In the end they are asked back to their start. coal judges the
distances, at every step and half-way between steps; finite differences judge the limits. An arm
that is not back in time is led back along its own path: if it comes to its start, its state was no
trap, and its own way ended in a local minimum. An obstacle that has moved may bar that path; then a
state is a trap if no posture nearby can be had.

With ``--exported`` armstep drives the arms, by tables that `iiwa_dnn.export` wrote, two hundred
times as long, among obstacles that stand still.
"""

import argparse
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from itertools import repeat
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

import iiwa_dnn
from helpers_export import in_armstep
from iiwa_dnn import Configuration, Target
from iiwa_dnn.qp import Matrix, Vector
from judge_distances import Judge, swinging
from judge_limits import Breach, breaches

ARMS = ("iiwa7", "panda", "ur5", "xarm7", "kinova")
ACCELERATION = 10.0
"""Acceleration limit of arms that have none of their own [rad/s^2]."""

DISTANCE = 0.02
"""Least distance that is promised [m]."""

HOSTILE = 6.0
LONGER = 200
"""Time for hostile requests [s], and its factor for exported steps."""

BACK = 20.0
ARRIVED = 1e-3
"""Time for the way back to the start [s], and what may be left of it, [m] or [rad]."""

TURN = 0.02
PATIENCE = 3.0
"""Way of a joint to the next posture when an arm is led back [rad], and the time for it [s]."""


RULES = ("limits broken", "distances broken", "traps")


class Case(NamedTuple):
    """A robot, whose limits hold, among obstacles, and how it is driven there."""

    robot: iiwa_dnn.Robot
    avoidance: iiwa_dnn.CollisionAvoidance
    dt: float  # [s]
    steps: int  # hostile ones
    moving: bool  # obstacles
    orientation: Any  # of a controller's task
    policy: Any

    @property
    def start(self) -> Configuration:
        """The configuration that the motion begins in."""
        return Configuration(self.robot, self.robot.start_posture())


class Driver(NamedTuple):
    """Steps of an arm, its hostile requests, the request for the start, and the way left to it.

    A step takes joint positions [rad], a time [s] and a request. It returns a command [rad/s], and
    whether it promises that distances hold if obstacles move.
    """

    step: Callable[[Vector, float, Any], tuple[Vector, bool]]
    requests: Iterator[Any]
    home: Any
    left: Callable[[Vector], float]  # of joint positions, [m] or [rad]


class Verdict(NamedTuple):
    """An arm's motion, and what is broken."""

    path: Matrix  # joint positions [rad], (k + 1, n)
    left: float  # of the way back to the start, [m] or [rad]
    limits: list[Breach]
    distances: int  # samples that are nearer than promised
    least: float  # distance of still obstacles [m]


def draw_obstacle(random: np.random.Generator, tip: Vector, until: float) -> Any:
    """Draw an obstacle around a point (3,) [m] that swings up to a time [s], or stands still."""
    make: Any = swinging
    velocity = np.zeros(3)
    if until > 0.0:
        direction = random.standard_normal(3)
        velocity = random.uniform(0.02, 0.2) * direction / np.linalg.norm(direction)
        make = partial(swinging, rate=float(random.uniform(0.5, 2.0)), until=until)
    center = tip + 0.35 * random.standard_normal(3)
    kind = random.integers(4)
    if kind == 0:
        return make(iiwa_dnn.Sphere)(center, 0.08, velocity=velocity)
    if kind == 1:
        end = center + 0.2 * random.standard_normal(3)
        return make(iiwa_dnn.Capsule)(center, end, 0.05, velocity=velocity)
    if kind == 2:
        return make(iiwa_dnn.Box)(center, [0.08, 0.1, 0.06], velocity=velocity)
    normal = random.standard_normal(3)
    normal /= np.linalg.norm(normal)
    offset = float(normal @ tip) - random.uniform(0.1, 0.4)
    return make(iiwa_dnn.HalfSpace)(normal, offset, velocity=velocity)


def draw_case(seed: int, exported: bool = False) -> Case | None:
    """Draw a case, for exported steps a longer one, without motion; None if it begins too near."""
    random = np.random.default_rng(seed)
    robot = iiwa_dnn.load_robot(ARMS[random.integers(len(ARMS))])
    acceleration = np.where(np.isfinite(robot.ddq_max), robot.ddq_max, ACCELERATION)
    jerk = 10.0 ** random.uniform(2.7, 4.0)
    kind = random.choice(3, p=(0.1, 0.4, 0.5))
    robot = robot.with_limits(
        acceleration=acceleration if kind > 0 else np.inf, jerk=jerk if kind > 1 else np.inf
    )
    dt = float(10.0 ** random.uniform(-3.0, np.log10(2e-2)))
    steps = int(HOSTILE / dt) * (LONGER if exported else 1)
    moving = bool(random.random() < 0.3) and not exported
    tip = Configuration(robot, robot.start_posture()).position
    obstacles = [
        draw_obstacle(random, tip, moving * steps * dt) for _ in range(random.integers(1, 4))
    ]
    avoidance = iiwa_dnn.CollisionAvoidance(obstacles, distance=DISTANCE)
    orientation = ("none", "so3")[random.integers(2)]
    policy = ("slow", "relax")[random.integers(2)]
    case = Case(robot, avoidance, dt, steps, moving, orientation, policy)
    return case if is_clear(case, 0.0) else None


def is_clear(case: Case, t: float) -> bool:
    """Test whether the start keeps the promised distances at a time [s]."""
    return Judge(case.robot, case.avoidance).distance(case.start.q, t) > DISTANCE + 1e-3


def places_of(case: Case) -> list[Vector]:
    """Return the middles of the obstacles [m]."""
    return [
        each.offset * np.array(each.normal)
        if isinstance(each, iiwa_dnn.HalfSpace)
        else each.box.center
        for each in case.avoidance.obstacles
    ]


def posture(robot: iiwa_dnn.Robot, random: np.random.Generator, beyond: float) -> Vector:
    """Draw a posture within the limits, or up to so much of 3 rad beyond them, (n,) [rad]."""
    lower = np.maximum(robot.q_lower, -3.0) - beyond
    upper = np.minimum(robot.q_upper, 3.0) + beyond
    return random.uniform(lower, upper)


def pose(robot: iiwa_dnn.Robot, q: Vector) -> Target:
    """Return the tip's pose in a posture (n,) [rad]."""
    there = Configuration(robot, q)
    return Target(there.position, there.rotation)


Streams = dict[str, Callable[[float], Target]]


def streams(robot: iiwa_dnn.Robot, random: np.random.Generator) -> Streams:
    """Return targets at a time [s] that no arm can simply follow."""
    start = robot.start_posture()
    home = pose(robot, start)
    amplitude = 0.3 * np.minimum(np.minimum(robot.q_upper - start, start - robot.q_lower), 3.0)
    rate = random.uniform(0.5, 1.2, robot.dof) * robot.dq_max / amplitude
    stretched = np.where(np.arange(robot.dof) % 2, 0.02, start)
    stretch = np.clip(stretched, robot.q_lower, robot.q_upper) - start
    postures = [posture(robot, random, -0.2) for _ in range(8)]
    hold = random.uniform(0.3, 3.0)
    direction = random.standard_normal(3)
    direction /= np.linalg.norm(direction)
    far = Target(2.0 * direction, home.rotation)

    def reversals(t: float) -> Target:  # a line at 0.4 m/s that turns round within one step
        way = 0.1 - abs((0.4 * t + 0.1) % 0.4 - 0.2)
        return Target(home.position + way * direction, home.rotation)

    return {
        "jumps": lambda t: pose(robot, postures[int(t / hold) % len(postures)]),
        "sinusoids": lambda t: pose(robot, start + amplitude * np.sin(rate * t)),
        "out of reach": lambda t: far if int(t / hold) % 2 == 0 else home,
        "singular": lambda t: pose(robot, start + np.sin(0.25 * np.pi * t) ** 2 * stretch),
        "reversals": reversals,
    }


STREAMS = ("jumps", "sinusoids", "out of reach", "singular", "reversals")


def into_obstacles(case: Case, random: np.random.Generator) -> Iterator[Target]:
    """Yield targets far away, into, behind obstacles, at joint limits, 0.4 s each."""
    robot, start = case.robot, case.start
    places = places_of(case)
    while True:
        one, other = random.choice(places, 2)
        at_limit = np.where(random.random(robot.dof) < 0.5, robot.q_lower, robot.q_upper)
        some = (random.random(robot.dof) < 0.4) & np.isfinite(at_limit)
        pressed = Configuration(robot, np.where(some, at_limit, start.q)).position
        goals = (
            start.position + random.choice([0.1, 0.5, 2.0]) * random.standard_normal(3),
            one,
            start.position + random.uniform(1.0, 3.0) * (one - start.position),
            0.5 * (one + other),
            start.position + 1.5 * (pressed - start.position),
        )
        target = Target(goals[random.integers(len(goals))], start.rotation)
        yield from repeat(target, max(1, int(0.4 / case.dt)))


def targets(case: Case, seed: int) -> Iterator[Target]:
    """Yield the hostile targets of a controller: among the obstacles, and streams for 2 s."""
    random = np.random.default_rng(seed)
    among = into_obstacles(case, random)
    while True:
        stream = streams(case.robot, random)[random.choice(STREAMS)]
        follow = random.random() < 0.3
        for k in range(int(2.0 / case.dt)):
            yield stream(k * case.dt) if follow else next(among)


def requests(case: Case, seed: int) -> Iterator[dict[str, Any]]:
    """Yield the hostile requests of a shield."""
    random = np.random.default_rng(seed)
    robot = case.robot
    n = robot.dof
    tip = case.start.position
    places = places_of(case)
    while True:
        steps = int(random.choice([0.02, 0.1, 0.4, 3.0]) / case.dt) + 1
        request = random.choice([0.1, 1.0, 10.0]) * robot.dq_max * random.standard_normal(n)
        noise = robot.dq_max * random.standard_normal((steps, n))
        drifting = request + 0.1 * np.cumsum(noise, axis=0)
        lost = np.where(random.random((steps, n)) < 0.02, np.nan, request)
        goal = posture(robot, random, 0.2)
        ways = (*(place - tip for place in places), tip, random.standard_normal(3))
        twist = random.choice([0.1, 1.0, 5.0]) * random.standard_normal(6)
        pressed = np.concatenate([random.choice(ways), 0.1 * twist[3:]])  # or stretched
        kinds: tuple[Iterable[dict[str, Any]], ...] = (
            repeat({"dq": request}, steps),
            ({"dq": each} for each in noise),
            ({"dq": request * (-1.0) ** k} for k in range(steps)),
            ({"dq": each} for each in drifting),
            ({"position": goal} if k == 0 else {} for k in range(steps)),  # a chunk, then silence
            repeat({"position": goal}, steps),
            repeat({"twist": twist}, steps),
            repeat({"twist": pressed}, steps),
            ({"dq": each} for each in lost),
            repeat({}, steps),
        )
        yield from kinds[random.integers(len(kinds))]


def scheme_of(case: Case) -> iiwa_dnn.Scheme:
    """Return the paper's scheme with the limits of a case."""
    limits: list[Any] = [case.avoidance]
    if np.isfinite(case.robot.ddq_max).any():
        limits.append(iiwa_dnn.AccelerationLimits())
    if np.isfinite(case.robot.dddq_max).any():
        limits.append(iiwa_dnn.JerkLimits())
    return iiwa_dnn.DoubleIndicator(orientation=case.orientation, extra_limits=limits)


def exported_of(made: Any) -> Any:
    """Let armstep load the tables of a controller or a shield."""
    with tempfile.TemporaryDirectory() as folder:
        return in_armstep(made, Path(folder))


def controller(case: Case, seed: int, exported: bool = False) -> Driver:
    """Return a controller among hostile targets."""
    start = case.start
    made = iiwa_dnn.Controller(case.robot, scheme_of(case), dt=case.dt, policy=case.policy)
    there = exported_of(made) if exported else None

    def step(q: Vector, t: float, request: Target) -> tuple[Vector, bool]:
        if there:
            return there.step(q, t, request.data).dq, False
        command = made.step(q, t, request)
        return command.dq, command.ok

    def left(q: Vector) -> float:
        return float(np.linalg.norm(Configuration(case.robot, q).position - start.position))

    return Driver(step, targets(case, seed), Target(start.position, start.rotation), left)


def shield(case: Case, seed: int, exported: bool = False) -> Driver:
    """Return a shield among hostile requests, or armstep's of its tables."""
    start = case.start.q
    made: Any = iiwa_dnn.Shield(case.robot, case.dt, case.avoidance.obstacles, DISTANCE)
    if exported:
        made = exported_of(made)

    def step(q: Vector, t: float, request: dict[str, Any]) -> tuple[Vector, bool]:
        return made.step(q, **request).dq, False

    def left(q: Vector) -> float:
        return float(np.abs(q - start).max())

    return Driver(step, requests(case, seed), {"position": start}, left)


def judged(case: Case, driver: Driver) -> Verdict:
    """Drive an arm by hostile requests, ask it back, and judge its path."""
    dt = case.dt
    q = case.start.q
    path = [q]
    ok: list[bool] = []
    left = np.inf
    while len(ok) < case.steps + int(BACK / dt) and left > ARRIVED:
        is_hostile = len(ok) < case.steps
        request = next(driver.requests) if is_hostile else driver.home
        dq, promised = driver.step(q, len(ok) * dt, request)
        q = q + dt * dq
        path.append(q)
        ok.append(promised)
        if not is_hostile:
            left = driver.left(q)
    driven = np.array(path)
    found = Judge(case.robot, case.avoidance).verdict(driven, dt, ok)
    broken = breaches(driven, dt, *case.robot.limits)
    return Verdict(driven, left, broken, found.broken, found.least)


def way_back(path: Matrix) -> list[Vector]:
    """Return postures `TURN` apart from the end of a path (k, n) [rad] to its start, no loops."""
    thin = [path[0]]
    for q in path:
        if np.abs(q - thin[-1]).max() > 0.5 * TURN:
            thin.append(q)
    path = np.array([*thin, path[-1]])
    here = len(path) - 1
    postures = []
    while here > 0:
        near = np.abs(path[: here + 1] - path[here]).max(axis=1) < TURN
        here = min(int(near.argmax()), here - 1)
        postures.append(path[here])
    return postures


def lead(case: Case, path: Matrix, postures: Iterable[Vector]) -> Vector:
    """Lead an arm by a shield along postures as far as it comes; its last posture, (n,)."""
    dt = case.dt
    made = iiwa_dnn.Shield(case.robot, dt, case.avoidance.obstacles, DISTANCE)
    made._t = len(path) * dt  # obstacles that have moved stay where they are
    q = path[-1]
    for each in postures:
        for _ in range(int(PATIENCE / dt)):
            if np.abs(each - q).max() < TURN:
                break
            q = q + dt * made.step(q, position=each).dq
        else:
            break
    return q


def name_stop(case: Case, path: Matrix) -> str:
    """Name why an arm is not back: it is led back along its path, else to postures nearby."""
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


def main(driven: str, steps: int, seed: int, exported: bool) -> int:
    """Drive until so many steps are done; print what was broken."""
    make = {"controller": controller, "shield": shield}[driven]
    counts: dict[str, Counter[str]] = {"still": Counter(), "moving": Counter()}
    least = np.inf
    done = 0
    while done < steps:
        seed += 1
        case = draw_case(seed, exported)
        if case is None:
            continue
        verdict = judged(case, make(case, seed, exported))
        taken = len(verdict.path) - 1
        found = Counter({"runs": 1, "steps": taken, case.robot.name: taken})
        found["limits broken"] = len(verdict.limits)
        found["distances broken"] = verdict.distances
        if verdict.left > 1e-2 and is_clear(case, case.steps * case.dt):
            found[name_stop(case, verdict.path)] += 1
        counts["moving" if case.moving else "still"].update(found)
        least = min(least, verdict.least)
        done += taken
        broken = "BROKEN" * any(found[rule] for rule in RULES)
        words = (broken, f"seed {seed}, {case.dt:.2g} s:", dict(found), *verdict.limits[:2])
        print(*words, flush=True)
    for kind, count in counts.items():
        print(f"{driven}, obstacles {kind}: {dict(count)}")
    print(f"least distance from a still obstacle {least:.7f} m, promised {DISTANCE} m")
    return int(any(count[rule] for count in counts.values() for rule in RULES))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("driven", choices=("controller", "shield"))
    parser.add_argument("steps", type=int, nargs="?", default=100_000)
    parser.add_argument("seed", type=int, nargs="?", default=0, help="seed before the first one")
    parser.add_argument("--exported", action="store_true", help="the same in C")
    sys.exit(main(**vars(parser.parse_args())))
