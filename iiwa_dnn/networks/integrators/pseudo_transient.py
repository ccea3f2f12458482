"""Implicit steps of any network, by Newton iterations on its whole state.

`settle` takes one linearly implicit step after another, longer ones as the rates fall
(switched evolution relaxation). The projection network has compiled loops
(`iiwa_dnn.networks.integrators.implicit`).

Source: C. T. Kelley and D. E. Keyes, "Convergence analysis of pseudo-transient continuation",
SIAM J. Numer. Anal. 35 (1998).
"""

import numpy as np

from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.base import Flow, Network
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import within

LONGEST = 1e8
"""Longest step of `settle` [rho]."""
SHORTEST = 1e-6
"""Step [rho] below which the field is not followed any more."""
MAX_NEWTON = 15
"""Newton iterations of one backward Euler step; four short ones follow if they do not converge."""


def settle(
    network: Network, qp: QP, state: Vector, point: Vector, tol: float, max_systems: int
) -> Settled:
    """Advance `state` (size,) with growing implicit steps; arguments as `Integrator.settle`'s."""
    flow = network.flow(qp)
    eye = np.eye(state.size)
    step = 1.0
    systems = 0
    time = 0.0
    rates = flow.rates(state)
    rate = float(np.abs(rates).max())
    while systems < max_systems and step >= SHORTEST:
        if not rate > tol:
            residuals = flow.read(qp, state, point)
            if within(*residuals, tol) or rate != rate:
                return systems, time, *residuals
        systems += 1
        new = state + _solved(eye / step - flow.derivative(state), rates)
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
    return systems, time, *flow.read(qp, state, point)


def backward_euler(flow: Flow, state: Vector, step: float, tol: float) -> int:
    """Take one backward Euler step, ``new = state + step F(new)``, in place.

    Args:
        flow: The network's right-hand side for the program.
        state: The state, (size,).
        step: Length, in units of rho.
        tol: Largest defect ``|new - state - step F(new)|`` that is accepted beside its rounding,
            in the state's unit.

    Returns:
        Linear systems solved.

    Raises:
        NoSolutionError: Very short steps do not converge either.
    """
    new = state.copy()
    eye = np.eye(state.size)
    for systems in range(MAX_NEWTON + 1):
        defect = new - state - step * flow.rates(new)
        if np.abs(defect).max() <= tol + 1e-14 * step:
            state[:] = new
            return systems
        new = new - _solved(eye - step * flow.derivative(new), defect)
    if step < SHORTEST:
        raise NoSolutionError("an implicit step cannot be solved to working precision")
    return MAX_NEWTON + sum(backward_euler(flow, state, 0.25 * step, tol) for _ in range(4))


def _solved(matrix: Vector, values: Vector) -> Vector:
    """Solve a linear system, (size,); NaN if it is singular."""
    try:
        return np.asarray(np.linalg.solve(matrix, values), dtype=np.float64)
    except np.linalg.LinAlgError:
        return np.full_like(values, np.nan)
