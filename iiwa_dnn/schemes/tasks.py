r"""Tasks: equality rows that let a frame follow its target.

A frame at position p with orientation R is to be at :math:`p_d, R_d` with the twist
:math:`[v_d;\, \omega_d]`. Each task states its rows A dq = b; with a ``weight`` w they become the
cost :math:`\tfrac12 w\,\|A \dot q - b\|^2` instead.

The paper feeds the error back at a gain :math:`\delta`, with :math:`\delta\,dt \ll 1`. With
``tracking="next"`` the rows ask for the target one period ahead: in place of the twist stands the
mean one until then, and in place of the gain :math:`\gamma \le 1/dt`,

.. math::

    b = \frac{p_d(t + dt) - p}{dt} - \Bigl(\frac{1}{dt} - \gamma\Bigr) (p_d(t) - p), \qquad
    b_\omega = \frac{\log(R_d(t + dt) R^T)}{dt}
        - \Bigl(\frac{1}{dt} - \gamma\Bigr) \log(R_d(t) R^T),

so that an Euler step leaves :math:`(1 - \gamma\,dt)` of the error, and with :math:`\gamma = 1/dt`
nothing of it but the step's curvature, :math:`\tfrac12 dt^2\,\dot q^T \nabla^2 p\,\dot q`, which
does not add up from step to step. A smaller :math:`\gamma` is for noise (`noise_gain`).
"""

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.checks import Vector3
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.references.rotations import (
    added,
    combined,
    cross,
    rotated,
    rotation_log,
    scaled,
)
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import TRACKINGS, Task, Tracking
from iiwa_dnn.schemes.step import StepViews

Form = Literal["so3", "block"]
Orientation = Literal["so3", "block", "none"]
ORIENTATIONS: tuple[Orientation, ...] = ("so3", "block", "none")

ROTATION_LENGTH = 0.5
"""Weight of a missing 1 rad/s of a task beside a missing 1 m/s where a policy lets it yield [m].

About an arm's forearm. With a fifth of it, more arms rest at joints' limits with the tip in place
and the hand turned away; with twice as much, no more arrive."""


class GainTask(Task):
    """Base of tasks that feed an error back: attributes as of `PositionTask`.

    The first three constants of every kernel are the index of the frame, the gain [1/s], not yet
    cut to 1 / dt, and 1 where the next target is tracked.
    """

    gain: float
    next_gain: float | None

    def __post_init__(self) -> None:
        checks.not_negative("gain", self.gain)
        checks.one_of("tracking", self.tracking, TRACKINGS)
        for name in ("weight", "next_gain"):
            if getattr(self, name) is not None:
                checks.not_negative(name, getattr(self, name))

    def constants(self, robot: Robot) -> Vector:
        """Return the index of the frame, the gain and the way of tracking, (3,)."""
        frame = float(robot.frame_id(self.frame_name(robot)))
        if self.tracking == "paper":
            return np.array([frame, self.gain, 0.0])
        return np.array([frame, np.inf if self.next_gain is None else self.next_gain, 1.0])


@compiled
def gain_of(step: StepViews, constants: Vector) -> float:
    """Compute the gain of a step [1/s] from the constants of a `GainTask`."""
    gain: float = constants[1]
    return min(gain, step.rate) if constants[2] != 0.0 else gain


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
def joint_velocity(step: StepViews, j: int, point: Vector3) -> Vector3:
    """Compute the velocity of a point [m] of the world for each unit of velocity of joint j.

    A joint with angular velocity w and velocity v of the world's origin moves it with v + w x p.
    """
    return added(vector_at(step.jacobian[j], 0), cross(joint_spin(step, j), point))


@compiled
def point_jacobian(step: StepViews, frame: int, point: Vector, out: Matrix) -> None:
    """Write the Jacobian (3, n) of a point (3,) [m] of the world that moves with a frame."""
    for j in range(step.q.size):
        if step.moves[frame, j] != 0.0:
            a = step.jacobian[j, 3]
            b = step.jacobian[j, 4]
            c = step.jacobian[j, 5]
            out[0, j] = step.jacobian[j, 0] + (b * point[2] - c * point[1])
            out[1, j] = step.jacobian[j, 1] + (c * point[0] - a * point[2])
            out[2, j] = step.jacobian[j, 2] + (a * point[1] - b * point[0])


@compiled
def angular_jacobian(step: StepViews, frame: int, out: Matrix) -> None:
    """Write the angular Jacobian of a frame, (3, n)."""
    for j in range(step.q.size):
        if step.moves[frame, j] != 0.0:
            for i in range(3):
                out[i, j] = step.jacobian[j, 3 + i]


@compiled
def position_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `PositionTask`, three."""
    frame = int(constants[0])
    gain = gain_of(step, constants)
    position = step.placements[frame, 9:]
    for i in range(3):
        b[i] = target[12 + i] + gain * (target[i] - position[i])
    point_jacobian(step, frame, position, A)


@dataclass(frozen=True, kw_only=True)
class PositionTask(GainTask):
    r"""Position of a frame.

    .. math::  J_p \dot q = v_d + \delta\,(p_d - p)

    Source: equation (2) of the paper.

    Attributes:
        gain: The paper's delta [1/s], at least 0.
        frame: Name of the frame; None stands for the robot's tip.
        weight: None for hard rows, else the weight of the soft task, at least 0.
        tracking: ``"paper"``, or ``"next"``: rows towards the next target.
        next_gain: Gain of ``"next"`` [1/s], at least 0; None stands for 1 / dt, and more is cut to
            it.
    """

    kernel = staticmethod(position_rows)
    gain: float = 10.2
    frame: str | None = None
    weight: float | None = None
    tracking: Tracking = "paper"
    next_gain: float | None = None
    rows: int = field(default=3, init=False, repr=False)


@compiled
def so3_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `OrientationTask` in the form ``so3``, three."""
    frame = int(constants[0])
    gain = gain_of(step, constants)
    relative = np.empty((3, 3))
    error = np.empty(3)
    _relative_rotation(step.placements[frame], target, relative)
    rotation_log(relative, error)
    for i in range(3):
        b[i] = target[15 + i] + gain * error[i]
    angular_jacobian(step, frame, A)
    if constants[2] != 0.0:
        # The logarithm of a product: the mean twist and the error do not just add up.
        turn = (target[15] / step.rate, target[16] / step.rate, target[17] / step.rate)
        ahead = np.empty(3)
        _turn(turn, relative)
        rotation_log(relative, ahead)
        for i in range(3):
            b[i] = step.rate * ahead[i] - (step.rate - gain) * error[i]


@compiled
def _relative_rotation(placement: Vector, target: Vector, out: Matrix) -> None:
    """Write the rotation (3, 3) from a placement's (12,) to a target's (18,), R_d R^T."""
    for i in range(3):
        for j in range(3):
            value = 0.0
            for k in range(3):
                value += target[3 + 3 * i + k] * placement[3 * k + j]
            out[i, j] = value


@compiled
def _turn(vector: Vector3, R: Matrix) -> None:
    """Turn a rotation matrix (3, 3) from the left by a rotation vector."""
    for j in range(3):
        column = rotated(vector, (R[0, j], R[1, j], R[2, j]))
        for i in range(3):
            R[i, j] = column[i]


@compiled
def block_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `OrientationTask` in the form ``block``, four."""
    frame = int(constants[0])
    gain = gain_of(step, constants)
    here = np.empty((4, 3))
    there = np.empty((4, 3))
    rotation = np.empty((3, 3))
    desired = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            rotation[i, j] = step.placements[frame, 3 * j + i]
            desired[i, j] = target[3 + 3 * i + j]
    block_map(rotation, here)
    block_map(desired, there)
    for i in range(4):
        b[i] = gain * (desired[i // 2, i % 2] - rotation[i // 2, i % 2])
        for k in range(3):
            b[i] += there[i, k] * target[15 + k]
        for j in range(step.q.size):
            if step.moves[frame, j] != 0.0:
                value = 0.0
                for k in range(3):
                    value += here[i, k] * step.jacobian[j, 3 + k]
                A[i, j] = value
    project_on_range(here, b)


@dataclass(frozen=True, kw_only=True)
class OrientationTask(GainTask):
    r"""Orientation of a frame, in one of two forms.

    ``so3``: the angular velocity itself, three rows that lose nothing at any orientation,

    .. math::  J_\omega \dot q = \omega_d + \nu \log(R_d R^T)

    ``block``, the paper's: with :math:`r = [R_{11}, R_{12}, R_{21}, R_{22}]`,

    .. math::  W(R)\,J_\omega \dot q = \dot r_d - \nu (r - r_d)

    where W follows from :math:`\dot R = [\omega]_\times R`. These four rows have rank three at
    most, and where the tool's axis is vertical they lose the two tilts (docs/errata.md). Off the
    path the four contradict each other, at second order in the error: no velocity fulfils them
    all. The right-hand side is therefore projected on the range of W, which gives the rows their
    least-squares meaning and changes nothing at first order.

    Sources: F. Bullo and R. M. Murray, "Proportional derivative (PD) control on the Euclidean
    group", European Control Conference 1995, for ``so3``; equations (3) to (5) of the paper.

    Attributes:
        gain: The paper's nu as a feedback gain [1/s], at least 0.
        form: ``"so3"`` or ``"block"``.
        frame: Name of the frame; None stands for the robot's tip.
        weight: None for hard rows, else the weight of the soft task, at least 0.
        tracking: ``"paper"``, or ``"next"``: rows towards the next target.
        next_gain: Gain of ``"next"`` [1/s], as of `PositionTask`.
    """

    gain: float = 10.2
    form: Form = "so3"
    frame: str | None = None
    weight: float | None = None
    tracking: Tracking = "paper"
    next_gain: float | None = None
    rows: int = field(default=3, init=False, repr=False)
    row_weight: float = field(default=ROTATION_LENGTH, init=False, repr=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.one_of("form", self.form, ("so3", "block"))
        if self.form == "block":
            self._set(rows=4)

    @property
    def kernel(self) -> Any:
        """The compiled function of the form."""
        return so3_rows if self.form == "so3" else block_rows


@compiled
def block_map(R: Matrix, out: Matrix) -> None:
    """Write W(R) (4, 3): the rate of [R11 R12 R21 R22] is W(R) times the angular velocity."""
    for i in range(4):
        for j in range(3):
            out[i, j] = 0.0
    for column in range(2):
        out[column, 1] = R[2, column]
        out[column, 2] = -R[1, column]
        out[2 + column, 0] = -R[2, column]
        out[2 + column, 2] = R[0, column]


@compiled
def project_on_range(columns: Matrix, vector: Vector) -> None:
    """Replace `vector` (4,) by its projection on the range of `columns` (4, 3), which is spoilt.

    Gram-Schmidt with pivoting; a direction below 1e-9 of the entries' scale, one, is none.
    """
    rows, count = columns.shape
    result = np.zeros(rows)
    for _ in range(count):
        best = 0
        largest = 0.0
        for j in range(count):
            norm = 0.0
            for i in range(rows):
                norm += columns[i, j] * columns[i, j]
            if norm > largest:
                best = j
                largest = norm
        if largest <= 1e-18:
            break
        scale = 1.0 / np.sqrt(largest)
        along = 0.0
        for i in range(rows):
            columns[i, best] *= scale
            along += columns[i, best] * vector[i]
        for i in range(rows):
            result[i] += along * columns[i, best]
        for j in range(count):
            if j != best:
                _take_out(columns, best, j)
        for i in range(rows):
            columns[i, best] = 0.0
    for i in range(rows):
        vector[i] = result[i]


@compiled
def _take_out(columns: Matrix, unit: int, other: int) -> None:
    """Make a column orthogonal to a unit column, twice, so that rounding leaves no trace of it."""
    rows = columns.shape[0]
    for _ in range(2):
        overlap = 0.0
        for i in range(rows):
            overlap += columns[i, unit] * columns[i, other]
        for i in range(rows):
            columns[i, other] -= overlap * columns[i, unit]
