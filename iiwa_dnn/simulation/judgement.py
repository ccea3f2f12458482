"""The check of every program of a run: those of the steps, and of their levels of priority."""

from contextlib import ExitStack
from typing import Any

import numpy as np
from numpy.typing import NDArray

from iiwa_dnn.control.answers import Answers
from iiwa_dnn.control.cascade import Cascade
from iiwa_dnn.qp.checkpool import CheckPool
from iiwa_dnn.qp.crosscheck import Agreement, CrossCheck


class Judgement(ExitStack):
    """Programs of a run of N steps on their way to the reference solvers.

    Attributes:
        residual: Largest absolute residual of the rows of each of l levels, (N, l); None where no
            task has a priority.
    """

    def __init__(self, check: CrossCheck, steps: int, stages: int, cascade: Cascade) -> None:
        """Start nothing yet; each step has so many stages, one program each."""
        super().__init__()
        self._levels, self._stages, self._noted = cascade.levels, stages, 0
        self._waiting: list[list[NDArray[np.float64]]] = []
        count = 1 + len(self._levels)
        pools = [CheckPool(check, steps * stages) for _ in range(count)]
        self._pools = [self.enter_context(pool) for pool in pools]
        self.residual = np.zeros((steps, count - 1)) if self._levels else None

    def note(self) -> None:
        """Note the levels of the next stage."""
        if self.residual is not None:
            step = self._noted // self._stages
            self._noted += 1
            self._waiting.append([np.concatenate([level.data, level.x]) for level in self._levels])
            for i, level in enumerate(self._levels):
                missing = np.abs(level.missing).max()
                self.residual[step, i] = max(self.residual[step, i], missing)

    def submit(self, answers: Answers) -> None:
        """Hand a stretch of steps over to the check."""
        self._pools[0].submit(answers.programs, answers.sizes, answers.all_x)
        for i, level in enumerate(self._levels):
            programs, x = np.split(
                np.array([each[i] for each in self._waiting]), [level.data.size], 1
            )
            # A level leaves x free in part: what has to agree is A x.
            self._pools[1 + i].submit(programs, level.sizes, x, by_cost=True)
        self._waiting.clear()

    def arrays(self, steps: int) -> dict[str, Any]:
        """Return the record's optional arrays, cut to the steps that were taken."""
        return {} if self.residual is None else {"level_residual": self.residual[:steps]}

    def finish(self) -> Agreement:
        """Return the verdict on each step, the worst of its programs."""
        verdicts = [pool.finish().worst_of(self._stages) for pool in self._pools]
        return Agreement(*(np.fmax.reduce(arrays) for arrays in zip(*verdicts, strict=True)))
