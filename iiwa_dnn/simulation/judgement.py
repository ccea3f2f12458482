"""The check of every program of a run."""

from contextlib import ExitStack

from iiwa_dnn.control.command import RowLayout
from iiwa_dnn.qp import Matrix
from iiwa_dnn.qp.crosscheck import Agreement, CheckPool, CrossCheck


class Judgement(ExitStack):
    """Programs of a run on their way to the reference solvers."""

    def __init__(self, check: CrossCheck, steps: int, stages: int, layout: RowLayout) -> None:
        """Start nothing yet; each of the steps has so many stages, one program each."""
        super().__init__()
        self._layout = layout
        self._stages = stages
        self._pool = CheckPool(check, steps * stages)

    def submit(self, rows: Matrix) -> None:
        """Hand the rows of a stretch of steps over to the check, (k, width)."""
        layout = self._layout
        points = layout.view(rows, "point")
        self._pool.submit(layout.view(rows, "program"), layout.sizes, points)

    def finish(self) -> Agreement:
        """Return the verdict on each step, the worst of its programs."""
        return self._pool.finish().worst_of(self._stages)
