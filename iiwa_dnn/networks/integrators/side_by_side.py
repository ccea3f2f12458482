"""First linearly implicit steps of many small programs side by side, compiled.

From rest, at x = 0 and without multipliers, a program that x = 0 satisfies has no active limit: the
first steps of the projection network are then those of its cost and its equalities alone
(`iiwa_dnn.networks.integrators.implicit_steps`), the same operations in every program of one shape.
Here each operation is done for `LANES` programs before the next, as vector instructions want it.
Where limits are in the way the result is not an equilibrium, and its residuals say so.

An array holds LANES values of each number: those of number i begin at i LANES.
"""

import numpy as np

from iiwa_dnn.qp.layout import Vector, compiled, offsets

LANES = 8
"""Programs side by side."""
ROUNDS = 2
"""Steps with one matrix; the second removes the rounding of the first."""


@compiled
def free_steps(data: Vector, n: int, m: int, p: int, step: float, x: Vector, y: Vector) -> None:
    """Take `ROUNDS` linearly implicit steps without limits from rest, of length `step` [rho].

    Args:
        data: `QP.data` of the programs, (size LANES,).
        n: Number of variables.
        m: Number of inequality rows.
        p: Number of equality rows.
        step: Length of a step, in units of rho.
        x: Primal points after the steps, (n LANES,); NaN where the matrix is not definite.
        y: Their multipliers of the equalities, (p LANES,).
    """
    at_q, _, at_A, at_lb = offsets(n, m, p)
    K, r, e = np.empty(n * n * LANES), np.empty(n * LANES), np.empty(p * LANES)
    _factor(data, n, p, at_A, step, K)
    for k in range(n * LANES):
        x[k] = 0.0
    for k in range(p * LANES):
        y[k] = 0.0
    for _ in range(ROUNDS):
        for k in range(n * LANES):
            r[k] = data[at_q * LANES + k]
        for i in range(n):
            for k in range(n):
                _add(r, i, 1.0, data, i * n + k, x, k)
        for j in range(p):
            row = at_A + j * n
            for k in range(LANES):
                e[j * LANES + k] = -step * data[(at_lb - p + j) * LANES + k]
            for i in range(n):
                _add(e, j, step, data, row + i, x, i)
            # y after the step for an x that stands still.
            for k in range(j * LANES, (j + 1) * LANES):
                y[k] += e[k]
            for i in range(n):
                _add(r, i, 1.0, data, row + i, y, j)
        _solve(K, n, r)
        for k in range(n * LANES):
            x[k] -= r[k]
        for j in range(p):
            for i in range(n):
                _add(y, j, -step, data, at_A + j * n + i, r, i)


@compiled
def _factor(data: Vector, n: int, p: int, at_A: int, step: float, K: Vector) -> None:
    """Write the Cholesky factor of P + I/step + step A^T A, its diagonal inverted, into K."""
    for i in range(n):
        for k in range(i + 1):
            for at in range((i * n + k) * LANES, (i * n + k + 1) * LANES):
                K[at] = data[at]
            for j in range(p):
                _add(K, i * n + k, step, data, at_A + j * n + i, data, at_A + j * n + k)
    for j in range(n):
        diagonal = j * n + j
        for k in range(j):
            _add(K, diagonal, -1.0, K, j * n + k, K, j * n + k)
        for k in range(diagonal * LANES, (diagonal + 1) * LANES):
            K[k] = 1.0 / np.sqrt(K[k] + 1.0 / step)
        for i in range(j + 1, n):
            for k in range(j):
                _add(K, i * n + j, -1.0, K, i * n + k, K, j * n + k)
            _multiply(K, i * n + j, K, diagonal)


@compiled
def _solve(K: Vector, n: int, r: Vector) -> None:
    """Solve with the factor in K, in place."""
    for i in range(n):
        for k in range(i):
            _add(r, i, -1.0, K, i * n + k, r, k)
        _multiply(r, i, K, i * n + i)
    for i in range(n - 1, -1, -1):
        _multiply(r, i, K, i * n + i)
        for k in range(i):
            _add(r, k, -1.0, K, i * n + k, r, i)


@compiled
def _add(out: Vector, o: int, factor: float, a: Vector, i: int, b: Vector, j: int) -> None:
    """Add factor a b to `out`, of the numbers i, j and o."""
    to, left, right = np.uint64(o * LANES), np.uint64(i * LANES), np.uint64(j * LANES)
    for k in range(np.uint64(LANES)):
        out[to + k] += factor * a[left + k] * b[right + k]


@compiled
def _multiply(out: Vector, o: int, a: Vector, i: int) -> None:
    """Multiply `out` by a, of the numbers i and o."""
    to, left = np.uint64(o * LANES), np.uint64(i * LANES)
    for k in range(np.uint64(LANES)):
        out[to + k] *= a[left + k]
