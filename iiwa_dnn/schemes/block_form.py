r"""The paper's four orientation rows.

With :math:`r = [R_{11}, R_{12}, R_{21}, R_{22}]`,

.. math::  W(R)\,J_\omega \dot q = \dot r_d - \nu (r - r_d)

where W follows from :math:`\dot R = [\omega]_\times R`. These rows have rank three at most, and
where the tool's axis is vertical they lose the two tilts (docs/errata.md). Off the path the four
contradict each other, at second order in the error: no velocity fulfils them all. The right-hand
side is therefore projected on the range of W, which gives the rows their least-squares meaning and
changes nothing at first order.

Source: equations (3) to (5) of the paper.
"""

import numpy as np

from iiwa_dnn.qp import Matrix, Vector
from iiwa_dnn.qp.layout import compiled
from iiwa_dnn.schemes.step import StepViews


@compiled
def block_rows(step: StepViews, constants: Vector, target: Vector, A: Matrix, b: Vector) -> None:
    """Write the rows of `OrientationTask` in the form ``block``, four."""
    frame = int(constants[0])
    gain = min(constants[1], step.rate)
    here = np.empty((4, 3))
    there = np.empty((4, 3))
    rotation = np.empty((3, 3))
    desired = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            rotation[i, j] = step.placements[frame, 3 * j + i]
            desired[i, j] = target[3 + 3 * i + j]
    block_map(rotation, here)
    block_map(desired, there)
    for i in range(4):
        b[i] = gain * (desired[i // 2, i % 2] - rotation[i // 2, i % 2])
        for k in range(3):
            b[i] += there[i, k] * target[15 + k]
        for j in range(step.q.size):
            if step.moves[frame, j] != 0.0:
                value = 0.0
                for k in range(3):
                    value += here[i, k] * step.jacobian[j, 3 + k]
                A[i, j] = value
    project_on_range(here, b)


@compiled
def block_map(R: Matrix, out: Matrix) -> None:
    """Write W(R) (4, 3): the rate of [R11 R12 R21 R22] is W(R) times the angular velocity."""
    for i in range(4):
        for j in range(3):
            out[i, j] = 0.0
    for column in range(2):
        out[column, 1] = R[2, column]
        out[column, 2] = -R[1, column]
        out[2 + column, 0] = -R[2, column]
        out[2 + column, 2] = R[0, column]


@compiled
def project_on_range(columns: Matrix, vector: Vector) -> None:
    """Replace `vector` (4,) by its projection on the range of `columns` (4, 3), which is spoilt.

    Gram-Schmidt with pivoting; a direction below 1e-9 of the entries' scale, one, is none.
    """
    rows, count = columns.shape
    result = np.zeros(rows)
    for _ in range(count):
        best = 0
        largest = 0.0
        for j in range(count):
            norm = 0.0
            for i in range(rows):
                norm += columns[i, j] * columns[i, j]
            if norm > largest:
                best = j
                largest = norm
        if largest <= 1e-18:
            break
        scale = 1.0 / np.sqrt(largest)
        along = 0.0
        for i in range(rows):
            columns[i, best] *= scale
            along += columns[i, best] * vector[i]
        for i in range(rows):
            result[i] += along * columns[i, best]
        for j in range(count):
            if j != best:
                _take_out(columns, best, j)
        for i in range(rows):
            columns[i, best] = 0.0
    for i in range(rows):
        vector[i] = result[i]


@compiled
def _take_out(columns: Matrix, unit: int, other: int) -> None:
    """Make a column orthogonal to a unit column, twice, so that rounding leaves no trace of it."""
    rows = columns.shape[0]
    for _ in range(2):
        overlap = 0.0
        for i in range(rows):
            overlap += columns[i, unit] * columns[i, other]
        for i in range(rows):
            columns[i, other] -= overlap * columns[i, unit]
