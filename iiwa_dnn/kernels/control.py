"""A whole control step in one compiled call: the program is assembled, and the network answers it.

For seven joints the way into compiled code is a large part of what a call costs, so a control loop
enters it once a step. The parts are those of its neighbours.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.kernels.program import velocity_program
from iiwa_dnn.networks.integrators.explicit import explicit_euler
from iiwa_dnn.networks.integrators.implicit import settle_implicit
from iiwa_dnn.networks.projection import field, stable_step
from iiwa_dnn.qp.residuals import kkt_point


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def control_step(row, p, mode, q, pose, jacobian, target, kinetic, constants, state):
    """Write program and answer of one control step into `row`, laid out as in `Answers`.

    The arguments from `p` to `kinetic` are those of `velocity_program`. `constants` is, one array
    being taken more quickly than five, [network (7) | parameters (5) | home (n) | limits (3 n)].
    The network's numbers are the tolerance, the budget and the first step of the implicit
    integrator; then the time to advance, zero for settling, whether x is projected, how many
    explicit sub-steps are asked for (zero for as many as stability needs) and which share of the
    stable step is used.

    Returns:
        False where the network did not settle or diverged; `state` is then what it was.
    """
    n = q.size
    at_point = n * (n + 3) + p * (n + 1)
    at_figures = at_point + 2 * n + p
    data, point, figures = row[:at_point], row[at_point:at_figures], row[at_figures:]
    network, parameters = constants[:7], constants[7:12]
    home, limits = constants[12 : 12 + n], constants[12 + n :].reshape(3, n)
    velocity_program(
        data, p, mode, q, pose, jacobian, target, limits, home, kinetic, parameters
    )  # fmt: skip
    tol, duration, projected = network[0], network[3], network[4] != 0.0
    before = state.copy()
    if duration > 0.0:
        count = int(network[5])
        if count == 0:
            active = np.empty(2 * n)
            field(data, n, 0, p, projected, state, np.empty(state.size), active)
            stable = network[6] * stable_step(data, n, 0, p, active)
            if not stable > 0.0:
                return False
            count = max(1, int(np.ceil(duration / stable)))
        explicit_euler(data, n, 0, p, projected, state, duration / count, count, -1.0)
        iterations, time = count, duration
        primal, dual, gap = kkt_point(data, n, 0, p, state, point)
        succeeded = primal + dual + gap < np.inf
    else:
        iterations, time, primal, dual, gap = settle_implicit(
            data, n, 0, p, state, point, tol, int(network[1]), network[2]
        )
        succeeded = primal <= tol and dual <= tol and gap <= tol
    if not succeeded:
        state[:] = before
        return False
    figures[0], figures[1], figures[2], figures[3], figures[4] = iterations, time, primal, dual, gap
    k = 5
    for i in range(4):
        for j in range(4):
            figures[k] = pose[i, j]
            k += 1
    return True
