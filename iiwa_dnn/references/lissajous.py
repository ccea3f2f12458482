"""A Lissajous figure."""

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
    for k in range(times.size):
        for i in range(3):
            amplitude, rate, shift = numbers[i], numbers[3 + i], numbers[6 + i]
            angle = rate * times[k] + shift
            out[row + k, column + i] += amplitude * (np.sin(angle) - np.sin(shift))
            out[row + k, column + 12 + i] += amplitude * rate * np.cos(angle)


@dataclass(frozen=True, eq=False)
class Lissajous(Reference):
    """A closed Lissajous figure: on each axis a sine of a whole number of turns per period.

    With w = 2 pi / period, on each axis i::

        displacement_i(t) = amplitude_i (sin(turns_i w t + phase_i) - sin(phase_i))

    The default is a figure of eight in the horizontal plane. In general it does not start at rest.

    Attributes:
        amplitudes: Amplitudes on x, y, z [m], shape (3,).
        turns: Whole numbers of turns per period on x, y, z, shape (3,).
        phases: Phases at t = 0 on x, y, z [rad], shape (3,).
        period: Time to go round once [s].

    Raises:
        InvalidInputError: If a parameter is not finite, the period is not above zero, a number of
            turns is not whole, or nothing moves.
    """

    name: ClassVar[str] = "lissajous"
    path: ClassVar[Any] = staticmethod(_path)
    amplitudes: Vector3 = (0.05, 0.05, 0.0)
    turns: Vector3 = (1.0, 2.0, 1.0)
    phases: Vector3 = (0.0, 0.0, 0.0)
    period: float = 10.0

    def __post_init__(self) -> None:
        for name in ("amplitudes", "turns", "phases"):
            self._set(**{name: vector3(name, getattr(self, name))})
        self._set(period=positive("period", self.period))
        if not all(turns.is_integer() for turns in self.turns):
            raise InvalidInputError("turns", "must be whole numbers", self.turns)
        if not any(a * k for a, k in zip(self.amplitudes, self.turns, strict=True)):
            raise InvalidInputError("amplitudes", "nothing moves", self.amplitudes)
        rates = (2.0 * np.pi / self.period) * np.array(self.turns)
        self._set(numbers=np.concatenate([self.amplitudes, rates, self.phases]))
