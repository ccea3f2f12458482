r"""The single-layer dual network.

Equalities, inequalities and bounds are one set of two-sided rows, :math:`\zeta^- \le E x \le
\zeta^+` with :math:`E = [A; G; I]`, :math:`\zeta^- = [b; -\infty; lb]` and :math:`\zeta^+ = [b; h;
ub]`. The state holds one number u for each row, and x is its output:

.. math::

    \rho\,\dot u = \Pi_{[\zeta^-,\,\zeta^+]}(E x - u) - E x, \qquad x = P^{-1}(E^T u - q) .

At rest :math:`E x = \Pi(E x - u)`, so a row is inside its limits and u is zero, or it is at one of
them and :math:`-u` is its multiplier with the right sign; :math:`P x + q - E^T u = 0` holds always.
The equilibria are exactly the KKT points. P has to be positive definite.

Source: Y. Zhang, J. Wang, Y. Xia, "A dual neural network for redundancy resolution of kinematically
redundant manipulators subject to joint limits and joint velocity limits", IEEE Transactions on
Neural Networks 14 (2003), with the inequality rows of Y. Zhang, J. Wang, "A dual neural network for
convex quadratic programming subject to linear equality and inequality constraints", Physics
Letters A 298 (2002).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Flow, Network, read_point
from iiwa_dnn.qp.layout import Matrix, Triple, Vector, check_size
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True)
class DualNetwork(Network):
    """The single-layer dual network, with p + m + n states: 14 for seven joints and rows.

    Raises:
        InvalidInputError: From any method but `state_size`: P is not positive definite.
    """

    carries_x: ClassVar[bool] = False

    def state_size(self, qp: QP) -> int:
        """Count the states: one for each row and each variable."""
        n, m, p = qp.sizes
        return n + m + p

    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side and its derivative for this program."""
        rows, lower, upper = _two_sided(qp)
        lifted = _solved(qp, rows.T)
        gram, offset = rows @ lifted, rows @ _solved(qp, qp.q)

        def rates(state: Vector) -> Vector:
            values = gram @ state - offset
            result: Vector = np.clip(values - state, lower, upper) - values
            return result

        def jacobian(state: Vector) -> Matrix:
            aim = gram @ state - offset - state
            inside = (aim > lower) & (aim < upper)
            result: Matrix = -gram
            result[inside] = 0.0
            result[inside, inside] = -1.0
            return result

        return Flow(rates, jacobian)

    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point of a state (state_size,) into `point`; returns its residuals."""
        n, m, p = qp.sizes
        check_size("state", state, n + m + p)
        rows, _, _ = _two_sided(qp)
        x = _solved(qp, rows.T @ state - qp.q)
        known = np.concatenate([x, -state[: p + m]])
        return read_point(qp, known, point, n + m + p)

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        r"""Bound the stable steps of explicit Euler, in units of rho, on every active set.

        Rows at a limit follow :math:`-E P^{-1} E^T`, the others decay at rate one: all eigenvalues
        are real, and none is below minus the largest of both.
        """
        rows, _, _ = _two_sided(qp)
        largest = float(np.linalg.eigvalsh(rows @ _solved(qp, rows.T))[-1])
        return 2.0 / max(largest, 1.0)


def _two_sided(qp: QP) -> tuple[Matrix, Vector, Vector]:
    """Stack all constraints as rows with two limits, ``(E, lower, upper)``."""
    rows = np.vstack([qp.A, qp.G, np.eye(qp.q.size)])
    lower = np.concatenate([qp.b, np.full(qp.h.size, -np.inf), qp.lb])
    return rows, lower, np.concatenate([qp.b, qp.h, qp.ub])


def _solved(qp: QP, right: Matrix) -> Matrix:
    """Multiply vectors by the inverse of P."""
    from scipy import linalg  # 0.05 s that only this network needs

    try:
        factor = linalg.cho_factor(qp.P, check_finite=False)
    except np.linalg.LinAlgError:
        raise InvalidInputError(
            "P", "is singular, and the dual network needs its inverse; take another network"
        ) from None
    solved: Matrix = linalg.cho_solve(factor, right, check_finite=False)
    return solved
