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

from iiwa_dnn.networks.activations import Activation, SignBiPower, enter_magnitude
from iiwa_dnn.networks.base import (
    RATES,
    Flow,
    Network,
    Rates,
    difference_jacobian,
    enter_rates,
    settings_of,
)
from iiwa_dnn.networks.dual import DualNetwork
from iiwa_dnn.qp.layout import QPViews, Sizes, Triple, Vector, compiled
from iiwa_dnn.qp.program import QP


@compiled
def activated_rates(qp: QPViews, constants: Vector, state: Vector, rates: Vector) -> None:
    """Write the rates (size,) of the network inside, scaled; see `ActivatedNetwork.prepare`.

    An address below 2^53 is a float without rounding.
    """
    first = 3 + int(constants[2])
    enter_rates(int(constants[0]), qp, constants[first:], state, rates)
    square = 0.0
    for i in range(state.size):
        square += rates[i] * rates[i]
    size = np.sqrt(square)
    if 0.0 < size < np.inf:
        scale = enter_magnitude(int(constants[1]), size, constants[3:first]) / size
        for i in range(state.size):
            rates[i] *= scale


@dataclass(frozen=True, kw_only=True)
class ActivatedNetwork(Network):
    """A network of the package or of one's own, with an activation of the norm of its rates.

    Attributes:
        network: The network; its own time constant is not used.
        activation: Phi.
    """

    network: Network = field(default_factory=DualNetwork)
    activation: Activation = field(default_factory=SignBiPower)
    compiled_rates = staticmethod(activated_rates)

    @property
    def carries_x(self) -> bool:  # type: ignore[override]
        """True if the network's state begins with x."""
        return self.network.carries_x

    def state_size(self, qp: QP) -> int:
        """Count the network's states."""
        return self.network.state_size(qp)

    def rates_function(self) -> Rates | None:
        """Return the compiled function, if the network inside has one."""
        return None if self.network.rates_function() is None else super().rates_function()

    def prepare(self, qp: QP) -> Vector:
        """Return addresses and constants of activation and network inside, (k,)."""
        inner = self.network.rates_function()
        assert inner is not None  # of those with one `prepare` is asked
        own = self.activation.constants
        head = [float(RATES.address(inner)), float(self.activation.address), float(own.size)]
        return np.concatenate([head, own, self.network.prepare(qp)])

    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side for this program; its derivative by differences."""
        if self.rates_function() is not None:
            return super().flow(qp)
        inner = self.network.flow(qp).rates

        def rates(state: Vector) -> Vector:
            result = inner(state)
            size = np.sqrt(result @ result)
            if 0.0 < size < np.inf:
                result *= self.activation(np.array([size])) / size
            return result

        return Flow(rates, lambda state: difference_jacobian(rates, state))

    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point of a state (state_size,) into `point`; returns its residuals."""
        return self.network.read(qp, state, point)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the work of the network inside; sizes are (n, m, p)."""
        return self.network.work(sizes)

    def linear_limit(self, qp: QP, state: Vector) -> float:
        """Compute the limit [rho] of the network inside at its speed at the state (size,)."""
        return self._slowed(qp, state, self.network.linear_limit(qp, state))

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """Bound the steps [rho] at this state; 0 without one: near rest none may be stable."""
        if state is None:
            return 0.0
        return self._slowed(qp, state, self.network.stable_step(qp, state))

    def _slowed(self, qp: QP, state: Vector, step: float) -> float:
        """Return the step of the network inside in the time of this one."""
        size = float(np.linalg.norm(self.network.rates(qp, state)))
        return step * size / float(self.activation(np.array([size]))[0]) if size > 0.0 else step

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        parts = {"network": self.network.settings(), "activation": settings_of(self.activation)}
        return {**settings_of(self), **parts}
