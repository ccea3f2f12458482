r"""Growth of an error in explicit steps of the network.

On a fixed active set the network is linear, :math:`\rho\,\dot s = M (s - s^*)`. With no bound
active, x and the equalities' multipliers move by

.. math::  M = \begin{pmatrix} -P & -A^T \\ A & 0 \end{pmatrix}

and every other multiplier decays by itself. An explicit Euler step of length h multiplies the
error along an eigenvector by :math:`1 + h\lambda`. For P = I each singular value :math:`\sigma` of
A gives :math:`\lambda = -\tfrac12 \pm \sqrt{\tfrac14 - \sigma^2}`, and the step is stable while
:math:`h\,\sigma^2 < 1` (docs/theory.md).
"""

from __future__ import annotations

import numpy as np

from iiwa_dnn.qp.program import QP, Matrix


def network_matrix(qp: QP) -> Matrix:
    """Build M for a program with n variables, p equalities and no bound active: (n + p, n + p)."""
    p = qp.b.size
    return np.block([[-qp.P, -qp.A.T], [qp.A, np.zeros((p, p))]])


def amplification(qp: QP, step: float) -> float:
    r"""Compute the largest growth of an error in one explicit Euler step, no bound being active.

    Args:
        qp: The program.
        step: Length of the step, in units of rho.

    Returns:
        The largest :math:`|1 + h \lambda|`: above 1, the step is unstable. Eigenvalues at zero,
        which belong to dependent equalities and to no error in x, are left out.
    """
    eigenvalues = np.linalg.eigvals(network_matrix(qp))
    moving = eigenvalues[np.abs(eigenvalues) > 1e-9]
    return float(np.abs(1.0 + step * moving).max(initial=0.0))
