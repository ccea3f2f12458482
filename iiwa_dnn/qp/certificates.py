r"""Certificates that a program has no solution, verified in floating point.

**Infeasible.** Multipliers :math:`(y, z, z_{box})` with :math:`z \ge 0`, and :math:`z_{box}`
positive only at a finite ub and negative only at a finite lb, prove it by Farkas' lemma where

.. math::

    r := A^T y + G^T z + z_{box} = 0, \qquad
    v := b^T y + h^T z + ub^T [z_{box}]_+ - lb^T [-z_{box}]_+ < 0 ,

since a feasible x would have :math:`0 = r^T x \le v < 0`.

**Unbounded.** A direction d with :math:`Pd = 0`, :math:`Ad = 0`, :math:`Gd \le 0`, d not towards a
finite bound, and :math:`q^T d < 0`: from any feasible point the cost falls along it for ever.

**In floating point** no residual is exactly zero, so a certificate has a radius, and is verified
where it is at least `RADIUS`: then no solution with entries below it exists, whatever the tolerance
of the solver. With r as it is, every feasible x has :math:`\|x\|_\infty \ge -v/\|r\|_1`. With the
direction's residuals as they are, every KKT point has an entry of at least :math:`-q^T d` over the
sum of their absolute values. Rounding is counted against the certificate.
"""

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.qp.layout import Vector
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
