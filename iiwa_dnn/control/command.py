"""A command and its answer: one row of numbers, which the control step writes and records keep.

This is the only file that knows where a number lies in a row.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from iiwa_dnn.control.policies import Action, Resolution
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector
from iiwa_dnn.qp.layout import Sizes, compiled
from iiwa_dnn.schemes.step import TARGET_SIZE

FIGURES = 5
"""Numbers that judge an answer: iterations, network time, primal and dual residual, gap."""
PLACEMENT = 12
"""Numbers of a frame's placement, as `Kinematics.placements` has them."""


class RowViews(NamedTuple):
    """Parts of a row, for a program of sizes n, m, p, dof joints and k tracked frames.

    Attributes:
        program: The program, `QP.data`, (size,).
        point: The answer, `Solution.point`, (2 n + m + p,).
        figures: Iterations, network time, primal and dual residual, gap, (5,).
        placement: Placement of the first tracked frame, (12,).
        q: Joint positions that the program was built at [rad], (dof,).
        dq: Command [rad/s], (dof,).
        targets: Targets of the tracked frames, (k, 18).
    """

    program: Vector
    point: Vector
    figures: Vector
    placement: Vector
    q: Vector
    dq: Vector
    targets: Matrix


@compiled
def row_views(row: Vector, n: int, m: int, p: int, dof: int) -> RowViews:
    """Make the views of a row, (width,); the columns are those of `RowLayout`."""
    at_point = (n + m + p) * (n + 1) + 2 * n
    at_figures = at_point + 2 * n + m + p
    at_placement = at_figures + FIGURES
    at_q = at_placement + PLACEMENT
    at_dq = at_q + dof
    at_targets = at_dq + dof
    return RowViews(
        row[:at_point],
        row[at_point:at_figures],
        row[at_figures:at_placement],
        row[at_placement:at_q],
        row[at_q:at_dq],
        row[at_dq:at_targets],
        row[at_targets:].reshape((row.size - at_targets) // TARGET_SIZE, TARGET_SIZE),
    )


class RowLayout:
    """Columns of the rows of one program.

    Attributes:
        sizes: ``(n, m, p)`` of the programs.
        dof: Number of joints.
        status: Status of an answer that is taken as it is.
        width: Length of a row.
        columns: Columns by the names of `RowViews`.
        dq: Columns of the command.
    """

    def __init__(self, sizes: Sizes, dof: int, frames: int, status: Status) -> None:
        """Lay out rows for programs of these sizes, and a number of tracked frames."""
        n, m, p = sizes
        lengths = {
            "program": (n + m + p) * (n + 1) + 2 * n,
            "point": 2 * n + m + p,
            "figures": FIGURES,
            "placement": PLACEMENT,
            "q": dof,
            "dq": dof,
            "targets": TARGET_SIZE * frames,
        }
        self.sizes = sizes
        self.dof = dof
        self.status = status
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

    def fill(
        self, row: Vector, qp: QP, solution: Solution, placement: Vector, q: Vector, dq: Vector
    ) -> None:
        """Write a step into a row.

        Args:
            row: The row, (width,), overwritten but for the targets.
            qp: The program.
            solution: The answer.
            placement: Placement of the first tracked frame, (12,).
            q: Joint positions [rad], (dof,).
            dq: Command [rad/s], (dof,).

        Raises:
            InvalidInputError: The program has another shape than the others.
        """
        if qp.sizes != self.sizes:
            problem = f"built a program of sizes {qp.sizes} after others of {self.sizes}"
            raise InvalidInputError("scheme", problem)
        figures = (solution.iterations, solution.network_time, *solution.residuals)
        parts: Any = (qp.data, solution.point, figures, placement, q, dq)
        for name, part in zip(self.columns, parts, strict=False):
            row[self.columns[name]] = part

    def bound_multipliers(self, rows: Matrix) -> Matrix:
        """Return the multipliers of the joints' bounds, `Solution.z_box`, (..., dof)."""
        n, _, _ = self.sizes
        return self.view(rows, "point")[..., -n:][..., : self.dof]

    def row_multipliers(self, rows: Matrix) -> Matrix:
        """Return the multipliers of the inequality rows, `Solution.z`, (..., m)."""
        n, m, p = self.sizes
        return self.view(rows, "point")[..., n + p : n + p + m]


class Command:
    """Decision of one control step.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
        resolution: Decision of the policy where the network had no answer; else None.
    """

    __slots__ = ("_layout", "_unsolved", "dq", "resolution", "row")

    def __init__(
        self,
        row: Vector,
        layout: RowLayout,
        resolution: Resolution | None = None,
        unsolved: Solution | None = None,
    ) -> None:
        """Take a row, which is not copied.

        Args:
            row: The numbers of the command, (width,).
            layout: Columns of the row.
            resolution: Decision of a policy.
            unsolved: Answer of another status than the layout's.
        """
        self.row = row
        self.dq = row[layout.dq]
        self.resolution = resolution
        self._layout = layout
        self._unsolved = unsolved

    @property
    def qp(self) -> QP:
        """The program that was answered."""
        return QP.from_data(self._layout.view(self.row, "program"), self._layout.sizes)

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
        """The answer: the network's unless there is a resolution."""
        if self._unsolved is not None:
            return self._unsolved
        layout = self._layout
        iterations, time, *residuals = layout.view(self.row, "figures").tolist()
        point = layout.view(self.row, "point")
        return Solution(point, layout.sizes, layout.status, int(iterations), time, *residuals)

    @property
    def action(self) -> Action:
        """The action taken; ``Action.NONE`` where the network's answer was taken."""
        return Action.NONE if self.resolution is None else self.resolution.action

    @property
    def ok(self) -> bool:
        """True if the command does all that the tasks ask: solved, by the network or a fallback."""
        return self.action in (Action.NONE, Action.FALLBACK) and self._unsolved is None

    def __getstate__(self) -> tuple[Any, ...]:
        return self.row, self._layout, self.resolution, self._unsolved

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        Command.__init__(self, *state)

    def __repr__(self) -> str:
        dq = np.array2string(self.dq, precision=4, separator=", ")
        words = _WORDS[self.action]
        if self.action is Action.NONE and not self.ok:
            words = "not settled"
        against = self._against()
        if against:
            words += f", against {', '.join(against)}"
        return f"<Command dq = {dq} rad/s, {words}; ok = {self.ok}>"

    def _against(self) -> list[str]:
        """Return the limits that stood in the way, in words."""
        found = self.resolution
        if found is None:
            return []
        sides = {"lower": found.sides < 0, "upper": found.sides > 0}
        names = [
            f"joint {joint + 1} {side} bound"
            for side, blocking in sides.items()
            for joint in np.flatnonzero(blocking)
        ]
        return names + [f"inequality row {row + 1}" for row in np.flatnonzero(found.rows)]


_WORDS = {
    Action.NONE: "solved",
    Action.FALLBACK: "solved by the reference solver",
    Action.SLOW: "no solution: slower along the path",
    Action.RELAX: "no solution: as near to the task as the limits allow",
    Action.STOP: "no solution: stopped",
}
