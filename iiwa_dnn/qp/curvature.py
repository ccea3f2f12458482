r"""Rigorous lower bounds on the curvature of a program's cost; compiled.

A cost that is strongly convex along all steps that keep A x = b has a :math:`\sigma > 0` with

.. math::

    d^T P d \ge \sigma \|d\|^2 \quad \text{for all } d \text{ with } A d = 0 .

It is shown by Gershgorin's circles, or by a Cholesky factor of
:math:`P + \varrho A^T A - s I`: where it runs to its end in floating point, no eigenvalue of that
matrix is below minus the rounding of its trace (S. M. Rump, "Verification of positive
definiteness", BIT Numerical Mathematics 46, 2006).
"""

import numpy as np

from iiwa_dnn.qp.dense import cholesky_factor
from iiwa_dnn.qp.enclosure import TINY, unit_of
from iiwa_dnn.qp.layout import Matrix, QPViews, compiled

UNKNOWN = -1.0
"""Curvature of a cost that is not shown to be convex."""

_TRIALS = 12
_FINER = 0.03
"""Shifts that are tried at most, from half the smallest diagonal entry on, and their ratio."""


@compiled
def least_curvature(qp: QPViews, S: Matrix, strongly: bool) -> float:
    """Bound the curvature of the cost along the steps that keep the equality rows.

    Args:
        qp: The program.
        S: Symmetric part of P, (n, n).
        strongly: Whether it is worth some work to find more than that P is semidefinite.

    Returns:
        sigma > 0; 0 if it is only shown that P is positive semidefinite; `UNKNOWN` if not even
        that is.
    """
    unit = unit_of(qp)
    simple = _gershgorin(S, unit)
    if simple > 0.0 or (simple == 0.0 and not strongly):
        return simple
    trace = 0.0
    for i in range(S.shape[0]):
        trace += S[i, i]
    M = np.empty((qp.q.size, qp.q.size))
    own = _shown(qp, S, 0.0, 0.0, M)
    if own > 0.0:
        return own
    squares = 0.0
    for j in range(qp.b.size):
        for i in range(qp.q.size):
            squares += qp.A[j, i] * qp.A[j, i]
    if squares > 0.0:
        with_rows = _shown(qp, S, trace / squares, 0.0, M)
        if with_rows > 0.0:
            return with_rows
    # A variable without cost does no harm to semidefiniteness.
    if simple == 0.0 or _shown(qp, S, 0.0, trace, M) > 0.0:
        return 0.0
    return UNKNOWN


@compiled
def _gershgorin(S: Matrix, unit: float) -> float:
    """Bound the smallest eigenvalue of S (n, n), exactly zero if an empty row makes it so."""
    least = np.inf
    for i in range(S.shape[0]):
        beside = 0.0
        for k in range(S.shape[0]):
            if k != i:
                beside += abs(S[i, k])
        circle = (1.0 - unit) * (S[i, i] - (1.0 + unit) * beside)
        if beside > 0.0:
            circle -= TINY
        if not circle > -np.inf:
            return UNKNOWN
        least = min(least, circle)
    return least


@compiled
def _shown(qp: QPViews, S: Matrix, weight: float, filling: float, M: Matrix) -> float:
    """Bound the smallest eigenvalue of S + weight A^T A from below, or return `UNKNOWN`.

    Args:
        qp: The program.
        S: Symmetric part of P, (n, n).
        weight: Weight of the equality rows.
        filling: Diagonal entry of a variable without cost.
        M: Scratch, (n, n).
    """
    unit = unit_of(qp)
    loss = 2.0 * unit * _size_of(qp, S, weight, filling) + TINY
    shift: float = np.inf
    for i in range(S.shape[0]):
        shift = min(shift, 0.5 * _entry(qp, S, weight, filling, i, i))
    for _ in range(_TRIALS):
        # The last one is as small as rounding lets it be.
        shift = max(shift, 2.0 * loss)
        for i in range(S.shape[0]):
            for k in range(i + 1):
                M[i, k] = _entry(qp, S, weight, filling, i, k)
            M[i, i] -= shift
        if cholesky_factor(M):
            return (1.0 - unit) * (shift - loss)
        if not shift > 2.0 * loss:
            break
        shift *= _FINER
    return UNKNOWN


@compiled
def _entry(qp: QPViews, S: Matrix, weight: float, filling: float, i: int, k: int) -> float:
    """Compute entry (i, k) of S + weight A^T A, S being (n, n) and empty rows being filled."""
    value: float = S[i, k]
    if weight > 0.0:
        for j in range(qp.b.size):
            value += weight * qp.A[j, i] * qp.A[j, k]
    if i == k and filling > 0.0:
        largest = 0.0
        for b in range(S.shape[0]):
            largest = max(largest, abs(S[i, b]))
        if largest == 0.0:
            value = filling
    return value


@compiled
def _size_of(qp: QPViews, S: Matrix, weight: float, filling: float) -> float:
    """Add up the absolute values of all terms of S + weight A^T A, S being (n, n)."""
    total = 0.0
    for i in range(S.shape[0]):
        total += filling
        for k in range(S.shape[0]):
            total += abs(S[i, k])
    for j in range(qp.b.size):
        line = 0.0
        for i in range(S.shape[0]):
            line += abs(qp.A[j, i])
        total += weight * line * line
    return total
