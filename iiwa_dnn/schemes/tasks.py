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
from typing import Literal

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.references.rotations import rotated, rotation_log
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import TRACKINGS, Codes, Task, Tracking

Form = Literal["so3", "block"]
Orientation = Literal["so3", "block", "none"]
ORIENTATIONS: tuple[Orientation, ...] = ("so3", "block", "none")

POSITION, ORIENTATION_SO3, ORIENTATION_BLOCK = 10, 11, 12

ROTATION_LENGTH = 0.1
"""Weight of a missing 1 rad/s of a task beside a missing 1 m/s where a policy lets it yield [m]."""


class GainTask(Task):
    """Base of tasks that feed an error back: attributes as of `PositionTask`."""

    gain: float
    next_gain: float | None

    def _check(self, name: str) -> None:
        """Check gain, by the name that users know it by, weight, priority, tracking, its gain."""
        checks.not_negative(name, self.gain)
        checks.one_of("tracking", self.tracking, TRACKINGS)
        if self.priority is not None:
            checks.integer("priority", self.priority, 1)
        for name in ("weight", "next_gain"):
            if getattr(self, name) is not None:
                checks.not_negative(name, getattr(self, name))

    def numbers(self, robot: Robot) -> Vector:
        """Return the gain, not yet cut to 1 / dt, and 1 where the next target is tracked, (2,)."""
        if self.tracking == "paper":
            return np.array([self.gain, 0.0])
        return np.array([np.inf if self.next_gain is None else self.next_gain, 1.0])


@dataclass(frozen=True)
class PositionTask(GainTask):
    r"""Position of a frame.

    .. math::  J_p \dot q = v_d + \delta\,(p_d - p)

    Source: equation (2) of the paper.

    Attributes:
        gain: The paper's delta [1/s], at least 0.
        frame: Name of the frame; None stands for the robot's tip.
        weight: None for hard rows, else the weight of the soft task, at least 0.
        priority: Level in a cascade, 1 the first; None: no cascade.
        tracking: ``"paper"``, or ``"next"``: rows towards the next target.
        next_gain: Gain of ``"next"`` [1/s], at least 0; None stands for 1 / dt, and more is cut to
            it.
    """

    gain: float = 10.2
    frame: str | None = None
    weight: float | None = None
    priority: int | None = None
    tracking: Tracking = "paper"
    next_gain: float | None = None
    kind: int = field(default=POSITION, init=False, repr=False)
    rows: int = field(default=3, init=False, repr=False)

    def __post_init__(self) -> None:
        self._check("position_gain")


@compiled
def position_rows(
    out: Vector, rows: int, rhs: int, n: int, codes: Codes, support: int, gain: float,
    jacobian: Matrix, place: Vector, targets: Vector, target: int,
) -> None:  # fmt: skip
    """Write three rows of n entries and their right-hand side into a program.

    A joint with angular velocity w and velocity v of the world's origin moves a frame at p with
    v + w x p. The rows begin at `rows` and the right-hand side at `rhs` in `out` (size,), the
    program or scratch memory; the flags of the joints that move the frame begin at `support` in
    `codes`, its target at `target` in `targets`; `place` (12,) is its placement, the gain is in
    [1/s]. Other arguments as `iiwa_dnn.schemes.assembly.assemble`.
    """
    x, y, z = place[9], place[10], place[11]
    for i in range(3):
        out[rhs + i] = targets[target + 12 + i] + gain * (targets[target + i] - place[9 + i])
    for j in range(jacobian.shape[0]):
        if codes[support + j] != 0:
            a, b, c = jacobian[j, 3], jacobian[j, 4], jacobian[j, 5]
            out[rows + j] = jacobian[j, 0] + (b * z - c * y)
            out[rows + n + j] = jacobian[j, 1] + (c * x - a * z)
            out[rows + 2 * n + j] = jacobian[j, 2] + (a * y - b * x)


@dataclass(frozen=True)
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
        priority: Level in a cascade, 1 the first; None: no cascade.
        tracking: ``"paper"``, or ``"next"``: rows towards the next target.
        next_gain: Gain of ``"next"`` [1/s], as of `PositionTask`.
    """

    gain: float = 10.2
    form: Form = "so3"
    frame: str | None = None
    weight: float | None = None
    priority: int | None = None
    tracking: Tracking = "paper"
    next_gain: float | None = None
    kind: int = field(default=ORIENTATION_SO3, init=False, repr=False)
    rows: int = field(default=3, init=False, repr=False)
    row_weight: float = field(default=ROTATION_LENGTH, init=False, repr=False)

    def __post_init__(self) -> None:
        self._check("orientation_gain")
        checks.one_of("form", self.form, ("so3", "block"))
        if self.form == "block":
            self._set(kind=ORIENTATION_BLOCK, rows=4)


@compiled
def so3_rows(
    out: Vector, rows: int, rhs: int, n: int, codes: Codes, support: int, gain: float,
    jacobian: Matrix, place: Vector, targets: Vector, target: int, rate: float,
) -> None:  # fmt: skip
    """Write three rows (3, n) and their right-hand side; arguments as `position_rows`.

    A `rate` above zero is 1 / dt of a task that tracks the next target.
    """
    relative, error = np.empty((3, 3)), np.empty(3)
    for i in range(3):
        for j in range(3):
            value = 0.0
            for k in range(3):
                value += targets[target + 3 + 3 * i + k] * place[3 * k + j]
            relative[i, j] = value
    rotation_log(relative, error)
    for i in range(3):
        out[rhs + i] = targets[target + 15 + i] + gain * error[i]
        for j in range(jacobian.shape[0]):
            if codes[support + j] != 0:
                out[rows + i * n + j] = jacobian[j, 3 + i]
    if rate > 0.0:
        # The logarithm of a product: the mean twist and the error do not just add up.
        turn = (
            targets[target + 15] / rate,
            targets[target + 16] / rate,
            targets[target + 17] / rate,
        )
        for j in range(3):
            column = rotated(turn, (relative[0, j], relative[1, j], relative[2, j]))
            for i in range(3):  # a slice would compile numba's error messages
                relative[i, j] = column[i]
        ahead = np.empty(3)
        rotation_log(relative, ahead)
        for i in range(3):
            out[rhs + i] = rate * ahead[i] - (rate - gain) * error[i]


@compiled
def block_rows(
    out: Vector, rows: int, rhs: int, n: int, codes: Codes, support: int, gain: float,
    jacobian: Matrix, place: Vector, targets: Vector, target: int,
) -> None:  # fmt: skip
    """Write four rows (4, n) and their right-hand side; arguments as `position_rows`."""
    here, there = np.empty((4, 3)), np.empty((4, 3))
    rotation, desired = np.empty((3, 3)), np.empty((3, 3))
    wanted = np.empty(4)
    for i in range(3):
        for j in range(3):
            rotation[i, j] = place[3 * j + i]
            desired[i, j] = targets[target + 3 + 3 * i + j]
    block_map(rotation, here)
    block_map(desired, there)
    for i in range(4):
        wanted[i] = gain * (desired[i // 2, i % 2] - rotation[i // 2, i % 2])
        for k in range(3):
            wanted[i] += there[i, k] * targets[target + 15 + k]
        for j in range(jacobian.shape[0]):
            if codes[support + j] != 0:
                value = 0.0
                for k in range(3):
                    value += here[i, k] * jacobian[j, 3 + k]
                out[rows + i * n + j] = value
    project_on_range(here, wanted)
    for i in range(4):
        out[rhs + i] = wanted[i]


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
        best, largest = 0, 0.0
        for j in range(count):
            norm = 0.0
            for i in range(rows):
                norm += columns[i, j] * columns[i, j]
            if norm > largest:
                best, largest = j, norm
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
                # Twice, so that rounding leaves no trace of the direction that was taken out.
                for _ in range(2):
                    overlap = 0.0
                    for i in range(rows):
                        overlap += columns[i, best] * columns[i, j]
                    for i in range(rows):
                        columns[i, j] -= overlap * columns[i, best]
        for i in range(rows):
            columns[i, best] = 0.0
    for i in range(rows):
        vector[i] = result[i]
