"""What every scheme offers, and the position task that all of them share."""

from __future__ import annotations

import math
from typing import Any, Protocol, TypeVar

from numpy.typing import ArrayLike

from iiwa_dnn.configuration import Configuration
from iiwa_dnn.exceptions import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.references import Target

SchemeT = TypeVar("SchemeT", bound="Scheme")


class Scheme(Protocol):
    """One way to choose joint velocities among those that fulfil the task."""

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


def check_gain(name: str, value: float) -> None:
    """Raise InvalidInputError unless a feedback gain is a finite number that is not negative."""
    if not (math.isfinite(value) and value >= 0):
        raise InvalidInputError(name, f"must be a gain in 1/s of at least 0, not {value}", value)


def position_rows(conf: Configuration, target: Target, gain: float) -> tuple[Matrix, Vector]:
    r"""Rows of the position task, J dq = v_d + delta (p_d - p).

    Args:
        conf: Where the robot is, n joints.
        target: Where it should be.
        gain: Feedback gain delta [1/s].

    Returns:
        ``(rows, rhs)`` of shapes (3, n) and (3,) [m/s].
    """
    error = target.position - conf.position
    return conf.jacobian[:3], target.linear_velocity + gain * error
