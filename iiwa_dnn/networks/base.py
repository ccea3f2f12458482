"""Dynamic neural network: an ODE for one quadratic program, and the reading of its state."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp.layout import Matrix, Triple, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point


class Flow(NamedTuple):
    """A network's right-hand side for one program that does not change meanwhile.

    Attributes:
        rates: rho ds/dt at a state, (state_size,).
        jacobian: Its derivative where it has one, and one of its limits at a kink,
            (state_size, state_size).
    """

    rates: Callable[[Vector], Vector]
    jacobian: Callable[[Vector], Matrix]


class CompiledForm(NamedTuple):
    """The compiled loops of the projection network, which stand in for a network's methods.

    Attributes:
        project: True if x goes through its bounds.
    """

    project: bool


@dataclass(frozen=True)
class Network(ABC):
    """A dynamic neural network for one quadratic program after another.

    Attributes:
        rho: Time constant [s].
        carries_x: True if the state begins with x; otherwise x is computed from it.
    """

    rho: float = 9e-5
    carries_x: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Check the time constant."""
        checks.positive("rho", self.rho)

    @abstractmethod
    def state_size(self, qp: QP) -> int:
        """Count the states."""

    @abstractmethod
    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side and its derivative for this program."""

    def moving_flow(self, qp: QP, rate: QP) -> Flow:
        """Make the right-hand side for this program while it changes.

        Args:
            qp: The program.
            rate: Its rate of change [1/rho], field by field, zero where a field is infinite. A
                network for a program that stands still leaves it out.
        """
        return self.flow(qp)

    @abstractmethod
    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point ``[x | y | z | z_box]`` of a state (state_size,) into `point`.

        Returns:
            Its residuals ``(primal, dual, gap)``, as qpsolvers defines them.
        """

    @abstractmethod
    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """Bound the stable steps of explicit Euler [rho]; 0 where none is known to be stable.

        Args:
            qp: The program.
            state: A state, (state_size,), around which the bound has to hold; None: everywhere.
        """

    @property
    def compiled(self) -> CompiledForm | None:
        """Compiled loops that integrate exactly this network; None where there are none."""
        return None

    def initial_state(self, qp: QP) -> Vector:
        """Make the state before any program was seen: zero, (state_size,)."""
        return np.zeros(self.state_size(qp))

    def rates(self, qp: QP, state: Vector) -> Vector:
        """Evaluate the right-hand side, rho ds/dt, of shape (state_size,)."""
        return self.flow(qp).rates(state)

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return settings_of(self)


def read_point(qp: QP, state: Vector, point: Vector, size: int) -> Triple:
    """Write the point of ``[x | y | z | ...]``, of this size, into `point`; see `Network.read`."""
    n, m, p = qp.sizes
    check_size("state", state, size)
    check_size("point", point, 2 * n + m + p)
    return kkt_point(qp.data, n, m, p, state, point)


def difference_jacobian(rates: Callable[[Vector], Vector], state: Vector) -> Matrix:
    """Differentiate rates at a state (size,) by central differences, (size, size)."""
    steps = 1e-6 * np.maximum(1.0, np.abs(state)) * np.eye(state.size)
    return np.array(
        [(rates(state + step) - rates(state - step)) / (2.0 * step.max()) for step in steps]
    ).T


def settings_of(part: Any) -> dict[str, Any]:
    """Name a network or an integrator, a dataclass, and its fields as values of JSON types."""
    fields = {name: np.asarray(value).tolist() for name, value in asdict(part).items()}
    return {"name": type(part).__name__, **fields}
