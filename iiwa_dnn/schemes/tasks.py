r"""Tasks: equality rows A dq = b that let frames of the arm follow their targets.

A frame at position p with orientation R is to be at :math:`p_d, R_d` with the twist
:math:`[v_d;\, \omega_d]`, and moves with :math:`[v;\, \omega] = J \dot q`. Each task brings an
error to zero at the rate `gain`. With a ``weight`` w the rows become the cost
:math:`\tfrac12 w\,\|A \dot q - b\|^2`.

A gain above 1 / dt is cut to it. With this one and a reference seen one period ahead
(`Reference.ahead`) the rows ask for the next target, and an Euler step leaves nothing of the error
but the step's curvature, :math:`\tfrac12 dt^2\,\dot q^T \nabla^2 p\,\dot q`, which does not add up.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.references.rotations import added, combined, cross, dot, rotation_log, row_of, scaled
from iiwa_dnn.robot import Configuration, Robot
from iiwa_dnn.schemes.block_form import block_rows
from iiwa_dnn.schemes.parts import Task
from iiwa_dnn.schemes.step import StepViews

Form = Literal["so3", "block"]
Orientation = Literal["so3", "block", "none"]
ORIENTATIONS: tuple[Orientation, ...] = ("so3", "block", "none")
Rows = tuple[tuple[float, ...], ...]

ROTATION_LENGTH = 0.5
"""Weight of a missing 1 rad/s of a task beside a missing 1 m/s where a policy lets it yield [m].

About an arm's forearm. With a fifth of it, more arms rest at joints' limits with the tip in place
and the hand turned away; with twice as much, no more arrive."""

FRAME, GAIN, BASE = range(3)
"""Constants of a task of a frame: its index, the gain [1/s], and the index of the frame that it is
seen from, 0 for the world's."""

WORLD = 3
WANTED = 15
"""Beginnings of the world's placement and of a fixed target among those constants."""


@compiled
def vector_at(array: Vector, start: int) -> Vector3:
    """Return three numbers of an array (k,), from an index on."""
    return array[start], array[start + 1], array[start + 2]


@compiled
def axis_at(placement: Vector, axis: Vector3) -> Vector3:
    """Turn a direction in a frame's own coordinates, by its placement (12,), into the world's."""
    x = scaled(axis[0], vector_at(placement, 0))
    return added(x, combined(axis[1], vector_at(placement, 3), axis[2], vector_at(placement, 6)))


@compiled
def joint_spin(step: StepViews, j: int) -> Vector3:
    """Return the angular velocity for each unit of velocity of joint j."""
    return vector_at(step.jacobian[j], 3)


@compiled
def rate_along(jacobian: Matrix, j: int, point: Vector3, normal: Vector3) -> float:
    """Compute the velocity along a normal (3,) of a point (3,) [m] that joint j moves [m/rad].

    A joint with angular velocity w and velocity v of the world's origin moves it with v + w x p.
    """
    x, y, z = point
    wx = jacobian[j, 3]
    wy = jacobian[j, 4]
    wz = jacobian[j, 5]
    value: float = normal[0] * (jacobian[j, 0] + (wy * z - wz * y))
    value += normal[1] * (jacobian[j, 1] + (wz * x - wx * z))
    value += normal[2] * (jacobian[j, 2] + (wx * y - wy * x))
    return value


@compiled
def write_position(
    step: StepViews, constants: Vector, base: Vector, wanted: Vector, A: Matrix, b: Vector
) -> None:
    """Write the rows of a frame's position as seen from the placement of a base (12,), three."""
    frame = int(constants[FRAME])
    other = int(constants[BASE])
    gain = min(constants[GAIN], step.rate)
    point = vector_at(step.placements[frame], 9)
    offset = combined(1.0, point, -1.0, vector_at(base, 9))
    for i in range(3):
        axis = vector_at(base, 3 * i)
        b[i] = wanted[12 + i] + gain * (wanted[i] - dot(axis, offset))
        for j in range(step.q.size):
            sign = step.moves[frame, j] - step.moves[other, j]
            A[i, j] = sign * rate_along(step.jacobian, j, point, axis)


@compiled
def write_rotation(
    step: StepViews, constants: Vector, base: Vector, wanted: Vector, A: Matrix, b: Vector
) -> None:
    """Write the rows of a frame's orientation as seen from the placement of a base (12,), three."""
    frame = int(constants[FRAME])
    other = int(constants[BASE])
    gain = min(constants[GAIN], step.rate)
    placement = step.placements[frame]
    relative = np.empty((3, 3))
    error = np.empty(3)
    for i in range(3):
        for k in range(3):
            value = 0.0
            for j in range(3):
                turned = dot(vector_at(base, 3 * k), vector_at(placement, 3 * j))
                value += wanted[3 + 3 * i + j] * turned
            relative[i, k] = value
    rotation_log(relative, error)
    for i in range(3):
        b[i] = wanted[15 + i] + gain * error[i]
        for j in range(step.q.size):
            sign = step.moves[frame, j] - step.moves[other, j]
            A[i, j] = sign * dot(vector_at(base, 3 * i), joint_spin(step, j))


@compiled
def position_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `PositionTask`, three."""
    write_position(step, constants, constants[WORLD:WANTED], target, A, b)


@compiled
def rotation_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `OrientationTask` in the form ``so3``, three."""
    write_rotation(step, constants, constants[WORLD:WANTED], target, A, b)


@compiled
def pose_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `PoseTask`, six."""
    position_rows(step, constants, target, A[:3], b[:3])
    rotation_rows(step, constants, target, A[3:], b[3:])


@compiled
def relative_pose_rows(
    step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector
) -> None:
    """Write the rows of `RelativePoseTask`, six."""
    base = step.placements[int(constants[BASE])]
    wanted = constants[WANTED:]
    write_position(step, constants, base, wanted, A[:3], b[:3])
    write_rotation(step, constants, base, wanted, A[3:], b[3:])


@dataclass(frozen=True, kw_only=True)
class GainTask(Task):
    """Base of tasks whose error decays.

    Attributes:
        gain: Rate at which the error decays [1/s], at least 0; more than 1 / dt, as inf, is cut to
            that.
        weight: None for hard rows, else the weight of the soft task, at least 0.
    """

    gain: float = 10.2
    weight: float | None = None

    def __post_init__(self) -> None:
        if self.gain != np.inf:
            checks.not_negative("gain", self.gain)
        if self.weight is not None:
            checks.not_negative("weight", self.weight)


@dataclass(frozen=True, kw_only=True)
class FrameTask(GainTask):
    """Base of tasks of a frame.

    Attributes:
        frame: Name of the frame; None stands for the robot's tip.
    """

    frame: str | None = None

    def _constants(
        self, robot: Robot, base: str | None = None, pose: ArrayLike | None = None
    ) -> Vector:
        """Return `FRAME`, `GAIN`, `BASE`, the world's placement, and the target of a pose (4, 4).

        Raises:
            NotFoundError: The robot has no such frame.
        """
        frame = robot.frame_id(self.frame_name(robot))
        other = 0 if base is None else robot.frame_id(base)
        fixed = np.eye(4) if pose is None else np.array(pose)
        world = [*np.eye(3).ravel(), *np.zeros(3)]
        wanted = [*fixed[:3, 3], *fixed[:3, :3].ravel(), *np.zeros(6)]
        return np.array([frame, self.gain, other, *world, *wanted])

    def constants(self, robot: Robot) -> Vector:
        """Return `FRAME`, `GAIN`, `BASE`, the world's placement and a target, (33,)."""
        return self._constants(robot)


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
    rows: int = field(default=3, init=False, repr=False)


@dataclass(frozen=True, kw_only=True)
class OrientationTask(FrameTask):
    r"""Orientation of a frame, in one of two forms.

    ``so3``: the angular velocity itself, three rows that lose nothing at any orientation,

    .. math::  J_\omega \dot q = \omega_d + \nu \log(R_d R^T)

    ``block``: the paper's four rows (`iiwa_dnn.schemes.block_form`).

    Source: F. Bullo and R. M. Murray, "Proportional derivative (PD) control on the Euclidean
    group", European Control Conference 1995, for ``so3``.

    Attributes:
        gain: The paper's nu as a feedback gain [1/s].
        weight: None for hard rows, else the weight of the soft task, at least 0.
        frame: Name of the frame; None stands for the robot's tip.
        form: ``"so3"`` or ``"block"``.
    """

    kernel = staticmethod(rotation_rows)
    form: Form = "so3"
    rows: int = field(default=3, init=False, repr=False)
    row_weight: float = field(default=ROTATION_LENGTH, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.one_of("form", self.form, ("so3", "block"))
        if self.form == "block":
            self._set(kernel=block_rows, rows=4)


@dataclass(frozen=True, kw_only=True)
class PoseTask(FrameTask):
    r"""Position and orientation of a frame, six rows.

    .. math::  J \dot q = [v_d + \delta (p_d - p);\; \omega_d + \delta \log(R_d R^T)]
    """

    kernel = staticmethod(pose_rows)
    rows: int = field(default=6, init=False, repr=False)


@dataclass(frozen=True)
class RelativePoseTask(FrameTask):
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
    frame: str = field()
    base: str = field()
    pose: Rows | None = None
    tracks: bool = field(default=False, init=False, repr=False)
    rows: int = field(default=6, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.pose is not None:
            pose = checks.finite_array("pose", self.pose, (4, 4))
            self._set(pose=tuple(map(tuple, pose.tolist())))

    def anchored(self, conf: Configuration) -> "RelativePoseTask":
        """Return the task with the relative pose of `conf`, unless it has one already."""
        if self.pose is not None:
            return self
        pose = np.linalg.inv(conf.frame(self.base).pose) @ conf.frame(self.frame).pose
        return replace(self, pose=tuple(map(tuple, pose.tolist())))

    def extra_frames(self, robot: Robot) -> tuple[str, ...]:
        """Return the name of the base frame."""
        return (self.base,)

    def constants(self, robot: Robot) -> Vector:
        """Return those of a task of a frame, (33,); without a pose the gain is 0."""
        found = self._constants(robot, self.base, self.pose)
        found[GAIN] *= self.pose is not None
        return found


@compiled
def axis_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `AxisTask`, two."""
    frame = int(constants[FRAME])
    placement = step.placements[frame]
    axis = vector_at(constants, 2)
    if constants[11] == 0.0:
        spin = vector_at(target, 15)
        wanted = (
            dot(row_of(target, 0), axis),
            dot(row_of(target, 1), axis),
            dot(row_of(target, 2), axis),
        )
    else:
        spin = (0.0, 0.0, 0.0)
        wanted = vector_at(constants, 12)
    here = axis_at(placement, axis)
    turn = cross(here, wanted)
    sine = np.sqrt(dot(turn, turn))
    angle = np.arctan2(sine, dot(here, wanted))
    factor = angle / sine if sine > 1e-12 else 1.0
    rate = combined(1.0, spin, min(constants[GAIN], step.rate) * factor, turn)
    for i in range(2):
        normal = axis_at(placement, vector_at(constants, 5 + 3 * i))
        b[i] = dot(normal, rate)
        for j in range(step.q.size):
            A[i, j] = step.moves[frame, j] * dot(normal, joint_spin(step, j))


@dataclass(frozen=True, kw_only=True)
class AxisTask(FrameTask):
    r"""Direction of one axis of a frame, which stays free to spin about it; two rows.

    With the axis a, the desired direction :math:`a_d` at the angle :math:`\theta` from it and a
    basis U of the directions normal to a:

    .. math::  U^T J_\omega \dot q = U^T \bigl(\omega_d
        + \delta\,\theta\,\tfrac{a \times a_d}{\|a \times a_d\|}\bigr)

    Attributes:
        axis: The axis in the frame's own coordinates, (3,), of any length.
        direction: Desired direction in the world, (3,); None: the axis of the target's rotation.
    """

    kernel = staticmethod(axis_rows)
    axis: Sequence[float] = (0.0, 0.0, 1.0)
    direction: Sequence[float] | None = None
    rows: int = field(default=2, init=False, repr=False)
    row_weight: float = field(default=ROTATION_LENGTH, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set(axis=checks.direction("axis", self.axis))
        if self.direction is not None:
            self._set(direction=checks.direction("direction", self.direction), tracks=False)

    def constants(self, robot: Robot) -> Vector:
        """Return frame, gain, axis, two normals of it, and 1 with a fixed direction or 0, (15,)."""
        fixed = (0.0, 0.0, 0.0, 0.0) if self.direction is None else (1.0, *self.direction)
        normals = _normals(self.axis).ravel()
        frame = robot.frame_id(self.frame_name(robot))
        return np.array([frame, self.gain, *self.axis, *normals, *fixed])


@compiled
def remote_center_rows(
    step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector
) -> None:
    """Write the rows of `RemoteCenterTask`, two."""
    frame = int(constants[FRAME])
    carrier = int(constants[BASE])
    placement = step.placements[frame]
    point = vector_at(constants, 9)
    if carrier > 0:
        point = vector_at(step.placements[carrier], 9)
    offset = combined(1.0, point, -1.0, vector_at(placement, 9))
    for i in range(2):
        normal = axis_at(placement, vector_at(constants, 3 + 3 * i))
        b[i] = min(constants[GAIN], step.rate) * dot(normal, offset)
        for j in range(step.q.size):
            sign = step.moves[frame, j] - step.moves[carrier, j]
            A[i, j] = sign * rate_along(step.jacobian, j, point, normal)


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
    point: Sequence[float] | str
    axis: Sequence[float] = (0.0, 0.0, 1.0)
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
        """Return frame, gain, the carrier's index or 0, two normals of the axis, point, (12,)."""
        carrier = robot.frame_id(self.point) if isinstance(self.point, str) else 0
        point = (0.0, 0.0, 0.0) if isinstance(self.point, str) else self.point
        frame = robot.frame_id(self.frame_name(robot))
        return np.array([frame, self.gain, carrier, *_normals(self.axis).ravel(), *point])


def _normals(axis: Sequence[float]) -> NDArray[np.float64]:
    """Return two unit vectors normal to a unit vector (3,) and to each other, (2, 3)."""
    smallest = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, smallest)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)])
