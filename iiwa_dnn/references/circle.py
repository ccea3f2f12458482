"""A circle."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numba import njit

from iiwa_dnn.checks import Vector3, direction, positive, vector3
from iiwa_dnn.references.base import Array, Reference


@njit(cache=True, error_model="numpy")
def _path(times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
    """Add displacement and velocity to targets (k, 18) in `out`; see `Reference.path`."""
    radius, rate = numbers[0], numbers[1]
    for k in range(times.size):
        p = rate * times[k]
        # -2 sin^2(p/2) is cos(p) - 1 without the cancellation near the start.
        along_u, along_v = -2.0 * np.sin(0.5 * p) ** 2, np.sin(p)
        for i in range(3):
            u, v = numbers[2 + i], numbers[5 + i]
            out[row + k, column + i] += radius * (along_u * u + along_v * v)
            out[row + k, column + 12 + i] += rate * radius * (np.cos(p) * v - np.sin(p) * u)


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
    path: ClassVar[Any] = staticmethod(_path)
    radius: float = 0.05
    period: float = 10.0
    normal: Vector3 = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        self._set(radius=positive("radius", self.radius), period=positive("period", self.period))
        self._set(normal=vector3("normal", self.normal))
        normal = np.array(direction("normal", self.normal))
        axis = np.eye(3)[0 if abs(normal[0]) < 0.9 else 1]
        u = axis - (axis @ normal) * normal
        u /= np.linalg.norm(u)
        head = [self.radius, 2.0 * np.pi / self.period]
        self._set(numbers=np.concatenate([head, u, np.cross(normal, u)]))
