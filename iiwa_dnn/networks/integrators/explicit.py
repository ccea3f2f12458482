"""Explicit Euler with a step that is computed to be stable."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import RATES, Network, enter_rates
from iiwa_dnn.networks.integrators.base import DURATION, NETWORK, SUBSTEPS, Integrator, Settled
from iiwa_dnn.networks.projection import mark_active, stable_step
from iiwa_dnn.qp.compiling import borrowed
from iiwa_dnn.qp.layout import QPViews, Vector, check_size, compiled, larger, qp_views
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point, within

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
        taken = 0
        rate_tol = tol
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
    function = network.rates_function()
    if function is not None:
        check_size("state", state, network.state_size(qp))
        constants = network.prepare(qp)
        limits = np.array([step, count, tol])
        address = RATES.address(function)
        return explicit_program(qp.data, *qp.sizes, address, constants, state, limits)
    flow = network.flow(qp)
    for done in range(count):
        rates = flow.rates(state)
        if tol >= 0.0 and not np.abs(rates).max() > tol:
            return done
        state += step * rates
    return count


@compiled
def explicit_program(
    data: Vector,
    n: int,
    m: int,
    p: int,
    rates: int,
    constants: Vector,
    state: Vector,
    limits: Vector,
) -> int:
    """Take explicit Euler steps; `limits` is their length [rho], their number and a tolerance."""
    qp = qp_views(data, n, m, p)
    constants = borrowed(constants)
    state = borrowed(state)
    return explicit_euler(qp, rates, constants, state, limits[0], int(limits[1]), limits[2])


@compiled
def explicit_euler(
    qp: QPViews,
    rates: int,
    constants: Vector,
    state: Vector,
    step: float,
    count: int,
    tol: float,
) -> int:
    """Advance the state in place by up to `count` explicit Euler steps of one length [rho].

    `rates` is the address of the network's compiled function, which takes the state (size,), and
    `constants` (k,) are its own. The steps end early once the largest rate is at most `tol`.

    Returns:
        Steps taken.
    """
    values = np.empty(state.size)
    for done in range(count):
        enter_rates(rates, qp, constants, state, values)
        largest = 0.0
        for i in range(state.size):
            largest = larger(largest, abs(values[i]))
        if not largest > tol:
            return done
        for i in range(state.size):
            state[i] += step * values[i]
    return count


@compiled
def follow(qp: QPViews, rates: int, constants: Vector, state: Vector, point: Vector) -> Settled:
    """Advance the network by its time with explicit steps; a compiled answer (`ANSWER`).

    It reads constants (k,), advances the state (size,) and writes the point (2n + m + p,).

    Returns:
        Sub-steps, 0 if none are stable; time [rho]; and the residuals of the point.
    """
    duration = constants[DURATION]
    count = int(constants[SUBSTEPS])
    own = constants[NETWORK:]
    if count == 0:
        values = np.empty(state.size)
        active = np.empty(qp.h.size + 2 * qp.q.size)
        enter_rates(rates, qp, own, state, values)
        mark_active(state, values, active)
        stable = SAFETY * stable_step(qp, active)
        if not stable > 0.0:
            return 0, 0.0, np.inf, np.inf, np.inf
        count = max(1, int(np.ceil(duration / stable)))
    explicit_euler(qp, rates, own, state, duration / count, count, -1.0)
    primal, dual, gap = kkt_point(qp, state, point)
    return count, duration, primal, dual, gap
