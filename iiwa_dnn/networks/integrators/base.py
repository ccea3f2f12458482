"""Integrator of a network: it advances a state by a time, or until the network has settled."""

from typing import Any, ClassVar, Protocol

from iiwa_dnn.networks.base import Network, settings_of
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP

Settled = tuple[int, float, float, float, float]
"""Progress of a network, and the residuals of the point that its state stands for.

``(iterations, network_time, primal, dual, gap)``: linear systems solved (implicit) or steps taken
(explicit), the time that passed in units of rho, and qpsolvers' three residuals. A plain tuple,
since a control loop asks for it at every step.
"""


class Integrator(Protocol):
    """One way to integrate a network; one that derives from this is a dataclass.

    Attributes:
        order: Order of the method in its step length.
    """

    order: ClassVar[int]

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` (size,) in place by `duration` [rho]; returns the iterations taken."""
        ...

    def settle(self, network: Network, qp: QP, state: Vector, point: Vector, tol: float) -> Settled:
        """Advance `state` in place until the KKT residuals of `point` are at most `tol`.

        Args:
            network: The network.
            qp: The program, which does not change meanwhile.
            state: Start, (size,); holds the last state afterwards.
            point: Output ``[x | y | z | z_box]`` of size n + p + m + n.
            tol: Absolute tolerance on each residual.

        Returns:
            The progress and the residuals, above `tol` if the budget of steps ended first.
        """
        ...

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return settings_of(self)
