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
from functools import lru_cache
from typing import ClassVar, NamedTuple

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import read_point
from iiwa_dnn.networks.clipped import Clipped, ClippedNetwork, clipped_rates
from iiwa_dnn.qp.layout import Matrix, Sizes, Triple, Vector, check_size
from iiwa_dnn.qp.program import QP


class _Dual(NamedTuple):
    """A program as its dual network has it.

    Attributes:
        lifted: M E^T, (n, rows).
        offset: s, (n,).
        gram: E M E^T, (rows, rows).
        base: E s, (rows,).
        lower: Lower limits of E x, (rows,).
        upper: Upper limits, (rows,).
        equalities: P^-1 A^T S^-1 of the simplified network, (n, p).
    """

    lifted: Matrix
    offset: Vector
    gram: Matrix
    base: Vector
    lower: Vector
    upper: Vector
    equalities: Matrix


@dataclass(frozen=True, kw_only=True)
class DualNetwork(ClippedNetwork):
    """The single-layer dual network, with p + m + n states: 14 for seven joints and rows.

    Raises:
        InvalidInputError: From any method but `state_size`: P is not positive definite.
    """

    carries_x: ClassVar[bool] = False
    simplified: ClassVar[bool] = False
    compiled_rates = staticmethod(clipped_rates)

    def state_size(self, qp: QP) -> int:
        """Count the states: one for each row and each variable."""
        n, m, p = qp.sizes
        return n + m + (0 if self.simplified else p)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count P's inverse, E M E^T and an evaluation's product; sizes are (n, m, p)."""
        n, m, p = sizes
        rows = m if self.simplified else m + p
        setup = 2.0 * n**3 + 2.0 * n * rows * (n + rows)
        if self.simplified:  # A M A^T, its factors, and what it takes from M
            setup += 4.0 * n * p * (n + p) + p**3 / 3.0
        return setup, 2.0 * (n + rows) ** 2

    def _dual(self, qp: QP) -> _Dual:
        return _lift(qp.data.tobytes(), qp.sizes, self.simplified)

    def arrays(self, qp: QP) -> Clipped:
        """Set a program up."""
        _, _, gram, base, lower, upper, _ = self._dual(qp)
        eye = np.eye(len(gram))
        return Clipped(gram - eye, base, lower, upper, eye, 1.0)

    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point of a state (state_size,) into `point`; returns its residuals."""
        n, m, p = qp.sizes
        check_size("state", state, self.state_size(qp))
        dual = self._dual(qp)
        x = dual.lifted @ state + dual.offset
        z = -state[: state.size - n]
        if self.simplified:
            gradient = qp.P @ x + qp.q - qp.G.T @ state[:m] - state[m:]
            z = np.concatenate([-dual.equalities.T @ gradient, z])
        return read_point(qp, np.concatenate([x, z]), point, n + m + p)

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        r"""Bound the stable steps of explicit Euler, in units of rho, on every active set.

        Rows at a limit follow :math:`-E M E^T`, the others decay at rate one: all eigenvalues are
        real, and none is below minus the largest of both.
        """
        return 2.0 / max(float(np.linalg.eigvalsh(self._dual(qp).gram)[-1]), 1.0)


@dataclass(frozen=True, kw_only=True)
class SimplifiedDualNetwork(DualNetwork):
    """The simplified dual network, with m + n states: 7 for seven joints and seven task rows."""

    simplified: ClassVar[bool] = True


@lru_cache(maxsize=4)  # a step of the network asks several times
def _lift(data: bytes, sizes: Sizes, simplified: bool) -> _Dual:
    """Lift a program; dependent equalities are solved in the least-squares sense."""
    qp = QP.from_data(np.frombuffer(data), sizes)
    try:
        inverse = np.linalg.inv(np.linalg.cholesky(qp.P))
    except np.linalg.LinAlgError:
        problem = "is singular, and a dual network needs its inverse; take another network"
        raise InvalidInputError("P", problem) from None
    M = inverse.T @ inverse
    offset = -M @ qp.q
    rows = np.eye(qp.q.size)
    lower = qp.lb
    upper = qp.ub
    equalities = np.empty((0, 0))
    if simplified:
        scaled = qp.A @ inverse.T
        equalities = inverse.T @ np.linalg.pinv(scaled, rcond=1e-10)
        M = M - equalities @ scaled @ inverse
        offset = equalities @ qp.b - M @ qp.q
    if qp.h.size:
        rows = np.vstack([qp.G, rows])
        lower = np.append(np.full(qp.h.size, -np.inf), lower)
        upper = np.append(qp.h, upper)
    if not simplified:
        rows = np.vstack([qp.A, rows])
        lower = np.append(qp.b, lower)
        upper = np.append(qp.b, upper)
    lifted = M @ rows.T
    return _Dual(lifted, offset, rows @ lifted, rows @ offset, lower, upper, equalities)
