"""A straight line, there and back."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numba import njit

from iiwa_dnn.checks import Vector3, positive, vector3
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Array, Reference


@njit(cache=True, error_model="numpy")
def _path(times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
    """Add displacement and velocity to targets (k, 18) in `out`; see `Reference.path`."""
    rate = numbers[0]
    for k in range(times.size):
        p = rate * times[k]
        # sin^2(p/2) is (1 - cos(p)) / 2 without the cancellation near the start.
        share, speed = np.sin(0.5 * p) ** 2, 0.5 * rate * np.sin(p)
        for i in range(3):
            out[row + k, column + i] += share * numbers[1 + i]
            out[row + k, column + 12 + i] += speed * numbers[1 + i]


@dataclass(frozen=True, eq=False)
class Line(Reference):
    """A straight line to a point and back, at rest at both ends.

    With w = 2 pi / period::

        displacement(t) = offset (1 - cos(w t)) / 2

    Attributes:
        offset: From the start to the far end [m], shape (3,).
        period: Time to go there and back [s].

    Raises:
        InvalidInputError: If a parameter is not finite, the offset is zero or the period is not
            above zero.
    """

    name: ClassVar[str] = "line"
    path: ClassVar[Any] = staticmethod(_path)
    offset: Vector3 = (0.1, 0.0, 0.0)
    period: float = 10.0

    def __post_init__(self) -> None:
        self._set(offset=vector3("offset", self.offset), period=positive("period", self.period))
        if not any(self.offset):
            raise InvalidInputError("offset", "must not be zero", self.offset)
        self._set(numbers=np.array([2.0 * np.pi / self.period, *self.offset]))
