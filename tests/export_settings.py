"""Controllers of every kind that is exported, each with the posture where it begins."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

import iiwa_dnn
from iiwa_dnn import Controller, DoubleIndicator, Limit, Reference, Robot, Scheme, Task
from iiwa_dnn.checks import Array
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators import ExplicitEuler
from iiwa_dnn.qp.layout import QPViews
from iiwa_dnn.studies.runs import paper_robot

Made = tuple[Controller, Array]

BALLS = ([0.36, 0.16, 0.64], [0.7, 0.0, 0.3], [-0.3, 0.5, 0.6])
RADII = (0.05, 0.1, 0.1)  # [m]
DISTANCE = 0.03  # [m]
DT = 1e-3  # [s]


def drawing(
    scheme: Scheme | None = None,
    path: Reference | None = None,
    robot: Robot | None = None,
    mode: str = "converged",
    dt: float = DT,
) -> Made:
    """Return a controller that draws a path, by default the heart with the paper's arm."""
    arm = paper_robot() if robot is None else robot
    q0 = arm.start_posture()
    start = iiwa_dnn.Configuration(arm, q0)
    reference = (iiwa_dnn.Heart() if path is None else path).anchored(start)
    scheme = DoubleIndicator() if scheme is None else scheme
    return Controller(arm, scheme, reference, dt=dt, mode=mode), q0


def with_parts(tasks: tuple[Task, ...] = (), limits: tuple[Limit, ...] = ()) -> Scheme:
    base = DoubleIndicator()
    return Scheme(base.costs, [*base.tasks, *tasks], [*base.limits, *limits])


def among_balls() -> Made:
    balls = list(map(iiwa_dnn.Sphere, BALLS, RADII))
    avoidance = iiwa_dnn.CollisionAvoidance(balls, self_collision=False, distance=DISTANCE)
    return drawing(with_parts(limits=(avoidance,)))


def among_boxes() -> Made:
    box = iiwa_dnn.Box((0.75, 0.0, 0.2), (0.1, 0.1, 0.1))
    floor = iiwa_dnn.HalfSpace((0.0, 0.0, 1.0), -0.3)
    return drawing(with_parts(limits=(iiwa_dnn.CollisionAvoidance([box, floor]),)))


def two_arms() -> Made:
    robot = iiwa_dnn.load_robot("iiwa7_dual")
    q0 = robot.start_posture()
    start = iiwa_dnn.Configuration(robot, q0)
    tips = ["left_iiwa7_flange", "right_iiwa7_flange"]
    base = DoubleIndicator()
    tasks = [replace(task, frame=name) for name in tips for task in base.tasks]
    paths = {name: iiwa_dnn.Heart().anchored(start.frame(name)) for name in tips}
    return Controller(robot, Scheme(base.costs, tasks, base.limits), paths, dt=DT), q0


def softly() -> Made:
    tasks = (
        iiwa_dnn.PostureTask({"iiwa7_joint_1": 0.1}, weight=0.05),
        iiwa_dnn.AxisTask(direction=(0.0, 0.0, -1.0), weight=0.01),
    )
    return drawing(with_parts(tasks))


def along_axis() -> Made:
    tasks = [iiwa_dnn.PositionTask(), iiwa_dnn.AxisTask()]
    coupling = iiwa_dnn.JointCouplingTask({"iiwa7_joint_1": 1.0, "iiwa7_joint_3": 1.0}, weight=0.01)
    base = DoubleIndicator()
    return drawing(Scheme(base.costs, [*tasks, coupling], base.limits))


def at_limits() -> Made:
    robot = paper_robot()
    velocity = robot.dq_max.copy()
    velocity[[0, 2]] = 0.105, 0.004
    return drawing(robot=robot.with_limits(velocity=velocity))


def with_rates() -> Made:
    limits = (iiwa_dnn.AccelerationLimits(10.0), iiwa_dnn.JerkLimits(500.0))
    return drawing(DoubleIndicator(extra_limits=limits), iiwa_dnn.Line((0.0, -0.1, 0.0)))


def through_points() -> Made:
    points = [[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.02, 0.03, 0.0], [0.0, 0.0, 0.01]]
    turns = np.eye(4)[[0, 0, 0, 0]]
    turns[1:3, [1, 2]] = np.diag([0.02, 0.03])
    path = iiwa_dnn.Waypoints([0.0, 0.5, 1.0, 1.5], points, "clamped", turns)
    return drawing(path=path)


def arm(name: str) -> Callable[[], Made]:
    return lambda: drawing(robot=iiwa_dnn.load_robot(name))


SETTINGS: dict[str, Callable[[], Made]] = {
    "heart": drawing,
    "velocity limits active": at_limits,
    "acceleration and jerk": with_rates,
    "collisions, 21 pairs": among_balls,
    "collisions with itself, a box, a floor": among_boxes,
    "two arms": two_arms,
    "soft tasks": softly,
    "axis and coupling": along_axis,
    "block form": lambda: drawing(DoubleIndicator(orientation="block")),
    "next target, cone": lambda: drawing(DoubleIndicator(tracking="next"), iiwa_dnn.Cone()),
    "continuous": lambda: drawing(mode="continuous", dt=1e-4),
    "poses": through_points,
    "panda": arm("panda"),
    "ur5": arm("ur5"),
}
"""Functions that make each controller, by its name."""


def without_solution(policy: str) -> Callable[[], Made]:

    def make() -> Made:
        robot = paper_robot()
        made = drawing(robot=robot.with_limits(velocity=0.045 * robot.dq_max))
        made[0].policy = policy
        return made

    return make


def yielding_with_rates() -> Made:
    limits = (iiwa_dnn.AccelerationLimits(2.0), iiwa_dnn.JerkLimits(50.0))
    return drawing(DoubleIndicator(extra_limits=limits), iiwa_dnn.Circle())


def braking_among_balls() -> Made:
    balls = list(map(iiwa_dnn.Sphere, BALLS, RADII))
    avoidance = iiwa_dnn.CollisionAvoidance(balls, self_collision=False, distance=DISTANCE)
    return drawing(
        with_parts(limits=(avoidance, iiwa_dnn.AccelerationLimits(5.0))), iiwa_dnn.Circle()
    )


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
        aim = min(max(state[i] - constants[0] * slope, qp.lb[i]), qp.ub[i])
        rates[i] = aim - state[i]
    for j in range(qp.b.size):
        missing = -qp.b[j]
        for i in range(n):
            missing += qp.A[j, i] * (state[i] + rates[i])
        rates[n + j] = missing


class SaddleFlow(Network):
    """A network of one's own in compiled code, for programs without inequality rows."""

    compiled_rates = staticmethod(damped_rates)

    def constants(self, sizes: tuple[int, int, int]) -> Array:
        """Return the length of the step towards x's aim, (1,)."""
        return np.array([0.5])

    def state_size(self, qp: iiwa_dnn.QP) -> int:
        """Count the states."""
        return int(qp.q.size + qp.b.size)


def own_network() -> Made:
    made = drawing(mode="continuous", dt=1e-4)
    made[0].solver = iiwa_dnn.DNNSolver(SaddleFlow(), follower=ExplicitEuler(substeps=20))
    return made


SETTINGS |= {
    "inertia": lambda: drawing(DoubleIndicator(kinetic="inertia")),
    "a network of one's own": own_network,
    "without a solution: slow": without_solution("slow"),
    "without a solution: relax": without_solution("relax"),
    "without a solution: stop": without_solution("stop"),
    "yielding to acceleration and jerk": yielding_with_rates,
    "braking among balls": braking_among_balls,
}
