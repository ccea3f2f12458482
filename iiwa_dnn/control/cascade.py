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

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.networks.integrators.base import ANSWER, enter_answer
from iiwa_dnn.networks.integrators.implicit import ImplicitEuler, settle
from iiwa_dnn.qp import QP, Matrix, Vector
from iiwa_dnn.qp.dense import row_dot
from iiwa_dnn.qp.layout import QPViews, Sizes, compiled, qp_views
from iiwa_dnn.qp.residuals import within

FINEST = 1e-12
"""Tolerance that a level aims at: a lower one may amplify its error by its multipliers. The step's
own tolerance is what it has to reach."""

BUDGET = 400
"""Linear systems of a try, at most; far from singular poses it takes about ten."""

SCALE = 2.0**14
"""Factor of a level's cost in a second try: near a singular pose the cost is as flat as the square
of a small singular value, and a step of the network has to be long beside that."""

SMALLEST = 1e-9
"""Length of what the levels above leave of a row below which it is left to the levels below [1]."""

HELD = 1e-11
"""Multiplier above which a limit holds for all levels below."""


class Priorities(NamedTuple):
    """Numbers and rows of the levels, and their programs and answers, overwritten.

    Attributes:
        numbers: Number of each level, (levels,), ascending, from 1.
        rows: That of each equality row, 0 for none, (p,).
        data: Program of each level, `QP.data`, (levels, size); of n variables, m inequality and
            `held_rows` equality rows.
        x: Its answer, (levels, n).
        missing: What the answer lacks, b - A x, (levels, p); zero for the rows of other levels.
        settings: Constants with which the network settles, ``[tol, budget, long step]``, (3,).
        tol: The step's own tolerance.
        answer: Address of the function that settles the network, `ANSWER`.
    """

    numbers: Vector
    rows: Vector
    data: Matrix
    x: Matrix
    missing: Matrix
    settings: Vector
    tol: float
    answer: int


@dataclass(frozen=True)
class Level:
    """Last program and answer of one level.

    Attributes:
        priority: Number of the level, from 1.
        own: Which rows of A are the level's, (p,).
        sizes: ``(n, m, p)`` of its programs.
        data: The program, `QP.data`, (size,).
        x: Its answer, (n,).
        missing: What the answer lacks, b - A x, (p,); zero for the rows of other levels.
    """

    priority: int
    own: NDArray[np.bool_]
    sizes: Sizes
    data: Vector
    x: Vector
    missing: Vector


class Cascade:
    """Levels of a scheme whose tasks have priorities.

    Attributes:
        priorities: What compiled code needs of them.
        levels: The levels, first to last; none where no task has a priority.
    """

    def __init__(self, rows: NDArray[np.int64], sizes: Sizes, tol: float) -> None:
        """Lay the levels out.

        Args:
            rows: Priority of each equality row, (p,), 0 for none.
            sizes: ``(n, m, p)`` of the step's programs.
            tol: Tolerance of their residuals.
        """
        numbers = np.unique(rows[rows > 0])
        n, m, p = sizes
        count = len(numbers)
        own_sizes = (n, m, held_rows(n, m, p))
        self.priorities = Priorities(
            numbers.astype(np.float64),
            rows.astype(np.float64),
            np.zeros((count, sum(own_sizes) * (n + 1) + 2 * n)),
            np.zeros((count, n)),
            np.zeros((count, p)),
            np.array([FINEST, BUDGET, ImplicitEuler().long_step]),
            tol,
            ANSWER.address(settle) if count else 0,
        )
        self.levels = [
            Level(number, rows == number, own_sizes, *arrays)
            for number, *arrays in zip(numbers.tolist(), *self.priorities[2:5], strict=True)
        ]

    def resolve(self, qp: QP) -> bool:
        """Replace the rows A x = b of a program by what can be attained (`resolve`)."""
        if not self.levels:
            return True
        return bool(resolve_program(qp.data, *qp.sizes, self.priorities))


@compiled
def held_rows(n: int, m: int, p: int) -> int:
    """Count the equality rows of a level's programs, of which those that are not needed are 0."""
    return min(n, p + m)


@compiled
def resolve_program(data: Vector, n: int, m: int, p: int, priorities: Priorities) -> bool:
    """Do what `resolve` does to a program `QP.data` (size,) of these sizes."""
    return resolve(qp_views(data, n, m, p), priorities)


@compiled
def resolve(qp: QPViews, priorities: Priorities) -> bool:
    """Replace the rows A x = b of a program, level by level, by what can be attained.

    They become rows of the same meaning and length one, as many as are independent, and zeros.
    A bound with a multiplier in some level becomes an equality, lb = ub, and an inequality row
    a row of A: levels below cannot leave it. Otherwise a single face would be all that is left
    to them, and rounding would decide whether a point is on it.

    Args:
        qp: The program, overwritten.
        priorities: The levels, whose programs and answers are overwritten.

    Returns:
        False if a level has no answer; the rows stay as they were then.
    """
    n = qp.q.size
    m = qp.h.size
    p = held_rows(n, m, qp.b.size)
    lb = qp.lb.copy()
    ub = qp.ub.copy()
    held = np.zeros(m)
    x = np.zeros(n)
    state = np.empty(3 * n + m + p)
    point = np.empty(2 * n + m + p)
    for k in range(priorities.numbers.size):
        program = qp_views(priorities.data[k], n, m, p)
        _write_limits(qp, lb, ub, program)
        _write_held(qp, priorities, k, held, x, program)
        _write_cost(qp, priorities, k, x, program)
        settled = _settled(program, priorities, 1.0, FINEST, state, point)
        if not settled:
            settled = _settled(program, priorities, SCALE, priorities.tol, state, point)
        _note_answer(qp, priorities, k, point)
        if not settled:
            return False
        for i in range(n):
            x[i] = point[i]
            if abs(point[n + p + m + i]) > HELD:
                lb[i] = x[i]
                ub[i] = x[i]
        for j in range(m):
            if point[n + p + j] > HELD:
                held[j] = 1.0
    for i in range(n):
        qp.lb[i] = lb[i]
        qp.ub[i] = ub[i]
    attained = qp.A
    rows = attained.copy()
    _hold(rows, x, qp)
    return True


@compiled
def _hold(rows: Matrix, x: Vector, program: QPViews) -> None:
    """Make a program hold the products of rows (k, n), overwritten, with x (n,)."""
    _leave_out_fixed(rows, program)
    write_orthonormal(rows, program.A)
    for j in range(program.b.size):
        program.b[j] = row_dot(program.A, j, x)


@compiled
def _leave_out_fixed(rows: Matrix, program: QPViews) -> None:
    """Leave the variables whose bounds are equal out of rows (k, n)."""
    for i in range(program.q.size):
        if not program.lb[i] < program.ub[i]:
            for j in range(rows.shape[0]):
                rows[j, i] = 0.0


@compiled
def _write_limits(qp: QPViews, lb: Vector, ub: Vector, program: QPViews) -> None:
    """Write the limits of a level: those of the step, with the bounds that are held by now."""
    for i in range(qp.q.size):
        program.lb[i] = lb[i]
        program.ub[i] = ub[i]
    for j in range(qp.h.size):
        program.h[j] = qp.h[j]
        for i in range(qp.q.size):
            program.G[j, i] = qp.G[j, i]


@compiled
def _write_held(
    qp: QPViews, priorities: Priorities, k: int, held: Vector, x: Vector, program: QPViews
) -> None:
    """Write the equality rows of level k: the levels above and the inequality rows that are held.

    Those of the first level are the rows without a priority, as they are.
    """
    if k == 0:
        _copy_rows_without_level(qp, priorities, program)
        return
    p = qp.b.size
    rows = np.zeros((p + held.size, qp.q.size))
    for i in range(qp.q.size):
        for j in range(p):
            if priorities.rows[j] < priorities.numbers[k]:
                rows[j, i] = qp.A[j, i]
        for j in range(held.size):
            rows[p + j, i] = held[j] * qp.G[j, i]
    _hold(rows, x, program)


@compiled
def _copy_rows_without_level(qp: QPViews, priorities: Priorities, program: QPViews) -> None:
    """Copy the equality rows without a priority into a program, and write zeros after them."""
    used = 0
    for j in range(program.b.size):
        program.b[j] = 0.0
        for i in range(qp.q.size):
            program.A[j, i] = 0.0
    for j in range(qp.b.size):
        if priorities.rows[j] == 0:
            program.b[used] = qp.b[j]
            for i in range(qp.q.size):
                program.A[used, i] = qp.A[j, i]
            used += 1


@compiled
def _write_cost(qp: QPViews, priorities: Priorities, k: int, x: Vector, program: QPViews) -> None:
    """Write the cost of level k, from the answer x (n,) of the level above.

    With E its rows in the freedom that is left, 1/2 |E (y - x) - (b - A x)|^2 of the answer y.
    """
    n = qp.q.size
    E = np.zeros((qp.b.size, n))
    _write_free_rows(qp, priorities, k, program, E)
    for i in range(n):
        program.q[i] = 0.0
        for c in range(n):
            program.P[i, c] = 0.0
    for j in range(qp.b.size):
        # Rows of other levels are zero in E.
        wanted = qp.b[j] - row_dot(qp.A, j, x) + row_dot(E, j, x)
        for i in range(n):
            program.q[i] -= E[j, i] * wanted
            for c in range(n):
                program.P[i, c] += E[j, i] * E[j, c]


@compiled
def _write_free_rows(
    qp: QPViews, priorities: Priorities, k: int, program: QPViews, rows: Matrix
) -> None:
    """Write the rows of level k in the freedom that the levels above leave into zeros (p, n)."""
    n = qp.q.size
    for j in range(qp.b.size):
        if priorities.rows[j] == priorities.numbers[k]:
            for i in range(n):
                rows[j, i] = qp.A[j, i]
    if k > 0:
        _leave_out_fixed(rows, program)
        for j in range(qp.b.size):
            for r in range(program.b.size):
                _subtract(rows, j, program.A, r)
    rest = rows.copy()
    basis = np.empty((n, n))
    write_orthonormal(rest, basis)
    # What is left of a row has no direction of its own: it is rounding.
    for j in range(qp.b.size):
        for i in range(n):
            rows[j, i] -= rest[j, i]


@compiled
def _settled(
    program: QPViews,
    priorities: Priorities,
    scale: float,
    tol: float,
    state: Vector,
    point: Vector,
) -> bool:
    """Settle the network on a level's program with its cost times a power of two.

    Returns:
        Whether `point` (size,) = [x | y | z | z_box] answers the program as it is within `tol`.
    """
    for i in range(state.size):
        state[i] = 0.0
    _scale_cost(program, scale)
    settings = priorities.settings
    _, _, primal, dual, gap = enter_answer(priorities.answer, program, 0, settings, state, point)
    _scale_cost(program, 1.0 / scale)
    for i in range(program.q.size, point.size):
        point[i] /= scale
    return within(primal, dual / scale, gap / scale, tol)


@compiled
def _scale_cost(program: QPViews, factor: float) -> None:
    """Multiply the cost of a program."""
    for i in range(program.q.size):
        program.q[i] *= factor
        for c in range(program.q.size):
            program.P[i, c] *= factor


@compiled
def _note_answer(qp: QPViews, priorities: Priorities, k: int, point: Vector) -> None:
    """Note the answer of level k, which begins `point`, and what it lacks."""
    for i in range(qp.q.size):
        priorities.x[k, i] = point[i]
    for j in range(qp.b.size):
        if priorities.rows[j] == priorities.numbers[k]:
            priorities.missing[k, j] = qp.b[j] - row_dot(qp.A, j, priorities.x[k])


@compiled
def write_orthonormal(rows: Matrix, out: Matrix) -> None:
    """Write orthonormal rows that span given ones, as many as there are, and zero rows after them.

    By Gram-Schmidt with the longest row first, each made orthogonal twice.

    Args:
        rows: The rows, (k, n); what is left of them is shorter than `SMALLEST`.
        out: The orthonormal ones, (l, n), l at least the rank.
    """
    n = rows.shape[1]
    for r in range(out.shape[0]):
        longest = SMALLEST
        chosen = -1
        for j in range(rows.shape[0]):
            length = math.sqrt(row_dot(rows, j, rows[j]))
            if length > longest:
                longest = length
                chosen = j
        for i in range(n):
            out[r, i] = rows[chosen, i] / longest if chosen >= 0 else 0.0
        if chosen < 0:
            continue
        for before in range(r):
            _subtract(out, r, out, before)
        length = math.sqrt(row_dot(out, r, out[r]))
        for i in range(n):
            out[r, i] /= length
        for j in range(rows.shape[0]):
            _subtract(rows, j, out, r)


@compiled
def _subtract(rows: Matrix, j: int, basis: Matrix, r: int) -> None:
    """Take the part along row r of a basis (l, n), of length one or zero, off row j of rows (k, n).

    Twice, as the first time leaves what rounding has made of it.
    """
    for _ in range(2):
        along = row_dot(rows, j, basis[r])
        for i in range(rows.shape[1]):
            rows[j, i] -= along * basis[r, i]
