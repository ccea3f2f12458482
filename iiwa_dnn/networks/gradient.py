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

from iiwa_dnn.networks.activations import Linear
from iiwa_dnn.networks.base import Flow, kkt_product
from iiwa_dnn.networks.kkt_system import KktSystem
from iiwa_dnn.networks.primal_dual import variational
from iiwa_dnn.networks.zeroing import ZeroingNetwork
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class GradientNetwork(ZeroingNetwork):
    """The gradient network; the zeroing network's activation and form, no integral, no growth."""

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count, for each evaluation, the residual and a product with W^T; sizes are (n, m, p)."""
        return 0.0, 2.0 * kkt_product(sizes)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set a program up; its rate of change has no effect.

        Steps of explicit Euler are stable below 2 / ||W||^2, if the activation is linear. Over all
        active sets of the projected form, W has the rows of the whole KKT matrix or the identity's.
        """
        system = KktSystem(qp, self.form)

        def rates(state: Vector) -> Vector:
            error, _ = system.evaluate(state)
            result: Vector = -system.matrix.T @ self.activation(error)
            return result

        def jacobian(state: Vector) -> Matrix:
            system.evaluate(state)
            result: Matrix = -system.matrix.T @ system.matrix
            return result

        def step(state: Vector | None) -> float:
            if state is None:
                return 2.0 / (float(np.linalg.norm(variational(qp)[0], 2)) ** 2 + 1.0)
            system.evaluate(state)
            return 2.0 / max(float(np.linalg.norm(system.matrix, 2)) ** 2, 1.0)

        # W is constant on an active set of the projected form.
        exact = self.form == "projected" and isinstance(self.activation, Linear)
        return Flow(rates, jacobian if exact else None, step=step)
