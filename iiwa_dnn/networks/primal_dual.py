r"""The primal-dual and the one-layer network of a linear variational inequality.

The KKT conditions say that :math:`u = [x; y; z]` solves a linear variational inequality on the set
:math:`\Omega = \{lb \le x \le ub,\; z \ge 0\}`, with

.. math::

    H = \begin{pmatrix} P & A^T & G^T \\ -A & 0 & 0 \\ -G & 0 & 0 \end{pmatrix}, \qquad
    c = \begin{pmatrix} q \\ b \\ h \end{pmatrix}, \qquad
    \rho\,\dot u = (I + H^T)\,\bigl\{ \Pi_\Omega\bigl(u - (H u + c)\bigr) - u \bigr\} .

H plus its transpose is positive semidefinite, which is all that is needed: with e the curly
bracket, :math:`\tfrac{d}{dt}\tfrac12\|u - u^*\|^2 \le -\|e\|^2/\rho` for every solution
:math:`u^*`. So it converges where P is singular too, if there is a solution, and explicit Euler
gets nearer at every step below :math:`2/\|I + H\|^2`.

Source: Y. Zhang, S. S. Ge, T. H. Lee, "A unified quadratic-programming-based dynamical system
approach to joint torque optimization of physically constrained redundant manipulators", IEEE
Transactions on Systems, Man, and Cybernetics B 34 (2004). The decrease is that of B. He, "A new
method for a class of linear variational inequalities", Mathematical Programming 66 (1994).

**The one-layer projection network** of the same inequality:

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
from typing import NamedTuple

import numpy as np

from iiwa_dnn.networks.base import Flow, Network, kkt_product
from iiwa_dnn.qp.layout import Matrix, Sizes, Vector
from iiwa_dnn.qp.program import QP

FRACTION = 0.5
"""Alpha times the norm of H in the one-layer network; alpha itself where H is zero."""


class Clipped(NamedTuple):
    r"""A network of k states that is affine but for one projection.

    .. math::  \rho\,\dot s = O\,\bigl\{\Pi_{[l,\,u]}(A s + k) - s - \kappa\,(A s + k)\bigr\}

    Attributes:
        matrix: A, (k, k).
        offset: k, (k,).
        lower: Lower limits l of what is projected, in the units of the states, (k,).
        upper: Upper limits u, in the units of the states, (k,).
        outer: O, (k, k).
        kappa: 1 where what is projected is taken off again, else 0.
    """

    matrix: Matrix
    offset: Vector
    lower: Vector
    upper: Vector
    outer: Matrix
    kappa: float = 0.0

    def rates(self, state: Vector) -> Vector:
        """Evaluate the rates at a state, (k,) both."""
        aim = self.matrix @ state + self.offset
        clipped = np.minimum(np.maximum(aim, self.lower), self.upper)
        result: Vector = self.outer @ (clipped - state - self.kappa * aim)
        return result

    def jacobian(self, state: Vector) -> Matrix:
        """Differentiate the rates at a state (k,), (k, k)."""
        aim = self.matrix @ state + self.offset
        inside = (aim > self.lower) & (aim < self.upper)
        inner = (inside - self.kappa)[:, np.newaxis] * self.matrix - np.eye(state.size)
        result: Matrix = self.outer @ inner
        return result


@dataclass(frozen=True, kw_only=True)
class PrimalDualNetwork(Network):
    """The primal-dual network, with n + p + m states: 14 for seven joints and seven rows."""

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of two products with H, and no set-up; see `Network.work`."""
        return 0.0, 2.0 * kkt_product(sizes)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the network up for a program, whose rate of change is ignored."""
        H, c, lower, upper = variational(qp)
        eye = np.eye(c.size)
        program = Clipped(eye - H, -c, lower, upper, eye + H.T)
        return Flow(program.rates, program.jacobian)


@dataclass(frozen=True, kw_only=True)
class OneLayerNetwork(PrimalDualNetwork):
    """The one-layer network, with n + p + m states.

    Attributes:
        corrected: True for the convergent form, two products with H for each evaluation.
    """

    corrected: bool = True

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of a product with H, or two if corrected; see `Network.work`."""
        setup, two = super().work(sizes)
        return setup, two if self.corrected else 0.5 * two

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the network up for a program, whose rate of change is ignored."""
        H, c, lower, upper = variational(qp)
        alpha = FRACTION / (float(np.linalg.norm(H, 2)) or 1.0)
        eye = np.eye(c.size)
        matrix = eye - alpha * H
        outer = matrix if self.corrected else eye
        program = Clipped(matrix, -alpha * c, lower, upper, outer)
        return Flow(program.rates, program.jacobian)


def variational(qp: QP) -> tuple[Matrix, Vector, Vector, Vector]:
    """Return H (k, k), c, and the lower and upper limits of Omega, (k,), with k = n + p + m.

    They are those of the variational inequality at the head of this module, for u = [x; y; z].
    """
    _, m, p = qp.sizes
    rows = np.vstack([qp.A, qp.G])
    H = np.block([[qp.P, rows.T], [-rows, np.zeros((p + m, p + m))]])
    lower = np.concatenate([qp.lb, np.full(p, -np.inf), np.zeros(m)])
    upper = np.concatenate([qp.ub, np.full(p + m, np.inf)])
    return H, np.concatenate([qp.q, qp.b, qp.h]), lower, upper
