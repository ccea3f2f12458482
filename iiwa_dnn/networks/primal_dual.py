r"""The primal-dual network of a linear variational inequality.

The KKT conditions say that :math:`u = [x; y; z]` solves a linear variational inequality on the set
:math:`\Omega = \{lb \le x \le ub,\; z \ge 0\}`, with

.. math::

    H = \begin{pmatrix} P & A^T & G^T \\ -A & 0 & 0 \\ -G & 0 & 0 \end{pmatrix}, \qquad
    c = \begin{pmatrix} q \\ b \\ h \end{pmatrix}, \qquad
    \rho\,\dot u = (I + H^T)\,\bigl\{ \Pi_\Omega\bigl(u - (H u + c)\bigr) - u \bigr\} .

H plus its transpose is positive semidefinite, which is all that is needed: with e the curly
bracket, :math:`\tfrac{d}{dt}\tfrac12\|u - u^*\|^2 \le -\|e\|^2/\rho` for every solution
:math:`u^*`. So it settles where P is singular too, if there is a solution, and explicit Euler gets
nearer at every step below :math:`2/\|I + H\|^2`.

Source: Y. Zhang, S. S. Ge, T. H. Lee, "A unified quadratic-programming-based dynamical system
approach to joint torque optimization of physically constrained redundant manipulators", IEEE
Transactions on Systems, Man, and Cybernetics B 34 (2004). The decrease is that of B. He, "A new
method for a class of linear variational inequalities", Mathematical Programming 66 (1994).
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn.networks.base import kkt_product
from iiwa_dnn.networks.clipped import Clipped, ClippedNetwork, clipped_rates
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True, kw_only=True)
class PrimalDualNetwork(ClippedNetwork):
    """The primal-dual network, with n + p + m states: 14 for seven joints and seven rows."""

    compiled_rates = staticmethod(clipped_rates)

    def state_size(self, qp: QP) -> int:
        """Count the states: x and one multiplier for each row."""
        n, m, p = qp.sizes
        return n + m + p

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count no set-up and two products with H; sizes are (n, m, p)."""
        return 0.0, 2.0 * kkt_product(sizes)

    def arrays(self, qp: QP) -> Clipped:
        """Set a program up."""
        H = coupling(qp)
        eye = np.eye(len(H))
        return Clipped(eye - H, -constant(qp), *limits(qp), eye + H.T)

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """Bound the steps [rho] with which explicit Euler gets nearer to every solution."""
        H = coupling(qp)
        return 2.0 / float(np.linalg.norm(np.eye(len(H)) + H, 2)) ** 2


def coupling(qp: QP) -> Matrix:
    """Build H, of shape (n + p + m, n + p + m)."""
    n, m, p = qp.sizes
    H = np.zeros((n + p + m, n + p + m))
    rows = np.vstack([qp.A, qp.G])
    H[:n, :n] = qp.P
    H[:n, n:] = rows.T
    H[n:, :n] = -rows
    return H


def constant(qp: QP) -> Vector:
    """Return c, (n + p + m,)."""
    return np.concatenate([qp.q, qp.b, qp.h])


def limits(qp: QP) -> tuple[Vector, Vector]:
    """Return the set Omega: lower and upper limits of the state, (n + p + m,) each."""
    _, m, p = qp.sizes
    free = np.full(p, np.inf)
    lower = np.concatenate([qp.lb, -free, np.zeros(m)])
    return lower, np.concatenate([qp.ub, free, np.full(m, np.inf)])
