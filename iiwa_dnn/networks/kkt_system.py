r"""The KKT conditions of a program as a system of equations E(s) = 0, with derivatives.

Two forms of the complementarity, both with :math:`A x = b` as rows:

* ``"projected"``, s = [x | y | z], with :math:`g = P x + q + A^T y + G^T z`: the rows
  :math:`x - \Pi_{[lb,\,ub]}(x - g)` and :math:`[z + G x - h]_+ - z`;
* ``"smooth"``, s = [x | y | w], where bounds are rows too, :math:`C = [G; I; -I]`,
  :math:`d = [h; ub; -lb]`: the rows g (with :math:`C^T w`) and, with the slack
  :math:`\sigma = d - C x`, the perturbed Fischer-Burmeister function
  :math:`w + \sigma - \sqrt{w^2 + \sigma^2 + \varepsilon^2}`, which vanishes exactly where both are
  positive with :math:`w\,\sigma = \varepsilon^2/2`.

Source of the second: C. Kanzow, "Some noninterior continuation methods for linear complementarity
problems", SIAM Journal on Matrix Analysis and Applications 17 (1996).
"""

from typing import Literal

import numpy as np

from iiwa_dnn.qp.dense import add_row, row_dot
from iiwa_dnn.qp.layout import (
    Matrix,
    QPViews,
    Sizes,
    Vector,
    check_size,
    compiled,
    qp_views,
)
from iiwa_dnn.qp.program import QP

Form = Literal["projected", "smooth"]
FORMS: tuple[Form, ...] = ("projected", "smooth")

EPSILON = 1e-6
"""Perturbation of the smooth form, in the unit of multipliers and slacks."""

REGULAR = 1e-10
"""Entry of the rows' diagonal that keeps the matrix regular where rows are dependent."""


def system_size(qp: QP, form: Form) -> int:
    """Count the unknowns of a form."""
    n, m, p = qp.sizes
    return n + p + m + (2 * n if form == "smooth" else 0)


class KktSystem:
    """The system of one program.

    Attributes:
        qp: The program.
        size: Number of unknowns.
        matrix: Derivative of the residual at the last point, (size, size).
    """

    matrix: Matrix

    def __init__(self, qp: QP, form: Form, rate: QP | None = None) -> None:
        """Take a program and, where it moves, its rate of change (zero where it is infinite)."""
        self._form = form
        self.size = system_size(qp, form)
        self.qp = qp
        self._rate: Vector = np.zeros(qp.data.size) if rate is None else rate.data

    def evaluate(self, s: Vector) -> tuple[Vector, Vector]:
        """Compute the residual at a point, and its drift: its rate at a point that stays.

        Args:
            s: The point, (size,).

        Returns:
            Residual and drift, (size,) both; `matrix` becomes the residual's derivative.
        """
        check_size("state", s, self.size)
        error = np.empty(self.size)
        drift = np.empty(self.size)
        self.matrix = np.zeros((self.size, self.size))
        evaluate(self.qp.data, self._rate, self.qp.sizes, s, error, drift, self.matrix)
        return error, drift


@compiled
def evaluate(
    data: Vector,
    rate: Vector,
    sizes: Sizes,
    s: Vector,
    error: Vector,
    drift: Vector,
    matrix: Matrix,
) -> None:
    """Write residual, drift (size,) and derivative (size, size), all zero before, at s (size,).

    The program and its rate are `QP.data`, of sizes (n, m, p); with n + p + m unknowns the form is
    the projected one, with 2 n more the smooth one.
    """
    n, m, p = sizes
    qp = qp_views(data, n, m, p)
    change = qp_views(rate, n, m, p)
    for i in range(n):
        error[i] = qp.q[i] + row_dot(qp.P, i, s)
        drift[i] = change.q[i] + row_dot(change.P, i, s)
        matrix[i, :n] = qp.P[i]
    for j in range(p):
        _put_row(qp.A, change.A, j, n + j, s, error, drift, matrix)
        error[n + j] -= qp.b[j]
        drift[n + j] -= change.b[j]
    for j in range(m):
        _put_row(qp.G, change.G, j, n + p + j, s, error, drift, matrix)
        error[n + p + j] -= qp.h[j]
        drift[n + p + j] -= change.h[j]
    if s.size > n + m + p:
        _put_bounds(qp, change, n + p + m, s, error, drift, matrix)
        for row in range(n + p, s.size):
            _smooth(row, n, s, error, drift, matrix)
        return
    for row in range(n + p, s.size):
        if not s[row] + error[row] > 0.0:
            _replace(row, -s[row], 0.0, -1.0, error, drift, matrix)
    for i in range(n):
        aim = s[i] - error[i]
        if aim <= qp.lb[i]:
            _replace(i, s[i] - qp.lb[i], -change.lb[i], 1.0, error, drift, matrix)
        if aim >= qp.ub[i]:
            _replace(i, s[i] - qp.ub[i], -change.ub[i], 1.0, error, drift, matrix)


@compiled
def _put_row(
    rows: Matrix,
    moved: Matrix,
    j: int,
    at: int,
    s: Vector,
    error: Vector,
    drift: Vector,
    matrix: Matrix,
) -> None:
    """Put row j of rows (k, n) that move at a rate (k, n) at a place, and take it to the gradient.

    Arrays are those of `evaluate`, (size,) and (size, size).
    """
    n = rows.shape[1]
    error[at] = row_dot(rows, j, s)
    drift[at] = row_dot(moved, j, s)
    add_row(error, s[at], rows, j)
    add_row(drift, s[at], moved, j)
    matrix[at, :n] = rows[j]
    matrix[:n, at] = rows[j]
    matrix[at, at] = -REGULAR


@compiled
def _put_bounds(
    qp: QPViews,
    change: QPViews,
    at: int,
    s: Vector,
    error: Vector,
    drift: Vector,
    matrix: Matrix,
) -> None:
    """Put the rows x - ub and lb - x; arrays of `evaluate`, (size,) and (size, size)."""
    n = qp.q.size
    for i in range(n):
        upper = at + i
        lower = at + n + i
        error[i] += s[upper] - s[lower]
        matrix[i, upper] = 1.0
        matrix[upper, i] = 1.0
        matrix[i, lower] = -1.0
        matrix[lower, i] = -1.0
        error[upper] = s[i] - qp.ub[i]
        error[lower] = qp.lb[i] - s[i]
        drift[upper] = -change.ub[i]
        drift[lower] = change.lb[i]


@compiled
def _smooth(row: int, n: int, s: Vector, error: Vector, drift: Vector, matrix: Matrix) -> None:
    """Put the complementarity in place of a row of C x - d; arrays (size,), (size, size)."""
    w = s[row]
    if not np.isfinite(error[row]):
        matrix[row, :n] = 0.0
        error[row] = w
        drift[row] = 0.0
        matrix[row, row] = 1.0
        return
    slack = -error[row]
    root = np.sqrt(w**2 + slack**2 + EPSILON**2)
    error[row] = w + slack - root
    drift[row] *= slack / root - 1.0
    matrix[row, :n] *= slack / root - 1.0
    matrix[row, row] = 1.0 - w / root


@compiled
def _replace(
    row: int,
    value: float,
    moved: float,
    slope: float,
    error: Vector,
    drift: Vector,
    matrix: Matrix,
) -> None:
    """Put a projection on a bound in place of a row; arrays (size,) and (size, size)."""
    error[row] = value
    drift[row] = moved
    matrix[row] = 0.0
    matrix[row, row] = slope
