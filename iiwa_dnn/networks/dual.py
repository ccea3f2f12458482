r"""The dual networks: a state for each row, x is their output.

Equalities, inequalities and bounds are one set of two-sided rows, :math:`\zeta^- \le E x \le
\zeta^+` with :math:`E = [A; G; I]`, :math:`\zeta^- = [b; -\infty; lb]` and :math:`\zeta^+ = [b; h;
ub]`. The state holds one number u for each row:

.. math::

    \rho\,\dot u = \Pi_{[\zeta^-,\,\zeta^+]}(E x - u) - E x, \qquad x = M E^T u + s,

with :math:`M = P^{-1},\ s = -P^{-1} q`. At rest :math:`E x = \Pi(E x - u)`, so a row is inside its
limits and u is zero, or it is at one of them and :math:`-u` is its multiplier with the right sign;
:math:`P x + q - E^T u = 0` holds always. The equilibria are exactly the KKT points. P has to be
positive definite.

The simplified network solves the equalities, so that :math:`E = [G; I]`. With
:math:`S = A P^{-1} A^T`

.. math::

    M = P^{-1} - P^{-1} A^T S^{-1} A P^{-1}, \qquad s = P^{-1} A^T S^{-1} b - M q .

Sources: Y. Zhang, J. Wang, Y. Xia, "A dual neural network for redundancy resolution of
kinematically redundant manipulators subject to joint limits and joint velocity limits", IEEE
Transactions on Neural Networks 14 (2003), with the inequality rows of Y. Zhang, J. Wang, "A dual
neural network for convex quadratic programming subject to linear equality and inequality
constraints", Physics Letters A 298 (2002); S. Liu, J. Wang, "A simplified dual neural network for
quadratic programming with its KWTA application", IEEE Transactions on Neural Networks 17 (2006).
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.primal_dual import Clipped
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class DualNetwork(Network):
    """The single-layer dual network, with p + m + n states: 14 for seven joints and rows.

    Raises:
        InvalidInputError: From any method but `state_size`: P is not positive definite.
    """

    carries_x: ClassVar[bool] = False
    simplified: ClassVar[bool] = False

    def state_size(self, qp: QP) -> int:
        """Count the states: one a variable and one a row, without those of A if `simplified`."""
        n, m, p = qp.sizes
        return n + m + (0 if self.simplified else p)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of P's inverse and E M E^T, and of a product; see `Network.work`."""
        n, m, p = sizes
        rows = m if self.simplified else m + p
        setup = 2.0 * n**3 + 2.0 * n * rows * (n + rows)
        if self.simplified:  # A M A^T, its factors, and what it takes from M
            setup += 4.0 * n * p * (n + p) + p**3 / 3.0
        return setup, 2.0 * (n + rows) ** 2

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the network up; dependent equalities are solved in the least-squares sense."""
        n, m, p = qp.sizes
        rows, lower, upper = two_sided(qp, p if self.simplified else 0)
        try:
            inverse = np.linalg.inv(np.linalg.cholesky(qp.P))
        except np.linalg.LinAlgError:
            problem = "is singular, and a dual network needs its inverse; take another network"
            raise InvalidInputError("P", problem) from None
        M = inverse.T @ inverse
        offset = -M @ qp.q
        equalities = np.empty((n, 0))
        if self.simplified:
            scaled = qp.A @ inverse.T
            equalities = inverse.T @ np.linalg.pinv(scaled, rcond=1e-10)
            M = M - equalities @ scaled @ inverse
            offset = equalities @ qp.b - M @ qp.q
        lifted = M @ rows.T
        gram = rows @ lifted

        def unknowns(state: Vector) -> Vector:
            x = lifted @ state + offset
            z = -state[: state.size - n]
            if self.simplified:
                gradient = qp.P @ x + qp.q - qp.G.T @ state[:m] - state[m:]
                z = np.concatenate([-equalities.T @ gradient, z])
            return np.concatenate([x, z])

        eye = np.eye(len(gram))
        program = Clipped(gram - eye, rows @ offset, lower, upper, eye, 1.0)
        return Flow(program.rates, program.jacobian, unknowns)


@dataclass(frozen=True, kw_only=True)
class SimplifiedDualNetwork(DualNetwork):
    """The simplified dual network, with m + n states: 7 for seven joints and seven task rows."""

    simplified: ClassVar[bool] = True


def two_sided(qp: QP, first: int = 0) -> tuple[Matrix, Vector, Vector]:
    """Return the rows [A; G; I] from row `first` on, (k, n), and their two limits, (k,) each."""
    n, m, _ = qp.sizes
    rows = np.vstack([qp.A, qp.G, np.eye(n)])
    lower = np.concatenate([qp.b, np.full(m, -np.inf), qp.lb])
    return rows[first:], lower[first:], np.concatenate([qp.b, qp.h, qp.ub])[first:]
