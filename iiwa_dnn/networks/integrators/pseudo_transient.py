"""Linearly implicit steps of any network: one Newton iteration of backward Euler, on all states.

`solve` takes longer ones as the rates fall (switched evolution relaxation). The projection network
has compiled loops (`iiwa_dnn.networks.integrators.implicit`).

Source: C. T. Kelley and D. E. Keyes, "Convergence analysis of pseudo-transient continuation",
SIAM J. Numer. Anal. 35 (1998).
"""

import numpy as np

from iiwa_dnn.networks.base import Flow, Network, checked_flow
from iiwa_dnn.networks.integrators.base import Progress
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import within

LONGEST = 1e8
"""Longest implicit step of a network that converges [rho]."""
SHORTEST = 1e-6
"""Step [rho] below which the iteration ends."""


def solve(
    network: Network, qp: QP, state: Vector, point: Vector, tol: float, max_linear_solves: int
) -> Progress:
    """Advance `state` (size,) with growing implicit steps; arguments as `ImplicitEuler.solve`."""
    flow = checked_flow(network, qp)
    step = 1.0
    linear_solves = 0
    time = 0.0
    rates = flow.rates(state)
    rate = float(np.abs(rates).max())
    while linear_solves < max_linear_solves and step >= SHORTEST:
        if not rate > tol:
            residuals = flow.read(qp, state, point)
            if within(*residuals, tol) or rate != rate:
                return linear_solves, time, *residuals
        linear_solves += 1
        new = state + linear_change(flow, state, step, rates)
        new_rates = flow.rates(new)
        new_rate = float(np.abs(new_rates).max())
        # The fields are small in some places that are far from any equilibrium.
        far = np.abs(new - state).max() > 10.0 * (1.0 + np.abs(state).max())
        if far or not new_rate <= 2.0 * rate:
            step *= 0.25
            continue
        time += step
        growth = min(rate / max(new_rate, 1e-300), 100.0)
        step = min(step * max(growth, 1.5 if new_rate < rate else 0.5), LONGEST)
        state[:] = new
        rates = new_rates
        rate = new_rate
    return linear_solves, time, *flow.read(qp, state, point)


def linear_change(flow: Flow, state: Vector, step: float, rates: Vector) -> Vector:
    """Compute the change of a state with these rates, (size,) each, by a linearly implicit step.

    The step is in units of rho. If its matrix is singular, the change is NaN.
    """
    matrix = np.eye(state.size) / step - flow.derivative(state)
    try:
        return np.asarray(np.linalg.solve(matrix, rates), dtype=np.float64)
    except np.linalg.LinAlgError:
        return np.full_like(rates, np.nan)
