"""Implicit integration of a network without compiled loops, by Newton's iteration on its state.

A backward Euler step is solved by a semismooth Newton iteration. Where that does not converge in
`MAX_NEWTON` iterations, the step is cut to a quarter: below one over the field's Lipschitz constant
it does converge, so the flow can always be followed, however slowly. `settle` follows the rules of
`iiwa_dnn.networks.integrators.continuation`; a linearly implicit step is kept only where it does
not go far, since these fields are small in some places that are far from any equilibrium.
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.continuation import (
    STALLED,
    TRAVELLING,
    TRIALS,
    near,
    next_step,
    progress,
    within,
)
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP

MAX_NEWTON = 15
FIRST_STEP, GROWTH = 1.0, 4.0
"""Length of the first step [rho] and its growth; this iteration has no line search to go faster."""
DEFECT = 1e-3
"""How well a backward Euler step of `settle` is solved, in the state's unit."""


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
    new, eye = start.copy(), np.eye(start.size)
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
    total, shortest = 0, 1e-6 * step
    for _ in range(count):
        done, length = 0.0, step
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


def settle(
    network: Network, qp: QP, state: Vector, point: Vector, tol: float, max_systems: int,
    long_step: float,
) -> Settled:  # fmt: skip
    """Advance `state` (size,) with growing implicit steps; arguments as `Integrator.settle`'s."""
    flow, eye = network.flow(qp), np.eye(state.size)
    step, systems, time = FIRST_STEP, 0, 0.0
    trial, stalled, travelling = 0, 0, 0
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
        try:
            new = state + np.linalg.solve(eye / length - flow.jacobian(state), rates)
        except np.linalg.LinAlgError:
            new = state
        new_rates = flow.rates(new)
        new_rate = float(np.abs(new_rates).max())
        close = np.abs(new - state).max() <= 10.0 * (1.0 + np.abs(state).max())
        if close and progress(rate, new_rate, tol):
            if new_rate <= 0.5 * rate:
                travelling = 0
            else:
                trial = (trial + 1) % TRIALS.size
            state[:], rates, rate, time = new, new_rates, new_rate, time + length
            continue
        if near(rate, tol) and trial + 1 < TRIALS.size:
            trial += 1
            continue
        reached, solved_in = backward_euler(flow, state, step, DEFECT)
        systems += solved_in
        if reached is None:
            step *= 0.25
            continue
        before, trial, time = rate, 0, time + step
        state[:], rates = reached, flow.rates(reached)
        rate = float(np.abs(rates).max())
        travelling, step = next_step(step, GROWTH, before, rate, tol, travelling)
    return systems, time, *network.read(qp, state, point)
