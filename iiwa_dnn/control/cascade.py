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
from iiwa_dnn.qp import QP, Vector
from iiwa_dnn.qp.layout import Sizes


@dataclass(frozen=True)
class Level:
    """Last program and answer of one level.

    Attributes:
        priority: Number of the level, from 1.
        rows: Which rows of A are the level's, (p,), and which are those above, (p,).
        sizes: ``(n, m, p)`` of its programs.
        solver: The network that settles them, with its own warm start.
        data: The program, `QP.data`.
        x: Its answer, (n,).
    """

    priority: int
    rows: tuple[NDArray[np.bool_], NDArray[np.bool_]]
    sizes: Sizes
    solver: DNNSolver
    data: Vector
    x: Vector


class Cascade:
    """Levels of a scheme whose tasks have priorities.

    Attributes:
        levels: The levels, first to last; none where no task has a priority.
    """

    def __init__(self, priorities: NDArray[np.int64], sizes: Sizes, solver: DNNSolver) -> None:
        """Lay the levels out; `priorities` (p,) is each equality row's, 0 for none."""
        self.levels: list[Level] = []
        n, m, _ = sizes
        for priority in sorted(set(priorities.tolist()) - {0}):
            own, above = priorities == priority, priorities < priority
            p = int(above.sum())
            data, x = np.zeros((n + m + p) * (n + 1) + 2 * n), np.zeros(n)
            network = DNNSolver(solver.network, solver.tol, solver.settler)
            self.levels.append(Level(priority, (own, above), (n, m, p), network, data, x))

    def resolve(self, qp: QP) -> None:
        """Replace b of a program, level by level, by what can be attained."""
        for level in self.levels:
            own, above = level.rows
            A, b = qp.A[own], qp.b[own]
            program = QP.from_data(level.data, level.sizes)
            program.P[:], program.q[:] = A.T @ A, -A.T @ b
            program.G[:], program.h[:], program.lb[:], program.ub[:] = qp.G, qp.h, qp.lb, qp.ub
            program.A[:], program.b[:] = qp.A[above], qp.b[above]
            solution = level.solver.solve(program)
            level.x[:] = solution.x
            # Without a solution there is none of the step either, and the policy decides.
            if solution.found:
                qp.b[own] = A @ solution.x
