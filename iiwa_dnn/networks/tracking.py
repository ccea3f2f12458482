r"""Discrete-time forms: a network that is ahead of its program by one control period.

A state at time t + tau is computed from the program, its rate and the states up to time t, so an
answer is there the moment its program is known:

.. math::  s_{k+1} = c\,\tau\,\dot s_k + \sum_i a_i\, s_{k-i}

From a formula of order r with rates that are exact to order r - 1, the residual of an answer is of
order :math:`\tau^r`. The more states a formula takes, the smaller is the largest gain
:math:`h = \tau/\rho` with which it is stable (`Formula.limit`): order is paid for with gain.

Sources: D. Guo, Z. Nie, L. Yan, "Novel discrete-time Zhang neural network for time-varying matrix
inversion", IEEE Transactions on Systems, Man, and Cybernetics: Systems 47 (2017) (three steps); the
coefficients of all were derived anew from Taylor's series, and are tested for order and stability.
"""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.networks.base import checked_flow
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.layout import Sizes, Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Solution


class Formula(NamedTuple):
    """An explicit formula for the next state.

    Attributes:
        rate: Coefficient c of the rate.
        past: Coefficients a of the states, the newest first.
        order: Order of the residual that remains, in tau.
        limit: Largest stable gain tau / rho of a linear error.
    """

    rate: float
    past: tuple[float, ...]
    order: int
    limit: float


EULER = Formula(1.0, (1.0,), 2, 2.0)
TAYLOR3 = Formula(1.0, (1.5, -1.0, 0.5), 3, 1.0)
"""Three steps: from (2 x[k+1] - 3 x[k] + 2 x[k-1] - x[k-2]) / (2 tau)."""
FIFD = Formula(1.6, (0.6, 0.2, 0.2), 3, 1.0)
"""Five-instant finite differences: from (5 x[k+1] - 3 x[k] - x[k-1] - x[k-2]) / (8 tau)."""
TAYLOR4 = Formula(2.25, (-0.125, 0.75, 0.625, -0.25), 4, 0.28)
"""Four steps: from (8 x[k+1] + x[k] - 6 x[k-1] - 5 x[k-2] + 2 x[k-3]) / (18 tau)."""
TAYLOR5 = Formula(2.0, (5 / 24, 12 / 24, 6 / 24, 4 / 24, -3 / 24), 4, 1 / 3)
"""Five steps: from (24 x[k+1] - 5 x[k] - 12 x[k-1] - 6 x[k-2] - 4 x[k-3] + 3 x[k-4]) / (48 tau)."""

_BACKWARD = ((0.0,), (1.0, -1.0), (1.5, -2.0, 0.5), (11 / 6, -3.0, 1.5, -1 / 3))
"""Backward differences of orders 0 to 3, the newest program first."""


@dataclass(frozen=True)
class TrackingSolver(DNNSolver):
    """A solver that advances a network by a discrete formula, with the program's rate of change.

    `advance` answers a program with the state that was computed from the programs before it. The
    rate comes from backward differences of the last programs. `solve` is that of `DNNSolver`.

    Attributes:
        formula: The formula.
        substeps: Steps of the formula in each `advance`; the program moves on linearly meanwhile.
    """

    formula: Formula = EULER
    substeps: int = 1
    _past: dict[str, list[Vector]] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        """Check the settings."""
        super().__post_init__()
        checks.instance("formula", self.formula, Formula)
        checks.integer("substeps", self.substeps, 1)

    def reset(self) -> None:
        """Forget states and programs: the next call starts from the network's initial state."""
        super().reset()
        self._past.update(states=[], programs=[])

    def advance(self, qp: QP, duration: float) -> Solution:
        """Move on by `duration` from the last program to this one, and answer it.

        Args:
            qp: The program at the end of the time.
            duration: Time since the last program [s], the same in all calls.

        Returns:
            The point that the state stands for, with status ``ADVANCED`` and its residuals.

        Raises:
            InvalidInputError: The duration is no finite number above 0.
        """
        checks.positive("duration", duration)
        if qp.sizes not in self._warm:
            self.reset()
        state = self._take(qp)
        programs = self._past["programs"]
        steps = self.substeps if programs else 0
        for i in range(steps):
            self._step(state, qp.sizes, duration / steps, i)
        programs.insert(0, qp.data.copy())
        del programs[self.formula.order :]
        return self._advanced(qp, state, steps, duration / self.network.rho)

    def _step(self, state: Vector, sizes: Sizes, step: float, i: int) -> None:
        """Advance the state in place by the step number i of `step` [s] since the last program."""
        programs = np.array(self._past["programs"])
        weights = np.array(_BACKWARD[len(programs) - 1])
        rate = weights @ np.where(np.isfinite(programs), programs, 0.0) / (self.substeps * step)
        now = QP.from_data(programs[0] + i * step * rate, sizes)
        moving = QP.from_data(self.network.rho * rate, sizes)
        change = step / self.network.rho * checked_flow(self.network, now, moving).rates(state)
        past = [state.copy(), *self._past["states"]]
        known = self.formula if len(past) >= len(self.formula.past) else EULER
        state[:] = known.rate * change
        for fraction, old in zip(known.past, past, strict=False):
            state += fraction * old
        self._past["states"] = past[: len(self.formula.past) - 1]
