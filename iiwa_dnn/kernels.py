"""The inner loops that are compiled with numba; only `kernels*.py` are compiled.

First the assembly of a control step's program, then the network that answers it, of which the
implicit integrator stands in `kernels_implicit.py`. A quadratic program travels as `QP.data` with
its sizes n, m, p, and is read in place:

    P[i, k]  data[i n + k]          G[j, i]  data[at_G + j n + i]     lb[i]  data[at_lb + i]
    q[i]     data[at_q + i]         A[j, i]  data[at_A + j n + i]     ub[i]  data[at_lb + n + i]
    h[j]     data[at_G + m n + j]   b[j]     data[at_lb - p + j]

The state of the projection network is one flat array, ``s = [x | y | z | u | l]``, with

    x (n)  the decision variables          z (m)  multipliers of G x <= h
    y (p)  multipliers of A x = b          u, l (n each)  multipliers of x <= ub and lb <= x

so u and l are the paper's mu for Omega = [I; -I]. Time is in units of the time constant rho.
The mathematics stands in `iiwa_dnn.schemes`, `iiwa_dnn.networks.projection` and
`iiwa_dnn.integrators.implicit`.
"""

# The kernels are plain loops over flat arrays on purpose. For seven joints a BLAS call costs more
# than its work, and so does every view: numba counts its references.
from __future__ import annotations

import numpy as np
from numba import njit

# numba makes a float of a signed and an unsigned integer: the constant has to be unsigned too.
ONE = np.uint64(1)


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def offsets(n, m, p):
    """``(at_q, at_G, at_A, at_lb)``: where the parts of `QP.data` begin."""
    at_q = n * n
    at_G = at_q + n
    at_A = at_G + m * n + m
    return at_q, at_G, at_A, at_A + p * n + p


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def larger(largest, value):
    """The larger of two; unlike with max(), a NaN once seen stays."""
    return value if value > largest or value != value else largest


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def rotation_log(R, out):
    """Write the rotation vector of R, of length at most pi, into `out`.

    Through the unit quaternion's largest component, so that it is accurate near 0 and near pi.
    """
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    if trace > 0.0:
        w = 0.5 * np.sqrt(1.0 + trace)
        out[0] = (R[2, 1] - R[1, 2]) / (4.0 * w)
        out[1] = (R[0, 2] - R[2, 0]) / (4.0 * w)
        out[2] = (R[1, 0] - R[0, 1]) / (4.0 * w)
    else:
        i = 0
        if R[1, 1] > R[0, 0]:
            i = 1
        if R[2, 2] > R[i, i]:
            i = 2
        j, k = (i + 1) % 3, (i + 2) % 3
        largest = 0.5 * np.sqrt(max(1.0 + R[i, i] - R[j, j] - R[k, k], 0.0))
        w = (R[k, j] - R[j, k]) / (4.0 * largest)
        sign = 1.0 if w >= 0.0 else -1.0
        w *= sign
        out[i] = sign * largest
        out[j] = sign * (R[i, j] + R[j, i]) / (4.0 * largest)
        out[k] = sign * (R[i, k] + R[k, i]) / (4.0 * largest)
    sine = np.sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2])
    # angle / sin(angle / 2), whose limit at 0 is 2
    scale = 2.0 * np.arctan2(sine, w) / sine if sine > 1e-12 else 2.0
    for i in range(3):
        out[i] *= scale


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def block_map(R, out):
    """Write W(R) (4, 3): the rate of [R11 R12 R21 R22] is W(R) times the angular velocity."""
    out[:] = 0.0
    for column in range(2):
        out[column, 1] = R[2, column]
        out[column, 2] = -R[1, column]
        out[2 + column, 0] = -R[2, column]
        out[2 + column, 2] = R[0, column]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def project_on_range(columns, vector):
    """Replace `vector` (4,) by its projection on the range of `columns` (4, 3), which is spoilt.

    Gram-Schmidt with pivoting; a direction below 1e-9 of the entries' scale, one, is none.
    """
    rows, count = columns.shape
    result = np.zeros(rows)
    for _ in range(count):
        best, largest = 0, 0.0
        for j in range(count):
            norm = 0.0
            for i in range(rows):
                norm += columns[i, j] * columns[i, j]
            if norm > largest:
                best, largest = j, norm
        if largest <= 1e-18:
            break
        scale = 1.0 / np.sqrt(largest)
        along = 0.0
        for i in range(rows):
            columns[i, best] *= scale
            along += columns[i, best] * vector[i]
        for i in range(rows):
            result[i] += along * columns[i, best]
        for j in range(count):
            if j != best:
                # Twice, so that rounding leaves no trace of the direction that was taken out.
                for _ in range(2):
                    overlap = 0.0
                    for i in range(rows):
                        overlap += columns[i, best] * columns[i, j]
                    for i in range(rows):
                        columns[i, j] -= overlap * columns[i, best]
        columns[:, best] = 0.0
    vector[:] = result


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def orientation_rows(mode, pose, jacobian, target, gain, rows, rhs):
    """Write the orientation task's rows (k, n) and right-hand side (k,).

    Mode 1 is so3 with k = 3, mode 2 the paper's block with k = 4, mode 0 nothing. The block's
    right-hand side is projected on the range of its rows (`iiwa_dnn.schemes.orientation`).
    """
    n = jacobian.shape[1]
    R = pose[:3, :3]
    desired = target[3:12].reshape(3, 3)
    omega = target[15:]
    if mode == 1:
        relative = np.empty((3, 3))
        for i in range(3):
            for j in range(3):
                value = 0.0
                for k in range(3):
                    value += desired[i, k] * R[j, k]
                relative[i, j] = value
        rotation_log(relative, rhs)
        for i in range(3):
            rhs[i] = omega[i] + gain * rhs[i]
            for j in range(n):
                rows[i, j] = jacobian[3 + i, j]
    elif mode == 2:
        here, there = np.empty((4, 3)), np.empty((4, 3))
        block_map(R, here)
        block_map(desired, there)
        for i in range(4):
            rhs[i] = gain * (desired[i // 2, i % 2] - R[i // 2, i % 2])
            for k in range(3):
                rhs[i] += there[i, k] * omega[k]
            for j in range(n):
                value = 0.0
                for k in range(3):
                    value += here[i, k] * jacobian[3 + k, j]
                rows[i, j] = value
        project_on_range(here, rhs)


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def velocity_bounds(q, limits, gain, lb, ub):
    """Write the velocity bounds of joint positions q; limits are the rows of `Robot.limits`."""
    for i in range(q.size):
        fastest = limits[2, i]
        lb[i] = min(max(gain * (limits[0, i] - q[i]), -fastest), fastest)
        ub[i] = min(max(gain * (limits[1, i] - q[i]), -fastest), fastest)


@njit(cache=True, error_model="numpy")
def move(q, dq, dq_solver, k, velocity, answer, dt):
    """Write `velocity` and the solver's `answer` (n,) into rows k, and where it leads into q.

    Rounded as numpy would: no product is contracted with its sum.
    """
    for i in range(velocity.size):
        dq_solver[k, i] = answer[i]
        dq[k, i] = velocity[i]
        q[k + 1, i] = q[k, i] + dt * velocity[i]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def window_mean(samples, count, sample):
    """Put the sample (n,) that comes after `count` others into the ring `samples` (window, n).

    Returns:
        The mean of the window, (n,), or of the samples that there are.
    """
    window, n = samples.shape
    samples[count % window] = sample
    filled = min(count + 1, window)
    mean = np.zeros(n)
    # A running sum would be quicker and would drift by its rounding.
    for k in range(filled):
        for i in range(n):
            mean[i] += samples[k, i]
    for i in range(n):
        mean[i] /= filled
    return mean


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def velocity_program(
    data, p, mode, q, pose, jacobian, target, limits, home, kinetic, parameters
):  # fmt: skip
    """Write the program of `iiwa_dnn.schemes.DoubleIndicator` into `data`, with p equality rows.

    `parameters` are weight, drift gain, position gain, orientation gain and limit gain.
    """
    n = q.size
    weight, drift_gain, position_gain = parameters[0], parameters[1], parameters[2]
    orientation_gain, limit_gain = parameters[3], parameters[4]
    at_q, _, at_A, at_lb = offsets(n, 0, p)
    at_b = at_lb - p
    for i in range(n):
        for j in range(n):
            data[i * n + j] = weight * kinetic[i, j]
        data[i * n + i] += 1.0 - weight
        data[at_q + i] = (1.0 - weight) * drift_gain * (q[i] - home[i])
    for i in range(3):
        data[at_b + i] = target[12 + i] + position_gain * (target[i] - pose[i, 3])
        for j in range(n):
            data[at_A + i * n + j] = jacobian[i, j]
    rows = data[at_A + 3 * n : at_b].reshape(p - 3, n)
    orientation_rows(mode, pose, jacobian, target, orientation_gain, rows, data[at_b + 3 : at_lb])
    velocity_bounds(q, limits, limit_gain, data[at_lb : at_lb + n], data[at_lb + n :])


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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def cholesky_factor(K, n):
    """Overwrite K's lower half (row stride n) by its Cholesky factor, with inverted diagonal.

    Returns:
        False if K is not positive definite to working precision; its content is then meaningless.
    """
    for i in range(n):
        for j in range(i):
            value = K[i * n + j]
            for k in range(j):
                value -= K[i * n + k] * K[j * n + k]
            K[i * n + j] = value * K[j * n + j]
        value = K[i * n + i]
        for k in range(i):
            value -= K[i * n + k] * K[i * n + k]
        if not value > 0.0:
            return False
        K[i * n + i] = 1.0 / np.sqrt(value)  # the inverse: a division costs many products
    return True


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def factor_solve(K, n, rhs, out):
    """Solve with the factor of `cholesky_factor` in K, for the leading n entries of `out`."""
    for i in range(n):
        value = rhs[i]
        for k in range(i):
            value -= K[i * n + k] * out[k]
        out[i] = value * K[i * n + i]
    for i in range(n - 1, -1, -1):
        value = out[i]
        for k in range(i + 1, n):
            value -= K[k * n + i] * out[k]
        out[i] = value * K[i * n + i]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def condensed_matrix(data, n, m, p, step, active, K):
    """Write the lower half of P + I/step + step (A^T A + active rows^T active rows) into K.

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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def _add_row(data, row, step, size, K):
    """Add step v v^T to the lower half of K, v being the row of `data` that begins there."""
    for i in range(size):
        scaled = step * data[row + i]
        for k in range(i + ONE):
            K[i * size + k] += scaled * data[row + k]


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def reduced_rates(data, n, m, p, rates, active, step, rhs, new):
    """Write the right-hand side of a linearly implicit step, its multipliers eliminated, into rhs.

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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def recover_multipliers(data, n, m, p, s, active, step, new):
    """Make a state of dx in new[:n] and of what `reduced_rates` left in new[n:]."""
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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def linearly_implicit_step(data, n, m, p, s, rates, active, step, factored, K, rhs, new):
    """One linearly implicit Euler step of the network without its primal projection.

    Solves (I/step - F'(s)) (new - s) = F(s), with the multipliers' rows eliminated. `K` (n n) and
    `rhs` (n) are scratch; with `factored`, K holds the factor that the last call left, for the same
    step length and active rows.

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


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def point_residuals(data, n, m, p, point):
    """``(primal, dual, gap)`` of a point [x | y | z | z_box], as qpsolvers defines them."""
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_h, at_b, at_ub = at_G + m * n, at_lb - p, at_lb + n
    at_z, at_box = n + p, n + p + m
    primal, dual, gap = 0.0, 0.0, 0.0
    for j in range(p):
        value = -data[at_b + j]
        for i in range(n):
            value += data[at_A + j * n + i] * point[i]
        primal = larger(primal, abs(value))
        gap += data[at_b + j] * point[n + j]
    for j in range(m):
        value = -data[at_h + j]
        for i in range(n):
            value += data[at_G + j * n + i] * point[i]
        primal = larger(primal, value)
        if point[at_z + j] != 0.0:
            gap += data[at_h + j] * point[at_z + j]
    for i in range(n):
        x, lb, ub, multiplier = point[i], data[at_lb + i], data[at_ub + i], point[at_box + i]
        primal = larger(primal, x - ub)
        primal = larger(primal, lb - x)
        value = data[at_q + i]
        for k in range(n):
            value += data[i * n + k] * point[k]
        gap += x * value
        value += multiplier
        for j in range(p):
            value += data[at_A + j * n + i] * point[n + j]
        for j in range(m):
            value += data[at_G + j * n + i] * point[at_z + j]
        dual = larger(dual, abs(value))
        if multiplier > 0.0 and ub < np.inf:
            gap += ub * multiplier
        elif multiplier < 0.0 and lb > -np.inf:
            gap += lb * multiplier
    return primal, dual, abs(gap)


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def largest_residuals(programs, n, m, p, points, out):
    """Write the largest residual of each point (N, k, size) into `out` (N, k).

    Infinity where a point is not a number from its first entry on: there is none.
    """
    count, k, _ = points.shape
    for i in range(count):
        for j in range(k):
            out[i, j] = np.inf
            if points[i, j, 0] == points[i, j, 0]:
                primal, dual, gap = point_residuals(programs[i], n, m, p, points[i, j])
                out[i, j] = larger(larger(primal, dual), gap)


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def kkt_point(data, n, m, p, s, point):
    """The primal-dual point that a state stands for, and its residuals ``(primal, dual, gap)``.

    x is put inside its bounds and z made nonnegative. z_box is what the projection of
    x - (P x + q + A^T y + G^T z) cuts off: at an equilibrium that is u - l plus the part of the
    multiplier that the primal projection carries. All of it shows in the residuals, which are
    those of the point that is handed out. `point` is the output, [x | y | z | z_box] of size
    n + p + m + n.
    """
    at_q, at_G, at_A, at_lb = offsets(n, m, p)
    at_ub, at_z = at_lb + n, n + p
    for i in range(n):
        point[i] = min(max(s[i], data[at_lb + i]), data[at_ub + i])
    for j in range(p):
        point[n + j] = s[n + j]
    for j in range(m):
        point[at_z + j] = max(s[at_z + j], 0.0)
    for i in range(n):
        aim = point[i] - data[at_q + i]
        for k in range(n):
            aim -= data[i * n + k] * point[k]
        for j in range(p):
            aim -= data[at_A + j * n + i] * point[n + j]
        for j in range(m):
            aim -= data[at_G + j * n + i] * point[at_z + j]
        point[at_z + m + i] = aim - min(max(aim, data[at_lb + i]), data[at_ub + i])
    return point_residuals(data, n, m, p, point)
