"""A straight line, there and back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import Vector3, positive, vector3
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Reference, phase


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
    offset: Vector3 = (0.1, 0.0, 0.0)
    period: float = 10.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "offset", vector3("offset", self.offset))
        object.__setattr__(self, "period", positive("period", self.period))
        if not any(self.offset):
            raise InvalidInputError("offset", "must not be zero", self.offset)

    def displacement(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.displacement`."""
        # sin^2(p/2) is (1 - cos(p)) / 2 without the cancellation near the start.
        return np.sin(phase(t, self.period) / 2.0) ** 2 * np.array(self.offset, dtype=np.float64)

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.velocity`."""
        rate = np.pi / self.period
        return rate * np.sin(phase(t, self.period)) * np.array(self.offset, dtype=np.float64)
