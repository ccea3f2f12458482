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
from iiwa_dnn.networks.base import Flow, difference_jacobian, kkt_product
from iiwa_dnn.networks.kkt_system import KktSystem
from iiwa_dnn.networks.primal_dual import coupling
from iiwa_dnn.networks.zeroing import ZeroingNetwork
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class GradientNetwork(ZeroingNetwork):
    """The gradient network; the zeroing network's activation and form, no integral, no growth."""

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count, for each evaluation, the residual and a product with W^T; sizes are (n, m, p)."""
        return 0.0, 2.0 * kkt_product(sizes)

    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side for this program; its derivative by differences."""
        system = KktSystem(qp, self.form)

        def rates(state: Vector) -> Vector:
            error, _ = system.evaluate(state)
            result: Vector = -system.matrix.T @ self.activation(error)
            return result

        def jacobian(state: Vector) -> Matrix:
            if self.form == "smooth" or not isinstance(self.activation, Linear):
                return difference_jacobian(rates, state)
            system.evaluate(state)  # W is constant on an active set
            result: Matrix = -system.matrix.T @ system.matrix
            return result

        return Flow(rates, jacobian)

    def moving_flow(self, qp: QP, rate: QP) -> Flow:
        """Make the same right-hand side: the rate of the program is not used."""
        return self.flow(qp)

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """Bound the stable steps of explicit Euler [rho]: 2 / ||W||^2, of a linear activation.

        Without a state W is bounded over all active sets of the projected form, whose rows are
        those of the whole KKT matrix or of the identity.
        """
        if state is None:
            return 2.0 / (float(np.linalg.norm(coupling(qp), 2)) ** 2 + 1.0)
        system = KktSystem(qp, self.form)
        system.evaluate(state)
        return 2.0 / max(float(np.linalg.norm(system.matrix, 2)) ** 2, 1.0)
