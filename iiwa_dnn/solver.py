"""The dynamic neural network as a solver of quadratic programs."""

from __future__ import annotations

import math

import numpy as np
import qpsolvers

from iiwa_dnn import kernels
from iiwa_dnn.exceptions import InvalidInputError
from iiwa_dnn.integrators import ExplicitEuler, ImplicitEuler, Integrator
from iiwa_dnn.networks import ProjectionNetwork
from iiwa_dnn.qp import QP, Residuals, Solution, Status, Vector


class DNNSolver:
    """A network, an integrator and a stopping rule, with a warm start kept between calls.

    The network's state is carried from one program to the next as long as their shapes agree,
    which is what a control loop wants.

    Attributes:
        network: The ODE.
        tol: Absolute tolerance on the primal residual, the dual residual and the duality gap.
        settler: Integrator of `solve`, which runs until the residuals are below `tol`.
        follower: Integrator of `advance`, which runs for a given time.
    """

    def __init__(
        self,
        network: ProjectionNetwork | None = None,
        tol: float = 1e-9,
        settler: Integrator | None = None,
        follower: Integrator | None = None,
    ) -> None:
        """Start from the network's initial state.

        Raises:
            InvalidInputError: `tol` is not a positive number.
        """
        if not (math.isfinite(tol) and tol > 0):
            raise InvalidInputError("tol", f"must be a positive number, not {tol}")
        self.network = network if network is not None else ProjectionNetwork()
        self.tol = tol
        self.settler: Integrator = settler if settler is not None else ImplicitEuler()
        self.follower: Integrator = follower if follower is not None else ExplicitEuler()
        self._shape: tuple[int, int, int] | None = None
        self._state: Vector = np.empty(0)

    @property
    def state(self) -> Vector:
        """The network's state [x | y | z | u | l], a copy; empty before the first call."""
        copy: Vector = self._state.copy()
        return copy

    def reset(self) -> None:
        """Forget the warm start: the next call starts from the network's initial state."""
        self._shape = None

    def solve(self, qp: QP) -> Solution:
        """Advance the network until it has settled, and say how well it has.

        Args:
            qp: The program; its values are taken as checked (`QP.check_values`).

        Returns:
            The solution; `found` only where every residual is at most `tol`.
        """
        state, point = self._ready(qp)
        settled = self.settler.settle(self.network, qp, state, point, self.tol)
        residuals = Residuals(settled.primal, settled.dual, settled.gap)
        largest = residuals.largest
        if largest <= self.tol:
            status = Status.SOLVED
        else:
            status = Status.NOT_SETTLED if math.isfinite(largest) else Status.NOT_FINITE
            if status is Status.NOT_FINITE:
                self.reset()  # a state that is not a number would spoil every later call
        return self._solution(
            qp, point, status, settled.iterations, settled.network_time, residuals
        )

    def advance(self, qp: QP, duration: float) -> Solution:
        """Advance the network by `duration` and no more, settled or not.

        Args:
            qp: The program, held constant meanwhile.
            duration: Time [s] on the network's own clock.

        Returns:
            The point that the state stands for, with status ``ADVANCED`` and its residuals.
        """
        state, point = self._ready(qp)
        network_time = duration / self.network.rho
        iterations = self.follower.advance(self.network, qp, state, network_time)
        residuals = Residuals(*kernels.kkt_point(qp.arrays(), state, point))
        status = Status.ADVANCED
        if not math.isfinite(residuals.largest):
            status = Status.NOT_FINITE
            self.reset()
        return self._solution(qp, point, status, iterations, network_time, residuals)

    def _ready(self, qp: QP) -> tuple[Vector, Vector]:
        """The warm state for this shape of problem, and room for its answer."""
        n, p, m = shape = (qp.q.size, qp.b.size, qp.h.size)
        if shape != self._shape:
            self._shape = shape
            self._state = self.network.initial_state(qp)
        return self._state, np.empty(2 * n + p + m)

    @staticmethod
    def _solution(
        qp: QP,
        point: Vector,
        status: Status,
        iterations: int,
        network_time: float,
        residuals: Residuals,
    ) -> Solution:
        n, p = qp.q.size, qp.b.size
        last = point.size - n
        return Solution(
            point[:n],
            point[n : n + p],
            point[n + p : last],
            point[last:],
            status,
            iterations,
            network_time,
            residuals,
        )


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
