"""What every scheme offers, and the assembly of the program that all of them share."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from iiwa_dnn import kernels
from iiwa_dnn.configuration import Configuration
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Target
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
        """The scheme's measure dq^T G(q) dq of a joint velocity."""
        ...

    def settings(self) -> dict[str, Any]:
        """Name and parameters, as values that JSON can hold."""
        ...


@lru_cache
def identity(n: int) -> Matrix:
    """The (n, n) identity matrix, the same array for every caller."""
    return np.eye(n)


class Weights(NamedTuple):
    """The numbers of a velocity program that do not change along a run.

    Attributes:
        mode: Form of the orientation rows, an index of `ORIENTATIONS`.
        rows: Equality rows p: 3 of the position and those of the orientation.
        values: The blend of kinetic energy (1) and cyclic motion (0), and the gains towards home,
            of the position, of the orientation and near the limits [1/s]; (5,).
    """

    mode: int
    rows: int
    values: Vector

    @classmethod
    def of(cls, orientation: Orientation, values: Sequence[float]) -> Weights:
        """The weights of a scheme with this form of the orientation rows."""
        rows = 3 + ROW_COUNT[orientation]
        return cls(MODE_INDEX[orientation], rows, np.array(values, dtype=np.float64))


def velocity_program(
    conf: Configuration,
    target: Target,
    weights: Weights,
    limits: Matrix,
    home: Vector,
    kinetic: Matrix,
) -> QP:
    r"""Assemble a velocity program: an objective, the task as equality rows, velocity bounds.

    The position rows are :math:`J \dot q = v_d + \delta\,(p_d - p)`; the orientation rows and the
    bounds stand in their own files, the objective in `iiwa_dnn.schemes.double_indicator`.

    Args:
        conf: Where the robot is, n joints.
        target: Where it should be.
        weights: Weight, gains and form of the orientation rows.
        limits: Rows of `Robot.limits` to keep, (3, n).
        home: Posture to come back to [rad], (n,).
        kinetic: G(q), (n, n).

    Returns:
        A QP in n variables with 3 position rows and 3, 4 or 0 orientation rows.
    """
    mode, p, values = weights
    q, pose, jacobian = conf.arrays
    n = q.size
    data = np.empty(n * (n + 3) + p * (n + 1))
    kernels.velocity_program(
        data, p, mode, q, pose, jacobian, target.data, limits, home, kinetic, values
    )
    return QP.from_data(data, (n, 0, p))
