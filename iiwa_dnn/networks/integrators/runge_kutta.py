r"""An adaptive explicit Runge-Kutta method: Bogacki and Shampine's pair of orders 3 and 2.

Each step is taken by the method of order 3 and judged by the embedded one of order 2. On a
stiff field the error estimate feels the edge of stability and holds the step below it, so no stable
step has to be known beforehand: it serves singular P too.

Source: P. Bogacki, L. F. Shampine, "A 3(2) pair of Runge-Kutta formulas", Applied Mathematics
Letters 2 (1989), as `scipy.integrate.RK23` implements it.
"""

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators.base import Integrator, Settled
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import within

_LEAST_RTOL = 100.0 * float(np.finfo(float).eps)
"""Relative tolerance below which scipy warns and takes this one."""


@dataclass(frozen=True)
class AdaptiveRungeKutta(Integrator):
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
            NoSolutionError: `max_steps` did not suffice, or the state is no longer a number.
        """
        if not duration > 0.0:
            return 0
        stepper = _stepper(network, qp, state, duration, max(self.rtol, _LEAST_RTOL), self.atol)
        while stepper.status == "running":
            if _steps(stepper) >= self.max_steps:
                raise NoSolutionError(
                    f"{_steps(stepper)} steps were not enough for {duration:g} rho"
                )
            message = stepper.step()
        state[:] = stepper.y
        if stepper.status == "failed":
            raise NoSolutionError(f"the network cannot be followed: {message}")
        return _steps(stepper)

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`."""
        atol = min(self.atol, 0.1 * tol)
        rate_tol = tol
        stepper = _stepper(network, qp, state, np.inf, _LEAST_RTOL, atol)
        while True:
            state[:] = stepper.y
            rate = float(np.abs(stepper.f).max())
            taken = _steps(stepper)
            done = stepper.status == "failed" or taken >= self.max_steps
            if done or not rate > rate_tol:
                primal, dual, gap = network.read(qp, state, point)
                # The gap weighs the rates with the multipliers: they may have to be smaller still.
                if done or within(primal, dual, gap, tol) or rate_tol < 1e-3 * tol:
                    return taken, float(stepper.t), primal, dual, gap
                rate_tol *= 0.5
            # On the way to rest, an error that is small beside the rest of the way is accepted.
            stepper.atol = atol + 0.01 * rate
            stepper.step()


def _stepper(
    network: Network, qp: QP, state: Vector, duration: float, rtol: float, atol: float
) -> Any:
    """Start scipy's integrator at a state (size,)."""
    from scipy.integrate import RK23  # 0.3 s that only this integrator needs

    rates = network.flow(qp).rates
    return RK23(
        lambda _, s: rates(s),
        0.0,
        state,
        duration,
        rtol=rtol,
        atol=atol,
        first_step=min(duration, 0.1),
    )


def _steps(stepper: Any) -> int:
    """Count the steps that were tried: three evaluations each, after the first of all."""
    return int(stepper.nfev - 1) // 3
