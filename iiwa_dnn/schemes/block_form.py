r"""The paper's four orientation rows.

With :math:`r = [R_{11}, R_{12}, R_{21}, R_{22}]`,

.. math::  W(R)\,J_\omega \dot q = \dot r_d - \nu (r - r_d)

where W follows from :math:`\dot R = [\omega]_\times R`: the row of :math:`R_{ij}` is
:math:`(R e_j \times e_i)^T`. These rows have rank three at most, and where the tool's axis is
vertical they lose the two tilts (docs/errata.md). Off the path the four contradict each other, at
second order in the error: no velocity fulfils them all. The right-hand side is therefore projected
on the range of W, which gives the rows their least-squares meaning and changes nothing at first
order. Normal to that range is

.. math::  u = [R_{23}, -R_{13}] \otimes [-R_{32}, R_{31}]

or, where the tool's axis is vertical and u vanishes, all but the column of turning about it.

Source: equations (3) to (5) of the paper.
"""

import math

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.references.rotations import column_of, combined, cross, dot
from iiwa_dnn.schemes.step import FRAME, GAIN, StepViews, vector_at, write_spin

VERTICAL = 1e-9
"""Sine of the angle between the tool's axis and the vertical that counts as none."""


@compiled
def block_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `OrientationTask` in the form ``block``, four."""
    gain = min(constants[GAIN], step.rate)
    placement = step.placements[int(constants[FRAME])]
    for i in range(4):
        unit = (1.0, 0.0, 0.0) if i < 2 else (0.0, 1.0, 0.0)
        here = vector_at(placement, 3 * (i % 2))
        there = column_of(target, i % 2)
        b[i] = gain * dot(unit, combined(1.0, there, -1.0, here))
        b[i] += dot(cross(there, unit), vector_at(target, 15))
        write_spin(step, constants, cross(here, unit), A[i])
    project_on_range(placement, b)


@compiled
def project_on_range(placement: Vector, b: Vector) -> None:
    """Replace b (4,) by its projection on the range of W of a frame's placement (12,)."""
    row = math.sqrt(placement[2] * placement[2] + placement[5] * placement[5])
    column = math.sqrt(placement[6] * placement[6] + placement[7] * placement[7])
    normal = np.empty(4)
    for i in range(4):
        if row > VERTICAL:
            first = placement[7] if i < 2 else -placement[6]
            second = -placement[5] if i % 2 == 0 else placement[2]
            normal[i] = first * second / (row * column)
        else:
            first = -placement[i % 2 * 3 + 1] if i < 2 else placement[i % 2 * 3]
            normal[i] = first / math.sqrt(2.0)
    along = normal[0] * b[0] + normal[1] * b[1] + normal[2] * b[2] + normal[3] * b[3]
    for i in range(4):
        b[i] = b[i] - along * normal[i] if row > VERTICAL else along * normal[i]
