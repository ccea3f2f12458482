r"""Rotations in compiled code: the exponential of SO(3), its left Jacobian and their rates.

A rotation vector :math:`\theta(t)` gives :math:`R = \exp[\theta]_\times`, which turns with

.. math::

    \omega = J(\theta)\,\dot\theta, \qquad
    J(\theta) = I + a\,[\theta]_\times + b\,[\theta]_\times^2,

    a = (1 - \cos\|\theta\|) / \|\theta\|^2, \qquad
    b = (\|\theta\| - \sin\|\theta\|) / \|\theta\|^3

Source: T. D. Barfoot, "State Estimation for Robotics", Cambridge University Press 2017, section 7.
"""

import numpy as np
from numba import njit

from iiwa_dnn.checks import Array

Four = tuple[float, float, float, float]


# Task rows call it too: without `fastmath` a function takes that of whichever calls it first.
@njit(cache=True, error_model="numpy", fastmath={"contract"})
def coefficients(square: float) -> Four:
    """Compute a, b and their derivatives by the angle over the angle, at a squared angle."""
    if square > 1.0:
        angle = np.sqrt(square)
        sine, versine = np.sin(angle), 2.0 * np.sin(0.5 * angle) ** 2
        slope = (angle * sine - 2.0 * versine) / square**2
        return (
            versine / square,
            (angle - sine) / (square * angle),
            slope,
            (angle * versine - 3.0 * (angle - sine)) / (square**2 * angle),
        )
    a, b, slope_a, slope_b = 0.5, 1.0 / 6.0, 0.0, 0.0
    power, term_a, term_b = 1.0, 0.5, 1.0 / 6.0
    for k in range(1, 11):  # the series, whose next term is below rounding
        term_a /= -(2.0 * k + 1.0) * (2.0 * k + 2.0)
        term_b /= -(2.0 * k + 2.0) * (2.0 * k + 3.0)
        slope_a += 2.0 * k * term_a * power
        slope_b += 2.0 * k * term_b * power
        power *= square
        a += term_a * power
        b += term_b * power
    return a, b, slope_a, slope_b


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def cross(u: Array, v: Array) -> Array:
    """Compute the cross product u x v, (3,)."""
    out = np.empty(3)
    out[0] = u[1] * v[2] - u[2] * v[1]
    out[1] = u[2] * v[0] - u[0] * v[2]
    out[2] = u[0] * v[1] - u[1] * v[0]
    return out


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def rotated(vector: Array, v: Array) -> Array:
    """Compute exp[vector] v, (3,)."""
    square = vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2
    a, b, _, _ = coefficients(square)
    once = cross(vector, v)
    out: Array = v + (1.0 - b * square) * once + a * cross(vector, once)
    return out


@njit(cache=True, error_model="numpy")
def left_jacobian(vector: Array, v: Array) -> Array:
    """Compute J(vector) v, (3,): the angular velocity of a rotation vector with the rate v."""
    a, b, _, _ = coefficients(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    once = cross(vector, v)
    out: Array = v + a * once + b * cross(vector, once)
    return out


@njit(cache=True, error_model="numpy")
def jacobian_rate(vector: Array, rate: Array) -> Array:
    """Compute dJ/dt rate, (3,): the part of the angular acceleration without the second rate."""
    _, b, slope_a, slope_b = coefficients(vector[0] ** 2 + vector[1] ** 2 + vector[2] ** 2)
    along = vector[0] * rate[0] + vector[1] * rate[1] + vector[2] * rate[2]
    once = cross(vector, rate)
    out: Array = along * (slope_a * once + slope_b * cross(vector, once)) + b * cross(rate, once)
    return out


@njit(cache=True, error_model="numpy")
def turn_target(target: Array, vector: Array, rate: Array) -> None:
    """Turn a target, `Target.data`, by a rotation vector with a rate; its position stays."""
    for j in range(3):
        column = rotated(vector, target[3 + j : 12 : 3])
        for i in range(3):
            target[3 + 3 * i + j] = column[i]
    target[15:18] = left_jacobian(vector, rate) + rotated(vector, target[15:18])


@njit(cache=True, error_model="numpy", fastmath={"contract"})
def rotation_log(R: Array, out: Array) -> None:
    """Write the rotation vector of R (3, 3), of length at most pi [rad], into `out` (3,).

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
