"""The dynamic neural network as a solver of quadratic programs."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Network, enter_rates
from iiwa_dnn.networks.integrators import ExplicitEuler, ImplicitEuler, Integrator
from iiwa_dnn.networks.integrators.base import CompiledAnswer, Settled, answer_program, enter_answer
from iiwa_dnn.networks.integrators.explicit import follow
from iiwa_dnn.networks.integrators.implicit import settle_address, settle_program
from iiwa_dnn.networks.integrators.scaling import equilibrate
from iiwa_dnn.networks.projection import ProjectionNetwork, is_projection
from iiwa_dnn.qp.certificates import find_certificate
from iiwa_dnn.qp.layout import Sizes, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Solution, Status

SHARPENED = 1e-14
SHARPENING = 20
"""Tolerance of `DNNSolver.sharpen`, and its linear systems."""

STRICTER = 1e-3
"""Tolerance in scaled coordinates over that in the program's own, where the residuals grow."""


@dataclass(frozen=True)
class DNNSolver:
    """A network, two integrators and a stopping rule, with a warm start kept between calls.

    The network's state is carried from one program to the next as long as their shapes agree, as a
    control loop wants it. A call takes the state away while it works on it, so that threads may
    share a solver; a copy has a warm start of its own.

    Attributes:
        network: The ODE.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        settler: Integrator of `solve`, which runs until the residuals are below `tol`.
        follower: Integrator of `advance`, which runs for a given time.
    """

    network: Network = field(default_factory=ProjectionNetwork)
    tol: float = 1e-9
    settler: ImplicitEuler = field(default_factory=ImplicitEuler)
    follower: Integrator = field(default_factory=ExplicitEuler)
    _warm: dict[Sizes, Vector] = field(default_factory=dict, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the settings; raises InvalidInputError naming the argument."""
        checks.positive("tol", self.tol)
        checks.instance("network", self.network, Network)
        checks.instance("settler", self.settler, ImplicitEuler)

    def __getstate__(self) -> dict[str, Any]:
        warm = {sizes: state.copy() for sizes, state in self._warm.items()}
        return {**self.__dict__, "_warm": warm}

    @property
    def state(self) -> Vector:
        """The network's state (size,), a copy; empty if the next call has no warm start."""
        return next((state.copy() for state in list(self._warm.values())), np.empty(0))

    def reset(self) -> None:
        """Forget the warm start: the next call starts from the network's initial state."""
        self._warm.clear()

    def disturb(self, noise: Vector) -> None:
        """Add noise (n,) [the unit of x] to x of the network's state; the next call starts there.

        Before the first call there is no state yet, and nothing happens.

        Raises:
            InvalidInputError: The network computes x from its state, which does not hold it.
        """
        if not self.network.carries_x:
            raise InvalidInputError("network", "holds no x in its state that could be disturbed")
        for state in self._warm.values():
            state[: noise.size] += noise

    def warm_state(self, sizes: Sizes) -> Vector | None:
        """Return the state itself, (size,), if the last program had these sizes; otherwise None."""
        return self._warm.get(sizes)

    def cold_state(self, sizes: Sizes) -> Vector:
        """Return a new state of the projection network, (size,), from which the next call starts.

        The programs have sizes ``(n, m, p)``.
        """
        n, m, p = sizes
        self._keep(sizes, np.zeros(3 * n + m + p))
        return self._warm[sizes]

    def compiled_answer(self, sizes: Sizes, duration: float = 0.0) -> CompiledAnswer | None:
        """Return the compiled function that answers programs of these sizes as this solver does.

        Args:
            sizes: ``(n, m, p)`` of the programs.
            duration: Time to advance [s]; 0 stands for `solve`, by its first try.

        Returns:
            The function's address and its arguments; None if network or integrator has none.
        """
        network = self.network
        builtin = is_projection(network)
        function = type(network).compiled_rates
        if function is None or not (builtin or type(network).flow is Network.flow):
            return None
        substeps = 0
        # A subclass may integrate in its own way.
        if duration == 0.0 and builtin and type(self.settler) is ImplicitEuler:
            address = settle_address()
        elif duration > 0.0 and type(self.follower) is ExplicitEuler:
            substeps = self.follower.substeps or 0
            if not (substeps or builtin):
                return None
            address = enter_answer.address(follow)
        else:
            return None
        budget = self.settler.max_steps
        ahead = duration / network.rho
        constants = [self.tol, budget, ahead, substeps, *network.constants(sizes)]
        return CompiledAnswer(address, enter_rates.address(function), np.array(constants))

    def solve(self, qp: QP) -> Solution:
        """Advance the network until it has settled, and judge the point it has reached.

        Where it does not settle and no certificate is found, it starts once more, from zero, in
        coordinates in which no row of the program stands out.

        Args:
            qp: The program; its values are taken as checked (`QP.check_values`).

        Returns:
            The solution; `found` only if every residual is at most `tol`.
        """
        state = self._take(qp)
        n, m, p = sizes = qp.sizes
        point = np.empty(2 * n + m + p)
        first = self._first_start
        if first is None:
            settled = self.settler.settle(self.network, qp, state, point, self.tol)
        else:
            settled = answer_program(qp.data, sizes, settle_address(), 0, first, state, point)
        if not self._is_within(settled):
            if not math.isfinite(sum(settled[2:])):
                return Solution(point, sizes, Status.NOT_FINITE, *settled)
            certificate = find_certificate(qp, point)
            if certificate is not None:
                return Solution(point, sizes, certificate[0], *settled, certificate[1])
            if first is not None:
                left = self.settler.max_steps - settled[0]
                settled = settle_scaled(qp, state, point, self.tol, left, settled)
            if not self._is_within(settled):
                return Solution(point, sizes, Status.NOT_SETTLED, *settled)
        # Without a solution the state is not kept: the multipliers grow without bound then, and
        # would spoil every later call.
        self._keep(sizes, state)
        return Solution(point, sizes, Status.SOLVED, *settled)

    @cached_property
    def _first_start(self) -> Vector | None:
        """Constants of the compiled `settle`, which leaves half of the budget to a second start.

        None for another network or integrator.
        """
        if type(self.settler) is not ImplicitEuler or not is_projection(self.network):
            return None
        return np.array([self.tol, (self.settler.max_steps + 1) // 2])

    def _is_within(self, settled: Settled) -> bool:
        """Check that no residual is above the tolerance, and none NaN."""
        tol = self.tol
        return settled[2] <= tol and settled[3] <= tol and settled[4] <= tol

    def sharpen(self, qp: QP, solution: Solution) -> Solution:
        """Go on from the state that the last call left, for a few linear systems.

        If the cost has small eigenvalues, x is known to the residuals over these only.

        Args:
            qp: The program of the last call.
            solution: Its solution.

        Returns:
            A solution with smaller residuals, or the same if no step had any.
        """
        warm = self.warm_state(qp.sizes)
        if warm is None or not solution.found or not is_projection(self.network):
            return solution
        state = warm.copy()
        point = np.empty_like(solution.point)
        settled = settle_program(qp, state, point, SHARPENED, SHARPENING)
        if not max(settled[2:]) < solution.residuals.largest:
            return solution
        self._keep(qp.sizes, state)
        systems = solution.iterations + settled[0]
        time = solution.network_time + settled[1]
        return Solution(point, qp.sizes, solution.status, systems, time, *settled[2:])

    def advance(self, qp: QP, duration: float) -> Solution:
        """Advance the network by `duration`, settled or not.

        Args:
            qp: The program, held constant meanwhile.
            duration: Time [s] on the network's own clock.

        Returns:
            The point that the state stands for, with status ``ADVANCED`` and its residuals.
        """
        state = self._take(qp)
        time = duration / self.network.rho
        iterations = self.follower.advance(self.network, qp, state, time)
        return self._advanced(qp, state, iterations, time)

    def _advanced(self, qp: QP, state: Vector, iterations: int, time: float) -> Solution:
        """Judge the point of a state that was advanced by a time [rho]; keep it if it is finite."""
        n, m, p = qp.sizes
        point = np.empty(2 * n + m + p)
        residuals = self.network.read(qp, state, point)
        status = Status.NOT_FINITE
        # The point of an infinite state is finite, since it is clipped to the bounds.
        if math.isfinite(sum(residuals)) and np.isfinite(state).all():
            status = Status.ADVANCED
            self._keep(qp.sizes, state)
        return Solution(point, qp.sizes, status, iterations, time, *residuals)

    def _take(self, qp: QP) -> Vector:
        """Take the warm state, or make one; nobody else has it until it is kept."""
        if type(qp) is not QP:
            checks.instance("qp", qp, QP)
        state = self._warm.pop(qp.sizes, None)
        if state is None:
            state = np.array(self.network.initial_state(qp), dtype=np.float64)
            check_size("network", state, self.network.state_size(qp))
        return state

    def _keep(self, sizes: Sizes, state: Vector) -> None:
        """Keep the state (size,) of programs of these sizes alone."""
        self._warm.clear()
        self._warm[sizes] = state


def settle_scaled(
    qp: QP, state: Vector, point: Vector, tol: float, budget: int, before: Settled
) -> Settled:
    """Settle a program from zero in scaled coordinates, then in its own; keep the better point.

    The state is (3 n + m + p,), the point (2 n + m + p,) that of the progress `before`.
    """
    scaled, units, cost = equilibrate(qp)
    state[:] = 0.0
    other = np.empty_like(point)
    stricter = STRICTER * tol * min(1.0, cost)
    first = settle_program(scaled, state, other, stricter, budget)
    state *= units
    second = settle_program(qp, state, other, tol, budget - first[0])
    residuals = before[2:]
    if max(second[2:]) < max(residuals):
        point[:] = other
        residuals = second[2:]
    systems = before[0] + first[0] + second[0]
    return systems, before[1] + first[1] + second[1], *residuals
