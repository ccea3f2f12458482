"""Many small programs at once, over all cores: a compiled loop around the implicit integrator.

A module of its own, since a loop over threads takes long to compile.
"""

from __future__ import annotations

import numpy as np
from numba import njit, prange

from iiwa_dnn.kernels.implicit import settle_implicit
from iiwa_dnn.kernels.layout import offsets
from iiwa_dnn.kernels.linear_step import cholesky_factor

CHUNK = 128
"""Programs that one thread solves before it takes the next ones."""

SOUND, NOT_FINITE, ASYMMETRIC, INDEFINITE, CROSSED = 0, 1, 2, 3, 4
"""What can be wrong with a program, as `QP.check_values` sees it."""


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _all_finite(data, begin, end):
    """Whether no entry from `begin` up to `end` is infinite or NaN."""
    bad = False
    for i in range(np.uint64(begin), np.uint64(end)):
        bad |= data[i] - data[i] != 0.0
    return not bad


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _not_finite(data, n, m, p):
    """Index of the first argument of P q G h A b lb ub with a value it may not have, or -1."""
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    if not _all_finite(data, 0, at_q):
        return 0
    if not _all_finite(data, at_q, at_G):
        return 1
    if not _all_finite(data, at_G, at_G + m * n):
        return 2
    if not _all_finite(data, at_A, at_lb - p):
        return 4
    if not _all_finite(data, at_lb - p, at_lb):
        return 5
    for j in range(at_G + m * n, at_A):
        if not data[j] > -np.inf:
            return 3
    for i in range(at_lb, at_lb + n):
        if not data[i] < np.inf:
            return 6
        if not data[i + n] > -np.inf:
            return 7
    return -1


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _fault_of_cost(data, n, K):
    """What is wrong with P, which is finite."""
    scale = 0.0
    for i in range(n * n):
        scale = max(scale, abs(data[i]))
    for i in range(n):
        for k in range(i):
            if abs(data[i * n + k] - data[k * n + i]) > 1e-10 * scale:
                return ASYMMETRIC
    # Positive semidefinite to 1e-10 of its scale: P plus that much of the identity has a factor.
    for i in range(n * n):
        K[i] = data[i]
    for i in range(n):
        K[i * n + i] += 1e-10 * scale
    return SOUND if scale == 0.0 or cholesky_factor(K, n) else INDEFINITE


@njit(cache=True, parallel=True, error_model="numpy", fastmath={"contract"})
def settle_batch(
    P, q, G, h, A, b, lb, ub, n, m, p, tol, max_systems, long_step,
    points, residuals, iterations, faults,
):  # fmt: skip
    """Settle one program for each row of `points`, each from a cold start.

    An input has one row, which all programs share, or one for each program.
    """
    count = points.shape[0]
    parts = n * n + n + m * n + m + p * n + p + 2 * n
    for chunk in prange((count + CHUNK - 1) // CHUNK):
        data, K = np.full(parts, np.nan), np.empty(n * n)
        state = np.empty(3 * n + m + p)
        for row in range(chunk * CHUNK, min((chunk + 1) * CHUNK, count)):
            source = row if P.shape[0] > 1 else 0
            fresh = False
            for i in range(n * n):
                fresh |= data[i] != P[source, i]
                data[i] = P[source, i]
            at = n * n
            for part in (q, G, h, A, b, lb, ub):
                source = row if part.shape[0] > 1 else 0
                for i in range(part.shape[1]):
                    data[at + i] = part[source, i]
                at += part.shape[1]
            argument, kind = _not_finite(data, n, m, p), SOUND
            if argument >= 0:
                kind = NOT_FINITE
            elif fresh:
                argument, kind = 0, _fault_of_cost(data, n, K)
            for i in range(parts - 2 * n, parts - n):
                if kind == SOUND and data[i] > data[i + n]:
                    argument, kind = 6, CROSSED
            faults[row, 0], faults[row, 1] = kind, argument
            if kind != SOUND:
                data[0] = np.nan  # the next one is looked at anew
                continue
            state[:] = 0.0
            systems, _, primal, dual, gap = settle_implicit(
                data, n, m, p, state, points[row], tol, max_systems, long_step
            )
            iterations[row] = systems
            residuals[row, 0], residuals[row, 1], residuals[row, 2] = primal, dual, gap
