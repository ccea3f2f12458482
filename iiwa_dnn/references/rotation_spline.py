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
import pinocchio as pin
from numpy.typing import NDArray

from iiwa_dnn.checks import Array
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.references.rotations import jacobian_rate

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
    pieces = len(turns)
    # A closed path has one knot fewer.
    count = pieces if ends == "closed" else pieces + 1
    after = np.arange(1, pieces + 1) % count
    free = np.ones(count)
    if ends == "clamped":
        free[[0, -1]] = 0.0
    h = np.diff(times)
    # The left Jacobian is the right one of the opposite vector.
    jacobians = np.array([pin.Jexp3(-turn) for turn in turns])
    inverses = np.linalg.inv(jacobians)
    matrix = _matrix(h, jacobians, inverses, after, free)
    constant = np.zeros((count, 3))
    for knot in (np.arange(pieces), after):
        np.add.at(constant, knot, 6.0 * turns / h[:, None] ** 2)
    rates = np.zeros((count, 3))
    for _ in range(_ITERATIONS):
        bent = constant.copy()
        for turn, inverse, k in zip(turns, inverses, after, strict=True):
            bent[k] -= jacobian_rate(tuple(turn), tuple(inverse @ rates[k]))
        last = rates
        rates = spsolve(matrix, (free[:, None] * bent).ravel()).reshape(count, 3)
        change = np.abs(rates - last).max()
        size = np.abs(rates).max()
        if not np.isfinite(size) or change <= _CONVERGED * size:
            break
    if not (np.isfinite(size) and change <= 1e-9 * size + 1e-300):
        problem = "no smooth rotation fits: add poses where the tool turns far"
        raise InvalidInputError("quaternions", problem, quaternions)
    h = h[:, None]
    first = rates[:pieces]
    final = np.einsum("kij,kj->ki", inverses, rates[after])
    cubic = (first + final) / h**2 - 2.0 * turns / h**3
    square = 3.0 * turns / h**2 - (2.0 * first + final) / h
    starts = (knots[:-1] * knots[0].inv()).as_rotvec()
    return np.stack([cubic, square, first, starts], axis=1)


def _matrix(
    h: Array, jacobians: Array, inverses: Array, after: NDArray[np.int64], free: Array
) -> Any:
    """Assemble the sparse matrix of the knots' angular velocities, (3 m, 3 m).

    Row k: the accelerations of the pieces before and after knot k are the same. At an open path's
    ends a piece is missing; at a clamped one, where `free` is 0, the velocity is zero.
    """
    from scipy.sparse import coo_array

    before = np.arange(len(h))
    knots = np.arange(len(free))
    rows = np.concatenate([before, before, after, after, knots])
    columns = np.concatenate([before, after, before, after, knots])
    own = np.multiply.outer(4.0 / h, np.eye(3))
    h = h[:, None, None]
    blocks = np.concatenate([own, 2.0 * inverses / h, 2.0 * jacobians / h, own])
    blocks *= free[rows[: len(blocks)], None, None]
    held = np.multiply.outer(1.0 - free, np.eye(3))
    i, j = np.indices((3, 3))
    at = (3 * rows[:, None, None] + i).ravel(), (3 * columns[:, None, None] + j).ravel()
    entries = np.concatenate([blocks, held]).ravel()
    return coo_array((entries, at), shape=(3 * len(free), 3 * len(free))).tocsc()
