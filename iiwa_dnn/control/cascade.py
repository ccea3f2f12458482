r"""Strict priorities: a cascade of programs, each settled by the network.

Tasks of priority 1, 2, ... may contradict each other or the limits. Level k is carried out as well
as the levels above and all limits let it be:

.. math::

    x_k = \arg\min_x \tfrac12 \|A_k x - b_k\|^2 \quad \text{with} \quad
    A_i x = A_i x_i \;(i < k), \quad A_0 x = b_0, \quad G x \le h, \quad lb \le x \le ub

:math:`A_0` being the rows of tasks without a priority. The step's own program then minimises the
scheme's cost with :math:`A_k x = A_k x_k` for every level. :math:`x_k` need not be unique, but
:math:`A_k x_k` is. Limits that have a multiplier in some level are equalities for those below, and
the rows of a level are projected on what the levels above leave free: that keeps every program well
conditioned, in singular poses too.

Sources: O. Kanoun, F. Lamiraux, P.-B. Wieber, "Kinematic control of redundant manipulators:
generalizing the task-priority framework to inequality task", IEEE Trans. Robotics 27 (2011);
A. Escande, N. Mansard, P.-B. Wieber, "Hierarchical quadratic programming: fast online
humanoid-robot motion generation", Int. J. Robotics Research 33 (2014).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.layout import Sizes

FINEST = 1e-12
"""Tolerance that a level aims at: a lower one may amplify its error by its multipliers. The step's
own tolerance is what it has to reach."""

SMALLEST = 1e-9
"""Singular value of a level's rows below which their direction is left to the levels below [1]."""

HELD = 1e-11
"""Multiplier above which a limit holds for all levels below."""


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
            own = priorities == priority
            above = priorities < priority
            p = int(above.sum())
            p = min(n, p + m) if self.levels else p
            data = np.zeros((n + m + p) * (n + 1) + 2 * n)
            x = np.zeros(n)
            network = DNNSolver(solver.network, FINEST, solver.settler)
            self.levels.append(
                Level(priority, (own, above), (n, m, p), network, data, x, np.zeros(own.sum()))
            )

    def resolve(self, qp: QP) -> None:
        """Replace the rows A x = b of a program, level by level, by what can be attained.

        They become rows of the same meaning and length one, as many as are independent, and zeros.
        A bound with a multiplier in some level becomes an equality, lb = ub, and an inequality row
        a row of A: levels below cannot leave it. Otherwise a single face would be all that is left
        to them, and rounding would decide whether a point is on it.
        """
        lb = qp.lb.copy()
        ub = qp.ub.copy()
        x: Vector = np.zeros(qp.q.size)
        held = np.zeros(qp.h.size, dtype=bool)
        freedom = np.eye(x.size)
        for level in self.levels:
            own, above = level.rows
            program = QP.from_data(level.data, level.sizes)
            if level is self.levels[0]:
                program.A[:] = qp.A[above]
                program.b[:] = qp.b[above]
            else:
                rows = np.where(lb < ub, np.concatenate([qp.A[above], qp.G[held]]), 0.0)
                _independent(rows, program.A)
                program.b[:] = program.A @ x
                freedom = np.diag(1.0 * (lb < ub)) - program.A.T @ program.A
            left, sizes, right = _decomposed(qp.A[own] @ freedom)
            E = left * sizes @ right
            program.P[:] = E.T @ E
            program.q[:] = -E.T @ (qp.b[own] - qp.A[own] @ x + E @ x)
            program.G[:] = qp.G
            program.h[:] = qp.h
            program.lb[:] = lb
            program.ub[:] = ub
            solution = level.solver.solve(program)
            level.x[:] = x = solution.x
            level.missing[:] = qp.b[own] - qp.A[own] @ x
            if not solution.residuals.largest <= self._tol:  # nor has the step: the policy decides
                return
            bound = np.abs(solution.z_box) > HELD
            lb[bound] = ub[bound] = x[bound]
            held |= solution.z > HELD
        if self.levels:
            qp.lb[:] = lb
            qp.ub[:] = ub
            _independent(np.where(lb < ub, qp.A, 0.0), qp.A)
            qp.b[:] = qp.A @ x


def _decomposed(A: Matrix) -> tuple[Matrix, Vector, Matrix]:
    """Decompose A (p, n) into singular vectors and values, without the smallest of them."""
    left, sizes, right = np.linalg.svd(A, full_matrices=False)
    count = int((sizes > SMALLEST).sum())
    return left[:, :count], sizes[:count], right[:count]


def _independent(A: Matrix, out: Matrix) -> None:
    """Write orthonormal rows that span those of A (p, n), and zero rows, into `out`."""
    directions = _decomposed(A)[2]
    out[:] = 0.0
    out[: len(directions)] = directions
