r"""The one-layer projection network of a linear variational inequality.

With H, c and :math:`\Omega` of `iiwa_dnn.networks.primal_dual` and :math:`u = [x; y; z]`,

.. math::

    \rho\,\dot u = \Pi_\Omega\bigl(u - \alpha (H u + c)\bigr) - u
        \quad \Bigl( +\, \alpha\,\bigl[(H u + c) - (H v + c)\bigr],
        \quad v = \Pi_\Omega(u - \alpha (H u + c)) \Bigr).

The part in brackets, the correction, makes it converge from anywhere for every monotone H with
:math:`\alpha\,\|H\| < 1`: :math:`\tfrac{d}{dt}\tfrac12\|u-u^*\|^2 \le
-(1-\alpha\|H\|)\,\|v - u\|^2/\rho`. Without it this is the simplified primal-dual network, the
paper's without its second multipliers of the bounds: it converges for every positive definite P, by
the function of docs/theory.md.

Sources: Y. Xia, J. Wang, "A general projection neural network for solving monotone variational
inequalities and related optimization problems", IEEE Transactions on Neural Networks 15 (2004);
the correction is that of P. Tseng, "A modified forward-backward splitting method for maximal
monotone mappings", SIAM Journal on Control and Optimization 38 (2000), as a flow.
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.clipped import Clipped, clipped_rates
from iiwa_dnn.networks.primal_dual import PrimalDualNetwork, constant, coupling, limits
from iiwa_dnn.qp.layout import Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class OneLayerNetwork(PrimalDualNetwork):
    """The one-layer network, with n + p + m states.

    Attributes:
        share: Share of alpha ||H||, above 0 and below 1.
        corrected: True for the convergent form, two products with H for each evaluation.
    """

    share: float = 0.5
    corrected: bool = True
    compiled_rates = staticmethod(clipped_rates)

    def __post_init__(self) -> None:
        """Check the parameters."""
        super().__post_init__()
        if not 0.0 < self.share < 1.0:
            raise InvalidInputError("share", f"must be in (0, 1), not {self.share}")

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count no set-up and a product with H, two with the correction; sizes are (n, m, p)."""
        setup, two = super().work(sizes)
        return setup, two if self.corrected else 0.5 * two

    def arrays(self, qp: QP) -> Clipped:
        """Set a program up."""
        H = coupling(qp)
        alpha = self.share / float(np.linalg.norm(H, 2))
        eye = np.eye(len(H))
        matrix = eye - alpha * H
        outer = matrix if self.corrected else eye
        return Clipped(matrix, -alpha * constant(qp), *limits(qp), outer)

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """Bound the steps [rho] that get nearer to every solution, of the corrected form."""
        return 2.0 * (1.0 - self.share) / (1.0 + self.share) ** 2
