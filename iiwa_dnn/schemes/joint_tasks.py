r"""Tasks of joints and of the whole arm: posture, coupling, elbow angle, centre of mass."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.frame_tasks import FeedbackTask
from iiwa_dnn.schemes.parts import Step


@dataclass(frozen=True)
class PostureTask(FeedbackTask):
    r"""Positions of some joints; one row a joint (`CyclicMotion` draws back all of them, softly).

    .. math::  \dot q_j = \delta\,(q_{d,j} - q_j)

    Attributes:
        joints: Desired positions by joint name [rad].
    """

    joints: Mapping[str, float]
    tracks: bool = field(default=False, init=False, repr=False)
    row_weight: float = field(default=0.1, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        joints = {name: checks.finite("joints", value) for name, value in self.joints.items()}
        self._set(joints=joints, rows=len(joints))

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        A, b = np.zeros((self.rows, step.q.size)), np.zeros(self.rows)
        for i, (name, wanted) in enumerate(self.joints.items()):
            j = _joint(step.robot, name)
            A[i, j], b[i] = 1.0, self.feedback(step) * (wanted - step.q[j])
        return A, b


@dataclass(frozen=True)
class JointCouplingTask(FeedbackTask):
    r"""One linear relation between joints, as of a gear or a mimic joint.

    .. math::  c^T \dot q = \delta\,(c_0 - c^T q)

    Attributes:
        coefficients: c by joint name.
        offset: c_0 [rad].
    """

    coefficients: Mapping[str, float]
    offset: float = 0.0
    tracks: bool = field(default=False, init=False, repr=False)
    rows: int = field(default=1, init=False, repr=False)
    row_weight: float = field(default=0.1, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.finite("offset", self.offset)
        given = self.coefficients.items()
        self._set(coefficients={name: checks.finite("coefficients", c) for name, c in given})

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (1, n) and b (1,)."""
        A = np.zeros((1, step.q.size))
        for name, coefficient in self.coefficients.items():
            A[0, _joint(step.robot, name)] = coefficient
        return A, self.feedback(step) * (self.offset - A @ step.q)


def couplings(robot: Robot) -> list[JointCouplingTask]:
    """Return the tasks that hold a robot's mimic joints to those they follow."""
    return [
        JointCouplingTask(coefficients={joint: 1.0, leader: -multiplier}, offset=offset)
        for joint, leader, multiplier, offset in robot.mimics
    ]


@dataclass(frozen=True)
class ElbowAngleTask(FeedbackTask):
    r"""Elbow (swivel) angle of an arm: of the plane shoulder, elbow, wrist about its long side.

    With w the unit vector from shoulder to wrist, u the elbow and l a reference direction, both
    seen from the shoulder, and :math:`(\cdot)_\perp` their parts normal to w, the angle from
    :math:`l_\perp` to :math:`u_\perp` about w changes by

    .. math::

        \dot\psi = \frac{w \cdot \bigl(u_\perp \times (\dot u - (w \cdot u)\,\dot w)\bigr)}
        {\|u_\perp\|^2} + \frac{w \cdot \bigl(l_\perp \times (w \cdot l)\,\dot w\bigr)}
        {\|l_\perp\|^2} = \delta\,(\psi_d - \psi)

    The angle does not exist where the arm is stretched or points along l.

    Source: K. Kreutz-Delgado, M. Long, H. Seraji, "Kinematic analysis of 7-DOF manipulators", Int.
    J. Robotics Research 11 (1992).

    Attributes:
        angle: Desired angle [rad]; None: the one where a run begins.
        joints: Names of the frames at shoulder, elbow and wrist; None: joints 2, 4 and 6.
        reference: Direction l in the world, (3,).
    """

    angle: float | None = None
    joints: tuple[str, str, str] | None = None
    reference: Sequence[float] = (0.0, 0.0, 1.0)
    tracks: bool = field(default=False, init=False, repr=False)
    rows: int = field(default=1, init=False, repr=False)
    row_weight: float = field(default=0.1, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.angle is not None:
            checks.finite("angle", self.angle)
        self._set(reference=checks.vector3("reference", self.reference))

    def anchored(self, conf: Configuration) -> ElbowAngleTask:
        """Return the task with the angle of `conf`, unless it has one already."""
        return self if self.angle is not None else replace(self, angle=self.angle_of(conf))

    def angle_of(self, conf: Configuration) -> float:
        """Compute the elbow angle of a configuration [rad], in (-pi, pi].

        Raises:
            InvalidInputError: The robot has not seven joints, and no frames are named.
        """
        shoulder, elbow, wrist = (conf.frame(name).position for name in self._names(conf.robot))
        return _swivel(elbow - shoulder, wrist - shoulder, np.array(self.reference))[0]

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (1, n) and b (1,)."""
        shoulder, elbow, wrist = (step.frame(name) for name in self._names(step.robot))
        u, d = elbow.position - shoulder.position, wrist.position - shoulder.position
        angle, by_elbow, by_wrist = _swivel(u, d, np.array(self.reference))
        moved = shoulder.jacobian[:3]
        A = by_elbow @ (elbow.jacobian[:3] - moved) + by_wrist @ (wrist.jacobian[:3] - moved)
        missing = 0.0 if self.angle is None else self.angle - angle
        missing = (missing + np.pi) % (2.0 * np.pi) - np.pi
        return A[np.newaxis], np.array([self.feedback(step) * missing])

    def _names(self, robot: Robot) -> tuple[str, str, str]:
        if self.joints is None and robot.dof != 7:
            problem = f"must name shoulder, elbow and wrist of a robot with {robot.dof} joints"
            raise InvalidInputError("joints", problem)
        names = robot.joint_names
        return self.joints or (names[1], names[3], names[5])


@dataclass(frozen=True)
class CenterOfMassTask(FeedbackTask):
    r"""Position of the arm's centre of mass along some axes of the world.

    .. math::  J_c \dot q = \delta\,(c_d - c)

    Attributes:
        position: Desired position [m], (3,); None: the one where a run begins.
        axes: Axes that are held, out of ``"xyz"``.
    """

    position: Sequence[float] | None = None
    axes: str = "xyz"
    tracks: bool = field(default=False, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.axes not in ("x", "y", "z", "xy", "xz", "yz", "xyz"):
            raise InvalidInputError("axes", f"must be letters out of xyz, not {self.axes!r}")
        if self.position is not None:
            self._set(position=checks.vector3("position", self.position))
        self._set(rows=len(self.axes))

    def anchored(self, conf: Configuration) -> CenterOfMassTask:
        """Return the task with the centre of mass of `conf`, unless it has one already."""
        if self.position is not None:
            return self
        place: Vector3 = checks.vector3("position", conf.center_of_mass[0])
        return replace(self, position=place)

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (rows, n) and b (rows,)."""
        conf = Configuration(step.robot, step.q)
        place, jacobian = conf.center_of_mass
        at = ["xyz".index(axis) for axis in self.axes]
        wanted = place if self.position is None else np.array(self.position)
        return jacobian[at], self.feedback(step) * (wanted - place)[at]


def _swivel(u: Vector, d: Vector, reference: Vector) -> tuple[float, Vector, Vector]:
    """Compute the angle about d (3,) from `reference` to u, and its gradients to u and d (3,)."""
    length = np.linalg.norm(d)
    w = d / length
    across, zero = u - w * (w @ u), reference - w * (w @ reference)
    angle = float(np.arctan2(w @ np.cross(zero, across), zero @ across))
    by_u = np.cross(w, across) / (across @ across)
    by_w = -(w @ u) * by_u + (w @ reference) * np.cross(w, zero) / (zero @ zero)
    return angle, by_u, (by_w - w * (w @ by_w)) / length


def _joint(robot: Robot, name: str) -> int:
    """Return a joint's place in q, or raise NotFoundError."""
    if name not in robot.joint_names:
        raise NotFoundError("joint", name, robot.joint_names)
    return robot.joint_names.index(name)
