r"""Certificates that a program has no solution, or none near, verified in floating point.

**Infeasible.** Multipliers y and :math:`z \ge 0` of the rows bound every feasible x, by Farkas'
lemma: with :math:`w = A^T y + G^T z`

.. math::

    \sum_i \min(w_i\,lb_i,\; w_i\,ub_i) \le w^T x \le b^T y + h^T z .

Where the left side is above the right one, no x is feasible. An entry of w without the bound that
it needs is a residual r, and then every feasible x has :math:`\|x\|_\infty` of at least the
difference over :math:`\|r\|_1`.

**Unbounded.** A direction d with :math:`Sd = 0`, S the symmetric part of P, :math:`Ad = 0`,
:math:`Gd \le 0`, d not towards a finite bound, and :math:`q^T d < 0`: from any feasible point the
cost falls along it for ever. With the residuals as they are, every KKT point has an entry of at
least :math:`-q^T d` over the sum of their absolute values.

So a certificate has a radius, within which there is no solution. A radius of at least `RADIUS` is
worth saying, whatever the tolerance of the solver; an infinite one proves that there is none.
A product of a row and a vector is rounded once (T. J. Dekker, "A floating-point technique for
extending the available precision", Numer. Math. 18, 1971), so that a residual that is zero is zero;
rounding, underflow included, is counted against the certificate throughout.
"""

from collections.abc import Callable
from operator import itemgetter

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.qp.layout import Matrix, QPViews, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Status

RADIUS = 1e8
"""Radius from which on a certificate is claimed."""

_INFEASIBLE = (Status.NONE_FEASIBLE_NEAR, Status.PRIMAL_INFEASIBLE)
_UNBOUNDED = (Status.NONE_OPTIMAL_NEAR, Status.UNBOUNDED)

_EPS = 2.0**-52
_TINY = 2.0**-900
"""Bound on the underflow of a term."""
_SLIGHT = 1e-5
"""Fraction of the largest entry below which a row takes no part in a polish."""
_WHOLE = 60.0
"""Least entry of a vector in whole numbers: 1 to 6 and their like divide it."""
_UNDERFLOW = 1e-270
"""Absolute term of a product below which digits may be lost to underflow."""
_SPLIT = 2.0**27 + 1.0
"""Factor that splits a number into two halves of its digits."""


def find_certificate(qp: QP, point: Vector) -> tuple[Status, Vector | None]:
    """Search for a certificate that there is no solution near, at a point that has diverged.

    The multipliers of such a point approach Farkas multipliers, or x a direction of recession. What
    they lack is removed by least squares on the rows that take part, and by rounding to whole
    numbers, which is exact where the entries have simple ratios.

    Args:
        qp: The program.
        point: ``[x | y | z | z_box]``, (2 n + m + p,).

    Returns:
        ``PRIMAL_INFEASIBLE`` or ``NONE_FEASIBLE_NEAR`` with multipliers ``[y | z | z_box]`` of size
        p + m + n, or ``UNBOUNDED`` or ``NONE_OPTIMAL_NEAR`` with a direction (n,);
        ``NOT_CONVERGED`` where no proof was found.
    """
    n, m, p = qp.sizes
    views = qp.views  # once: each field of a program is made where it is asked for
    limited = np.isfinite(np.concatenate([views.b, views.h]))
    multipliers = _scaled(np.where(limited, point[n : n + p + m], 0.0))
    radius, vector = _best(views, multipliers, _polished_multipliers, infeasibility_radius)
    if radius >= RADIUS:
        w = np.vstack([views.A, views.G]).T @ vector
        box = np.where(_is_carried(views, w), 0.0 - w, 0.0)
        return _status(radius, *_INFEASIBLE), np.concatenate([vector, box])
    direction = _scaled(point[:n])
    direction = np.where(_towards_bound(views, direction), 0.0, direction)
    radius, vector = _best(views, direction, _polished_direction, unboundedness_radius)
    return _status(radius, *_UNBOUNDED), vector if radius >= RADIUS else None


def _best(
    qp: QPViews,
    vector: Vector,
    polish: Callable[[QPViews, Vector], Vector],
    radius: Callable[[QPViews, Vector], float],
) -> tuple[float, Vector]:
    """Return the largest radius of a vector, polished or not, and the vector that has it.

    Three vectors are tried: the given one, the polished one, and that in whole numbers. If the
    radius of the first is infinite, the others are not computed.
    """
    judged = [(radius(qp, vector), vector)]
    if judged[0][0] < np.inf:
        polished = polish(qp, vector)
        judged += [(radius(qp, each), each) for each in (polished, _whole(polished))]
    return max(judged, key=itemgetter(0))


def _status(radius: float, near: Status, outright: Status) -> Status:
    """Return `outright` for an infinite radius, `near` from `RADIUS` on, else NOT_CONVERGED."""
    if radius < RADIUS:
        return Status.NOT_CONVERGED
    return outright if radius == np.inf else near


def certified(qp: QP, certificate: Vector) -> Status:
    """Judge a certificate, ``[y | z | z_box]`` of size p + m + n or a direction (n,).

    Returns:
        One of the statuses of `find_certificate`; ``NOT_CONVERGED`` if it proves nothing.

    Raises:
        InvalidInputError: It has another size.
    """
    n, m, p = qp.sizes
    if certificate.shape == (n,):
        return _status(unboundedness_radius(qp.views, certificate), *_UNBOUNDED)
    check_size("certificate", certificate, n + m + p)
    return _status(infeasibility_radius(qp.views, certificate[: p + m]), *_INFEASIBLE)


def infeasibility_radius(qp: QPViews, multipliers: Vector) -> float:
    """Compute the radius within which no x is feasible, as multipliers of the rows prove.

    Args:
        qp: The program.
        multipliers: Multipliers ``[y | z]``, (p + m,).

    Returns:
        A bound on the largest entry of any feasible x; inf if none is feasible, 0 if nothing is
        proven.
    """
    p = qp.b.size
    limits = np.concatenate([qp.b, qp.h])
    used = multipliers != 0.0
    finite = np.isfinite(multipliers).all() and np.isfinite(limits[used]).all()
    if not finite or (multipliers[p:] < 0.0).any():
        return 0.0
    w, rounding = products(np.vstack([qp.A, qp.G]).T, multipliers)
    carried = _is_carried(qp, w)
    taking_part = carried & (w != 0.0)
    bounds = np.where(w > 0.0, qp.lb, qp.ub)[taking_part]
    reach = np.maximum(np.abs(qp.lb), np.abs(qp.ub))
    both = reach < np.inf
    factors = np.concatenate([limits[used], -bounds, reach[both]])
    weights = np.concatenate([multipliers[used], w[taking_part], rounding[both]])
    residual = np.where(carried, 0.0, np.abs(w)).sum() + rounding[~both].sum()
    return _radius(factors, weights, float(residual))


@np.errstate(over="ignore", invalid="ignore")
def unboundedness_radius(qp: QPViews, direction: Vector) -> float:
    """Compute the radius within which there is no KKT point, as the direction (n,) proves.

    Returns:
        A bound on the largest entry of x and of the multipliers of any KKT point; inf if there is
        none, 0 if nothing is proven.
    """
    if not np.isfinite(direction).all():
        return 0.0
    # Twice the symmetric part: of the smallest numbers halves would be rounded.
    curved, of_cost = products(np.hstack([qp.P, qp.P.T]), np.tile(direction, 2))
    along, of_rows = products(np.vstack([qp.A, qp.G[np.isfinite(qp.h)]]), direction)
    # Below zero, an inequality's row is no residual.
    along[: qp.b.size] = np.abs(along[: qp.b.size])
    wrong = 0.5 * (np.abs(curved) + of_cost).sum() + np.maximum(along + of_rows, 0.0).sum()
    outside = np.abs(direction[_towards_bound(qp, direction)]).sum()
    return _radius(qp.q, direction, float(wrong + outside))


def _radius(factors: Vector, weights: Vector, residual: float) -> float:
    """Divide minus the product of factors and weights (k,), less its rounding, by a residual.

    Returns:
        The radius: inf if the residual is 0; 0 if the product is not below 0 for certain.
    """
    total, rounding = products(factors[np.newaxis], weights)
    value = -float(total[0] + rounding[0])
    if not value > 0.0:
        return 0.0
    return value / residual if residual != 0.0 else np.inf


def products(rows: Matrix, vector: Vector) -> tuple[Vector, Vector]:
    """Compute the product of rows (k, n) and a vector (n,), and bound its rounding, (k,) each."""
    products = np.empty(len(rows))
    rounding = np.empty(len(rows))
    dot_twice(np.ascontiguousarray(rows), vector, products, rounding)
    return products, rounding


@compiled
def dot_twice(rows: Matrix, vector: Vector, products: Vector, rounding: Vector) -> None:
    """Write the product of rows (k, n) and a vector (n,) in twice the precision, (k,).

    `rounding` (k,) becomes a bound on the error: 0 where no digit was lost, NaN where a term
    overflows.
    """
    for j in range(rows.shape[0]):
        total = 0.0
        lost = 0.0
        loss = 0.0
        for i in range(rows.shape[1]):
            a = rows[j, i]
            b = vector[i]
            term = a * b
            a_high = _SPLIT * a - (_SPLIT * a - a)
            b_high = _SPLIT * b - (_SPLIT * b - b)
            rest = (term - a_high * b_high) - (a - a_high) * b_high - a_high * (b - b_high)
            rest = (a - a_high) * (b - b_high) - rest
            added = (total + term) - total
            rest += (total - ((total + term) - added)) + (term - added)
            total += term
            lost += rest
            loss += abs(rest)
            if abs(term) < _UNDERFLOW and a != 0.0 and b != 0.0:
                loss += _TINY
        products[j] = total + lost
        bound = _EPS * (abs(products[j]) + 2.0 * rows.shape[1] * loss)
        rounding[j] = bound if loss != 0.0 else 0.0


def _is_carried(qp: QPViews, w: Vector) -> NDArray[np.bool_]:
    """Mark entries of w (n,) that are 0, above 0 with a lower bound, or below with an upper one."""
    return np.asarray(np.where(w > 0.0, qp.lb > -np.inf, qp.ub < np.inf) | (w == 0.0))


def _towards_bound(qp: QPViews, vector: Vector) -> NDArray[np.bool_]:
    """Mark the entries of a direction (n,) that point towards a finite bound, (n,)."""
    return np.where(vector > 0.0, qp.ub < np.inf, (vector < 0.0) & (qp.lb > -np.inf))


def _scaled(vector: Vector) -> Vector:
    """Divide a vector by its largest absolute entry."""
    return vector / max(float(np.abs(vector).max(initial=0.0)), _EPS)


def _whole(vector: Vector) -> Vector:
    """Scale a vector and round it to whole numbers, of which the least that counts is `_WHOLE`."""
    sizes = np.abs(vector)
    least = sizes.min(where=sizes > _SLIGHT * sizes.max(initial=0.0), initial=np.inf)
    return np.asarray(np.round(_WHOLE / least * vector))


def _polished_multipliers(qp: QPViews, multipliers: Vector) -> Vector:
    """Find the nearest multipliers on the same rows whose residual is zero to rounding."""
    used = np.abs(multipliers) > _SLIGHT
    polished = np.where(used, multipliers, 0.0)
    w = np.vstack([qp.A, qp.G]).T @ polished
    # A bound that takes part carries whatever the rows leave over; the others carry nothing.
    left = ~(_is_carried(qp, w) & (np.abs(w) > _SLIGHT))
    rows = np.vstack([qp.A, qp.G])[used]
    polished[used] = _on_null_space(rows[:, left].T, polished[used])
    polished[qp.b.size :] = np.maximum(polished[qp.b.size :], 0.0)
    return polished


def _polished_direction(qp: QPViews, direction: Vector) -> Vector:
    """Project a direction (n,) on the null space of P, A and the rows of G that it does not lower.

    Its entries that are nearly zero become zero.
    """
    moves = np.abs(direction) > _SLIGHT
    polished = np.where(moves, direction, 0.0)
    falls = qp.G @ polished < -_SLIGHT * np.abs(qp.G).sum(axis=1)
    rows = np.vstack([0.5 * qp.P + 0.5 * qp.P.T, qp.A, qp.G[~falls & np.isfinite(qp.h)]])[:, moves]
    polished[moves] = _on_null_space(rows, polished[moves])
    return polished


def _on_null_space(rows: Matrix, vector: Vector) -> Vector:
    """Project `vector` on the null space of `rows`, twice for the sake of rounding."""
    sizes = np.abs(rows).max(axis=1, initial=0.0)
    rows = rows[sizes > 0.0] / sizes[sizes > 0.0, np.newaxis]
    for _ in range(2 if rows.size else 0):
        vector = vector - np.linalg.lstsq(rows, rows @ vector, rcond=1e-10)[0]
    return vector
