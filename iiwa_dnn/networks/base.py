"""Dynamic neural network: an ODE for one quadratic program, and the reading of its state."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numba import types

from iiwa_dnn import checks
from iiwa_dnn.qp.compiling import VECTOR, Signature
from iiwa_dnn.qp.layout import (
    QP_VIEWS,
    Matrix,
    QPViews,
    Sizes,
    Triple,
    Vector,
    check_size,
    compiled,
    qp_views,
)
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import point_of_state


class Flow(NamedTuple):
    """A network's right-hand side for one program that does not change meanwhile.

    Attributes:
        rates: rho ds/dt at a state, (state_size,).
        jacobian: Its derivative where it has one, and one of its limits at a kink,
            (state_size, state_size).
    """

    rates: Callable[[Vector], Vector]
    jacobian: Callable[[Vector], Matrix]


_STOOD_IN_FOR = frozenset({"state_size", "flow", "moving_flow", "prepare", "read", "stable_step"})

Rates = Callable[[QPViews, Vector, Vector, Vector], None]
"""Compiled function ``(qp, constants, state, rates)`` that writes rho ds/dt into `rates`."""

RATES = Signature(types.void, QP_VIEWS, VECTOR, VECTOR, VECTOR)
"""Types of a network's compiled function."""

enter_rates = RATES.enter


@compiled
def evaluate_rates(
    data: Vector,
    n: int,
    m: int,
    p: int,
    address: int,
    constants: Vector,
    state: Vector,
    rates: Vector,
) -> None:
    """Write the rates (size,) at a state (size,) of the network whose function is at the address.

    The program is `QP.data`; the constants (k,) are those of `Network.constants`.
    """
    enter_rates(address, qp_views(data, n, m, p), constants, state, rates)


@dataclass(frozen=True, kw_only=True)
class Network(ABC):
    """A dynamic neural network for one quadratic program after another.

    Attributes:
        rho: Time constant [s].
        carries_x: True if the state begins with x; otherwise x is computed from it.
        compiled_rates: The right-hand side, rates (size,) at a state (size,), as a static compiled
            function (`Rates`), if it has one.
    """

    rho: float = 9e-5
    carries_x: ClassVar[bool] = True
    compiled_rates: ClassVar[staticmethod[[QPViews, Vector, Vector, Vector], None] | None] = None

    def __post_init__(self) -> None:
        """Check the time constant."""
        checks.positive("rho", self.rho)

    @abstractmethod
    def state_size(self, qp: QP) -> int:
        """Count the states."""

    def constants(self, sizes: Sizes) -> Vector:
        """Return the constants of `compiled_rates` for programs of these sizes (n, m, p)."""
        return np.empty(0)

    def prepare(self, qp: QP) -> Vector:
        """Return the constants of `compiled_rates` for one program, (k,).

        By default they are those of its sizes. A network that sets its program up first
        overrides this, and has no compiled answer then.
        """
        return self.constants(qp.sizes)

    def flow(self, qp: QP) -> Flow:
        """Make the right-hand side and its derivative for this program.

        By default the rates are those of `compiled_rates`, differentiated numerically.
        """
        function = type(self).compiled_rates
        if function is None:
            raise NotImplementedError(f"{type(self).__name__} has no flow and no compiled_rates")
        address = RATES.address(function)
        constants = self.prepare(qp)
        size = self.state_size(qp)

        def rates(state: Vector) -> Vector:
            check_size("state", state, size)
            result = np.empty(size)
            evaluate_rates(qp.data, *qp.sizes, address, constants, state, result)
            return result

        return Flow(rates, lambda state: difference_jacobian(rates, state))

    def moving_flow(self, qp: QP, rate: QP) -> Flow:
        """Make the right-hand side for this program while it changes.

        Args:
            qp: The program.
            rate: Its rate of change [1/rho], field by field, zero where a field is infinite. A
                network for a program that stands still leaves it out.
        """
        return self.flow(qp)

    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point ``[x | y | z | z_box]`` of a state (state_size,) into `point`.

        By default the state begins with ``[x | y | z]``.

        Returns:
            Its residuals ``(primal, dual, gap)``, as qpsolvers defines them.
        """
        return read_point(qp, state, point, self.state_size(qp))

    @abstractmethod
    def stable_step(self, qp: QP, state: Vector | None = None) -> float:
        """Bound the stable steps of explicit Euler [rho]; 0 where none is known to be stable.

        Args:
            qp: The program.
            state: A state, (state_size,), around which the bound has to hold; None: everywhere.
        """

    def linear_limit(self, qp: QP, state: Vector) -> float:
        r"""Compute the largest step [rho] of explicit Euler that is stable on the active set.

        Eigenvalues :math:`\lambda` of the derivative at the state (state_size,) ask for
        :math:`|1 + h \lambda| \le 1`. Those at zero, of dependent rows, are left out. It is 0 where
        an eigenvalue has no negative real part.
        """
        eigenvalues = np.linalg.eigvals(self.flow(qp).jacobian(state))
        squares = np.abs(eigenvalues) ** 2
        moving = squares > 1e-14 * squares.max(initial=1e-300)
        bounds = -2.0 * eigenvalues.real[moving] / squares[moving]
        return max(0.0, float(bounds.min(initial=2.0)))

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the floating-point operations of one program's set-up and of one evaluation.

        By default an evaluation is a product of a square matrix with n + m + p numbers. A subclass
        counts its own; sizes are (n, m, p).
        """
        return 0.0, 2.0 * sum(sizes) ** 2

    def rates_function(self) -> Rates | None:
        """Return `compiled_rates`, unless a subclass has overridden what it stands in for."""
        for cls in type(self).__mro__:
            if "compiled_rates" in vars(cls):
                return cls.compiled_rates  # type: ignore[attr-defined,no-any-return]
            if not _STOOD_IN_FOR.isdisjoint(vars(cls)):
                return None
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


def kkt_product(sizes: Sizes) -> float:
    """Count the operations of one product with the KKT matrix of a program of sizes (n, m, p)."""
    n, m, p = sizes
    return 2.0 * n**2 + 4.0 * n * (m + p)


def read_point(qp: QP, state: Vector, point: Vector, size: int) -> Triple:
    """Write the point of ``[x | y | z | ...]``, of this size, into `point`; see `Network.read`."""
    n, m, p = qp.sizes
    check_size("state", state, size)
    check_size("point", point, 2 * n + m + p)
    return point_of_state(qp.data, n, m, p, state, point)


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
