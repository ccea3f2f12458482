"""A whole control step in one compiled call: the program is assembled and the network answers it.

For seven joints the way into compiled code is a large part of the cost of a call, so a control loop
enters it once a step.
"""

import numpy as np
from numba import njit

from iiwa_dnn.control.answers import FIGURES, PLACE
from iiwa_dnn.networks.integrators.base import DURATION, TOLERANCE, enter_answer
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled, qp_views
from iiwa_dnn.qp.residuals import within
from iiwa_dnn.schemes.assembly import ASSEMBLE
from iiwa_dnn.schemes.parts import Codes

_enter_assemble = ASSEMBLE.enter


@compiled
def control_step(
    rows: Matrix, index: int, codes: Codes, work: Vector, jacobian: Matrix, placements: Matrix,
    state: Vector, built: bool, motion: float,
) -> bool:  # fmt: skip
    """Write program and answer of one control step into row `index` of `Answers.rows`.

    Args:
        rows: `Answers.rows`; the row ends with the step's targets.
        index: Number of the row.
        codes: `Layout.codes`, with the addresses of `assemble` and of the answering function.
        work: ``[1 / dt | last command (dof) | the one before (dof) | joint positions (dof) |
            network | inertia matrix (dof dof, or none) | constants | room for a state]``: the
            commands are written; the network's constants are those of `CompiledAnswer`; the others
            are `Layout.numbers`.
        jacobian: `Kinematics.jacobian`, (dof, 6).
        placements: `Kinematics.placements`, (frames, 12).
        state: The network's state, (size,), advanced.
        built: Whether the row holds the program already.
        motion: Where above 0, the answer moves the joint positions in `work` for this time [s], as
            the ideal plant does.

    Returns:
        False where the network did not settle or diverged; `state` is then as it was.
    """
    n, m, p, dof = codes[0], codes[1], codes[2], codes[3]
    row = rows[index]
    at_point = (n + m + p) * (n + 1) + 2 * n
    at_figures = at_point + 2 * n + m + p
    data, point, figures = row[:at_point], row[at_point:at_figures], row[at_figures:]
    at_network = 1 + 3 * dof
    q, network = work[1 + 2 * dof : at_network], work[at_network : at_network + codes[10]]
    inertia, before = work[at_network + codes[10] : -state.size], work[-state.size :]
    if not built:
        targets = figures[FIGURES + PLACE + dof :]
        constants = inertia[dof * dof :] if codes[6] != 0 else inertia
        past = work[1 : 1 + 2 * dof]
        _enter_assemble(
            codes[7], data, codes, constants, q, jacobian, placements, inertia, targets, work[0],
            past,
        )  # fmt: skip
    for i in range(state.size):
        before[i] = state[i]
    iterations, time, primal, dual, gap = enter_answer(
        codes[8], qp_views(data, n, m, p), codes[9], network, state, point
    )
    if network[DURATION] > 0.0:
        succeeded = primal + dual + gap < np.inf
    else:
        succeeded = within(primal, dual, gap, network[TOLERANCE])
    if not succeeded:
        for i in range(state.size):
            state[i] = before[i]
        return False
    figures[0], figures[1], figures[2], figures[3], figures[4] = iterations, time, primal, dual, gap
    for i in range(PLACE):
        figures[FIGURES + i] = placements[codes[5], i]
    for i in range(dof):
        figures[FIGURES + PLACE + i] = q[i]
        work[1 + dof + i], work[1 + i] = work[1 + i], point[i]
        if motion > 0.0:
            # Rounded as numpy would: the record's q[k + 1] is q[k] + dt dq[k] to the last bit.
            q[i] = move(q[i], motion, point[i])
    return True


# fastmath=False: left out, it would be inherited from the caller.
@njit(cache=True, error_model="numpy", fastmath=False)
def move(q: float, dt: float, dq: float) -> float:
    """Return q + dt dq, the product rounded before the sum."""
    return q + dt * dq
