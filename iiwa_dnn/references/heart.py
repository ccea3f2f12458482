"""The paper's heart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import positive
from iiwa_dnn.references.base import Reference, phase


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
    scale: float = 3.45e-3
    period: float = 10.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "scale", positive("scale", self.scale))
        object.__setattr__(self, "period", positive("period", self.period))

    def displacement(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.displacement`."""
        p = phase(t, self.period)
        sine = np.sin(p)
        x = 16 * sine * sine * sine  # quicker than numpy's power
        y = 13 * np.cos(p) - 5 * np.cos(2 * p) - 2 * np.cos(3 * p) - np.cos(4 * p) - 5
        path: NDArray[np.float64] = np.concatenate((x, y, 0 * p), axis=-1)
        return self.scale * path

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.velocity`."""
        p = phase(t, self.period)
        x = 48 * np.sin(p) ** 2 * np.cos(p)
        y = -13 * np.sin(p) + 10 * np.sin(2 * p) + 6 * np.sin(3 * p) + 4 * np.sin(4 * p)
        rate = 2 * np.pi / self.period
        path: NDArray[np.float64] = np.concatenate((x, y, 0 * p), axis=-1)
        return rate * self.scale * path
