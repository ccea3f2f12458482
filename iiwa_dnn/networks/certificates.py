r"""Proofs that a program has no solution: found along the way a network runs off, then verified.

**Infeasible.** Multipliers :math:`(y, z, z_{box})` with :math:`z \ge 0`, and :math:`z_{box}`
positive only at a finite ub and negative only at a finite lb, prove it by Farkas' lemma where

.. math::

    r := A^T y + G^T z + z_{box} = 0, \qquad
    v := b^T y + h^T z + ub^T [z_{box}]_+ - lb^T [-z_{box}]_+ < 0 ,

since a feasible x would have :math:`0 = r^T x \le v < 0`.

**Unbounded.** A direction d with :math:`Pd = 0`, :math:`Ad = 0`, :math:`Gd \le 0`, d not towards a
finite bound, and :math:`q^T d < 0`: from any feasible point the cost falls along it for ever.

**In floating point** no residual is exactly zero, so what is computed, and what "verified" means
here, is a radius. With r as it is, every feasible x has :math:`\|x\|_\infty \ge -v/\|r\|_1`. With
the direction's residuals as they are, every KKT point has an entry of at least :math:`-q^T d` over
the sum of their absolute values. Rounding is counted against the certificate. One is claimed only
where the radius is at least `RADIUS`: then no solution with entries below it exists, whatever the
tolerance of the solver.

**Where they come from.** On an infeasible program the multipliers of the projection network grow
for ever, on an unbounded one x does, and the difference of two long implicit steps tends to the
direction of that growth: for the plain saddle-point flow this is the minimal displacement of a
nonexpansive map, as in G. Banjac, P. Goulart, B. Stellato, S. Boyd, "Infeasibility detection in the
alternating direction method of multipliers for convex optimization", J. Optim. Theory Appl. 183
(2019). Least squares on the rows that take part then takes out what is left of the residuals.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from iiwa_dnn import kernels
from iiwa_dnn.qp.program import QP, Matrix, Status, Vector

RADIUS = 1e8
"""A certificate is claimed only if no solution has all entries below this."""

ROUNDS = 3
"""How often the growth is looked at before it is given up."""

_EPS = float(np.finfo(float).eps)
_LONG = 1e6
# Shares of the largest entry below which a row takes no part: how well a growth is known depends
# on how fast it is beside what has grown before.
_SHARES = (1e-8, 1e-6, 1e-4, 1e-2)


class Certificate(NamedTuple):
    """A verified proof that a program has no solution.

    Attributes:
        status: ``PRIMAL_INFEASIBLE`` or ``UNBOUNDED``.
        vector: ``[y | z | z_box]`` of size p + m + n, or the direction, (n,).
    """

    status: Status
    vector: Vector


def infeasibility_radius(qp: QP, vector: Vector) -> float:
    """The radius below which no x is feasible, as the multipliers ``[y | z | z_box]`` prove.

    Args:
        qp: The program.
        vector: Multipliers, of size p + m + n.

    Returns:
        A bound on the largest entry of any feasible x; inf where the residual is exactly zero, and
        0 where nothing is proven.
    """
    _, m, p = qp.sizes
    y, z, z_box = vector[:p], vector[p : p + m], vector[p + m :]
    upper, lower = np.maximum(z_box, 0.0), np.maximum(-z_box, 0.0)
    inside = np.concatenate([z, upper, lower])
    limits = np.concatenate([qp.h, qp.ub, -qp.lb])
    used = inside != 0.0
    if not np.isfinite(vector).all() or (z < 0.0).any() or not np.isfinite(limits[used]).all():
        return 0.0
    residual = qp.A.T @ y + qp.G.T @ z + z_box
    size = np.abs(qp.A.T) @ np.abs(y) + np.abs(qp.G.T) @ z + np.abs(z_box)
    terms = np.concatenate([qp.b * y, limits[used] * inside[used]])
    return _radius(terms, float((np.abs(residual) + _rounding(m + p + 1) * size).sum()))


def unboundedness_radius(qp: QP, direction: Vector) -> float:
    """The radius within which there is no KKT point, as the direction proves.

    Args:
        qp: The program.
        direction: Direction of recession, (n,).

    Returns:
        A bound on the largest entry of x and of the multipliers of any KKT point; inf where the
        residuals are exactly zero, and 0 where nothing is proven.
    """
    n = qp.sizes[0]
    if not np.isfinite(direction).all():
        return 0.0
    limited = np.isfinite(qp.h)
    rows = np.vstack([qp.P, qp.A, qp.G[limited]])
    values = rows @ direction
    falling = n + qp.b.size  # below zero, an inequality's row is no residual
    error = _rounding(n) * (np.abs(rows) @ np.abs(direction))
    wrong = np.abs(values)
    wrong[falling:] = values[falling:]
    outside = direction[(qp.ub < np.inf) & (direction > 0.0)].sum()
    outside -= direction[(qp.lb > -np.inf) & (direction < 0.0)].sum()
    return _radius(qp.q * direction, float(np.maximum(wrong + error, 0.0).sum() + outside))


def find_certificate(qp: QP, point: Vector) -> Certificate | None:
    """Follow the network from where it was given up, and prove that there is no solution.

    Takes at most `ROUNDS` + 1 implicit steps, of at most 100 linear systems each, and after each
    but the first ten small least-squares problems.

    Args:
        qp: The program.
        point: ``[x | y | z | z_box]``, where the network was given up.

    Returns:
        A verified certificate; None where none was found, which proves nothing.
    """
    n, m, p = qp.sizes
    z_box = point[-n:]
    state = np.concatenate([point[:-n], np.maximum(z_box, 0.0), np.maximum(-z_box, 0.0)])
    before, after = np.empty(point.size), np.empty(point.size)
    for count in range(ROUNDS + 1):
        if kernels.advance_implicit(qp.data, n, m, p, state, _LONG, 1, 1e-9) < 0:
            break
        before, after = after, before
        kernels.kkt_point(qp.data, n, m, p, state, after)
        if not np.isfinite(after).all():
            break
        if count:
            growth = after - before
            for part in (growth[:n], growth[n:]):
                part /= max(np.abs(part).max(), np.finfo(float).tiny)
            if (certificate := _verified(qp, growth)) is not None:
                return certificate
            if count == ROUNDS:
                return _verified(qp, _nearest(qp, growth))
    return None


def _verified(qp: QP, growth: Vector) -> Certificate | None:
    """The certificate that a growth of ``[x | y | z | z_box]`` leads to, if it can be verified."""
    n = qp.sizes[0]
    multipliers = [growth[n:], *(_polished_multipliers(qp, growth[n:], s) for s in _SHARES)]
    radius, best = max((infeasibility_radius(qp, c), i) for i, c in enumerate(multipliers))
    if radius >= RADIUS:
        return Certificate(Status.PRIMAL_INFEASIBLE, multipliers[best])
    directions = [growth[:n], *(_polished_direction(qp, growth[:n], s) for s in _SHARES)]
    radius, best = max((unboundedness_radius(qp, c), i) for i, c in enumerate(directions))
    return Certificate(Status.UNBOUNDED, directions[best]) if radius >= RADIUS else None


def _nearest(qp: QP, growth: Vector) -> Vector:
    """The nearest direction and the nearest multipliers that have a certificate's signs and zeros.

    Both are strictly convex programs, which the network settles. The growth may not be there yet:
    a row takes no part in it as long as its slack is not used up, which can take very long.
    """
    n, m, p = qp.sizes
    upper, lower = qp.ub < np.inf, qp.lb > -np.inf
    limited = np.isfinite(qp.h)
    zeros = _unit_rows(np.vstack([qp.P, qp.A]))
    direction = QP(
        np.eye(n), -growth[:n], _unit_rows(qp.G[limited]), np.zeros(int(limited.sum())),
        zeros, np.zeros(zeros.shape[0]),
        np.where(lower, 0.0, -np.inf), np.where(upper, 0.0, np.inf),
    )  # fmt: skip
    rows = np.hstack([qp.A.T, qp.G.T, np.eye(n)])
    most = np.where(np.concatenate([np.ones(p, bool), limited, upper]), np.inf, 0.0)
    least = np.where(np.concatenate([np.ones(p, bool), np.zeros(m, bool), lower]), -np.inf, 0.0)
    size = p + m + n
    zeros = _unit_rows(rows)
    multipliers = QP(
        np.eye(size), -growth[n:], A=zeros, b=np.zeros(zeros.shape[0]), lb=least, ub=most
    )
    return np.concatenate([_settled(direction), _settled(multipliers)])


def _settled(qp: QP) -> Vector:
    """X of a program that has a solution, with the default integrator's settings."""
    n, m, p = qp.sizes
    state, point = np.zeros(3 * n + m + p), np.empty(2 * n + m + p)
    kernels.settle_implicit(qp.data, n, m, p, state, point, 1e-10, 1000, 1e7)
    return point[:n]


def _polished_multipliers(qp: QP, vector: Vector, share: float) -> Vector:
    """The nearest multipliers on the same rows whose residual is zero to rounding."""
    _, m, p = qp.sizes
    rows = np.vstack([qp.A, qp.G])
    weights = vector[: p + m].copy()
    takes_part = np.abs(weights) > share
    takes_part[p:] &= (weights[p:] > 0.0) & np.isfinite(qp.h)
    weights[~takes_part] = 0.0
    bounds = vector[p + m :]
    # A bound that takes part carries whatever the rows leave over; the others carry nothing.
    carries = ((bounds > share) & (qp.ub < np.inf)) | ((bounds < -share) & (qp.lb > -np.inf))
    weights[takes_part] = _on_null_space(rows[takes_part][:, ~carries].T, weights[takes_part])
    weights[p:] = np.maximum(weights[p:], 0.0)
    box = np.where(carries, -(rows.T @ weights), 0.0)
    kept = ((box > 0.0) & (qp.ub < np.inf)) | ((box < 0.0) & (qp.lb > -np.inf))
    return np.concatenate([weights, np.where(kept, box, 0.0)])


def _polished_direction(qp: QP, direction: Vector, share: float) -> Vector:
    """The nearest direction, along the same rows, whose residuals are zero to rounding."""
    moves = np.abs(direction) > share
    moves &= ~((direction > 0.0) & (qp.ub < np.inf)) & ~((direction < 0.0) & (qp.lb > -np.inf))
    polished = np.where(moves, direction, 0.0)
    falls = qp.G @ polished < -share * np.abs(qp.G).sum(axis=1)
    rows = np.vstack([qp.P, qp.A, qp.G[~falls & np.isfinite(qp.h)]])[:, moves]
    polished[moves] = _on_null_space(rows, polished[moves])
    return polished


def _on_null_space(rows: Matrix, vector: Vector) -> Vector:
    """The projection of `vector` on the null space of `rows`, twice for the sake of rounding."""
    rows = _unit_rows(rows)
    if not rows.size:
        return vector
    for _ in range(2):
        vector = vector - np.linalg.lstsq(rows, rows @ vector, rcond=1e-10)[0]
    return vector


def _unit_rows(rows: Matrix) -> Matrix:
    """The rows that are not zero, each divided by its largest entry."""
    sizes = np.abs(rows).max(axis=1, initial=0.0)
    scaled: Matrix = rows[sizes > 0.0] / sizes[sizes > 0.0, None]
    return scaled


def _rounding(terms: int) -> float:
    """Relative error of a sum of that many products."""
    return (terms + 2) * _EPS


def _radius(terms: Vector, residual: float) -> float:
    """How far the certificate reaches: its value, against its residual; 0 if it has none."""
    value = -float(terms.sum() + _rounding(terms.size) * np.abs(terms).sum())
    if not value > 0.0:
        return 0.0
    return value / residual if residual > 0.0 else np.inf
