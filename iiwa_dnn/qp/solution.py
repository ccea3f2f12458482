"""The answer to a quadratic program, with its residuals; and the network as a solver of qpsolvers.

Multipliers are named as in qpsolvers: ``z`` for ``G x <= h``, ``y`` for ``A x = b``, and ``z_box``
for the bounds (positive at ``ub``, negative at ``lb``).
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from iiwa_dnn.errors import InvalidInputError
from iiwa_dnn.qp.layout import Sizes, Vector

if TYPE_CHECKING:
    import qpsolvers

NAME = "iiwa_dnn"
SOLVE: list[Callable[..., qpsolvers.Solution]] = []
"""The function that `register` enters, put here by `iiwa_dnn.networks`, a later subpackage."""


class Status(str, Enum):
    """Outcome of a solve."""

    SOLVED = "solved"
    """Every entry of the residuals is at most its tolerance."""
    ADVANCED = "advanced"
    """The network was advanced by the time asked for, converged or not (a continuous run)."""
    NOT_CONVERGED = "not converged"
    """The budget of steps ended before the residuals were small enough."""
    NOT_FINITE = "not finite"
    """The data or the state is no longer a number."""
    PRIMAL_INFEASIBLE = "primal infeasible"
    """No point satisfies the constraints: Farkas multipliers prove it, rounding counted."""
    UNBOUNDED = "dual infeasible (unbounded)"
    """The cost falls for ever along a direction that no constraint ends: the direction proves it.

    The program is unbounded then, unless no point is feasible in the first place.
    """
    NONE_FEASIBLE_NEAR = "no feasible point within 1e8"
    """Every point that satisfies the constraints has an entry of 1e8 or more: it is proven of
    multipliers that leave a residual. There may be one farther away."""
    NONE_OPTIMAL_NEAR = "no KKT point within 1e8"
    """Every KKT point has an entry or a multiplier of 1e8 or more: it is proven of a direction that
    leaves a residual. There may be one farther away."""
    NOT_CONVEX = "not convex"
    """P is not symmetric and positive semidefinite: a KKT point may be no minimum."""
    DIVERGED = "diverged"
    """The network was advanced by the time asked for, and a residual or an entry of its state is
    beyond 1e8 times the largest number of the program: no step is as long as it may be."""

    __str__ = str.__str__


class Residuals(NamedTuple):
    """qpsolvers' three residuals of a primal-dual point; all are zero exactly at a KKT point.

    Attributes:
        primal: Largest violation of a constraint.
        dual: Largest entry of ``P x + q + G^T z + A^T y + z_box``.
        gap: Difference between the primal and the dual objective.
    """

    primal: float
    dual: float
    gap: float

    @property
    def largest(self) -> float:
        """The largest of the three: the KKT residual that records and reports show."""
        total = self.primal + self.dual + self.gap
        # max() would drop a NaN that does not come first.
        return max(self) if total == total else total


class Solution(NamedTuple):
    """A primal-dual point and the evidence for it.

    Attributes:
        point: ``[x | y | z | z_box]`` in one array, of size n + p + m + n.
        sizes: ``(n, m, p)`` of the program.
        status: The end of the solve.
        iterations: Linear solves (implicit) or steps taken (explicit).
        network_time: Time by which the network was advanced, in units of its time constant rho.
        primal: Primal residual of this very point, as qpsolvers defines it.
        dual: Dual residual.
        gap: Duality gap.
        certificate: Evidence that there is no solution, or none within 1e8 as the status says,
            where it was verified: ``[y | z | z_box]`` of size p + m + n for an infeasible program,
            the direction (n,) for an unbounded one.
    """

    point: Vector
    sizes: Sizes
    status: Status
    iterations: int
    network_time: float
    primal: float
    dual: float
    gap: float
    certificate: Vector | None = None

    @property
    def x(self) -> Vector:
        """Primal point, inside the bounds, (n,)."""
        return self.point[: self.sizes[0]]

    @property
    def y(self) -> Vector:
        """Multipliers of the equalities, (p,)."""
        n, _, p = self.sizes
        return self.point[n : n + p]

    @property
    def z(self) -> Vector:
        """Multipliers of the inequalities, nonnegative, (m,)."""
        n, m, p = self.sizes
        return self.point[n + p : n + p + m]

    @property
    def z_box(self) -> Vector:
        """Multipliers of the bounds, (n,)."""
        return self.point[-self.sizes[0] :]

    @property
    def residuals(self) -> Residuals:
        """The three residuals."""
        return Residuals(self.primal, self.dual, self.gap)

    @property
    def found(self) -> bool:
        """True if the status is ``SOLVED``."""
        return self.status is Status.SOLVED

    def to_qpsolvers(self, problem: qpsolvers.Problem) -> qpsolvers.Solution:
        """Convert to a `qpsolvers.Solution` of `problem`.

        Multipliers of constraints that `problem` does not have are empty arrays, as those of
        qpsolvers' own solvers. A solution that was not found carries no ``x``; the point that the
        network reached is in ``extras["last_x"]``, so that nobody takes it for an answer.
        """
        import qpsolvers

        extras: dict[str, Any] = {
            "status": self.status.value,
            "iterations": self.iterations,
            "network_time": self.network_time,
            "primal_residual": self.primal,
            "dual_residual": self.dual,
            "duality_gap": self.gap,
        }
        n, m, p = self.sizes
        x = self.point[:n]
        if not self.found:
            if self.certificate is not None:
                extras["certificate"] = self.certificate
            return qpsolvers.Solution(problem, {**extras, "last_x": x}, found=False)
        bounded = problem.lb is not None or problem.ub is not None
        return qpsolvers.Solution(
            problem,
            extras,
            True,
            float(0.5 * x.dot(problem.P.dot(x)) + x.dot(problem.q)),
            x,
            self.point[n : n + p],
            self.point[n + p : n + p + m],
            self.point[n + p + m :] if bounded else np.empty(0),
        )


def register() -> None:
    """Register the network as the dense solver "iiwa_dnn" of qpsolvers; twice is as good as once.

    From then on ``qpsolvers.solve_qp(P, q, ..., solver="iiwa_dnn")`` and ``solve_problem`` run
    `iiwa_dnn.solve_problem` with ``sharpen=True``, and ``qpsolvers.available_solvers`` lists it.
    Its keyword arguments are ``eps_abs``, the absolute tolerance on primal residual, dual residual
    and gap (1e-9), ``eps_rel``, the tolerance on each entry of a residual relative to the sum of
    its absolute terms (0), and ``max_iter``, the largest number of linear solves (1000).
    The start is always cold: ``initvals`` is not used, nor is ``verbose``. A malformed or nonconvex
    problem raises ``qpsolvers.ProblemError``, an option of another name ``TypeError``.
    """
    from qpsolvers import solvers

    solvers.solve_function[NAME] = _solve_problem
    for names in (solvers.available_solvers, solvers.dense_solvers):
        if NAME not in names:
            names.append(NAME)


def _solve_problem(
    problem: qpsolvers.Problem,
    initvals: Vector | None = None,
    verbose: bool = False,
    eps_abs: float = 1e-9,
    eps_rel: float = 0.0,
    max_iter: int = 1000,
) -> qpsolvers.Solution:
    """Solve a problem as qpsolvers' own functions do; see `register`."""
    from qpsolvers import ProblemError

    try:
        return SOLVE[0](problem, tol=eps_abs, sharpen=True, eps_rel=eps_rel, max_iter=max_iter)
    except InvalidInputError as error:
        raise ProblemError(str(error)) from error
