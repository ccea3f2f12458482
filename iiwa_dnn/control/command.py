"""A command and its answer: one row of numbers, which the control step writes and records keep.

This is the only file that knows where a number lies in a row.
"""

import copy
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.control.policies import Action, ProgramKind
from iiwa_dnn.control.relaxed import DAMPING
from iiwa_dnn.control.state import LAST, Q
from iiwa_dnn.naming import DONE, describe, in_the_way
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.qp.layout import IntVector, Sizes, data_size, offsets
from iiwa_dnn.schemes.limits import Periods
from iiwa_dnn.schemes.program import ACCELERATION, LimitNames
from iiwa_dnn.schemes.step import TARGET_SIZE

FIGURES = 5
"""Numbers that judge an answer: iterations, network time, primal and dual residual, gap."""
PLACEMENT = 12
"""Numbers of a frame's placement, as `Kinematics.placements` has them."""
DECISION = 4
"""Numbers of a decision: action, share of the period, status, kind of the program."""
BOUNDS = 2
"""Rows of the command's bounds: lower and upper ones."""
PAST = 3
"""Rows of what a program was built at: joint positions, last command and the one before."""

ACTIVE = 1e-9
"""Multiplier above which a bound or row counts as active."""

SINGULAR = "a singular posture, or tasks against each other"
DAMPED = 4.0
"""Squared singular value of the tasks' rows below which damping counts, in units of its own."""

STATUSES = tuple(Status)
"""Statuses by their number in a row."""
SOLVED, ADVANCED, NOT_SETTLED, NOT_FINITE, *_ = range(len(STATUSES))


class RowViews(NamedTuple):
    """Parts of a row, for a program of sizes n, m, p, dof joints and k tracked frames.

    Attributes:
        program: The program, `QP.data`, (size,).
        point: The answer, `Solution.point`, (2 n + m + p,).
        figures: Iterations, network time, primal and dual residual, gap, (5,).
        placement: Placement of the first tracked frame, (12,).
        past: Joint positions that the program was built at [rad], last command and the one before
            it [rad/s], (3, dof).
        dq: Command [rad/s], (dof,).
        next_q: Joint positions at the end of the period, q + dt dq [rad], (dof,).
        decision: Action, share of the period by which the reference's clock advances, number of
            the answer's status in `STATUSES`, and `ProgramKind` of the program, (4,).
        bounds: Bounds of the step that the command keeps [rad/s], (2, dof). Those of the program
            are others where limits of acceleration or jerk hold the command back.
        blocking: Where there is an action: for each variable 1 if its upper bound stood in the way,
            -1 if its lower one did, else 0, and for each inequality row 1 or 0, (n + m,).
        least: Distance that each watched pair has to keep [m], (pairs,), as in `ControllerState`.
        targets: Targets of the tracked frames, (k, 18).
    """

    program: Vector
    point: Vector
    figures: Vector
    placement: Vector
    past: Matrix
    dq: Vector
    next_q: Vector
    decision: Vector
    bounds: Matrix
    blocking: Vector
    least: Vector
    targets: Matrix


@compiled
def row_views(row: Vector, ends: IntVector, dof: int) -> RowViews:
    """Make the views of a row, (width,), whose parts end at these columns (`RowLayout`)."""
    return RowViews(
        row[: ends[0]],
        row[ends[0] : ends[1]],
        row[ends[1] : ends[2]],
        row[ends[2] : ends[3]],
        row[ends[3] : ends[4]].reshape(PAST, dof),
        row[ends[4] : ends[5]],
        row[ends[5] : ends[6]],
        row[ends[6] : ends[7]],
        row[ends[7] : ends[8]].reshape(BOUNDS, dof),
        row[ends[8] : ends[9]],
        row[ends[9] : ends[10]],
        row[ends[10] :].reshape((ends[11] - ends[10]) // TARGET_SIZE, TARGET_SIZE),
    )


@compiled
def note_command(views: RowViews, following: Matrix, dq: Vector, dt: float) -> None:
    """Note the command of a step, and where the arm is after it.

    Args:
        views: The step's row.
        following: `ControllerState.past` for the next step, (8 + k, dof).
        dq: The command [rad/s], (dof,) or longer.
        dt: Control period [s].
    """
    for i in range(views.dq.size):
        views.dq[i] = dq[i]
        following[LAST, i] = dq[i]
        views.next_q[i] = views.past[Q, i] + dt * dq[i]


class RowLayout:
    """Columns of the rows of one program.

    Attributes:
        sizes: ``(n, m, p)`` of the programs.
        ends: Columns at which the parts of `RowViews` end, (12,).
        width: Length of a row.
        columns: Columns by the names of `RowViews`.
        shape: Shape of joint positions, (dof,).
        dq: Columns of the command.
        names: Names of the limits, `LimitNames`; None where nobody asks for them.
    """

    def __init__(
        self, sizes: Sizes, dof: int, frames: int, names: LimitNames | None = None, pairs: int = 0
    ) -> None:
        """Lay out rows for programs of these sizes, and numbers of tracked frames and pairs."""
        self.names: Any = names
        self.sizes = sizes
        self.shape = (dof,)
        n, m, p = sizes
        lengths = [
            data_size(*sizes),
            2 * n + m + p,
            FIGURES,
            PLACEMENT,
            PAST * dof,
            dof,
            dof,
            DECISION,
            BOUNDS * dof,
            n + m,
            pairs,
            TARGET_SIZE * frames,
        ]
        ends = [*accumulate(lengths)]
        self.ends: IntVector = np.array(ends, dtype=np.int64)
        self.width = ends[-1]
        columns = map(slice, [0, *ends], ends)
        self.columns = dict(zip(RowViews._fields, columns, strict=True))
        self.dq = self.columns["dq"]

    def at_periods(self, periods: Periods) -> "RowLayout":
        """Return the layout for other control periods; commands keep those of theirs."""
        layout = copy.copy(self)
        layout.names = copy.copy(self.names)
        layout.names.periods = periods
        return layout

    def view(self, rows: Matrix, name: str) -> Matrix:
        """Return the columns of a name of rows (..., width)."""
        return rows[..., self.columns[name]]

    def targets(self, row: Vector) -> Matrix:
        """Return the targets of a row, (k, 18)."""
        return row[self.columns["targets"]].reshape(-1, TARGET_SIZE)

    def multipliers(self, rows: Matrix, tol: float) -> tuple[Matrix, Matrix]:
        """Return the multipliers of active bounds, (..., dof), and inequality rows, (..., m).

        They are those of `Solution.z_box` and `Solution.z`, 0 where none is active: where the
        multiplier is not above the tolerance `tol`, or its part of the duality gap is, multiplier
        times slack; above one, the slack itself. Without a smaller multiplier the residuals were
        still within the tolerance, and in continuous mode one that is left from earlier takes a
        while to decay.
        """
        n, m, p = self.sizes
        point = self.view(rows, "point")
        of_bounds = point[..., -n:]
        of_rows = point[..., n + p : n + p + m]
        bounds = self.view(rows, "program")[..., -2 * n :]
        nearest = np.where(of_bounds > 0.0, bounds[..., n:], bounds[..., :n])
        at_bounds = _active(of_bounds, np.abs(nearest - point[..., :n]), tol)
        return at_bounds[..., : self.shape[0]], _active(of_rows, self._slacks(rows), tol)

    def excess(self, rows: Matrix) -> Vector:
        """Compute by how much commands are beyond the bounds of their steps [rad/s], (k,).

        Of a command that nothing holds back from the answer, the excess over the inequality rows
        counts too.

        Args:
            rows: Rows of the commands, (k, width).
        """
        dq = self.view(rows, "dq")
        lower, upper = np.split(self.view(rows, "bounds"), 2, axis=1)
        free = self.view(rows, "decision")[:, 3:] < ProgramKind.HELD
        of_rows = np.where(free, -self._slacks(rows), 0.0)
        excess: Vector = np.hstack([lower - dq, dq - upper, of_rows]).max(axis=1, initial=0.0)
        return excess

    def _slacks(self, rows: Matrix) -> Matrix:
        """Compute h - G x at the answers x of rows (..., width), (..., m)."""
        n, m, p = self.sizes
        _, at_G, at_A, _ = offsets(n, m, p)
        G, h = np.split(self.view(rows, "program")[..., at_G:at_A], [m * n], axis=-1)
        x = self.view(rows, "point")[..., :n]
        slacks: Matrix = h - np.einsum("...ji,...i->...j", G.reshape(*h.shape, n), x)
        return slacks


def _active(multipliers: Matrix, slacks: Matrix, tol: float) -> Matrix:
    """Put zero in place of the multipliers of inactive bounds or rows."""
    sizes = np.abs(multipliers)
    active = (sizes > tol) & (slacks <= tol / np.clip(sizes, tol, 1.0))
    return np.where(active, multipliers, 0.0)


class Command:
    """Decision of one control step.

    Attributes:
        row: The numbers of the command, (width,), which its properties are views of.
        dq: Joint velocity [rad/s], (n,), within the limits.
        action: The action taken; ``Action.NONE`` where the network's answer was taken.
        reasons: Reasons beside limits for a command that need not be what is asked.
    """

    __slots__ = ("_layout", "action", "dq", "reasons", "row")

    def __init__(
        self,
        row: Vector,
        layout: RowLayout,
        action: Action = Action.NONE,
        reasons: tuple[str, ...] = (),
    ) -> None:
        """Take a row (width,), which is not copied, its columns, the action taken and reasons."""
        self.row = row
        self.dq = row[layout.dq]
        self.action = action
        self.reasons = reasons
        self._layout = layout

    @property
    def next_q(self) -> Vector:
        """Joint positions at the end of the period, q + dt dq [rad], (n,), a view."""
        return self.row[self._layout.columns["next_q"]]

    @property
    def fraction(self) -> float:
        """Share of the control period by which the reference's clock advances, in [0, 1]."""
        return float(self._layout.view(self.row, "decision")[1])

    @property
    def blocking(self) -> Vector:
        """Bounds and rows that stood in the way, as in `RowViews`, (n + m,), a view."""
        return self._layout.view(self.row, "blocking")

    @property
    def against(self) -> tuple[str, ...]:
        """Reasons, bounds and rows that keep the command from what tasks and cost ask, in words.

        The `conditions` are among them.
        """
        sides, rows = np.split(self.blocking, [self._layout.sizes[0]])
        if self.action is Action.NONE:
            sides, rows = self._layout.multipliers(self.row, ACTIVE)
        names = self._layout.names
        codes = names.codes(self.bounds, sides, self.past)
        words = [*map(describe, in_the_way(names.settings, codes, rows))]
        if not words and self.kind is ProgramKind.SOFTENED:
            words = self._lacks
        return (*self.reasons, *words, *self.conditions)

    @property
    def _lacks(self) -> list[str]:
        """State that the rows of the softened program's tasks, or the joints, are not enough."""
        qp = self.qp
        rows = (~qp.A.any(axis=1)).sum()
        rank = (np.linalg.eigvalsh(qp.P) > DAMPED * DAMPING**2).sum()
        few = f"{qp.q.size} joints for {rows} rows of the tasks"
        return [SINGULAR if rank < min(qp.q.size, rows) else few] * bool(rank < rows)

    @property
    def conditions(self) -> tuple[str, ...]:
        """Pairs that began nearer than they have to be, and relations that joints do not fulfil."""
        least = self._layout.view(self.row, "least")
        found: tuple[str, ...] = self._layout.names.conditions(self.past[Q], least)
        return found

    @property
    def qp(self) -> QP:
        """The program that was answered; `kind` says how it differs from the step's own."""
        return QP.from_data(self._layout.view(self.row, "program"), self._layout.sizes)

    @property
    def kind(self) -> ProgramKind:
        """Kind of the program that was answered."""
        return ProgramKind(int(self._layout.view(self.row, "decision")[3]))

    @property
    def bounds(self) -> Matrix:
        """Lower and upper bounds of the command [rad/s], those of the step, (2, n), a view."""
        return self._layout.view(self.row, "bounds").reshape(BOUNDS, -1)

    @property
    def limits(self) -> QP:
        """The program that was answered, with the bounds of the step: what the command keeps."""
        qp = QP.from_data(self._layout.view(self.row, "program").copy(), self._layout.sizes)
        qp.lb[: self.dq.size], qp.ub[: self.dq.size] = self.bounds
        return qp

    @property
    def past(self) -> Matrix:
        """Joint positions [rad], last command and the one before it [rad/s], (3, n), a view."""
        return self._layout.view(self.row, "past").reshape(PAST, -1)

    @property
    def targets(self) -> Matrix:
        """Targets of the tracked frames, (k, 18)."""
        return self._layout.targets(self.row)

    @property
    def placement(self) -> Vector:
        """Placement of the first tracked frame, as `Kinematics.placements`, (12,), a view."""
        return self._layout.view(self.row, "placement")

    @property
    def solution(self) -> Solution:
        """The network's answer to `qp`; where the command is held back, it is on the way there."""
        iterations, time, *residuals = self._layout.view(self.row, "figures").tolist()
        status = STATUSES[int(self._layout.view(self.row, "decision")[2])]
        point = self._layout.view(self.row, "point")
        return Solution(point, self._layout.sizes, status, int(iterations), time, *residuals)

    @property
    def ok(self) -> bool:
        """True if the command does all that the tasks ask."""
        return self.action is Action.NONE and self._layout.view(self.row, "decision")[2] <= ADVANCED

    @property
    def limited(self) -> bool:
        """True if acceleration and jerk limits alone keep it from all that the tasks ask.

        Then the arm is on its way there, or noise asks for more than it may follow; a command that
        is neither `ok` nor limited cannot do it.
        """
        if (
            self.action in (Action.NONE, Action.STOP)
            or self.blocking[self._layout.sizes[0] :].any()
        ):
            return False
        codes = np.abs(self._layout.names.codes(self.bounds, self.blocking, self.past))
        return bool(codes.any()) and bool((codes[codes > 0] >= ACCELERATION).all())

    def __repr__(self) -> str:
        dq = np.array2string(self.dq, precision=4, separator=", ")
        words = "solved" if self.ok else "not settled"
        if self.action:
            words = f"no solution: {DONE[self.action.name.lower()]}"
            words += f", against {', '.join(self.against)}" if self.against else ""
        return f"<Command dq = {dq} rad/s, {words}; ok = {self.ok}>"
