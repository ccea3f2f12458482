r"""The noise-suppressing neural dynamics: a zeroing network with bounded activations in series.

With the residual E of the KKT conditions in its ``"smooth"`` form, the perturbed Fischer-Burmeister
function as the NCP function (`iiwa_dnn.networks.kkt_system`), and n the noise,

.. math::

    \rho\,\dot E = -\eta\,\Phi(E) - \gamma\,\Phi\bigl(E + \eta\,\Phi(Z)\bigr) + n, \qquad
    \rho\,\dot Z = E, \qquad \Phi(e) = \min(\max(e, -1), 1) .

Near rest :math:`\Phi` is linear and the integral takes a constant noise out that is below
:math:`\gamma\,\min(1, \eta)`, with :math:`Z \to n/(\gamma\,\eta)`; it is the noise-tolerant
zeroing network with the gains :math:`\gamma + \eta` and :math:`\gamma\,\eta`.

Source: L. Wei, L. Jin et al., "Noise-suppressing neural dynamics for time-dependent constrained
nonlinear optimization with applications", IEEE Transactions on Systems, Man, and Cybernetics:
Systems, equation (12); the form above was read out of the authors' published programs
(docs/noise_suppressing.md), not of the text.
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.networks.kkt_system import Form
from iiwa_dnn.networks.zeroing import ZeroingNetwork
from iiwa_dnn.qp.layout import Vector


@dataclass(frozen=True, kw_only=True)
class NoiseSuppressingNetwork(ZeroingNetwork):
    """The network with 2 (3 n + p + m) states: unknowns and the integrals of their residuals.

    Attributes:
        form: Form of the complementarity; ``"smooth"`` is the source's.
        integral: gamma, in units of 1 / rho.
        proportional: eta, in units of 1 / rho.
        bound: Bound of the activations; the source's is 1.
        noise: Constant noise in the rate of the residual [1/rho].
    """

    form: Form = "smooth"
    integral: float = 1.0
    proportional: float = 1.0
    bound: float = 1.0
    noise: float = 0.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        super().__post_init__()
        for name in ("integral", "proportional", "bound"):
            checks.positive(name, getattr(self, name))
        checks.finite("noise", self.noise)

    def removal(self, error: Vector, state: Vector) -> Vector:
        """Return the rate (size,) at which a residual (size,) is removed, less the noise."""
        size = error.size
        bound = self.bound
        first = self.proportional * np.clip(error, -bound, bound)
        summed = self.proportional * np.clip(state[size : 2 * size], -bound, bound)
        second: Vector = self.integral * np.clip(error + summed, -bound, bound)
        return first + second - self.noise

    def step(self, state: Vector | None) -> float:
        """Bound the steps of explicit Euler [rho] near rest, where the activations are linear.

        The bound is the same at every state (size,). Both eigenvalues, -gamma and -eta, are real.
        """
        return 2.0 / max(self.integral, self.proportional)
