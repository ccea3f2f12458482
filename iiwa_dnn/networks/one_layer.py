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
from iiwa_dnn.networks.base import Flow
from iiwa_dnn.networks.clipped import Clipped
from iiwa_dnn.networks.primal_dual import PrimalDualNetwork, variational
from iiwa_dnn.qp.layout import Sizes
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

    def __post_init__(self) -> None:
        """Check the parameters."""
        super().__post_init__()
        if not 0.0 < self.share < 1.0:
            raise InvalidInputError("share", f"must be in (0, 1), not {self.share}")

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count no set-up and a product with H, two with the correction; sizes are (n, m, p)."""
        setup, two = super().work(sizes)
        return setup, two if self.corrected else 0.5 * two

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set a program up, with the steps that get nearer to every solution, if corrected."""
        H, c, lower, upper = variational(qp)
        alpha = self.share / float(np.linalg.norm(H, 2))
        eye = np.eye(c.size)
        matrix = eye - alpha * H
        outer = matrix if self.corrected else eye
        step = 2.0 * (1.0 - self.share) / (1.0 + self.share) ** 2
        return Clipped(matrix, -alpha * c, lower, upper, outer).flow(qp, step)
