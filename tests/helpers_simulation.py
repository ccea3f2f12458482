"""The paper's experiment in small: robot, start, reference, and short runs of it."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from helpers_kinematics import PAPER_Q0
from iiwa_dnn.control.command import Command
from iiwa_dnn.control.controller import Controller
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.program import QP
from iiwa_dnn.references import Heart, Reference, Target
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Configuration, Robot, load_robot
from iiwa_dnn.schemes import (
    Cost,
    DoubleIndicator,
    JointLimits,
    KineticEnergy,
    Limit,
    OrientationTask,
    PositionTask,
    Scheme,
    Task,
)
from iiwa_dnn.simulation import simulate

UNCHECKED = CrossCheck(())


@cache
def paper_robot() -> Robot:
    """The iiwa 7 with the paper's position limits."""
    return load_robot("iiwa7").with_limits(lower=-2.5, upper=2.5)


@cache
def paper_start() -> Configuration:
    """The paper's theta(0)."""
    return Configuration(paper_robot(), PAPER_Q0)


def heart(period: float = 10.0) -> Reference:
    """The heart from the paper's start; a short period makes a short run of a whole one."""
    return Heart(period=period).anchored(paper_start())


def near_target(q: ArrayLike, seed: int, size: float = 0.1) -> Target:
    """A target near the pose at q, in motion in every direction."""
    rng = np.random.default_rng(seed)
    pose = Configuration(paper_robot(), np.asarray(q) + size * rng.standard_normal(7))
    return Target(
        pose.position, pose.rotation, size * rng.standard_normal(3), size * rng.standard_normal(3)
    )


def run(
    scheme: Scheme | None = None,
    reference: Reference | None = None,
    robot: Robot | None = None,
    **options: Any,
) -> Record:
    """A run from the paper's start, by default of 0.05 s at 1e-3 s and without a cross-check."""
    return simulate(
        robot or paper_robot(),
        scheme or DoubleIndicator(),
        reference or heart(),
        PAPER_Q0,
        **{"dt": 1e-3, "duration": 0.05, "check": UNCHECKED} | options,
    )


def driven(
    controller: Controller, q: ArrayLike, steps: int, target: Any = None
) -> tuple[NDArray[np.float64], list[Command]]:
    """Follow a controller to a target, or to that of each time; the path (steps + 1, n) from q."""
    path = [np.array(q)]
    commands = []
    for k in range(steps):
        t = k * controller.dt
        commands.append(controller.step(path[-1], t, target(t) if callable(target) else target))
        path.append(path[-1] + controller.dt * commands[-1].dq)
    return np.array(path), commands


def rows_of(part: Any, conf: Configuration, target: Target | None = None, **options: Any) -> QP:
    """The program of one limit or task alone; by default the tip is to stay where it is."""
    kind = "limits" if isinstance(part, Limit) else "tasks"
    target = target or Target(conf.position, conf.rotation)
    return Scheme(**{kind: [part]}).build_qp(conf, target, **options)


def own(kind: type[Any], rows: int = 0, **answers: Any) -> Any:
    """A part of one's own, an `Own`, each of whose methods has one answer."""
    methods = {name: lambda self, step, it=answer: it for name, answer in answers.items()}
    return type("Own", (kind,), {"rows": rows, "tracks": False, **methods})()


def beside(part: Any) -> Scheme:
    """A scheme of the tip's position with one more part."""
    tasks = [PositionTask(), *[part] * isinstance(part, Task)]
    limits = [JointLimits(), *[part] * isinstance(part, Limit)]
    return Scheme([KineticEnergy(), *[part] * isinstance(part, Cost)], tasks, limits)


def fixed(qp: QP) -> Scheme:
    """A scheme with one program, whatever the instant is."""
    _, m, p = qp.sizes
    cost = own(Cost, quadratic=(qp.P, qp.q))
    task = own(Task, p, equations=(qp.A, qp.b))
    return Scheme([cost], [task], [own(Limit, m, inequalities=(qp.G, qp.h), bounds=(qp.lb, qp.ub))])


def orientation_rows(
    form: str, conf: Configuration, target: Target, gain: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Rows and right-hand side of the orientation task alone."""
    qp = rows_of(OrientationTask(gain=gain, form=form), conf, target)
    return qp.A, qp.b


def block_vector(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """The paper's r: the upper left 2x2 block of a rotation, row by row, (4,)."""
    return rotation[:2, :2].reshape(4)


def block_map(rotation: NDArray[np.float64]) -> NDArray[np.float64]:
    """W(R), (4, 3): the rate of `block_vector` is W(R) times the angular velocity."""
    columns = [rotation[:, 0], rotation[:, 1], rotation[:, 0], rotation[:, 1]]
    return np.cross(columns, np.eye(3)[[0, 0, 1, 1]])
