"""The implicit integrator for networks without compiled loops: the same two kinds of step.

See `iiwa_dnn.networks.integrators.implicit`. A backward Euler step is solved by a semismooth Newton
iteration on the whole state. Where that does not converge in `MAX_NEWTON` iterations, the step is
cut to a quarter: below one over the field's Lipschitz constant it does converge, so the flow can
always be followed, however slowly. A linearised step is kept only where it halves the rates and
does not go far: these fields are small in some places that are far from any equilibrium.
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn.networks import Flow, Network
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP

MAX_NEWTON = 15
FIRST_STEP, LAST_STEP, GROWTH = 1.0, 1e6, 4.0
DEFECT = 1e-3
"""How well a backward Euler step is solved, in the state's unit."""
NEAR = 1e4
"""Rates up to this many tolerances are near the solution, where rounding is in the way."""
TRIALS = (1.0, 1e-2, 1e2, 1e-4)
"""Lengths of the linearised steps that are tried there, in units of the first."""


def backward_euler(flow: Flow, start: Vector, step: float, tol: float) -> tuple[Vector | None, int]:
    """One backward Euler step, ``new = start + step F(new)``.

    Args:
        flow: The network's right-hand side for the program.
        start: The state, (size,), which is not changed.
        step: Length, in units of rho.
        tol: Largest defect ``|new - start - step F(new)|`` that is accepted, in the state's unit.

    Returns:
        The new state (size,), None where the iteration did not converge; linear systems solved.
    """
    new, eye = start.copy(), np.eye(start.size)
    for systems in range(MAX_NEWTON + 1):
        defect = new - start - step * flow.rates(new)
        if np.abs(defect).max() <= tol:
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
    network: Network,
    qp: QP,
    state: Vector,
    point: Vector,
    tol: float,
    max_systems: int,
    long_step: float,
) -> Settled:
    """Advance `state` (size,) with growing implicit steps; arguments as `Integrator.settle`'s."""
    flow, eye = network.flow(qp), np.eye(state.size)
    step, systems, time = FIRST_STEP, 0, 0.0
    trial, stalled, travelling = 0, 0, 0
    rates = flow.rates(state)
    rate = float(np.abs(rates).max())
    while systems < max_systems:
        if not rate > tol:
            primal, dual, gap = network.read(qp, state, point)
            if primal <= tol and dual <= tol and gap <= tol:
                return systems, time, primal, dual, gap
            stalled += 1
            if stalled > 30 or rate != rate:
                break
        systems += 1
        length = long_step * TRIALS[trial]
        try:
            new = state + np.linalg.solve(eye / length - flow.jacobian(state), rates)
        except np.linalg.LinAlgError:
            new = state
        new_rates = flow.rates(new)
        new_rate = float(np.abs(new_rates).max())
        close = np.abs(new - state).max() <= 10.0 * (1.0 + np.abs(state).max())
        rounding = rate <= NEAR * tol
        if new_rate <= (0.9 if rounding else 0.5) * rate and close:
            if new_rate > 0.5 * rate:
                trial = (trial + 1) % len(TRIALS)
            state[:], rates, rate = new, new_rates, new_rate
            time += length
            continue
        if rounding and trial + 1 < len(TRIALS):
            trial += 1
            continue
        trial = 0
        reached, solved_in = backward_euler(flow, state, step, DEFECT + 1e-14 * step)
        systems += solved_in
        if reached is None:
            step *= 0.25
            continue
        before = rate
        state[:], rates = reached, flow.rates(reached)
        rate = float(np.abs(rates).max())
        time += step
        # The state travels and does not settle: no solution, or none that is near.
        travelling = travelling + 1 if step >= LAST_STEP and rate > 0.5 * before else 0
        if travelling >= 3:
            break
        step = min(GROWTH * step, LAST_STEP)
    return systems, time, *network.read(qp, state, point)
