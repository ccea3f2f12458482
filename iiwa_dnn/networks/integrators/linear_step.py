r"""Linearly implicit Euler step of the projection network, compiled.

The step :math:`(I/h - F'(s))\,(s^+ - s) = F(s)` is linear on the active set at s. Its multipliers
are eliminated, which leaves n equations for the change of x with the condensed matrix

.. math::

    K = P + I/h + h\,(A^T A + C^T C),

C being the active rows of :math:`[G; I; -I]`. Newton's iteration for a backward Euler step
(`iiwa_dnn.networks.integrators.backward_euler`) has the same matrix.
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn.qp.dense import add_outer, cholesky_factor, factor_solve
from iiwa_dnn.qp.layout import ONE, Vector, compiled, offsets


@compiled
def begin_gram(data: Vector, n: int, m: int, p: int, counted: Vector, gram: Vector) -> None:
    """Write A^T A into `gram` (n n,); no row of G is counted in it, so `counted` (m,) is zero."""
    _, _, at_A, _ = offsets(n, m, p)
    for j in range(m):
        counted[j] = 0.0
    for k in range(n * n):
        gram[k] = 0.0
    for j in range(p):
        add_outer(gram, 1.0, data, at_A + j * n, n)


@compiled
def condensed_matrix(
    data: Vector, n: int, m: int, p: int, step: float, active: Vector, counted: Vector,
    gram: Vector, K: Vector,
) -> None:  # fmt: skip
    """Write the lower half of the condensed matrix of an active set (m + 2n,) into K (n n,).

    `gram`, A^T A and the products of the rows of G in `counted`, is kept from call to call: between
    two steps few rows become active or cease to be.
    """
    _, at_G, _, _ = offsets(n, m, p)
    for j in range(m):
        if active[j] != counted[j]:
            add_outer(gram, active[j] - counted[j], data, at_G + j * n, n)
            counted[j] = active[j]
    size = np.uint64(n)
    for i in range(size):
        for k in range(i + ONE):
            K[i * size + k] = data[i * size + k] + step * gram[i * size + k]
    for i in range(n):
        K[i * n + i] += 1.0 / step + step * (active[m + i] + active[m + n + i])


@compiled
def linear_step(
    data: Vector, n: int, m: int, p: int, s: Vector, rates: Vector, active: Vector, step: float,
    factored: bool, counted: Vector, gram: Vector, K: Vector, rhs: Vector, new: Vector,
) -> bool:  # fmt: skip
    """Write the state after a linearly implicit step from `s` into `new`, both (size,).

    Args:
        data: The program, of shape (size of `QP.data`,).
        n: Variables.
        m: Inequality rows.
        p: Equality rows.
        s: State, (3n + m + p,).
        rates: Rates at s, likewise.
        active: Active multipliers at s, 1 or 0, (m + 2n,).
        step: Length h.
        factored: Whether K holds the factor that the last call left for this step and active set.
        counted: See `condensed_matrix`, (m,).
        gram: See `condensed_matrix`, (n n,).
        K: Scratch, (n n,).
        rhs: Scratch, (n,).
        new: Output, (3n + m + p,).

    Returns:
        False if K is not positive definite to working precision; `new` is then meaningless.
    """
    if not factored:
        condensed_matrix(data, n, m, p, step, active, counted, gram, K)
        if not cholesky_factor(K, n):
            return False
    _reduced_rates(data, n, m, p, rates, active, step, rhs, new)
    factor_solve(K, n, rhs, new)
    _recover_multipliers(data, n, m, p, s, active, step, new)
    return True


@compiled
def _reduced_rates(
    data: Vector, n: int, m: int, p: int, rates: Vector, active: Vector, step: float, rhs: Vector,
    new: Vector,
) -> None:  # fmt: skip
    """Write the right-hand side of the n equations into `rhs`.

    The multipliers' changes for an x that stands still go into new[n:].
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
def _recover_multipliers(
    data: Vector, n: int, m: int, p: int, s: Vector, active: Vector, step: float, new: Vector,
) -> None:  # fmt: skip
    """Turn the change of x in new[:n] and the changes of `_reduced_rates` into the new state."""
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
