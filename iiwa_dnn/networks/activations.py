r"""Activations of an error: odd, increasing functions that set how fast a network removes it.

With :math:`\rho\,\dot e = -\Phi(e)` an error settles within :math:`\rho\int_0^{|e_0|} de/\Phi(e)`.
Every bound below is that integral, or one that leaves out a part of :math:`\Phi`.

Sources: Y. Zhang, D. Jiang, J. Wang, "A recurrent neural network for solving Sylvester equation
with time-varying coefficients", IEEE Transactions on Neural Networks 13 (2002) (power-sigmoid);
S. Li, S. Chen, B. Liu, "Accelerating a recurrent neural network to finite-time convergence for
solving time-varying Sylvester equation by using a sign-bi-power activation function", Neural
Processing Letters 37 (2013); A. Polyakov, "Nonlinear feedback design for fixed-time stabilization
of linear control systems", IEEE Transactions on Automatic Control 57 (2012); J. D.
Sanchez-Torres, E. N. Sanchez, A. G. Loukianov, "Predefined-time stability of dynamical systems
with sliding modes", American Control Conference (2015).
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import cached_property
from typing import ClassVar

import numpy as np
from numba import types

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.compiling import VECTOR, Signature
from iiwa_dnn.qp.layout import Vector, compiled

MAGNITUDE = Signature(types.float64, types.float64, VECTOR)
"""Types of an activation's compiled function."""

enter_magnitude = MAGNITUDE.enter


@compiled
def activate(address: int, constants: Vector, error: Vector, value: Vector) -> None:
    """Write the values (k,) at errors (k,), of the function at an address with constants (j,)."""
    for i in range(error.size):
        magnitude = enter_magnitude(address, abs(error[i]), constants)
        value[i] = np.copysign(magnitude, error[i])


@dataclass(frozen=True)
class Activation(ABC):
    """An odd, increasing function of an error, entry by entry.

    Attributes:
        magnitude: Its value at an error of a size of at least 0, ``(size, constants)``, as a static
            compiled function; the constants are the fields, in their order.
    """

    magnitude: ClassVar[staticmethod[[float, Vector], float]]

    def __post_init__(self) -> None:
        """Check the parameters: above 0, `power` below 1 and `upper_power` above 1."""
        for field in fields(self):
            checks.positive(field.name, getattr(self, field.name))
        if not getattr(self, "power", 0.5) < 1.0:
            raise InvalidInputError("power", "must be below 1")
        if not getattr(self, "upper_power", 2.0) > 1.0:
            raise InvalidInputError("upper_power", "must be above 1")

    @cached_property
    def constants(self) -> Vector:
        """The fields in their order, (j,)."""
        return np.array([getattr(self, field.name) for field in fields(self)], dtype=np.float64)

    @property
    def address(self) -> int:
        """Address of the compiled function."""
        function: Callable[[float, Vector], float] = type(self).magnitude
        return MAGNITUDE.address(function)

    def __call__(self, error: Vector) -> Vector:
        """Evaluate at errors (...,)."""
        value = np.empty(error.shape)
        flat = np.ascontiguousarray(error, dtype=np.float64).ravel()
        activate(self.address, self.constants, flat, value.reshape(-1))
        return value

    def settle_time(self, error: float) -> float:
        """Bound the time [rho] in which an error of this size vanishes; inf where it never does."""
        return np.inf


@compiled
def _linear(size: float, constants: Vector) -> float:
    """Return the size; there are no constants, (0,)."""
    return size


@dataclass(frozen=True)
class Linear(Activation):
    """Phi(e) = e: the error decays like exp(-t / rho)."""

    magnitude = staticmethod(_linear)


@compiled
def _power_sigmoid(size: float, constants: Vector) -> float:
    """Evaluate for constants [exponent, slope], (2,)."""
    if size < 1.0:
        half = 0.5 * constants[1]
        return np.tanh(half * size) / np.tanh(half)  # type: ignore[no-any-return]
    return size ** constants[0]  # type: ignore[no-any-return]


@dataclass(frozen=True)
class PowerSigmoid(Activation):
    r"""A bipolar sigmoid for :math:`|e| < 1`, :math:`|e|^p` beyond: faster than linear both ways.

    Attributes:
        exponent: p, at least 1.
        slope: Steepness xi of the sigmoid, normed to 1 at e = 1; its slope at 0 is above xi / 2.
    """

    exponent: float = 3.0
    slope: float = 4.0

    magnitude = staticmethod(_power_sigmoid)


@compiled
def _fixed_time(size: float, constants: Vector) -> float:
    """Evaluate for constants [power, upper power, low, high], (4,)."""
    value: float = constants[2] * size ** constants[0] + constants[3] * size ** constants[1]
    return value


@dataclass(frozen=True)
class FixedTime(Activation):
    r"""Two powers, :math:`a\,|e|^r + b\,|e|^s` with r < 1 < s: settles in a fixed time.

    Within :math:`1/(a(1-r)) + 1/(b(s-1))` from any start, and within
    :math:`|e_0|^{1-r}/(a(1-r))` from :math:`e_0`.

    Attributes:
        power: r, above 0 and below 1.
        upper_power: s, above 1.
        low: a.
        high: b.
    """

    power: float = 0.5
    upper_power: float = 2.0
    low: float = 1.0
    high: float = 1.0

    magnitude = staticmethod(_fixed_time)

    def settle_time(self, error: float) -> float:
        """Return the smaller of the two bounds [rho]."""
        below = 1.0 / (self.low * (1.0 - self.power))
        beyond = 1.0 / (self.high * (self.upper_power - 1.0))
        return float(min(below + beyond, below * abs(error) ** (1.0 - self.power)))


@compiled
def _sign_bi_power(size: float, constants: Vector) -> float:
    """Evaluate for constants [power], (1,)."""
    value: float = 0.5 * (size ** constants[0] + size ** (1.0 / constants[0]))
    return value


@dataclass(frozen=True)
class SignBiPower(Activation):
    r"""Two powers, :math:`\tfrac12(|e|^r + |e|^{1/r})`: `FixedTime` with one parameter.

    Published as finite-time, it settles in a fixed time too: at most 2 (1 + r) / (1 - r).

    Attributes:
        power: r, above 0 and below 1.
    """

    power: float = 0.5

    magnitude = staticmethod(_sign_bi_power)

    def settle_time(self, error: float) -> float:
        """Return the bound [rho] of the same two powers."""
        return FixedTime(self.power, 1.0 / self.power, 0.5, 0.5).settle_time(error)


@compiled
def _predefined_time(size: float, constants: Vector) -> float:
    """Evaluate for constants [time, power], (2,); the exponent is cut lest it overflow."""
    power = constants[1]
    grown = np.exp(min(size**power, 300.0))
    value: float = grown * size ** (1.0 - power) / (power * constants[0])
    return value


@dataclass(frozen=True)
class PredefinedTime(Activation):
    r""":math:`\exp(|e|^p)\,|e|^{1-p}/(p\,T)`: settles in :math:`T(1 - e^{-|e_0|^p}) < T`.

    Attributes:
        time: T [rho].
        power: p, above 0 and below 1.
    """

    time: float = 1.0
    power: float = 0.5

    magnitude = staticmethod(_predefined_time)

    def settle_time(self, error: float) -> float:
        """Return the settle time itself [rho]."""
        return float(-self.time * np.expm1(-(abs(error) ** self.power)))
