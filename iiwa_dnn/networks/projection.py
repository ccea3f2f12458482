r"""The paper's projection network.

With the Lagrangian's gradient :math:`g = P x + q + A^T y + G^T z + u - l`,

.. math::

    \rho\,\dot x &= -x + \Pi_{[lb,\,ub]}(x - g) \\
    \rho\,\dot y &= A x - b \\
    \rho\,\dot z &= -z + [z + G x - h]_+ \\
    \rho\,\dot u &= -u + [u + x - ub]_+ \\
    \rho\,\dot l &= -l + [l + lb - x]_+

where u and l are the paper's :math:`\mu` for :math:`\Omega = [I; -I]`, :math:`\chi = [ub; -lb]`:
the bounds act twice, in the projection and in the multipliers. At rest ``x = proj(x - g)``, with
feasibility and complementarity: the equilibria are exactly the KKT points (docs/theory.md). The
state is one flat array, ``s = [x | y | z | u | l]``, and time is in units of rho.

Source: "Enhanced Orientation Tracking for Redundant Manipulators via DNN-Based Double Control",
section III, its slips corrected (docs/errata.md).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from iiwa_dnn.networks.base import CompiledForm, Flow, Network, read_point
from iiwa_dnn.qp.dense import add_scaled, dot, extreme_eigenvalues
from iiwa_dnn.qp.layout import Matrix, Triple, Vector, check_size, compiled, larger, offsets
from iiwa_dnn.qp.program import QP

_PROJECTED, _FREE = CompiledForm(project=True), CompiledForm(project=False)
_METHODS = ("state_size", "flow", "read", "stable_step")
"""Methods that the compiled loops stand in for."""


@dataclass(frozen=True)
class ProjectionNetwork(Network):
    """The paper's network for one quadratic program after another.

    Attributes:
        rho: Time constant [s].
        primal_projection: True if x goes through its bounds, as in the paper. Without it the
            bounds act through their multipliers alone; the equilibria are the same, and a
            backward Euler step becomes a convex problem
            (`iiwa_dnn.networks.integrators.implicit_steps`).
    """

    primal_projection: bool = True

    @property
    def compiled(self) -> CompiledForm | None:
        """The compiled loops, unless a subclass overrides a method that they stand in for."""
        own = type(self)
        if own is not ProjectionNetwork and any(
            getattr(own, name) is not getattr(ProjectionNetwork, name) for name in _METHODS
        ):
            return None
        return _PROJECTED if self.primal_projection else _FREE

    def state_size(self, qp: QP) -> int:
        """Count the states: n + p + m + 2n, 28 for seven joints and the paper's seven rows."""
        n, m, p = qp.sizes
        return 3 * n + p + m

    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side and its derivative for this program."""

        def rates(state: Vector) -> Vector:
            result = np.empty(state.size)
            self._field(qp, state, result)
            return result

        return Flow(rates, lambda state: self._jacobian(qp, state))

    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point of a state (state_size,) into `point`; returns its residuals."""
        return read_point(qp, state, point, self.state_size(qp))

    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        r"""Bound the stable steps of explicit Euler, in units of rho.

        On a fixed active set the network is linear. For an eigenvalue with eigenvector (v, w),
        \|v\| = 1, :math:`\lambda^2 + \pi\lambda + s = 0` with :math:`\pi = v^*Pv` and
        :math:`s = \|Cv\|^2`, C being the equality rows and the active inequality rows. Euler
        stays inside its circle where the step is below 2/pi (real pair) and pi/s (complex pair),
        so below ``min(2/max eig P, min eig P / max eig C^T C)``.

        Args:
            qp: The program.
            state: A state, (state_size,), whose active rows are counted; None counts every
                inequality row, and the bound holds on every active set.

        Returns:
            The bound; zero where P is singular, since then no step is known to be stable.
        """
        n, m, p = qp.sizes
        if state is None:
            # Both bounds of one variable are active together only if they coincide.
            bounded = (qp.ub < np.inf) | (qp.lb > -np.inf)
            active = np.concatenate([np.ones(m), bounded, qp.lb == qp.ub])
        else:
            active = self._field(qp, state, np.empty(state.size))
        return stable_step(qp.data, n, m, p, active)

    def _jacobian(self, qp: QP, state: Vector) -> Matrix:
        """Differentiate the rates, (state_size, state_size)."""
        n, _, p = qp.sizes
        rows = np.vstack([qp.A, qp.G, np.eye(n), -np.eye(n)])
        active = self._field(qp, state, np.empty(state.size)) > 0.0
        follows = np.concatenate([np.ones(p, dtype=bool), active])
        jacobian = np.zeros((state.size, state.size))
        jacobian[:n, :n], jacobian[:n, n:] = -qp.P, -rows.T
        jacobian[n:, :n] = np.where(follows[:, None], rows, 0.0)
        jacobian[n:, n:] = -np.diag(np.where(follows, 0.0, 1.0))
        if self.primal_projection:
            aim = state[:n] - (qp.P @ state[:n] + qp.q + rows.T @ state[n:])
            outside = np.flatnonzero((aim <= qp.lb) | (aim >= qp.ub))
            jacobian[outside] = 0.0
            jacobian[outside, outside] = -1.0
        return jacobian

    def _field(self, qp: QP, state: Vector, rates: Vector) -> Vector:
        """Write the rates; returns which multipliers are active, 1 or 0, of shape (m + 2n,)."""
        n, m, p = qp.sizes
        check_size("state", state, 3 * n + m + p)
        active = np.empty(m + 2 * n)
        field(qp.data, n, m, p, self.primal_projection, state, rates, active)
        return active


@compiled
def field(
    data: Vector, n: int, m: int, p: int, project: bool, s: Vector, rates: Vector,
    active: Vector,
) -> float:  # fmt: skip
    """Write the network's rates rho ds/dt; with `project`, x goes through its bounds.

    `active` (m + 2n,) becomes 1 for the multipliers with mu + Omega x - chi > 0, else 0.

    Returns:
        The largest absolute rate: zero exactly at a KKT point, NaN if one is NaN.
    """
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    at_z, at_u = n + p, n + p + m
    largest = 0.0
    for i in range(n):  # the gradient, for now
        rates[i] = data[at_q + i] + s[at_u + i] - s[at_u + n + i] + dot(data, i * n, s, n)
    for j in range(p):
        row = at_A + j * n
        add_scaled(rates, s[n + j], data, row, n)
        rate = dot(data, row, s, n) - data[at_b + j]
        rates[n + j] = rate
        largest = larger(largest, abs(rate))
    for j in range(m):
        row, z = at_G + j * n, s[at_z + j]
        if z != 0.0:
            add_scaled(rates, z, data, row, n)
        slack = dot(data, row, s, n) - data[at_h + j]
        is_active = z + slack > 0.0
        rate = slack if is_active else -z
        active[j] = is_active
        rates[at_z + j] = rate
        largest = larger(largest, abs(rate))
    for i in range(n):
        rate = -rates[i]
        if project:
            rate = min(max(s[i] + rate, data[at_lb + i]), data[at_ub + i]) - s[i]
        rates[i] = rate
        largest = larger(largest, abs(rate))
        for side in range(2):
            slack = s[i] - data[at_ub + i] if side == 0 else data[at_lb + i] - s[i]
            multiplier = s[at_u + side * n + i]
            is_active = multiplier + slack > 0.0
            rate = slack if is_active else -multiplier
            active[m + side * n + i] = is_active
            rates[at_u + side * n + i] = rate
            largest = larger(largest, abs(rate))
    return largest


@compiled
def stable_step(data: Vector, n: int, m: int, p: int, active: Vector) -> float:
    """Compute the bound of `ProjectionNetwork.stable_step` for an active set (m + 2n,)."""
    _, at_G, at_A, _ = offsets(n, m, p)
    K = np.zeros(n * n)
    for j in range(p + m):
        row = at_A + j * n if j < p else at_G + (j - p) * n
        if j < p or active[j - p] != 0.0:
            for i in range(n):
                for k in range(n):
                    K[i * n + k] += data[row + i] * data[row + k]
    for i in range(n):
        K[i * n + i] += active[m + i] + active[m + n + i]
    _, coupling = extreme_eigenvalues(K, n)
    for k in range(n * n):
        K[k] = data[k]
    smallest, largest = extreme_eigenvalues(K, n)
    # Passive multipliers and clipped variables decay at rate one: never more than 2.
    bound = 2.0 / max(largest, 1.0)
    return min(bound, max(smallest, 0.0) / coupling) if coupling > 0.0 else bound
