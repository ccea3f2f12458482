"""The check of every program of a run: those of the steps, and of their levels of priority."""

from contextlib import ExitStack

import numpy as np

from iiwa_dnn.control.cascade import Level
from iiwa_dnn.control.command import RowLayout
from iiwa_dnn.qp import Matrix
from iiwa_dnn.qp.checkpool import CheckPool
from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck
from iiwa_dnn.simulation.loop import Outcome


class Judgement(ExitStack):
    """Programs of a run on their way to the reference solvers."""

    def __init__(
        self, check: CrossCheck, steps: int, stages: int, layout: RowLayout, levels: list[Level]
    ) -> None:
        """Start nothing yet; each of the steps has so many stages, one program each."""
        super().__init__()
        self._layout = layout
        self._levels = levels
        self._stages = stages
        self._waiting: list[list[Matrix]] = []
        pools = [CheckPool(check, steps * stages) for _ in range(1 + len(levels))]
        self._pools = [self.enter_context(pool) for pool in pools]

    def observe(self, k: int, outcome: Outcome) -> None:
        """Take in the levels of step k."""
        for levels in outcome.levels:
            self._waiting.append([programs for programs, _ in levels])

    def submit(self, rows: Matrix) -> None:
        """Hand the rows of a stretch of steps over to the check, (k, width)."""
        layout = self._layout
        points = layout.view(rows, "point")
        self._pools[0].submit(layout.view(rows, "program"), layout.sizes, points)
        for i, level in enumerate(self._levels):
            found = np.array([programs[i] for programs in self._waiting])
            programs, answers = np.split(found, [level.data.size], axis=1)
            # A level leaves x free in part: what has to agree is A x.
            self._pools[1 + i].submit(programs, level.sizes, answers, by_cost=True)
        self._waiting.clear()

    def finish(self) -> Agreement:
        """Return the verdict on each step, the worst of its programs."""
        verdicts = [pool.finish().worst_of(self._stages) for pool in self._pools]
        return Agreement(*(np.fmax.reduce(arrays) for arrays in zip(*verdicts, strict=True)))
