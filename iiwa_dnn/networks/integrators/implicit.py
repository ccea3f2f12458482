r"""Implicit Euler with growing steps: pseudo-transient continuation to the equilibrium.

**The rules** of `solve`: first a linearly implicit step that is so long that it is Newton's step
on the active set. A warm start in a control loop needs only that. If it does not halve the largest
rate, a backward Euler step follows, ten times as long as the last one; its first direction is that
of the refused step. Both may undo each other's work, so the end comes when some rounds have not
halved the smallest of all rates.

**The primal projection.** `advance` integrates the network as it is. `solve` leaves the projection
of x out, with which a step would no longer be a convex problem
(`iiwa_dnn.networks.integrators.implicit_steps`): at the equilibrium the multipliers alone keep the
bounds, so the answer is the same, and the one that is handed out is put inside its bounds.

**Other networks**, and the projection in `advance`, take linearly implicit steps on the whole state
(`iiwa_dnn.networks.integrators.pseudo_transient`).

Source: C. T. Kelley and D. E. Keyes, "Convergence analysis of pseudo-transient continuation",
SIAM J. Numer. Anal. 35 (1998).
"""

import math
from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled, released
from iiwa_dnn.networks.base import Network, checked_flow
from iiwa_dnn.networks.integrators import pseudo_transient
from iiwa_dnn.networks.integrators.base import (
    Answered,
    AnswerSettings,
    Integrator,
    Progress,
)
from iiwa_dnn.networks.integrators.implicit_steps import (
    Condensed,
    backward_euler,
    linear_step,
)
from iiwa_dnn.networks.integrators.pseudo_transient import LONGEST
from iiwa_dnn.networks.integrators.scaling import LARGE
from iiwa_dnn.networks.projection import is_projection, mark_active, unprojected_rates, write_spans
from iiwa_dnn.qp.layout import QPViews, Sizes, Vector, check_size, copied, qp_views
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import is_small_enough, kkt_point, within

SHORTEST = 30.0
"""Length of the first backward Euler step [rho]."""
GROWTH = 10.0
"""Growth of that length from round to round."""
STALLED = 15
"""Rounds in which the smallest rate so far is not halved, before the end: there is no solution, or
rounding keeps the residuals above the tolerance."""
UNKNOWN = -1.0
"""Mark of a row where the condensed matrix is no factor for a linearly implicit step."""
MAX_NEWTON = 50
"""Newton iterations of one backward Euler step of `solve`, half as many as one of `advance`."""


@dataclass(frozen=True)
class ImplicitEuler(Integrator):
    """Implicit Euler, of order 1; without the primal projection any step has one solution.

    Other networks, and the projection in `advance`, take linearly implicit steps.

    Attributes:
        step: Longest step of `advance`, in units of rho.
        max_steps: Budget of `solve` in linear solves.
    """

    step: float = 1.0
    max_steps: int = 1000

    def __post_init__(self) -> None:
        """Check the numbers."""
        checks.positive("step", self.step)
        checks.integer("max_steps", self.max_steps, 1)

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` in place by `duration` [rho] in equal steps no longer than `step`.

        Returns:
            Number of linear solves. If a matrix is singular, the state becomes NaN.
        """
        count = max(1, math.ceil(duration / self.step))
        check_size("state", state, network.state_size(qp))
        length = duration / count
        if is_projection(network) and not network.primal_projection:
            return sum(step_program(qp.data, *qp.sizes, state, length) for _ in range(count))
        flow = checked_flow(network, qp)
        for _ in range(count):
            state += pseudo_transient.linear_change(flow, state, length, flow.rates(state))
        return count

    def solve(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Progress:
        """Advance a state (size,) in place until the KKT residuals of its point are at most `tol`.

        The point (2 n + m + p,) is overwritten. The projection network is integrated without its
        primal projection.
        """
        if is_projection(network):
            n, m, p = qp.sizes
            check_size("state", state, 3 * n + m + p)
            check_size("point", point, 2 * n + m + p)
            stats = solve_program(qp.data, qp.sizes, state, point, tol, self.max_steps)
            return int(stats[0]), *stats[1:]
        return pseudo_transient.solve(network, qp, state, point, tol, self.max_steps)


@compiled
def step_program(data: Vector, n: int, m: int, p: int, s: Vector, step: float) -> int:
    """Advance the projection network, without its primal projection, by one backward Euler step.

    Args:
        data: The program, `QP.data`.
        n: Number of variables.
        m: Number of inequality rows.
        p: Number of equality rows.
        s: State of the network, (3n + m + p,), advanced in place.
        step: Length of the step [rho].

    Returns:
        Number of linear solves; 0, with a state of NaN, if a matrix is not positive definite.
    """
    rows = s.size - n
    qp = qp_views(data, n, m, p)
    spans = np.empty(2 * m)
    write_spans(qp, spans)
    matrix = Condensed(
        np.empty(rows), np.zeros(m + p), np.zeros((n, n)), np.empty((n, n)), np.empty(rows), spans
    )
    new = s.copy()
    linear_solves = backward_euler(qp, s, step, new, 1e-12, 2 * MAX_NEWTON, matrix)
    if linear_solves < 0:
        new[:] = np.nan
    copied(s, new)
    return max(linear_solves, 0)


@compiled
def solve(qp: QPViews, rates: int, settings: AnswerSettings, s: Vector, point: Vector) -> Answered:
    """Solve by `solve_within`, as a function of type `enter_answer` for projection networks."""
    return solve_within(qp, settings.tolerance, int(settings.budget), s, point)


@compiled
def solve_within(qp: QPViews, tol: float, budget: int, s: Vector, point: Vector) -> Answered:
    """Advance a state `s` (size,) until the residuals of its point are at most `tol`.

    The state is advanced in place, the point (2n + m + p,) is overwritten. After `budget` linear
    solves, or where the residuals stall, the last state is kept.

    Returns:
        ``(linear_solves, time, primal, dual, gap)``: linear solves, network time that passed
        [rho], and the residuals of `point`.
    """
    n = qp.q.size
    rows = s.size - n
    spans = np.empty(2 * qp.h.size)
    write_spans(qp, spans)
    matrix = Condensed(
        np.empty(rows),
        np.zeros(rows - 2 * n),
        np.zeros((n, n)),
        np.empty((n, n)),
        np.empty(rows),
        spans,
    )
    now = np.empty(s.size)
    then = np.empty(s.size)
    new = s.copy()
    step = SHORTEST
    linear_solves = 0
    time = 0.0
    stalled = 0
    longest = _longest_step(qp)
    matrix.active[:] = UNKNOWN
    rate = unprojected_rates(qp, spans, s, now)
    smallest = np.inf
    while linear_solves < budget:
        stalled += 1
        if rate < 0.5 * smallest:
            smallest = rate
            stalled = 0
        if not rate > tol:
            primal, dual, gap = kkt_point(qp, s, point)
            if within(primal, dual, gap, tol):
                return linear_solves, time, primal, dual, gap
        changed = mark_active(qp, s, now, matrix.active)
        linear_solves += 1
        if linear_step(qp, s, now, longest, matrix, changed == 0, new):
            new_rate = unprojected_rates(qp, spans, new, then)
            if new_rate < 0.5 * rate:
                copied(s, new)
                copied(now, then)
                rate = new_rate
                time += longest
                continue
        if stalled > 0:
            kkt_point(qp, s, point)
            if stalled > STALLED or is_small_enough(qp, point, tol, 0.0):
                break
        taken = backward_euler(
            qp, s, step, new, 0.1 * rate, min(MAX_NEWTON, budget - linear_solves), matrix
        )
        matrix.active[:] = UNKNOWN
        linear_solves += max(taken, -taken)
        if taken < 0:
            step *= 0.1
            continue
        time += step
        copied(s, new)
        rate = unprojected_rates(qp, spans, s, now)
        if step < longest:
            step *= GROWTH
    primal, dual, gap = kkt_point(qp, s, point)
    return linear_solves, time, primal, dual, gap


@compiled
def _longest_step(qp: QPViews) -> float:
    """Return the longest implicit step [rho]: `LONGEST`, longer for a curvature above `LARGE`.

    A step of length h leaves the fraction 1 / (1 + h / c) of an error of a multiplier, c being the
    curvature of the cost along its row.
    """
    largest = LARGE
    for i in range(qp.q.size):
        largest = max(largest, qp.P[i, i])
    return LONGEST * (largest / LARGE)


@released
def solve_program(
    data: Vector, sizes: Sizes, s: Vector, point: Vector, tol: float, max_linear_solves: int
) -> Answered:
    """Solve by `solve_within` for a program's flat array, `QP.data`, of sizes (n, m, p)."""
    n, m, p = sizes
    return solve_within(qp_views(data, n, m, p), tol, max_linear_solves, s, point)
