"""Controllers of every kind that is exported, each with the posture where it begins."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import iiwa_dnn as d
from iiwa_dnn.checks import Array
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.layout import QPViews
from iiwa_dnn.studies.runs import paper_robot

Made = tuple[d.Controller, Array]
BASE = d.DoubleIndicator()


def drawing(
    scheme: d.Scheme = BASE,
    path: d.Reference | None = None,
    robot: d.Robot | None = None,
    dt: float = 1e-3,
    **options: Any,
) -> Made:
    """Return a controller that draws a path, by default the heart with the paper's arm."""
    arm = paper_robot() if robot is None else robot
    q0 = arm.start_posture()
    reference = (path or d.Heart()).anchored(d.Configuration(arm, q0))
    return d.Controller(arm, scheme, reference, dt=dt, **options), q0


def with_limits(*limits: d.Limit) -> d.Scheme:
    return d.DoubleIndicator(extra_limits=limits)


def at_limits() -> Made:
    robot = paper_robot()
    velocity = robot.dq_max.copy()
    velocity[[0, 2]] = 0.105, 0.004
    return drawing(d.DoubleIndicator(kinetic="inertia"), robot=robot.with_limits(velocity=velocity))


def without_solution(policy: Any) -> Made:
    robot = paper_robot()
    return drawing(robot=robot.with_limits(velocity=0.045 * robot.dq_max), policy=policy)


def among_balls() -> Made:
    places = ([0.36, 0.16, 0.64], [0.7, 0.0, 0.3], [-0.3, 0.5, 0.6])
    balls = [d.Sphere(*ball) for ball in zip(places, (0.05, 0.1, 0.1), strict=True)]
    avoidance = d.CollisionAvoidance(balls, self_collision=False, distance=0.03)
    return drawing(with_limits(avoidance, d.AccelerationLimits(1.0)))


def begun_nearer() -> Made:
    """Pairs that begin nearer than they have to be, one of which comes beyond."""
    ball = d.Sphere([0.36, 0.16, 0.64], 0.05)
    limits = d.CollisionAvoidance([ball], distance=0.045), d.AccelerationLimits(1.0)
    return drawing(with_limits(*limits), d.Heart(scale=0.01))


def among_boxes() -> Made:
    box = d.Box((0.75, 0.0, 0.2), (0.1, 0.1, 0.1))
    floor = d.HalfSpace((0.0, 0.0, 1.0), -0.3)
    return drawing(with_limits(d.CollisionAvoidance([box, floor])))


def two_arms() -> Made:
    robot = d.load_robot("iiwa7_dual")
    q0 = robot.start_posture()
    start = d.Configuration(robot, q0)
    tips = ["left_iiwa7_flange", "right_iiwa7_flange"]
    tasks = [replace(task, frame=name) for name in tips for task in BASE.tasks]
    paths = {name: d.Heart().anchored(start.frame(name)) for name in tips}
    return d.Controller(robot, d.Scheme(BASE.costs, tasks, BASE.limits), paths, dt=1e-3), q0


def other_tasks() -> Made:
    tasks = [
        d.PositionTask(),
        d.AxisTask(),
        d.JointCouplingTask({"iiwa7_joint_1": 1.0, "iiwa7_joint_3": 1.0}, weight=0.01),
        d.PostureTask({"iiwa7_joint_1": 0.1}, weight=0.05),
        d.AxisTask(direction=(0.0, 0.0, -1.0), weight=0.01),
    ]
    return drawing(d.Scheme(BASE.costs, tasks, BASE.limits))


def tilting() -> Made:
    points = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.02, 0.03, 0.0], [0.0, 0.0, 0.01]]
    turns = np.eye(4)[[0, 0, 0, 0]]
    turns[1:3, [1, 2]] = np.diag([0.02, 0.03])
    path = d.Waypoints([0.0, 0.5, 1.0, 1.5], points, quaternions=turns)
    return drawing(path=d.Tilting(path))


@compiled
def damped_rates(qp: QPViews, constants: Array, state: Array, rates: Array) -> None:
    """Write the rates (n + p,) at a state [x | y]: a saddle-point flow within the bounds."""
    n = qp.q.size
    for i in range(n):
        slope = qp.q[i]
        for k in range(n):
            slope += qp.P[i, k] * state[k]
        for j in range(qp.b.size):
            slope += qp.A[j, i] * state[n + j]
        aim = min(max(state[i] - 0.5 * slope, qp.lb[i]), qp.ub[i])
        rates[i] = aim - state[i]
    for j in range(qp.b.size):
        missing = -qp.b[j]
        for i in range(n):
            missing += qp.A[j, i] * (state[i] + rates[i])
        rates[n + j] = missing


class SaddleFlow(d.Network):
    """A network of one's own in compiled code, for programs without inequality rows."""

    compiled_rates = staticmethod(damped_rates)


def own_network() -> Made:
    solver = d.DNNSolver(SaddleFlow(), advance_integrator=d.ExplicitEuler(substeps=20))
    return drawing(mode="continuous", dt=1e-4, solver=solver)


SETTINGS: dict[str, Callable[[], Made]] = {
    "inertia, velocity limits active": at_limits,
    "collisions with balls": among_balls,
    "collisions that begin nearer": begun_nearer,
    "collisions with itself, a box, a floor": among_boxes,
    "two arms": two_arms,
    "other tasks": other_tasks,
    "block form, next target, cone": lambda: drawing(
        d.DoubleIndicator(orientation="block", sample="end"), d.Cone()
    ),
    "continuous": lambda: drawing(mode="continuous", dt=np.float64(1e-4)),
    "tilting poses": tilting,
    "ur5": lambda: drawing(robot=d.load_robot("ur5")),
    "a network of one's own": own_network,
    "without a solution: slow": lambda: without_solution("slow"),
    "without a solution: relax": lambda: without_solution("relax"),
    "without a solution: stop": lambda: without_solution("stop"),
    "yielding to acceleration and jerk": lambda: drawing(
        with_limits(d.AccelerationLimits(2.0), d.JerkLimits(50.0)), d.Circle(begin=0.0)
    ),
}
"""Functions that make each controller, by its name."""
