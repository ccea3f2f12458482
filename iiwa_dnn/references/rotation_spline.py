r"""A smooth interpolation of rotations: angular velocity and acceleration are continuous.

Between two rotations the rotation vector from the first one is a cubic polynomial of the time x,

.. math::  R(x) = \exp[\theta(x)]_\times R_i, \qquad \theta(0) = 0,\ \theta(h) = \varphi

with :math:`\varphi = \log(R_{i+1} R_i^T)`. The angular velocities at the two ends, :math:`\omega_i`
and :math:`\omega_{i+1}`, are :math:`\dot\theta(0)` and :math:`J(\varphi)\,\dot\theta(h)`. They are
chosen so that the angular acceleration :math:`J \ddot\theta + \dot J \dot\theta` does not jump from
piece to piece: a block tridiagonal system, linear but for :math:`\dot J \dot\theta`, which is taken
from the iteration before.

Source: "Smooth Attitude Interpolation", the note behind ``scipy.spatial.transform.RotationSpline``,
whose equations stand here in the fixed frame and with other ends.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.rotations import jacobian_rate, left_jacobian

_ITERATIONS = 200
_CONVERGED = 1e-13  # change of an angular velocity, relative to the largest


def fit_rotations(times: Array, quaternions: Array, ends: str) -> Array:
    """Fit the spline to unit quaternions w, x, y, z (m, 4) at times (m,) [s]; ends of `Waypoints`.

    Returns:
        Coefficients of x^3, x^2 and x of each piece's polynomial, and the rotation vector from the
        first orientation to the piece's, (m - 1, 4, 3).

    Raises:
        InvalidInputError: Two neighbours are half a turn apart, or the turns are too large to fit.
    """
    from scipy.sparse.linalg import spsolve
    from scipy.spatial.transform import Rotation

    knots = Rotation.from_quat(quaternions[:, [1, 2, 3, 0]])
    turns = (knots[1:] * knots[:-1].inv()).as_rotvec()
    if np.linalg.norm(turns, axis=1).max() > np.pi - 1e-6:
        raise InvalidInputError("quaternions", "two neighbours are half a turn apart", quaternions)
    h = np.diff(times)[:, None]
    pieces = len(turns)
    jacobians = np.array([[left_jacobian(turn, axis) for axis in np.eye(3)] for turn in turns])
    jacobians = jacobians.swapaxes(1, 2)
    inverses = np.linalg.inv(jacobians)
    # A closed path has one knot fewer.
    count = pieces if ends == "closed" else pieces + 1
    matrix, constant, before = _system(turns, h, jacobians, inverses, ends == "clamped", count)
    rates = np.zeros((count, 3))
    for _ in range(_ITERATIONS):
        bent = constant.copy()
        for k in np.flatnonzero(before >= 0):
            i = before[k]
            bent[k] -= jacobian_rate(turns[i], inverses[i] @ rates[k])
        last, rates = rates, spsolve(matrix, bent.ravel()).reshape(count, 3)
        change, size = np.abs(rates - last).max(), np.abs(rates).max()
        if not np.isfinite(size) or change <= _CONVERGED * size:
            break
    if not (np.isfinite(size) and change <= 1e-9 * size + 1e-300):
        problem = "no smooth rotation fits: add poses where the tool turns far"
        raise InvalidInputError("quaternions", problem, quaternions)
    first = rates[np.arange(pieces)]
    last = np.einsum("kij,kj->ki", inverses, rates[np.arange(1, pieces + 1) % count])
    cubic = (first + last) / h**2 - 2.0 * turns / h**3
    square = 3.0 * turns / h**2 - (2.0 * first + last) / h
    starts = (knots[:-1] * knots[0].inv()).as_rotvec()
    return np.stack([cubic, square, first, starts], axis=1)


def _system(
    turns: Array, h: Array, jacobians: Array, inverses: Array, clamped: bool, count: int
) -> tuple[Any, Array, NDArray[np.int64]]:
    """Assemble matrix and constant of the knots' angular velocities, and each knot's piece before.

    Row k: the accelerations of the pieces before and after knot k are the same. At an open path's
    ends a piece is missing, or the velocity is zero.
    """
    from scipy.sparse import coo_array

    eye, pieces = np.eye(3), len(turns)
    constant, before = np.zeros((count, 3)), np.full(count, -1)
    blocks = [(0, 0, eye), (pieces, pieces, eye)] if clamped else []
    for i in range(pieces):
        start, end, held = i, (i + 1) % count, 6.0 * turns[i] / h[i] ** 2
        if not clamped or start > 0:
            blocks += [(start, start, 4.0 * eye / h[i]), (start, end, 2.0 * inverses[i] / h[i])]
            constant[start] += held
        if not clamped or i + 1 < pieces:
            blocks += [(end, start, 2.0 * jacobians[i] / h[i]), (end, end, 4.0 * eye / h[i])]
            constant[end] += held
            before[end] = i
    rows, columns, values = (np.array(part) for part in zip(*blocks, strict=True))
    three = np.arange(3)
    at = np.broadcast_arrays(
        3 * rows[:, None, None] + three[:, None], 3 * columns[:, None, None] + three
    )
    entries = values.ravel(), (at[0].ravel(), at[1].ravel())
    return coo_array(entries, shape=(3 * count, 3 * count)).tocsc(), constant, before
