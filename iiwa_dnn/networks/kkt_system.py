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
        self._form = form
        self.size = system_size(qp, form)
        self.qp = qp
        self._rate = rate
        self._affine = _affine(qp, form, 1.0)
        self._drift = None if rate is None else _affine(rate, form, 0.0)

    def evaluate(self, s: Vector) -> tuple[Vector, Vector]:
        """Compute the residual at a point, and its drift: its rate at a point that stays.

        Args:
            s: The point, (size,).

        Returns:
            Residual and drift, (size,) both; `matrix` becomes the residual's derivative.
        """
        check_size("state", s, self.size)
        n, _, p = self.qp.sizes
        base, constant = self._affine
        error: Vector = base @ s + constant
        drift: Vector = np.zeros(self.size)
        if self._drift is not None:
            moved, shifted = self._drift
            drift = moved @ s + shifted
        self.matrix = base.copy()
        np.einsum("ii->i", self.matrix)[n : n + p] = -REGULAR
        (self._smooth if self._form == "smooth" else self._projected)(s, error, drift)
        return error, drift

    def _smooth(self, s: Vector, error: Vector, drift: Vector) -> None:
        """Put the complementarity in place of the rows C x - d."""
        n, _, p = self.qp.sizes
        at = np.arange(n + p, self.size)
        w = s[n + p :]
        ends = np.isfinite(error[at])
        slack = np.where(ends, -error[at], 0.0)
        root = np.sqrt(w**2 + slack**2 + EPSILON**2)
        error[at] = np.where(ends, w + slack - root, w)
        share = np.where(ends, 1.0 - slack / root, 0.0)
        self.matrix[at, :n] *= -share[:, None]
        self.matrix[at, at] = np.where(ends, 1.0 - w / root, 1.0)
        drift[at] *= -share

    def _projected(self, s: Vector, error: Vector, drift: Vector) -> None:
        """Put the projections in place of the rows g and G x - h."""
        n, m, p = self.qp.sizes
        qp = self.qp
        matrix = self.matrix
        rate = self._rate
        x = s[:n]
        aim = x - error[:n]
        for name, bound in ("lb", qp.lb), ("ub", qp.ub):
            out = np.flatnonzero(aim <= bound if name == "lb" else aim >= bound)
            if out.size:
                error[out] = x[out] - bound[out]
                matrix[out] = 0.0
                matrix[out, out] = 1.0
                drift[out] = 0.0 if rate is None else -getattr(rate, name)[out]
        if m:
            rows = np.arange(n + p, self.size)
            z = s[n + p :]
            idle = ~(z + error[rows] > 0.0)
            error[rows] = np.where(idle, -z, error[rows])
            matrix[rows[idle], :n] = 0.0
            drift[rows[idle]] = 0.0
            matrix[rows, rows] = np.where(idle, -1.0, -REGULAR)


def _affine(qp: QP, form: Form, unit: float) -> tuple[Matrix, Vector]:
    """Stack gradient and rows, A x - b and C x - d, as a matrix and a constant.

    `unit` is 0 for a rate of change: the rows of the bounds stay.
    """
    n = qp.q.size
    matrix = np.zeros((system_size(qp, form),) * 2)
    rows = [qp.A, qp.G]
    constant = [qp.q, -qp.b, -qp.h]
    if form == "smooth":
        rows += [unit * np.eye(n), -unit * np.eye(n)]
        constant += [-qp.ub, qp.lb]
    stacked = np.vstack(rows)
    matrix[:n, :n] = qp.P
    matrix[:n, n:] = stacked.T
    matrix[n:, :n] = stacked
    return matrix, np.concatenate(constant)
