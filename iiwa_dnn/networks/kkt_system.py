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

from __future__ import annotations

from typing import Literal

import numpy as np

from iiwa_dnn.qp.layout import Matrix, Vector, check_size
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
        self._form, self.size, self._n = form, system_size(qp, form), qp.sizes[0]
        self.qp, self._rows, self._right = qp, *_rows(qp, form, 1.0)
        self._rate = None if rate is None else (rate, *_rows(rate, form, 0.0))
        n, p = self._n, qp.b.size
        self._base = np.zeros((self.size, self.size))
        self._base[:n, :n], self._base[:n, n : n + p], self._base[n : n + p, :n] = (
            qp.P, qp.A.T, qp.A
        )  # fmt: skip
        self._base[:n, n + p :] = self._rows.T
        at = np.arange(n, n + p)
        self._base[at, at] = -REGULAR

    def evaluate(self, s: Vector) -> tuple[Vector, Vector]:
        """Compute the residual at a point, and its drift: its rate at a point that stays.

        Args:
            s: The point, (size,).

        Returns:
            Residual and drift, (size,) both; `matrix` becomes the residual's derivative.
        """
        check_size("state", s, self.size)
        n, p = self._n, self.qp.b.size
        x, w = s[:n], s[n + p :]
        self.matrix = matrix = self._base.copy()
        error: Vector = np.concatenate([self.qp.q, np.zeros(self.size - n)]) + matrix @ s
        error[n : n + p] = self.qp.A @ x - self.qp.b
        drift: Vector = np.zeros(self.size)
        moved: Vector = np.zeros(self._right.size)
        if self._rate is not None:
            rate, rows, right = self._rate
            drift[:n] = rate.P @ x + rate.q + rate.A.T @ s[n : n + p] + rows.T @ w
            drift[n : n + p] = rate.A @ x - rate.b
            moved = rows @ x - right
        over = self._rows @ x - self._right
        if self._form == "smooth":
            self._smooth(matrix, error, drift, w, over, moved)
        else:
            self._projected(matrix, error, drift, x, w, over, moved)
        return error, drift

    def _smooth(
        self, matrix: Matrix, error: Vector, drift: Vector, w: Vector, over: Vector, moved: Vector
    ) -> None:
        at = np.arange(self.size - w.size, self.size)
        ends = np.isfinite(over)
        slack = np.where(ends, -over, 0.0)
        root = np.sqrt(w**2 + slack**2 + EPSILON**2)
        error[at] = np.where(ends, w + slack - root, w)
        share = np.where(ends, 1.0 - slack / root, 0.0)
        matrix[at, : self._n] = -share[:, None] * self._rows
        matrix[at, at] = np.where(ends, 1.0 - w / root, 1.0)
        drift[at] = -share * moved

    def _projected(
        self, matrix: Matrix, error: Vector, drift: Vector, x: Vector, w: Vector, over: Vector,
        moved: Vector,
    ) -> None:  # fmt: skip
        n, qp = self._n, self.qp
        aim = x - error[:n]
        for name, at in ("lb", aim <= qp.lb), ("ub", aim >= qp.ub):
            out = np.flatnonzero(at)
            error[out] = x[out] - getattr(qp, name)[out]
            matrix[out], matrix[out, out] = 0.0, 1.0
            drift[out] = 0.0 if self._rate is None else -getattr(self._rate[0], name)[out]
        rows = np.arange(self.size - w.size, self.size)
        active = w + over > 0.0
        error[rows] = np.where(active, over, -w)
        matrix[rows, :n] = np.where(active[:, None], self._rows, 0.0)
        matrix[rows, rows] = np.where(active, -REGULAR, -1.0)
        drift[rows] = np.where(active, moved, 0.0)


def _rows(qp: QP, form: Form, unit: float) -> tuple[Matrix, Vector]:
    """Stack the inequality rows of a form; `unit` is 0 for a rate, whose bounds' rows stay."""
    if form == "projected":
        return qp.G, qp.h
    eye = unit * np.eye(qp.q.size)
    return np.vstack([qp.G, eye, -eye]), np.concatenate([qp.h, qp.ub, -qp.lb])
