r"""Rotations in compiled code: the exponential of SO(3) and its left Jacobian.

A rotation vector :math:`\theta(t)` gives :math:`R = \exp[\theta]_\times`, which turns with

.. math::

    \omega = J(\theta)\,\dot\theta, \qquad
    J(\theta) = I + a\,[\theta]_\times + b\,[\theta]_\times^2,

    a = (1 - \cos\|\theta\|) / \|\theta\|^2, \qquad
    b = (\|\theta\| - \sin\|\theta\|) / \|\theta\|^3

Source: T. D. Barfoot, "State Estimation for Robotics", Cambridge University Press 2017, section 7.
"""

import math

import numpy as np

from iiwa_dnn.checks import Array, Matrix, Vector3
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.compiling.trigonometry import sin
from iiwa_dnn.references.targets import TargetData


@compiled
def coefficients(square: float) -> tuple[float, float]:
    """Compute a and b at a squared angle."""
    if square > 1.0:
        angle = np.sqrt(square)
        sine = sin(0.5 * angle)
        versine = 2.0 * sine * sine
        return versine / square, (angle - sin(angle)) / (square * angle)
    a = 1.0
    b = 1.0
    for i in range(10):  # the series from its last term, after which all are below rounding
        k = 10 - i
        a = 1.0 - a * square / ((2.0 * k + 1.0) * (2.0 * k + 2.0))
        b = 1.0 - b * square / ((2.0 * k + 2.0) * (2.0 * k + 3.0))
    return 0.5 * a, b / 6.0


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
def rotated(vector: Vector3, v: Vector3) -> Vector3:
    """Compute exp[vector] v."""
    square = dot(vector, vector)
    a, b = coefficients(square)
    once = cross(vector, v)
    return combined(1.0, v, 1.0, combined(1.0 - b * square, once, a, cross(vector, once)))


@compiled
def left_jacobian(vector: Vector3, v: Vector3) -> Vector3:
    """Compute J(vector) v: the angular velocity of a rotation vector with the rate v."""
    a, b = coefficients(dot(vector, vector))
    once = cross(vector, v)
    return combined(1.0, v, 1.0, combined(a, once, b, cross(vector, once)))


@compiled
def triple(v: Array) -> Vector3:
    """Return the components of a vector (3,)."""
    return v[0], v[1], v[2]


@compiled
def column_of(R: Matrix, j: int) -> Vector3:
    """Return the j-th column of a matrix (3, 3)."""
    return R[0, j], R[1, j], R[2, j]


@compiled
def turn_target(target: TargetData, vector: Vector3, rate: Vector3) -> None:
    """Turn a target by a rotation vector with a rate; its position stays."""
    for j in range(3):
        column = rotated(vector, column_of(target.rotation, j))
        for i in range(3):
            target.rotation[i, j] = column[i]
    before = rotated(vector, triple(target.angular_velocity))
    after = combined(1.0, left_jacobian(vector, rate), 1.0, before)
    for i in range(3):
        target.angular_velocity[i] = after[i]


@compiled
def rotation_log(R: Matrix, out: Array) -> None:
    """Write the rotation vector of R (3, 3), of length at most pi [rad], into `out` (3,).

    Through the unit quaternion's largest component, so that it is accurate near 0 and near pi.
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
    """Set the twist of a target to the mean one towards another, a period dt [s] later."""
    relative = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            relative[i, j] = dot(triple(then.rotation[i]), triple(now.rotation[j]))
    turn = np.empty(3)
    rotation_log(relative, turn)
    for i in range(3):
        now.linear_velocity[i] = (then.position[i] - now.position[i]) / dt
        now.angular_velocity[i] = turn[i] / dt
