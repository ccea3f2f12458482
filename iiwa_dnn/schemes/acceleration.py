r"""The acceleration level: schemes whose variable x is the joint acceleration.

After a control period the joints have the velocity :math:`\dot q + dt\,x`. The parts are those of
the velocity level, read anew:

* a **task** with the gain :math:`\delta` and the error e brings it to rest critically damped,

  .. math::  J x = a_d - \dot J \dot q + 2 \delta\,(v_d - J \dot q) + \delta^2 e ;

* **limits** bound the velocity after the period, :math:`lb \le \dot q + dt\,x \le ub` and
  :math:`G (\dot q + dt\,x) \le h`, at the positions :math:`\tilde q = q + \tfrac12 dt\,\dot q`. An
  acceleration that is held moves these by :math:`dt\,(\dot q + dt\,x)`, as a velocity does the
  joints at the velocity level, and q is always half-way between two of them: what a limit keeps
  there, it keeps here;
* **costs** weigh x: `KineticEnergy` is the norm of the acceleration. A motion that no task sees
  goes on for ever unless a cost damps it.

Sources: J. Y. S. Luh, M. W. Walker, R. P. C. Paul, "Resolved-acceleration control of mechanical
manipulators", IEEE Trans. Automatic Control 25 (1980); J. M. Hollerbach, K. C. Suh, "Redundancy
resolution of manipulators through torque optimization", IEEE J. Robotics and Automation 3 (1987).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.robot.kinematics import Kinematics
from iiwa_dnn.schemes.costs import KineticEnergy, WeightedCost
from iiwa_dnn.schemes.parts import Cost, Task
from iiwa_dnn.schemes.step import Step
from iiwa_dnn.schemes.tasks import OrientationTask, PositionTask

Level = Literal["velocity", "acceleration"]
LEVELS: tuple[Level, ...] = ("velocity", "acceleration")


@dataclass(frozen=True, kw_only=True)
class JointAcceleration(WeightedCost):
    r"""Joint acceleration, :math:`\tfrac12 w\,\|\ddot q + \lambda\,\dot q\|^2`.

    Attributes:
        weight: w, at least 0.
        damping: :math:`\lambda` [1/s], at least 0: rate at which motion that no task sees dies out.
    """

    damping: float = 5.0

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.not_negative("damping", self.damping)

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n) and q (n,)."""
        return self.weight * np.eye(step.q.size), self.weight * self.damping * step.dq


@dataclass(frozen=True, kw_only=True)
class JointTorque(WeightedCost):
    r"""Joint torque, :math:`\tfrac12 w\,\|\tau\|^2`, :math:`\tau = M \ddot q + h(q, \dot q)`.

    Alone it lets the joints race before long (the source in `iiwa_dnn.schemes.acceleration`); a
    `JointAcceleration` beside it keeps them in check.

    Attributes:
        weight: w, at least 0.
    """

    def quadratic(self, step: Step) -> tuple[Matrix, Vector]:
        """Return P (n, n) and q (n,)."""
        M = step.inertia
        return self.weight * M @ M, self.weight * M @ step.bias


def check_parts(costs: Sequence[Cost], tasks: Sequence[Task]) -> None:
    """Raise InvalidInputError unless the parts have a meaning at the acceleration level."""
    for cost in costs:
        if cost.is_compiled and not isinstance(cost, KineticEnergy):
            problem = f"{type(cost).__name__} is of the velocity level alone"
            raise InvalidInputError("costs", problem, cost)
    for task in tasks:
        known = isinstance(task, PositionTask | OrientationTask)
        if not known or task.tracking != "paper" or getattr(task, "form", "so3") != "so3":
            problem = "of the acceleration level are PositionTask and OrientationTask (so3), "
            problem += f"without tracking the next target, not {task!r}"
            raise InvalidInputError("tasks", problem, task)


def with_squared_gains(tasks: Sequence[Task]) -> list[Task]:
    r"""Return tasks of which the rows of the velocity level feed back :math:`\delta^2 e`."""
    position_or_turn: Any = tasks
    return [replace(task, gain=task.gain**2) for task in position_or_turn]


def damping_of(frames: Sequence[str], tasks: Sequence[tuple[str, Task]]) -> Vector:
    r"""Return :math:`2 \delta` of each tracked frame's twist, (6 frames,), from tasks by frame."""
    damping = np.zeros((len(frames), 6))
    for name, task in tasks:
        rows = slice(0, 3) if isinstance(task, PositionTask) else slice(3, 6)
        damping[frames.index(name), rows] = 2.0 * task.gain  # type: ignore[attr-defined]
    return damping.ravel()


def lift_targets(
    kinematics: Kinematics,
    frames: Sequence[str],
    damping: Vector,
    targets: Matrix,
    wanted: Vector,
    past: Matrix,
) -> Matrix:
    r"""Put :math:`a_d - \dot J \dot q + 2 \delta (v_d - J \dot q)` in the place of the twists.

    With the gain squared, the rows of the velocity level are then those of the acceleration level.

    Args:
        kinematics: Kinematics of the joint positions.
        frames: Names of the k tracked frames.
        damping: `damping_of`, (6 k,).
        targets: Their targets, (k, 18).
        wanted: Their accelerations, linear and angular, (6 k,).
        past: Joint positions [rad] and joint velocities [rad/s], (2 or more, n).

    Returns:
        The changed targets, (k, 18), a copy.
    """
    data = kinematics.data
    model = kinematics.robot.model
    pin.forwardKinematics(model, data, past[0], past[1], np.zeros(model.nv))
    lifted = targets.copy()
    for i, name in enumerate(frames):
        frame = kinematics.robot.frame_id(name)
        own = slice(6 * i, 6 * i + 6)
        axes = pin.LOCAL_WORLD_ALIGNED
        velocity = pin.getFrameVelocity(model, data, frame, axes).vector
        drift = pin.getFrameClassicalAcceleration(model, data, frame, axes).vector
        twist = lifted[i, 12:18]
        twist[:] = wanted[own] - drift + damping[own] * (twist - velocity)
    return lifted


def lower_limits(qp: QP, dq: Vector, dt: float) -> None:
    """Turn limits of the velocity after a period dt [s] into those of the change from dq (n,)."""
    n = dq.size
    for bound in (qp.lb, qp.ub):
        bound[:n] = (bound[:n] - dq) / dt
    qp.h[:] = (qp.h - qp.G[:, :n] @ dq) / dt
