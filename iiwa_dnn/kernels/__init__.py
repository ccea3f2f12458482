"""The inner loops that are compiled with numba; nothing is compiled elsewhere.

One module for each thing that is done; `batch` and `dense` are imported by those who need them. A
quadratic program travels as `QP.data` with its sizes n, m, p, and is read in place:

    P[i, k]  data[i n + k]          G[j, i]  data[at_G + j n + i]     lb[i]  data[at_lb + i]
    q[i]     data[at_q + i]         A[j, i]  data[at_A + j n + i]     ub[i]  data[at_lb + n + i]
    h[j]     data[at_G + m n + j]   b[j]     data[at_lb - p + j]

The state of the projection network is one flat array, ``s = [x | y | z | u | l]``, with

    x (n)  the decision variables          z (m)  multipliers of G x <= h
    y (p)  multipliers of A x = b          u, l (n each)  multipliers of x <= ub and lb <= x

so u and l are the paper's mu for Omega = [I; -I]. Time is in units of the time constant rho.
The mathematics stands in `iiwa_dnn.schemes`, `iiwa_dnn.networks.projection` and
`iiwa_dnn.networks.integrators.implicit`.
"""

# The kernels are plain loops over flat arrays on purpose. For seven joints a BLAS call costs more
# than its work, and so does every view: numba counts its references.
from __future__ import annotations

from iiwa_dnn.kernels.control import control_step
from iiwa_dnn.kernels.implicit import advance_implicit, settle_implicit
from iiwa_dnn.kernels.layout import larger, offsets
from iiwa_dnn.kernels.linear_step import (
    cholesky_factor,
    condensed_matrix,
    factor_solve,
    linearly_implicit_step,
    recover_multipliers,
    reduced_rates,
)
from iiwa_dnn.kernels.motion import clip_command, move, window_mean
from iiwa_dnn.kernels.network import explicit_euler, extreme_eigenvalues, field, stable_step
from iiwa_dnn.kernels.program import (
    block_map,
    orientation_rows,
    project_on_range,
    rotation_log,
    velocity_bounds,
    velocity_program,
)
from iiwa_dnn.kernels.residuals import kkt_point, largest_residuals, point_residuals

__all__ = [
    "advance_implicit",
    "block_map",
    "cholesky_factor",
    "clip_command",
    "condensed_matrix",
    "control_step",
    "explicit_euler",
    "extreme_eigenvalues",
    "factor_solve",
    "field",
    "kkt_point",
    "larger",
    "largest_residuals",
    "linearly_implicit_step",
    "move",
    "offsets",
    "orientation_rows",
    "point_residuals",
    "project_on_range",
    "recover_multipliers",
    "reduced_rates",
    "rotation_log",
    "settle_implicit",
    "stable_step",
    "velocity_bounds",
    "velocity_program",
    "window_mean",
]
