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

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators import pseudo_transient
from iiwa_dnn.networks.integrators.base import (
    ANSWER,
    BUDGET,
    LONG_STEP,
    TOLERANCE,
    Integrator,
    Settled,
    answer_program,
)
from iiwa_dnn.networks.integrators.implicit_steps import (
    Condensed,
    backward_euler,
    condensed,
    condensed_size,
    copy_into,
    linear_step,
)
from iiwa_dnn.networks.integrators.pseudo_transient import (
    STALLED,
    TRAVELLING,
    TRIALS,
    next_step,
    progress,
    trial_left,
)
from iiwa_dnn.networks.projection import field, is_projection, mark_active
from iiwa_dnn.qp.compiling import borrowed, outlived
from iiwa_dnn.qp.layout import (
    QPViews,
    Triple,
    Vector,
    borrowed_views,
    check_size,
    compiled,
    inlined,
    qp_views,
    released,
)
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point, within

FIRST_STEP = 30.0
"""Length of the first backward Euler step [rho]."""
GROWTH = 10.0
"""Growth of that length from round to round."""
AT_ONCE = 500
"""Linear systems after which compiled code returns, so that Ctrl-C ends a long settle."""
MAX_NEWTON = 50
"""Newton iterations of one backward Euler step of `settle`, half as many as one of `advance`."""


@dataclass(frozen=True)
class ImplicitEuler(Integrator):
    """Backward Euler, of order 1; without the primal projection any step has one solution.

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
        length = duration / count
        check_size("state", state, network.state_size(qp))
        if is_projection(network) and not network.primal_projection:
            systems = advance_implicit(qp.data, *qp.sizes, state, length, count, 1e-12)
        else:
            systems = pseudo_transient.advance(network.flow(qp), state, length, count, 1e-12)
        if systems < 0:
            raise NoSolutionError("an implicit step cannot be solved to working precision")
        return systems

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`.

        The projection network is integrated without its primal projection.
        """
        budget = self.max_steps
        if is_projection(network):
            return settle_program(qp, state, point, tol, budget, self.long_step)
        return pseudo_transient.settle(network, qp, state, point, tol, budget, self.long_step)


@compiled
def advance_implicit(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, count: int, tol: float
) -> int:
    """Advance `s` (size,) in place by `count` backward Euler steps of one length, solved to `tol`.

    Returns:
        Linear systems solved, or -1 if one could not be.
    """
    qp = qp_views(data, n, m, p)
    matrix = condensed(qp, np.empty(condensed_size(qp)))
    new = s.copy()
    total = 0
    for _ in range(count):
        systems = backward_euler(qp, s, step, new, tol, 2 * MAX_NEWTON, matrix)
        if systems < 0:
            return -1
        total += systems
        copy_into(s, new)
    return total


@compiled
def _starts_outside(s: Vector, active: Vector) -> bool:
    """Check for a cold start that breaks limits, from which a long step would be refused."""
    return not _any(s) and _any(active)


@compiled
def _any(values: Vector) -> bool:
    """Check that a value is not zero, with less to compile than numpy's own."""
    k = 0
    while k < values.size and values[k] == 0.0:
        k += 1
    return k < values.size


@compiled
def _same(values: Vector, others: Vector) -> bool:
    """Check that all values (k,) equal the first entries of the others."""
    k = 0
    while k < values.size and values[k] == others[k]:
        k += 1
    return k == values.size


@inlined
def _linear_rate(
    qp: QPViews,
    s: Vector,
    rates: Vector,
    step: float,
    factored: bool,
    matrix: Condensed,
    new: Vector,
    new_rates: Vector,
) -> float:
    """Take a `linear_step` and return the largest rate after it; NaN if it cannot be solved."""
    if not linear_step(qp, s, rates, step, factored, matrix, new):
        return np.nan
    return field(qp, step < 0.0, new, new_rates)


@compiled
def settle(qp: QPViews, rates: int, constants: Vector, s: Vector, point: Vector) -> Settled:
    """Advance `s` (size,) in place until the residuals of `point` (size,) are small enough.

    A compiled answer (`ANSWER`), of the projection network alone: `rates` is not used.

    Returns:
        ``(systems, time, primal, dual, gap)``: linear systems solved, network time that passed
        [rho], and the residuals of `point`.
    """
    tol = constants[TOLERANCE]
    max_systems = int(constants[BUDGET])
    long_step = constants[LONG_STEP]
    qp = borrowed_views(qp)
    s = borrowed(s)
    point = borrowed(point)
    size = s.size
    owner = np.empty(4 * size + condensed_size(qp))  # several take as long as some rows
    work = borrowed(owner)
    now = work[:size]
    new_rates = work[size : 2 * size]
    new = work[2 * size : 3 * size]
    before = work[3 * size : 4 * size]
    matrix = condensed(qp, work[4 * size :])
    project = tol < 0.0  # False; a literal is compiled once more
    step = FIRST_STEP
    systems = 0
    time = 0.0
    factored = project
    trial = 0
    stalled = 0
    travelling = 0
    rate = field(qp, project, s, now)
    mark_active(s, now, matrix.active)
    refused = _starts_outside(s, matrix.active)
    while systems < max_systems and travelling < TRAVELLING and stalled <= STALLED:
        if not rate > tol:
            primal, dual, gap = kkt_point(qp, s, point)
            if within(primal, dual, gap, tol):
                return systems, time, primal, dual, gap
            stalled += 1
        if not refused:
            systems += 1
            length = long_step * TRIALS[trial]
            new_rate = _linear_rate(qp, s, now, length, factored, matrix, new, new_rates)
            if progress(rate, new_rate, tol):
                halved = new_rate <= 0.5 * rate
                if halved:
                    travelling = 0
                else:
                    trial = (trial + 1) % TRIALS.size
                copy_into(s, new)
                now, new_rates = new_rates, now
                copy_into(before, matrix.active)
                mark_active(s, now, matrix.active)
                # The same rows active and the same length: the same matrix once more.
                factored = halved and _same(matrix.active, before)
                rate = new_rate
                time += length
                continue
        factored = False
        refused = False
        if trial_left(rate, tol, trial):
            trial += 1
            mark_active(s, now, matrix.active)
            continue
        copy_into(new, s)
        count = min(MAX_NEWTON, max_systems - systems)
        solved_in = backward_euler(qp, s, step, new, 0.1 * rate, count, matrix)
        if solved_in < 0:
            step *= 0.1
        else:
            copy_into(s, new)
            last_rate = rate
            rate = field(qp, project, s, now)
            systems += solved_in
            trial = 0
            time += step
            travelling, step = next_step(step, GROWTH, last_rate, rate, tol, travelling)
        mark_active(s, now, matrix.active)
    primal, dual, gap = kkt_point(qp, s, point)
    outlived(owner)
    return systems, time, primal, dual, gap


def settle_program(
    qp: QP, state: Vector, point: Vector, tol: float, max_systems: int, long_step: float
) -> Settled:
    """Settle the projection network from `state` (size,), interruptibly; see `settle`."""
    n, m, p = qp.sizes
    check_size("state", state, 3 * n + m + p)
    check_size("point", point, 2 * n + m + p)
    address = ANSWER.address(settle)
    systems = 0
    time = 0.0
    while True:
        budget = min(AT_ONCE, max_systems - systems)
        constants = np.array([tol, budget, long_step])
        settled = answer_program(qp.data, qp.sizes, address, 0, constants, state, point)
        systems += settled[0]
        time += settled[1]
        if settled[0] < AT_ONCE or systems >= max_systems or within(*settled[2:], tol):
            return systems, time, *settled[2:]


@released
def sharpen_implicit(
    data: Vector, n: int, m: int, p: int, s: Vector, point: Vector, step: float, count: int
) -> Triple:
    """Take `count` linearly implicit steps from an equilibrium; keep the state that is nearest one.

    Unlike in `settle`, the rates may grow on the way: a step in a direction that costs
    next to nothing can reach a limit that the next step then holds.

    Returns:
        ``(primal, dual, gap)`` of `point`, that of the state which `s` holds in the end.
    """
    qp = qp_views(data, n, m, p)
    matrix = condensed(qp, np.empty(condensed_size(qp)))
    rates = np.empty(s.size)
    new = s.copy()
    old = np.empty(s.size)
    other = np.empty(point.size)
    primal, dual, gap = kkt_point(qp, s, point)
    for _ in range(count):
        copy_into(old, new)
        field(qp, step < 0.0, old, rates)
        mark_active(old, rates, matrix.active)
        if not linear_step(qp, old, rates, step, step < 0.0, matrix, new):
            break
        first, second, third = kkt_point(qp, new, other)
        if max(first, second, third) < max(primal, dual, gap):
            primal = first
            dual = second
            gap = third
            copy_into(s, new)
            copy_into(point, other)
    return primal, dual, gap
