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

from dataclasses import dataclass
from typing import TypeGuard

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.records import Record
from iiwa_dnn.networks.base import Network, kkt_product
from iiwa_dnn.qp.dense import (
    add_multiple,
    add_outer,
    add_row,
    dot,
    extreme_eigenvalues,
    largest_entry,
    times,
)
from iiwa_dnn.qp.layout import QPViews, Sizes, Vector
from iiwa_dnn.qp.program import QP


@compiled
def write_spans(qp: QPViews, spans: Vector) -> None:
    """Write where the entries of each row of G (m, n) begin, and then where they end, (2m,).

    Rows of one entry, as limits written as rows have, then cost next to nothing.
    """
    n = qp.q.size
    m = qp.h.size
    for j in range(m):
        begin = 0
        end = n
        while begin < n and qp.G[j, begin] == 0.0:
            begin += 1
        while end > begin and qp.G[j, end - 1] == 0.0:
            end -= 1
        spans[j] = begin
        spans[m + j] = end


@compiled
def rows_times(qp: QPViews, spans: Vector, x: Vector, values: Vector) -> None:
    """Write [A; G; I; -I] x into `values`, of size p + m + 2n."""
    n = qp.q.size
    m = qp.h.size
    p = qp.b.size
    first = p + m
    times(qp.A, x, values)
    for j in range(m):
        begin = int(spans[j])
        values[p + j] = dot(0.0, qp.G[j, begin : int(spans[m + j])], x[begin:])
    for i in range(n):
        values[first + i] = x[i]
        values[first + n + i] = -x[i]


@compiled
def add_transposed(qp: QPViews, spans: Vector, factor: float, s: Vector, out: Vector) -> None:
    """Add factor (A^T y + G^T z + u - l) of a state s to the first n entries of `out` (size,)."""
    n = qp.q.size
    m = qp.h.size
    p = qp.b.size
    at_z = n + p
    at_u = at_z + m
    for i in range(n):
        out[i] += factor * (s[at_u + i] - s[at_u + n + i])
    for j in range(p):
        add_row(out, factor * s[n + j], qp.A, j)
    for j in range(m):
        if s[at_z + j] != 0.0:
            begin = int(spans[j])
            add_multiple(out[begin:], factor * s[at_z + j], qp.G[j, begin : int(spans[m + j])])


@compiled
def write_slacks(qp: QPViews, spans: Vector, x: Vector, slacks: Vector) -> None:
    """Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n)."""
    n = qp.q.size
    p = qp.b.size
    first = p + qp.h.size
    rows_times(qp, spans, x, slacks)
    for j in range(p):
        slacks[j] -= qp.b[j]
    for j in range(qp.h.size):
        slacks[p + j] -= qp.h[j]
    for i in range(n):
        slacks[first + i] -= qp.ub[i]
        slacks[first + n + i] += qp.lb[i]


@compiled
def unprojected_rates(qp: QPViews, spans: Vector, s: Vector, rates: Vector) -> float:
    """Write rho ds/dt at a state, both (size,), without the projection of x on its bounds.

    `spans` (2m,) are those of `write_spans`.

    Returns:
        The largest absolute rate: zero exactly at a KKT point, NaN if one is NaN.
    """
    n = qp.q.size
    times(qp.P, s, rates)
    for i in range(n):
        rates[i] = -qp.q[i] - rates[i]
    add_transposed(qp, spans, -1.0, s, rates)
    write_slacks(qp, spans, s, rates[n:])
    for k in range(n + qp.b.size, s.size):
        if not s[k] + rates[k] > 0.0:  # the multiplier decays
            rates[k] = -s[k]
    return largest_entry(rates)


@compiled
def mark_active(qp: QPViews, s: Vector, rates: Vector, active: Vector) -> int:
    """Mark the rows [A; G; I; -I] that are active by 1, others by 0, (p + m + 2n,).

    Equalities are active, inequalities where mu + Omega x - chi > 0. A multiplier that is not
    active decays: it and its rate add up to zero exactly.

    Returns:
        Number of rows whose mark has changed.
    """
    n = qp.q.size
    changed = 0
    for k in range(active.size):
        now = 1.0 if k < qp.b.size or s[n + k] + rates[n + k] > 0.0 else 0.0
        changed += 1 if now != active[k] else 0
        active[k] = now
    return changed


class ProjectionConstants(Record):
    """Constant of a projection network: whether x is projected on its bounds."""

    projects: bool


@compiled
def projection_rates(qp: QPViews, constants: Vector, state: Vector, rates: Vector) -> None:
    """Write rho ds/dt of `ProjectionNetwork` at a state s, both (size,), into `rates`."""
    spans = np.empty(2 * qp.h.size)
    write_spans(qp, spans)
    unprojected_rates(qp, spans, state, rates)
    if ProjectionConstants.of(constants).projects:
        for i in range(qp.q.size):
            rates[i] = min(max(state[i] + rates[i], qp.lb[i]), qp.ub[i]) - state[i]


@compiled
def stable_step(qp: QPViews, active: Vector) -> float:
    """Compute the bound of `ProjectionNetwork.stable_step` for an active set (p + m + 2n,)."""
    n = qp.q.size
    p = qp.b.size
    first = p + qp.h.size
    K = np.zeros((n, n))
    for j in range(p):
        add_outer(K, active[j], qp.A[j], 0)
    for j in range(qp.h.size):
        add_outer(K, active[p + j], qp.G[j], 0)
    for i in range(n):
        K[i, i] += active[first + i] + active[first + n + i]
        for k in range(i):
            K[i, k] = K[k, i]
    _, coupling = extreme_eigenvalues(K)
    for i in range(n):
        for k in range(n):
            K[i, k] = qp.P[i, k]
    smallest, largest = extreme_eigenvalues(K)
    # Passive multipliers and clipped variables decay at rate one: never more than 2.
    bound = 2.0 / max(largest, 1.0)
    return min(bound, max(smallest, 0.0) / coupling) if coupling > 0.0 else bound


@dataclass(frozen=True, kw_only=True)
class ProjectionNetwork(Network):
    """The paper's network, whose states are x and the multipliers of all rows and bounds.

    Attributes:
        rho: Time constant [s].
        primal_projection: True if x is projected on its bounds, as in the paper. Without it the
            bounds act through their multipliers alone; the equilibria are the same, and a
            backward Euler step becomes a convex problem
            (`iiwa_dnn.networks.integrators.implicit_steps`).
    """

    primal_projection: bool = True
    compiled_rates = staticmethod(projection_rates)

    def constants(self, sizes: Sizes) -> Vector:
        """Return `ProjectionConstants`."""
        return ProjectionConstants.make(projects=self.primal_projection).numbers

    def state_size(self, qp: QP) -> int:
        """Count the states: n + p + m + 2n, 28 for seven joints and the paper's seven rows."""
        n, m, p = qp.sizes
        return 3 * n + p + m

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the operations of one product with the KKT matrix; see `Network.work`."""
        return 0.0, kkt_product(sizes)

    def stable_step(self, qp: QP, state: Vector) -> float:
        r"""Bound the stable steps of explicit Euler, in units of rho.

        On a fixed active set the network is linear. For an eigenvalue with eigenvector (v, w),
        \|v\| = 1, :math:`\lambda^2 + \pi\lambda + s = 0` with :math:`\pi = v^*Pv` and
        :math:`s = \|Cv\|^2`, C being the equality rows and the active inequality rows. Euler
        stays inside its circle where the step is below 2/pi (real pair) and pi/s (complex pair),
        so below ``min(2/max eig P, min eig P / max eig C^T C)``. Multipliers that are not active
        decay at rate one, which asks for a step below 2.

        Args:
            qp: The program.
            state: A state, (state_size,), whose active rows are counted.

        Returns:
            The bound; zero where P is singular, since then no step is known to be stable.
        """
        n, _, p = qp.sizes
        active = np.where((state + self.rates(qp, state))[n:] > 0.0, 1.0, 0.0)
        active[:p] = 1.0
        return stable_step(qp.views, active)


def is_projection(network: Network) -> TypeGuard[ProjectionNetwork]:
    """Check that a network has the states, flow and rates of `ProjectionNetwork`.

    Its compiled loops then integrate this network.
    """
    kind = type(network)
    if kind is ProjectionNetwork:  # quickly
        return True
    own = (kind.flow, kind.state_size, kind.compiled_rates)
    return own == (Network.flow, ProjectionNetwork.state_size, projection_rates)
