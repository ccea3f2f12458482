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
network itself settle what is left, on the rows that are active.

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
from iiwa_dnn.qp.layout import Triple, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point

ATTEMPTS = ((1e-8, 0.99, 0.0), (1e-7, 0.9, 1e-3), (1e-6, 0.9, 1e-2), (1e-9, 0.9, 0.0))
"""Inverse of the steps' length [1/rho], share of the way to the boundary that is gone, and
least fall of the barrier, of one attempt after another."""
EPS = 1e-16
"""Least eps times delta: below, rounding of A^T A/delta could make K indefinite."""
REFINED = 4
"""Solutions of one system, the first and its refinements."""
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

    Works in numpy and LAPACK: it is meant for large programs and for those that are left over.
    """
    run = _Run(qp, state, point, tol)
    run.limit = max_systems
    # Overflows end an attempt: they show in its residuals.
    with np.errstate(all="ignore"):
        for attempt in ATTEMPTS:
            if run.systems >= max_systems or run.attempt(*attempt):
                break
    return run.systems, run.time, *kkt_point(qp.data, *qp.sizes, state, point)


class _Run:
    """The scaled program, its condensed system, and the best point so far."""

    def __init__(self, qp: QP, state: Vector, point: Vector, tol: float) -> None:
        self.qp, self.state, self.point, self.tol = qp, state, point, tol
        self.systems, self.limit, self.time, self.best = 0, 0, 0.0, np.inf
        self.residuals = (np.inf, np.inf, np.inf)
        limited, self.fixed = np.isfinite(qp.h), np.flatnonzero(qp.lb == qp.ub)
        self.rows = np.flatnonzero(limited)
        A, G = np.vstack([qp.A, np.eye(qp.q.size)[self.fixed]]), qp.G[self.rows]
        self.P, self.A, self.G = qp.P.copy(), A, G.copy()
        self.d, self.f, self.e = (np.ones(k) for k in (qp.q.size, len(A), len(G)))
        self._equilibrate()
        q = qp.q * self.d
        self.c = 1.0 / max(np.abs(self.P).max(axis=0).mean(), np.abs(q).max(), 1e-300)
        self.P *= self.c
        self.q, self.b = q * self.c, np.concatenate([qp.b, qp.lb[self.fixed]]) * self.f
        self.upper = np.flatnonzero((qp.ub < np.inf) & (qp.lb < qp.ub))
        self.lower = np.flatnonzero((qp.lb > -np.inf) & (qp.lb < qp.ub))
        upper, lower = (qp.ub / self.d)[self.upper], (qp.lb / self.d)[self.lower]
        self.chi = np.concatenate([qp.h[self.rows] * self.e, upper, -lower])
        self.parts = len(G), len(G) + len(self.upper)
        self.gram = self.A.T @ self.A

    def _equilibrate(self) -> None:
        for _ in range(10):
            sizes = [np.abs(rows).max(axis=0) for rows in (self.P, self.A, self.G) if len(rows)]
            d, f, e = (
                1.0 / np.sqrt(np.where(size > 0.0, size, 1.0))
                for size in (
                    np.max(sizes, axis=0),
                    np.abs(self.A).max(axis=1, initial=0.0),
                    np.abs(self.G).max(axis=1, initial=0.0),
                )
            )
            self.P *= d[:, None] * d
            self.A *= f[:, None] * d
            self.G *= e[:, None] * d
            self.d, self.f, self.e = self.d * d, self.f * f, self.e * e
            if all(np.abs(1.0 - scale).max(initial=0.0) < 1e-2 for scale in (d, f, e)):
                break

    def times(self, x: Vector) -> Vector:
        """Compute Omega x."""
        return np.concatenate([self.G @ x, x[self.upper], -x[self.lower]])

    def transposed(self, mu: Vector) -> Vector:
        """Compute Omega^T mu."""
        first, second = self.parts
        total: Vector = self.G.T @ mu[:first]
        total[self.upper] += mu[first:second]
        total[self.lower] -= mu[second:]
        return total

    def factor(self, weights: Vector) -> bool:
        """Factor K = P + eps I + A^T A/delta + Omega^T W Omega; False if that is not possible.

        eps is enlarged until K is positive definite to working precision.
        """
        from scipy.linalg.lapack import dpotrf

        first, second = self.parts
        rows = np.sqrt(weights[:first])[:, None] * self.G
        self.H = rows.T @ rows
        self.H += self.P
        self.H += self.gram / self.delta
        diagonal = np.einsum("ii->i", self.H)
        diagonal[self.upper] += weights[first:second]
        diagonal[self.lower] += weights[second:]
        self.eps = EPS / self.delta
        while self.eps < 1.0 and self.systems < self.limit:
            self.systems += 1
            K = self.H.copy()
            K.flat[:: len(K) + 1] += self.eps
            self.L, info = dpotrf(K.T, lower=1, overwrite_a=1, clean=0)
            if info == 0:
                return True
            self.eps *= 10.0
        return False

    def solve(self, rx: Vector, ry: Vector) -> tuple[Vector, Vector]:
        """Solve [H + eps I, A^T; A, -delta] (dx, dy) = (rx, ry), refined."""
        from scipy.linalg.lapack import dpotrs

        delta, dx, dy, before = self.delta, np.zeros_like(rx), np.zeros_like(ry), np.inf
        scale = max(np.abs(rx).max(), np.abs(ry).max(initial=0.0))
        ex, ey = rx, ry
        for _ in range(REFINED):
            change, _ = dpotrs(self.L, ex + self.A.T @ (ey / delta), lower=1)
            dx, dy = dx + change, dy + (self.A @ change - ey) / delta
            gap = ry - self.A @ dx
            ex = rx - (self.H @ dx + self.eps * dx + self.A.T @ (dy - self.A @ dx / delta))
            ey = gap + delta * dy
            error = max(np.abs(ex).max(), np.abs(ey).max(initial=0.0))
            if not 1e-13 * scale < error < 0.5 * before:
                break
            before = error
        return dx, dy

    def judge(self, x: Vector, y: Vector, mu: Vector) -> float:
        """Judge the point in the program's own units and keep it if it is the best so far.

        Returns:
            Its largest residual.
        """
        n, m, p = self.qp.sizes
        s, z_u_l = np.zeros_like(self.state), np.split(mu, self.parts)
        multipliers = y * self.f / self.c
        s[:n], s[n : n + p] = x * self.d, multipliers[:p]
        s[n + p + self.rows] = z_u_l[0] * self.e / self.c
        bounds = s[n + p + m :].reshape(2, n)
        bounds[0, self.upper] = z_u_l[1] / (self.d[self.upper] * self.c)
        bounds[1, self.lower] = z_u_l[2] / (self.d[self.lower] * self.c)
        bounds[0, self.fixed] = np.maximum(multipliers[p:], 0.0)
        bounds[1, self.fixed] = np.maximum(-multipliers[p:], 0.0)
        residuals = worse(self.qp, self.point, kkt_point(self.qp.data, n, m, p, s, self.point))
        largest = max(residuals) if sum(residuals) < np.inf else np.inf
        if largest < self.best:
            self.best, self.residuals = largest, residuals
            self.state[:] = s
        return largest

    def start(self, delta: float) -> tuple[Vector, Vector, Vector, Vector]:
        """Find x and y that balance cost and limits, and positive mu and slacks around them."""
        self.delta = delta
        self.factor(np.ones_like(self.chi))
        x, y = self.solve(-self.q + self.transposed(self.chi), self.b)
        slack = self.chi - self.times(x)
        mu, s = (np.maximum(v - min(v.min(initial=0.0), 0.0), 1e-2) for v in (-slack, slack))
        return x, y, mu + (slack > 0.0).any(), s + (slack < 0.0).any()

    def newton(
        self, target: Vector, rates: tuple[Vector, Vector, Vector], mu: Vector, s: Vector
    ) -> tuple[Vector, Vector, Vector, Vector]:
        """Solve one linearly implicit step with s dmu + mu ds = target; returns dx, dy, dmu, ds."""
        rd, rp, ri = rates
        W, t = 1.0 / (s / mu + self.delta), ri + target / mu
        dx, dy = self.solve(-rd - self.transposed(W * t), -rp)
        dmu = W * (self.times(dx) + t)
        return dx, dy, dmu, (target - s * dmu) / mu

    def attempt(self, delta: float, share: float, fall: float) -> bool:
        """Follow the smoothed flow from its start; returns whether the point was found."""
        k, stalled, best, nearest = max(len(self.chi), 1), 0, np.inf, np.inf
        x, y, mu, s = kept = self.start(delta)
        last = min(self.limit, self.systems + MOST)
        while self.systems < last:
            rd = self.P @ x + self.q + self.A.T @ y + self.transposed(mu)
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
        mu, delta = np.where(active, mu, 0.0), self.delta
        for _ in range(NETWORK_STEPS):
            full = self.systems >= self.limit
            if full or not self.factor(np.where(active, 1.0 / delta, 0.0)):
                break
            slack = self.times(x) - self.chi
            rd = self.P @ x + self.q + self.A.T @ y + self.transposed(mu)
            push = np.where(active, slack / delta, 0.0)
            dx, dy = self.solve(-rd - self.transposed(push), self.b - self.A @ x)
            mu = mu + push + np.where(active, self.times(dx) / delta, 0.0)
            x, y, self.time = x + dx, y + dy, self.time + 1.0 / delta
            if self.judge(x, y, np.maximum(mu, 0.0)) <= 0.5 * self.tol:
                break
            active = mu + self.times(x) - self.chi > 0.0
            mu = np.where(active, mu, 0.0)
        return self.best <= self.tol


def worse(qp: QP, point: Vector, residuals: Triple) -> Triple:
    """Return the residuals of ``[x | y | z | z_box]``, or those of numpy's sums where larger.

    Sums in another order round otherwise, and a claim has to hold for all: to the dual residual,
    whose multipliers may be very large, its rounding is added.
    """
    n, m, p = qp.sizes
    P, q, G, h, A, b, lb, ub = qp.arrays()
    x, y, z, z_box = np.split(point, [n, n + p, n + p + m])
    Px, down, up = P @ x, np.minimum(z_box, 0.0), np.maximum(z_box, 0.0)
    rows, low, high = np.isfinite(h), np.isfinite(lb), np.isfinite(ub)
    primal = max(np.abs(A @ x - b).max(initial=0.0), (G @ x - h).max(initial=0.0))
    gap = x @ Px + q @ x + h[rows] @ z[rows] + b @ y + lb[low] @ down[low] + ub[high] @ up[high]
    sizes = np.abs(z_box) + np.abs(G).T @ np.abs(z) + np.abs(A).T @ np.abs(y)
    rounding = 0.25 * np.finfo(float).eps * sizes.max()
    dual = np.abs(Px + q + G.T @ z + A.T @ y + z_box).max() + rounding
    first, second, third = np.maximum(residuals, (primal, dual, abs(gap))).tolist()
    return first, second, third


def _length(v: Vector, dv: Vector) -> float:
    """Compute the longest step, at most 1, along dv that holds v nonnegative."""
    falling = dv < 0.0
    return float(np.min(-v[falling] / dv[falling], initial=1.0))
