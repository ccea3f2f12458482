r"""A yardstick that is no network: OSQP's alternating direction method, as a map of its state.

For rows :math:`l \le E x \le u` with multipliers y and their slack variables z, an iteration is

.. math::

    \tilde x &= (P + \sigma I + E^T R E)^{-1} (\sigma x - q + E^T (R z - y)), \qquad
    v = \alpha E \tilde x + (1 - \alpha) z \\
    x^+ &= \alpha \tilde x + (1 - \alpha) x, \qquad
    z^+ = \Pi_{[l,\,u]}(v + R^{-1} y), \qquad y^+ = y + R (v - z^+)

with :math:`\sigma = 10^{-6}`, :math:`\alpha = 1.6`, and R = 0.1, of equalities 100.

Source: B. Stellato, G. Banjac, P. Goulart, A. Bemporad, S. Boyd, "OSQP: an operator splitting
solver for quadratic programs", Mathematical Programming Computation 12 (2020).
"""

from dataclasses import dataclass

import numpy as np

from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.dual import two_sided
from iiwa_dnn.qp.layout import Sizes, Vector
from iiwa_dnn.qp.program import QP

_SIGMA = 1e-6
_ALPHA = 1.6


@dataclass(frozen=True, kw_only=True)
class AdmmIteration(Network):
    """OSQP without scaling, polishing and adaptation: an explicit step of one rho an iteration.

    The state is [x | y | z], of rows [A; G; I].
    """

    def state_size(self, qp: QP) -> int:
        """Count x, and two numbers for each row."""
        return qp.q.size + 2 * sum(qp.sizes)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of the factorisation and of one substitution; see `Network.work`."""
        size = sizes[0] + sum(sizes)
        return size**3 / 3.0, 2.0 * size**2

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the iteration up for a program, whose rate of change is ignored."""
        rows, lower, upper = two_sided(qp)
        weight = np.where(lower == upper, 100.0, 0.1)
        inverse = np.linalg.inv(qp.P + _SIGMA * np.eye(qp.q.size) + (rows.T * weight) @ rows)

        def rates(state: Vector) -> Vector:
            x, y, z = np.split(state, [qp.q.size, qp.q.size + lower.size])
            aim = inverse @ (_SIGMA * x - qp.q + rows.T @ (weight * z - y))
            moved = z + _ALPHA * (rows @ aim - z)
            clipped = np.clip(moved + y / weight, lower, upper)
            return np.concatenate([_ALPHA * (aim - x), weight * (moved - clipped), clipped - z])

        return Flow(rates)
