r"""Tasks of joints and of the whole arm: posture, coupling, elbow angle, centre of mass."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pinocchio as pin

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.references.rotations import added, combined, cross, dot, scaled
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.frame_tasks import FeedbackTask
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.schemes.tasks import axis_at, gain_of, joint_velocity, vector_at


@compiled
def posture_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `PostureTask`."""
    for i in range(b.size):
        joint = int(constants[3 + 2 * i])
        A[i, joint] = 1.0
        b[i] = gain_of(step, constants) * (constants[4 + 2 * i] - step.q[joint])


@dataclass(frozen=True)
class PostureTask(FeedbackTask):
    r"""Positions of some joints; one row a joint (`CyclicMotion` draws back all of them, softly).

    .. math::  \dot q_j = \delta\,(q_{d,j} - q_j)

    Attributes:
        joints: Desired positions by joint name [rad].
    """

    kernel = staticmethod(posture_rows)
    joints: Mapping[str, float]
    tracks: bool = field(default=False, init=False, repr=False)
    row_weight: float = field(default=0.1, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        given: Any = self.joints
        if not isinstance(given, Mapping):
            problem = "must be positions by joint name: dict(zip(robot.joint_names, q))"
            raise InvalidInputError("joints", problem, given)
        joints = {name: checks.finite("joints", value) for name, value in given.items()}
        self._set(joints=joints, rows=len(joints))

    def constants(self, robot: Robot) -> Vector:
        """Return gain, then index and desired position of each joint, (3 + 2 rows,)."""
        pairs = [(_joint(robot, name), wanted) for name, wanted in self.joints.items()]
        return self._with(robot, pairs)


@compiled
def coupling_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the row of `JointCouplingTask`."""
    missing = constants[3]
    for j in range(step.q.size):
        A[0, j] = constants[4 + j]
        missing -= constants[4 + j] * step.q[j]
    b[0] = gain_of(step, constants) * missing


@dataclass(frozen=True)
class JointCouplingTask(FeedbackTask):
    r"""One linear relation between joints, as of a gear or a mimic joint.

    .. math::  c^T \dot q = \delta\,(c_0 - c^T q)

    It is a limit where the tasks yield: a linkage is not pulled apart.

    Attributes:
        coefficients: c by joint name.
        offset: c_0 [rad].
    """

    kernel = staticmethod(coupling_rows)
    coefficients: Mapping[str, float]
    offset: float = 0.0
    tracks: bool = field(default=False, init=False, repr=False)
    rows: int = field(default=1, init=False, repr=False)
    row_weight: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.finite("offset", self.offset)
        given = self.coefficients.items()
        self._set(coefficients={name: checks.finite("coefficients", c) for name, c in given})

    def constants(self, robot: Robot) -> Vector:
        """Return gain, offset and the coefficient of each joint, (4 + n,)."""
        row = np.zeros(robot.dof)
        for name, coefficient in self.coefficients.items():
            row[_joint(robot, name)] = coefficient
        return self._with(robot, self.offset, row)


def couplings(robot: Robot) -> list[JointCouplingTask]:
    """Return the tasks that hold a robot's mimic joints to those they follow."""
    return [
        JointCouplingTask(coefficients={joint: 1.0, leader: -multiplier}, offset=offset)
        for joint, leader, multiplier, offset in robot.mimics
    ]


@compiled
def swivel_angle(u: Vector3, d: Vector3, reference: Vector3) -> tuple[float, Vector3, Vector3]:
    """Compute the angle about d from a reference direction to u, and its gradients to u and d."""
    length = np.sqrt(dot(d, d))
    w = scaled(1.0 / length, d)
    across = combined(1.0, u, -dot(w, u), w)
    zero = combined(1.0, reference, -dot(w, reference), w)
    angle = np.arctan2(dot(w, cross(zero, across)), dot(zero, across))
    by_u = scaled(1.0 / dot(across, across), cross(w, across))
    turned = scaled(dot(w, reference) / dot(zero, zero), cross(w, zero))
    by_w = combined(-dot(w, u), by_u, 1.0, turned)
    return angle, by_u, scaled(1.0 / length, combined(1.0, by_w, -dot(w, by_w), w))


@compiled
def elbow_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the row of `ElbowAngleTask`."""
    shoulder = int(constants[3])
    elbow = int(constants[4])
    wrist = int(constants[5])
    origin = vector_at(step.placements[shoulder], 9)
    middle = vector_at(step.placements[elbow], 9)
    end = vector_at(step.placements[wrist], 9)
    u = combined(1.0, middle, -1.0, origin)
    d = combined(1.0, end, -1.0, origin)
    angle, by_u, by_d = swivel_angle(u, d, vector_at(constants, 8))
    missing = (constants[7] - angle) * constants[6]
    missing -= 2.0 * np.pi * np.floor((missing + np.pi) / (2.0 * np.pi))
    b[0] = gain_of(step, constants) * missing
    both = added(by_u, by_d)
    for j in range(step.q.size):
        of_elbow = step.moves[elbow, j] * dot(by_u, joint_velocity(step, j, middle))
        of_wrist = step.moves[wrist, j] * dot(by_d, joint_velocity(step, j, end))
        of_shoulder = step.moves[shoulder, j] * dot(both, joint_velocity(step, j, origin))
        A[0, j] = of_elbow + of_wrist - of_shoulder


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

    kernel = staticmethod(elbow_rows)
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
        names = self._names(conf.robot)
        shoulder, elbow, wrist = (vector_at(conf.frame(name).position, 0) for name in names)
        upper = combined(1.0, elbow, -1.0, shoulder)
        whole = combined(1.0, wrist, -1.0, shoulder)
        direction = checks.vector3("reference", self.reference)
        return float(swivel_angle(upper, whole, direction)[0])

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of the frames at shoulder, elbow and wrist."""
        return self._names(robot)

    def constants(self, robot: Robot) -> Vector:
        """Return gain, indices of the frames, 1 with an angle or 0, angle and direction, (11,)."""
        frames = [robot.frame_id(name) for name in self._names(robot)]
        angle = 0.0 if self.angle is None else self.angle
        return self._with(robot, frames, self.angle is not None, angle, self.reference)

    def _names(self, robot: Robot) -> tuple[str, str, str]:
        if self.joints is None and robot.dof != 7:
            problem = f"must name shoulder, elbow and wrist of a robot with {robot.dof} joints"
            raise InvalidInputError("joints", problem)
        names = robot.joint_names
        return self.joints or (names[1], names[3], names[5])


@compiled
def center_of_mass_rows(
    step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector
) -> None:
    """Write the rows of `CenterOfMassTask`."""
    links = constants[10:].reshape((constants.size - 10) // 5, 5)
    total = 0.0
    for k in range(links.shape[0]):
        total += links[k, 1]
    center = (0.0, 0.0, 0.0)
    jacobian = np.zeros((3, step.q.size))
    for k in range(links.shape[0]):
        frame = int(links[k, 0])
        fraction = links[k, 1] / total
        placement = step.placements[frame]
        point = added(vector_at(placement, 9), axis_at(placement, vector_at(links[k], 2)))
        center = combined(1.0, center, fraction, point)
        for j in range(step.q.size):
            moved = scaled(fraction * step.moves[frame, j], joint_velocity(step, j, point))
            for i in range(3):
                jacobian[i, j] += moved[i]
    row = 0
    for i in range(3):
        if constants[7 + i] != 0.0:
            b[row] = gain_of(step, constants) * (constants[4 + i] - center[i]) * constants[3]
            for j in range(step.q.size):
                A[row, j] = jacobian[i, j]
            row += 1


@dataclass(frozen=True)
class CenterOfMassTask(FeedbackTask):
    r"""Position of the arm's centre of mass along some axes of the world.

    .. math::  J_c \dot q = \delta\,(c_d - c)

    Attributes:
        position: Desired position [m], (3,); None: the one where a run begins.
        axes: Axes that are held, out of ``"xyz"``.
    """

    kernel = staticmethod(center_of_mass_rows)
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

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the names of all joints' frames."""
        return tuple(robot.model.names[1:])

    def constants(self, robot: Robot) -> Vector:
        """Return gain, 1 with a position or 0, it, axes, and frame, mass, lever of each link."""
        model = robot.model
        position = np.zeros(3) if self.position is None else self.position
        held = [axis in self.axes for axis in "xyz"]
        links = [
            (model.getFrameId(name, pin.FrameType.JOINT), inertia.mass, *inertia.lever)
            for name, inertia in zip(model.names[1:], list(model.inertias)[1:], strict=True)
        ]
        return self._with(robot, self.position is not None, position, held, links)


def _joint(robot: Robot, name: str) -> int:
    """Return a joint's place in q, or raise NotFoundError."""
    if name not in robot.joint_names:
        raise NotFoundError("joint", name, robot.joint_names)
    return robot.joint_names.index(name)
