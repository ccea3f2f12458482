"""Integrator of a network: it advances a state by a time, or until the network has converged."""

from typing import Any, NamedTuple, Protocol

from iiwa_dnn.compiling.library import entry
from iiwa_dnn.compiling.records import Record, part
from iiwa_dnn.networks.base import Network, settings_of
from iiwa_dnn.qp.layout import QPViews, Vector
from iiwa_dnn.qp.program import QP

Progress = tuple[int, float, float, float, float]
"""Progress of a network, and the residuals of the point that its state stands for.

``(iterations, network_time, primal, dual, gap)``: linear solves (implicit) or steps taken
(explicit), the time that passed in units of rho, and qpsolvers' three residuals. A plain tuple,
since a control loop asks for it at every step.
"""

Answered = tuple[float, float, float, float, float]
"""`Progress`, as compiled code returns it: all floats."""


class SolveStats(Record):
    """Statistics of a solve.

    Attributes:
        iterations: Linear solves, or steps taken.
        time: Network time that passed [rho].
        primal: Primal residual.
        dual: Dual residual.
        gap: Duality gap.
    """

    iterations: float
    time: float
    primal: float
    dual: float
    gap: float


class AnswerSettings(Record):
    """Settings of a compiled answer.

    Attributes:
        tolerance: Tolerance of the residuals.
        budget: Largest number of linear solves.
        duration: Time to advance [rho]; 0 to solve.
        substeps: Number of explicit sub-steps; 0 for as many as stability needs.
        network: Constants of the network, (k,).
    """

    tolerance: float
    budget: float
    duration: float
    substeps: int
    network: Vector = part("constants")


@entry
def enter_answer(
    address: int, qp: QPViews, rates: int, settings: AnswerSettings, state: Vector, point: Vector
) -> Answered:
    """Call the function of a `CompiledAnswer` by its address, to answer a program.

    The state (size,) is advanced in place, by a time or until the network has converged, and its
    point (2n + m + p,) is written.

    Args:
        address: Address of the function.
        qp: The program.
        rates: Address of the network's compiled function; 0 to solve.
        settings: Tolerance, budget and time.
        state: The state.
        point: The point, overwritten.

    Returns:
        ``(iterations, network_time, primal, dual, gap)``, as `Progress`.
    """
    raise NotImplementedError


class CompiledAnswer(NamedTuple):
    """A compiled function that solves programs of one shape or advances a network on them.

    Attributes:
        address: Address of a function of the type `enter_answer`.
        rates: Address of the network's compiled function.
        settings: Its settings.
    """

    address: int
    rates: int
    settings: AnswerSettings


class Integrator(Protocol):
    """Base of the integrators of a network; a subclass is a dataclass."""

    def advance(self, network: Network, qp: QP, state: Vector, duration: float) -> int:
        """Advance `state` (size,) in place by `duration` [rho]; returns the iterations taken."""
        ...

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return settings_of(self)
