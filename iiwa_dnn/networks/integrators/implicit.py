r"""Implicit Euler with growing steps: pseudo-transient continuation to the equilibrium.

**The rules** of `settle`, by which linearly implicit and backward Euler steps take turns, are those
of `iiwa_dnn.networks.integrators.pseudo_transient`. Its budget is mostly not used: once three of
the longest steps have not halved the rates, the state is running off, and
`iiwa_dnn.networks.refutation` looks for the proof that there is no solution.

**The primal projection.** `advance` integrates the network as it is. `settle` leaves the projection
of x out, with which a step would no longer be a convex problem
(`iiwa_dnn.networks.integrators.implicit_steps`): at the equilibrium the multipliers alone keep the
bounds, so the answer is the same, and the one that is handed out is put inside its bounds.

**Networks without compiled loops**, and the projection in `advance`, go through a Newton iteration
on the whole state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numba import types

from iiwa_dnn import checks
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators import pseudo_transient
from iiwa_dnn.networks.integrators.base import Integrator, Settled
from iiwa_dnn.networks.integrators.implicit_steps import backward_euler, begin_gram, linear_step
from iiwa_dnn.networks.integrators.pseudo_transient import near, next_step, progress
from iiwa_dnn.networks.projection import field
from iiwa_dnn.qp.compiling import VECTOR, Signature
from iiwa_dnn.qp.layout import Vector, check_size, compiled, released
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point, within

FIRST_STEP, GROWTH = 30.0, 10.0
"""Length of the first backward Euler step [rho], and its growth from round to round."""
MAX_NEWTON = 50
"""Newton iterations of one backward Euler step of `settle`, half as many as one of `advance`."""


@dataclass(frozen=True)
class ImplicitEuler(Integrator):
    """Backward Euler, of order 1, stable at any step.

    Attributes:
        step: Longest step of `advance`, in units of rho.
        long_step: Length of the linearly implicit step that `settle` tries first, in units of rho.
        max_steps: Budget of `settle` in linear systems.
    """

    order: ClassVar[int] = 1
    step: float = 1.0
    long_step: float = 1e8
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
            NoSolutionError: A step could not be solved to working precision.
        """
        count = max(1, math.ceil(duration / self.step))
        length, form = duration / count, network.compiled
        if form is not None and not form.project:
            n, m, p = qp.sizes
            check_size("state", state, 3 * n + m + p)
            systems = advance_implicit(qp.data, n, m, p, state, length, count, 1e-12)
        else:
            systems = pseudo_transient.advance(network.flow(qp), state, length, count, 1e-12)
        if systems < 0:
            raise NoSolutionError("an implicit step cannot be solved to working precision")
        return systems

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`.

        The projection network is integrated without its primal projection.
        """
        if network.compiled is None:
            return pseudo_transient.settle(
                network, qp, state, point, tol, self.max_steps, self.long_step
            )
        n, m, p = qp.sizes
        check_size("state", state, 3 * n + m + p)
        check_size("point", point, 2 * n + m + p)
        return settle_implicit(qp.data, n, m, p, state, point, tol, self.max_steps, self.long_step)


@compiled
def advance_implicit(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, count: int, tol: float
) -> int:
    """Advance `s` (size,) in place by `count` backward Euler steps of one length, solved to `tol`.

    Returns:
        Linear systems solved, or -1 where one could not be.
    """
    counted, gram, K, new = np.empty(m), np.empty(n * n), np.empty(n * n), s.copy()
    begin_gram(data, n, m, p, counted, gram)
    total, most = 0, 2 * MAX_NEWTON
    for _ in range(count):
        systems = backward_euler(data, n, m, p, s, step, new, tol, most, counted, gram, K)
        if systems < 0:
            return -1
        total += systems
        for i in range(s.size):
            s[i] = new[i]
    return total


@compiled
def _any(values: Vector) -> bool:
    """Tell whether a value is not zero, with less to compile than numpy's own."""
    k = 0
    while k < values.size and values[k] == 0.0:
        k += 1
    return k < values.size


@released
def settle_implicit(
    data: Vector, n: int, m: int, p: int, s: Vector, point: Vector, tol: float,
    max_systems: int, long_step: float,
) -> tuple[int, float, float, float, float]:  # fmt: skip
    """Advance `s` (size,) in place until the residuals of `point` (size,) are at most `tol`.

    Returns:
        ``(systems, time, primal, dual, gap)``: linear systems solved, network time that passed
        [rho], and the residuals of `point`.
    """
    size, flags, project = s.size, m + 2 * n, tol < 0.0  # False; a literal is compiled apart
    work = np.empty(3 * (size + flags) + 2 * n * n + p + m)  # several would take as long as a step
    rates, new_rates, new = work[:size], work[size : 2 * size], work[2 * size : 3 * size]
    rest = work[3 * size :]
    active, new_active = rest[:flags], rest[flags : 2 * flags]
    rhs, counted = rest[2 * flags : 3 * flags + p], rest[3 * flags + p : 3 * flags + p + m]
    rest = rest[3 * flags + p + m :]
    gram, K = rest[: n * n], rest[n * n :]
    begin_gram(data, n, m, p, counted, gram)
    step, systems, time, factored = FIRST_STEP, 0, 0.0, project
    trial, stalled, travelling = 0, 0, 0
    rate = field(data, n, m, p, project, s, rates, active)
    # A cold start that breaks limits: the long step would hold them all, and be refused.
    far = not _any(s) and _any(active)
    while systems < max_systems and travelling < pseudo_transient.TRAVELLING:
        if not rate > tol:
            primal, dual, gap = kkt_point(data, n, m, p, s, point)
            if within(primal, dual, gap, tol):
                return systems, time, primal, dual, gap
            stalled += 1
            if stalled > pseudo_transient.STALLED or rate != rate:
                break
        systems, length = systems + (not far), long_step * pseudo_transient.TRIALS[trial]
        if not far and linear_step(
            data, n, m, p, s, rates, active, length, factored, counted, gram, K, rhs, new
        ):
            new_rate = field(data, n, m, p, project, new, new_rates, new_active)
            if progress(rate, new_rate, tol):
                factored = new_rate <= 0.5 * rate
                if factored:
                    travelling = 0
                else:
                    trial = (trial + 1) % pseudo_transient.TRIALS.size
                # The same rows active and the same length: the same matrix once more.
                for k in range(flags):
                    factored = factored and active[k] == new_active[k]
                for i in range(size):
                    s[i] = new[i]
                rates, new_rates = new_rates, rates
                active, new_active = new_active, active
                rate, time = new_rate, time + length
                continue
        factored = far = False
        if near(rate, tol) and trial + 1 < pseudo_transient.TRIALS.size:
            trial += 1
            continue
        count, before = min(MAX_NEWTON, max_systems - systems), rate
        for i in range(size):
            new[i] = s[i]
        solved_in = backward_euler(data, n, m, p, s, step, new, 0.1 * rate, count, counted, gram, K)
        if solved_in < 0:
            step *= 0.1
            continue
        for i in range(size):
            s[i] = new[i]
        rate = field(data, n, m, p, project, s, rates, active)
        systems, trial, time = systems + solved_in, 0, time + step
        travelling, step = next_step(step, GROWTH, before, rate, tol, travelling)
    primal, dual, gap = kkt_point(data, n, m, p, s, point)
    return systems, time, primal, dual, gap


@released
def sharpen_implicit(
    data: Vector, n: int, m: int, p: int, s: Vector, point: Vector, step: float, count: int
) -> tuple[float, float, float]:
    """Take `count` linearly implicit steps from an equilibrium; keep the state that is nearest one.

    Unlike in `settle_implicit`, the rates may grow on the way: a step in a direction that costs
    next to nothing can reach a limit that the next step then holds.

    Returns:
        ``(primal, dual, gap)`` of `point`, that of the state which `s` holds in the end.
    """
    size, flags = s.size, m + 2 * n
    rates, active, rhs = np.empty(size), np.empty(flags), np.empty(flags + p)
    counted, gram, K = np.empty(m), np.empty(n * n), np.empty(n * n)
    new, other = s.copy(), np.empty(point.size)
    begin_gram(data, n, m, p, counted, gram)
    primal, dual, gap = kkt_point(data, n, m, p, s, point)
    for _ in range(count):
        old = new.copy()
        field(data, n, m, p, step < 0.0, old, rates, active)
        if not linear_step(
            data, n, m, p, old, rates, active, step, step < 0.0, counted, gram, K, rhs, new
        ):
            break
        first, second, third = kkt_point(data, n, m, p, new, other)
        if max(first, second, third) < max(primal, dual, gap):
            primal, dual, gap = first, second, third
            for k in range(size):
                s[k] = new[k]
            for k in range(point.size):
                point[k] = other[k]
    return primal, dual, gap


SETTLED = types.Tuple([types.int64, *4 * [types.float64]])
SETTLE = Signature(
    SETTLED, VECTOR, *3 * [types.int64], VECTOR, VECTOR, types.float64, types.int64, types.float64
)
