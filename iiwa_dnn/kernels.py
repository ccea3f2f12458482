"""The inner loops that are compiled with numba; nothing is compiled elsewhere.

A quadratic program travels as the tuple ``qp = (P, q, G, h, A, b, lb, ub)`` of `QP.arrays`. The
state of the projection network is one flat array ``s = [x | y | z | u | l]`` with

    x (n)  the decision variables          z (m)  multipliers of G x <= h
    y (p)  multipliers of A x = b          u, l (n each)  multipliers of x <= ub and lb <= x

so u and l are the paper's mu for Omega = [I; -I]. Time is in units of the time constant rho.
The mathematics stands in `iiwa_dnn.networks.projection` and `iiwa_dnn.integrators.implicit`.
"""

# The kernels are plain loops on purpose: for seven joints a BLAS call costs more than its work.
from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True, error_model="numpy")
def unpack(data, n, m, p):
    """The tuple qp as views of `QP.data`."""
    end_p = n * n
    end_g = end_p + n + m * n
    end_a = end_g + m + p * n
    end = end_a + p
    return (
        data[:end_p].reshape(n, n),
        data[end_p : end_p + n],
        data[end_p + n : end_g].reshape(m, n),
        data[end_g : end_g + m],
        data[end_g + m : end_a].reshape(p, n),
        data[end_a:end],
        data[end : end + n],
        data[end + n :],
    )


@njit(cache=True, error_model="numpy")
def multiplier_field(qp, s, out, active):
    """Write the rates of y, z, u, l into `out`; flag the multipliers with mu + Omega x - chi > 0.

    Returns:
        The largest absolute rate; NaN if one is NaN.
    """
    _, q, G, h, A, b, lb, ub = qp
    n, p, m = q.size, b.size, h.size
    largest = 0.0
    for j in range(p):
        rate = -b[j]
        for i in range(n):
            rate += A[j, i] * s[i]
        out[n + j] = rate
        # max() would drop a NaN, a failed comparison keeps it.
        largest = largest if abs(rate) <= largest else abs(rate)
    for k in range(m + 2 * n):
        if k < m:
            slack = -h[k]
            for i in range(n):
                slack += G[k, i] * s[i]
        elif k < m + n:
            slack = s[k - m] - ub[k - m]
        else:
            slack = lb[k - m - n] - s[k - m - n]
        multiplier = s[n + p + k]
        active[k] = multiplier + slack > 0.0
        rate = slack if active[k] else -multiplier
        out[n + p + k] = rate
        largest = largest if abs(rate) <= largest else abs(rate)
    return largest


@njit(cache=True, error_model="numpy")
def lagrangian_gradient(qp, s, out):
    """Write P x + q + A^T y + G^T z + u - l into out[:n]."""
    P, q, G, h, A, b, _, _ = qp
    n, p, m = q.size, b.size, h.size
    for i in range(n):
        value = q[i] + s[n + p + m + i] - s[n + p + m + n + i]
        for k in range(n):
            value += P[i, k] * s[k]
        out[i] = value
    for j in range(p):
        y = s[n + j]
        for i in range(n):
            out[i] += A[j, i] * y
    for j in range(m):
        z = s[n + p + j]
        if z != 0.0:
            for i in range(n):
                out[i] += G[j, i] * z


@njit(cache=True, error_model="numpy")
def field(qp, project, s, out, active):
    """Write the network's rates rho ds/dt into `out`; with `project`, x goes through its bounds.

    Returns:
        The largest absolute rate: zero exactly at a KKT point.
    """
    _, q, _, _, _, _, lb, ub = qp
    lagrangian_gradient(qp, s, out)
    largest = multiplier_field(qp, s, out, active)
    for i in range(q.size):
        rate = -out[i]
        if project:
            rate = min(max(s[i] + rate, lb[i]), ub[i]) - s[i]
        out[i] = rate
        largest = largest if abs(rate) <= largest else abs(rate)
    return largest


@njit(cache=True, error_model="numpy")
def explicit_euler(qp, project, s, step, count, tol):
    """Advance `s` in place by up to `count` explicit Euler steps.

    Stops early once the largest rate is at most `tol`.

    Returns:
        ``(steps, rate)``: steps taken, and the largest rate at the last point evaluated.
    """
    rates = np.empty(s.size)
    active = np.empty(s.size, np.bool_)
    rate = np.inf
    for done in range(count):
        rate = field(qp, project, s, rates, active)
        if not rate > tol:
            return done, rate
        for i in range(s.size):
            s[i] += step * rates[i]
    return count, rate


@njit(cache=True, error_model="numpy")
def cholesky_solve(K, rhs, out):
    """Solve K out = rhs, K symmetric positive definite in its lower half, which is overwritten.

    Returns:
        False if K is not positive definite to working precision; `out` is then meaningless.
    """
    n = rhs.size
    for i in range(n):
        for j in range(i):
            value = K[i, j]
            for k in range(j):
                value -= K[i, k] * K[j, k]
            K[i, j] = value * K[j, j]
        value = K[i, i]
        for k in range(i):
            value -= K[i, k] * K[i, k]
        if not value > 0.0:
            return False
        K[i, i] = 1.0 / np.sqrt(value)  # the inverse: divisions cost more than products
    for i in range(n):
        value = rhs[i]
        for k in range(i):
            value -= K[i, k] * out[k]
        out[i] = value * K[i, i]
    for i in range(n - 1, -1, -1):
        value = out[i]
        for k in range(i + 1, n):
            value -= K[k, i] * out[k]
        out[i] = value * K[i, i]
    return True


@njit(cache=True, error_model="numpy")
def condensed_matrix(qp, step, active, K):
    """Write the lower half of P + I/step + step (A^T A + active rows^T active rows) into K."""
    P, q, G, h, A, b, _, _ = qp
    n, p, m = q.size, b.size, h.size
    for i in range(n):
        for k in range(i + 1):
            K[i, k] = P[i, k]
        K[i, i] += 1.0 / step
        if active[m + i]:
            K[i, i] += step
        if active[m + n + i]:
            K[i, i] += step
    for j in range(p):
        for i in range(n):
            scaled = step * A[j, i]
            for k in range(i + 1):
                K[i, k] += scaled * A[j, k]
    for j in range(m):
        if active[j]:
            for i in range(n):
                scaled = step * G[j, i]
                for k in range(i + 1):
                    K[i, k] += scaled * G[j, k]


@njit(cache=True, error_model="numpy")
def linearly_implicit_step(qp, s, rates, active, step, new):
    """One linearly implicit Euler step of the network without its primal projection.

    Solves (I/step - F'(s)) (new - s) = F(s), with the multipliers' rows eliminated.

    Returns:
        False if the condensed matrix is not positive definite; `new` is then meaningless.
    """
    _, q, G, h, A, b, _, _ = qp
    n, p, m = q.size, b.size, h.size
    decay = step / (1.0 + step)
    K = np.empty((n, n))
    rhs = np.empty(n)
    # With dx = 0 the multipliers would change by `new`; the rest follows from dx below.
    for k in range(n, n + p):
        new[k] = step * rates[k]
    for k in range(m + 2 * n):
        new[n + p + k] = (step if active[k] else decay) * rates[n + p + k]
    for i in range(n):
        rhs[i] = rates[i] - new[n + p + m + i] + new[n + p + m + n + i]
    for j in range(p):
        for i in range(n):
            rhs[i] -= A[j, i] * new[n + j]
    for j in range(m):
        if new[n + p + j] != 0.0:
            for i in range(n):
                rhs[i] -= G[j, i] * new[n + p + j]
    condensed_matrix(qp, step, active, K)
    if not cholesky_solve(K, rhs, new[:n]):
        return False
    for j in range(p):
        for i in range(n):
            new[n + j] += step * A[j, i] * new[i]
    for k in range(m + 2 * n):
        if active[k]:
            if k < m:
                for i in range(n):
                    new[n + p + k] += step * G[k, i] * new[i]
            elif k < m + n:
                new[n + p + k] += step * new[k - m]
            else:
                new[n + p + k] -= step * new[k - m - n]
    for k in range(s.size):
        new[k] += s[k]
    return True


@njit(cache=True, error_model="numpy")
def _implicit_multipliers(qp, s, step, slacks, new):
    """Multipliers after a backward Euler step to new[:n]; fills slacks (p + m + 2n)."""
    _, q, G, h, A, b, lb, ub = qp
    n, p, m = q.size, b.size, h.size
    keep = 1.0 / (1.0 + step)
    for j in range(p):
        value = -b[j]
        for i in range(n):
            value += A[j, i] * new[i]
        slacks[j] = value
        new[n + j] = s[n + j] + step * value
    for k in range(m + 2 * n):
        if k < m:
            value = -h[k]
            for i in range(n):
                value += G[k, i] * new[i]
        elif k < m + n:
            value = new[k - m] - ub[k - m]
        else:
            value = lb[k - m - n] - new[k - m - n]
        slacks[p + k] = value
        old = s[n + p + k]
        new[n + p + k] = max(old * keep, old + step * value)


@njit(cache=True, error_model="numpy")
def _line_search(qp, s, step, slacks, change, direction, gradient):
    """Minimise the convex piecewise quadratic of `backward_euler` along `direction`.

    Its derivative is continuous, increasing and piecewise linear, so a Newton iteration kept
    inside a bracket ends at the root.
    """
    P, q, G, h, A, b, _, _ = qp
    n, p, m = q.size, b.size, h.size
    keep = 1.0 / (1.0 + step)
    start = 0.0
    curvature = 0.0
    for i in range(n):
        start += gradient[i] * direction[i]
        value = direction[i] / step
        for k in range(n):
            value += P[i, k] * direction[k]
        curvature += value * direction[i]
    for j in range(p):
        value = 0.0
        for i in range(n):
            value += A[j, i] * direction[i]
        curvature += step * value * value
    constant = start
    for k in range(m + 2 * n):
        if k < m:
            value = 0.0
            for i in range(n):
                value += G[k, i] * direction[i]
        elif k < m + n:
            value = direction[k - m]
        else:
            value = -direction[k - m - n]
        change[k] = value
        old = s[n + p + k]
        constant -= max(old * keep, old + step * slacks[p + k]) * value
    low, high, length = 0.0, np.inf, 1.0
    for _ in range(50):
        slope = constant + length * curvature
        second = curvature
        for k in range(m + 2 * n):
            old = s[n + p + k]
            moving = old + step * (slacks[p + k] + length * change[k])
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


@njit(cache=True, error_model="numpy")
def backward_euler(qp, s, step, new, tol, max_newton):
    """One backward Euler step of the network without its primal projection.

    new = s + step F(new). Eliminating the multipliers leaves the stationarity of a strongly
    convex, piecewise quadratic function of x, for every step length; it is minimised by a
    semismooth Newton iteration with an exact line search, started at new[:n]. That is why a
    step cannot cycle, however many bounds are active.

    The iteration stops when the gradient is at most `tol`, or after `max_newton` rounds.

    Returns:
        Newton iterations, or -1 where a matrix was not positive definite to working precision.
    """
    _, q, _, h, _, b, _, _ = qp
    n, p, m = q.size, b.size, h.size
    keep = 1.0 / (1.0 + step)
    gradient, direction, rhs = np.empty(n), np.empty(n), np.empty(n)
    K = np.empty((n, n))
    slacks, change = np.empty(p + m + 2 * n), np.empty(m + 2 * n)
    active = np.empty(m + 2 * n, np.bool_)
    for iteration in range(max_newton):
        _implicit_multipliers(qp, s, step, slacks, new)
        lagrangian_gradient(qp, new, gradient)
        size = 0.0
        for i in range(n):
            gradient[i] += (new[i] - s[i]) / step
            rhs[i] = -gradient[i]
            size = size if abs(rhs[i]) <= size else abs(rhs[i])
        if not size > tol:
            return iteration
        for k in range(m + 2 * n):
            old = s[n + p + k]
            active[k] = old + step * slacks[p + k] > old * keep
        condensed_matrix(qp, step, active, K)
        if not cholesky_solve(K, rhs, direction):
            return -1
        length = _line_search(qp, s, step, slacks, change, direction, gradient)
        for i in range(n):
            new[i] += length * direction[i]
    _implicit_multipliers(qp, s, step, slacks, new)
    return max_newton


@njit(cache=True, error_model="numpy")
def advance_implicit(qp, s, step, count, tol):
    """Advance `s` in place by `count` backward Euler steps of fixed length, solved to `tol`.

    Returns:
        Linear systems solved, or -1 where one could not be.
    """
    new = s.copy()
    total = 0
    for _ in range(count):
        systems = backward_euler(qp, s, step, new, tol, 100)
        if systems < 0:
            return -1
        total += systems
        s[:] = new
    return total


@njit(cache=True, error_model="numpy")
def kkt_point(qp, s, point):
    """The primal-dual point that a state stands for, and its residuals.

    x is put inside its bounds and z made nonnegative. z_box is what the projection of
    x - (P x + q + A^T y + G^T z) cuts off: at an equilibrium that is u - l plus the part of the
    multiplier that the primal projection carries. All of it shows in the residuals, which are
    those of the point that is handed out. `point` is the output, [x | y | z | z_box] of size
    n + p + m + n.

    Returns:
        ``(primal, dual, gap)`` as qpsolvers defines them.
    """
    P, q, G, h, A, b, lb, ub = qp
    n, p, m = q.size, b.size, h.size
    primal, dual, gap = 0.0, 0.0, 0.0
    for i in range(n):
        point[i] = min(max(s[i], lb[i]), ub[i])
    for j in range(p):
        value = -b[j]
        for i in range(n):
            value += A[j, i] * point[i]
        primal = primal if abs(value) <= primal else abs(value)
        point[n + j] = s[n + j]
        gap += b[j] * s[n + j]
    for j in range(m):
        value = -h[j]
        for i in range(n):
            value += G[j, i] * point[i]
        primal = primal if value <= primal else value
        multiplier = max(s[n + p + j], 0.0)
        point[n + p + j] = multiplier
        if multiplier > 0.0:
            gap += h[j] * multiplier
    for i in range(n):
        value = q[i]
        curvature = 0.0
        for k in range(n):
            curvature += P[i, k] * point[k]
        gap += point[i] * (curvature + q[i])
        value += curvature
        for j in range(p):
            value += A[j, i] * point[n + j]
        for j in range(m):
            value += G[j, i] * point[n + p + j]
        aim = point[i] - value
        multiplier = aim - min(max(aim, lb[i]), ub[i])
        if multiplier > 0.0:
            gap += ub[i] * multiplier
        elif multiplier < 0.0:
            gap += lb[i] * multiplier
        point[n + p + m + i] = multiplier
        value += multiplier
        dual = dual if abs(value) <= dual else abs(value)
    return primal, dual, abs(gap)


@njit(cache=True, error_model="numpy")
def settle_implicit(data, n, m, p, s, point, tol, max_steps, long_step):
    """Advance `s` in place, with growing implicit steps, until its KKT residuals are below `tol`.

    Each round first tries one linearly implicit step of length `long_step`: near the solution
    that is a Newton step, and it is kept if it halves the largest rate. Otherwise a fully solved
    backward Euler step is taken, which is safe at any length; its length grows tenfold a round.

    Returns:
        ``(systems, time, primal, dual, gap)``: linear systems solved, network time that passed
        [rho], and the residuals of `point`.
    """
    qp = unpack(data, n, m, p)
    size = s.size
    rates, new_rates, new = np.empty(size), np.empty(size), np.empty(size)
    active, new_active = np.empty(size, np.bool_), np.empty(size, np.bool_)
    step = 10.0
    systems, time, stalled = 0, 0.0, 0
    primal, dual, gap = np.inf, np.inf, np.inf
    rate = field(qp, False, s, rates, active)
    for _ in range(max_steps):
        if not rate > tol:
            primal, dual, gap = kkt_point(qp, s, point)
            if not max(primal, dual, gap) > tol:
                return systems, time, primal, dual, gap
            # Small rates and a large gap: large multipliers. Go on, but not for ever.
            stalled += 1
            if stalled > 10 or rate != rate:
                break
        systems += 1
        if linearly_implicit_step(qp, s, rates, active, long_step, new):
            new_rate = field(qp, False, new, new_rates, new_active)
            if new_rate <= 0.5 * rate:
                s[:] = new
                rates, new_rates = new_rates, rates
                active, new_active = new_active, active
                rate = new_rate
                time += long_step
                continue
        new[:] = s
        solved = backward_euler(qp, s, step, new, min(1e-2, 0.1 * rate), 100)
        if solved < 0:
            step *= 0.1
            continue
        systems += solved
        s[:] = new
        time += step
        step = min(step * 10.0, 1e6)
        rate = field(qp, False, s, rates, active)
    primal, dual, gap = kkt_point(qp, s, point)
    return systems, time, primal, dual, gap
