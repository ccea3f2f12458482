r"""Residual of the KKT conditions as a system of equations, for the networks that remove it.

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

from typing import Literal, NamedTuple

import numpy as np

from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.program import QP

Form = Literal["projected", "smooth"]

EPSILON = 1e-6
"""Perturbation of the smooth form, in the unit of multipliers and slacks."""

REGULAR = 1e-10
"""Entry of the rows' diagonal that keeps the matrix regular where rows are dependent."""


def system_size(qp: QP, form: Form) -> int:
    """Count the unknowns of a form."""
    n, m, p = qp.sizes
    return n + p + m + (2 * n if form == "smooth" else 0)


class KktResidual(NamedTuple):
    """The system at one point.

    Attributes:
        error: Residual E, (size,).
        drift: Its rate at a point that stays, (size,).
        matrix: Its derivative in s, (size, size).
    """

    error: Vector
    drift: Vector
    matrix: Matrix


def evaluate(qp: QP, form: Form, s: Vector, rate: QP | None = None) -> KktResidual:
    """Compute the residual at a point s (size,), its drift and its derivative.

    `rate` is the program's rate of change, zero where a field is infinite; None for one that does
    not change.
    """
    if rate is None:
        rate = QP.from_data(np.zeros(qp.data.size), qp.sizes)
    n, _, p = qp.sizes
    matrix, offset = _linear_part(qp, form, 1.0)
    moving, moved = _linear_part(rate, form, 0.0)
    system = KktResidual(matrix @ s + offset, moving @ s + moved, matrix)
    matrix[range(n, s.size), range(n, s.size)] = -REGULAR
    if form == "smooth":
        _smooth(system, s, n + p)
    else:
        _project(system, s, qp, rate)
    return system


def _smooth(system: KktResidual, s: Vector, first: int) -> None:
    """Replace the rows of C x - d, from row `first` on, by the Fischer-Burmeister function."""
    error, drift, matrix = system
    rows = np.arange(first, s.size)
    limited = np.isfinite(error[rows])
    w = s[rows]
    slack = np.where(limited, -error[rows], 0.0)
    root = np.sqrt(w**2 + slack**2 + EPSILON**2)
    slope = np.where(limited, slack / root - 1.0, 0.0)
    error[rows] = np.where(limited, w + slack - root, w)
    drift[rows] *= slope
    matrix[rows] *= slope[:, np.newaxis]
    matrix[rows, rows] = np.where(limited, 1.0 - w / root, 1.0)


def _project(system: KktResidual, s: Vector, qp: QP, rate: QP) -> None:
    """Replace rows of variables at a bound, and rows whose multiplier decays, by projections."""
    error, drift, matrix = system
    n, _, p = qp.sizes
    eye = np.eye(s.size)
    aim = s[:n] - error[:n]
    idle = n + p + np.flatnonzero(~(s[n + p :] + error[n + p :] > 0.0))
    for reached, bound, moved in (
        (aim <= qp.lb, qp.lb, rate.lb),
        (aim >= qp.ub, qp.ub, rate.ub),
    ):
        at = np.flatnonzero(reached)
        error[at] = s[at] - bound[at]
        drift[at] = -moved[at]
        matrix[at] = eye[at]
    error[idle] = -s[idle]
    drift[idle] = 0.0
    matrix[idle] = -eye[idle]


def _linear_part(qp: QP, form: Form, unit: float) -> tuple[Matrix, Vector]:
    """Return matrix (size, size) and constant (size,) of the system without complementarity.

    In the smooth form the rows of the bounds are plus and minus `unit` times the identity: 1 for a
    program, 0 for its rate of change.
    """
    eye = unit * np.eye(qp.q.size)
    smooth = form == "smooth"
    rows = np.vstack([qp.A, qp.G, eye, -eye] if smooth else [qp.A, qp.G])
    limits = [-qp.b, -qp.h, -qp.ub, qp.lb] if smooth else [-qp.b, -qp.h]
    matrix = np.block([[qp.P, rows.T], [rows, np.zeros((len(rows), len(rows)))]])
    return matrix, np.concatenate([qp.q, *limits])
