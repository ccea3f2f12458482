r"""The gradient network: steepest descent on half the squared residual of the KKT conditions.

.. math::  \rho\,\dot s = -W^T E(s), \qquad W = \partial E / \partial s

It needs one product where the zeroing network solves a linear system, and decays at the smallest
eigenvalue of :math:`W^T W`, the square of the program's condition; behind a program that moves at
a speed v it lags by about :math:`\rho\,v/\lambda_{min}`.

Source: Y. Zhang, K. Chen, H.-Z. Tan, "Performance analysis of gradient neural network exploited for
online time-varying matrix inversion", IEEE Transactions on Automatic Control 54 (2009).
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn.networks.base import Flow, kkt_product
from iiwa_dnn.networks.kkt_residual import evaluate
from iiwa_dnn.networks.zeroing import ZeroingNetwork
from iiwa_dnn.qp.layout import Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class GradientNetwork(ZeroingNetwork):
    """The gradient network; the zeroing network's activation and form, no integral, no growth."""

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count, for each evaluation, the residual and a product with W^T; sizes are (n, m, p)."""
        return 0.0, 2.0 * kkt_product(sizes)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set a program up; its rate of change has no effect."""

        def rates(state: Vector) -> Vector:
            error, _, matrix = evaluate(qp, self.form, state)
            return np.asarray(-matrix.T @ self.activation(error))

        return Flow(rates)
