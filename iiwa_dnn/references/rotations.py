"""Vectors in space, turns by a quaternion, and the logarithm of a rotation, in compiled code."""

import math

import numpy as np

from iiwa_dnn.checks import Array, Matrix, Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.trigonometry import sin_cos
from iiwa_dnn.references.targets import TargetData


@compiled
def dot(u: Vector3, v: Vector3) -> float:
    """Compute the scalar product u . v."""
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@compiled
def cross(u: Vector3, v: Vector3) -> Vector3:
    """Compute the cross product u x v."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


@compiled
def scaled(a: float, u: Vector3) -> Vector3:
    """Compute a u."""
    return a * u[0], a * u[1], a * u[2]


@compiled
def combined(a: float, u: Vector3, b: float, v: Vector3) -> Vector3:
    """Compute a u + b v."""
    return a * u[0] + b * v[0], a * u[1] + b * v[1], a * u[2] + b * v[2]


@compiled
def triple(v: Array) -> Vector3:
    """Return the components of a vector (3,)."""
    return v[0], v[1], v[2]


@compiled
def column_of(R: Matrix, j: int) -> Vector3:
    """Return the j-th column of a matrix (3, 3)."""
    return R[0, j], R[1, j], R[2, j]


@compiled
def rotated(w: float, u: Vector3, v: Vector3) -> Vector3:
    """Rotate v by the quaternion with scalar part w and vector part u, of any length but 0."""
    once = cross(u, v)
    scale = 2.0 / (w * w + dot(u, u))
    return combined(1.0, v, scale, combined(w, once, 1.0, cross(u, once)))


@compiled
def turn_target(target: TargetData, w: float, u: Vector3, w_rate: float, u_rate: Vector3) -> None:
    """Turn a target about the world's axes by a quaternion; its position stays.

    Args:
        target: The target.
        w: Scalar part of the quaternion, whose length may be any but 0.
        u: Vector part.
        w_rate: Rate of the scalar part [1/s].
        u_rate: Rate of the vector part [1/s].
    """
    for j in range(3):
        column = rotated(w, u, column_of(target.rotation, j))
        for i in range(3):
            target.rotation[i, j] = column[i]
    before = rotated(w, u, triple(target.angular_velocity))
    spin = combined(1.0, cross(u, u_rate), 1.0, combined(w, u_rate, -w_rate, u))
    after = combined(1.0, before, 2.0 / (w * w + dot(u, u)), spin)
    for i in range(3):
        target.angular_velocity[i] = after[i]


@compiled
def turn_about(target: TargetData, axis: Vector3, angle: float, rate: float) -> None:
    """Turn a target about an axis of length 1 by an angle [rad], at a rate [rad/s]."""
    sine, cosine = sin_cos(0.5 * angle)
    half = 0.5 * rate
    turn_target(target, cosine, scaled(sine, axis), -half * sine, scaled(half * cosine, axis))


@compiled
def rotation_log(R: Matrix, out: Array) -> None:
    """Write the rotation vector of R (3, 3), of length at most pi [rad], into `out` (3,).

    The unit quaternion is computed first, from a large component, so that the vector is accurate
    near an angle of 0 and near one of pi.
    """
    trace = 0.0
    i = 0
    for axis in range(3):
        trace += R[axis, axis]
        if R[axis, axis] > R[i, i]:
            i = axis
    if trace > 0.0:
        w = 0.5 * np.sqrt(1.0 + trace)
        for axis in range(3):
            j = (axis + 1) % 3
            k = (axis + 2) % 3
            out[axis] = (R[k, j] - R[j, k]) / (4.0 * w)
    else:
        j = (i + 1) % 3
        k = (i + 2) % 3
        largest = 0.5 * np.sqrt(max(1.0 + R[i, i] - R[j, j] - R[k, k], 0.0))
        w = (R[k, j] - R[j, k]) / (4.0 * largest)
        sign = 1.0 if w >= 0.0 else -1.0
        w *= sign
        out[i] = sign * largest
        out[j] = sign * (R[i, j] + R[j, i]) / (4.0 * largest)
        out[k] = sign * (R[i, k] + R[k, i]) / (4.0 * largest)
    sine = np.sqrt(dot(triple(out), triple(out)))
    # angle / sin(angle / 2), whose limit at 0 is 2
    scale = 2.0 * math.atan2(sine, w) / sine if sine > 1e-12 else 2.0
    for axis in range(3):
        out[axis] *= scale


@compiled
def set_mean_twist(now: TargetData, then: TargetData, dt: float) -> None:
    """Set the twist of a target `now` to the mean one over dt [s], to a target `then`."""
    relative = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            relative[i, j] = dot(triple(then.rotation[i]), triple(now.rotation[j]))
    turn = np.empty(3)
    rotation_log(relative, turn)
    for i in range(3):
        now.linear_velocity[i] = (then.position[i] - now.position[i]) / dt
        now.angular_velocity[i] = turn[i] / dt
