"""A circle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import Vector3, positive, vector3
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Reference, phase


@dataclass(frozen=True, eq=False)
class Circle(Reference):
    """A circle at constant speed, counter-clockwise about its normal.

    With w = 2 pi / period and (u, v, normal) right-handed and orthonormal::

        displacement(t) = radius ((cos(w t) - 1) u + sin(w t) v)

    u is the part of the world's x axis in the circle's plane, or of its y axis if x is nearly the
    normal. The circle starts at full speed, 2 pi radius / period, not at rest.

    Attributes:
        radius: Radius [m].
        period: Time to go round once [s].
        normal: Direction of the circle's axis; its length does not matter.

    Raises:
        InvalidInputError: If a parameter is not finite, radius or period is not above zero, or the
            normal is zero.
    """

    name: ClassVar[str] = "circle"
    radius: float = 0.05
    period: float = 10.0
    normal: Vector3 = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "radius", positive("radius", self.radius))
        object.__setattr__(self, "period", positive("period", self.period))
        object.__setattr__(self, "normal", vector3("normal", self.normal))
        if not any(self.normal):
            raise InvalidInputError("normal", "must not be zero", self.normal)

    def displacement(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.displacement`."""
        u, v = self._plane()
        p = phase(t, self.period)
        # -2 sin^2(p/2) is cos(p) - 1 without the cancellation near the start.
        return self.radius * (-2.0 * np.sin(p / 2.0) ** 2 * u + np.sin(p) * v)

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.velocity`."""
        u, v = self._plane()
        p = phase(t, self.period)
        return (2.0 * np.pi / self.period) * self.radius * (np.cos(p) * v - np.sin(p) * u)

    def _plane(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Orthonormal u and v, each of shape (3,), with u x v along the normal."""
        normal = np.array(self.normal) / np.abs(self.normal).max()  # its square may not underflow
        normal /= np.linalg.norm(normal)
        axis = np.eye(3)[0 if abs(normal[0]) < 0.9 else 1]
        u = axis - (axis @ normal) * normal
        u /= np.linalg.norm(u)
        return u, np.cross(normal, u)
