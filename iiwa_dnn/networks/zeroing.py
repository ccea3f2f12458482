r"""The zeroing network, which removes the residual of the KKT conditions at a rate that is set.

The residual E(s, t) of the KKT conditions is to vanish along
:math:`\rho\,\dot E = -\Phi(E)`. With W its derivative in s and :math:`\partial_t E` the program's
part of its rate, each evaluation solves one linear system:

.. math::

    \rho\,\dot s = -W^{-1}\Bigl((1 + (t/\rho)^{k})\,\Phi(E)
        + \kappa \int E\,\tfrac{dt}{\rho} + \rho\,\partial_t E\Bigr)

For a program that is known with its rate, E decays at the activation's rate though the program
moves; no other network here does so. The integral rejects a constant disturbance of
:math:`\dot E` and leaves :math:`\rho^2 c / \kappa` of a ramp c t. The power k makes the gain grow.

Sources: Y. Zhang, S. S. Ge, "Design and analysis of a general recurrent neural network model for
time-varying matrix inversion", IEEE Transactions on Neural Networks 16 (2005); L. Jin, Y. Zhang,
S. Li, "Integration-enhanced Zhang neural network for real-time-varying matrix inversion in the
presence of various kinds of noises", IEEE Transactions on Neural Networks and Learning Systems 27
(2016); Z. Zhang et al., "A varying-parameter convergent-differential neural network for solving
joint-angular-drift problems of redundant robot manipulators", IEEE/ASME Transactions on
Mechatronics 23 (2018).
"""

from dataclasses import dataclass, field
from typing import get_args

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.activations import Activation, Linear
from iiwa_dnn.networks.base import Flow, Network, kkt_product
from iiwa_dnn.networks.kkt_residual import Form, evaluate, system_size
from iiwa_dnn.qp.layout import Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class ZeroingNetwork(Network):
    """The zeroing network, with n + p + m states, and as many again with the integral.

    Attributes:
        rho: Time constant [s]; the literature's gain gamma is 1 / rho.
        activation: Phi.
        form: ``"projected"`` or ``"smooth"`` complementarity; the latter has 2 n states more.
        integral: kappa, the gain of the integral in units of 1 / rho^2; 0 for none.
        growth: k, the power of the growing gain; 0 for a constant gain.
    """

    rho: float = 1e-2
    activation: Activation = field(default_factory=Linear)
    form: Form = "projected"
    integral: float = 0.0
    growth: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters; raises InvalidInputError naming the one that is wrong."""
        super().__post_init__()
        checks.one_of("form", self.form, get_args(Form))
        checks.not_negative("integral", self.integral)
        checks.not_negative("growth", self.growth)

    def state_size(self, qp: QP) -> int:
        """Count the states: unknowns, their integrals, and a clock for the growing gain."""
        return system_size(qp, self.form) * (1 + (self.integral > 0.0)) + (self.growth > 0.0)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of a residual, a drift and a solved system; see `Network.work`."""
        size = sum(sizes) + (2 * sizes[0] if self.form == "smooth" else 0)
        return 0.0, 2.0 * kkt_product(sizes) + 2.0 * size**3 / 3.0 + 2.0 * size**2

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the network up for a program and its rate of change [1/rho].

        The rates raise NoSolutionError where the derivative of the KKT conditions is singular.
        """
        size = system_size(qp, self.form)
        linear = isinstance(self.activation, Linear) and not (self.growth or self.integral)

        def rates(state: Vector) -> Vector:
            error, drift, matrix = evaluate(qp, self.form, state[:size], rate)
            wanted = self.removal(error, state) + drift
            result = np.ones(state.size)
            if self.integral:
                result[size : 2 * size] = error
            try:
                result[:size] = -np.linalg.solve(matrix, wanted)
            except np.linalg.LinAlgError:
                raise NoSolutionError("the derivative of the KKT conditions is singular") from None
            return result

        # Exact at rest; elsewhere it makes of a long implicit step Newton's.
        return Flow(rates, (lambda state: -np.eye(size)) if linear else None)

    def removal(self, error: Vector, state: Vector) -> Vector:
        """Return the rate (size,) at which a residual (size,) is removed at a state."""
        wanted = self.activation(error)
        if self.growth:
            wanted = (1.0 + abs(state[-1]) ** self.growth) * wanted
        if self.integral:
            wanted = wanted + self.integral * state[error.size : 2 * error.size]
        return wanted
