"""The dynamic neural network as a solver of quadratic programs."""

import math
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Network, checked_flow, enter_rates
from iiwa_dnn.networks.integrators import ExplicitEuler, ImplicitEuler, Integrator
from iiwa_dnn.networks.integrators.base import AnswerSettings, CompiledAnswer, enter_answer
from iiwa_dnn.networks.integrators.explicit import advance_explicitly
from iiwa_dnn.networks.integrators.implicit import solve
from iiwa_dnn.networks.integrators.scaling import (
    LARGE,
    STEEP,
    Scaling,
    is_ordinary,
    scaled,
)
from iiwa_dnn.networks.projection import ProjectionNetwork, is_projection
from iiwa_dnn.qp.certificates import find_certificate
from iiwa_dnn.qp.dense import all_finite, is_convex
from iiwa_dnn.qp.layout import Sizes, Triple, Vector, check_size, data_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import is_accepted
from iiwa_dnn.qp.solution import Solution, Status

SHARPENED = 1e-14
SHARPENING = (4, 20)
"""Tolerance of a sharpened solution, and the linear solves of a round, at first and again."""

_COSTS: tuple[float | None, ...] = (None, LARGE, 1.0, None)
"""Largest entries of the cost in the attempts of a `solve`; None: the program as it is."""
_OPEN = (Status.NOT_CONVERGED, Status.NOT_FINITE)
"""Statuses after which another attempt is made."""
DIVERGENCE = 1e8
"""Ratio of a state or a residual to the largest number of a program beyond which it diverges."""

_NETWORK = ProjectionNetwork()
_SOLVE_INTEGRATOR = ImplicitEuler()
_ADVANCE_INTEGRATOR = ExplicitEuler()


@dataclass(frozen=True)
class DNNSolver:
    """A network, two integrators and a stopping rule, with a warm start kept between calls.

    The network's state is carried from one program to the next as long as their shapes agree, as a
    control loop wants it. A call takes the state away while it works on it, so that threads may
    share a solver.

    Attributes:
        network: The ODE.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        solve_integrator: Integrator of `solve`, which runs until the residuals are below `tol`.
        advance_integrator: Integrator of `advance`, which runs for a given time.
        eps_rel: Tolerance on each entry of a residual, relative to the sum of its absolute terms;
            rounding passes in any case (`iiwa_dnn.qp.residuals`).
    """

    network: Network = _NETWORK
    tol: float = 1e-9
    solve_integrator: ImplicitEuler = _SOLVE_INTEGRATOR
    advance_integrator: Integrator = _ADVANCE_INTEGRATOR
    eps_rel: float = 0.0
    _warm: dict[Sizes, Vector] = field(default_factory=dict, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the settings; raises InvalidInputError naming the argument."""
        checks.positive("tol", self.tol)
        checks.not_negative("eps_rel", self.eps_rel)
        checks.instance("network", self.network, Network)
        checks.instance("solve_integrator", self.solve_integrator, ImplicitEuler)

    @property
    def state(self) -> Vector:
        """The network's state (size,), a copy; empty if the next call has no warm start."""
        return next((state.copy() for state in list(self._warm.values())), np.empty(0))

    def reset(self) -> None:
        """Forget the warm start: the next call starts from the network's initial state."""
        self._warm.clear()

    def disturb(self, noise: Vector) -> None:
        """Add noise (k,) [the unit of x] to the first k entries of x in the network's state.

        The next call starts there. Before the first one there is no state yet, and nothing happens.

        Raises:
            InvalidInputError: The network computes x from its state, which does not hold it; or
                there is more noise than entries of x.
        """
        if not self.network.carries_x:
            raise InvalidInputError("network", "holds no x in its state that could be disturbed")
        added = checks.array("noise", noise, (-1,))
        for sizes, state in self._warm.items():
            state[: added.size] += check_size("noise", added, min(added.size, sizes[0]))

    def state_for(self, sizes: Sizes) -> Vector:
        """Return the warm state, no copy, (size,), of programs of these sizes; zeros if none."""
        try:
            return self._warm[sizes]
        except KeyError:
            self._keep(sizes, np.zeros(self.state_size(sizes)))
            return self._warm[sizes]

    def state_size(self, sizes: Sizes) -> int:
        """Count the numbers of the network's state for programs of these sizes."""
        return self.network.state_size(QP.from_data(np.zeros(data_size(*sizes)), sizes))

    def compiled_answer(self, sizes: Sizes, duration: float = 0.0) -> CompiledAnswer | None:
        """Return the compiled function that answers programs of these sizes as this solver does.

        Args:
            sizes: ``(n, m, p)`` of the programs.
            duration: Time to advance [s]; 0 solves, as `solve` does without its attempts in scaled
                units.

        Returns:
            The function's address and its arguments; None if network or integrator has none.
        """
        network = self.network
        function = type(network).compiled_rates
        if function is None or type(network).flow is not Network.flow:
            return None
        integrator = self.advance_integrator if duration > 0.0 else self.solve_integrator
        substeps = getattr(integrator, "substeps", None)
        # A subclass may integrate in its own way.
        own = ExplicitEuler if duration > 0.0 else ImplicitEuler
        if type(integrator) is not own or not (is_projection(network) or substeps):
            return None
        constants = [
            self.tol,
            self.solve_integrator.max_steps,
            duration / network.rho,
            substeps or 0,
        ]
        address = enter_answer.address(advance_explicitly if duration > 0.0 else solve)
        rates = enter_rates.address(function) if duration > 0.0 else 0
        settings = AnswerSettings.of(np.array([*constants, *network.constants(sizes)]))
        return CompiledAnswer(address, rates, settings)

    def solve(self, qp: QP) -> Solution:
        """Solve the program: advance the network to convergence, and judge the point.

        If `ProjectionNetwork` does not converge and no certificate is found, further attempts
        follow: from a state of zero on the program in scaled units, with a largest entry of the
        cost of 1e3, and from there of 1, and in the program's units. If the largest entry of a row
        is below 1e-3 or above 1e3, or that of the cost below 1e-3, the attempt in the program's
        units that comes first is left out. Other networks have one attempt, in the program's units.

        Args:
            qp: The program; its values are taken as checked (`QP.check_values`).

        Returns:
            The solution; `found` only if P is convex and `QP.accepts` the point. `iterations`
            counts the linear solves of all attempts, at most `solve_integrator.max_steps`.
        """
        return self._solve(qp, self._take(qp), False)

    def solve_cold(self, qp: QP, sharpen: bool = False) -> Solution:
        """Solve a program from the network's initial state, whatever other threads solve.

        Args:
            qp: The program; its values are taken as checked (`QP.check_values`).
            sharpen: Whether to take a few more steps, until the residuals are rounding.
        """
        self.reset()
        return self._solve(qp, self._fresh(qp), sharpen)

    def _solve(self, qp: QP, state: Vector, sharpen: bool) -> Solution:
        """Make the attempts of a `solve` from a state (size,), and keep the state of a solution."""
        qp, costs = self._attempts(qp)
        taken = 0
        time = 0.0
        for cost in costs:
            if cost == LARGE and taken > 0:
                state[:] = 0.0
            scaling = scaled(qp, cost) if cost else None
            left = self.solve_integrator.max_steps - taken
            solution = self._attempt(qp, scaling, state, self.tol, left)
            taken += solution.iterations
            time += solution.network_time
            if solution.status not in _OPEN or taken >= self.solve_integrator.max_steps:
                break
        if taken > solution.iterations:
            solution = solution._replace(iterations=taken, network_time=time)
        if sharpen:
            solution = self._sharpened(qp, solution, state)
        # Without a solution the multipliers grow without bound, and would spoil every later call.
        if solution.found:
            self._keep(qp.sizes, state)
        return solution

    def _attempts(self, qp: QP) -> tuple[QP, tuple[float | None, ...]]:
        """Return a program, and the largest entry of the cost in each attempt (`scaled`)."""
        costs = _COSTS if is_projection(self.network) else _COSTS[:1]
        if is_ordinary(qp.data, *qp.sizes):
            return qp, costs
        return QP(*qp.views), costs[1:] or costs  # P becomes symmetric

    def _attempt(
        self, qp: QP, scaling: Scaling | None, state: Vector, tol: float, budget: int
    ) -> Solution:
        """Solve the program by the network, and judge the point that it reaches.

        Args:
            qp: The program.
            scaling: The program in other units, in which the network converges; None: in its own.
            state: State of the program as it is, (size,), advanced.
            tol: Tolerance that ends the steps, in the program's units.
            budget: Largest number of linear solves.
        """
        n, m, p = qp.sizes
        point = np.empty(2 * n + m + p)
        solve_integrator = self.solve_integrator
        if budget < solve_integrator.max_steps:
            solve_integrator = replace(solve_integrator, max_steps=budget)
        if scaling is None:
            stats = solve_integrator.solve(self.network, qp, state, point, tol)
        else:
            state /= scaling.of_state
            tol *= scaling.of_tolerance
            stats = solve_integrator.solve(self.network, scaling.qp, state, point, tol)
            state *= scaling.of_state
            point *= scaling.of_point
            stats = *stats[:2], *qp.residuals(point)
        status = self._status(qp, point, stats[2:])
        certificate = None
        if status is Status.NOT_CONVERGED:
            find = find_certificate if scaling is None else scaling.find_certificate
            status, certificate = find(qp, point)
        return Solution(point, qp.sizes, status, *stats, certificate)

    def _status(self, qp: QP, point: Vector, residuals: Triple) -> Status:
        """Judge a point by its residuals, and the cost by a Cholesky factor."""
        if is_accepted(qp.data, *qp.sizes, point, self.tol, self.eps_rel):
            return Status.SOLVED
        if not math.isfinite(sum(residuals)):
            return Status.NOT_FINITE
        return Status.NOT_CONVERGED if is_convex(qp.P, np.empty_like(qp.P)) else Status.NOT_CONVEX

    def _sharpened(self, qp: QP, solution: Solution, state: Vector) -> Solution:
        """Reduce the residuals of a solution by a few more linear solves from its state (size,).

        If the cost has small eigenvalues, the error of x may be as large as the residuals over
        these. So each round first solves with a steeper cost
        (`iiwa_dnn.networks.integrators.scaling`), which converges sooner there. The state is
        advanced where that has reduced the residuals.

        Returns:
            A solution with smaller residuals, or the same if no step had any.
        """
        if not solution.found or not is_projection(self.network):
            return solution
        for most, is_steep in product(SHARPENING, (True, False)):
            left = min(most, self.solve_integrator.max_steps - solution.iterations)
            if left < 1 or solution.residuals.largest <= SHARPENED:
                break
            new = state.copy()
            scaling = scaled(qp, STEEP, 0) if is_steep else None
            sharper = self._attempt(qp, scaling, new, SHARPENED, left)
            if sharper.found and sharper.residuals.largest < solution.residuals.largest:
                state[:] = new
                solution = sharper._replace(
                    iterations=solution.iterations + sharper.iterations,
                    network_time=solution.network_time + sharper.network_time,
                )
        return solution

    def advance(self, qp: QP, duration: float) -> Solution:
        """Advance the network by `duration`, converged or not.

        Args:
            qp: The program, held constant meanwhile.
            duration: Time [s] on the network's own clock.

        Returns:
            The point of the state and its residuals, with status ``ADVANCED``, ``DIVERGED`` or
            ``NOT_FINITE``. The next call continues from the state unless that is not finite.

        Raises:
            InvalidInputError: The duration is no finite number above 0; or as
                `ExplicitEuler.advance`.
        """
        time = checks.positive("duration", duration) / self.network.rho
        state = self._take(qp)
        iterations = self.advance_integrator.advance(self.network, qp, state, time)
        return self._advanced(qp, state, iterations, time)

    def _advanced(self, qp: QP, state: Vector, iterations: int, time: float) -> Solution:
        """Judge the point of a state that was advanced by a time [rho]; keep a finite state."""
        n, m, p = qp.sizes
        point = np.empty(2 * n + m + p)
        residuals = checked_flow(self.network, qp).read(qp, state, point)
        status = Status.NOT_FINITE
        # The point of an infinite state is finite, since it is clipped to the bounds.
        if math.isfinite(sum(residuals)) and np.isfinite(state).all():
            numbers = np.abs(qp.data[np.isfinite(qp.data)]).max(initial=1.0)
            far = max(*residuals, np.abs(state).max()) > DIVERGENCE * numbers
            status = Status.DIVERGED if far else Status.ADVANCED
            self._keep(qp.sizes, state)
        return Solution(point, qp.sizes, status, iterations, time, *residuals)

    def _take(self, qp: QP) -> Vector:
        """Take the warm state away, so that no other thread has it; make one if there is none."""
        state = self._warm.pop(checks.instance("qp", qp, QP).sizes, None)
        if state is None or not all_finite(state, 0, state.size):
            state = self._fresh(qp)
        return state

    def _fresh(self, qp: QP) -> Vector:
        """Make the network's initial state of zeros (size,), and check the size of its rates."""
        state = np.zeros(checks.integer("state_size", self.network.state_size(qp), 0))
        if not is_projection(self.network):
            check_size(
                f"rates of {type(self.network).__name__}",
                np.asarray(self.network.rates(qp, state)),
                state.size,
            )
        return state

    def _keep(self, sizes: Sizes, state: Vector) -> None:
        """Keep the state (size,) as the only warm one, for programs of these sizes."""
        self._warm.clear()
        self._warm[sizes] = state
