"""The dynamic neural network as a solver of quadratic programs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from iiwa_dnn import checks
from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.networks import Network, ProjectionNetwork
from iiwa_dnn.networks.integrators import SAFETY, ExplicitEuler, ImplicitEuler, Integrator
from iiwa_dnn.networks.refutation import find_certificate
from iiwa_dnn.qp.layout import Vector
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Refutation, Solution, Status

if TYPE_CHECKING:
    import qpsolvers


_PARTS = frozenset({"network", "tol", "settler", "follower"})
"""Attributes whose change makes compiled constants (`DNNSolver.numbers`) stale."""


class DNNSolver:
    """A network, an integrator and a stopping rule, with a warm start kept between calls.

    The network's state is carried from one program to the next as long as their shapes agree,
    which is what a control loop wants.

    Attributes:
        network: The ODE.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        settler: Integrator of `solve`, which runs until the residuals are below `tol`.
        follower: Integrator of `advance`, which runs for a given time.
        version: Number of times that one of these was set.
    """

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
            InvalidInputError: `tol` is not a positive number.
        """
        checks.positive("tol", tol)
        self.network: Network = network if network is not None else ProjectionNetwork()
        self.tol = tol
        self.settler: Integrator = settler if settler is not None else ImplicitEuler()
        self.follower: Integrator = follower if follower is not None else ExplicitEuler()
        self._sizes: tuple[int, int, int] | None = None
        self._state: Vector = np.empty(0)
        self._point_size = 0

    def __setattr__(self, name: str, value: object) -> None:
        super().__setattr__(name, value)
        if name in _PARTS:
            self.version = getattr(self, "version", 0) + 1

    @property
    def state(self) -> Vector:
        """The network's state (size,), a copy; empty before the first call."""
        copy: Vector = self._state.copy()
        return copy

    def reset(self) -> None:
        """Forget the warm start: the next call starts from the network's initial state."""
        self._sizes = None

    def disturb(self, noise: Vector) -> None:
        """Add noise (n,) [the unit of x] to x of the network's state; the next call starts there.

        Before the first call there is no state yet, and nothing happens.

        Raises:
            InvalidInputError: The network computes x from its state, which does not hold it.
        """
        if not self.network.carries_x:
            raise InvalidInputError("network", "holds no x in its state that could be disturbed")
        if self._sizes is not None:
            self._state[: self._sizes[0]] += noise

    def warm_state(self, sizes: tuple[int, int, int]) -> Vector | None:
        """The state itself, (size,), where the last program had these sizes; otherwise None."""
        return self._state if sizes == self._sizes else None

    def numbers(self, duration: float = 0.0) -> Vector | None:
        """What `control_step` needs to stand in for `solve` or `advance`.

        Args:
            duration: Time to advance [s]; 0 stands for `solve`.

        Returns:
            The numbers, (7,), or None where network or integrator has no compiled form.
        """
        network, settler, follower = self.network, self.settler, self.follower
        if type(network) is not ProjectionNetwork:
            return None
        projected = float(network.primal_projection)
        if duration > 0.0 and type(follower) is ExplicitEuler:
            ahead, substeps = duration / network.rho, follower.substeps or 0
            return np.array([self.tol, 0.0, 0.0, ahead, projected, substeps, SAFETY])
        if duration == 0.0 and type(settler) is ImplicitEuler:
            budget, long_step = settler.max_steps, settler.long_step
            return np.array([self.tol, budget, long_step, 0.0, projected, 0.0, SAFETY])
        return None

    def solve(self, qp: QP) -> Solution:
        """Advance the network until it has settled, and say how well it has.

        Args:
            qp: The program; its values are taken as checked (`QP.check_values`).

        Returns:
            The solution; `found` only where every residual is at most `tol`.
        """
        sizes = qp.sizes
        if sizes != self._sizes:
            self._begin(qp)
        point, tol = np.empty(self._point_size), self.tol
        iterations, network_time, primal, dual, gap = self.settler.settle(
            self.network, qp, self._state, point, tol
        )
        # No residual may be above the tolerance, and none NaN.
        solved = primal <= tol and dual <= tol and gap <= tol
        status = Status.SOLVED if solved else self._failed(primal + dual + gap)
        solution = Solution(point, sizes, status, iterations, network_time, primal, dual, gap)
        return solution if solved else self._refuted(qp, solution)

    def advance(self, qp: QP, duration: float) -> Solution:
        """Advance the network by `duration` and no more, settled or not.

        Args:
            qp: The program, held constant meanwhile.
            duration: Time [s] on the network's own clock.

        Returns:
            The point that the state stands for, with status ``ADVANCED`` and its residuals.
        """
        sizes = qp.sizes
        if sizes != self._sizes:
            self._begin(qp)
        point = np.empty(self._point_size)
        network_time = duration / self.network.rho
        iterations = self.follower.advance(self.network, qp, self._state, network_time)
        primal, dual, gap = self.network.read(qp, self._state, point)
        total = primal + dual + gap
        status = Status.ADVANCED if math.isfinite(total) else self._failed(total)
        return Solution(point, sizes, status, iterations, network_time, primal, dual, gap)

    def _begin(self, qp: QP) -> None:
        """Start from the network's initial state, for programs of this shape."""
        n, m, p = self._sizes = qp.sizes
        self._point_size = 2 * n + m + p
        self._state = self.network.initial_state(qp)

    def _refuted(self, qp: QP, last: Solution) -> Solution:
        """The same solution, with a proof that there is none where one is found."""
        if last.status is not Status.NOT_SETTLED:
            return last
        certificate = find_certificate(qp, last.point)
        return Refutation.of(last, *certificate) if certificate is not None else last

    def _failed(self, residuals: float) -> Status:
        # On a program without a solution the multipliers grow without bound, or are no numbers
        # any more; carried on, they would spoil every later call.
        self.reset()
        return Status.NOT_SETTLED if math.isfinite(residuals) else Status.NOT_FINITE


def solve_problem(
    problem: qpsolvers.Problem | QP,
    tol: float = 1e-9,
    solver: DNNSolver | None = None,
) -> qpsolvers.Solution:
    """Solve one convex quadratic program with a dynamic neural network, from a cold start.

    Args:
        problem: Dense or sparse; n variables, p equalities, m inequalities, bounds.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        solver: Network and integrator to use; the default integrates the paper's network
            implicitly. Its state is reset first and its own tolerance replaces `tol`.

    Returns:
        The solution with x (n,), y (p,), z (m,), z_box (n,), obj, and in `extras` the status,
        the iterations, the residuals and the network time in units of rho. `found` is False
        where there is none within the tolerance.

    Raises:
        InvalidInputError: The problem is malformed or not convex; the message names the argument.
    """
    qp = problem if isinstance(problem, QP) else QP.from_qpsolvers(problem)
    qp.check_values()
    if solver is None:
        solver = DNNSolver(tol=tol)
    solver.reset()
    stated = qp.to_qpsolvers() if isinstance(problem, QP) else problem
    return solver.solve(qp).to_qpsolvers(stated)
