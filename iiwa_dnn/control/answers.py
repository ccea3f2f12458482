"""Programs and answers of a stretch of control steps, kept in one array until they are recorded."""

import numpy as np

from iiwa_dnn.control.policies import Action, Resolution
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector

FIGURES, PLACE = 5, 12
"""Numbers of an answer's figures (iterations, time, three residuals) and of the tip's placement."""


class Answers:
    """Room for `capacity` answers: a control loop that makes no objects is twice as quick.

    One step a row: ``[program | point | iterations, network time, primal and dual residual, gap |
    tip placement | joint positions | targets]``, the first as `QP.data`, the second as
    `Solution.point`, the placement as `Kinematics.placements`, each target as `Target.data`. All
    programs have one shape.

    Attributes:
        count: Number of answers so far.
        sizes: ``(n, m, p)`` of the programs.
        status: Status of the answers that are not in `unsolved`.
        rows: The array, (capacity, width).
        at_figures: Column in which the figures begin.
        at_targets: Column in which the targets begin.
        unsolved: Solutions of another status, by the number of the answer.
        resolved: Decisions of a policy, by the number of the answer.
    """

    def __init__(
        self,
        sizes: tuple[int, int, int],
        joints: int,
        status: Status,
        targets: Matrix,
        accelerates: bool = False,
    ) -> None:
        """Allocate a row for each row of the targets (k, 18 frames); nothing is answered yet.

        Where the programs are of the acceleration level, `all_dq` lies in an array of its own.
        """
        self.count, self.sizes, self.status = 0, sizes, status
        n, m, p = sizes
        program, point = (n + m + p) * (n + 1) + 2 * n, 2 * n + m + p
        self._program, self._point = slice(0, program), slice(program, program + point)
        self._x = slice(program, program + joints)
        self.at_figures = program + point
        self._figures = slice(self.at_figures, self.at_figures + FIGURES)
        self._place = slice(self._figures.stop, self._figures.stop + PLACE)
        self._q = slice(self._place.stop, self._place.stop + joints)
        self.at_targets = self._q.stop
        self.rows: Matrix = np.empty((len(targets), self.at_targets + targets.shape[1]))
        self.rows[:, self.at_targets :] = targets
        x = self.rows[:, self._x]
        self._dq: Matrix = np.zeros_like(x) if accelerates else x
        self.unsolved: dict[int, Solution] = {}
        self.resolved: dict[int, Resolution] = {}

    def program(self, i: int) -> Vector:
        """Return row i's program, `QP.data`, to be read or written."""
        data: Vector = self.rows[i, self._program]
        return data

    def add(self, qp: QP, solution: Solution, place: Vector, q: Vector) -> None:
        """Copy one answer in.

        Raises:
            InvalidInputError: The program has another shape than the others.
        """
        if qp.sizes != self.sizes:
            problem = f"built a program of sizes {qp.sizes} after others of {self.sizes}"
            raise InvalidInputError("scheme", problem)
        row = self.rows[self.count]
        row[self._program], row[self._point] = qp.data, solution.point
        row[self._figures] = (solution.iterations, solution.network_time, *solution.residuals)
        row[self._place], row[self._q] = place, q
        if solution.status is not self.status:
            self.unsolved[self.count] = solution
        self.count += 1

    def qp(self, i: int) -> QP:
        """Return program i."""
        return QP.from_data(self.program(i), self.sizes)

    def solution(self, i: int) -> Solution:
        """Return the solution of program i."""
        if i in self.unsolved:
            return self.unsolved[i]
        iterations, time, *residuals = self.rows[i, self._figures].tolist()
        point = self.rows[i, self._point]
        return Solution(point, self.sizes, self.status, int(iterations), time, *residuals)

    def dq(self, i: int) -> Vector:
        """Return the joint velocity of answer i [rad/s], (joints,)."""
        dq: Vector = self._dq[i]
        return dq

    @property
    def programs(self) -> Matrix:
        """Programs, one `QP.data` a row, (count, size)."""
        return self.rows[: self.count, self._program]

    @property
    def all_x(self) -> Matrix:
        """Primal points, (count, n)."""
        start = self._point.start
        return self.rows[: self.count, start : start + self.sizes[0]]

    @property
    def all_dq(self) -> Matrix:
        """Joint velocities [rad/s], (count, joints)."""
        return self._dq[: self.count]

    @property
    def bound_multipliers(self) -> Matrix:
        """Multipliers of the joints' bounds, `Solution.z_box`, (count, joints)."""
        start = self._point.stop - self.sizes[0]
        return self.rows[: self.count, start : start + self._q.stop - self._q.start]

    @property
    def row_multipliers(self) -> Matrix:
        """Multipliers of the inequality rows, `Solution.z`, (count, m)."""
        stop = self._point.stop - self.sizes[0]
        return self.rows[: self.count, stop - self.sizes[1] : stop]

    @property
    def places(self) -> Matrix:
        """Placements of the tip, (count, 12)."""
        return self.rows[: self.count, self._place]

    @property
    def q(self) -> Matrix:
        """Joint positions that the programs were built at [rad], (count, joints)."""
        return self.rows[: self.count, self._q]

    @property
    def targets(self) -> Matrix:
        """Targets of all rows, one frame after the other, (rows, 18 frames)."""
        return self.rows[:, self.at_targets :]

    def repeat(self, first: int) -> None:
        """Put answer `first` in the place of all after it."""
        for i in range(first + 1, self.count):
            self.rows[i] = self.rows[first]
            self._dq[i] = self._dq[first]
            self.unsolved.pop(i, None)
            self.resolved.pop(i, None)


class Command:
    """Decision of one control step.

    Attributes:
        dq: Joint velocity [rad/s], (n,), within the limits.
    """

    __slots__ = ("_answers", "_index", "dq")

    def __init__(self, answers: Answers, index: int, dq: Vector) -> None:
        self._answers, self._index, self.dq = answers, index, dq

    @property
    def resolution(self) -> Resolution | None:
        """Decision of the policy where the network had no answer; else None."""
        return self._answers.resolved.get(self._index)

    @property
    def qp(self) -> QP:
        """The program that was answered."""
        return self._answers.qp(self._index)

    @property
    def solution(self) -> Solution:
        """The answer: the network's unless there is a resolution."""
        return self._answers.solution(self._index)

    @property
    def action(self) -> Action:
        """The action taken; ``Action.NONE`` where the network's answer was taken."""
        resolution = self.resolution
        return Action.NONE if resolution is None else resolution.action

    @property
    def ok(self) -> bool:
        """True if the command does all that the tasks ask: solved, by the network or a fallback."""
        asked = self.action in (Action.NONE, Action.FALLBACK)
        return asked and self._index not in self._answers.unsolved

    def __repr__(self) -> str:
        dq, words = np.array2string(self.dq, precision=4, separator=", "), _WORDS[self.action]
        if self.action is Action.NONE and not self.ok:
            words = "not settled"
        if (found := self.resolution) is not None:
            sides = zip(("lower", "upper"), (found.sides < 0, found.sides > 0), strict=True)
            against = [f"joint {i + 1} {side} bound" for side, at in sides for i in at.nonzero()[0]]
            against += [f"inequality row {i + 1}" for i in found.rows.nonzero()[0]]
            words += f", against {', '.join(against)}" if against else ""
        return f"<Command dq = {dq} rad/s, {words}; ok = {self.ok}>"


_WORDS = {
    Action.NONE: "solved",
    Action.FALLBACK: "solved by the reference solver",
    Action.SLOW: "no solution: slower along the path",
    Action.RELAX: "no solution: as near to the task as the limits allow",
    Action.STOP: "no solution: stopped",
}
