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

**A network whose clock runs by the size of its own rates**, in finite-, fixed- and predefined-time
forms: for a network :math:`\rho\,\dot s = F(s)` and an activation :math:`\Phi`,

.. math::  \rho\,\dot s = \Phi(\|F(s)\|)\,\frac{F(s)}{\|F(s)\|} .

The trajectories are those of the network, run through at another speed, so that the equilibria and
the set from which it converges stay. Where :math:`\tfrac{d}{dt}\tfrac12\|s-s^*\|^2 \le
-c\,\|F\|^2/\rho` and :math:`\|F\| \ge \kappa\,\|s-s^*\|` along the way, the error
:math:`w = \kappa\,\|s - s^*\|` falls at least as :math:`\rho\,\dot w = -c\,\kappa^2\,\Phi(w)`: it
settles within :math:`\int_0^w de/\Phi(e) / (c\,\kappa^2)` [rho].

Source: K. Garg, D. Panagou, "Fixed-time stable gradient flows: applications to continuous-time
optimization", IEEE Transactions on Automatic Control 66 (2021), whose scaling by the norm is taken
for every network here.
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass, field, fields

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.networks.base import Flow, Network, checked_flow
from iiwa_dnn.networks.dual import DualNetwork
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True)
class Activation(ABC):
    """An odd, increasing function of an error, entry by entry."""

    def __post_init__(self) -> None:
        """Check the parameters: above 0."""
        for each in fields(self):
            checks.positive(each.name, getattr(self, each.name))

    def __call__(self, error: Vector) -> Vector:
        """Evaluate at errors (...,)."""
        return np.asarray(np.copysign(self.magnitude(np.abs(error)), error))

    @abstractmethod
    def magnitude(self, size: Vector) -> Vector:
        """Evaluate at errors of sizes (...,) of at least 0."""


@dataclass(frozen=True)
class Linear(Activation):
    """Phi(e) = e: the error decays like exp(-t / rho)."""

    def magnitude(self, size: Vector) -> Vector:
        """Return the sizes (...,)."""
        return size


@dataclass(frozen=True)
class PowerSigmoid(Activation):
    r"""A bipolar sigmoid for :math:`|e| < 1`, :math:`|e|^p` beyond: faster than linear both ways.

    Attributes:
        exponent: p, at least 1.
        slope: Steepness xi of the sigmoid, normed to 1 at e = 1; its slope at 0 is above xi / 2.
    """

    exponent: float = 3.0
    slope: float = 4.0

    def magnitude(self, size: Vector) -> Vector:
        """Evaluate at sizes (...,)."""
        half = 0.5 * self.slope
        below = np.tanh(half * size) / np.tanh(half)
        return np.where(size < 1.0, below, size**self.exponent)


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

    def magnitude(self, size: Vector) -> Vector:
        """Evaluate at sizes (...,)."""
        return np.asarray(self.low * size**self.power + self.high * size**self.upper_power)


SIGN_BI_POWER = FixedTime(0.5, 2.0, 0.5, 0.5)
"""The sign-bi-power activation, published as finite-time: it settles within 6, as with any r and
s = 1/r within 2 (1 + r) / (1 - r)."""


@dataclass(frozen=True)
class PredefinedTime(Activation):
    r"""An exponential of a power, :math:`\exp(|e|^p)\,|e|^{1-p}/(p\,T)`.

    From :math:`e_0` an error settles in :math:`T(1 - e^{-|e_0|^p}) < T`.

    Attributes:
        time: T [rho].
        power: p, above 0 and below 1.
    """

    time: float = 1.0
    power: float = 0.5

    def magnitude(self, size: Vector) -> Vector:
        """Evaluate at sizes (...,); the exponent is cut lest it overflow."""
        grown = np.exp(np.minimum(size**self.power, 300.0))
        return np.asarray(grown * size ** (1.0 - self.power) / (self.power * self.time))


@dataclass(frozen=True, kw_only=True)
class ActivatedNetwork(Network):
    """A network whose rates F are scaled to the norm Phi(f), f that of F: Phi(f) / f F.

    Attributes:
        network: The network that gives F; its own time constant is not used.
        activation: Phi; with `Linear` the rates stay as they are.
    """

    network: Network = field(default_factory=DualNetwork)
    activation: Activation = SIGN_BI_POWER

    @property
    def carries_x(self) -> bool:  # type: ignore[override]
        """True if the network's state begins with x."""
        return self.network.carries_x

    def state_size(self, qp: QP) -> int:
        """Count the network's states."""
        return self.network.state_size(qp)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of the network inside, for sizes (n, m, p); see `Network.work`."""
        return self.network.work(sizes)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the network inside up for a program, and scale its rates.

        The derivative is that at a constant speed, with which a long implicit step is Newton's.
        """
        inner = checked_flow(self.network, qp, rate)

        def rates(state: Vector) -> Vector:
            values = inner.rates(state)
            return values * self._speed(values)

        def jacobian(state: Vector) -> Matrix:
            return self._speed(inner.rates(state)) * inner.derivative(state)

        return Flow(rates, jacobian, inner.unknowns)

    def _speed(self, rates: Vector) -> float:
        """Compute Phi(|F|) / |F| of rates F (size,); 1 if their norm is 0 or not finite."""
        size = np.sqrt(rates @ rates)
        if not 0.0 < size < np.inf:
            return 1.0
        return float(self.activation(size)) / float(size)
