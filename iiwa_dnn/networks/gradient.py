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
    """The gradient network, by activation and form of `ZeroingNetwork`; its other gains stay 0."""

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of a residual and a product with W^T; see `Network.work`."""
        return 0.0, 2.0 * kkt_product(sizes)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the network up for a program, whose rate of change is ignored."""

        def rates(state: Vector) -> Vector:
            error, _, matrix = evaluate(qp, self.form, state)
            return np.asarray(-matrix.T @ self.activation(error))

        return Flow(rates)
