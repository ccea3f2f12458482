"""One backward Euler step of the projection network."""

from __future__ import annotations

import numpy as np

from iiwa_dnn.qp.dense import add_multiple, add_outer, add_scaled, dot, solve_upper
from iiwa_dnn.qp.layout import Vector, compiled, larger, offsets


@compiled
def begin_gram(data: Vector, n: int, m: int, p: int, gram: Vector, counted: Vector) -> None:
    """Write A^T A into `gram`, and note that no inequality row is counted in it."""
    _, _, at_A, _ = offsets(n, m, p)
    gram[:] = 0.0
    counted[:] = 0.0
    for j in range(p):
        add_outer(gram, 1.0, data, at_A + j * n, n)


@compiled
def newton_matrix(
    data: Vector, n: int, m: int, p: int, step: float, active: Vector, gram: Vector,
    counted: Vector, K: Vector,
) -> None:  # fmt: skip
    """Write the upper half of P + I/step + step (A^T A + active rows^T active rows) into K (n n,).

    `gram` (n n,), the second part without the bounds, and its rows `counted` (m,) are kept
    from call to call: between two Newton iterations few rows become active or cease to be.
    """
    _, at_G, _, _ = offsets(n, m, p)
    for j in range(m):
        if active[j] != counted[j]:
            add_outer(gram, active[j] - counted[j], data, at_G + j * n, n)
            counted[j] = active[j]
    add_multiple(K, data, step, gram, n)
    for i in range(n):
        K[i * n + i] += 1.0 / step + step * (active[m + i] + active[m + n + i])


@compiled
def _rows_times(data: Vector, n: int, m: int, p: int, x: Vector, values: Vector) -> None:
    """Write [A; G; I; -I] x into `values` (p + m + 2n)."""
    _, at_G, at_A, _ = offsets(n, m, p)
    for j in range(p):
        values[j] = dot(data, at_A + j * n, x, 0, n)
    for j in range(m):
        values[p + j] = dot(data, at_G + j * n, x, 0, n)
    for i in range(n):
        values[p + m + i] = x[i]
        values[p + m + n + i] = -x[i]


@compiled
def _slacks(data: Vector, n: int, m: int, p: int, x: Vector, slacks: Vector) -> None:
    """Write A x - b, G x - h, x - ub and lb - x into `slacks` (p + m + 2n)."""
    _, at_G, _, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    _rows_times(data, n, m, p, x, slacks)
    for j in range(p):
        slacks[j] -= data[at_b + j]
    for j in range(m):
        slacks[p + j] -= data[at_h + j]
    for i in range(n):
        slacks[p + m + i] -= data[at_ub + i]
        slacks[p + m + n + i] += data[at_lb + i]


@compiled
def _multipliers(
    n: int, m: int, p: int, s: Vector, step: float, slacks: Vector, new: Vector, active: Vector,
) -> None:  # fmt: skip
    """Multipliers after a backward Euler step to x with these slacks, and which are active."""
    keep = 1.0 / (1.0 + step)
    for j in range(p):
        new[n + j] = s[n + j] + step * slacks[j]
    for k in range(p, p + m + 2 * n):
        old = s[n + k]
        moving = old + step * slacks[k]
        is_active = moving > old * keep
        active[k - p] = is_active
        new[n + k] = moving if is_active else old * keep


@compiled
def _gradient(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, new: Vector, gradient: Vector,
) -> float:  # fmt: skip
    """Write what the step's x has to bring to zero; returns its largest entry."""
    at_q, at_G, at_A, _ = offsets(n, m, p)
    at_z, at_u = n + p, n + p + m
    for i in range(n):
        value = data[at_q + i] + new[at_u + i] - new[at_u + n + i]
        gradient[i] = value + (new[i] - s[i]) / step
    for k in range(n):  # P is symmetric
        add_scaled(gradient, 0, new[k], data, k * n, n)
    for j in range(p):
        add_scaled(gradient, 0, new[n + j], data, at_A + j * n, n)
    for j in range(m):
        if new[at_z + j] != 0.0:
            add_scaled(gradient, 0, new[at_z + j], data, at_G + j * n, n)
    size = 0.0
    for i in range(n):
        size = larger(size, abs(gradient[i]))
    return size


@compiled
def _line_search(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, slacks: Vector,
    change: Vector, direction: Vector, gradient: Vector,
) -> float:  # fmt: skip
    """Minimise the convex piecewise quadratic of `backward_euler` along `direction`.

    Its derivative is continuous, increasing and piecewise linear, so a Newton iteration kept
    inside a bracket ends at the root. `change` is [A; G; I; -I] direction.
    """
    keep = 1.0 / (1.0 + step)
    start, curvature = 0.0, 0.0
    for i in range(n):
        start += gradient[i] * direction[i]
        value = direction[i] / step + dot(data, i * n, direction, 0, n)
        curvature += value * direction[i]
    for j in range(p):
        curvature += step * change[j] * change[j]
    constant = start
    for k in range(p, p + m + 2 * n):
        old = s[n + k]
        constant -= max(old * keep, old + step * slacks[k]) * change[k]
    low, high, length = 0.0, np.inf, 1.0
    for _ in range(50):
        slope = constant + length * curvature
        second = curvature
        for k in range(p, p + m + 2 * n):
            old = s[n + k]
            moving = old + step * (slacks[k] + length * change[k])
            if moving > old * keep:
                slope += moving * change[k]
                second += step * change[k] * change[k]
            else:
                slope += old * keep * change[k]
        if abs(slope) <= 1e-3 * abs(start):
            break
        if slope > 0.0:
            high = length
        else:
            low = length
        length -= slope / second
        if not low < length < high:
            length = 0.5 * (low + high) if high < np.inf else 2.0 * low
    return length


@compiled
def workspace_size(n: int, m: int, p: int) -> int:
    """Size of the scratch array of `backward_euler`."""
    return 2 * n * n + 2 * n + 2 * (p + m + 2 * n) + (m + 2 * n) + m


@compiled
def backward_euler(
    data: Vector, n: int, m: int, p: int, s: Vector, step: float, new: Vector, tol: float,
    max_newton: int, work: Vector,
) -> int:  # fmt: skip
    """One backward Euler step of the network without its primal projection.

    new = s + step F(new), both of shape (3n + m + p,). Eliminating the multipliers leaves the
    stationarity of a strongly convex, piecewise quadratic function of x, for every step length; it
    is minimised by a semismooth Newton iteration with an exact line search, started at new[:n].
    That is why a step cannot cycle, however many bounds are active.

    The iteration stops when the gradient is at most `tol` or lost in rounding, or after
    `max_newton` rounds. The first m + n n entries of `work` are those of `begin_gram`, counted
    and gram; the rest is scratch.

    Returns:
        Newton iterations, or -1 where a matrix was not positive definite to working precision.
    """
    rows = p + m + 2 * n
    counted, gram, K = work[:m], work[m : m + n * n], work[m + n * n : m + 2 * n * n]
    rest = work[m + 2 * n * n :]
    gradient, direction = rest[:n], rest[n : 2 * n]
    slacks, change = rest[2 * n : 2 * n + rows], rest[2 * n + rows : 2 * n + 2 * rows]
    active = rest[2 * n + 2 * rows :]
    _slacks(data, n, m, p, new, slacks)
    # A slack is known to its rounding, and its multiplier to `step` times that.
    largest = 1.0
    for i in range(n):
        largest = max(largest, abs(new[i]))
    floor = 1e-15 * step * largest
    taken = max_newton
    for iteration in range(max_newton):
        _multipliers(n, m, p, s, step, slacks, new, active)
        size = _gradient(data, n, m, p, s, step, new, gradient)
        if not size > max(tol, floor):
            taken = iteration
            break
        newton_matrix(data, n, m, p, step, active, gram, counted, K)
        if not solve_upper(K, n, gradient, direction):
            return -1
        for i in range(n):
            direction[i] = -direction[i]
        _rows_times(data, n, m, p, direction, change)
        length = _line_search(data, n, m, p, s, step, slacks, change, direction, gradient)
        for i in range(n):
            new[i] += length * direction[i]
        for k in range(rows):
            slacks[k] += length * change[k]
    # Once more from x itself: long steps would magnify what the updates have gathered.
    _slacks(data, n, m, p, new, slacks)
    _multipliers(n, m, p, s, step, slacks, new, active)
    return taken
