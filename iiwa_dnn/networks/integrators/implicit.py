r"""Implicit Euler with growing steps: pseudo-transient continuation to the equilibrium.

**The step is a convex problem.** Write one backward Euler step of length h (in units of rho) of
the projection network without its primal projection. The multipliers' lines can be solved for:

.. math::

    y^+ = y + h (A x^+ - b), \qquad
    \mu^+ = \max\Bigl(\frac{\mu}{1+h},\; \mu + h\,(\Omega x^+ - \chi)\Bigr)

and both are increasing in :math:`x^+`. What is left, :math:`(x^+ - x)/h + P x^+ + q + A^T y^+ +
\Omega^T \mu^+ = 0`, is therefore the stationarity of a strongly convex, piecewise quadratic
function, for every h. It has one minimiser, and a semismooth Newton iteration with an exact line
search reaches it. A bare Newton iteration on the KKT conditions can cycle when many bounds are
active; this cannot.

**Two kinds of step.** `settle` first tries a single linearised step with a very long h, which near
the equilibrium is a Newton step; a warm start in a control loop needs only that. If it does not
halve the rates, a fully solved step follows whose h grows tenfold a round, from 10 to 1e6. Where
rounding is in the way, linearised steps of other lengths are tried too. The budget is bounded, and
mostly not used: once three of the longest steps have not halved the rates, the state is running
off, and `iiwa_dnn.networks.certificates` looks for the proof that there is no solution.

**What is left out.** The projection of x is not integrated here: at the equilibrium the
multipliers alone keep the bounds, so the answer is the same. The answer that is handed out is
put inside its bounds.

**Other networks** have no compiled loops. Their backward Euler steps are solved by a Newton
iteration on the whole state, and cut where it does not converge
(`iiwa_dnn.networks.integrators.pseudo_transient`).

Sources: C. T. Kelley and D. E. Keyes, "Convergence analysis of pseudo-transient continuation",
SIAM J. Numer. Anal. 35 (1998), for the continuation; R. T. Rockafellar, "Augmented Lagrangians
and applications of the proximal point algorithm in convex programming", Math. Oper. Res. 1
(1976), for the same step of the plain saddle-point flow, which is his method of multipliers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from iiwa_dnn import checks, kernels
from iiwa_dnn.errors import NoSolutionError
from iiwa_dnn.networks import Network, ProjectionNetwork
from iiwa_dnn.networks.integrators import pseudo_transient
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.qp.program import QP, Vector


@dataclass(frozen=True)
class ImplicitEuler:
    """Backward Euler, of order 1, stable at any step.

    Attributes:
        step: Longest step of `advance`, in units of rho.
        long_step: Length of the linearised step that `settle` tries first, in units of rho.
        max_steps: Budget of `settle` in linear systems.
    """

    order: ClassVar[int] = 1
    step: float = 1.0
    long_step: float = 1e7
    max_steps: int = 1000

    def __post_init__(self) -> None:
        """Check the numbers."""
        checks.positive("step", self.step)
        checks.positive("long_step", self.long_step)
        checks.integer("max_steps", self.max_steps, 1)

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` in place by `duration` [rho] in equal steps no longer than `step`.

        Returns:
            Linear systems solved.

        Raises:
            NoSolutionError: A step's linear system is singular to working precision.
        """
        count = max(1, math.ceil(duration / self.step))
        length = duration / count
        if isinstance(network, ProjectionNetwork):
            systems = kernels.advance_implicit(qp.data, *qp.sizes, state, length, count, 1e-12)
        else:
            systems = pseudo_transient.advance(network.flow(qp), state, length, count, 1e-12)
        if systems < 0:
            raise NoSolutionError("an implicit step is singular to working precision")
        return int(systems)

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`."""
        if not isinstance(network, ProjectionNetwork):
            return pseudo_transient.settle(
                network, qp, state, point, tol, self.max_steps, self.long_step
            )
        n, m, p = qp.sizes
        settled: Settled = kernels.settle_implicit(
            qp.data, n, m, p, state, point, tol, self.max_steps, self.long_step
        )
        return settled
