r"""A network whose clock runs by the size of its own rates: finite-, fixed-, predefined-time forms.

For a network :math:`\rho\,\dot s = F(s)` and an activation :math:`\Phi`,

.. math::  \rho\,\dot s = \Phi(\|F(s)\|)\,\frac{F(s)}{\|F(s)\|} .

The trajectories are those of the network, run through at another speed, so that the equilibria and
the set from which it converges stay. Where :math:`\tfrac{d}{dt}\tfrac12\|s-s^*\|^2 \le
-c\,\|F\|^2/\rho` and :math:`\|F\| \ge \kappa\,\|s-s^*\|` along the way, the error
:math:`w = \kappa\,\|s - s^*\|` falls at least as :math:`\rho\,\dot w = -c\,\kappa^2\,\Phi(w)`: it
settles within ``activation.settle_time(w) / (c kappa^2)`` [rho].

Source: K. Garg, D. Panagou, "Fixed-time stable gradient flows: applications to continuous-time
optimization", IEEE Transactions on Automatic Control 66 (2021), whose scaling by the norm is taken
for every network here.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from iiwa_dnn.networks.activations import Activation, SignBiPower
from iiwa_dnn.networks.base import Flow, Network, settings_of
from iiwa_dnn.networks.dual import DualNetwork
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class ActivatedNetwork(Network):
    """A network of the package or of one's own, with an activation of the norm of its rates.

    Attributes:
        network: The network; its own time constant is not used.
        activation: Phi.
    """

    network: Network = field(default_factory=DualNetwork)
    activation: Activation = field(default_factory=SignBiPower)

    @property
    def carries_x(self) -> bool:  # type: ignore[override]
        """True if the network's state begins with x."""
        return self.network.carries_x

    def state_size(self, qp: QP) -> int:
        """Count the network's states."""
        return self.network.state_size(qp)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the work of the network inside; sizes are (n, m, p)."""
        return self.network.work(sizes)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Scale the rates of the network inside, with stable steps at a state alone.

        The derivative is that at a constant speed: a long implicit step is then Newton's.
        """
        inner = self.network.flow(qp, rate)

        def rates(state: Vector) -> Vector:
            values = inner.rates(state)
            return values * self._speed(values)

        def jacobian(state: Vector) -> Matrix:
            return self._speed(inner.rates(state)) * inner.derivative(state)

        def step(state: Vector | None) -> float:
            if state is None or inner.step is None:
                return 0.0  # near rest none may be stable
            return inner.step(state) / self._speed(inner.rates(state))

        def limit(state: Vector) -> float:
            return inner.linear_limit(state) / self._speed(inner.rates(state))

        return Flow(rates, jacobian, inner.unknowns, step, limit=limit)

    def _speed(self, rates: Vector) -> float:
        """Compute the speed at which the network inside, with rates (size,), is run through."""
        size = np.sqrt(rates @ rates)
        if not 0.0 < size < np.inf:
            return 1.0
        return float(self.activation(size)) / float(size)

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        parts = {"network": self.network.settings(), "activation": settings_of(self.activation)}
        return {**settings_of(self), **parts}
