"""Explicit Euler with a step that is computed to be stable."""

import math
from dataclasses import dataclass

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import compiled
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Network, checked_flow, enter_rates
from iiwa_dnn.networks.integrators.base import Answered, AnswerSettings, Integrator
from iiwa_dnn.networks.projection import mark_active, stable_step
from iiwa_dnn.qp.layout import QPViews, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point

SAFETY = 0.95
"""Fraction of the computed stable step that is used: the bound itself is only marginally stable."""

MOST = 1_000_000
"""Largest number of sub-steps that stability may ask for in one `advance`."""


@dataclass(frozen=True)
class ExplicitEuler(Integrator):
    r"""Explicit Euler: ``s <- s + h F(s)``, of order 1.

    One control step of the paper is h = 1.11 in units of rho, where its own heart needs h < 0.155:
    one Euler step a control step is unstable, and the projections only hide it. So a duration is
    cut into sub-steps below `Network.stable_step`.

    Attributes:
        substeps: Sub-steps per `advance`; None computes how many are needed for stability.
    """

    substeps: int | None = None

    def __post_init__(self) -> None:
        """Check the number."""
        if self.substeps is not None:
            checks.integer("substeps", self.substeps, 1)

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` in place by `duration` [rho].

        Returns:
            Sub-steps taken.

        Raises:
            InvalidInputError: No step is known to be stable, as where P is singular, or more than
                `MOST` steps are needed, and `substeps` was not given. The message names the
                network.
        """
        check_size("state", state, network.state_size(qp))
        rates = checked_flow(network, qp).rates
        count = self.substeps
        if count is None:
            stable = SAFETY * network.stable_step(qp, state)
            if not (stable > 0.0 and duration <= MOST * stable):
                raise InvalidInputError(
                    type(network).__name__,
                    f"no explicit step is known to be stable, or more than {MOST} would be needed "
                    "(is P singular?); give substeps, or integrate implicitly",
                )
            count = max(1, math.ceil(duration / stable))
        step = duration / count
        with np.errstate(over="ignore", invalid="ignore"):  # the caller judges the state
            for _ in range(count):
                state += step * rates(state)
        return count


@compiled
def advance_explicitly(
    qp: QPViews, rates: int, settings: AnswerSettings, state: Vector, point: Vector
) -> Answered:
    """Advance a network by a time with explicit steps, as a function of type `enter_answer`.

    The state (size,) is advanced in place, and its point (2n + m + p,) is written.

    Returns:
        Sub-steps, 0 if none are stable, or more than `MOST` needed; time [rho]; and the residuals
        of the point.
    """
    duration = settings.duration
    count = settings.substeps
    values = np.empty(state.size)
    if count == 0:
        active = np.empty(state.size - qp.q.size)
        enter_rates(rates, qp, settings.network, state, values)
        mark_active(qp, state, values, active)
        stable = SAFETY * stable_step(qp, active)
        if not (stable > 0.0 and duration <= MOST * stable):
            return 0, 0.0, np.inf, np.inf, np.inf
        count = max(1, int(np.ceil(duration / stable)))
    step = duration / count
    for _ in range(count):
        enter_rates(rates, qp, settings.network, state, values)
        for i in range(state.size):
            state[i] += step * values[i]
    primal, dual, gap = kkt_point(qp, state, point)
    return count, duration, primal, dual, gap
