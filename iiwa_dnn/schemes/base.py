"""What every scheme offers, and the assembly of the program that all of them share."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import kernels
from iiwa_dnn.qp.program import QP, Matrix, Vector
from iiwa_dnn.references import Target
from iiwa_dnn.robot.configuration import Configuration
from iiwa_dnn.robot.robot import Robot
from iiwa_dnn.schemes.orientation import MODE_INDEX, ROW_COUNT, Orientation

SchemeT = TypeVar("SchemeT", bound="Scheme")


class Scheme(Protocol):
    """One way to choose joint velocities among those that fulfil the task."""

    @property
    def limit_gain(self) -> float | None:
        """The gain of the velocity bounds near a position limit [1/s]; None: no bounds."""
        ...

    def anchored(self: SchemeT, conf: Configuration) -> SchemeT:
        """The same scheme with `conf` as the posture to come back to, where it has one."""
        ...

    def build_qp(self, conf: Configuration, target: Target) -> QP:
        """The quadratic program whose solution is the joint velocity [rad/s]; not solved here."""
        ...

    def kinetic_index(self, conf: Configuration, dq: ArrayLike) -> float:
        """The scheme's measure dq^T G(q) dq of a joint velocity (n,) [rad/s]."""
        ...

    def settings(self) -> dict[str, Any]:
        """Name and parameters, as values that JSON can hold."""
        ...


@lru_cache
def identity(n: int) -> Matrix:
    """The (n, n) identity matrix, the same array for every caller."""
    return np.eye(n)


class VelocityProgram(NamedTuple):
    r"""A velocity program less what changes along a run: objective, task rows, velocity bounds.

    The position rows are :math:`J \dot q = v_d + \delta\,(p_d - p)`; the orientation rows and the
    bounds stand in their own files, the objective in `iiwa_dnn.schemes.double_indicator`.

    Attributes:
        mode: Form of the orientation rows, as the kernels call it (`MODE_INDEX`).
        rows: Equality rows: 3 of the position and 3, 4 or 0 of the orientation.
        weights: The blend of kinetic energy (1) and cyclic motion (0), and the gains towards home,
            of the position, of the orientation and near the limits [1/s]; (5,).
        limits: Rows of `Robot.limits` to keep, (3, n).
        home: Posture to come back to [rad], (n,).
        inertia: Whether G(q) is the joint-space inertia matrix; otherwise it is the identity.
    """

    mode: int
    rows: int
    weights: Vector
    limits: Matrix
    home: Vector
    inertia: bool

    @classmethod
    def of(
        cls,
        orientation: Orientation,
        weights: Sequence[float],
        limits: Matrix,
        home: Vector,
        inertia: bool = False,
    ) -> VelocityProgram:
        """The program with this form of the orientation rows."""
        rows = 3 + ROW_COUNT[orientation]
        numbers = np.array(weights, dtype=np.float64)
        return cls(MODE_INDEX[orientation], rows, numbers, limits, home, inertia)

    def kinetic(self, conf: Configuration) -> Matrix:
        """G(q), (n, n)."""
        return np.array(conf.inertia) if self.inertia else identity(self.home.size)

    def build(self, conf: Configuration, target: Target) -> QP:
        """The program at a configuration of n joints: a QP in n variables, not solved here."""
        q, pose, jacobian = conf.arrays
        n, p = q.size, self.rows
        data = np.empty(n * (n + 3) + p * (n + 1))
        kernels.velocity_program(
            data, p, self.mode, q, pose, jacobian, target.data,
            self.limits, self.home, self.kinetic(conf), self.weights,
        )  # fmt: skip
        return QP.from_data(data, (n, 0, p))


def compiled_program(scheme: Scheme, robot: Robot) -> VelocityProgram | None:
    """The scheme's ``program(robot)``, where that is all that its `build_qp` builds.

    A scheme may offer this method; the control loop then assembles and solves in one compiled
    call. None where it does not, or where a subclass builds in a way of its own.
    """
    builder = next(cls for cls in type(scheme).__mro__ if "build_qp" in vars(cls))
    if "program" not in vars(builder):
        return None
    program: VelocityProgram = scheme.program(robot)  # type: ignore[attr-defined]
    return program
