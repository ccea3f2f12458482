r"""Rounding in the residuals of a point, and multipliers whose rounding leaves no duality gap.

The gap is a sum of terms that cancel. Where they are 1e7 times as large as the tolerance and more,
rounding of x and of the multipliers decides about it, and so does the order of the sum. With x
held, the gap changes by :math:`a_j^T x_F\,t` when the multiplier of row a_j grows by t, F being the
entries of x inside their bounds, and the dual residual by at most :math:`\max |a_j| |t|`: the
multiplier of the row where this is least for the gap takes it away, within the tolerance.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from iiwa_dnn.qp.layout import Triple, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import accurate_gap, kkt_point

TRIALS = 40
"""States of one search."""
SHARE = 0.5
"""Change of the dual residual by a random change of the multipliers, over the room for it."""


def worse(qp: QP, point: Vector, residuals: Triple) -> Triple:
    """Return the residuals of ``[x | y | z | z_box]``, or those of numpy's sums where larger.

    Sums in another order round otherwise, and a claim has to hold for all: to the dual residual,
    whose multipliers may be very large, its rounding is added.
    """
    n, m, p = qp.sizes
    P, q, G, h, A, b, lb, ub = qp.arrays()
    x, y, z, z_box = np.split(point, [n, n + p, n + p + m])
    Px = P @ x
    primal = max(np.abs(A @ x - b).max(initial=0.0), (G @ x - h).max(initial=0.0))
    sizes = np.abs(z_box) + np.abs(G).T @ np.abs(z) + np.abs(A).T @ np.abs(y)
    rounding = 0.25 * np.finfo(float).eps * sizes.max()
    dual = np.abs(Px + q + G.T @ z + A.T @ y + z_box).max() + rounding
    rows, low, high = np.isfinite(h), np.isfinite(lb), np.isfinite(ub)
    ends = lb[low] @ np.minimum(z_box, 0.0)[low], ub[high] @ np.maximum(z_box, 0.0)[high]
    # In qpsolvers' order.
    gap = x @ Px + q @ x + h[rows] @ z[rows] + b @ y + ends[0] + ends[1]
    first, second, third = np.maximum(residuals, (primal, dual, abs(gap))).tolist()
    return first, second, third


def closings(qp: QP, state: Vector, room: float) -> Iterator[Vector]:
    """Yield states near `state` (3n + m + p,) whose gap is zero but for rounding.

    The dual residual grows by less than `room`. From the second on, x moves by a rounding and all
    multipliers a little, each time in another direction, so that the sums round in another way.
    """
    n, m, p = qp.sizes
    point, rng, of_rows = np.empty(2 * n + m + p), np.random.default_rng(0), slice(n, n + p + m)
    kkt_point(qp.data, n, m, p, state, point)
    rows, x = np.vstack([qp.A, qp.G]), point[:n]
    movable = np.concatenate([np.ones(p), point[n + p : n + p + m] > 0.0])
    inside = (qp.lb < x) & (x < qp.ub)
    slopes = movable * (rows @ np.where(inside, x, 0.0))
    gains = np.abs(slopes) / np.maximum(np.abs(rows).max(axis=1, initial=0.0), 1e-300)
    if not gains.any():
        return
    row = int(np.argmax(gains))
    for trial in range(TRIALS):
        s = state.copy()
        if trial:
            change = movable * rng.uniform(-1.0, 1.0, p + m)
            s[of_rows] += SHARE * room / np.abs(rows.T @ change).max() * change
            s[:n] *= 1.0 + np.finfo(float).eps * inside * rng.integers(-1, 2, n)
        for _ in range(2):
            kkt_point(qp.data, n, m, p, s, point)
            s[n + row] -= accurate_gap(qp.data, n, m, p, point) / slopes[row]
        yield s
