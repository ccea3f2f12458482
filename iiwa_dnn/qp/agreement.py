r"""Agreement of an answer with a reference: in the solution, in the objective, and in feasibility.

An answer x is judged beside the point :math:`[x_r | y | z | z_{box}]` of a reference by three gaps:

(a) the largest violation of a row :math:`a^T x \le b`, over :math:`\max(w, |a|^T |x| + |b|)`;

(b) the difference of the objectives, over
:math:`\max(w, \tfrac12 |x|^T |P| |x|, |q|^T |x|)`;

(c) the largest entry of :math:`x - x_r` in the range of

.. math::

    S = P + A^T A + G_+^T G_+ + I_+ ,

all rows scaled to length 1, where + selects rows and bounds with a multiplier at the reference.

w is 1, or the largest coefficient of the row or the cost where that is not within 1e-3 and 1e3. (Of
a row of 1e8 through x = 0, a point 1e-9 from the solution is 0.1 outside.) In the null space of S
the cost is linear and no row with a multiplier leaves its limit, so a step along it leaves the
objective as it is: where it is feasible, it leads to another solution. Where there is only one, and
each active row has a multiplier, S is definite and (c) the largest entry of x - x_r.

A reference with the residual r is up to about :math:`r / \lambda` from the solution along an
eigenvector of S with the eigenvalue :math:`\lambda`: it says nothing of x where three times that
exceeds the tolerance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp.dense import ROUNDING
from iiwa_dnn.qp.layout import Matrix, QPViews, Sizes, Vector
from iiwa_dnn.qp.program import QP, field_slices

USUAL = 1e3
"""Largest coefficient of a cost or a row, or its inverse, up to which it is not scaled."""

_ACTIVE = 1e-6
"""Multiplier above which a row or bound is active, relative to the largest one if that is above
1."""

_FLAT = ROUNDING
"""Eigenvalue of S, relative to n times the largest, up to which it is rounding: x is free along its
eigenvector."""

NOISE = 2.0**-45
"""Root of a variable's curvature, relative to the largest, up to which it is rounding."""


class Agreement(NamedTuple):
    """Gaps between answers to N programs and k references; NaN where no reference has an answer.

    Attributes:
        solution_gap: Largest difference in x where x is unique, (N, k); of joint velocities in
            [rad/s].
        objective_gap: Difference in the objective, relative to its terms, (N, k).
        feasibility_gap: Largest violation of a row or bound, relative to its terms, (N, k).
        reference_residual: Largest KKT residual of each reference, the one that judged or was asked
            last, (N, k); inf without an answer, or where its answer decides nothing; 0 where a
            proof judged.
        judge: 0 where the reference that was asked judged, 1 where the second one did, 2 where a
            proof did in their place, -1 where nobody could, (N, k).

    Of the reference "proof", the solution gap is the bound of `Proof` and the objective gap the
    largest that this bound allows, to first order; without a bound, gap and residual are inf.
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


def curvatures(block: QPViews) -> Matrix:
    """Return the root of each variable's own curvature, relative to the largest one, (N, n)."""
    root = np.sqrt(np.abs(np.diagonal(block.P, axis1=1, axis2=2)))
    return np.asarray(root / root.max(axis=1, keepdims=True, initial=np.finfo(float).tiny))


def normalised(programs: Matrix, sizes: Sizes) -> tuple[Matrix, Matrix]:
    """Divide the cost and the rows of N programs by their `units`, and multiply their variables.

    A variable is multiplied by the unit of its own curvature's root, relative to the largest one.

    Args:
        programs: One `QP.data` a row.
        sizes: Their `QP.sizes`.

    Returns:
        The programs, one `QP.data` a row, and the factors from their variables to those that were
        given, (N, n).
    """
    n, m, _ = sizes
    block = stacked(programs, sizes)
    root = curvatures(block)
    factors = 1.0 / units(np.where(root > NOISE, root, 0.0)[:, :, np.newaxis])
    rows = factors[:, np.newaxis] * np.hstack(
        [block.P * factors[:, :, np.newaxis], block.q[:, np.newaxis], block.G, block.A]
    )
    unit = units(rows)
    unit[:, : n + 1] = units(np.abs(rows[:, : n + 1]).max(axis=2, initial=0.0))[:, np.newaxis]
    rows = (rows / unit[:, :, np.newaxis]).reshape(len(rows), n * unit.shape[1])
    P_q_G, A = np.split(rows, [n * (n + 1 + m)], axis=1)
    h, b = np.split(np.hstack([block.h, block.b]) / unit[:, n + 1 :], [m], axis=1)
    return np.hstack([P_q_G, h, A, b, block.lb / factors, block.ub / factors]), factors


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
    relative = excess / np.maximum(units(rows), terms)
    return np.asarray(np.where(limits < np.inf, relative, 0.0).max(axis=1, initial=0.0))


@np.errstate(invalid="ignore")
def objective_gaps(block: QPViews, x: Matrix, steps: Matrix) -> Matrix:
    """Compute the absolute differences of the objectives at x (N, n) and at x - steps (N, k, n).

    Returns:
        The differences, (N, k), each divided by the largest of three numbers at x: the sum of the
        absolute quadratic terms, that of the linear ones, and the unit (`units`) of the largest
        coefficient. The third keeps the quotient finite at x = 0.
    """
    size = np.abs(x)
    curved = 0.5 * np.einsum("ki,kij,kj->k", size, np.abs(block.P), size)
    linear = (np.abs(block.q) * size).sum(axis=1)
    coefficients = np.maximum(np.abs(block.P).max(axis=2, initial=0.0), np.abs(block.q))
    terms = np.max([curved, linear, units(coefficients)], axis=0)
    # By the gradient halfway: subtracting two objectives would cancel.
    halfway = x[:, np.newaxis] - 0.5 * steps
    gradient = 0.5 * halfway @ (block.P + block.P.swapaxes(1, 2)) + block.q[:, np.newaxis]
    return np.asarray(np.abs((gradient * steps).sum(axis=2)) / terms[:, np.newaxis])


def unique_step(qp: QP, reference: Vector, step: Vector) -> tuple[Vector, float]:
    """Project a difference x - x_r on the directions in which x is unique.

    Args:
        qp: The program, normalised.
        reference: Its point by a reference, (2 n + m + p,).
        step: The difference x - x_r, (n,); x is normalised too.

    Returns:
        The difference in those directions, (n,), and the least eigenvalue of S there.
    """
    n, _, p = qp.sizes
    rows = np.vstack([qp.A, qp.G, np.eye(n)])
    length = np.linalg.norm(rows, axis=1)
    force = length * np.abs(reference[n:])
    active = force > _ACTIVE * max(1.0, force[p:].max())
    active[:p] = length[:p] > 0.0
    directions = rows[active] / length[active, np.newaxis]
    eigenvalues, vectors = np.linalg.eigh(qp.P + directions.T @ directions)
    is_unique = eigenvalues > _FLAT * n * eigenvalues[-1]
    unique = vectors[:, is_unique]
    return unique @ (unique.T @ step), float(eigenvalues[is_unique].min(initial=np.inf))
