r"""Agreement of an answer with a reference: in the solution, in the objective, and in feasibility.

An answer x is judged beside the point :math:`[x_r | y | z | z_{box}]` of a reference by three gaps:

(a) the largest violation of a row :math:`a^T x \le b`, over :math:`\max(w, |a|^T |x| + |b|)`;

(b) the difference of the objectives, over
:math:`\max(w, \tfrac12 |x|^T |P| |x|, |q|^T |x|)`;

(c) the largest entry of :math:`x - x_r` in the range of

.. math::

    S = P + A^T A + G_+^T G_+ + I_+ ,

all rows scaled to length 1, where + selects rows and bounds with a multiplier at the reference.

w is 1, or the largest coefficient of the row or the cost where all of them are slight. In the null
space of S the cost is linear and no row with a multiplier leaves its limit, so a step along it
leaves the objective as it is: where it is feasible, it leads to another solution. Where there is
only one, and each active row has a multiplier, S is definite and (c) the largest entry of x - x_r.
Where an answer differs from the reference, the reference is polished first, as OSQP does it: x_r is
then that of its active rows.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp.layout import Matrix, QPViews, Sizes, Vector
from iiwa_dnn.qp.program import QP, field_slices

USUAL = 1e3
"""Largest coefficient of a cost or a row, or its inverse, up to which it is not scaled."""

_ACTIVE = 1e-6
"""Multiplier above which a row or bound is active, relative to the largest one if that is above
1."""

_FLAT = 1e-8
"""Eigenvalue of S, relative to the largest, up to which x is free along its eigenvector."""


class Agreement(NamedTuple):
    """Gaps between answers to N programs and k references; NaN where no reference has an answer.

    Attributes:
        solution_gap: Largest difference in x where x is unique, (N, k); of joint velocities in
            [rad/s].
        objective_gap: Difference in the objective, relative to its terms, (N, k).
        feasibility_gap: Largest violation of a row or bound, relative to its terms, (N, k).
        reference_residual: Largest KKT residual of each reference, the one that judged or was asked
            last, (N, k); inf without an answer.
        judge: 0 where the reference that was asked judged, 1 where the second one did, -1 where
            neither has an answer that is believed, (N, k).

    Of a proof, the solution gap is the bound of `Proof`, the objective gap the largest that this
    bound allows, to first order, and the residual 0; without a bound, gap and residual are inf.
    """

    solution_gap: Matrix
    objective_gap: Matrix
    feasibility_gap: Matrix
    reference_residual: Matrix
    judge: NDArray[np.int8]

    @property
    def largest(self) -> Matrix:
        """Largest of the three gaps, (N, k); NaN if one is."""
        return np.asarray(np.maximum.reduce(self[:3]))

    def worst_of(self, group: int) -> Agreement:
        """Return the worst agreement of each `group` of consecutive programs, a step's stages."""
        steps = len(self.judge) // group
        *gaps, judge = (array.reshape(steps, group, self.judge.shape[1]) for array in self)
        worst = np.where((judge < 0).any(axis=1), -1, judge.max(axis=1)).astype(np.int8)
        return Agreement._make([*(gap.max(axis=1) for gap in gaps), worst])


def stacked(programs: Matrix, sizes: Sizes) -> QPViews:
    """View N programs, one `QP.data` a row, as the eight fields, each with a first axis of N."""
    parts = [(programs[:, part], shape) for part, shape in field_slices(sizes)]
    return QPViews(*[part.reshape(len(part), *shape) for part, shape in parts])


@np.errstate(divide="ignore", invalid="ignore")
def units(coefficients: Matrix) -> Matrix:
    """Return the unit of each row of coefficients (..., n), (...).

    If the largest coefficient of a row is 0 or between 1 / `USUAL` and `USUAL`, the unit is 1, else
    that coefficient, rounded down to a power of two so that a division by the unit is exact.
    """
    largest = np.abs(coefficients).max(axis=-1, initial=0.0)
    usual = (largest == 0.0) | ((largest >= 1.0 / USUAL) & (largest <= USUAL))
    return np.where(usual, 1.0, np.exp2(np.floor(np.log2(largest))))


def normalised(programs: Matrix, sizes: Sizes) -> Matrix:
    """Divide the cost and the rows of N programs, one `QP.data` a row, by their `units`."""
    n = sizes[0]
    block = stacked(programs, sizes)
    cost = units(programs[:, np.newaxis, : n * n + n])
    G = units(block.G)
    A = units(block.A)
    bounds = np.ones((len(programs), 2 * n))
    divisors = [cost.repeat(n * n + n, 1), G.repeat(n, 1), G, A.repeat(n, 1), A, bounds]
    return programs / np.concatenate(divisors, axis=1)


@np.errstate(invalid="ignore")
def feasibility_gaps(block: QPViews, x: Matrix) -> Vector:
    """Compute the largest violation of a row or bound at N points (N, n), (N,).

    A violation is relative to the sum of the absolute terms of its row.
    """
    eye = np.broadcast_to(np.eye(x.shape[1]), block.P.shape)
    rows = np.concatenate([block.A, -block.A, block.G, eye, -eye], axis=1)
    limits = np.concatenate([block.b, -block.b, block.h, block.ub, -block.lb], axis=1)
    terms = np.einsum("kji,ki->kj", np.abs(rows), np.abs(x)) + np.abs(limits)
    excess = np.einsum("kji,ki->kj", rows, x) - limits
    relative = excess / np.maximum(np.minimum(units(rows), 1.0), terms)
    return np.asarray(np.where(limits < np.inf, relative, 0.0).max(axis=1, initial=0.0))


@np.errstate(invalid="ignore")
def objective_gaps(block: QPViews, x: Matrix, steps: Matrix) -> Matrix:
    """Compute the absolute differences of the objectives at x (N, n) and at x - steps (N, k, n).

    Returns:
        The differences, (N, k), each divided by the largest of three numbers at x: the sum of the
        absolute quadratic terms, that of the linear ones, and the unit (`units`) of the largest
        coefficient, at most 1. The third keeps the quotient finite at x = 0.
    """
    size = np.abs(x)
    curved = 0.5 * np.einsum("ki,kij,kj->k", size, np.abs(block.P), size)
    linear = (np.abs(block.q) * size).sum(axis=1)
    coefficients = np.maximum(np.abs(block.P).max(axis=2, initial=0.0), np.abs(block.q))
    terms = np.max([curved, linear, np.minimum(units(coefficients), 1.0)], axis=0)
    # By the gradient halfway: subtracting two objectives would cancel.
    halfway = x[:, np.newaxis] - 0.5 * steps
    gradient = 0.5 * halfway @ (block.P + block.P.swapaxes(1, 2)) + block.q[:, np.newaxis]
    return np.asarray(np.abs((gradient * steps).sum(axis=2)) / terms[:, np.newaxis])


def solution_gap(qp: QP, reference: Vector, x: Vector, tolerance: float) -> float:
    """Compute the largest absolute entry of x - x_r in the directions in which x is unique.

    If no entry of x - x_r exceeds the tolerance, all directions count.

    Args:
        qp: The program, normalised.
        reference: Its point by the reference, (2 n + m + p,).
        x: The answer, (n,).
        tolerance: Largest gap that counts as agreement.
    """
    n = x.size
    if not np.abs(x - reference[:n]).max() > tolerance:
        return float(np.abs(x - reference[:n]).max())
    point, directions = _polished(qp, reference)
    step = x - point[:n]
    eigenvalues, vectors = np.linalg.eigh(qp.P + directions.T @ directions)
    free = vectors[:, eigenvalues <= _FLAT * eigenvalues[-1]]
    return float(np.abs(step - free @ (free.T @ step)).max())


def _polished(qp: QP, reference: Vector) -> tuple[Vector, Matrix]:
    """Solve the KKT system of the rows that are active at a reference's point.

    A point with a KKT residual of 1e-10 may be 1e-6 from the solution.

    Returns:
        The point, the reference's own if no better, (2 n + m + p,); and the active rows, scaled to
        length 1, (k, n).
    """
    n, m, p = qp.sizes
    rows = np.vstack([qp.A, qp.G, np.eye(n)])
    limits = np.concatenate([qp.b, qp.h, np.where(reference[-n:] > 0.0, qp.ub, qp.lb)])
    length = np.linalg.norm(rows, axis=1)
    force = length * np.abs(reference[n:])
    active = force > _ACTIVE * max(1.0, force[p:].max())
    active[:p] = length[:p] > 0.0
    directions = rows[active] / length[active, np.newaxis]
    gradient = qp.P @ reference[:n] + qp.q + reference[n:] @ rows
    excess = (rows[active] @ reference[:n] - limits[active]) / length[active]
    k = len(directions)
    kkt = np.block([[qp.P, directions.T], [directions, np.zeros((k, k))]])
    step = np.linalg.lstsq(kkt, np.concatenate([gradient, excess]))[0]
    point = reference.copy()
    point[:n] -= step[:n]
    point[n:][active] -= step[n:] / length[active]
    point[n + p : n + p + m].clip(0.0, out=point[n + p : n + p + m])
    better = qp.residuals(point).largest < qp.residuals(reference).largest
    return point if better else reference, directions
