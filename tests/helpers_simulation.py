"""The paper's experiment in small: robot, start, reference, and short runs of it."""

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import iiwa_dnn as d
from helpers_kinematics import PAPER_Q0
from iiwa_dnn.schemes.joint_limits import MotionConstants

UNCHECKED = d.CrossCheck(())


@cache
def paper_robot() -> d.Robot:
    """The iiwa 7 with the paper's position limits."""
    return d.load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)


@cache
def paper_start() -> d.Configuration:
    """The paper's theta(0)."""
    return d.Configuration(paper_robot(), PAPER_Q0)


def limits_of_joints(
    lower: float,
    upper: float,
    velocity: float,
    acceleration: float,
    jerk: float,
    varying: tuple[float, float] = (0.0, np.inf),
    joints: int = 1,
) -> MotionConstants:
    """Limits of joints that are alike; offset and deceleration of the position-dependent ones."""
    own = [lower, upper, velocity, acceleration, jerk, *varying]
    head = [0.0, True, jerk < np.inf, *[0.0] * 4]
    return MotionConstants.of(np.concatenate([head, np.repeat(own, joints)]))


def heart(period: float = 10.0) -> d.Reference:
    """The heart from the paper's start; a short period makes a short run of a whole one."""
    return d.Heart(period=period).anchored(paper_start())


def near_target(q: ArrayLike, seed: int, size: float = 0.1) -> d.Target:
    """A target near the pose at q, in motion in every direction."""
    rng = np.random.default_rng(seed)
    pose = d.Configuration(paper_robot(), np.asarray(q) + size * rng.standard_normal(7))
    return d.Target(
        pose.position, pose.rotation, size * rng.standard_normal(3), size * rng.standard_normal(3)
    )


def run(
    scheme: d.Scheme | None = None,
    reference: d.Reference | None = None,
    robot: d.Robot | None = None,
    **options: Any,
) -> d.Record:
    """A run from the paper's start, by default of 0.05 s at 1e-3 s and without a cross-check."""
    return d.simulate(
        robot or paper_robot(),
        scheme or d.DoubleIndicator(),
        reference or heart(),
        PAPER_Q0,
        **{"dt": 1e-3, "duration": 0.05, "check": UNCHECKED} | options,
    )


def driven(
    controller: d.Controller, q: ArrayLike, steps: int, target: Any = None
) -> tuple[NDArray[np.float64], list[d.Command]]:
    """Follow a controller to a target, or to that of each time; the path (steps + 1, n) from q."""
    path = [np.array(q)]
    commands = []
    for k in range(steps):
        t = k * controller.dt
        commands.append(controller.step(path[-1], t, target(t) if callable(target) else target))
        path.append(commands[-1].next_q)
    return np.array(path), commands


def rows_of(part: Any, conf: d.Configuration, target: Any = None, **options: Any) -> d.QP:
    """The program of one limit or task alone; by default the tip is to stay where it is."""
    kind = "limits" if isinstance(part, d.Limit) else "tasks"
    target = target or d.Target(conf.position, conf.rotation)
    return d.Scheme(**{kind: [part]}).build_qp(conf, target, **options)


def own(kind: type[Any], rows: int = 0, **answers: Any) -> Any:
    """A part of one's own, an `Own`, each of whose methods has one answer."""
    methods = {name: lambda self, step, it=answer: it for name, answer in answers.items()}
    return type("Own", (kind,), {"rows": rows, "tracks": False, **methods})()


def beside(part: Any) -> d.Scheme:
    """A scheme of the tip's position with one more part."""
    tasks = [d.PositionTask(), *[part] * isinstance(part, d.Task)]
    limits = [d.JointLimits(), *[part] * isinstance(part, d.Limit)]
    return d.Scheme([d.KineticEnergy(), *[part] * isinstance(part, d.Cost)], tasks, limits)


def fixed(qp: d.QP) -> d.Scheme:
    """A scheme with one program, whatever the instant is."""
    _, m, p = qp.sizes
    cost = own(d.Cost, quadratic=(qp.P, qp.q))
    task = own(d.Task, p, equations=(qp.A, qp.b))
    limit = own(d.Limit, m, inequalities=(qp.G, qp.h), bounds=(qp.lb, qp.ub))
    return d.Scheme([cost], [task], [limit])


def block_vector(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """The paper's r: the upper left 2x2 block of a rotation, row by row, (4,)."""
    return rotation[:2, :2].reshape(4)


def block_map(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """W(R), (4, 3): the rate of `block_vector` is W(R) times the angular velocity."""
    columns = [rotation[:, 0], rotation[:, 1], rotation[:, 0], rotation[:, 1]]
    return np.cross(columns, np.eye(3)[[0, 0, 1, 1]])
