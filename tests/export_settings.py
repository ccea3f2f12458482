"""Controllers of every kind that is exported, each with the posture where it begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import iiwa_dnn
from iiwa_dnn import (
    AccelerationLimits,
    CollisionAvoidance,
    Controller,
    DoubleIndicator,
    JerkLimits,
    Limit,
    Reference,
    Robot,
    Scheme,
)
from iiwa_dnn.checks import Array
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators import ExplicitEuler
from iiwa_dnn.qp.layout import QPViews
from iiwa_dnn.studies.runs import paper_robot

Made = tuple[Controller, Array]
BASE = DoubleIndicator()


def drawing(
    scheme: Scheme = BASE,
    path: Reference | None = None,
    robot: Robot | None = None,
    dt: float = 1e-3,
    **options: Any,
) -> Made:
    """Return a controller that draws a path, by default the heart with the paper's arm."""
    arm = paper_robot() if robot is None else robot
    q0 = arm.start_posture()
    reference = (path or iiwa_dnn.Heart()).anchored(iiwa_dnn.Configuration(arm, q0))
    return Controller(arm, scheme, reference, dt=dt, **options), q0


def with_limits(*limits: Limit) -> Scheme:
    return DoubleIndicator(extra_limits=limits)


def at_limits() -> Made:
    robot = paper_robot()
    velocity = robot.dq_max.copy()
    velocity[[0, 2]] = 0.105, 0.004
    return drawing(DoubleIndicator(kinetic="inertia"), robot=robot.with_limits(velocity=velocity))


def without_solution(policy: Any) -> Made:
    robot = paper_robot()
    return drawing(robot=robot.with_limits(velocity=0.045 * robot.dq_max), policy=policy)


def among_balls() -> Made:
    places = ([0.36, 0.16, 0.64], [0.7, 0.0, 0.3], [-0.3, 0.5, 0.6])
    balls = [iiwa_dnn.Sphere(*ball) for ball in zip(places, (0.05, 0.1, 0.1), strict=True)]
    avoidance = CollisionAvoidance(balls, self_collision=False, distance=0.03)
    return drawing(with_limits(avoidance, AccelerationLimits(1.0)))


def two_arms() -> Made:
    robot = iiwa_dnn.load_robot("iiwa7_dual")
    q0 = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q0)
    tips = ["left_iiwa7_flange", "right_iiwa7_flange"]
    tasks = [replace(task, frame=name) for name in tips for task in BASE.tasks]
    paths = {name: iiwa_dnn.Heart().anchored(start.frame(name)) for name in tips}
    return Controller(robot, Scheme(BASE.costs, tasks, BASE.limits), paths, dt=1e-3), q0


def other_tasks() -> Made:
    tasks = [
        iiwa_dnn.PositionTask(),
        iiwa_dnn.AxisTask(),
        iiwa_dnn.JointCouplingTask({"iiwa7_joint_1": 1.0, "iiwa7_joint_3": 1.0}, weight=0.01),
        iiwa_dnn.PostureTask({"iiwa7_joint_1": 0.1}, weight=0.05),
        iiwa_dnn.AxisTask(direction=(0.0, 0.0, -1.0), weight=0.01),
    ]
    return drawing(Scheme(BASE.costs, tasks, BASE.limits))


def tilting() -> Made:
    points = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.02, 0.03, 0.0], [0.0, 0.0, 0.01]]
    turns = np.eye(4)[[0, 0, 0, 0]]
    turns[1:3, [1, 2]] = np.diag([0.02, 0.03])
    path = iiwa_dnn.Waypoints([0.0, 0.5, 1.0, 1.5], points, "clamped", turns)
    return drawing(path=iiwa_dnn.Tilting(path))


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


class SaddleFlow(Network):
    """A network of one's own in compiled code, for programs without inequality rows."""

    compiled_rates = staticmethod(damped_rates)


def own_network() -> Made:
    solver = iiwa_dnn.DNNSolver(SaddleFlow(), follower=ExplicitEuler(substeps=20))
    return drawing(mode="continuous", dt=1e-4, solver=solver)


SETTINGS: dict[str, Callable[[], Made]] = {
    "inertia, velocity limits active": at_limits,
    "collisions with balls": among_balls,
    "collisions with itself, a box, a floor": lambda: drawing(
        with_limits(
            CollisionAvoidance(
                [
                    iiwa_dnn.Box((0.75, 0.0, 0.2), (0.1, 0.1, 0.1)),
                    iiwa_dnn.HalfSpace((0.0, 0.0, 1.0), -0.3),
                ]
            )
        )
    ),
    "two arms": two_arms,
    "other tasks": other_tasks,
    "block form, next target, cone": lambda: drawing(
        DoubleIndicator(orientation="block", tracking="next"), iiwa_dnn.Cone()
    ),
    "continuous": lambda: drawing(mode="continuous", dt=1e-4),
    "tilting poses": tilting,
    "ur5": lambda: drawing(robot=iiwa_dnn.load_robot("ur5")),
    "a network of one's own": own_network,
    "without a solution: slow": lambda: without_solution("slow"),
    "without a solution: relax": lambda: without_solution("relax"),
    "without a solution: stop": lambda: without_solution("stop"),
    "yielding to acceleration and jerk": lambda: drawing(
        with_limits(AccelerationLimits(2.0), JerkLimits(50.0)), iiwa_dnn.Circle()
    ),
}
"""Functions that make each controller, by its name."""
