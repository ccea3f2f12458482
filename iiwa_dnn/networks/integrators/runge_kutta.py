r"""An adaptive explicit Runge-Kutta method: Bogacki and Shampine's pair of orders 3 and 2.

Each step is taken by the method of order 3 and judged by the one of order 2 that comes with it; the
next one is as long as the tolerance allows. Where the field is stiff the error estimate feels the
edge of stability and holds the step below it, so no stable step has to be known beforehand: it
serves singular P too.

Source: P. Bogacki, L. F. Shampine, "A 3(2) pair of Runge-Kutta formulas", Applied Mathematics
Letters 2 (1989).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks import Flow, Network
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP


@dataclass(frozen=True)
class AdaptiveRungeKutta:
    """Bogacki-Shampine 3(2), of order 3, with a step that follows its own error estimate.

    Attributes:
        rtol: Error of a step of `advance` that is accepted, relative to the state.
        atol: Error that is accepted on top. `settle` takes at most a tenth of its tolerance, and
            a hundredth of the largest rate.
        max_steps: Budget of `advance` and of `settle`, rejected steps included.
    """

    order: ClassVar[int] = 3
    rtol: float = 1e-6
    atol: float = 1e-9
    max_steps: int = 200_000

    def __post_init__(self) -> None:
        """Check the numbers."""
        checks.positive("rtol", self.rtol)
        checks.positive("atol", self.atol)
        checks.integer("max_steps", self.max_steps, 1)

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` in place by `duration` [rho].

        Returns:
            Steps taken, rejected ones included.

        Raises:
            NoSolutionError: `max_steps` did not suffice.
        """
        time, step, taken = 0.0, min(duration, 0.1), 0
        flow = network.flow(qp)
        slope = flow.rates(state)
        while time < duration:
            if taken >= self.max_steps:
                raise NoSolutionError(f"{taken} steps were not enough for {duration:g} rho")
            step = min(step, duration - time)
            new, last, error = _step(flow, state, slope, step)
            taken += 1
            accepted = self.atol + self.rtol * np.maximum(np.abs(state), np.abs(new))
            size = float(np.abs(error / accepted).max())
            if size <= 1.0:
                time = duration if step == duration - time else time + step
                state[:], slope = new, last
            step *= _factor(size)
        return taken

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`."""
        time, step, rate_tol = 0.0, 0.1, tol
        atol = min(self.atol, 0.1 * tol)
        flow = network.flow(qp)
        slope = flow.rates(state)
        taken = 0
        for taken in range(self.max_steps):
            if not np.abs(slope).max() > rate_tol:
                primal, dual, gap = network.read(qp, state, point)
                # The gap weighs the rates with the multipliers: they may have to be smaller still.
                if max(primal, dual, gap) <= tol or rate_tol < 1e-3 * tol:
                    return taken, time, primal, dual, gap
                rate_tol *= 0.5
            new, last, error = _step(flow, state, slope, step)
            # On the way to rest, what counts is an error that is small beside what is left to go.
            size = float(np.abs(error).max() / (atol + 0.01 * np.abs(slope).max()))
            if size <= 1.0:
                time += step
                state[:], slope = new, last
            step *= _factor(size)
        return taken + 1, time, *network.read(qp, state, point)


def _step(flow: Flow, state: Vector, first: Vector, step: float) -> tuple[Vector, Vector, Vector]:
    """The new state, its slope (the next step's first), and the estimate of the error."""
    second = flow.rates(state + 0.5 * step * first)
    third = flow.rates(state + 0.75 * step * second)
    new = state + step * (2.0 * first + 3.0 * second + 4.0 * third) / 9.0
    last = flow.rates(new)
    error = step * (-5.0 * first / 72.0 + second / 12.0 + third / 9.0 - last / 8.0)
    return new, last, error


def _factor(size: float) -> float:
    """How much longer the next step may be; shorter after one that was not accepted."""
    if not size > 0.0:
        return 5.0 if size == 0.0 else 0.2
    return min(5.0, max(0.2, 0.9 / float(np.cbrt(size))))
