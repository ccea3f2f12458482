r"""Certificates that a program has no solution, verified in floating point.

**Infeasible.** Multipliers :math:`(y, z, z_{box})` with :math:`z \ge 0`, and :math:`z_{box}`
positive only at a finite ub and negative only at a finite lb, prove it by Farkas' lemma where

.. math::

    r := A^T y + G^T z + z_{box} = 0, \qquad
    v := b^T y + h^T z + ub^T [z_{box}]_+ - lb^T [-z_{box}]_+ < 0 ,

since a feasible x would have :math:`0 = r^T x \le v < 0`.

**Unbounded.** A direction d with :math:`Pd = 0`, :math:`Ad = 0`, :math:`Gd \le 0`, d not towards a
finite bound, and :math:`q^T d < 0`: from any feasible point the cost falls along it for ever.

**In floating point** no residual is exactly zero, so a certificate has a radius. With r as it is,
every feasible x has :math:`\|x\|_\infty \ge -v/\|r\|_1`; with the direction's residuals as they
are, every KKT point has an entry of at least :math:`-q^T d` over the sum of their absolute values.
A radius of at least `RADIUS` is worth saying, for no solution with entries below it exists,
whatever the tolerance of the solver. It does not prove that there is none.

**Proven outright.** Bounds do: with :math:`w = A^T y + G^T z`, every feasible x has
:math:`\sum_i \min(w_i\, lb_i, w_i\, ub_i) \le w^T x \le b^T y + h^T z`, and where rounding included
the left side is above the right one, no x is feasible. Where an x without a bound takes part, w
has to be exactly zero there, which are the equations :math:`M \lambda = 0` of the multipliers
:math:`\lambda`. They hold in whole numbers; or else, with an approximate right inverse R of M,
there is an exact one within :math:`|R| \|M \lambda\|_\infty / (1 - \|I - M R\|_\infty)`, and if
it keeps the signs, it is the certificate. So is a direction near d, on which all of P, A and the
rows of G that do not fall are exactly zero. Rounding is counted against the certificate throughout.
"""

from fractions import Fraction
from operator import mul

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.program import QP

RADIUS = 1e8
"""Radius from which on a certificate is claimed."""

_EPS = float(np.finfo(float).eps)


def infeasibility_radius(qp: QP, vector: Vector) -> float:
    """Compute the radius below which no x is feasible, as multipliers ``[y | z | z_box]`` prove.

    Args:
        qp: The program.
        vector: Multipliers, of size p + m + n.

    Returns:
        A bound on the largest entry of any feasible x; inf where the residual is exactly zero, and
        0 where nothing is proven.
    """
    _, m, p = qp.sizes
    y = vector[:p]
    z = vector[p : p + m]
    z_box = vector[p + m :]
    inside = np.concatenate([z, np.maximum(z_box, 0.0), np.maximum(-z_box, 0.0)])
    limits = np.concatenate([qp.h, qp.ub, -qp.lb])
    used = inside != 0.0
    if not np.isfinite(vector).all() or (z < 0.0).any() or not np.isfinite(limits[used]).all():
        return 0.0
    residual = qp.A.T @ y + qp.G.T @ z + z_box
    size = np.abs(qp.A.T) @ np.abs(y) + np.abs(qp.G.T) @ z + np.abs(z_box)
    terms = np.concatenate([qp.b * y, limits[used] * inside[used]])
    return _radius(terms, float((np.abs(residual) + _rounding(m + p + 1) * size).sum()))


def unboundedness_radius(qp: QP, direction: Vector) -> float:
    """Compute the radius within which there is no KKT point, as the direction proves.

    Args:
        qp: The program.
        direction: Direction of recession, (n,).

    Returns:
        A bound on the largest entry of x and of the multipliers of any KKT point; inf where the
        residuals are exactly zero, and 0 where nothing is proven.
    """
    n, _, p = qp.sizes
    if not np.isfinite(direction).all():
        return 0.0
    rows = np.vstack([qp.P, qp.A, qp.G[np.isfinite(qp.h)]])
    values = rows @ direction
    wrong = np.abs(values)
    wrong[n + p :] = values[n + p :]  # below zero, an inequality's row is no residual
    error = _rounding(n) * (np.abs(rows) @ np.abs(direction))
    outside = np.abs(direction[towards_bound(qp, direction)]).sum()
    return _radius(qp.q * direction, float(np.maximum(wrong + error, 0.0).sum() + outside))


def proves_infeasible(qp: QP, vector: Vector) -> bool:
    """Test whether multipliers near ``[y | z | z_box]`` prove outright that no x is feasible.

    Those of the rows alone are read, (p + m + n,): bounds take what is left.
    """
    _, m, p = qp.sizes
    if not infeasibility_radius(qp, vector) > 0.0:
        return False
    vector = vector[: p + m]
    used = vector != 0.0
    rows = np.vstack([qp.A, qp.G])[used]
    limits = np.concatenate([qp.b, qp.h])[used]
    weights = vector[used]
    least = _least_on_box(qp, rows, weights, 0.0)
    unlimited = np.isneginf(least)
    error = _distance_from_null_space(rows[:, unlimited].T, weights)
    signed = used[qp.b.size :].sum()
    if error and not error < weights[weights.size - signed :].min(initial=np.inf):
        return False
    least = np.where(unlimited, 0.0, _least_on_box(qp, rows, weights, error))
    value = limits @ weights
    size = np.abs(limits) @ np.abs(weights) + np.abs(least).sum()
    rounding = _rounding(least.size + weights.size) * size + 2.0 * error * np.abs(limits).sum()
    return bool(least.sum() - value > rounding)


def _least_on_box(qp: QP, rows: Matrix, weights: Vector, error: float) -> Vector:
    """Bound each term of weights^T rows x from below, (n,), for x in its bounds.

    Args:
        qp: The program.
        rows: Rows (k, n).
        weights: Their multipliers, (k,).
        error: Error of each multiplier.
    """
    sums = np.abs(rows).sum(axis=0)
    center = rows.T @ weights
    radius = _rounding(weights.size) * (np.abs(rows).T @ np.abs(weights)) + 2.0 * error * sums
    ends = np.array([center - radius, center + radius])
    with np.errstate(invalid="ignore"):
        products = ends[:, np.newaxis] * np.array([qp.lb, qp.ub])
    # Zero times infinity: the variable takes no part.
    least: Vector = np.where(np.isnan(products), 0.0, products).min(axis=(0, 1))
    return least


def _distance_from_null_space(M: Matrix, vector: Vector) -> float:
    """Bound how far a vector (k,) is from one on which M (j, k) is exactly zero; inf if unknown."""
    fractions = [Fraction(value) for value in vector.tolist()]
    if all(sum(map(mul, map(Fraction, row), fractions)) == 0 for row in M.tolist()):
        return 0.0
    M = M[np.any(M != 0.0, axis=1)]
    if M.shape[0] > M.shape[1]:
        return np.inf
    R = np.linalg.pinv(M)
    rounding = _rounding(max(M.shape))
    residual = np.abs(M @ vector) + rounding * (np.abs(M) @ np.abs(vector))
    defect = np.abs(np.eye(M.shape[0]) - M @ R) + rounding * (1.0 + np.abs(M) @ np.abs(R))
    contraction = float(defect.sum(axis=1).max())
    if not contraction < 0.5:
        return np.inf
    # Twice as much takes in the rounding of all that is positive here.
    return 2.0 * float(np.abs(R).sum(axis=1).max() * residual.max() / (1.0 - contraction))


def proves_unbounded(qp: QP, direction: Vector) -> bool:
    """Test whether a direction near this one (n,) proves outright that there is no KKT point."""
    moves = direction != 0.0
    if towards_bound(qp, direction).any() or not unboundedness_radius(qp, direction) > 0.0:
        return False
    d = direction[moves]
    inequalities = qp.G[np.isfinite(qp.h)][:, moves]
    sizes = np.abs(inequalities)
    values = inequalities @ d
    falls = values < -1e-9 * (sizes @ np.abs(d))
    rows = np.vstack([qp.P[:, moves], qp.A[:, moves], inequalities[~falls]])
    error = _distance_from_null_space(rows, d)
    bounded = (np.isfinite(qp.lb) | np.isfinite(qp.ub))[moves]
    if not error < np.abs(d[bounded]).min(initial=np.inf):
        return False
    rising = values + _rounding(d.size) * (sizes @ np.abs(d)) + 2.0 * error * sizes.sum(axis=1)
    q = qp.q[moves]
    slope = q @ d + _rounding(d.size) * (np.abs(q) @ np.abs(d)) + 2.0 * error * np.abs(q).sum()
    return bool(slope < 0.0 and (rising[falls] < 0.0).all())


def towards_bound(qp: QP, vector: Vector) -> NDArray[np.bool_]:
    """Mark the entries of `vector` (n,) that point from the inside to a finite bound, (n,)."""
    marked: NDArray[np.bool_] = (vector > 0.0) & (qp.ub < np.inf)
    return marked | ((vector < 0.0) & (qp.lb > -np.inf))


def _rounding(terms: int) -> float:
    """Bound the relative rounding error of a sum of so many products."""
    return (terms + 2) * _EPS


def _radius(terms: Vector, residual: float) -> float:
    """Divide a certificate's value, less its rounding, by its residual; 0 if it has none."""
    value = -float(terms.sum() + _rounding(terms.size) * np.abs(terms).sum())
    if not value > 0.0:
        return 0.0
    return value / residual if residual > 0.0 else np.inf
