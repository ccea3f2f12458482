"""The implicit integrator of the projection network, compiled.

The mathematics stands in `iiwa_dnn.networks.integrators.implicit`. State and program are laid out
as in `iiwa_dnn.kernels`.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.kernels.dense import add_multiple, add_outer, add_scaled, dot, solve_upper
from iiwa_dnn.kernels.layout import larger, offsets
from iiwa_dnn.kernels.linear_step import linearly_implicit_step, recover_multipliers, reduced_rates
from iiwa_dnn.kernels.network import field
from iiwa_dnn.kernels.residuals import kkt_point

FIRST_STEP = 10.0
"""Length of the first fully solved step, in units of rho; it grows tenfold a round."""
LAST_STEP = 1e6
"""Where it ends: beyond, the linear systems are singular to working precision."""
PLAIN = 16
"""Up to this many variables the plain loops of the other modules are quicker than vector code."""
NEAR = 1e4
"""Rates up to this many tolerances are near the solution, where rounding is in the way."""
TRIALS = np.array([1.0, 1e-2, 1e2, 1e-4, 1e4])
"""Lengths of the linearised steps that are tried there, in units of the first: shorter ones have
better conditioned systems, longer ones bring nearly dependent rows to rest."""
MAX_NEWTON = 50
"""Newton iterations of one fully solved step."""


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def begin_gram(data, n, m, p, gram, counted):
    """Write A^T A into `gram`, and note that no inequality row is counted in it."""
    _, _, at_A, _ = offsets(n, m, p)
    gram[:] = 0.0
    counted[:] = 0.0
    for j in range(p):
        add_outer(gram, 1.0, data, at_A + j * n, n)


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def newton_matrix(data, n, m, p, step, active, gram, counted, K):
    """Write the upper half of P + I/step + step (A^T A + active rows^T active rows) into K.

    `gram`, the second part without the bounds, is kept from call to call: between two Newton
    iterations few rows become active or cease to be.
    """
    _, at_G, _, _ = offsets(n, m, p)
    for j in range(m):
        if active[j] != counted[j]:
            add_outer(gram, active[j] - counted[j], data, at_G + j * n, n)
            counted[j] = active[j]
    add_multiple(K, data, step, gram, n)
    for i in range(n):
        K[i * n + i] += 1.0 / step + step * (active[m + i] + active[m + n + i])


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _rows_times(data, n, m, p, x, values):
    """Write [A; G; I; -I] x into `values` (p + m + 2n)."""
    _, at_G, at_A, _ = offsets(n, m, p)
    for j in range(p):
        values[j] = dot(data, at_A + j * n, x, 0, n)
    for j in range(m):
        values[p + j] = dot(data, at_G + j * n, x, 0, n)
    for i in range(n):
        values[p + m + i] = x[i]
        values[p + m + n + i] = -x[i]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _slacks(data, n, m, p, x, slacks):
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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _multipliers(n, m, p, s, step, slacks, new, active):
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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _gradient(data, n, m, p, s, step, new, gradient):
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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _line_search(data, n, m, p, s, step, slacks, change, direction, gradient):
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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def workspace_size(n, m, p):
    """Size of the scratch array of `backward_euler`."""
    return 2 * n * n + 2 * n + 2 * (p + m + 2 * n) + (m + 2 * n) + m


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def backward_euler(data, n, m, p, s, step, new, tol, max_newton, work):
    """One backward Euler step of the network without its primal projection.

    new = s + step F(new). Eliminating the multipliers leaves the stationarity of a strongly
    convex, piecewise quadratic function of x, for every step length; it is minimised by a
    semismooth Newton iteration with an exact line search, started at new[:n]. That is why a
    step cannot cycle, however many bounds are active.

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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def advance_implicit(data, n, m, p, s, step, count, tol):
    """Advance `s` in place by `count` backward Euler steps of fixed length, solved to `tol`.

    Returns:
        Linear systems solved, or -1 where one could not be.
    """
    new, work = s.copy(), np.empty(workspace_size(n, m, p))
    begin_gram(data, n, m, p, work[m : m + n * n], work[:m])
    total = 0
    for _ in range(count):
        systems = backward_euler(data, n, m, p, s, step, new, tol, 100, work)
        if systems < 0:
            return -1
        total += systems
        s[:] = new
    return total


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _linear_step(data, n, m, p, s, rates, active, step, work, new):
    """`kernels.linearly_implicit_step` with the matrix that is kept up to date in `work`."""
    counted, gram, K = work[:m], work[m : m + n * n], work[m + n * n : m + 2 * n * n]
    rhs = work[m + 2 * n * n : m + 2 * n * n + n]
    reduced_rates(data, n, m, p, rates, active, step, rhs, new)
    newton_matrix(data, n, m, p, step, active, gram, counted, K)
    if not solve_upper(K, n, rhs, new):
        return False
    recover_multipliers(data, n, m, p, s, active, step, new)
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def settle_implicit(data, n, m, p, s, point, tol, max_systems, long_step):
    """Advance `s` in place, with growing implicit steps, until its KKT residuals are below `tol`.

    Each round first tries one linearly implicit step of length `long_step`: near the solution
    that is a Newton step, and it is kept if it halves the largest rate. Otherwise a fully solved
    backward Euler step is taken, which is safe at any length; its length grows tenfold a round.
    Where three of the longest steps have not halved the rate, the state travels and does not
    settle: there is no solution, or none that is near.

    Returns:
        ``(systems, time, primal, dual, gap)``: linear systems solved, network time that passed
        [rho], and the residuals of `point`.
    """
    size, flags = s.size, m + 2 * n
    work = np.empty(3 * size + 2 * flags + n * n + n)
    rates, new_rates, new = work[:size], work[size : 2 * size], work[2 * size : 3 * size]
    active = work[3 * size : 3 * size + flags]
    new_active = work[3 * size + flags : 3 * size + 2 * flags]
    K, rhs = work[3 * size + 2 * flags : -n], work[-n:]
    step = FIRST_STEP
    systems, time, trial, stalled, travelling = 0, 0.0, 0, 0, 0
    begun, factored = False, False
    rate = field(data, n, m, p, False, s, rates, active)
    while systems < max_systems:
        if not rate > tol:
            primal, dual, gap = kkt_point(data, n, m, p, s, point)
            if primal <= tol and dual <= tol and gap <= tol:
                return systems, time, primal, dual, gap
            # Small rates and a large gap: large multipliers. Go on, but not for ever.
            stalled += 1
            if stalled > 30 or rate != rate:
                break
        systems += 1
        factored = factored and trial == 0
        long = long_step * TRIALS[trial]
        if not begun and (systems == 1 or n <= PLAIN):
            solved = linearly_implicit_step(
                data, n, m, p, s, rates, active, long, factored, K, rhs, new
            )
        else:
            if not begun:
                implicit = np.empty(workspace_size(n, m, p))
                begin_gram(data, n, m, p, implicit[m : m + n * n], implicit[:m])
                begun = True
            solved = _linear_step(data, n, m, p, s, rates, active, long, implicit, new)
        if solved:
            new_rate = field(data, n, m, p, False, new, new_rates, new_active)
            halved = new_rate <= 0.5 * rate
            # Where rounding is near, less than a half is progress too.
            if halved or (rate <= NEAR * tol and new_rate <= 0.9 * rate):
                # The same rows active and the same length: the same matrix once more.
                factored = halved and not begun
                for k in range(flags):
                    factored = factored and active[k] == new_active[k]
                s[:] = new
                rates, new_rates = new_rates, rates
                active, new_active = new_active, active
                time += long
                if halved:
                    travelling = 0
                else:
                    trial = (trial + 1) % TRIALS.size
                rate = new_rate
                continue
        if rate <= NEAR * tol and trial + 1 < TRIALS.size:
            trial += 1
            continue
        if not begun:
            implicit = np.empty(workspace_size(n, m, p))
            begin_gram(data, n, m, p, implicit[m : m + n * n], implicit[:m])
            begun = True
        new[:] = s
        count = min(MAX_NEWTON, max_systems - systems)
        solved_in = backward_euler(
            data, n, m, p, s, step, new, min(1e-2, 0.1 * rate), count, implicit
        )
        if solved_in < 0:
            step *= 0.1
            continue
        systems += solved_in
        trial = 0
        time += step
        s[:] = new
        before = rate
        rate = field(data, n, m, p, False, s, rates, active)
        if step < LAST_STEP:
            step *= 10.0
        elif rate > 0.5 * before:
            travelling += 1
            if travelling >= 3:
                break
            if rate <= NEAR * tol:
                # Not a long way to go, but rounding: shorter steps have better conditioned systems.
                step = 10.0 * FIRST_STEP
    primal, dual, gap = kkt_point(data, n, m, p, s, point)
    return systems, time, primal, dual, gap
