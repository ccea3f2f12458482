r"""The simplified dual network: a state for each inequality and bound only.

The equalities are solved for. With :math:`S = A P^{-1} A^T` and :math:`E = [G; I]`,

.. math::

    \rho\,\dot u = \Pi_{[\zeta^-,\,\zeta^+]}(E x - u) - E x, \qquad x = M E^T u + s,

    M = P^{-1} - P^{-1} A^T S^{-1} A P^{-1}, \qquad s = P^{-1} A^T S^{-1} b - M q .

Source: S. Liu, J. Wang, "A simplified dual neural network for quadratic programming with its KWTA
application", IEEE Transactions on Neural Networks 17 (2006).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Flow, Network, difference_jacobian, read_point
from iiwa_dnn.qp.layout import Matrix, Triple, Vector, check_size
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True)
class SimplifiedDualNetwork(Network):
    """The simplified dual network, with m + n states: 7 for seven joints and seven task rows.

    Raises:
        InvalidInputError: From any method but `state_size`: P is not positive definite.
    """

    carries_x: ClassVar[bool] = False

    def state_size(self, qp: QP) -> int:
        """Count the states: one for each inequality and each variable."""
        n, m, _ = qp.sizes
        return n + m

    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side for this program; its derivative by differences."""
        rows, M, offset = _reduced(qp)
        gram, base = rows @ M @ rows.T, rows @ offset
        lower = np.concatenate([np.full(qp.h.size, -np.inf), qp.lb])
        upper = np.concatenate([qp.h, qp.ub])

        def rates(state: Vector) -> Vector:
            values = gram @ state + base
            result: Vector = np.clip(values - state, lower, upper) - values
            return result

        return Flow(rates, lambda state: difference_jacobian(rates, state))

    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point of a state (state_size,) into `point`; returns its residuals."""
        n, m, p = qp.sizes
        check_size("state", state, n + m)
        rows, M, offset = _reduced(qp)
        x = M @ (rows.T @ state) + offset
        y = np.linalg.lstsq(qp.A.T, rows.T @ state - qp.q - qp.P @ x, rcond=1e-10)[0]
        return read_point(qp, np.concatenate([x, y, -state[:m]]), point, n + m + p)

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """Bound the stable steps of explicit Euler, in units of rho, on every active set."""
        rows, M, _ = _reduced(qp)
        return 2.0 / max(float(np.linalg.eigvalsh(rows @ M @ rows.T)[-1]), 1.0)


def _reduced(qp: QP) -> tuple[Matrix, Matrix, Vector]:
    """Solve the equalities; returns E, M and s, in the least-squares sense for dependent rows."""
    try:
        inverse = np.linalg.inv(np.linalg.cholesky(qp.P))
    except np.linalg.LinAlgError:
        raise InvalidInputError(
            "P", "is singular, and the simplified dual network needs its inverse"
        ) from None
    scaled = qp.A @ inverse.T
    lifted = inverse.T @ np.linalg.pinv(scaled, rcond=1e-10)
    M = inverse.T @ inverse - lifted @ scaled @ inverse
    return np.vstack([qp.G, np.eye(qp.q.size)]), M, lifted @ qp.b - M @ qp.q
