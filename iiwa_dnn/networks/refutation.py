r"""Search for evidence that a program has no solution, along the way the network diverges.

On an infeasible program the multipliers of the projection network grow for ever, on an unbounded
one x does, and the difference of two long implicit steps tends to the direction of that growth: for
the plain saddle-point flow this is the minimal displacement of a nonexpansive map, as in
G. Banjac, P. Goulart, B. Stellato, S. Boyd, "Infeasibility detection in the alternating direction
method of multipliers for convex optimization", J. Optim. Theory Appl. 183 (2019). Least squares on
the rows that take part then takes out the rest of the residuals, and `iiwa_dnn.qp.certificates`
verifies the result.
"""

import numpy as np

from iiwa_dnn.networks.integrators.implicit import advance_implicit
from iiwa_dnn.qp.certificates import (
    RADIUS,
    infeasibility_radius,
    proves_infeasible,
    proves_unbounded,
    towards_bound,
    unboundedness_radius,
)
from iiwa_dnn.qp.layout import Matrix, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import point_of_state
from iiwa_dnn.qp.solution import Status

ROUNDS = 3
"""Implicit steps whose growth is looked at before the search is given up."""

_LONG = 1e6
_SLIGHT = 1e-4
"""Fraction of the largest entry below which a row takes no part."""


def find_certificate(qp: QP, point: Vector) -> tuple[Status, Vector] | None:
    """Follow the network from where it was given up, and prove that there is no solution near.

    Takes at most `ROUNDS` + 1 implicit steps, of at most 100 linear systems each, and after each
    but the first at most four small least-squares problems.

    Args:
        qp: The program.
        point: ``[x | y | z | z_box]`` where the network was given up.

    Returns:
        ``PRIMAL_INFEASIBLE`` or ``NONE_FEASIBLE_NEAR`` with multipliers ``[y | z | z_box]`` of size
        p + m + n, or ``UNBOUNDED`` or ``NONE_OPTIMAL_NEAR`` with a direction (n,), verified; None
        where none was found, which proves nothing.
    """
    n, m, p = qp.sizes
    check_size("point", point, 2 * n + m + p)
    z_box = point[-n:]
    state = np.concatenate([point[:-n], np.maximum(z_box, 0.0), np.maximum(-z_box, 0.0)])
    before = np.empty(point.size)
    after = np.empty(point.size)
    for count in range(ROUNDS + 1):
        if advance_implicit(qp.data, n, m, p, state, _LONG, 1, 1e-9) < 0:
            break
        before, after = after, before
        point_of_state(qp.data, n, m, p, state, after)
        if not np.isfinite(after).all():
            break
        if count:
            growth = after - before
            for part in (growth[:n], growth[n:]):
                part /= max(np.abs(part).max(), np.finfo(float).tiny)
            certificate = _verified(qp, growth)
            if certificate is not None:
                return certificate
    return None


def _verified(qp: QP, growth: Vector) -> tuple[Status, Vector] | None:
    """Polish a growth of ``[x | y | z | z_box]``; returns a certificate that can be verified."""
    n = qp.sizes[0]
    for multipliers in (growth[n:], _polished_multipliers(qp, growth[n:])):
        if infeasibility_radius(qp, multipliers) >= RADIUS:
            proven = proves_infeasible(qp, multipliers)
            return Status.PRIMAL_INFEASIBLE if proven else Status.NONE_FEASIBLE_NEAR, multipliers
    for direction in (growth[:n], _polished_direction(qp, growth[:n])):
        if unboundedness_radius(qp, direction) >= RADIUS:
            proven = proves_unbounded(qp, direction)
            return Status.UNBOUNDED if proven else Status.NONE_OPTIMAL_NEAR, direction
    return None


def _polished_multipliers(qp: QP, vector: Vector) -> Vector:
    """Find the nearest multipliers on the same rows whose residual is zero to rounding."""
    _, m, p = qp.sizes
    rows = np.vstack([qp.A, qp.G])
    weights = vector[: p + m].copy()
    bounds = vector[p + m :]
    takes_part = np.abs(weights) > _SLIGHT
    takes_part[p:] &= (weights[p:] > 0.0) & np.isfinite(qp.h)
    weights[~takes_part] = 0.0
    # A bound that takes part carries whatever the rows leave over; the others carry nothing.
    carries = (np.abs(bounds) > _SLIGHT) & towards_bound(qp, bounds)
    weights[takes_part] = _on_null_space(rows[takes_part][:, ~carries].T, weights[takes_part])
    weights[p:] = np.maximum(weights[p:], 0.0)
    box = np.where(carries, -(rows.T @ weights), 0.0)
    return np.concatenate([weights, np.where(towards_bound(qp, box), box, 0.0)])


def _polished_direction(qp: QP, direction: Vector) -> Vector:
    """Find the nearest direction, along the same rows, whose residuals are zero to rounding."""
    moves = (np.abs(direction) > _SLIGHT) & ~towards_bound(qp, direction)
    polished = np.where(moves, direction, 0.0)
    falls = qp.G @ polished < -_SLIGHT * np.abs(qp.G).sum(axis=1)
    rows = np.vstack([qp.P, qp.A, qp.G[~falls & np.isfinite(qp.h)]])[:, moves]
    polished[moves] = _on_null_space(rows, polished[moves])
    return polished


def _on_null_space(rows: Matrix, vector: Vector) -> Vector:
    """Project `vector` on the null space of `rows`, twice for the sake of rounding."""
    rows = _unit_rows(rows)
    if not rows.size:
        return vector
    for _ in range(2):
        vector = vector - np.linalg.lstsq(rows, rows @ vector, rcond=1e-10)[0]
    return vector


def _unit_rows(rows: Matrix) -> Matrix:
    """Return the rows that are not zero, each divided by its largest entry."""
    sizes = np.abs(rows).max(axis=1, initial=0.0)
    scaled: Matrix = rows[sizes > 0.0] / sizes[sizes > 0.0, None]
    return scaled
