r"""Tasks of frames beyond position and orientation: pose, axis, relative pose, remote centre.

A frame at position p with orientation R moves with the twist :math:`[v;\, \omega] = J \dot q`.
Each task brings an error to zero at the rate `gain`; its Jacobian is written in closed form.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.references.rotations import combined, cross, dot, rotation_log, row_of
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.parts import Tracking
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.schemes.tasks import (
    ROTATION_LENGTH,
    GainTask,
    axis_at,
    gain_of,
    joint_spin,
    joint_velocity,
    position_rows,
    so3_rows,
    vector_at,
)

Rows = tuple[tuple[float, ...], ...]


@dataclass(frozen=True, kw_only=True)
class FeedbackTask(GainTask):
    """Base of tasks whose error decays.

    Attributes:
        gain: Rate at which the error decays [1/s], at least 0.
        weight: None for hard rows, else the weight of the soft task, at least 0.
        tracking: ``"paper"``, or ``"next"``: rows towards the next target.
        next_gain: Gain of ``"next"`` [1/s], as of `PositionTask`.
    """

    gain: float = 10.2
    weight: float | None = None
    tracking: Tracking = "paper"
    next_gain: float | None = None

    def _with(self, robot: Robot, *own: ArrayLike) -> Vector:
        """Return the constants of a `GainTask`, and further ones."""
        return np.concatenate([GainTask.constants(self, robot), *map(np.ravel, own)])


@compiled
def pose_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `PoseTask`, six."""
    position_rows(step, constants, target, A[:3], b[:3])
    so3_rows(step, constants, target, A[3:], b[3:])


@dataclass(frozen=True, kw_only=True)
class PoseTask(FeedbackTask):
    r"""Position and orientation of a frame, six rows.

    .. math::  J \dot q = [v_d + \delta (p_d - p);\; \omega_d + \delta \log(R_d R^T)]

    Attributes:
        frame: Name of the frame; None stands for the robot's tip.
    """

    kernel = staticmethod(pose_rows)
    frame: str | None = None
    rows: int = field(default=6, init=False, repr=False)


@compiled
def axis_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `AxisTask`, two."""
    frame = int(constants[0])
    placement = step.placements[frame]
    axis = vector_at(constants, 3)
    if constants[12] == 0.0:
        spin = vector_at(target, 15)
        wanted = (
            dot(row_of(target, 0), axis),
            dot(row_of(target, 1), axis),
            dot(row_of(target, 2), axis),
        )
    else:
        spin = (0.0, 0.0, 0.0)
        wanted = vector_at(constants, 13)
    here = axis_at(placement, axis)
    turn = cross(here, wanted)
    sine = np.sqrt(dot(turn, turn))
    angle = np.arctan2(sine, dot(here, wanted))
    factor = angle / sine if sine > 1e-12 else 1.0
    rate = combined(1.0, spin, gain_of(step, constants) * factor, turn)
    for i in range(2):
        normal = axis_at(placement, vector_at(constants, 6 + 3 * i))
        b[i] = dot(normal, rate)
        for j in range(step.q.size):
            A[i, j] = step.moves[frame, j] * dot(normal, joint_spin(step, j))


@dataclass(frozen=True, kw_only=True)
class AxisTask(FeedbackTask):
    r"""Direction of one axis of a frame, which stays free to spin about it; two rows.

    With the axis a, the desired direction :math:`a_d` at the angle :math:`\theta` from it and a
    basis U of the directions normal to a:

    .. math::  U^T J_\omega \dot q = U^T \bigl(\omega_d
        + \delta\,\theta\,\tfrac{a \times a_d}{\|a \times a_d\|}\bigr)

    Attributes:
        axis: The axis in the frame's own coordinates, (3,), of any length.
        direction: Desired direction in the world, (3,); None: the axis of the target's rotation.
        frame: Name of the frame; None stands for the robot's tip.
    """

    kernel = staticmethod(axis_rows)
    axis: Sequence[float] = (0.0, 0.0, 1.0)
    direction: Sequence[float] | None = None
    frame: str | None = None
    rows: int = field(default=2, init=False, repr=False)
    row_weight: float = field(default=ROTATION_LENGTH, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set(axis=checks.direction("axis", self.axis))
        if self.direction is not None:
            self._set(direction=checks.direction("direction", self.direction), tracks=False)

    def constants(self, robot: Robot) -> Vector:
        """Return gain, axis, two normals of it, and 1 with a fixed direction or 0, (16,)."""
        fixed = (0.0, 0.0, 0.0, 0.0) if self.direction is None else (1.0, *self.direction)
        return self._with(robot, self.axis, _normals(self.axis).T, fixed)


@compiled
def relative_pose_rows(
    step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector
) -> None:
    """Write the rows of `RelativePoseTask`, six."""
    frame = int(constants[0])
    base = int(constants[3])
    gain = gain_of(step, constants)
    first = step.placements[base]
    second = step.placements[frame]
    point = vector_at(second, 9)
    between = combined(1.0, point, -1.0, vector_at(first, 9))
    for i in range(3):
        axis = vector_at(first, 3 * i)
        b[i] = gain * (constants[5 + i] - dot(axis, between)) * constants[4]
        for j in range(step.q.size):
            sign = step.moves[frame, j] - step.moves[base, j]
            A[i, j] = sign * dot(axis, joint_velocity(step, j, point))
            A[3 + i, j] = sign * dot(axis, joint_spin(step, j))
    relative = np.empty((3, 3))
    for i in range(3):
        for k in range(3):
            relative[i, k] = 0.0
            for j in range(3):
                turned = dot(vector_at(first, 3 * k), vector_at(second, 3 * j))
                relative[i, k] += constants[8 + 3 * i + j] * turned
    error = np.empty(3)
    rotation_log(relative, error)
    for i in range(3):
        b[3 + i] = gain * error[i] * constants[4]


@dataclass(frozen=True)
class RelativePoseTask(FeedbackTask):
    r"""Pose of one frame as seen from another, six rows.

    With the base frame at :math:`p_1, R_1` and the frame at :math:`p_2, R_2`, the relative position
    :math:`r = R_1^T (p_2 - p_1)` and orientation :math:`R = R_1^T R_2` obey

    .. math::

        R_1^T \bigl(v_2 - v_1 - \omega_1 \times (p_2 - p_1)\bigr) = \delta\,(r_d - r), \qquad
        R_1^T (\omega_2 - \omega_1) = \delta \log(R_d R^T)

    Attributes:
        frame: Name of the frame.
        base: Name of the frame that it is seen from.
        pose: Desired pose as a homogeneous matrix, (4, 4); None: the one where a run begins.
    """

    kernel = staticmethod(relative_pose_rows)
    frame: str
    base: str
    pose: Rows | None = None
    tracks: bool = field(default=False, init=False, repr=False)
    rows: int = field(default=6, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.pose is not None:
            pose = checks.finite_array("pose", self.pose, (4, 4))
            self._set(pose=tuple(map(tuple, pose.tolist())))

    def anchored(self, conf: Configuration) -> RelativePoseTask:
        """Return the task with the relative pose of `conf`, unless it has one already."""
        if self.pose is not None:
            return self
        pose = np.linalg.inv(conf.frame(self.base).pose) @ conf.frame(self.frame).pose
        return replace(self, pose=tuple(map(tuple, pose.tolist())))

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the name of the base frame."""
        return (self.base,)

    def constants(self, robot: Robot) -> Vector:
        """Return gain, index of the base, 1 with a pose or 0, its position and rotation, (17,)."""
        base = robot.frame_id(self.base)
        pose = np.eye(4) if self.pose is None else np.array(self.pose)
        return self._with(robot, base, self.pose is not None, pose[:3, 3], pose[:3, :3])


@compiled
def remote_center_rows(
    step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector
) -> None:
    """Write the rows of `RemoteCenterTask`, two."""
    frame = int(constants[0])
    carrier = int(constants[9])
    placement = step.placements[frame]
    point = vector_at(constants, 10)
    if carrier >= 0:
        point = vector_at(step.placements[carrier], 9)
    offset = combined(1.0, point, -1.0, vector_at(placement, 9))
    for i in range(2):
        normal = axis_at(placement, vector_at(constants, 3 + 3 * i))
        b[i] = gain_of(step, constants) * dot(normal, offset)
        for j in range(step.q.size):
            sign = step.moves[frame, j]
            if carrier >= 0:
                sign -= step.moves[carrier, j]
            A[i, j] = sign * dot(normal, joint_velocity(step, j, point))


@dataclass(frozen=True)
class RemoteCenterTask(FeedbackTask):
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
    point: Sequence[float] | str
    axis: Sequence[float] = (0.0, 0.0, 1.0)
    frame: str | None = None
    tracks: bool = field(default=False, init=False, repr=False)
    rows: int = field(default=2, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set(axis=checks.direction("axis", self.axis))
        if not isinstance(self.point, str):
            self._set(point=checks.vector3("point", self.point))

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the name of the frame that carries the point, if there is one."""
        return (self.point,) if isinstance(self.point, str) else ()

    def constants(self, robot: Robot) -> Vector:
        """Return gain, two normals of the axis, the carrier's index or -1, and the point, (13,)."""
        normals = _normals(self.axis).T
        if isinstance(self.point, str):
            return self._with(robot, normals, robot.frame_id(self.point), np.zeros(3))
        return self._with(robot, normals, -1.0, self.point)


def _normals(axis: Sequence[float]) -> NDArray[np.float64]:
    """Return two unit vectors normal to a unit vector (3,) and to each other, (3, 2)."""
    smallest = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, smallest)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)], axis=1)
