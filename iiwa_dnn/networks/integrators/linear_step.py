"""One linearly implicit step of the projection network, its multipliers eliminated."""

from __future__ import annotations

import numpy as np

from iiwa_dnn.qp.dense import cholesky_factor, factor_solve
from iiwa_dnn.qp.layout import ONE, Vector, compiled, offsets


@compiled
def condensed_matrix(
    data: Vector, n: int, m: int, p: int, step: float, active: Vector, K: Vector,
) -> None:  # fmt: skip
    """Write the lower half of P + I/step + step (A^T A + active rows^T active rows) into K (n n,).

    Equality rows go two at a time, which halves the passes over K; indices are unsigned, which
    saves numba the question whether they are negative.
    """
    _, at_G, at_A, _ = offsets(n, m, p)
    size, row = np.uint64(n), np.uint64(at_A)
    for i in range(size):
        for k in range(i + ONE):
            K[i * size + k] = data[i * size + k]
    for i in range(n):
        K[i * n + i] += 1.0 / step + step * (active[m + i] + active[m + n + i])
    for _ in range(p // 2):
        other = row + size
        for i in range(size):
            first, second = step * data[row + i], step * data[other + i]
            for k in range(i + ONE):
                K[i * size + k] += first * data[row + k] + second * data[other + k]
        row = other + size
    if p % 2:
        _add_row(data, row, step, size, K)
    for j in range(m):
        if active[j] != 0.0:
            _add_row(data, np.uint64(at_G + j * n), step, size, K)


@compiled
def _add_row(data: Vector, row: np.uint64, step: float, size: np.uint64, K: Vector) -> None:
    """Add step v v^T to the lower half of K, v being the row of `data` that begins there."""
    for i in range(size):
        scaled = step * data[row + i]
        for k in range(i + ONE):
            K[i * size + k] += scaled * data[row + k]


@compiled
def reduced_rates(
    data: Vector, n: int, m: int, p: int, rates: Vector, active: Vector, step: float,
    rhs: Vector, new: Vector,
) -> None:  # fmt: skip
    """Write a linearly implicit step's right-hand side, multipliers eliminated, into rhs (n,).

    With dx = 0 the multipliers would change by what new[n:] then holds.
    """
    _, at_G, at_A, _ = offsets(n, m, p)
    at_z, at_u = n + p, n + p + m
    decay = step / (1.0 + step)
    for j in range(p):
        new[n + j] = step * rates[n + j]
    for k in range(m + 2 * n):
        new[at_z + k] = rates[at_z + k] * (step if active[k] != 0.0 else decay)
    for i in range(n):
        value = rates[i] - new[at_u + i] + new[at_u + n + i]
        for j in range(p):
            value -= data[at_A + j * n + i] * new[n + j]
        for j in range(m):
            value -= data[at_G + j * n + i] * new[at_z + j]
        rhs[i] = value


@compiled
def recover_multipliers(
    data: Vector, n: int, m: int, p: int, s: Vector, active: Vector, step: float, new: Vector,
) -> None:  # fmt: skip
    """Make a state (size,) of dx in new[:n] and of the entries of `reduced_rates` in new[n:]."""
    _, at_G, at_A, _ = offsets(n, m, p)
    at_z, at_u = n + p, n + p + m
    for j in range(p):
        value = 0.0
        for i in range(n):
            value += data[at_A + j * n + i] * new[i]
        new[n + j] += step * value
    for j in range(m):
        if active[j] != 0.0:
            value = 0.0
            for i in range(n):
                value += data[at_G + j * n + i] * new[i]
            new[at_z + j] += step * value
    for i in range(n):
        new[at_u + i] += step * active[m + i] * new[i]
        new[at_u + n + i] -= step * active[m + n + i] * new[i]
    for k in range(s.size):
        new[k] += s[k]


@compiled
def linearly_implicit_step(
    data: Vector, n: int, m: int, p: int, s: Vector, rates: Vector, active: Vector, step: float,
    factored: bool, K: Vector, rhs: Vector, new: Vector,
) -> bool:  # fmt: skip
    """One linearly implicit Euler step of the network without its primal projection.

    Solves (I/step - F'(s)) (new - s) = F(s), with the multipliers' rows eliminated. `K` (n n,) and
    `rhs` (n,) are scratch; with `factored`, K holds the factor that the last call left, for the
    same step length and active rows.

    Returns:
        False if the condensed matrix is not positive definite; `new` is then meaningless.
    """
    reduced_rates(data, n, m, p, rates, active, step, rhs, new)
    if not factored:
        condensed_matrix(data, n, m, p, step, active, K)
        if not cholesky_factor(K, n):
            return False
    factor_solve(K, n, rhs, new)
    recover_multipliers(data, n, m, p, s, active, step, new)
    return True
