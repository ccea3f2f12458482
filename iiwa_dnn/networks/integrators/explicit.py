"""Explicit Euler with a step that is computed to be stable."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators.base import Integrator, Settled
from iiwa_dnn.networks.projection import field
from iiwa_dnn.qp.layout import Vector, check_size, compiled
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import within

SAFETY = 0.95
"""Share of the computed stable step that is used: the bound itself is only marginally stable."""


@dataclass(frozen=True)
class ExplicitEuler(Integrator):
    r"""Explicit Euler: ``s <- s + h F(s)``, of order 1.

    One control step of the paper is h = 1.11 in units of rho, where its own heart needs h < 0.155:
    one Euler step a control step is unstable, and the projections only hide it. So a duration is
    cut into sub-steps below `Network.stable_step`.

    Attributes:
        substeps: Sub-steps per `advance`; None computes how many are needed for stability.
        max_steps: Budget of `settle`.
    """

    order: ClassVar[int] = 1
    substeps: int | None = None
    max_steps: int = 1_000_000

    def __post_init__(self) -> None:
        """Check the numbers."""
        if self.substeps is not None:
            checks.integer("substeps", self.substeps, 1)
        checks.integer("max_steps", self.max_steps, 1)

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` in place by `duration` [rho].

        Returns:
            Sub-steps taken.

        Raises:
            InvalidInputError: P is singular, so that no step is known to be stable, and
                `substeps` was not given.
        """
        count = self.substeps
        if count is None:
            count = max(1, math.ceil(duration / self._stable_step(network, qp, state)))
        _steps(network, qp, state, duration / count, count, -1.0)
        return count

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`.

        Raises:
            InvalidInputError: P is singular, so that no step is known to be stable.
        """
        step = self._stable_step(network, qp, None)
        taken, rate_tol = 0, tol
        while True:
            taken += _steps(network, qp, state, step, self.max_steps - taken, rate_tol)
            primal, dual, gap = network.read(qp, state, point)
            # The gap weighs the rates with the multipliers, so they may have to be smaller still.
            if within(primal, dual, gap, tol) or taken >= self.max_steps or rate_tol < 1e-3 * tol:
                return taken, taken * step, primal, dual, gap
            rate_tol *= 0.1

    def _stable_step(self, network: Network, qp: QP, state: Vector | None) -> float:
        step = SAFETY * network.stable_step(qp, state)
        if step <= 0.0:
            raise InvalidInputError(
                "P", "is singular, so no explicit step is known to be stable; integrate implicitly"
            )
        return step


def _steps(network: Network, qp: QP, state: Vector, step: float, count: int, tol: float) -> int:
    """Take up to `count` steps, until the largest rate is at most `tol`; returns how many."""
    form = network.compiled
    if form is not None:
        n, m, p = qp.sizes
        check_size("state", state, 3 * n + m + p)
        taken, _ = explicit_euler(qp.data, n, m, p, form.project, state, step, count, tol)
        return taken
    flow = network.flow(qp)
    for done in range(count):
        rates = flow.rates(state)
        if not np.abs(rates).max() > tol:
            return done
        state += step * rates
    return count


@compiled
def explicit_euler(
    data: Vector, n: int, m: int, p: int, project: bool, s: Vector, step: float, count: int,
    tol: float,
) -> tuple[int, float]:  # fmt: skip
    """Advance `s` in place by up to `count` explicit Euler steps.

    Stops early once the largest rate is at most `tol`.

    Returns:
        ``(steps, rate)``: steps taken, and the largest rate at the last point evaluated.
    """
    rates, active = np.empty(s.size), np.empty(m + 2 * n)
    rate = np.inf
    for done in range(count):
        rate = field(data, n, m, p, project, s, rates, active)
        if not rate > tol:
            return done, rate
        for i in range(s.size):
            s[i] += step * rates[i]
    return count, rate
