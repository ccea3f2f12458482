r"""Strict priorities: a cascade of programs, each settled by the network.

Tasks of priority 1, 2, ... may contradict each other or the limits. Level k is carried out as well
as the levels above and all limits let it be:

.. math::

    x_k = \arg\min_x \tfrac12 \|A_k x - b_k\|^2 \quad \text{with} \quad
    A_i x = A_i x_i \;(i < k), \quad A_0 x = b_0, \quad G x \le h, \quad lb \le x \le ub

:math:`A_0` being the rows of tasks without a priority. The step's own program then minimises the
scheme's cost with :math:`A_k x = A_k x_k` for every level. :math:`x_k` need not be unique, but
:math:`A_k x_k` is.

Source: O. Kanoun, F. Lamiraux, P.-B. Wieber, "Kinematic control of redundant manipulators:
generalizing the task-priority framework to inequality task", IEEE Trans. Robotics 27 (2011).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.layout import Sizes

FINEST = 1e-12
"""Tolerance that a level aims at: a lower one may amplify its error by its multipliers. The step's
own tolerance is what it has to reach."""


@dataclass(frozen=True)
class Level:
    """Last program and answer of one level.

    Attributes:
        priority: Number of the level, from 1.
        rows: Which rows of A are the level's, (p,), and which are those above, (p,).
        sizes: ``(n, m, p)`` of its programs.
        solver: The network that settles them, with its own warm start.
        data: The program, `QP.data`, (size,).
        x: Its answer, (n,).
        missing: What the answer lacks, b - A x of its own rows, (rows,).
    """

    priority: int
    rows: tuple[NDArray[np.bool_], NDArray[np.bool_]]
    sizes: Sizes
    solver: DNNSolver
    data: Vector
    x: Vector
    missing: Vector


class Cascade:
    """Levels of a scheme whose tasks have priorities.

    Attributes:
        levels: The levels, first to last; none where no task has a priority.
    """

    def __init__(self, priorities: NDArray[np.int64], sizes: Sizes, solver: DNNSolver) -> None:
        """Lay the levels out; `priorities` (p,) is each equality row's, 0 for none."""
        self.levels: list[Level] = []
        self._tol = solver.tol
        n, m, _ = sizes
        for priority in sorted(set(priorities.tolist()) - {0}):
            own, above = priorities == priority, priorities < priority
            p = int(above.sum())
            data, x = np.zeros((n + m + p) * (n + 1) + 2 * n), np.zeros(n)
            network = DNNSolver(solver.network, FINEST, solver.settler)
            self.levels.append(
                Level(priority, (own, above), (n, m, p), network, data, x, np.zeros(own.sum()))
            )

    def resolve(self, qp: QP) -> None:
        """Replace the rows A x = b of a program, level by level, by what can be attained.

        They become rows of the same meaning and length one, as many as are independent, and zeros.
        """
        A = b = None
        for level in self.levels:
            own, above = level.rows
            if A is None or b is None:
                A, b = qp.A[above], qp.b[above]
            program = QP.from_data(level.data, level.sizes)
            program.P[:], program.q[:] = qp.A[own].T @ qp.A[own], -qp.A[own].T @ qp.b[own]
            program.G[:], program.h[:], program.lb[:], program.ub[:] = qp.G, qp.h, qp.lb, qp.ub
            program.A[:], program.b[:] = A, b
            solution = level.solver.solve(program)
            level.x[:] = x = solution.x
            level.missing[:] = qp.b[own] - qp.A[own] @ x
            if not solution.residuals.largest <= self._tol:  # nor has the step: the policy decides
                return
            A = _independent(qp.A[own | above])
            b = A @ x
        if A is not None and b is not None:
            qp.A[:], qp.b[:] = A, b


def _independent(A: Matrix) -> Matrix:
    """Return orthonormal rows that span those of A (p, n), and zero rows, (p, n)."""
    _, sizes, directions = np.linalg.svd(A, full_matrices=False)
    count = int((sizes > 1e-9 * max(1.0, sizes[0])).sum())
    rows = np.zeros_like(A)
    rows[:count] = directions[:count]
    return rows
