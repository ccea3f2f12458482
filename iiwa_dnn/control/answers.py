"""Programs and answers of a stretch of control steps, kept in one array until they are recorded."""

from __future__ import annotations

import numpy as np

from iiwa_dnn.control.policies import Resolution
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp import QP, Matrix, Solution, Status, Vector

FIGURES = 5 + 16
"""Numbers in a row beside program and answer."""


class Answers:
    """Room for `capacity` answers: a control loop that makes no objects is twice as quick.

    One step a row: ``[program | point | iterations, network time, primal and dual residual, gap |
    pose]``, the first as `QP.data`, the second as `Solution.point`, the last row by row. All
    programs have one shape, which the first one sets.

    Attributes:
        capacity: How many there is room for.
        count: How many there are.
        status: Of those that are not in `unsolved`.
        sizes: ``(n, m, p)`` of the programs; zeros before the first.
        rows: The array, (capacity, width).
        x_slice: Where in a row the primal point is.
        unsolved: Solutions that are none, by their number.
        resolved: What a policy decided, by the number of the answer that it gave.
    """

    def __init__(self, capacity: int, status: Status) -> None:
        """Start empty."""
        self.capacity, self.status, self.count = capacity, status, 0
        self.sizes = (0, 0, 0)
        self.rows: Matrix = np.empty((0, 0))
        self.unsolved: dict[int, Solution] = {}
        self.resolved: dict[int, Resolution] = {}
        self._program = self._point = self.x_slice = slice(0, 0)

    def shape(self, sizes: tuple[int, int, int]) -> None:
        """Make room for programs of these sizes.

        Raises:
            InvalidInputError: There are programs of other sizes already.
        """
        if self.count:
            problem = f"built a program of sizes {sizes} after others of {self.sizes}"
            raise InvalidInputError("scheme", problem)
        n, m, p = self.sizes = sizes
        program = (n + m + p) * (n + 1) + 2 * n
        point = 2 * n + m + p
        self._program, self._point = slice(0, program), slice(program, program + point)
        self.x_slice = slice(program, program + n)
        self.rows = np.empty((self.capacity, program + point + FIGURES))

    def add(self, qp: QP, solution: Solution, pose: Matrix) -> None:
        """Copy one answer in.

        Raises:
            InvalidInputError: The program has another shape than those before.
        """
        if qp.sizes != self.sizes:
            self.shape(qp.sizes)
        row = self.rows[self.count]
        row[self._program], row[self._point] = qp.data, solution.point
        row[-FIGURES:-16] = (solution.iterations, solution.network_time, *solution.residuals)
        row[-16:] = pose.ravel()
        if solution.status is not self.status:
            self.unsolved[self.count] = solution
        self.count += 1

    def qp(self, i: int) -> QP:
        """Program i."""
        return QP.from_data(self.rows[i, self._program], self.sizes)

    def solution(self, i: int) -> Solution:
        """Its solution."""
        if i in self.unsolved:
            return self.unsolved[i]
        row = self.rows[i]
        iterations, time, primal, dual, gap = row[-FIGURES:-16].tolist()
        point = row[self._point]
        return Solution(
            point, self.sizes, self.status, int(iterations), time, primal, dual, gap
        )  # fmt: skip

    def x(self, i: int) -> Vector:
        """Its primal point, (n,)."""
        x: Vector = self.rows[i, self.x_slice]
        return x

    @property
    def programs(self) -> Matrix:
        """One `QP.data` a row, (count, size)."""
        return self.rows[: self.count, self._program]

    @property
    def all_x(self) -> Matrix:
        """The primal points, (count, n)."""
        return self.rows[: self.count, self.x_slice]

    @property
    def bound_multipliers(self) -> Matrix:
        """`Solution.z_box` of each, (count, n)."""
        stop = self._point.stop
        return self.rows[: self.count, stop - self.sizes[0] : stop]

    def repeat(self, first: int) -> None:
        """Put answer `first` in the place of all after it."""
        self.rows[first + 1 : self.count] = self.rows[first]
        for numbered in (self.unsolved, self.resolved):
            for i in range(first + 1, self.count):
                numbered.pop(i, None)

    @property
    def iterations(self) -> Vector:
        """What each one took, (count,)."""
        return self.rows[: self.count, -FIGURES]

    @property
    def residuals(self) -> Matrix:
        """Primal and dual residual and gap, (count, 3)."""
        return self.rows[: self.count, -FIGURES + 2 : -16]

    @property
    def poses(self) -> Matrix:
        """Where the tip was, (count, 4, 4)."""
        return self.rows[: self.count, -16:].reshape(-1, 4, 4)
