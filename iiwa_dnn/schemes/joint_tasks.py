r"""Tasks of joints, their positions and couplings: :math:`C \dot q = \delta\,(c - C q)`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError, NotFoundError
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.robot import Robot
from iiwa_dnn.schemes.parts import Checks
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


def numbers_of(argument: str, value: Any) -> dict[str, float]:
    """Return finite numbers by joint name; refuse any other value."""
    if not isinstance(value, Mapping):
        problem = "must be numbers by joint name: dict(zip(robot.joint_names, q))"
        raise InvalidInputError(argument, problem, value)
    return {name: checks.finite(argument, number) for name, number in value.items()}


class JointTask(GainTask):
    """Base of tasks of joints, which name the rows of C and state c."""

    kernel = staticmethod(joint_rows)
    tracks = False

    def _relations(self) -> list[tuple[Mapping[str, float], float]]:
        """Return for each row its coefficients by joint name, and its c [rad]."""
        raise NotImplementedError

    def row_count(self, robot: Robot) -> int:
        """Return the number of relations."""
        return len(self._relations())

    def constants(self, robot: Robot) -> Vector:
        """Return gain, C (rows, n) and c (rows,).

        Raises:
            NotFoundError: The robot has no joint of a name.
        """
        relations = self._relations()
        C = np.zeros((len(relations), robot.dof))
        for row, (coefficients, _) in zip(C, relations, strict=True):
            for name, coefficient in coefficients.items():
                if name not in robot.joint_names:
                    raise NotFoundError("joint", name, robot.joint_names)
                row[robot.joint_names.index(name)] = coefficient
        return np.array([self.gain, *C.ravel(), *(wanted for _, wanted in relations)])


@dataclass(frozen=True)
class PostureTask(JointTask):
    r"""Positions of some joints; one row a joint (`CyclicMotion` draws back all of them, softly).

    .. math::  \dot q_j = \delta\,(q_{d,j} - q_j)

    Attributes:
        joints: Desired positions by joint name [rad].
    """

    _checks: ClassVar[Checks] = {"joints": numbers_of}
    row_weight = 0.1
    joints: Mapping[str, float]

    def _relations(self) -> list[tuple[Mapping[str, float], float]]:
        return [({name: 1.0}, position) for name, position in self.joints.items()]


@dataclass(frozen=True)
class JointCouplingTask(JointTask):
    r"""One linear relation between joints, as of a gear or of a joint that follows another.

    .. math::  c^T \dot q = \delta\,(c_0 - c^T q)

    It is a limit where the tasks yield: a linkage is not pulled apart.

    Attributes:
        coefficients: c by joint name.
        offset: c_0 [rad].
    """

    _checks: ClassVar[Checks] = {"coefficients": numbers_of, "offset": checks.finite}
    row_weight = 0.0
    coefficients: Mapping[str, float]
    offset: float = 0.0

    def _relations(self) -> list[tuple[Mapping[str, float], float]]:
        return [(self.coefficients, self.offset)]
