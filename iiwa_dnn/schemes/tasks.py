r"""Tasks: equality rows A dq = b by which frames and joints of the arm follow their targets.

A frame at position p with orientation R moves with the twist :math:`[v;\, \omega] = J \dot q`. Its
target is :math:`p_d, R_d` with the twist :math:`[v_d;\, \omega_d]`. Each task brings an error to
zero exponentially, at the rate `gain`. With a ``weight`` w the rows become the cost
:math:`\tfrac12 w\,\|A \dot q - b\|^2`.

A gain above 1 / dt is cut to 1 / dt. With that gain and the target of the end of the control period
(`Reference.feed_forward`), the error after an Euler step is the curvature of the step alone,
:math:`\tfrac12 dt^2\,\dot q^T \nabla^2 p\,\dot q`, which does not accumulate.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, ClassVar, Literal

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import (
    column_of,
    combined,
    cross,
    dot,
    rotation_log,
    triple,
)
from iiwa_dnn.references.targets import Target, TargetData
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.robot.kinematics import Placement
from iiwa_dnn.schemes.parts import Task
from iiwa_dnn.schemes.step import (
    FrameConstants,
    StepViews,
    axis_at,
    seen_from,
    write_spin,
    write_velocity,
)

Orientation = Literal["so3", "block", "none"]

ROTATION_LENGTH = 0.5
"""Weight of 1 rad/s of error in a relaxed task, beside 1 m/s [m]: about the length of a forearm.

With a fifth of it, more arms rest at joint limits with the tip in place and the hand turned away;
with twice as much, no more arrive."""

VERTICAL = 1e-9
"""Sine of the angle between the tool's axis and the vertical up to which they are parallel."""


@compiled
def position_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A (3, n) and b (3,) of a frame's position relative to its base frame.

    `constants` begin with a `FrameConstants`.
    """
    own = FrameConstants.of(constants[: FrameConstants.width()])
    gain = min(own.gain, step.rate)
    base = Placement.of(step.placements[own.relative_to])
    point = triple(Placement.of(step.placements[own.frame]).position)
    offset = combined(1.0, point, -1.0, triple(base.position))
    for i in range(3):
        axis = triple(base.axes[i])
        missing = target.position[i] - dot(axis, offset)
        b[i] = target.linear_velocity[i] + gain * missing
        write_velocity(step, own, point, axis, A[i])


@compiled
def rotation_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A (3, n) and b (3,) of a frame's orientation relative to its base frame.

    `constants` begin with a `FrameConstants`.
    """
    own = FrameConstants.of(constants[: FrameConstants.width()])
    gain = min(own.gain, step.rate)
    base = Placement.of(step.placements[own.relative_to])
    placement = Placement.of(step.placements[own.frame])
    missing = np.empty((3, 3))
    error = np.empty(3)
    for i in range(3):
        for k in range(3):
            seen = seen_from(placement, triple(base.axes[k]))
            missing[i, k] = dot(triple(target.rotation[i]), seen)
    rotation_log(missing, error)
    for i in range(3):
        b[i] = target.angular_velocity[i] + gain * error[i]
        write_spin(step, own, triple(base.axes[i]), A[i])


@compiled
def block_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A (4, n) and b (4,) of an `OrientationTask` in the form ``block``."""
    own = FrameConstants.of(constants)
    gain = min(own.gain, step.rate)
    placement = Placement.of(step.placements[own.frame])
    for i in range(4):
        unit = (1.0, 0.0, 0.0) if i < 2 else (0.0, 1.0, 0.0)
        here = triple(placement.axes[i % 2])
        there = column_of(target.rotation, i % 2)
        b[i] = gain * dot(unit, combined(1.0, there, -1.0, here))
        b[i] += dot(cross(there, unit), triple(target.angular_velocity))
        write_spin(step, own, cross(here, unit), A[i])
    project_on_range(placement.axes, b)


@compiled
def project_on_range(axes: Matrix, b: Vector) -> None:
    """Project b (4,), in place, on the range of the matrix W of `OrientationTask`.

    Args:
        axes: Axes of the frame, one a row, (3, 3).
        b: The vector, overwritten.
    """
    x, y, _ = triple(axes[2])
    row = math.sqrt(axes[0, 2] * axes[0, 2] + axes[1, 2] * axes[1, 2])
    column = math.sqrt(x * x + y * y)
    normal = np.empty(4)
    along = 0.0
    for i in range(4):
        if row > VERTICAL:
            first = y if i < 2 else -x
            second = -axes[1, 2] if i % 2 == 0 else axes[0, 2]
            normal[i] = first * second / (row * column)
        else:
            first = -axes[i % 2, 1] if i < 2 else axes[i % 2, 0]
            normal[i] = first / math.sqrt(2.0)
        along += normal[i] * b[i]
    for i in range(4):
        b[i] = b[i] - along * normal[i] if row > VERTICAL else along * normal[i]


@compiled
def pose_rows(step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector) -> None:
    """Write A (6, n) and b (6,) of a frame's pose relative to its base frame, position first."""
    half = b.size // 2
    position_rows(step, constants, target, A[:half], b[:half])
    rotation_rows(step, constants, target, A[half:], b[half:])


class HeldPoseConstants(Record):
    """Constants of `RelativePoseTask`: those of a frame, and its desired pose at rest."""

    task: FrameConstants = part(FrameConstants)
    pose: TargetData = part(TargetData)


@compiled
def held_pose_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A (6, n) and b (6,) of a `RelativePoseTask`, whose pose is among the constants."""
    pose_rows(step, constants, HeldPoseConstants.of(constants).pose, A, b)


def feedback_gain(argument: str, value: float) -> float:
    """Return a gain of at least 0, which may be inf; refuse any other value."""
    return np.inf if value == np.inf else checks.not_negative(argument, value)


@dataclass(frozen=True, kw_only=True)
class GainTask(Task):
    """Base of tasks whose error decays exponentially.

    Attributes:
        gain: Rate at which the error decays [1/s], at least 0; above 1 / dt, as inf, it is cut to
            1 / dt.
        weight: None for hard rows, else the weight of the soft task, at least 0.
    """

    _checks: ClassVar[checks.Checks] = {"gain": feedback_gain, "weight": checks.not_negative}
    gain: float = 10.2
    weight: float | None = None


@dataclass(frozen=True, kw_only=True)
class FrameTask(GainTask):
    """Base of tasks of a frame.

    Attributes:
        frame: Name of the frame; None stands for the robot's tip.
    """

    frame: str | None = None

    @property
    def _base(self) -> str | None:
        """Name of the base frame, relative to which the frame moves; None stands for the world."""
        return getattr(self, "base", None)

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the name of the base frame, unless that is the world."""
        return () if self._base is None else (self._base,)

    def frame_constants(self, robot: Robot) -> FrameConstants:
        """Return the first constants of the task.

        Raises:
            NotFoundError: The robot does not have the frame or the base frame.
        """
        base = 0 if self._base is None else robot.frame_id(self._base)
        frame = robot.frame_id(self.frame_name(robot))
        return FrameConstants.make(frame=frame, gain=self.gain, relative_to=base)

    def constants(self, robot: Robot) -> Vector:
        """Return the task's constants, (k,)."""
        return self.frame_constants(robot)


@dataclass(frozen=True, kw_only=True)
class PositionTask(FrameTask):
    r"""Position of a frame, three rows.

    .. math::  J_p \dot q = v_d + \delta\,(p_d - p)

    Source: equation (2) of the paper.

    Attributes:
        gain: The paper's delta [1/s].
        weight: None for hard rows, else the weight of the soft task, at least 0.
        frame: Name of the frame; None stands for the robot's tip.
    """

    kernel = staticmethod(position_rows)
    rows = 3


@dataclass(frozen=True, kw_only=True)
class OrientationTask(FrameTask):
    r"""Orientation of a frame, in one of two forms.

    ``so3``: the angular velocity itself, three rows that lose nothing at any orientation,

    .. math::  J_\omega \dot q = \omega_d + \nu \log(R_d R^T)

    ``block``: the paper's four rows. With :math:`r = [R_{11}, R_{12}, R_{21}, R_{22}]`,

    .. math::  W(R)\,J_\omega \dot q = \dot r_d - \nu (r - r_d)

    where W follows from :math:`\dot R = [\omega]_\times R`: the row of :math:`R_{ij}` is
    :math:`(R e_j \times e_i)^T`. These rows have rank three at most, and where the tool's axis is
    vertical they lose the two tilts (docs/errata.md). Off the path the four contradict each other,
    at second order in the error: no velocity fulfils them all. The right-hand side is therefore
    projected on the range of W, which gives the rows their least-squares meaning and changes
    nothing at first order. Normal to that range is

    .. math::  u = [R_{23}, -R_{13}] \otimes [-R_{32}, R_{31}]

    or, where the tool's axis is vertical and u vanishes, all but the column of turning about it.

    Sources: equations (3) to (5) of the paper for ``block``; for ``so3`` F. Bullo and R. M. Murray,
    "Proportional derivative (PD) control on the Euclidean group", European Control Conference 1995.

    Attributes:
        gain: The paper's nu as a feedback gain [1/s].
        weight: None for hard rows, else the weight of the soft task, at least 0.
        frame: Name of the frame; None stands for the robot's tip.
        form: ``"so3"`` or ``"block"``.
    """

    kernel = staticmethod(rotation_rows)
    _checks: ClassVar[checks.Checks] = {"form": partial(checks.one_of, choices=("so3", "block"))}
    form: Literal["so3", "block"] = "so3"
    rows = 3
    row_weight = ROTATION_LENGTH

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.form == "block":
            self._set(kernel=block_rows, rows=4)


@dataclass(frozen=True, kw_only=True)
class PoseTask(FrameTask):
    r"""Position and orientation of a frame, six rows.

    .. math::  J \dot q = [v_d + \delta (p_d - p);\; \omega_d + \delta \log(R_d R^T)]
    """

    kernel = staticmethod(pose_rows)
    rows = 6


@dataclass(frozen=True)
class RelativePoseTask(FrameTask):
    r"""Pose of one frame relative to another, six rows.

    With the base frame at :math:`p_1, R_1` and the frame at :math:`p_2, R_2`, the relative position
    :math:`r = R_1^T (p_2 - p_1)` and orientation :math:`R = R_1^T R_2` obey

    .. math::

        R_1^T \bigl(v_2 - v_1 - \omega_1 \times (p_2 - p_1)\bigr) = \delta\,(r_d - r), \qquad
        R_1^T (\omega_2 - \omega_1) = \delta \log(R_d R^T)

    Attributes:
        frame: Name of the frame.
        base: Name of the base frame.
        pose: Desired pose in the base frame as a homogeneous matrix, (4, 4); None: the one with
            which a run begins.
    """

    kernel = staticmethod(held_pose_rows)
    _checks: ClassVar[checks.Checks] = {
        "pose": lambda name, pose: tuple(
            map(tuple, checks.finite_array(name, pose, (4, 4)).tolist())
        )
    }
    frame: str = field()
    base: str = field()
    pose: tuple[tuple[float, ...], ...] | None = None
    tracks = False
    rows = 6

    def anchored(self, conf: Configuration) -> "RelativePoseTask":
        """Return the task with the relative pose of `conf`, or the task itself if it has a pose."""
        if self.pose is not None:
            return self
        pose = np.linalg.inv(conf.frame(self.base).pose) @ conf.frame(self.frame).pose
        return replace(self, pose=pose.tolist())

    def constants(self, robot: Robot) -> Vector:
        """Return `HeldPoseConstants`."""
        pose = np.eye(4) if self.pose is None else np.array(self.pose)
        target = Target(pose[:3, 3], pose[:3, :3]).data
        return HeldPoseConstants.make(task=self.frame_constants(robot), pose=target)


class AxisConstants(Record):
    """Constants of `AxisTask`.

    Attributes:
        task: Frame and gain.
        axis: The axis in the frame's own coordinates.
        normals: Two directions normal to it and to each other.
        direction: Desired direction in the world; zero: the axis as the target's rotation turns it.
    """

    task: FrameConstants = part(FrameConstants)
    axis: Vector = part(3)
    normals: Matrix = part(2, 3)
    direction: Vector = part(3)


@compiled
def axis_rows(step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector) -> None:
    """Write A (2, n) and b (2,) of an `AxisTask`."""
    own = AxisConstants.of(constants)
    placement = Placement.of(step.placements[own.task.frame])
    axis = triple(own.axis)
    spin = (0.0, 0.0, 0.0)
    wanted = triple(own.direction)
    if dot(wanted, wanted) == 0.0:
        spin = triple(target.angular_velocity)
        x = dot(triple(target.rotation[0]), axis)
        y = dot(triple(target.rotation[1]), axis)
        wanted = (x, y, dot(triple(target.rotation[2]), axis))
    here = axis_at(placement, axis)
    turn = cross(here, wanted)
    sine = np.sqrt(dot(turn, turn))
    angle = math.atan2(sine, dot(here, wanted))
    factor = angle / sine if sine > 1e-12 else 1.0
    rate = combined(1.0, spin, min(own.task.gain, step.rate) * factor, turn)
    for i in range(2):
        normal = axis_at(placement, triple(own.normals[i]))
        b[i] = dot(normal, rate)
        write_spin(step, own.task, normal, A[i])


@dataclass(frozen=True, kw_only=True)
class AxisTask(FrameTask):
    r"""Direction of one axis of a frame, about which the frame is free to spin; two rows.

    With the axis a, the desired direction :math:`a_d` at the angle :math:`\theta` from it and a
    basis U of the directions normal to a:

    .. math::  U^T J_\omega \dot q = U^T \bigl(\omega_d
        + \delta\,\theta\,\tfrac{a \times a_d}{\|a \times a_d\|}\bigr)

    Attributes:
        axis: The axis in the frame's own coordinates, (3,), of any length.
        direction: Desired direction in the world, (3,); None: the axis as the target's rotation
            turns it.
    """

    kernel = staticmethod(axis_rows)
    _checks: ClassVar[checks.Checks] = {"axis": checks.direction, "direction": checks.direction}
    axis: Sequence[float] = (0.0, 0.0, 1.0)
    direction: Sequence[float] | None = None
    rows = 2
    row_weight = ROTATION_LENGTH

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set(tracks=self.direction is None)

    def constants(self, robot: Robot) -> Vector:
        """Return `AxisConstants`."""
        direction = (0.0, 0.0, 0.0) if self.direction is None else self.direction
        return AxisConstants.make(
            task=self.frame_constants(robot),
            axis=self.axis,
            normals=_normals(self.axis),
            direction=direction,
        )


class RemoteCenterConstants(Record):
    """Constants of `RemoteCenterTask`.

    Attributes:
        task: Frame, gain, and the frame that carries the point as base frame.
        normals: Two directions normal to the shaft and to each other.
        point: The point relative to the origin of the base frame [m].
    """

    task: FrameConstants = part(FrameConstants)
    normals: Matrix = part(2, 3)
    point: Vector = part(3)


@compiled
def remote_center_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A (2, n) and b (2,) of a `RemoteCenterTask`."""
    own = RemoteCenterConstants.of(constants)
    placement = Placement.of(step.placements[own.task.frame])
    carrier = Placement.of(step.placements[own.task.relative_to])
    point = combined(1.0, triple(carrier.position), 1.0, triple(own.point))
    offset = combined(1.0, point, -1.0, triple(placement.position))
    for i in range(2):
        normal = axis_at(placement, triple(own.normals[i]))
        b[i] = min(own.task.gain, step.rate) * dot(normal, offset)
        write_velocity(step, own.task, point, normal, A[i])


@dataclass(frozen=True)
class RemoteCenterTask(FrameTask):
    r"""Remote centre of motion: a shaft along an axis of a frame goes through a point; two rows.

    With the point seen from the frame, :math:`s = R^T (c - p)`, and a basis U of the directions
    normal to the shaft, :math:`U^T s = 0` is kept:

    .. math::  U^T R^T \bigl(J_v - [c - p]_\times J_\omega - J_c\bigr) \dot q = \delta\, U^T s

    Along the optical axis of a camera this is a task to look at the point, :math:`J_c` being the
    point's own Jacobian where another frame carries it.

    Source: N. Aghakhani et al., "Task control with remote center of motion constraint for minimally
    invasive robotic surgery", ICRA 2013.

    Attributes:
        point: The point in the world [m], (3,), or the name of the frame whose origin it is.
        axis: The shaft in the frame's own coordinates, (3,), of any length.
        frame: Name of the frame; None stands for the robot's tip.
    """

    kernel = staticmethod(remote_center_rows)
    _checks: ClassVar[checks.Checks] = {
        "axis": checks.direction,
        "point": lambda name, at: at if isinstance(at, str) else checks.vector3(name, at),
    }
    point: Sequence[float] | str
    axis: Sequence[float] = (0.0, 0.0, 1.0)
    tracks = False
    rows = 2

    @property
    def _base(self) -> str | None:
        return self.point if isinstance(self.point, str) else None

    def constants(self, robot: Robot) -> Vector:
        """Return `RemoteCenterConstants`."""
        point = (0.0, 0.0, 0.0) if isinstance(self.point, str) else self.point
        return RemoteCenterConstants.make(
            task=self.frame_constants(robot), normals=_normals(self.axis), point=point
        )


def _normals(axis: Sequence[float]) -> Matrix:
    """Return two unit vectors normal to a unit vector (3,) and to each other, (2, 3)."""
    smallest = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, smallest)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)])


class JointConstants(Record):
    """Constants of a task of joints, whose rows are C dq = gain (c - C q).

    Attributes:
        gain: Rate at which the error decays [1/s].
        offsets: c [rad], (rows,).
        coefficients: C, row by row, (rows * n,).
    """

    gain: float
    offsets: Vector = part("rows")
    coefficients: Vector = part("entries")


@compiled
def joint_rows(
    step: StepViews, constants: Vector, target: TargetData, A: Matrix, b: Vector
) -> None:
    """Write A (rows, n) and b (rows,) of a task of joints."""
    own = JointConstants.of(constants, b.size)
    C = own.coefficients.reshape(b.size, step.q.size)
    gain = min(own.gain, step.rate)
    for i in range(b.size):
        missing = own.offsets[i]
        for j in range(step.q.size):
            A[i, j] = C[i, j]
            missing -= A[i, j] * step.q[j]
        b[i] = gain * missing


def numbers_of(argument: str, value: Any) -> dict[str, float]:
    """Return finite numbers by joint name; refuse any other value."""
    if not isinstance(value, Mapping):
        problem = "must be numbers by joint name: dict(zip(robot.joint_names, q))"
        raise InvalidInputError(argument, problem, value)
    return {name: checks.finite(argument, number) for name, number in value.items()}


class JointTask(GainTask):
    """Base of tasks with linear relations C q = c between joint positions."""

    kernel = staticmethod(joint_rows)
    tracks = False

    def _relations(self) -> list[tuple[Mapping[str, float], float]]:
        """Return for each relation its row of C by joint names, and its c [rad]."""
        raise NotImplementedError

    def row_count(self, robot: Robot) -> int:
        """Return the number of relations."""
        return len(self._relations())

    def constants(self, robot: Robot) -> JointConstants:
        """Return the constants of the task for a robot.

        Raises:
            NotFoundError: The robot has no joint of a name.
        """
        coefficients, offsets = zip(*self._relations(), strict=True)
        C = np.zeros((len(offsets), robot.dof))
        for row, named in zip(C, coefficients, strict=True):
            for name, coefficient in named.items():
                if name not in robot.joint_names:
                    raise NotFoundError("joint", name, robot.joint_names)
                row[robot.joint_names.index(name)] = coefficient
        return JointConstants.make(gain=self.gain, offsets=offsets, coefficients=C.ravel())


@dataclass(frozen=True)
class PostureTask(JointTask):
    r"""Desired positions of some joints, one row a joint; `CyclicMotion` is a cost for all of them.

    .. math::  \dot q_j = \delta\,(q_{d,j} - q_j)

    Attributes:
        joints: Desired positions by joint name [rad].
    """

    _checks: ClassVar[checks.Checks] = {"joints": numbers_of}
    row_weight = 0.1
    joints: Mapping[str, float]

    def _relations(self) -> list[tuple[Mapping[str, float], float]]:
        return [({name: 1.0}, position) for name, position in self.joints.items()]


@dataclass(frozen=True)
class JointCouplingTask(JointTask):
    r"""One linear relation between joints, for example of a gear or of joints that move as one.

    .. math::  c^T \dot q = \delta\,(c_0 - c^T q)

    Policies never relax it, as a linkage cannot be pulled apart. If joints begin off the relation,
    they approach it as fast as the limits admit, but not while the arm brakes.

    Attributes:
        coefficients: c by joint name.
        offset: c_0 [rad].
    """

    _checks: ClassVar[checks.Checks] = {"coefficients": numbers_of, "offset": checks.finite}
    row_weight = 0.0
    coefficients: Mapping[str, float]
    offset: float = 0.0

    def _relations(self) -> list[tuple[Mapping[str, float], float]]:
        return [(self.coefficients, self.offset)]

    def error(self, robot: Robot, q: Vector) -> float:
        """Compute the error c_0 - c^T q [rad] of the relation at joint positions q (n,)."""
        own = self.constants(robot)
        return float(own.offsets[0] - own.coefficients @ q)
