r"""Tasks of frames beyond position and orientation: pose, axis, relative pose, remote centre.

A frame at position p with orientation R moves with the twist :math:`[v;\, \omega] = J \dot q`.
Each task brings an error to zero at the rate `gain`; its Jacobian is written in closed form.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn import checks
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import rotation_log
from iiwa_dnn.robot import Configuration
from iiwa_dnn.schemes.parts import Step, Tracking
from iiwa_dnn.schemes.tasks import ROTATION_LENGTH, GainTask

Rows = tuple[tuple[float, ...], ...]


@dataclass(frozen=True, kw_only=True)
class FeedbackTask(GainTask):
    """Base of tasks whose error decays.

    Attributes:
        gain: Rate at which the error decays [1/s], at least 0.
        weight: None for hard rows, else the weight of the soft task, at least 0.
        priority: Level in a cascade, 1 the first; None: no cascade (`iiwa_dnn.control.cascade`).
        tracking: ``"paper"``, or ``"next"``: rows towards the next target.
        next_gain: Gain of ``"next"`` [1/s], as of `PositionTask`.
    """

    gain: float = 10.2
    weight: float | None = None
    priority: int | None = None
    tracking: Tracking = "paper"
    next_gain: float | None = None

    def __post_init__(self) -> None:
        self._check("gain")
        if self.priority is not None:
            checks.integer("priority", self.priority, 1)

    def feedback(self, step: Step) -> float:
        """Return the gain of a step [1/s]."""
        gain = float(self.numbers(step.robot)[0])
        return gain if self.tracking == "paper" else min(gain, 1.0 / step.dt)


@dataclass(frozen=True)
class PoseTask(FeedbackTask):
    r"""Position and orientation of a frame, six rows.

    .. math::  J \dot q = [v_d + \delta (p_d - p);\; \omega_d + \delta \log(R_d R^T)]

    Attributes:
        frame: Name of the frame; None stands for the robot's tip.
    """

    frame: str | None = None
    rows: int = field(default=6, init=False, repr=False)

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (6, n) and b (6,)."""
        here, target = step.frame(self.frame), step.target(self.frame)
        error = np.concatenate([target.position - here.position, _log(target.rotation, here)])
        return here.jacobian, target.data[12:] + self.feedback(step) * error


@dataclass(frozen=True)
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

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (2, n) and b (2,)."""
        here = step.frame(self.frame)
        spin: Vector = np.zeros(3)
        if self.direction is None:
            target = step.target(self.frame)
            wanted, spin = target.rotation @ self.axis, target.data[15:]
        else:
            wanted = np.array(self.direction)
        axis, normals = here.rotation @ self.axis, here.rotation @ _normals(self.axis)
        turn = np.cross(axis, wanted)
        sine = np.sqrt(turn @ turn)
        angle = np.arctan2(sine, axis @ wanted)
        error = turn * (angle / sine if sine > 1e-12 else 1.0)
        return normals.T @ here.jacobian[3:], normals.T @ (spin + self.feedback(step) * error)


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

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (6, n) and b (6,)."""
        base, here = step.frame(self.base), step.frame(self.frame)
        back, apart = base.rotation.T, here.position - base.position
        place, turn = back @ apart, back @ here.rotation
        pose = np.eye(4) if self.pose is None else np.array(self.pose)
        if self.pose is None:
            pose[:3, :3], pose[:3, 3] = turn, place
        J1, J2 = base.jacobian, here.jacobian
        linear = J2[:3] - J1[:3] + pin.skew(apart) @ J1[3:]
        A = np.concatenate([back @ linear, back @ (J2[3:] - J1[3:])])
        error = np.empty(3)
        rotation_log(np.ascontiguousarray(pose[:3, :3] @ turn.T), error)
        return A, self.feedback(step) * np.concatenate([pose[:3, 3] - place, error])


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

    def equations(self, step: Step) -> tuple[Matrix, Vector]:
        """Return A (2, n) and b (2,)."""
        here, normals = step.frame(self.frame), _normals(self.axis)
        moved, back = here.jacobian[:3], (here.rotation @ normals).T
        if isinstance(self.point, str):
            there = step.frame(self.point)
            apart, moved = there.position - here.position, moved - there.jacobian[:3]
        else:
            apart = self.point - here.position
        A = back @ (moved - pin.skew(apart) @ here.jacobian[3:])
        return A, self.feedback(step) * (back @ apart)


def _log(desired: Matrix, here: Any) -> Vector:
    """Compute the rotation vector from an orientation to the desired one, (3,)."""
    error = np.empty(3)
    rotation_log(desired @ here.rotation.T, error)
    return error


def _normals(axis: Sequence[float]) -> NDArray[np.float64]:
    """Return two unit vectors normal to a unit vector (3,) and to each other, (3, 2)."""
    smallest = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, smallest)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)], axis=1)
