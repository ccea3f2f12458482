"""Pseudo-transient continuation: rules of both settle loops, and the loop for any network.

Each round of `settle` first tries one linearly implicit step, very long at first: near the
equilibrium that is a Newton step, and a warm start in a control loop needs only that. If it makes
no `progress`, a fully solved backward Euler step follows, whose length grows from round to round.
Linearly implicit steps of other lengths are tried too where rounding is in the way.

Here a backward Euler step is solved by a semismooth Newton iteration on the whole state. If that
does not converge in `MAX_NEWTON` iterations, the step is cut to a quarter: below one over the
field's Lipschitz constant it does converge, so the flow can always be followed, however slowly. A
linearly implicit step is kept only where it does not go far, since these fields are small in some
places that are far from any equilibrium. The projection network has compiled loops
(`iiwa_dnn.networks.integrators.implicit`).

Source: C. T. Kelley and D. E. Keyes, "Convergence analysis of pseudo-transient continuation",
SIAM J. Numer. Anal. 35 (1998).
"""

import numpy as np

from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.qp.layout import Vector, compiled
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import within

LAST_STEP = 1e6
"""Longest backward Euler step [rho]: beyond, the systems are singular to working precision."""
TRIALS = np.array([1.0, 1e-2, 1e2, 1e-4, 1e4])
"""Lengths of the linearly implicit steps, in units of the first: shorter ones have better
conditioned systems, longer ones bring nearly dependent rows to rest."""
STALLED = 30
"""Rounds with small rates but large residuals, as large multipliers have them, before the end."""
TRAVELLING = 12
"""Longest steps that do not halve the rates, before the end: the state travels, since there is no
solution or none that is near."""
FIRST_STEP = 1.0
GROWTH = 4.0
"""Length of the first step [rho] and its growth; this iteration has no line search to go faster."""
MAX_NEWTON = 15
DEFECT = 1e-3
"""Defect up to which `settle` solves a backward Euler step, in the state's unit."""


@compiled
def near(rate: float, tol: float) -> bool:
    """Tell whether the rates are so near the tolerance that rounding is in the way."""
    return rate <= 1e4 * tol


@compiled
def progress(rate: float, new_rate: float, tol: float) -> bool:
    """Tell whether a step is kept: it halved the largest rate, or lowered it near rest."""
    return new_rate <= 0.5 * rate or (near(rate, tol) and new_rate <= 0.9 * rate)


@compiled
def trial_left(rate: float, tol: float, trial: int) -> bool:
    """Check that a linearly implicit step of another length may help against rounding."""
    return near(rate, tol) and trial + 1 < TRIALS.size


@compiled
def next_step(
    step: float, growth: float, before: float, rate: float, tol: float, travelling: int
) -> tuple[int, float]:
    """Count the longest steps that did not halve the rates, and choose the next step's length."""
    if step < LAST_STEP:
        return travelling, step * growth
    if rate <= 0.5 * before:
        return travelling, step
    # Not a long way to go, but rounding: shorter steps have better conditioned systems.
    return travelling + 1, 100.0 if near(rate, tol) else step


def backward_euler(flow: Flow, start: Vector, step: float, tol: float) -> tuple[Vector | None, int]:
    """Take one backward Euler step, ``new = start + step F(new)``.

    Args:
        flow: The network's right-hand side for the program.
        start: The state, (size,), which is not changed.
        step: Length, in units of rho.
        tol: Largest defect ``|new - start - step F(new)|`` that is accepted beside its rounding,
            in the state's unit.

    Returns:
        The new state (size,), None where the iteration did not converge; linear systems solved.
    """
    new = start.copy()
    eye = np.eye(start.size)
    floor = 1e-14 * step
    for systems in range(MAX_NEWTON + 1):
        defect = new - start - step * flow.rates(new)
        if np.abs(defect).max() <= tol + floor:
            return new, systems
        if systems == MAX_NEWTON or not np.isfinite(defect).all():
            break
        try:
            new = new - np.linalg.solve(eye - step * flow.jacobian(new), defect)
        except np.linalg.LinAlgError:
            break
    return None, systems


def advance(flow: Flow, state: Vector, step: float, count: int, tol: float) -> int:
    """Advance `state` (size,) by `count` backward Euler steps, cut where one does not converge.

    Returns:
        Linear systems solved, or -1 where even very short steps did not converge.
    """
    total = 0
    shortest = 1e-6 * step
    for _ in range(count):
        done = 0.0
        length = step
        while done < step * (1.0 - 1e-12):
            length = min(length, step - done)
            new, systems = backward_euler(flow, state, length, tol)
            total += systems
            if new is not None:
                state[:] = new
                done += length
            elif length < shortest:
                return -1
            else:
                length *= 0.25
    return total


def _linear_step(flow: Flow, state: Vector, rates: Vector, step: float) -> Vector:
    """Take a linearly implicit step [rho]; the state itself if its system is singular."""
    try:
        change = np.linalg.solve(np.eye(state.size) / step - flow.jacobian(state), rates)
    except np.linalg.LinAlgError:
        return state
    return state + change


def settle(
    network: Network,
    qp: QP,
    state: Vector,
    point: Vector,
    tol: float,
    max_systems: int,
    long_step: float,
) -> Settled:
    """Advance `state` (size,) with growing implicit steps; arguments as `Integrator.settle`'s."""
    flow = network.flow(qp)
    step = FIRST_STEP
    systems = 0
    time = 0.0
    trial = 0
    stalled = 0
    travelling = 0
    rates = flow.rates(state)
    rate = float(np.abs(rates).max())
    while systems < max_systems and travelling < TRAVELLING:
        if not rate > tol:
            residuals = network.read(qp, state, point)
            if within(*residuals, tol):
                return systems, time, *residuals
            stalled += 1
            if stalled > STALLED or rate != rate:
                break
        systems += 1
        length = long_step * float(TRIALS[trial])
        new = _linear_step(flow, state, rates, length)
        new_rates = flow.rates(new)
        new_rate = float(np.abs(new_rates).max())
        close = np.abs(new - state).max() <= 10.0 * (1.0 + np.abs(state).max())
        if close and progress(rate, new_rate, tol):
            if new_rate <= 0.5 * rate:
                travelling = 0
            else:
                trial = (trial + 1) % TRIALS.size
            state[:] = new
            rates = new_rates
            rate = new_rate
            time = time + length
            continue
        if trial_left(rate, tol, trial):
            trial += 1
            continue
        reached, solved_in = backward_euler(flow, state, step, DEFECT)
        systems += solved_in
        if reached is None:
            step *= 0.25
            continue
        before = rate
        trial = 0
        time = time + step
        state[:] = reached
        rates = flow.rates(reached)
        rate = float(np.abs(rates).max())
        travelling, step = next_step(step, GROWTH, before, rate, tol, travelling)
    return systems, time, *network.read(qp, state, point)
