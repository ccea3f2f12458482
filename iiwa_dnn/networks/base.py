"""Dynamic neural network: an ODE for one quadratic program, and the reading of its state."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.compiling.library import entry
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.layout import Matrix, QPViews, Sizes, Triple, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import kkt_point


@entry
def enter_rates(address: int, qp: QPViews, constants: Vector, state: Vector, rates: Vector) -> None:
    """Call a network's function by its address, to write rho ds/dt at a state into `rates`.

    State and rates are (size,), the network's constants are (k,).
    """


class Flow(NamedTuple):
    """A network that was set up for one program.

    Attributes:
        rates: rho ds/dt at a state, (state_size,).
        jacobian: Its derivative where it has one, and one of its limits at a kink,
            (state_size, state_size); None: it is computed by differences.
        unknowns: ``[x | y | z]`` of a state, (n + p + m,); None: the state begins with them.
    """

    rates: Callable[[Vector], Vector]
    jacobian: Callable[[Vector], Matrix] | None = None
    unknowns: Callable[[Vector], Vector] | None = None

    def derivative(self, state: Vector) -> Matrix:
        """Differentiate the rates at a state (size,), (size, size)."""
        if self.jacobian is not None:
            return checks.array("jacobian", self.jacobian(state), (state.size, state.size))
        steps = 1e-6 * np.maximum(1.0, np.abs(state)) * np.eye(state.size)
        rows = [
            (self.rates(state + step) - self.rates(state - step)) / (2.0 * step.max())
            for step in steps
        ]
        return np.array(rows).T

    def linear_limit(self, state: Vector) -> float:
        r"""Compute the largest step [rho] of explicit Euler that is stable on the active set.

        Eigenvalues :math:`\lambda` of the derivative at the state (size,) ask for
        :math:`|1 + h \lambda| \le 1`. Those at zero, of dependent rows, are left out. It is 0 where
        an eigenvalue has no negative real part.
        """
        # Values that are not finite say nothing of a step; the state becomes like them.
        eigenvalues = np.linalg.eigvals(
            np.nan_to_num(self.derivative(state), posinf=0.0, neginf=0.0)
        )
        squares = np.abs(eigenvalues) ** 2
        moving = squares > 1e-14 * squares.max(initial=1e-300)
        bounds = -2.0 * eigenvalues.real[moving] / squares[moving]
        return max(0.0, float(bounds.min(initial=2.0)))

    def read(self, qp: QP, state: Vector, point: Vector) -> Triple:
        """Write the point ``[x | y | z | z_box]`` of a state into `point`, (2 n + m + p,).

        Returns:
            Its residuals ``(primal, dual, gap)``, as qpsolvers defines them.
        """
        size = sum(qp.sizes)
        check_size("point", point, size + qp.sizes[0])
        unknowns = state if self.unknowns is None else self.unknowns(state)
        check_size("state", unknowns[:size], size)
        return kkt_point(qp.views, unknowns, point)


@dataclass(frozen=True, kw_only=True)
class Network:
    """Base of the dynamic neural networks, whose equilibria solve a quadratic program.

    A subclass defines `flow` or `compiled_rates`.

    Attributes:
        rho: Time constant [s].
        carries_x: True if the state begins with x; otherwise x is computed from it.
        compiled_rates: The right-hand side, rates (size,) at a state (size,), as a static compiled
            function of the type `enter_rates`, if it has one.
    """

    rho: float = 9e-5
    carries_x: ClassVar[bool] = True
    compiled_rates: ClassVar[staticmethod[[QPViews, Vector, Vector, Vector], None] | None] = None

    def __post_init__(self) -> None:
        """Check the time constant."""
        checks.positive("rho", self.rho)

    def state_size(self, qp: QP) -> int:
        """Count the states, which are zero at first; by default n + m + p."""
        return sum(qp.sizes)

    def constants(self, sizes: Sizes) -> Vector:
        """Return the constants of `compiled_rates` for programs of these sizes (n, m, p)."""
        return np.empty(0)

    def flow(self, qp: QP, rate: QP | None = None) -> Flow:
        """Set the network up for a program; by default with the rates of `compiled_rates`.

        Args:
            qp: The program.
            rate: Rate of change of the program's fields [1/rho], zero where a field is infinite;
                None for a program that does not change. Most networks ignore the rate.
        """
        if self.compiled_rates is None:
            raise InvalidInputError(
                type(self).__name__, "has neither flow nor compiled_rates", self
            )
        address = enter_rates.address(type(self).compiled_rates)
        constants = self.constants(qp.sizes)
        views = qp.views
        size = self.state_size(qp)

        def rates(state: Vector) -> Vector:
            check_size("state", state, size)
            result = np.empty(size)
            enter_rates(address, views, constants, state, result)
            return result

        return Flow(rates)

    def rates(self, qp: QP, state: Vector) -> Vector:
        """Evaluate the right-hand side, rho ds/dt, of shape (state_size,)."""
        return checked_flow(self, qp).rates(state)

    def stable_step(self, qp: QP, state: Vector) -> float:
        """Bound the stable steps of explicit Euler around a state (state_size,), in units of rho.

        The bound is 0 if no step is known to be stable; by default it is `Flow.linear_limit`.
        """
        return checked_flow(self, qp).linear_limit(state)

    def work(self, sizes: Sizes) -> tuple[float, float]:
        """Count the floating-point operations of one program's set-up and of one evaluation.

        By default the set-up counts 0, and an evaluation as a product of a square matrix with
        n + m + p numbers.

        Args:
            sizes: Sizes (n, m, p) of the program.
        """
        return 0.0, 2.0 * sum(sizes) ** 2

    def settings(self) -> dict[str, Any]:
        """Return name and parameters, as values that JSON can hold."""
        return settings_of(self)


def checked_flow(network: Network, qp: QP, rate: QP | None = None) -> Flow:
    """Set a program up by `Network.flow`; refuse a method that returns anything but a `Flow`."""
    flow = network.flow(qp) if rate is None else network.flow(qp, rate)
    return checks.instance(f"{type(network).__name__}.flow", flow, Flow)


def kkt_product(sizes: Sizes) -> float:
    """Count the operations of one product with the KKT matrix of a program of sizes (n, m, p)."""
    n, m, p = sizes
    return 2.0 * n**2 + 4.0 * n * (m + p)


def settings_of(part: Any) -> dict[str, Any]:
    """Return the name and the fields of a network or an integrator, a dataclass, in JSON types."""
    values = {each.name: getattr(part, each.name) for each in fields(part)}
    return {
        "name": type(part).__name__,
        **{
            name: settings_of(value) if is_dataclass(value) else np.asarray(value).tolist()
            for name, value in values.items()
        },
    }
