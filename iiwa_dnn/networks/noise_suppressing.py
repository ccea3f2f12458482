r"""The noise-suppressing neural dynamics: a zeroing network with bounded activations in series.

With the residual E of the KKT conditions in its ``"smooth"`` form, the perturbed Fischer-Burmeister
function as the NCP function, and n the noise,

.. math::

    \rho\,\dot E = -\eta\,\Phi(E) - \gamma\,\Phi\bigl(E + \eta\,\Phi(Z)\bigr) + n, \qquad
    \rho\,\dot Z = E, \qquad \Phi(e) = \min(\max(e, -1), 1) .

Near rest :math:`\Phi` is linear and the integral takes a constant noise out that is below
:math:`\gamma\,\min(1, \eta)`, with :math:`Z \to n/(\gamma\,\eta)`; it is the noise-tolerant
zeroing network with the gains :math:`\gamma + \eta` and :math:`\gamma\,\eta`.

Source: L. Wei, L. Jin et al., "Noise-suppressing neural dynamics for time-dependent constrained
nonlinear optimization with applications", IEEE Transactions on Systems, Man, and Cybernetics:
Systems, equation (12); the form above was read out of the authors' published programs
(docs/papers.md), not of the text.
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.networks.kkt_residual import Form
from iiwa_dnn.networks.zeroing import ZeroingNetwork
from iiwa_dnn.qp.layout import Vector


@dataclass(frozen=True, kw_only=True)
class NoiseSuppressingNetwork(ZeroingNetwork):
    """The network with 2 (3 n + p + m) states: unknowns and the integrals of their residuals.

    Attributes:
        form: Form of the complementarity; ``"smooth"`` is the source's.
        integral: gamma, in units of 1 / rho.
        proportional: eta, in units of 1 / rho.
    """

    form: Form = "smooth"
    integral: float = 1.0
    proportional: float = 1.0

    def __post_init__(self) -> None:
        """Check the parameters."""
        super().__post_init__()
        checks.positive("integral", self.integral)
        checks.positive("proportional", self.proportional)

    def removal(self, error: Vector, state: Vector) -> Vector:
        """Return the rate (size,) at which a residual (size,) is removed."""
        summed = state[error.size : 2 * error.size]
        aim = error + self.proportional * np.clip(summed, -1.0, 1.0)
        own = self.proportional * np.clip(error, -1.0, 1.0)
        return np.asarray(own + self.integral * np.clip(aim, -1.0, 1.0))
