"""The dynamic neural network as a solver of quadratic programs."""

from __future__ import annotations

import math
from collections import deque
from typing import TYPE_CHECKING, Any

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.integrators import (
    SAFETY,
    ExplicitEuler,
    ImplicitEuler,
    Integrator,
    barrier,
    closing,
)
from iiwa_dnn.networks.integrators.base import Settled
from iiwa_dnn.networks.integrators.implicit import settle_implicit, sharpen_implicit
from iiwa_dnn.networks.projection import ProjectionNetwork
from iiwa_dnn.networks.refutation import find_certificate
from iiwa_dnn.qp.layout import Sizes, Vector, check_size
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.residuals import within
from iiwa_dnn.qp.solution import Solution, Status

if TYPE_CHECKING:
    pass

LARGE, HUGE = 150, 400
"""Variables from which on the barrier comes before the search for a certificate, and from which on
a cold start goes through it at once."""
SPARSE = 0.1
"""Share of numbers that are not zero below which a large program goes through the barrier first."""
SHARPENING = 5
"""Linear systems of `DNNSolver.sharpen`."""
WORK = 20_000
"""Linear systems times variables of a first try: the rest of the budget is for the second."""

_NETWORK, _SETTLER, _FOLLOWER = ProjectionNetwork(), ImplicitEuler(), ExplicitEuler()
_PARTS = ("network", "tol", "settler", "follower")


class DNNSolver:
    """A network, an integrator and a stopping rule, with a warm start kept between calls.

    The network's state is carried from one program to the next as long as their shapes agree, as a
    control loop wants it. Threads may share a solver: a call takes the state away while it works on
    it, and one that finds none starts from the network's initial state.

    Attributes:
        network: The ODE.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        settler: Integrator of `solve`, which runs until the residuals are below `tol`.
        follower: Integrator of `advance`, which runs for a given time.
        version: Number of times that one of these was set anew: `numbers` of an older version are
            out of date.
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
        checks.positive("tol", tol)
        given: object = network
        if not (given is None or isinstance(given, Network)):
            problem = f"must be an object of a Network's class, not {network!r}"
            raise InvalidInputError("network", problem, network)
        network = _NETWORK if network is None else network
        settler = _SETTLER if settler is None else settler
        self._kept: deque[tuple[Network, Sizes, Vector]]
        self._quick: tuple[int, float] | None
        self.__dict__.update(  # not through __setattr__, which counts
            _kept=deque(maxlen=1),
            version=0,
            network=network,
            tol=tol,
            settler=settler,
            follower=_FOLLOWER if follower is None else follower,
            _quick=_budget(network, settler),
        )

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "tol":
            checks.positive("tol", value)
        super().__setattr__(name, value)
        if name in _PARTS:
            self.__dict__["_quick"] = _budget(self.network, self.settler)
            self.version += 1

    @property
    def state(self) -> Vector:
        """The network's state (size,), a copy; empty where the next call has no warm start."""
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

    def numbers(self, duration: float = 0.0) -> Vector | None:
        """Collect the numbers that a compiled control step needs to stand in for this solver.

        Args:
            duration: Time to advance [s]; 0 stands for `solve`.

        Returns:
            ``[tol, budget of linear systems, long step, time to advance [rho], whether x is
            projected, sub-steps or 0, SAFETY]``, (7,), or None where network or integrator has no
            compiled form.
        """
        form, settler, follower = self.network.compiled, self.settler, self.follower
        if form is None:
            return None
        # A subclass may integrate in a way of its own.
        if duration > 0.0 and type(follower) is ExplicitEuler:
            ahead, substeps = duration / self.network.rho, follower.substeps or 0
            return np.array([self.tol, 0.0, 0.0, ahead, form.project, substeps, SAFETY])
        if duration == 0.0 and type(settler) is ImplicitEuler:
            budget, long_step = settler.max_steps, settler.long_step
            return np.array([self.tol, budget, long_step, 0.0, form.project, 0.0, SAFETY])
        return None

    def solve(self, qp: QP) -> Solution:
        """Advance the network until it has settled, and judge the point it has reached.

        Args:
            qp: The program; its values are taken as checked (`QP.check_values`).

        Returns:
            The solution; `found` only where every residual is at most `tol`.
        """
        network, tol, sizes = self.network, self.tol, qp.sizes
        n, m, p = sizes
        state, point = self._take(network, qp), np.empty(2 * n + m + p)
        if self._quick and n < LARGE:
            half, long_step = self._quick
            budget = half if half * n <= WORK else WORK // n + 1
            settled = settle_implicit(qp.data, n, m, p, state, point, tol, budget, long_step)
        else:
            settled = self._settle(network, qp, state, point)
        systems, time, primal, dual, gap = settled
        if primal + dual + gap <= 0.1 * tol:  # nothing is in doubt
            self._kept.append((network, sizes, state))
            # A named tuple's own way costs as much as a fifth of the call.
            found = (point, sizes, Status.SOLVED, systems, time, primal, dual, gap, None)
            return tuple.__new__(Solution, found)
        doubtful = 0.1 * tol < primal + dual + gap <= 3.0 * tol
        if doubtful and point.dot(point) > (1e13 * tol) ** 2:  # rounding may decide: try for better
            worse = closing.worse(qp, point, (primal, dual, gap))
            if not within(*worse, tol):
                again = self._second_try(network, qp, state, point, (*settled[:2], *worse))
                settled = (again[0], *settled[1:]) if again[2:] == worse else again
                primal, dual, gap = settled[2:]
        # The state is not kept without a solution: the multipliers grow without bound then, or are
        # no numbers any more, and would spoil every later call.
        if not (primal <= tol and dual <= tol and gap <= tol):
            if not math.isfinite(primal + dual + gap):
                return Solution(point, sizes, Status.NOT_FINITE, *settled)
            if n >= LARGE:
                settled = self._second_try(network, qp, state, point, settled)
            # Almost there: rounding is in the way, not the lack of a solution.
            far = n < LARGE or max(settled[2:]) > 1e-3
            proof = find_certificate(qp, point) if far else None
            if proof is not None:
                return Solution(point, sizes, proof[0], *settled, proof[1])
            if n < LARGE:
                settled = self._second_try(network, qp, state, point, settled)
            if not within(*settled[2:], tol):
                return Solution(point, sizes, Status.NOT_SETTLED, *settled)
        self._kept.append((network, sizes, state))
        return Solution(point, sizes, Status.SOLVED, *settled)

    def sharpen(self, qp: QP, solution: Solution) -> Solution:
        """Go on for a few long steps from the state that the last call left, as far as it helps.

        Where the cost has small eigenvalues, x is known to the residuals over these only.

        Args:
            qp: The program of the last call.
            solution: Its solution.

        Returns:
            A solution with smaller residuals, or the same where no step had any.
        """
        settler = self.settler
        if type(settler) is not ImplicitEuler or not (self._quick and solution.found):
            return solution
        if solution.sizes != qp.sizes:
            return solution
        x = solution.x
        size = np.abs(qp.q).dot(np.abs(x)) + np.abs(x.dot(qp.P.dot(x)))
        if not 1e-14 * size < self.tol:  # rounding of the cost is near the tolerance already
            return solution
        try:
            owner, sizes, state = self._kept.pop()  # nobody else has it now
        except IndexError:
            return solution
        if owner is self.network and sizes == qp.sizes:
            point, count, step = solution.point.copy(), SHARPENING, settler.long_step
            residuals = sharpen_implicit(qp.data, *sizes, state, point, step, count)
            if max(residuals) < solution.residuals.largest:
                systems, time = solution.iterations + count, solution.network_time + count * step
                solution = Solution(point, sizes, solution.status, systems, time, *residuals)
        self._kept.append((owner, sizes, state))
        return solution

    def _settle(self, network: Network, qp: QP, state: Vector, point: Vector) -> Settled:
        """Settle with the settler; a large program from a cold start, through the barrier."""
        settler = self.settler
        if type(settler) is not ImplicitEuler or self._quick is None:
            return settler.settle(network, qp, state, point, self.tol)
        if self._through_barrier(qp) and not state.any():
            return barrier.settle(qp, state, point, self.tol, settler.max_steps)
        budget = min((settler.max_steps + 1) // 2, WORK // qp.sizes[0] + 1)
        return settle_implicit(
            qp.data, *qp.sizes, state, point, self.tol, budget, settler.long_step
        )

    @staticmethod
    def _through_barrier(qp: QP) -> bool:
        """Tell whether a cold start goes through the barrier at once."""
        n = qp.sizes[0]
        return n >= HUGE or (n >= LARGE and np.count_nonzero(qp.data) < SPARSE * qp.data.size)

    def _second_try(
        self, network: Network, qp: QP, state: Vector, point: Vector, settled: Settled
    ) -> Settled:
        """Start again the other way, with the rest of the budget; take the better point."""
        settler, n = self.settler, qp.sizes[0]
        if type(settler) is not ImplicitEuler or self._quick is None or n >= HUGE:
            return settled
        left = settler.max_steps - settled[0]
        if left <= 0:
            return settled
        other = point.copy()
        if self._through_barrier(qp):
            state[:], left = 0.0, min(left, WORK // n + 1)
            again: Settled = settle_implicit(
                qp.data, *qp.sizes, state, other, self.tol, left, settler.long_step
            )
        else:
            again = barrier.settle(qp, state, other, self.tol, left)
        if not max(again[2:]) < max(settled[2:]):
            return again[0] + settled[0], *settled[1:]
        point[:] = other
        return again[0] + settled[0], again[1] + settled[1], *again[2:]

    def advance(self, qp: QP, duration: float) -> Solution:
        """Advance the network by `duration`, settled or not.

        Args:
            qp: The program, held constant meanwhile.
            duration: Time [s] on the network's own clock.

        Returns:
            The point that the state stands for, with status ``ADVANCED`` and its residuals.
        """
        n, m, p = qp.sizes
        network, point = self.network, np.empty(2 * n + m + p)
        state, time = self._take(network, qp), duration / network.rho
        iterations = self.follower.advance(network, qp, state, time)
        residuals = network.read(qp, state, point)
        status = Status.NOT_FINITE
        if math.isfinite(sum(residuals)):
            status = Status.ADVANCED
            self._kept.append((network, qp.sizes, state))
        return Solution(point, qp.sizes, status, iterations, time, *residuals)

    def _warm(self) -> tuple[Network, Sizes, Vector] | None:
        """Return the last network, sizes and state; None where a call has them or none was."""
        try:
            return self._kept[-1]
        except IndexError:
            return None

    def _take(self, network: Network, qp: QP) -> Vector:
        """Take the warm state, or make one; nobody else has it until it is put back."""
        if self._kept:
            try:
                owner, sizes, state = self._kept.pop()
                if owner is network and sizes == qp.sizes:
                    return state
            except IndexError:  # another thread was quicker
                pass
        if type(network) is ProjectionNetwork:  # its own state, without a copy and a check
            n, m, p = qp.sizes
            return np.zeros(3 * n + m + p)
        state = np.array(network.initial_state(qp), dtype=np.float64)
        check_size("network", state, network.state_size(qp))
        return state


def _budget(network: Network, settler: Integrator) -> tuple[int, float] | None:
    """Return the linear systems of a first try and the long step; None without compiled loops."""
    if type(settler) is ImplicitEuler and network.compiled is not None:
        return (settler.max_steps + 1) // 2, settler.long_step
    return None
