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
        self.qp = qp
        self.size = system_size(qp, form)
        self._form = form
        self._rate = QP.from_data(np.zeros(qp.data.size), qp.sizes) if rate is None else rate
        self._linear, self._offset = _linear_part(qp, form, 1.0)
        self._moving, self._moved = _linear_part(self._rate, form, 0.0)

    def evaluate(self, s: Vector) -> tuple[Vector, Vector]:
        """Compute the residual at a point, and its drift: its rate at a point that stays.

        Args:
            s: The point, (size,).

        Returns:
            Residual and drift, (size,) both; `matrix` becomes the residual's derivative.
        """
        check_size("state", s, self.size)
        n = self.qp.q.size
        error = self._linear @ s + self._offset
        drift = self._moving @ s + self._moved
        self.matrix = self._linear.copy()
        self.matrix[range(n, s.size), range(n, s.size)] = -REGULAR
        if self._form == "smooth":
            self._smooth(s, error, drift)
        else:
            self._project(s, error, drift)
        return error, drift

    def _smooth(self, s: Vector, error: Vector, drift: Vector) -> None:
        """Put the complementarity in place of the rows of C x - d; arrays (size,)."""
        n, _, p = self.qp.sizes
        rows = np.arange(n + p, s.size)
        limited = np.isfinite(error[rows])
        w = s[rows]
        slack = np.where(limited, -error[rows], 0.0)
        root = np.sqrt(w**2 + slack**2 + EPSILON**2)
        slope = np.where(limited, slack / root - 1.0, 0.0)
        error[rows] = np.where(limited, w + slack - root, w)
        drift[rows] *= slope
        self.matrix[rows] *= slope[:, np.newaxis]
        self.matrix[rows, rows] = np.where(limited, 1.0 - w / root, 1.0)

    def _project(self, s: Vector, error: Vector, drift: Vector) -> None:
        """Put projections in place of rows at a bound and of idle rows; arrays (size,)."""
        n, m, p = self.qp.sizes
        x = s[:n]
        z = s[n + p :]
        at_lower = x - error[:n] <= self.qp.lb
        at_upper = x - error[:n] >= self.qp.ub
        idle = ~(z + error[n + p :] > 0.0)
        for at_bound, bound, rate in (
            (at_lower, self.qp.lb, self._rate.lb),
            (at_upper, self.qp.ub, self._rate.ub),
        ):
            error[:n] = np.where(at_bound, x - bound, error[:n])
            drift[:n] = np.where(at_bound, -rate, drift[:n])
        error[n + p :] = np.where(idle, -z, error[n + p :])
        drift[n + p :] = np.where(idle, 0.0, drift[n + p :])
        replaced = np.concatenate([at_lower | at_upper, np.zeros(p, dtype=bool), idle])
        slopes = np.diag(np.concatenate([np.ones(n + p), -np.ones(m)]))
        self.matrix[replaced] = slopes[replaced]


def _linear_part(qp: QP, form: Form, unit: float) -> tuple[Matrix, Vector]:
    """Return matrix (size, size) and constant (size,) of the system without complementarity.

    The rows of the smooth form's bounds are plus and minus the `unit` times the identity.
    """
    eye = unit * np.eye(qp.q.size)
    smooth = form == "smooth"
    rows = np.vstack([qp.A, qp.G, eye, -eye] if smooth else [qp.A, qp.G])
    limits = [-qp.b, -qp.h, -qp.ub, qp.lb] if smooth else [-qp.b, -qp.h]
    matrix = np.block([[qp.P, rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    return matrix, np.concatenate([qp.q, *limits])
