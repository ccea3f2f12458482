"""What every network is: an ODE for one program, and how its state is read."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.qp.layout import Matrix, Vector
from iiwa_dnn.qp.program import QP


class Flow(NamedTuple):
    """A network's right-hand side for one program that does not change meanwhile.

    Attributes:
        rates: rho ds/dt at a state, (state_size,).
        jacobian: Its derivative where it has one, and one of its limits at a kink,
            (state_size, state_size).
    """

    rates: Callable[[Vector], Vector]
    jacobian: Callable[[Vector], Matrix]


@dataclass(frozen=True)
class Network(ABC):
    """A dynamic neural network for one quadratic program after another.

    Attributes:
        rho: Time constant [s].
        carries_x: Whether the state begins with x; otherwise x is computed from it.
    """

    rho: float = 9e-5
    carries_x: ClassVar[bool] = True

    def __post_init__(self) -> None:
        """Check the time constant."""
        checks.positive("rho", self.rho)

    @abstractmethod
    def state_size(self, qp: QP) -> int:
        """Number of states."""

    @abstractmethod
    def flow(self, qp: QP) -> Flow:
        """The right-hand side and its derivative for this program."""

    @abstractmethod
    def read(self, qp: QP, state: Vector, point: Vector) -> tuple[float, float, float]:
        """Write what a state (state_size,) stands for, ``[x | y | z | z_box]``, into `point`.

        Returns:
            Its residuals ``(primal, dual, gap)``, as qpsolvers defines them.
        """

    @abstractmethod
    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """A step, in units of rho, below which explicit Euler is stable; 0 where none is known.

        Args:
            qp: The program.
            state: Where given, (state_size,), the bound need only hold around there.
        """

    def initial_state(self, qp: QP) -> Vector:
        """The state at rest before any problem was seen: zero, (size,)."""
        return np.zeros(self.state_size(qp))

    def rates(self, qp: QP, state: Vector) -> Vector:
        """The right-hand side, rho ds/dt, of shape (state_size,)."""
        return self.flow(qp).rates(state)
