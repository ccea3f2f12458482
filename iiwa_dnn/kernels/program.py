"""A control step's program, assembled (`iiwa_dnn.schemes`)."""

from __future__ import annotations

import numpy as np
from numba import njit

from iiwa_dnn.qp.layout import offsets


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
