"""The projection network's rates, its stable step, and explicit Euler."""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.kernels.layout import larger, offsets


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def field(data, n, m, p, project, s, rates, active):
    """Write the network's rates rho ds/dt; with `project`, x goes through its bounds.

    `active` (m + 2n) becomes 1 for the multipliers with mu + Omega x - chi > 0, else 0.

    Returns:
        The largest absolute rate: zero exactly at a KKT point, NaN if one is NaN.
    """
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    at_z, at_u = n + p, n + p + m
    largest = 0.0
    for i in range(n):
        gradient = data[at_q + i] + s[at_u + i] - s[at_u + n + i]
        for k in range(n):
            gradient += data[i * n + k] * s[k]
        for j in range(p):
            gradient += data[at_A + j * n + i] * s[n + j]
        for j in range(m):
            gradient += data[at_G + j * n + i] * s[at_z + j]
        rate = -gradient
        if project:
            rate = min(max(s[i] + rate, data[at_lb + i]), data[at_ub + i]) - s[i]
        rates[i] = rate
        largest = larger(largest, abs(rate))
        for side in range(2):
            slack = s[i] - data[at_ub + i] if side == 0 else data[at_lb + i] - s[i]
            multiplier = s[at_u + side * n + i]
            is_active = multiplier + slack > 0.0
            rate = slack if is_active else -multiplier
            active[m + side * n + i] = is_active
            rates[at_u + side * n + i] = rate
            largest = larger(largest, abs(rate))
    for j in range(p):
        rate = -data[at_b + j]
        for i in range(n):
            rate += data[at_A + j * n + i] * s[i]
        rates[n + j] = rate
        largest = larger(largest, abs(rate))
    for j in range(m):
        slack = -data[at_h + j]
        for i in range(n):
            slack += data[at_G + j * n + i] * s[i]
        is_active = s[at_z + j] + slack > 0.0
        rate = slack if is_active else -s[at_z + j]
        active[j] = is_active
        rates[at_z + j] = rate
        largest = larger(largest, abs(rate))
    return largest


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def extreme_eigenvalues(K, n):
    """Smallest and largest eigenvalue of the symmetric K (n n), which is overwritten.

    Cyclic Jacobi rotations (G. H. Golub, C. F. Van Loan, "Matrix Computations", section 8.5): a
    call of LAPACK costs more than all of them for seven joints.
    """
    for _ in range(50):
        off, size = 0.0, 0.0
        for i in range(n):
            size += K[i * n + i] * K[i * n + i]
            for k in range(i):
                off += K[i * n + k] * K[i * n + k]
        # Second order: an off-diagonal of eps moves an eigenvalue by eps^2 over their distance.
        if not off > 1e-26 * (size + off):
            break
        for i in range(1, n):
            for k in range(i):
                below = K[i * n + k]
                if below == 0.0:
                    continue
                theta = 0.5 * (K[i * n + i] - K[k * n + k]) / below
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
                if theta < 0.0:
                    t = -t
                c = 1.0 / np.sqrt(t * t + 1.0)
                s = t * c
                K[i * n + i] += t * below
                K[k * n + k] -= t * below
                K[i * n + k] = K[k * n + i] = 0.0
                for j in range(n):
                    if j != i and j != k:
                        one, other = K[k * n + j], K[i * n + j]
                        K[k * n + j] = K[j * n + k] = c * one - s * other
                        K[i * n + j] = K[j * n + i] = s * one + c * other
    smallest, largest = K[0], K[0]
    for i in range(1, n):
        smallest, largest = min(smallest, K[i * n + i]), larger(largest, K[i * n + i])
    return smallest, largest


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def stable_step(data, n, m, p, active):
    """The bound of `iiwa_dnn.networks.ProjectionNetwork.stable_step` for an active set."""
    _, at_G, at_A, _ = offsets(n, m, p)
    K = np.zeros(n * n)
    for j in range(p + m):
        row = at_A + j * n if j < p else at_G + (j - p) * n
        if j < p or active[j - p] != 0.0:
            for i in range(n):
                for k in range(n):
                    K[i * n + k] += data[row + i] * data[row + k]
    for i in range(n):
        K[i * n + i] += active[m + i] + active[m + n + i]
    _, coupling = extreme_eigenvalues(K, n)
    K[:] = data[: n * n]
    smallest, largest = extreme_eigenvalues(K, n)
    # Passive multipliers and clipped variables decay at rate one: never more than 2.
    bound = 2.0 / max(largest, 1.0)
    return min(bound, max(smallest, 0.0) / coupling) if coupling > 0.0 else bound


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def explicit_euler(data, n, m, p, project, s, step, count, tol):
    """Advance `s` in place by up to `count` explicit Euler steps.

    Stops early once the largest rate is at most `tol`.

    Returns:
        ``(steps, rate)``: steps taken, and the largest rate at the last point evaluated.
    """
    rates, active = np.empty(s.size), np.empty(m + 2 * n)
    rate = np.inf
    for done in range(count):
        rate = field(data, n, m, p, project, s, rates, active)
        if not rate > tol:
            return done, rate
        for i in range(s.size):
            s[i] += step * rates[i]
    return count, rate
