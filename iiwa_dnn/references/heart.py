"""The paper's heart."""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numba import njit

from iiwa_dnn.checks import positive
from iiwa_dnn.references.base import Array, Reference


@njit(cache=True, error_model="numpy")
def _path(times: Array, numbers: Array, out: Array, row: int, column: int) -> None:
    """Add displacement and velocity to targets (k, 18) in `out`; see `Reference.path`."""
    scale, rate = numbers[0], numbers[1]
    for k in range(times.size):
        p = rate * times[k]
        s1, c1 = np.sin(p), np.cos(p)
        out[row + k, column] += scale * 16.0 * s1 * s1 * s1
        y = 13.0 * c1 - 5.0 * np.cos(2.0 * p) - 2.0 * np.cos(3.0 * p) - np.cos(4.0 * p) - 5.0
        out[row + k, column + 1] += scale * y
        out[row + k, column + 12] += rate * scale * 48.0 * s1 * s1 * c1
        y = -13.0 * s1 + 10.0 * np.sin(2.0 * p) + 6.0 * np.sin(3.0 * p) + 4.0 * np.sin(4.0 * p)
        out[row + k, column + 13] += rate * scale * y


@dataclass(frozen=True, eq=False)
class Heart(Reference):
    """The heart of the paper's section V-A, in a horizontal plane.

    With w = 2 pi / period and a = scale::

        x(t) = x(0) + 16 a sin^3(w t)
        y(t) = y(0) + a (13 cos(w t) - 5 cos(2 w t) - 2 cos(3 w t) - cos(4 w t)) - 5 a
        z(t) = z(0)

    It starts in the notch, at rest, with its point towards -y. The paper gives neither a nor w.
    Its run takes 10 s, hence the default period. The default scale is an inference: with it, the
    largest squared joint speed times the step of 1e-4 s is the 4.54e-6 of the paper's Table I, and
    the heart is 32 a = 0.110 m wide.

    Attributes:
        scale: The factor a [m].
        period: Time to go round once [s].

    Raises:
        InvalidInputError: If a parameter is not a finite number above zero.
    """

    name: ClassVar[str] = "heart"
    path: ClassVar[Any] = staticmethod(_path)
    scale: float = 3.45e-3
    period: float = 10.0

    def __post_init__(self) -> None:
        self._set(scale=positive("scale", self.scale), period=positive("period", self.period))
        self._set(numbers=np.array([self.scale, 2.0 * np.pi / self.period]))
