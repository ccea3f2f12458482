r"""Implicit Euler with growing steps: pseudo-transient continuation to the equilibrium.

**The step is a convex problem.** Write one backward Euler step of length h (in units of rho) of
the projection network without its primal projection. The multipliers' lines can be solved for:

.. math::

    y^+ = y + h (A x^+ - b), \qquad
    \mu^+ = \max\Bigl(\frac{\mu}{1+h},\; \mu + h\,(\Omega x^+ - \chi)\Bigr)

and both are increasing in :math:`x^+`. What is left, :math:`(x^+ - x)/h + P x^+ + q + A^T y^+ +
\Omega^T \mu^+ = 0`, is therefore the stationarity of a strongly convex, piecewise quadratic
function, for every h. It has one minimiser, and a semismooth Newton iteration with an exact line
search reaches it. A bare Newton iteration on the KKT conditions can cycle when many bounds are
active; this cannot.

**Two kinds of step.** `settle` first tries a single linearised step with a very long h, which near
the equilibrium is a Newton step; a warm start in a control loop needs only that. If it does not
halve the rates, a fully solved step follows whose h grows tenfold a round, from 10 to 1e6. Where
rounding is in the way, linearised steps of other lengths are tried too. The budget is bounded, and
mostly not used: once three of the longest steps have not halved the rates, the state is running
off, and `iiwa_dnn.networks.refutation` looks for the proof that there is no solution.

**What is left out.** The projection of x is not integrated here: at the equilibrium the
multipliers alone keep the bounds, so the answer is the same. The answer that is handed out is
put inside its bounds.

**Other networks** have no compiled loops. Their backward Euler steps are solved by a Newton
iteration on the whole state, and cut where it does not converge
(`iiwa_dnn.networks.integrators.pseudo_transient`).

Sources: C. T. Kelley and D. E. Keyes, "Convergence analysis of pseudo-transient continuation",
SIAM J. Numer. Anal. 35 (1998), for the continuation; R. T. Rockafellar, "Augmented Lagrangians
and applications of the proximal point algorithm in convex programming", Math. Oper. Res. 1
(1976), for the same step of the plain saddle-point flow, which is his method of multipliers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks import Network, ProjectionNetwork
from iiwa_dnn.networks.integrators import pseudo_transient
from iiwa_dnn.networks.integrators.backward_euler import (
    backward_euler,
    begin_gram,
    newton_matrix,
    workspace_size,
)
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.linear_step import (
    linearly_implicit_step,
    recover_multipliers,
    reduced_rates,
)
from iiwa_dnn.networks.projection import field
from iiwa_dnn.qp.dense import solve_upper
from iiwa_dnn.qp.layout import Vector, compiled
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point

FIRST_STEP = 10.0
"""Length of the first fully solved step, in units of rho; it grows tenfold a round."""
LAST_STEP = 1e6
"""Where it ends: beyond, the linear systems are singular to working precision."""
PLAIN = 16
"""Up to this many variables the plain loops of the other modules are quicker than vector code."""
NEAR = 1e4
"""Rates up to this many tolerances are near the solution, where rounding is in the way."""
TRIALS = np.array([1.0, 1e-2, 1e2, 1e-4, 1e4])
"""Lengths of the linearised steps that are tried there, in units of the first: shorter ones have
better conditioned systems, longer ones bring nearly dependent rows to rest."""
MAX_NEWTON = 50
"""Newton iterations of one fully solved step."""


@dataclass(frozen=True)
class ImplicitEuler:
    """Backward Euler, of order 1, stable at any step.

    Attributes:
        step: Longest step of `advance`, in units of rho.
        long_step: Length of the linearised step that `settle` tries first, in units of rho.
        max_steps: Budget of `settle` in linear systems.
    """

    order: ClassVar[int] = 1
    step: float = 1.0
    long_step: float = 1e7
    max_steps: int = 1000

    def __post_init__(self) -> None:
        """Check the numbers."""
        checks.positive("step", self.step)
        checks.positive("long_step", self.long_step)
        checks.integer("max_steps", self.max_steps, 1)

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` in place by `duration` [rho] in equal steps no longer than `step`.

        Returns:
            Linear systems solved.

        Raises:
            NoSolutionError: A step's linear system is singular to working precision.
        """
        count = max(1, math.ceil(duration / self.step))
        length = duration / count
        if isinstance(network, ProjectionNetwork):
            systems = advance_implicit(qp.data, *qp.sizes, state, length, count, 1e-12)
        else:
            systems = pseudo_transient.advance(network.flow(qp), state, length, count, 1e-12)
        if systems < 0:
            raise NoSolutionError("an implicit step is singular to working precision")
        return int(systems)

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`."""
        if not isinstance(network, ProjectionNetwork):
            return pseudo_transient.settle(
                network, qp, state, point, tol, self.max_steps, self.long_step
            )
        n, m, p = qp.sizes
        settled: Settled = settle_implicit(
            qp.data, n, m, p, state, point, tol, self.max_steps, self.long_step
        )
        return settled


@compiled
def advance_implicit(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, count: int, tol: float,
) -> int:  # fmt: skip
    """Advance `s` (size,) in place by `count` backward Euler steps of one length, solved to `tol`.

    Returns:
        Linear systems solved, or -1 where one could not be.
    """
    new, work = s.copy(), np.empty(workspace_size(n, m, p))
    begin_gram(data, n, m, p, work[m : m + n * n], work[:m])
    total = 0
    for _ in range(count):
        systems = backward_euler(data, n, m, p, s, step, new, tol, 100, work)
        if systems < 0:
            return -1
        total += systems
        s[:] = new
    return total


@compiled
def _linear_step(
    data: Vector, n: int, m: int, p: int, s: Vector, rates: Vector, active: Vector, step: float,
    work: Vector, new: Vector,
) -> bool:  # fmt: skip
    """`linearly_implicit_step` with the matrix that is kept up to date in `work`."""
    counted, gram, K = work[:m], work[m : m + n * n], work[m + n * n : m + 2 * n * n]
    rhs = work[m + 2 * n * n : m + 2 * n * n + n]
    reduced_rates(data, n, m, p, rates, active, step, rhs, new)
    newton_matrix(data, n, m, p, step, active, gram, counted, K)
    if not solve_upper(K, n, rhs, new):
        return False
    recover_multipliers(data, n, m, p, s, active, step, new)
    return True


@compiled
def settle_implicit(
    data: Vector, n: int, m: int, p: int, s: Vector, point: Vector, tol: float,
    max_systems: int, long_step: float,
) -> tuple[int, float, float, float, float]:  # fmt: skip
    """Advance `s` in place, with growing implicit steps, until its KKT residuals are below `tol`.

    Each round first tries one linearly implicit step of length `long_step`: near the solution
    that is a Newton step, and it is kept if it halves the largest rate. Otherwise a fully solved
    backward Euler step is taken, which is safe at any length; its length grows tenfold a round.
    Where three of the longest steps have not halved the rate, the state travels and does not
    settle: there is no solution, or none that is near.

    Returns:
        ``(systems, time, primal, dual, gap)``: linear systems solved, network time that passed
        [rho], and the residuals of `point`.
    """
    size, flags = s.size, m + 2 * n
    work = np.empty(3 * size + 2 * flags + n * n + n)
    rates, new_rates, new = work[:size], work[size : 2 * size], work[2 * size : 3 * size]
    active = work[3 * size : 3 * size + flags]
    new_active = work[3 * size + flags : 3 * size + 2 * flags]
    K, rhs = work[3 * size + 2 * flags : -n], work[-n:]
    step = FIRST_STEP
    systems, time, trial, stalled, travelling = 0, 0.0, 0, 0, 0
    begun, factored = False, False
    rate = field(data, n, m, p, False, s, rates, active)
    while systems < max_systems:
        if not rate > tol:
            primal, dual, gap = kkt_point(data, n, m, p, s, point)
            if primal <= tol and dual <= tol and gap <= tol:
                return systems, time, primal, dual, gap
            # Small rates and a large gap: large multipliers. Go on, but not for ever.
            stalled += 1
            if stalled > 30 or rate != rate:
                break
        systems += 1
        factored = factored and trial == 0
        long = long_step * TRIALS[trial]
        if not begun and (systems == 1 or n <= PLAIN):
            solved = linearly_implicit_step(
                data, n, m, p, s, rates, active, long, factored, K, rhs, new
            )
        else:
            if not begun:
                implicit = np.empty(workspace_size(n, m, p))
                begin_gram(data, n, m, p, implicit[m : m + n * n], implicit[:m])
                begun = True
            solved = _linear_step(data, n, m, p, s, rates, active, long, implicit, new)
        if solved:
            new_rate = field(data, n, m, p, False, new, new_rates, new_active)
            halved = new_rate <= 0.5 * rate
            # Where rounding is near, less than a half is progress too.
            if halved or (rate <= NEAR * tol and new_rate <= 0.9 * rate):
                # The same rows active and the same length: the same matrix once more.
                factored = halved and not begun
                for k in range(flags):
                    factored = factored and active[k] == new_active[k]
                s[:] = new
                rates, new_rates = new_rates, rates
                active, new_active = new_active, active
                time += long
                if halved:
                    travelling = 0
                else:
                    trial = (trial + 1) % TRIALS.size
                rate = new_rate
                continue
        if rate <= NEAR * tol and trial + 1 < TRIALS.size:
            trial += 1
            continue
        if not begun:
            implicit = np.empty(workspace_size(n, m, p))
            begin_gram(data, n, m, p, implicit[m : m + n * n], implicit[:m])
            begun = True
        new[:] = s
        count = min(MAX_NEWTON, max_systems - systems)
        solved_in = backward_euler(
            data, n, m, p, s, step, new, min(1e-2, 0.1 * rate), count, implicit
        )
        if solved_in < 0:
            step *= 0.1
            continue
        systems += solved_in
        trial = 0
        time += step
        s[:] = new
        before = rate
        rate = field(data, n, m, p, False, s, rates, active)
        if step < LAST_STEP:
            step *= 10.0
        elif rate > 0.5 * before:
            travelling += 1
            if travelling >= 3:
                break
            if rate <= NEAR * tol:
                # Not a long way to go, but rounding: shorter steps have better conditioned systems.
                step = 10.0 * FIRST_STEP
    primal, dual, gap = kkt_point(data, n, m, p, s, point)
    return systems, time, primal, dual, gap
