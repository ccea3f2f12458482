r"""Barrier network: a smooth start for programs that the projection network does not settle alone.

**Equilibration.** With x = D x', rows scaled by E and the cost by c (Ruiz's iteration), the program
is settled in coordinates in which the largest entry of each row and column is near one. For the
network that is another time constant for each state; its equilibria are the same.

**Smoothed flow.** For inequalities :math:`\Omega x \le \chi` and :math:`\nu > 0` the projection is
replaced by a barrier,

.. math::

    \rho\,\dot x = -(P x + q + A^T y + \Omega^T \mu), \qquad \rho\,\dot y = A x - b, \qquad
    \rho\,\dot\mu = \Omega x - \chi + \nu / \mu ,

which is smooth and holds the multipliers positive; at rest :math:`\mu_j (\chi - \Omega x)_j = \nu`.
Its linearly implicit steps of length :math:`1/\delta`, with the slack :math:`\nu/\mu` as a variable
s of its own, are those of a proximal interior-point method; as :math:`\nu` falls, its equilibrium
moves to that of the projection network. From there on linearly implicit steps of the projection
network itself settle what is left, on the rows that are active. Each step's linear system is that
of `iiwa_dnn.networks.integrators.eliminations`; variables whose bounds meet take no part.

Sources: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
RAL-TR-2001-034; S. Mehrotra, "On the implementation of a primal-dual interior point method", SIAM
J. Optim. 2 (1992), for the choice of :math:`\nu` and the start; R. Schwan, Y. Jiang, D. Kuhn, C. N.
Jones, "PIQP: a proximal interior-point quadratic programming solver", CDC 2023, for the
regularisation.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.eliminations import elimination
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import point_of_state

ATTEMPTS = ((1e-8, 0.99, 0.0), (1e-7, 0.9, 1e-3), (1e-6, 0.9, 1e-2), (1e-9, 0.9, 0.0))
"""Inverse of the steps' length [1/rho], share of the way to the boundary that is gone, and
least fall of the barrier, of one attempt after another."""
EPS = 1e-16
"""Least eps times delta: below, rounding of A^T A/delta could make K indefinite."""
REFINED = 4
"""Solutions of one system, the first and its refinements."""
LEAST = 1e-30
"""Least weight of a row, of one that takes no part."""
NEAR = 1e-3
"""Size of the scaled residuals from which on the point is judged in the program's own units."""
MOST = 150
"""Systems of one attempt."""
STALLED = 25
"""Steps without a better point before an attempt is given up."""
NETWORK_STEPS = 10
"""Linearly implicit steps of the projection network after an attempt."""


def settle(qp: QP, state: Vector, point: Vector, tol: float, max_systems: int) -> Settled:
    """Settle `state` (3n + m + p,) from a cold start; arguments as `Integrator.settle`'s.

    Works in numpy, LAPACK and SuperLU: it is meant for large programs and for those left over.
    """
    if (qp.lb == qp.ub).all():  # nothing is left to choose
        state[:], state[: qp.q.size] = 0.0, qp.lb
        return 0, 0.0, *point_of_state(qp.data, *qp.sizes, state, point)
    run = _Run(qp, state, point, tol)
    run.limit = max_systems
    # Overflows end an attempt: they show in its residuals.
    with np.errstate(all="ignore"):
        for attempt in ATTEMPTS:
            if run.systems >= max_systems or run.attempt(*attempt):
                break
    residuals, fixed = point_of_state(qp.data, *qp.sizes, state, point), qp.lb == qp.ub
    z_box, bounds = point[-qp.q.size :], state[-2 * qp.q.size :].reshape(2, -1)
    bounds[:, fixed] = np.maximum(z_box[fixed], 0.0), np.maximum(-z_box[fixed], 0.0)
    return run.systems, run.time, *residuals


class _Run:
    """The scaled program, its linear system, and the best point so far."""

    def __init__(self, qp: QP, state: Vector, point: Vector, tol: float) -> None:
        self.qp, self.state, self.point, self.tol = qp, state, point, tol
        self.systems, self.limit, self.time, self.best = 0, 0, 0.0, np.inf
        self.residuals = (np.inf, np.inf, np.inf)
        # A variable whose bounds meet is a number; its multiplier is what the others leave over.
        self.moving, self.rows = np.flatnonzero(qp.lb < qp.ub), np.flatnonzero(np.isfinite(qp.h))
        self.rest = rest = np.where(qp.lb < qp.ub, 0.0, qp.lb)
        # Views where all take part, without a copy.
        columns = slice(None) if self.moving.size == qp.q.size else self.moving
        rows = slice(None) if self.rows.size == qp.h.size else self.rows
        P, G = qp.P[columns], qp.G[rows]
        q, b, h = qp.q[self.moving] + P @ rest, qp.b - qp.A @ rest, qp.h[self.rows] - G @ rest
        self.system = elimination(*(v[:, columns] for v in (P, qp.A, G)))
        (self.d, self.f, self.e), self.c = self.system.equilibrate(q)
        self.P, self.A, self.G = self.system.matrices
        self.AT, self.GT = self.A.T, self.G.T
        self.q, self.b = q * self.d * self.c, b * self.f
        lb, ub = qp.lb[self.moving] / self.d, qp.ub[self.moving] / self.d
        self.upper, self.lower = np.flatnonzero(ub < np.inf), np.flatnonzero(lb > -np.inf)
        self.chi = np.concatenate([h * self.e, ub[self.upper], -lb[self.lower]])
        self.parts = h.size, h.size + self.upper.size

    def times(self, x: Vector) -> Vector:
        """Compute Omega x."""
        return np.concatenate([self.G @ x, x[self.upper], -x[self.lower]])

    def transposed(self, mu: Vector) -> Vector:
        """Compute Omega^T mu."""
        first, second = self.parts
        total: Vector = self.GT @ mu[:first]
        total[self.upper] += mu[first:second]
        total[self.lower] -= mu[second:]
        return total

    def factor(self, weights: Vector) -> bool:
        """Factor the system for the weights of all rows; False if that is not possible.

        eps is enlarged until the matrix is positive definite to working precision.
        """
        first, second = self.parts
        self.weights, self.box = np.maximum(weights, LEAST), np.zeros_like(self.q)
        self.box[self.upper] += weights[first:second]
        self.box[self.lower] += weights[second:]
        self.eps = EPS / self.delta
        while self.eps < 1.0 and self.systems < self.limit:
            self.systems += 1
            if self.system.factor(self.weights[:first], self.box + self.eps, self.delta):
                return True
            self.eps *= 10.0
        return False

    def solve(self, rx: Vector, ry: Vector, rmu: Vector) -> tuple[Vector, Vector, Vector]:
        """Solve one step's system for dx, dy and dmu, refined.

        Its lines are (P + eps) dx + A^T dy + Omega^T dmu = rx, A dx - delta dy = ry and
        Omega dx - dmu/W = rmu. The bounds' multipliers are eliminated, but refined with the rest.
        """
        first, w, delta, before = self.parts[0], self.weights, self.delta, np.inf
        errors = rx, ry, rmu
        dx, dy, dmu = (np.zeros_like(v) for v in errors)
        scale = max(np.abs(v).max(initial=0.0) for v in errors)
        for _ in range(REFINED):
            ex, ey, emu = errors
            pushed = w * emu
            pushed[:first] = 0.0
            x, y, g = self.system.solve(ex + self.transposed(pushed), ey, emu[:first])
            mu = w * (self.times(x) - emu)
            mu[:first] = g
            dx, dy, dmu = dx + x, dy + y, dmu + mu
            errors = (
                rx - (self.P @ dx + self.eps * dx + self.AT @ dy + self.transposed(dmu)),
                ry - self.A @ dx + delta * dy,
                rmu - self.times(dx) + dmu / w,
            )
            error = max(np.abs(v).max(initial=0.0) for v in errors)
            if not 1e-13 * scale < error < 0.5 * before:
                break
            before = error
        return dx, dy, dmu

    def judge(self, x: Vector, y: Vector, mu: Vector) -> float:
        """Judge the point in the program's own units and keep it if it is the best so far.

        Returns:
            Its largest residual.
        """
        n, m, p = self.qp.sizes
        s, z_u_l = np.zeros_like(self.state), np.split(mu, self.parts)
        s[:n] = self.rest
        s[self.moving], s[n : n + p] = x * self.d, y * self.f / self.c
        s[n + p + self.rows] = z_u_l[0] * self.e / self.c
        bounds = s[n + p + m :].reshape(2, n)
        bounds[0, self.moving[self.upper]] = z_u_l[1] / (self.d[self.upper] * self.c)
        bounds[1, self.moving[self.lower]] = z_u_l[2] / (self.d[self.lower] * self.c)
        return self.keep(s)

    def keep(self, s: Vector) -> float:
        """Keep the state s if it is the best so far; returns its largest residual."""
        residuals = point_of_state(self.qp.data, *self.qp.sizes, s, self.point)
        largest = max(residuals) if sum(residuals) < np.inf else np.inf
        if largest < self.best:
            self.best, self.residuals = largest, residuals
            self.state[:] = s
        return largest

    def start(self, delta: float) -> tuple[Vector, Vector, Vector, Vector]:
        """Find x and y that balance cost and limits, and positive mu and slacks around them."""
        self.delta = delta
        self.factor(np.ones_like(self.chi))
        x, y, _ = self.solve(-self.q, self.b, self.chi)
        slack = self.chi - self.times(x)
        mu, s = (np.maximum(v - min(v.min(initial=0.0), 0.0), 1e-2) for v in (-slack, slack))
        return x, y, mu + (slack > 0.0).any(), s + (slack < 0.0).any()

    def newton(
        self, target: Vector, rates: tuple[Vector, Vector, Vector], mu: Vector, s: Vector
    ) -> tuple[Vector, Vector, Vector, Vector]:
        """Solve one linearly implicit step with s dmu + mu ds = target; returns dx, dy, dmu, ds."""
        rd, rp, ri = rates
        dx, dy, dmu = self.solve(-rd, -rp, -ri - target / mu)
        return dx, dy, dmu, (target - s * dmu) / mu

    def attempt(self, delta: float, share: float, fall: float) -> bool:
        """Follow the smoothed flow from its start; returns whether the point was found."""
        k, stalled, best, nearest = max(len(self.chi), 1), 0, np.inf, np.inf
        x, y, mu, s = kept = self.start(delta)
        last = min(self.limit, self.systems + MOST)
        while self.systems < last:
            rd = self.P @ x + self.q + self.AT @ y + self.transposed(mu)
            rates = rd, self.A @ x - self.b, self.times(x) + s - self.chi
            nu = float(s @ mu) / k
            size = max(nu, *(float(np.abs(r).max(initial=0.0)) for r in rates))
            if not size < np.inf:
                break
            better = size < 0.9 * best
            if size < NEAR:
                value = self.judge(x, y, mu)
                if value <= 0.5 * self.tol:
                    kept = x, y, mu, s
                    break  # the network's own steps sharpen it
                better, nearest = better or value < nearest, min(nearest, value)
            if better:
                kept = x, y, mu, s
            best, stalled = min(best, size), 0 if better else stalled + 1
            if stalled > STALLED or 0.0 < nu < 1e-20 or not self.factor(1.0 / (s / mu + delta)):
                break
            dx, dy, dmu, ds = self.newton(-s * mu, rates, mu, s)
            if nu > 0.0:
                after = float((s + _length(s, ds) * ds) @ (mu + _length(mu, dmu) * dmu)) / k
                center = max(min(1.0, max(0.0, after / nu)) ** 3, fall)
                dx, dy, dmu, ds = self.newton(-s * mu - ds * dmu + center * nu, rates, mu, s)
            # All the way only where nothing is in it.
            reach = min(max(share, 1.0 - nu), 1.0 - 1e-6)
            one, two = (v if v == 1.0 else reach * v for v in (_length(s, ds), _length(mu, dmu)))
            x, s, y, mu = x + one * dx, s + one * ds, y + two * dy, mu + two * dmu
            self.time += 1.0 / delta
        x, y, mu, s = kept
        # From zero, the steps find the smallest multipliers of the active rows: less rounding.
        return self.network(x, y, mu, mu > s) or self.network(x, 0.0 * y, 0.0 * mu, mu > s)

    def network(self, x: Vector, y: Vector, mu: Vector, active: NDArray[np.bool_]) -> bool:
        """Take linearly implicit steps of the projection network; returns whether it settled."""
        mu, delta, last = np.where(active, mu, 0.0), self.delta, np.inf
        for _ in range(NETWORK_STEPS):
            full = self.systems >= self.limit
            if full or not self.factor(np.where(active, 1.0 / delta, 0.0)):
                break
            slack = self.times(x) - self.chi
            rd = self.P @ x + self.q + self.AT @ y + self.transposed(mu)
            dx, dy, dmu = self.solve(-rd, self.b - self.A @ x, np.where(active, -slack, 0.0))
            mu = np.where(active, mu + dmu, 0.0)
            x, y, self.time = x + dx, y + dy, self.time + 1.0 / delta
            value = self.judge(x, y, np.maximum(mu, 0.0))
            before, active = active, mu + self.times(x) - self.chi > 0.0
            if value <= 0.5 * self.tol or (value > 0.5 * last and (active == before).all()):
                break
            mu, last = np.where(active, mu, 0.0), value
        return self.best <= self.tol


def _length(v: Vector, dv: Vector) -> float:
    """Compute the longest step, at most 1, along dv that holds v nonnegative."""
    falling = dv < 0.0
    return float(np.min(-v[falling] / dv[falling], initial=1.0))
