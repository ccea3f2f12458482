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
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.layout import Sizes, Vector, check_size
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

_BACKWARD = ((1.0, -1.0), (1.5, -2.0, 0.5), (11 / 6, -3.0, 1.5, -1 / 3))
"""Backward differences of orders 1 to 3, the newest program first."""


@dataclass(frozen=True)
class TrackingSolver(DNNSolver):
    """A network that is advanced by a formula, and gets its program's rate of change.

    `advance` answers a program with the state that was computed from the programs before it. The
    rate comes from backward differences of the last programs, or is given. `solve` is that of
    `DNNSolver`.

    Attributes:
        formula: The formula.
        substeps: Steps of the formula in each `advance`; the program moves on linearly meanwhile.
    """

    formula: Formula = EULER
    substeps: int = 1
    _states: list[Vector] = field(default_factory=list, init=False, repr=False)
    _programs: list[Vector] = field(default_factory=list, init=False, repr=False)
    _rates: list[Vector] = field(default_factory=list, init=False, repr=False)

    def __post_init__(self) -> None:
        """Check the settings."""
        super().__post_init__()
        checks.integer("substeps", self.substeps, 1)

    def reset(self) -> None:
        """Forget states and programs: the next call starts from the network's initial state."""
        super().reset()
        for past in (self._states, self._programs, self._rates):
            past.clear()

    def advance(self, qp: QP, duration: float, rate: Vector | None = None) -> Solution:
        """Move on by `duration` from the last program to this one, and answer it.

        Args:
            qp: The program at the end of the time.
            duration: Time since the last program [s], the same in all calls.
            rate: Rate of change of `QP.data` at this program [1/s], (size,), for the next call;
                None takes backward differences.

        Returns:
            The point that the state stands for, with status ``ADVANCED`` and its residuals.
        """
        if self.warm_state(qp.sizes) is None:
            self.reset()
        state = self._take(qp)
        steps = 0
        if self._programs:
            self._follow(state, duration, qp.sizes)
            steps = self.substeps
        self._programs.insert(0, qp.data.copy())
        del self._programs[self.formula.order :]
        self.predict(self._difference(duration) if rate is None else rate)
        return self._advanced(qp, state, steps, duration / self.network.rho)

    def predict(self, rate: Vector) -> None:
        """Set the rate of change of the last program's `QP.data` [1/s], (size,), for the next call.

        It may be set after the call, where it depends on the answer.
        """
        check_size("rate", rate, self._programs[0].size)
        self._rates[:] = [rate]

    def _difference(self, duration: float) -> Vector:
        """Estimate the rate of change of the program [1/s] at the newest one."""
        known = np.array(self._programs)
        if len(known) < 2:
            return np.zeros(known[0].size)
        finite = np.where(np.isfinite(known), known, 0.0)
        rate: Vector = np.array(_BACKWARD[len(known) - 2]) @ finite / duration
        return rate

    def _follow(self, state: Vector, duration: float, sizes: Sizes) -> None:
        """Advance the state in place, from the last program to the end of the time [s]."""
        network = self.network
        formula = self.formula
        rate = self._rates[0]
        step = duration / self.substeps
        moving = QP.from_data(network.rho * rate, sizes)
        for i in range(self.substeps):
            now = QP.from_data(self._programs[0] + i * step * rate, sizes)
            change = step / network.rho * network.flow(now, moving).rates(state)
            past = [state.copy(), *self._states]
            known = formula if len(past) >= len(formula.past) else EULER
            state[:] = known.rate * change
            for share, old in zip(known.past, past, strict=False):
                state += share * old
            self._states[:] = past[: len(formula.past) - 1]
