"""Known paths at their quickest: a joint path timed anew, and its file for a robot's controller.

The geometric path stays; toppra chooses the speed along it, as high as the limits of velocity and
acceleration allow everywhere. Source: H. Pham, Q.-C. Pham, "A new approach to time-optimal path
parameterization based on reachability analysis", IEEE Transactions on Robotics 34 (2018).
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import checks
from iiwa_dnn.errors import FileError, InvalidInputError, import_extra
from iiwa_dnn.files import one_line, write_csv
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.references import Reference
from iiwa_dnn.results.metrics import limits
from iiwa_dnn.results.record import Record
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes import DoubleIndicator, Scheme
from iiwa_dnn.simulation.runner import simulate

_ON_PATH = 1e-6  # largest difference between the spline and a record [rad]


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Joint positions over time, with their two derivatives.

    Attributes:
        t: Times [s], (N+1,), increasing from 0.
        q: Joint positions [rad], (N+1, n).
        dq: Joint velocities [rad/s], (N+1, n).
        ddq: Joint accelerations [rad/s^2], (N+1, n).

    Raises:
        InvalidInputError: A value is not finite or of a wrong shape, the times do not increase, or
            positions and velocities contradict each other.
    """

    t: Vector
    q: Matrix
    dq: Matrix
    ddq: Matrix

    def __post_init__(self) -> None:
        times = checks.finite_array("t", self.t, (-1,))
        object.__setattr__(self, "t", times)
        shape = (len(times), *np.shape(self.q)[-1:])
        for name in ("q", "dq", "ddq"):
            array = checks.finite_array(name, getattr(self, name), shape)
            object.__setattr__(self, name, array)
        if len(times) < 2 or not (np.diff(times) > 0.0).all():
            raise InvalidInputError("t", "must hold two times at least, increasing", times)
        h = np.diff(times)[:, None]
        moved = 0.5 * h * (self.dq[1:] + self.dq[:-1])
        # The trapezoid's error where the acceleration jumps from one extreme to the other.
        allowed = 0.5 * h**2 * np.abs(self.ddq).max() + 1e-9
        if (np.abs(np.diff(self.q, axis=0) - moved) > allowed).any():
            raise InvalidInputError("dq", "is not the rate of q", self.dq)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write a CSV file, ``t,q1,...,dq1,...,ddq1,...``, all digits kept.

        Raises:
            FileError: The file cannot be written.
        """
        table = np.column_stack([self.t, self.q, self.dq, self.ddq])
        write_csv(path, _head(self.q.shape[1]), table)

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Trajectory:
        """Read a file written by `save`.

        Raises:
            FileError: The file cannot be read, or is not a trajectory.
        """
        try:
            with Path(path).open(encoding="utf-8") as file:
                head = file.readline().strip().split(",")
                if head != _head(len(head) // 3):
                    raise ValueError("the header must be t,q1,...,dq1,...,ddq1,...")
                table = np.loadtxt(file, delimiter=",", ndmin=2)
            return cls(table[:, 0], *np.split(table[:, 1:], 3, axis=1))
        except OSError as error:
            raise FileError(path, f"cannot be read ({one_line(error)})") from error
        except (ValueError, IndexError) as error:
            raise FileError(path, f"not a trajectory: {one_line(error)}") from error


def _head(joints: int) -> list[str]:
    return ["t", *(f"{name}{i + 1}" for name in ("q", "dq", "ddq") for i in range(joints))]


def retime(
    path: Record | Reference,
    acceleration: ArrayLike,
    velocity: ArrayLike | None = None,
    *,
    robot: Robot | None = None,
    q0: ArrayLike | None = None,
    scheme: Scheme | None = None,
    dt: float = 1e-3,
    points: int = 1000,
) -> Trajectory:
    """Compute the quickest timing of a joint path from rest to rest (extra ``retime``).

    Args:
        path: A run, whose joint path is taken; or a reference, of which a run is made first.
        acceleration: Largest joint accelerations [rad/s^2], a number or (n,).
        velocity: Largest joint velocities [rad/s], likewise; None: those of the run's robot.
        robot: Robot of a reference's run.
        q0: Joint positions at the start of a reference's run [rad], (n,); None: the robot's own.
        scheme: Scheme of a reference's run; None: the paper's, towards the next target.
        dt: Time between two samples of the result [s].
        points: Pieces in which the speed along the path is chosen; a rough path takes more.

    Returns:
        The trajectory. Its samples keep both limits.

    Raises:
        InvalidInputError: An argument is out of range, a reference's run is incomplete, or there is
            no timing within the limits.
        MissingDependencyError: toppra is not installed.
    """
    checks.positive("dt", dt)
    checks.integer("points", points, 10)
    record = path if isinstance(path, Record) else _run(path, robot, q0, scheme)
    fastest = limits(record, "dq_max") if velocity is None else velocity
    dq_max = _bound("velocity", fastest, record.dof)
    ddq_max = _bound("acceleration", acceleration, record.dof)
    trajectory = _optimum(record, dq_max, ddq_max, points)
    end = float(trajectory.duration)
    count = max(2, int(np.ceil(end / dt - 1e-9)))
    q, dq, ddq = (trajectory(np.linspace(0.0, end, count + 1), order) for order in range(3))
    dq[[0, -1]] = 0.0
    # Limits hold at toppra's grid, up to rounding; the samples between are slowed to keep them too.
    too_fast = np.abs(dq / dq_max).max()
    too_hard = np.sqrt(np.abs(ddq / ddq_max).max())
    slower = max(1.0, too_fast, too_hard, count * dt / end)
    times = np.linspace(0.0, slower * end, count + 1)
    return Trajectory(times, q, dq / slower, ddq / slower**2)


def _bound(name: str, value: ArrayLike, joints: int) -> Vector:
    """Return the limits of n joints, (n,), of one number or of n."""
    bound = np.broadcast_to(np.asarray(value, dtype=np.float64), (joints,))
    if not ((bound > 0.0) & np.isfinite(bound)).all():
        raise InvalidInputError(name, "must be finite and above 0", value)
    return bound


def _run(
    path: Reference, robot: Robot | None, q0: ArrayLike | None, scheme: Scheme | None
) -> Record:
    """Follow a reference and return the record, complete."""
    if robot is None:
        raise InvalidInputError("robot", "is missing: a reference needs a robot to follow it")
    start = robot.start_posture() if q0 is None else q0
    scheme = DoubleIndicator(tracking="next") if scheme is None else scheme
    record = simulate(robot, scheme, path, start, dt=1e-3, check=CrossCheck(()))
    if record.path_completed < 1.0:
        raise InvalidInputError("path", f"the robot cannot follow it at its own speed: {record}")
    return record


def _optimum(record: Record, velocity: Vector, acceleration: Vector, points: int) -> Any:
    """Fit a spline to the joint path and let toppra time it; return its trajectory."""
    toppra = import_extra("toppra", "pip install 'iiwa-dnn[retime]'")
    limit = toppra.constraint
    # The clock of the path: where a policy slowed it down, the path is not longer for that.
    factor = np.ones(record.steps) if record.fraction is None else record.fraction
    clock = np.concatenate([[0.0], np.cumsum(factor * np.diff(record.t))])
    moves = np.concatenate([[True], np.diff(clock) > 1e-3 * np.diff(record.t)])
    clock = clock[moves]
    q = record.q[moves]
    if len(clock) < 3 or not np.ptp(q, axis=0).max() > 0.0:
        raise InvalidInputError("path", "the arm does not move on it", record)
    while True:
        knots = np.unique(np.linspace(0, len(clock) - 1, points + 1).round().astype(int))
        spline = toppra.SplineInterpolator(clock[knots], q[knots])
        if np.abs(spline(clock) - q).max() < _ON_PATH or len(knots) == len(clock):
            break
        points *= 2
    at_nodes = limit.DiscretizationType.Interpolation
    constraints = [
        limit.JointVelocityConstraint(np.outer(velocity, [-1.0, 1.0])),
        limit.JointAccelerationConstraint(np.outer(acceleration, [-1.0, 1.0]), at_nodes),
    ]
    fine = np.linspace(clock[0], clock[-1], max(points, len(knots) - 1) + 1)
    for grid in (fine, None):  # on a fine grid toppra may fail by rounding: then its own
        problem = toppra.algorithm.TOPPRA(
            constraints, spline, gridpoints=grid, parametrizer="ParametrizeConstAccel"
        )
        trajectory = problem.compute_trajectory(0.0, 0.0)
        if trajectory is not None:
            return trajectory
    raise InvalidInputError("acceleration", "toppra finds no timing within the limits")
