r"""Tasks of joints, their positions and couplings: :math:`C \dot q = \delta\,(c - C q)`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.step import StepViews
from iiwa_dnn.schemes.tasks import GainTask


@compiled
def joint_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of a task of joints: its constants are gain, C (rows, dof) and c (rows,)."""
    dof = step.q.size
    gain = min(constants[0], step.rate)
    for i in range(b.size):
        missing = constants[1 + dof * b.size + i]
        for j in range(dof):
            A[i, j] = constants[1 + dof * i + j]
            missing -= A[i, j] * step.q[j]
        b[i] = gain * missing


@dataclass(frozen=True)
class PostureTask(GainTask):
    r"""Positions of some joints; one row a joint (`CyclicMotion` draws back all of them, softly).

    .. math::  \dot q_j = \delta\,(q_{d,j} - q_j)

    Attributes:
        joints: Desired positions by joint name [rad].
    """

    kernel = staticmethod(joint_rows)
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
        """Return gain, a row of C for each joint, and the desired positions."""
        C = [_row(robot, {name: 1.0}) for name in self.joints]
        return np.concatenate([[self.gain], *C, list(self.joints.values())])


@dataclass(frozen=True)
class JointCouplingTask(GainTask):
    r"""One linear relation between joints, as of a gear or a mimic joint.

    .. math::  c^T \dot q = \delta\,(c_0 - c^T q)

    It is a limit where the tasks yield: a linkage is not pulled apart.

    Attributes:
        coefficients: c by joint name.
        offset: c_0 [rad].
    """

    kernel = staticmethod(joint_rows)
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
        """Return gain, the coefficient of each joint, and the offset, (2 + n,)."""
        return np.array([self.gain, *_row(robot, self.coefficients), self.offset])


def _row(robot: Robot, coefficients: Mapping[str, float]) -> Vector:
    """Return the coefficients of all joints, (n,); raise NotFoundError for an unknown name."""
    row = np.zeros(robot.dof)
    for name, coefficient in coefficients.items():
        if name not in robot.joint_names:
            raise NotFoundError("joint", name, robot.joint_names)
        row[robot.joint_names.index(name)] = coefficient
    return row
