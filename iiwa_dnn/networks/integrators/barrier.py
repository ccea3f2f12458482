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
network itself settle what is left, on the rows that are active. Of each step's linear system all
multipliers are eliminated. A variable whose bounds meet gets an equality row in their place.

Sources: D. Ruiz, "A scaling algorithm to equilibrate both rows and columns norms in matrices",
RAL-TR-2001-034; S. Mehrotra, "On the implementation of a primal-dual interior point method", SIAM
J. Optim. 2 (1992), for the choice of :math:`\nu` and the start; R. Schwan, Y. Jiang, D. Kuhn, C. N.
Jones, "PIQP: a proximal interior-point quadratic programming solver", CDC 2023, for the
regularisation.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve

from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.qp.layout import Matrix, Triple, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import point_of_state

ATTEMPTS = ((1e-8, 0.99, 0.0), (1e-7, 0.9, 1e-3), (1e-6, 0.9, 1e-2), (1e-9, 0.9, 0.0))
"""Inverse of the steps' length [1/rho], fraction of the distance to the boundary that is gone, and
least fall of the barrier, of one attempt after another."""
EPS = 1e-16
"""Least eps times delta: below, rounding of A^T A/delta could make K indefinite."""
REFINED = 4
"""Solutions of one system, the first and its refinements."""
LEAST = 1e-30
"""Least weight of a row, of one that is not active."""
NEAR = 1e-3
"""Size of the scaled residuals from which on the point is judged in the program's own units."""
MOST = 150
"""Systems of one attempt."""
STALLED = 25
"""Steps without a better point before an attempt is given up."""
NETWORK_STEPS = 10
"""Linearly implicit steps of the projection network after an attempt."""


class Scaled(NamedTuple):
    """A program in coordinates x' = x / d, with rows and cost scaled, and only finite limits.

    Attributes:
        P: Cost matrix, (n, n).
        q: Cost vector, (n,).
        A: Equality rows, a row for each variable whose bounds meet among them, (rows, n).
        b: Their right-hand sides, (p,).
        omega: Inequality rows and bounds that are finite, (k, n).
        chi: Their limits, (k,).
        d: Scale of each variable, (n,).
        f: Scale of each equality row.
        e: Scale of each inequality row, (k,).
        c: Scale of the cost.
        used: True for the rows of [G; I; -I] that `omega` has, (m + 2n,).
    """

    P: Matrix
    q: Vector
    A: Matrix
    b: Vector
    omega: Matrix
    chi: Vector
    d: Vector
    f: Vector
    e: Vector
    c: float
    used: NDArray[np.bool_]


def equilibrate(qp: QP) -> Scaled:
    """Scale a program until the largest entry of each row and column of P, A and G is near one."""
    n, m, _ = qp.sizes
    fixed = qp.lb == qp.ub
    chi = np.concatenate([qp.h, qp.ub, -qp.lb])
    used = np.isfinite(chi)
    used[m:] &= ~np.tile(fixed, 2)
    P = qp.P.copy()
    A = np.vstack([qp.A, np.eye(n)[fixed]])
    G = np.where(used[:m, None], qp.G, 0.0)
    d = np.ones(n)
    f = np.ones(len(A))
    e = np.ones(m)
    for _ in range(10):
        x = _inverse_roots(np.vstack([P, A, G]), 0)
        y = _inverse_roots(A, 1)
        z = _inverse_roots(G, 1)
        P *= x[:, None] * x
        A *= y[:, None] * x
        G *= z[:, None] * x
        d *= x
        f *= y
        e *= z
        if np.abs(1.0 - np.concatenate([x, y, z])).max() < 1e-2:
            break
    c = 1.0 / max(np.abs(P).max(axis=0).mean(), np.abs(qp.q * d).max(), 1e-300)
    rows = np.concatenate([e, 1.0 / d, 1.0 / d])[used]
    omega = np.vstack([G, np.eye(n), -np.eye(n)])[used]
    b = np.concatenate([qp.b, qp.lb[fixed]])
    return Scaled(c * P, c * qp.q * d, A, b * f, omega, chi[used] * rows, d, f, rows, c, used)


def _inverse_roots(matrix: Matrix, axis: int) -> Vector:
    """Compute one over the root of the largest entry of each column (axis 0) or row (axis 1)."""
    sizes = np.abs(matrix).max(axis=axis, initial=0.0)
    roots: Vector = 1.0 / np.sqrt(np.where(sizes > 0.0, sizes, 1.0))
    return roots


class Iterate(NamedTuple):
    """A point of the smoothed flow.

    Attributes:
        x: Primal point, (n,).
        y: Multipliers of the equality rows, (p,).
        mu: Multipliers of the limits, (k,).
        s: Slacks of the limits, (k,).
    """

    x: Vector
    y: Vector
    mu: Vector
    s: Vector


class System:
    """The condensed linear system of one step, factored for the weights of all inequality rows.

    Its lines are (P + eps) dx + A^T dy + Omega^T dmu = rx, A dx - delta dy = ry and
    Omega dx - dmu / weights = rmu. eps is enlarged until the condensed matrix is positive definite
    to working precision.

    Attributes:
        count: Factorizations that were tried.
        usable: True if the last of them succeeded.
    """

    def __init__(self, program: Scaled, weights: Vector, delta: float) -> None:
        """Factor the matrix for the weights (k,) of the inequality rows."""
        self._program = program
        self._weights = np.maximum(weights, LEAST)
        self._delta = delta
        self._eps = EPS / delta
        self.count = 0
        self.usable = False
        A = program.A
        omega = program.omega
        K = program.P + A.T @ A / delta + omega.T @ (self._weights[:, None] * omega)
        while self._eps < 1.0 and not self.usable:
            self.count += 1
            try:
                self._factor = cho_factor(K + self._eps * np.eye(len(K)), check_finite=False)
                self.usable = True
            except np.linalg.LinAlgError:
                self._eps *= 10.0

    def solve(self, rx: Vector, ry: Vector, rmu: Vector) -> tuple[Vector, Vector, Vector]:
        """Solve for dx (n,), dy (p,) and dmu (k,), refined."""
        P, _, A, _, omega, *_ = self._program
        w = self._weights
        dx = np.zeros_like(rx)
        dy = np.zeros_like(ry)
        dmu = np.zeros_like(rmu)
        errors = (rx, ry, rmu)
        scale = _largest(errors)
        before = np.inf
        for _ in range(REFINED):
            ex, ey, emu = errors
            right = ex + A.T @ (ey / self._delta) + omega.T @ (w * emu)
            x = cho_solve(self._factor, right, check_finite=False)
            dx = dx + x
            dy = dy + (A @ x - ey) / self._delta
            dmu = dmu + w * (omega @ x - emu)
            errors = (
                rx - (P @ dx + self._eps * dx + A.T @ dy + omega.T @ dmu),
                ry - A @ dx + self._delta * dy,
                rmu - omega @ dx + dmu / w,
            )
            error = _largest(errors)
            if not 1e-13 * scale < error < 0.5 * before:
                break
            before = error
        return dx, dy, dmu


def settle(qp: QP, state: Vector, point: Vector, tol: float, max_systems: int) -> Settled:
    """Settle `state` (3n + m + p,) from a cold start; arguments as `Integrator.settle`'s.

    Works in numpy and LAPACK: it is meant for large programs and for those left over.
    """
    n = qp.q.size
    run = Run(qp, state, tol, max_systems)
    # Overflows end an attempt: they show in its residuals.
    with np.errstate(all="ignore"):
        for attempt in ATTEMPTS:
            if run.systems >= max_systems or run.attempt(*attempt):
                break
    residuals = point_of_state(qp.data, *qp.sizes, state, point)
    fixed = qp.lb == qp.ub
    z_box = point[-n:]
    bounds = state[-2 * n :].reshape(2, n)
    bounds[:, fixed] = np.maximum(z_box[fixed], 0.0), np.maximum(-z_box[fixed], 0.0)
    return run.systems, run.time, *residuals


class Run:
    """Attempts on one program, and the best state so far.

    Attributes:
        systems: Linear systems that were factored.
        time: Network time that passed [rho].
    """

    def __init__(self, qp: QP, state: Vector, tol: float, limit: int) -> None:
        """Write the best state into `state` (3n + m + p,); take at most `limit` systems."""
        self.systems = 0
        self.time = 0.0
        self._qp = qp
        self._program = equilibrate(qp)
        self._state = state
        self._tol = tol
        self._limit = limit
        self._best = np.inf
        self._delta = 0.0

    def attempt(self, delta: float, fraction: float, fall: float) -> bool:
        """Follow the smoothed flow from its start; returns True if the point was found."""
        self._delta = delta
        program = self._program
        now = self._start()
        kept = now
        best = np.inf
        nearest = np.inf
        stalled = 0
        last = min(self._limit, self.systems + MOST)
        while self.systems < last and stalled <= STALLED:
            rates = _rates(program, now)
            nu = float(now.s @ now.mu) / max(now.s.size, 1)
            size = max(nu, _largest(rates))
            if not size < np.inf:
                break
            better = size < 0.9 * best
            if size < NEAR:
                value = self._judge(now.x, now.y, now.mu)
                if value <= 0.5 * self._tol:
                    kept = now
                    break  # the network's own steps sharpen it
                better = better or value < nearest
                nearest = min(nearest, value)
            if better:
                kept = now
            best = min(best, size)
            stalled = 0 if better else stalled + 1
            system = self._factored(1.0 / (now.s / now.mu + delta))
            if not system.usable or 0.0 < nu < 1e-20:
                break
            step = _predicted_and_corrected(system, now, rates, nu, fall)
            # All the way only if nothing is in it.
            now = _moved(now, step, min(max(fraction, 1.0 - nu), 1.0 - 1e-6))
            self.time += 1.0 / delta
        active = kept.mu > kept.s
        # From zero, the steps find the smallest multipliers of the active rows: less rounding.
        return self._network(kept.x, kept.y, kept.mu, active) or self._network(
            kept.x, 0.0 * kept.y, 0.0 * kept.mu, active
        )

    def _factored(self, weights: Vector) -> System:
        """Factor the system of a step."""
        system = System(self._program, weights, self._delta)
        self.systems += system.count
        return system

    def _start(self) -> Iterate:
        """Find x and y that balance cost and limits, and positive mu and slacks around them."""
        program = self._program
        system = self._factored(np.ones_like(program.chi))
        x, y, _ = system.solve(-program.q, program.b, program.chi)
        slack = program.chi - program.omega @ x
        mu = np.maximum(-slack - min((-slack).min(initial=0.0), 0.0), 1e-2)
        s = np.maximum(slack - min(slack.min(initial=0.0), 0.0), 1e-2)
        return Iterate(x, y, mu + (slack > 0.0).any(), s + (slack < 0.0).any())

    def _judge(self, x: Vector, y: Vector, mu: Vector) -> float:
        """Compute the largest residual in the program's own units; keep the best state so far."""
        n, _, p = self._qp.sizes
        program = self._program
        state = np.zeros_like(self._state)
        state[:n] = x * program.d
        state[n : n + p] = y[:p] * program.f[:p] / program.c
        state[n + p :][program.used] = mu * program.e / program.c
        point = np.empty(state.size - n)
        largest = _largest(point_of_state(self._qp.data, *self._qp.sizes, state, point))
        if largest < self._best:
            self._best = largest
            self._state[:] = state
        return largest

    def _network(self, x: Vector, y: Vector, mu: Vector, active: NDArray[np.bool_]) -> bool:
        """Take linearly implicit steps of the projection network; returns True if it settled."""
        program = self._program
        mu = np.where(active, mu, 0.0)
        last = np.inf
        for _ in range(NETWORK_STEPS):
            if self.systems >= self._limit:
                break
            system = self._factored(np.where(active, 1.0 / self._delta, 0.0))
            if not system.usable:
                break
            rd = program.P @ x + program.q + program.A.T @ y + program.omega.T @ mu
            slack = program.omega @ x - program.chi
            dx, dy, dmu = system.solve(
                -rd, program.b - program.A @ x, np.where(active, -slack, 0.0)
            )
            mu = np.where(active, mu + dmu, 0.0)
            x = x + dx
            y = y + dy
            self.time += 1.0 / self._delta
            value = self._judge(x, y, np.maximum(mu, 0.0))
            before = active
            active = mu + program.omega @ x - program.chi > 0.0
            if value <= 0.5 * self._tol or (value > 0.5 * last and (active == before).all()):
                break
            mu = np.where(active, mu, 0.0)
            last = value
        return bool(self._best <= self._tol)


def _rates(program: Scaled, now: Iterate) -> tuple[Vector, Vector, Vector]:
    """Compute the dual, the primal and the slacks' residual."""
    dual = program.P @ now.x + program.q + program.A.T @ now.y + program.omega.T @ now.mu
    return dual, program.A @ now.x - program.b, program.omega @ now.x + now.s - program.chi


def _predicted_and_corrected(
    system: System, now: Iterate, rates: tuple[Vector, Vector, Vector], nu: float, fall: float
) -> Iterate:
    """Take one linearly implicit step to nu = 0, then one to the nu that this one lets expect."""
    step = _step(system, now, rates, -now.s * now.mu)
    if nu > 0.0:
        s = now.s + _length(now.s, step.s) * step.s
        mu = now.mu + _length(now.mu, step.mu) * step.mu
        after = float(s @ mu) / s.size
        center = max(min(1.0, max(0.0, after / nu)) ** 3, fall)
        target = -now.s * now.mu - step.s * step.mu + center * nu
        step = _step(system, now, rates, target)
    return step


def _step(
    system: System, now: Iterate, rates: tuple[Vector, Vector, Vector], target: Vector
) -> Iterate:
    """Solve one linearly implicit step with s dmu + mu ds = target."""
    dual, primal, slack = rates
    dx, dy, dmu = system.solve(-dual, -primal, -slack - target / now.mu)
    return Iterate(dx, dy, dmu, (target - now.s * dmu) / now.mu)


def _moved(now: Iterate, step: Iterate, fraction: float) -> Iterate:
    """Move along a step, up to a fraction of the distance to where s or mu is zero."""
    one = _length(now.s, step.s)
    two = _length(now.mu, step.mu)
    one = one if one == 1.0 else fraction * one
    two = two if two == 1.0 else fraction * two
    return Iterate(
        now.x + one * step.x, now.y + two * step.y, now.mu + two * step.mu, now.s + one * step.s
    )


def _length(v: Vector, dv: Vector) -> float:
    """Compute the longest step, at most 1, along dv that holds v nonnegative."""
    falling = dv < 0.0
    return float(np.min(-v[falling] / dv[falling], initial=1.0))


def _largest(arrays: tuple[Vector, ...] | Triple) -> float:
    """Compute the largest absolute entry of several arrays; NaN if one is NaN."""
    return float(np.abs(np.hstack(arrays)).max(initial=0.0))
