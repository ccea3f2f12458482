"""A command and its answer: one row of numbers, which the control step writes and records keep.

This is the only file that knows where a number lies in a row.
"""

from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.compiling.library import inlined
from iiwa_dnn.control.policies import Action, ProgramKind, Resolution
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.qp.layout import Sizes, offsets
from iiwa_dnn.schemes.limit_names import ACCELERATION, LimitNames
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
        decision: Action, share of the period by which the reference's clock advances, number of
            the answer's status in `STATUSES`, and `ProgramKind` of the program, (4,).
        bounds: Bounds of the step that the command keeps [rad/s], (2, dof). Those of the program
            are others where limits of acceleration or jerk hold the command back.
        blocking: Where there is an action: for each variable 1 if its upper bound stood in the way,
            -1 if its lower one did, else 0, and for each inequality row 1 or 0, (n + m,).
        targets: Targets of the tracked frames, (k, 18).
    """

    program: Vector
    point: Vector
    figures: Vector
    placement: Vector
    past: Matrix
    dq: Vector
    decision: Vector
    bounds: Matrix
    blocking: Vector
    targets: Matrix


@inlined
def row_views(row: Vector, n: int, m: int, p: int, dof: int) -> RowViews:
    """Make the views of a row, (width,); the columns are those of `RowLayout`."""
    at_point = (n + m + p) * (n + 1) + 2 * n
    at_figures = at_point + 2 * n + m + p
    at_placement = at_figures + FIGURES
    at_past = at_placement + PLACEMENT
    at_dq = at_past + PAST * dof
    at_decision = at_dq + dof
    at_bounds = at_decision + DECISION
    at_blocking = at_bounds + BOUNDS * dof
    at_targets = at_blocking + n + m
    return RowViews(
        row[:at_point],
        row[at_point:at_figures],
        row[at_figures:at_placement],
        row[at_placement:at_past],
        row[at_past:at_dq].reshape(PAST, dof),
        row[at_dq:at_decision],
        row[at_decision:at_bounds],
        row[at_bounds:at_blocking].reshape(BOUNDS, dof),
        row[at_blocking:at_targets],
        row[at_targets:].reshape((row.size - at_targets) // TARGET_SIZE, TARGET_SIZE),
    )


class RowLayout:
    """Columns of the rows of one program.

    Attributes:
        sizes: ``(n, m, p)`` of the programs.
        dof: Number of joints.
        width: Length of a row.
        columns: Columns by the names of `RowViews`.
        dq: Columns of the command.
        names: Names of the limits; None where nobody asks for them.
    """

    def __init__(
        self, sizes: Sizes, dof: int, frames: int, names: LimitNames | None = None
    ) -> None:
        """Lay out rows for programs of these sizes, and a number of tracked frames."""
        self.names = names
        n, m, p = sizes
        lengths = {
            "program": (n + m + p) * (n + 1) + 2 * n,
            "point": 2 * n + m + p,
            "figures": FIGURES,
            "placement": PLACEMENT,
            "past": PAST * dof,
            "dq": dof,
            "decision": DECISION,
            "bounds": BOUNDS * dof,
            "blocking": n + m,
            "targets": TARGET_SIZE * frames,
        }
        self.sizes = sizes
        self.dof = dof
        self.columns: dict[str, slice] = {}
        self.width = 0
        for name, length in lengths.items():
            self.columns[name] = slice(self.width, self.width + length)
            self.width += length
        self.dq = self.columns["dq"]

    def view(self, rows: Matrix, name: str) -> Matrix:
        """Return the columns of a name of rows (..., width)."""
        return rows[..., self.columns[name]]

    def targets(self, row: Vector) -> Matrix:
        """Return the targets of a row, (k, 18)."""
        return row[self.columns["targets"]].reshape(-1, TARGET_SIZE)

    def fill(self, row: Vector, solution: Solution) -> None:
        """Write the answer to the program of a row (width,) into it, without an action."""
        figures = (solution.iterations, solution.network_time, *solution.residuals)
        self.view(row, "point")[:] = solution.point
        self.view(row, "figures")[:] = figures
        status = STATUSES.index(solution.status)
        self.view(row, "decision")[:] = (Action.NONE, 1.0, status, ProgramKind.OWN)

    def bound_multipliers(self, rows: Matrix, tol: float) -> Matrix:
        """Return the multipliers of the joints' active bounds, (..., dof), as `Solution.z_box`.

        A bound or row is active where its multiplier is above the tolerance `tol` and its part of
        the duality gap, multiplier times slack, is not; above one, the slack itself. Without a
        smaller multiplier the residuals were still within the tolerance, and in continuous mode one
        that is left from earlier takes a while to decay.
        """
        n, _, _ = self.sizes
        dof = self.dof
        point = self.view(rows, "point")
        bounds = self.view(rows, "program")[..., -2 * n :]
        multipliers = point[..., -n:][..., :dof]
        above = bounds[..., n:][..., :dof] - point[..., :dof]
        below = point[..., :dof] - bounds[..., :dof]
        return _active(multipliers, np.where(multipliers > 0.0, above, below), tol)

    def row_multipliers(self, rows: Matrix, tol: float) -> Matrix:
        """Return the multipliers of the active inequality rows, (..., m), as `Solution.z`."""
        n, m, p = self.sizes
        _, at_G, at_A, _ = offsets(n, m, p)
        point = self.view(rows, "point")
        G, h = np.split(self.view(rows, "program")[..., at_G:at_A], [m * n], axis=-1)
        values = np.einsum("...ji,...i->...j", G.reshape(*h.shape, n), point[..., :n])
        return _active(point[..., n + p : n + p + m], h - values, tol)

    def excess(self, rows: Matrix) -> Vector:
        """Compute by how much commands are beyond the bounds of their steps [rad/s], (k,).

        Of a command that nothing holds back from the answer, the excess over the inequality rows
        counts too.

        Args:
            rows: Rows of the commands, (k, width).
        """
        n, m, p = self.sizes
        dq = self.view(rows, "dq")
        lower, upper = np.split(self.view(rows, "bounds"), 2, axis=1)
        excess = np.maximum(lower - dq, dq - upper).max(axis=1, initial=0.0)
        _, at_G, at_A, _ = offsets(n, m, p)
        G, h = np.split(self.view(rows, "program")[:, at_G:at_A], [m * n], axis=1)
        values = np.einsum(
            "kji,ki->kj", G.reshape(len(rows), m, n), self.view(rows, "point")[:, :n]
        )
        of_rows = (values - h).max(axis=1, initial=0.0)
        free = self.view(rows, "decision")[:, 3] < ProgramKind.HELD
        return np.where(free, np.maximum(excess, of_rows), excess)


def _active(multipliers: Matrix, slacks: Matrix, tol: float) -> Matrix:
    """Put zero in place of the multipliers of inactive bounds or rows."""
    sizes = np.abs(multipliers)
    active = (sizes > tol) & (slacks <= tol / np.clip(sizes, tol, 1.0))
    return np.where(active, multipliers, 0.0)


class Command:
    """Decision of one control step.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
        action: The action taken; ``Action.NONE`` where the network's answer was taken.
    """

    __slots__ = ("_layout", "action", "dq", "row")

    def __init__(self, row: Vector, layout: RowLayout, action: Action = Action.NONE) -> None:
        """Take a row, which is not copied.

        Args:
            row: The numbers of the command, (width,).
            layout: Columns of the row.
            action: What was done in place of the network's answer.
        """
        self.row = row
        self.dq = row[layout.dq]
        self.action = action
        self._layout = layout

    @property
    def fraction(self) -> float:
        """Share of the control period by which the reference's clock advances, in [0, 1]."""
        return float(self._layout.view(self.row, "decision")[1])

    @property
    def resolution(self) -> Resolution | None:
        """Decision of the policy where the network had no answer; else None."""
        if self.action is Action.NONE:
            return None
        n = self._layout.sizes[0]
        blocking = self._layout.view(self.row, "blocking").astype(np.int8)
        sides = blocking[:n]
        rows = blocking[n:]
        names = self._layout.names
        against: tuple[str, ...] = ()
        if names is not None:
            against = tuple(names.in_words(self.bounds, sides, rows, self.past))
        return Resolution(self.action, self.qp, self.solution, self.fraction, sides, rows, against)

    @property
    def against(self) -> tuple[str, ...]:
        """Bounds and rows that keep the command from what the tasks and the cost ask, in words."""
        found = self.resolution
        if found is not None:
            return found.against
        if self._layout.names is None:
            return ()
        sides = self._layout.bound_multipliers(self.row, ACTIVE)
        rows = self._layout.row_multipliers(self.row, ACTIVE)
        return tuple(self._layout.names.in_words(self.bounds, sides, rows, self.past))

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
        layout = self._layout
        iterations, time, *residuals = layout.view(self.row, "figures").tolist()
        point = layout.view(self.row, "point")
        status = STATUSES[int(layout.view(self.row, "decision")[2])]
        return Solution(point, layout.sizes, status, int(iterations), time, *residuals)

    @property
    def ok(self) -> bool:
        """True if the command does all that the tasks ask."""
        solution = self.solution
        solved = solution.status in (Status.SOLVED, Status.ADVANCED)
        return self.action is Action.NONE and solved

    @property
    def limited(self) -> bool:
        """True if acceleration and jerk limits alone keep it from all that the tasks ask.

        Then the arm is on its way there, or noise asks for more than it may follow; a command that
        is neither `ok` nor limited cannot do it.
        """
        found = self.resolution
        if found is None or self._layout.names is None or found.rows.any():
            return False
        codes = np.abs(self._layout.names.codes(self.bounds, found.sides, self.past))
        return bool(codes.any()) and bool((codes[codes > 0] >= ACCELERATION).all())

    def __getstate__(self) -> tuple[Any, ...]:
        return self.row, self._layout, self.action

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        Command.__init__(self, *state)

    def __repr__(self) -> str:
        dq = np.array2string(self.dq, precision=4, separator=", ")
        words = _WORDS[self.action]
        if self.action is Action.NONE and not self.ok:
            words = "not settled"
        found = self.resolution
        if found is not None and found.against:
            words += f", against {', '.join(found.against)}"
        return f"<Command dq = {dq} rad/s, {words}; ok = {self.ok}>"


_WORDS = {
    Action.NONE: "solved",
    Action.SLOW: "no solution: slower along the path",
    Action.RELAX: "no solution: as near to the task as the limits allow",
    Action.STOP: "no solution: stopped",
}
