"""A Lissajous figure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from iiwa_dnn.checks import Vector3, positive, vector3
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.base import Reference, phase


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
    amplitudes: Vector3 = (0.05, 0.05, 0.0)
    turns: Vector3 = (1.0, 2.0, 1.0)
    phases: Vector3 = (0.0, 0.0, 0.0)
    period: float = 10.0

    def __post_init__(self) -> None:
        for name in ("amplitudes", "turns", "phases"):
            object.__setattr__(self, name, vector3(name, getattr(self, name)))
        object.__setattr__(self, "period", positive("period", self.period))
        if not all(turns.is_integer() for turns in self.turns):
            raise InvalidInputError("turns", "must be whole numbers", self.turns)
        if not any(a * k for a, k in zip(self.amplitudes, self.turns, strict=True)):
            raise InvalidInputError("amplitudes", "nothing moves", self.amplitudes)

    def displacement(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.displacement`."""
        amplitudes, turns, phases = self._parameters()
        moved: NDArray[np.float64] = np.sin(turns * phase(t, self.period) + phases) - np.sin(phases)
        return amplitudes * moved

    def velocity(self, t: ArrayLike) -> NDArray[np.float64]:
        """See :meth:`Reference.velocity`."""
        amplitudes, turns, phases = self._parameters()
        rates = (2.0 * np.pi / self.period) * turns
        moved: NDArray[np.float64] = np.cos(turns * phase(t, self.period) + phases)
        return amplitudes * rates * moved

    def _parameters(self) -> list[NDArray[np.float64]]:
        """Amplitudes, turns and phases, each of shape (3,)."""
        return [np.array(v, np.float64) for v in (self.amplitudes, self.turns, self.phases)]
