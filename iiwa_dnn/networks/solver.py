"""The dynamic neural network as a solver of quadratic programs."""

import math
from collections import deque
from functools import lru_cache
from typing import Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import RATES, Network
from iiwa_dnn.networks.integrators import ExplicitEuler, ImplicitEuler, Integrator
from iiwa_dnn.networks.integrators.base import (
    ANSWER,
    CompiledAnswer,
    Settled,
    answer_program,
)
from iiwa_dnn.networks.integrators.equilibration import settle_equilibrated
from iiwa_dnn.networks.integrators.explicit import follow
from iiwa_dnn.networks.integrators.implicit import (
    AT_ONCE,
    settle,
    sharpen_implicit,
)
from iiwa_dnn.networks.projection import ProjectionNetwork, is_projection
from iiwa_dnn.networks.refutation import find_certificate
from iiwa_dnn.qp.layout import Sizes, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import within
from iiwa_dnn.qp.solution import Solution, Status

LARGE = 100
"""Variables from which on starting again is quicker than to look for a proof first."""
SHARPENING = 5
"""Linear systems of `DNNSolver.sharpen`."""

_NETWORK = ProjectionNetwork()
_SETTLER = ImplicitEuler()
_FOLLOWER = ExplicitEuler()
_SOLVED = Status.SOLVED  # to look it up takes longer than to compare
_SETTINGS = ("network", "tol", "settler", "follower")


@lru_cache
def _settle_address() -> int:
    """Return the address of `settle`, compiled at the first call."""
    return ANSWER.address(settle)


class DNNSolver:
    """A network, an integrator and a stopping rule, with a warm start kept between calls.

    The network's state is carried from one program to the next as long as their shapes agree, as a
    control loop wants it. Threads may share a solver: a call takes the state away while it works on
    it, and one that finds none starts from the network's initial state. A copy has a warm start of
    its own.

    Attributes:
        network: The ODE.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        settler: Integrator of `solve`, which runs until the residuals are below `tol`.
        follower: Integrator of `advance`, which runs for a given time.
        version: Number of times that one of these was set anew: a `compiled_answer` of an older
            version is out of date.
    """

    network: Network
    tol: float
    settler: Integrator
    follower: Integrator
    version: int

    def __init__(
        self,
        network: Network | None = None,
        tol: float = 1e-9,
        settler: Integrator | None = None,
        follower: Integrator | None = None,
    ) -> None:
        """Start from the network's initial state.

        Raises:
            InvalidInputError: `tol` is not a positive number, or `network` is not a network.
        """
        self._kept: deque[tuple[Network, Sizes, Vector]] = deque(maxlen=1)
        self.tol = tol
        self.settler = _SETTLER if settler is None else settler
        self.follower = _FOLLOWER if follower is None else follower
        self.network = _NETWORK if network is None else network
        self._first_try = self._first_constants()
        self._follower_answer: tuple[tuple[Sizes, float], CompiledAnswer | None] | None = None
        self.version = 0

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "tol":
            checks.positive("tol", value)
        if name == "network" and not isinstance(value, Network):
            problem = f"must be an object of a Network's class, not {value!r}"
            raise InvalidInputError("network", problem, value)
        super().__setattr__(name, value)
        if name in _SETTINGS and hasattr(self, "version"):
            self._first_try = self._first_constants()
            self._follower_answer = None
            self.version += 1

    def __getstate__(self) -> dict[str, Any]:
        kept = [(network, sizes, state.copy()) for network, sizes, state in tuple(self._kept)]
        return {**self.__dict__, "_kept": deque(kept, maxlen=1)}

    @property
    def state(self) -> Vector:
        """The network's state (size,), a copy; empty if the next call has no warm start."""
        warm = self._warm()
        return np.empty(0) if warm is None else warm[2].copy()

    def reset(self) -> None:
        """Forget the warm start: the next call starts from the network's initial state."""
        self._kept.clear()

    def disturb(self, noise: Vector) -> None:
        """Add noise (n,) [the unit of x] to x of the network's state; the next call starts there.

        Before the first call there is no state yet, and nothing happens.

        Raises:
            InvalidInputError: The network computes x from its state, which does not hold it.
        """
        if not self.network.carries_x:
            raise InvalidInputError("network", "holds no x in its state that could be disturbed")
        warm = self._warm()
        if warm is not None:
            _, (n, _, _), state = warm
            state[:n] += noise

    def warm_state(self, sizes: Sizes) -> Vector | None:
        """Return the state itself, (size,), if the last program had these sizes; otherwise None."""
        try:
            owner, last, state = self._kept[-1]
        except IndexError:  # another thread has it, or there was no call yet
            return None
        return state if last == sizes and owner is self.network else None

    def cold_state(self, sizes: Sizes) -> Vector:
        """Return a new state of the projection network, (size,), from which the next call starts.

        The programs have sizes ``(n, m, p)``.
        """
        n, m, p = sizes
        state = np.zeros(3 * n + m + p)
        self._kept.append((self.network, sizes, state))
        return state

    def compiled_answer(self, sizes: Sizes, duration: float = 0.0) -> CompiledAnswer | None:
        """Return the compiled function that answers programs of these sizes as this solver does.

        Args:
            sizes: ``(n, m, p)`` of the programs.
            duration: Time to advance [s]; 0 stands for `solve`, by its first try.

        Returns:
            The function's address and its arguments; None if network or integrator has none.
        """
        network = self.network
        settler = self.settler
        follower = self.follower
        rates = network.rates_function()
        kind = type(network)
        if rates is None or kind.read is not Network.read or kind.prepare is not Network.prepare:
            return None
        builtin = is_projection(network)
        budget = 0
        long_step = 0.0
        substeps = 0
        # A subclass may integrate in its own way.
        if duration == 0.0 and builtin and type(settler) is ImplicitEuler:
            address = ANSWER.address(settle)
            budget = settler.max_steps
            long_step = settler.long_step
        elif duration > 0.0 and type(follower) is ExplicitEuler and (follower.substeps or builtin):
            address = ANSWER.address(follow)
            substeps = follower.substeps or 0
        else:
            return None
        ahead = duration / network.rho
        constants = [self.tol, budget, long_step, ahead, substeps, *network.constants(sizes)]
        return CompiledAnswer(address, RATES.address(rates), np.array(constants))

    def solve(self, qp: QP) -> Solution:
        """Advance the network until it has settled, and judge the point it has reached.

        Args:
            qp: The program; its values are taken as checked (`QP.check_values`).

        Returns:
            The solution; `found` only if every residual is at most `tol`.
        """
        network = self.network
        tol = self.tol
        state = self._take(network, qp)
        n, m, p = sizes = qp.sizes
        point = np.empty(2 * n + m + p)
        if self._first_try is None:
            settled = self.settler.settle(network, qp, state, point, tol)
        else:
            address = _settle_address()
            settled = answer_program(qp.data, sizes, address, 0, self._first_try, state, point)
        systems, time, primal, dual, gap = settled
        if primal <= tol and dual <= tol and gap <= tol:
            self._kept.append((network, sizes, state))
            # A named tuple's own constructor costs as much as a fifth of the call.
            values = (point, sizes, _SOLVED, systems, time, primal, dual, gap, None)
            return tuple.__new__(Solution, values)
        settled, status, certificate = self._try_again(qp, state, point, settled)
        # The state is not kept without a solution: the multipliers grow without bound then, or are
        # no numbers any more, and would spoil every later call.
        if status is _SOLVED:
            self._kept.append((network, sizes, state))
        return Solution(point, sizes, status, *settled, certificate)

    def sharpen(self, qp: QP, solution: Solution) -> Solution:
        """Go on for a few long steps from the state that the last call left, as far as it helps.

        If the cost has small eigenvalues, x is known to the residuals over these only.

        Args:
            qp: The program of the last call.
            solution: Its solution.

        Returns:
            A solution with smaller residuals, or the same if no step had any.
        """
        settler = self.settler
        warm = self.warm_state(qp.sizes)
        if warm is None or self._first_try is None or not isinstance(settler, ImplicitEuler):
            return solution
        if not solution.found or solution.sizes != qp.sizes:
            return solution
        x = solution.x
        cost = np.abs(qp.q).dot(np.abs(x)) + np.abs(x.dot(qp.P.dot(x)))
        if not 1e-14 * cost < self.tol:  # rounding of the cost is near the tolerance already
            return solution
        state = warm.copy()
        point = solution.point.copy()
        step = settler.long_step
        residuals = sharpen_implicit(qp.data, *qp.sizes, state, point, step, SHARPENING)
        if not max(residuals) < solution.residuals.largest:
            return solution
        self._kept.append((self.network, qp.sizes, state))
        systems = solution.iterations + SHARPENING
        time = solution.network_time + SHARPENING * step
        return Solution(point, qp.sizes, solution.status, systems, time, *residuals)

    def advance(self, qp: QP, duration: float) -> Solution:
        """Advance the network by `duration`, settled or not.

        Args:
            qp: The program, held constant meanwhile.
            duration: Time [s] on the network's own clock.

        Returns:
            The point that the state stands for, with status ``ADVANCED`` and its residuals.
        """
        state = self._take(self.network, qp)
        n, m, p = sizes = qp.sizes
        answer = self._following(sizes, duration)
        if answer is not None:
            point = np.empty(2 * n + m + p)
            settled = answer_program(qp.data, sizes, *answer, state, point)
            if settled[0] > 0:
                return self._judged(sizes, state, point, settled)
        time = duration / self.network.rho
        iterations = self.follower.advance(self.network, qp, state, time)
        return self._advanced(qp, state, iterations, time)

    def _following(self, sizes: Sizes, duration: float) -> CompiledAnswer | None:
        """Return the `compiled_answer` that advances; the last one is kept."""
        if self._follower_answer is None or self._follower_answer[0] != (sizes, duration):
            answer = self.compiled_answer(sizes, duration) if duration > 0.0 else None
            self._follower_answer = ((sizes, duration), answer)
        return self._follower_answer[1]

    def _advanced(self, qp: QP, state: Vector, iterations: int, time: float) -> Solution:
        """Judge the point of a state that was advanced by a time [rho], and keep the state."""
        n, m, p = qp.sizes
        point = np.empty(2 * n + m + p)
        residuals = self.network.read(qp, state, point)
        return self._judged(qp.sizes, state, point, (iterations, time, *residuals))

    def _judged(self, sizes: Sizes, state: Vector, point: Vector, settled: Settled) -> Solution:
        """Make the solution of a state that was advanced, and keep the state if it is finite."""
        status = Status.NOT_FINITE
        # The point of an infinite state is finite, since it is clipped to the bounds.
        if math.isfinite(sum(settled[2:])) and np.isfinite(state).all():
            status = Status.ADVANCED
            self._kept.append((self.network, sizes, state))
        return Solution(point, sizes, status, *settled)

    def _first_constants(self) -> Vector | None:
        """Return the constants of a first try by compiled code.

        None if the network or the integrator has no compiled code that settles it.
        """
        if type(self.settler) is not ImplicitEuler or not is_projection(self.network):
            return None
        budget = min(AT_ONCE, (self.settler.max_steps + 1) // 2)
        return np.array([self.tol, budget, self.settler.long_step])

    def _try_again(
        self, qp: QP, state: Vector, point: Vector, settled: Settled
    ) -> tuple[Settled, Status, Vector | None]:
        """Prove that there is no solution or start again, cold, after a first try failed.

        Returns:
            The progress, the better one of both tries; the status, and the certificate if any.
        """
        if not math.isfinite(sum(settled[2:])):
            return settled, Status.NOT_FINITE, None
        large = qp.sizes[0] >= LARGE
        proof = None if large else find_certificate(qp, point)
        if proof is not None:
            return settled, *proof
        settler = self.settler
        if isinstance(settler, ImplicitEuler) and self._first_try is not None:
            left = settler.max_steps - settled[0]
            other = point.copy()
            again = settle_equilibrated(qp, state, other, self.tol, left)
            systems = settled[0] + again[0]
            if max(again[2:]) < max(settled[2:]):
                point[:] = other
                settled = (systems, settled[1] + again[1], *again[2:])
            else:
                settled = (systems, *settled[1:])
        if within(*settled[2:], self.tol):
            return settled, Status.SOLVED, None
        proof = find_certificate(qp, point) if large else None
        return settled, *(proof or (Status.NOT_SETTLED, None))

    def _warm(self) -> tuple[Network, Sizes, Vector] | None:
        """Return the last network, sizes and state; None while another call has them."""
        try:
            return self._kept[-1]
        except IndexError:
            return None

    def _take(self, network: Network, qp: QP) -> Vector:
        """Take the warm state, or make one; nobody else has it until it is put back."""
        if type(qp) is not QP:
            checks.instance("qp", qp, QP)
        try:
            owner, sizes, state = self._kept.pop()
            if owner is network and sizes == qp.sizes:
                return state
        except IndexError:  # no call yet, or another thread was quicker
            pass
        state = np.array(network.initial_state(qp), dtype=np.float64)
        check_size("network", state, network.state_size(qp))
        return state
