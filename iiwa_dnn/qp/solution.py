"""The answer to a quadratic program, with the residuals that judge it.

Multipliers are named as in qpsolvers: ``z`` for ``G x <= h``, ``y`` for ``A x = b``, and ``z_box``
for the bounds (positive at ``ub``, negative at ``lb``).
"""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, Any, NamedTuple

from iiwa_dnn.qp.layout import Vector

if TYPE_CHECKING:
    import qpsolvers


class Status(str, Enum):
    """How a solve ended."""

    SOLVED = "solved"
    """Every residual is at most the tolerance."""
    ADVANCED = "advanced"
    """The network was advanced by the time asked for, settled or not (a continuous run)."""
    NOT_SETTLED = "not settled"
    """The budget of steps ended before the residuals were small enough."""
    NOT_FINITE = "not finite"
    """The data or the state is no longer a number."""
    PRIMAL_INFEASIBLE = "primal infeasible"
    """No point satisfies the constraints: Farkas multipliers prove it."""
    UNBOUNDED = "dual infeasible (unbounded)"
    """The cost falls for ever along a direction that no constraint ends: the direction proves it.

    The program is unbounded then, unless no point is feasible in the first place.
    """


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
        status: How the solve ended.
        iterations: Linear systems solved (implicit) or steps taken (explicit).
        network_time: How far the network was advanced, in units of its time constant rho.
        primal: Primal residual of this very point, as qpsolvers defines it.
        dual: Dual residual.
        gap: Duality gap.
    """

    point: Vector
    sizes: tuple[int, int, int]
    status: Status
    iterations: int
    network_time: float
    primal: float
    dual: float
    gap: float

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
    def certificate(self) -> Vector | None:
        """The proof ``(size,)`` that there is no solution, where there is one (`Refutation`)."""
        return None

    @property
    def found(self) -> bool:
        """True only when every residual is at most the tolerance that was asked for."""
        return self.status is Status.SOLVED

    def to_qpsolvers(self, problem: qpsolvers.Problem) -> qpsolvers.Solution:
        """The same answer as a `qpsolvers.Solution` of `problem`.

        A solution that was not found carries no ``x``; what the network reached is in
        ``extras["last_x"]``, so that nobody takes it for an answer.
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
        if not self.found:
            if self.certificate is not None:
                extras["certificate"] = self.certificate
            return qpsolvers.Solution(problem, {**extras, "last_x": self.x}, found=False)
        x = self.x
        return qpsolvers.Solution(
            problem,
            extras,
            found=True,
            obj=float(0.5 * x @ (problem.P @ x) + problem.q @ x),
            x=x,
            y=self.y if problem.A is not None else None,
            z=self.z if problem.G is not None else None,
            z_box=self.z_box if problem.lb is not None or problem.ub is not None else None,
        )


class Refutation(Solution):
    """A solution that was not found, with the proof that there is none.

    A class of its own, so that the solutions of a control loop carry no field for it.
    """

    _certificate: Vector

    @classmethod
    def of(cls, last: Solution, status: Status, certificate: Vector) -> Refutation:
        """The last word on a program, with a certificate that was verified.

        Args:
            last: Where the network was given up.
            status: ``PRIMAL_INFEASIBLE`` or ``UNBOUNDED``.
            certificate: ``[y | z | z_box]`` of size p + m + n, or the direction, (n,).
        """
        refutation = cls(*last._replace(status=status))
        refutation._certificate = certificate
        return refutation

    @property
    def certificate(self) -> Vector:
        """``[y | z | z_box]`` if the program is infeasible, the direction (n,) if unbounded."""
        return self._certificate
