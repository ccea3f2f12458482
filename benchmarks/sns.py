"""Saturation in the null space beside the network, on the heart and on hostile targets.

The algorithm is the first of F. Flacco, A. De Luca and O. Khatib, "Control of redundant robots
under hard joint constraints: saturation in the null space", IEEE Transactions on Robotics 31
(2015), with its bounds: of a joint's range, its velocity, and the velocity from which it can brake.
"""

import time
from collections.abc import Callable
from typing import Any

import numpy as np

import hostile
import iiwa_dnn
from benchmarks.report import show
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.results.metrics import rotation_angle
from iiwa_dnn.studies import paper
from iiwa_dnn.studies.runs import HeartRun, paper_robot
from judge_distances import Judge
from judge_limits import breaches

GAIN = 10.2
"""Gain of the position and of the orientation [1/s], the paper's delta."""

RUNS = 10
STEPS = 1000
RADIUS = 0.08
"""Hostile runs, each of so many steps at most, among spheres of this radius [m]."""

SLACK = 1e-9
"""Excess over a bound [rad/s] that is rounding."""

Asked = tuple[Matrix, Vector]
Step = Callable[[Vector, float], tuple[Vector, float]]
"""Returns the command at joint positions q and a path's time [s], and the scale of the task."""


def saturate(J: Matrix, task: Vector, lower: Vector, upper: Vector) -> tuple[Vector, float]:
    """Return the joint velocity (n,) by saturation in the null space, and the scale of the task.

    Args:
        J: Jacobian of the task, (m, n).
        task: Velocity of the task, (m,).
        lower: Lower bounds of the joints [rad/s], (n,).
        upper: Upper bounds [rad/s], (n,).
    """
    free = np.ones(lower.size)
    saturated = np.zeros(lower.size)
    best = (0.0, free, saturated)
    while True:
        inverse = _inverse(J, free)
        along = inverse @ task
        rest = saturated - inverse @ (J @ saturated)
        beyond = np.maximum(along + rest - upper, lower - along - rest)
        if beyond.max() <= SLACK:
            return along + rest, 1.0
        scales = _largest_scales(along, rest, lower, upper)
        worst = int(scales.argmin())
        if scales[worst] > best[0]:
            best = (float(scales[worst]), free.copy(), saturated.copy())
        over = along[worst] + rest[worst] > upper[worst]
        saturated = saturated.copy()
        saturated[worst] = upper[worst] if over else lower[worst]
        free = free.copy()
        free[worst] = 0.0
        if np.linalg.matrix_rank(J * free, tol=1e-6) < task.size:
            break
    scale, free, saturated = best
    inverse = _inverse(J, free)
    dq = saturated + inverse @ (scale * task - J @ saturated)
    return np.clip(dq, lower, upper), scale


def _inverse(J: Matrix, free: Vector) -> Matrix:
    """Return the pseudo-inverse (n, m) by the joints that are free; the others have no rounding."""
    return np.asarray(free[:, None] * np.linalg.pinv(J * free, rcond=1e-6))


def _largest_scales(along: Vector, rest: Vector, lower: Vector, upper: Vector) -> Vector:
    """Return for each joint the largest scale s in [0, 1] with s along + rest in its bounds."""
    with np.errstate(divide="ignore", invalid="ignore"):
        room = np.where(along > 0.0, upper - rest, lower - rest) / along
    inside = (rest >= lower - SLACK) & (rest <= upper + SLACK)
    return np.where(along == 0.0, inside, np.clip(np.where(inside, room, 0.0), 0.0, 1.0))


def bounds(robot: iiwa_dnn.Robot, q: Vector, dt: float) -> tuple[Vector, Vector]:
    """Return the published bounds of the joint velocities [rad/s], (n,) both."""
    below = np.maximum(q - robot.q_lower, 0.0)
    above = np.maximum(robot.q_upper - q, 0.0)
    speeds = [
        np.minimum.reduce([room / dt, robot.dq_max, np.sqrt(2.0 * robot.ddq_max * room)])
        for room in (below, above)
    ]
    return -speeds[0], speeds[1]


def task_of(conf: iiwa_dnn.Configuration, target: iiwa_dnn.Target, rows: int) -> Asked:
    """Return the Jacobian and the velocity of a task: the target's, and its error's feedback."""
    turn = target.rotation @ conf.rotation.T
    angle = rotation_angle(target.rotation, conf.rotation)
    skew = 0.5 * (turn - turn.T)[[2, 0, 1], [1, 2, 0]]
    axis = skew / max(float(np.linalg.norm(skew)), 1e-300)
    moving = np.concatenate([target.linear_velocity, target.angular_velocity])
    back = np.concatenate([target.position - conf.position, angle * axis])
    return conf.jacobian[:rows], (moving + GAIN * back)[:rows]


def drive(robot: iiwa_dnn.Robot, heart: Any, dt: float, make: Any) -> dict[str, Any]:
    """Drive along a path whose clock runs slower by the scale; return a row of the table."""
    step = make(robot, heart, dt)
    q = np.array(paper.START)
    path = [q]
    errors = []
    scales = []
    times = []
    t = 0.0
    while t < heart.period - 0.5 * dt and len(path) < 10.0 * heart.period / dt:
        conf = iiwa_dnn.Configuration(robot, q)
        errors.append(float(np.linalg.norm(heart.at(t).position - conf.position)))
        began = time.perf_counter()
        dq, scale = step(q, t)
        times.append(time.perf_counter() - began)
        q = q + dt * dq
        t += scale * dt
        path.append(q)
        scales.append(scale)
    limits = (robot.q_lower, robot.q_upper, robot.dq_max)
    rates = np.abs(np.diff(path, 2, axis=0)).max() / dt**2
    return {
        "error": max(errors),
        "drift": float(np.abs(path[-1] - path[0]).max()),
        "slow": 100.0 * float(np.mean(np.array(scales) < 1.0 - 1e-9)),
        "took": len(scales) * dt,
        "broken": sum(each.excess > 1e-6 for each in breaches(np.array(path), dt, *limits)),
        "rate": rates,
        "us": 1e6 * float(np.median(times)),
    }


def by_saturation(robot: iiwa_dnn.Robot, heart: Any, dt: float) -> Step:
    """Return the step of saturation in the null space along a path."""

    def step(q: Vector, t: float) -> tuple[Vector, float]:
        conf = iiwa_dnn.Configuration(robot, q)
        return saturate(*task_of(conf, heart.at(t), 6), *bounds(robot, q, dt))

    return step


def by_network(robot: iiwa_dnn.Robot, heart: Any, dt: float) -> Step:
    """Return the step of a controller with the paper's scheme, whose own clock is not used."""
    scheme = HeartRun(orientation="so3").scheme()
    controller = iiwa_dnn.Controller(robot, scheme, dt=dt)

    def step(q: Vector, t: float) -> tuple[Vector, float]:
        command = controller.step(q, t, heart.at(t))
        return command.dq, command.fraction

    return step


def hostile_row(make: Callable[[hostile.Case], Any], cases: dict[int, hostile.Case]) -> Any:
    """Drive the cases by hostile targets; return a row of the table."""
    broken: dict[str, int] = dict.fromkeys(("position", "velocity", "acceleration", "jerk"), 0)
    near = 0
    left = []
    times = []
    for seed, case in cases.items():
        step = make(case)
        targets = hostile.targets(case, seed)
        path = [case.robot.start_posture()]
        for k in range(min(case.steps, STEPS)):
            target = next(targets)
            began = time.perf_counter()
            dq = step(path[-1], k * case.dt, target)
            times.append(time.perf_counter() - began)
            path.append(path[-1] + case.dt * dq)
            tip = iiwa_dnn.Configuration(case.robot, path[-1]).position
            left.append(float(np.linalg.norm(target.position - tip)))
        driven = np.array(path)
        for breach in breaches(driven, case.dt, *case.robot.limits):
            broken[breach.quantity] += breach.excess > 1e-4
        near += Judge(case.robot, case.avoidance).verdict(driven, case.dt).least < (
            hostile.DISTANCE - 1e-4
        )
    return broken | {"near": near, "left": np.mean(left), "us": 1e6 * np.median(times)}


def hostile_saturation(case: hostile.Case) -> Any:
    """Return the step of saturation in the null space among hostile targets."""
    rows = 6 if case.orientation == "so3" else 3

    def step(q: Vector, t: float, target: iiwa_dnn.Target) -> Vector:
        conf = iiwa_dnn.Configuration(case.robot, q)
        limits = bounds(case.robot, q, case.dt)
        return saturate(*task_of(conf, target, rows), *limits)[0]

    return step


def hostile_controller(case: hostile.Case) -> Any:
    """Return the step of a controller among hostile targets."""
    scheme = hostile.scheme_of(case)
    made = iiwa_dnn.Controller(case.robot, scheme, dt=case.dt, policy=case.policy)
    return lambda q, t, target: made.step(q, t, target).dq


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


def report() -> None:
    """Print both tables."""
    filters = {"network": by_network, "saturation in the null space": by_saturation}
    columns = {
        "the heart": "{name}",
        "largest error m": "{error:.2e}",
        "joint drift rad": "{drift:.1e}",
        "slowed": "{slow:.0f} %",
        "took": "{took:.2f} s",
        "limits broken": "{broken}",
        "acceleration rad/s²": "{rate:.0f}",
        "median µs": "{us:.0f}",
    }
    robot = paper_robot()
    rows = (
        {"name": f"{name}, in {period:g} s"}
        | drive(robot, HeartRun(period=period).reference(), 1e-3, make)
        for period in (10.0, 0.5)
        for name, make in filters.items()
    )
    show("Saturation in the null space, the heart at 1 ms", columns, rows)
    cases = draw_cases()
    columns = {
        "hostile targets": "{name}",
        **{name: f"{{{name}}}" for name in ("position", "velocity", "acceleration", "jerk")},
        "distance": "{near}",
        "mean distance to the target": "{left:.2f} m",
        "median µs": "{us:.0f}",
    }
    makers = {"controller": hostile_controller, "saturation in the null space": hostile_saturation}
    rows = ({"name": name} | hostile_row(make, cases) for name, make in makers.items())
    show(f"Runs of {len(cases)} in which a limit is broken", columns, rows)
