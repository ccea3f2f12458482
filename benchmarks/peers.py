"""Solvers behind one face, each through its quickest public Python entry.

A peer gets each program in its own layout before the clock starts. The clock runs for `solve`
alone: handing the numbers over, solving, and getting the answer back. `point` brings the answer to
qpsolvers' conventions afterwards, so that the same residuals judge all.
"""

from abc import ABC, abstractmethod
from typing import Any

import numpy as np
import qpsolvers
import scipy.sparse as spa

from iiwa_dnn.errors import MissingDependencyError
from iiwa_dnn.networks.problems import solve_problem
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.program import QP, Vector

try:
    import daqp
    import osqp
    import piqp
    from proxsuite import proxqp
except ImportError as error:  # pragma: no cover
    missing = error.name or "a solver"
    raise MissingDependencyError(missing, "pip install 'iiwa-dnn[bench]'") from error

TOL = 1e-9
Point = tuple[Vector | None, Vector | None, Vector | None, Vector | None]


class Peer(ABC):
    """One solver; `warm` where it may keep what it has between programs of one shape."""

    name: str
    model: Any  # the workspace that a warm start keeps

    def __init__(self, warm: bool) -> None:
        self.warm = warm
        self.ready = False

    @abstractmethod
    def convert(self, qp: QP) -> Any:
        """The program in the solver's own layout; not timed."""

    @abstractmethod
    def solve(self, given: Any) -> Any:
        """The solver's raw answer; timed."""

    @abstractmethod
    def point(self, qp: QP, answer: Any) -> Point:
        """``(x, y, z, z_box)`` of an answer; not timed."""


class Network(Peer):
    """This package's solver."""

    name = "iiwa_dnn"

    def __init__(self, warm: bool) -> None:
        super().__init__(warm)
        self.solver = DNNSolver(tol=TOL)

    def convert(self, qp: QP) -> QP:
        return qp

    def solve(self, given: QP) -> Any:
        if not self.warm:
            self.solver.reset()
        return self.solver.solve(given)

    def point(self, qp: QP, answer: Any) -> Point:
        return answer.x, answer.y, answer.z, answer.z_box


class Daqp(Peer):
    """DAQP's workspace, updated in place: it starts from its last active set.

    Bounds come first, and equalities are rows marked 5.
    """

    name = "DAQP"

    def convert(self, qp: QP) -> Any:
        upper = np.concatenate([qp.ub, qp.h, qp.b])
        lower = np.concatenate([qp.lb, np.full(qp.h.size, -np.inf), qp.b])
        sense = np.zeros(upper.size, dtype=np.intc)
        sense[upper.size - qp.b.size :] = 5
        rows = np.ascontiguousarray(np.vstack([qp.G, qp.A]))
        upper = np.minimum(upper, 1e30)
        lower = np.maximum(lower, -1e30)
        return qp.P.copy(), qp.q.copy(), rows, upper, lower, sense

    def solve(self, given: Any) -> Any:
        if self.warm and self.ready:
            P, q, rows, upper, lower, _ = given
            self.model.update(P, q, rows, upper, lower)
        else:
            self.model = daqp.Model()
            self.model.settings = {"primal_tol": TOL, "dual_tol": TOL}
            self.model.setup(*given)
            self.ready = True
        return self.model.solve()

    def point(self, qp: QP, answer: Any) -> Point:
        x, _, _, info = answer
        n, m, _ = qp.sizes
        return x, info["lam"][n + m :], info["lam"][n : n + m], info["lam"][:n]


class Piqp(Peer):
    """PIQP's dense interface."""

    name = "PIQP"

    def convert(self, qp: QP) -> Any:
        rows = np.full(qp.h.size, -np.inf)
        parts = (qp.P, qp.q, qp.A, qp.b, qp.G, rows, qp.h, qp.lb, qp.ub)
        return [part.copy(order="F") for part in parts]

    def solve(self, given: Any) -> Any:
        if self.warm and self.ready:
            self.model.update(*given)
        else:
            self.model = piqp.DenseSolver()
            settings = self.model.settings
            settings.eps_abs = settings.eps_duality_gap_abs = TOL
            settings.eps_rel = settings.eps_duality_gap_rel = 0.0
            self.model.setup(*given)
            self.ready = True
        self.model.solve()
        return self.model.result

    def point(self, qp: QP, answer: Any) -> Point:
        return answer.x, answer.y, answer.z_u, answer.z_bu - answer.z_bl


class Proxqp(Peer):
    """ProxQP's own dense interface."""

    name = "ProxQP"

    def convert(self, qp: QP) -> Any:
        limits = (np.full(qp.h.size, -np.inf), qp.h, qp.lb, qp.ub)
        parts = (qp.P, qp.q, qp.A, qp.b, qp.G, *(np.clip(each, -1e20, 1e20) for each in limits))
        return qp.sizes, [np.ascontiguousarray(part) for part in parts]

    def solve(self, given: Any) -> Any:
        (n, m, p), arrays = given
        if self.warm and self.ready:
            self.model.update(*arrays)
        else:
            self.model = proxqp.dense.QP(n, p, m, True)
            settings = self.model.settings
            settings.eps_abs = TOL
            settings.eps_rel = 0.0
            # Without it, some answers have gaps far above the tolerance.
            settings.check_duality_gap = True
            settings.eps_duality_gap_abs = TOL
            settings.eps_duality_gap_rel = 0.0
            if self.warm:
                settings.initial_guess = proxqp.InitialGuess.WARM_START_WITH_PREVIOUS_RESULT
            self.model.init(*arrays)
            self.ready = True
        self.model.solve()
        results = self.model.results
        return results.x, results.y, results.z

    def point(self, qp: QP, answer: Any) -> Point:
        x, y, z = answer
        m = qp.h.size
        return np.array(x), np.array(y), np.array(z[:m]), np.array(z[m:])


class Osqp(Peer):
    """OSQP's own interface: update and warm start."""

    name = "OSQP"

    def convert(self, qp: QP) -> Any:
        n = qp.q.size
        # Full patterns, so that an update may change any entry.
        pattern = np.triu(np.ones((n, n))).astype(bool)
        cost = spa.csc_matrix(np.where(pattern, 1.0, 0.0))
        cost.data = qp.P.T[pattern.T].copy()
        full = np.vstack([qp.A, qp.G])
        filled = np.vstack([np.ones_like(full), np.eye(n)])
        rows = spa.csc_matrix(filled)
        rows.data = np.vstack([full, np.eye(n)]).T[filled.T.astype(bool)]
        lower = np.concatenate([qp.b, np.full(qp.h.size, -np.inf), qp.lb])
        return cost, qp.q.copy(), rows, lower, np.concatenate([qp.b, qp.h, qp.ub])

    def solve(self, given: Any) -> Any:
        cost, q, rows, lower, upper = given
        if self.warm and self.ready:
            self.model.update(q=q, l=lower, u=upper, Px=cost.data, Ax=rows.data)
        else:
            self.model = osqp.OSQP()
            options = {"eps_abs": TOL, "eps_rel": 0.0, "polishing": True, "max_iter": 20_000}
            self.model.setup(cost, q, rows, lower, upper, verbose=False, **options)
            self.ready = True
        return self.model.solve(raise_error=False)

    def point(self, qp: QP, answer: Any) -> Point:
        _, m, p = qp.sizes
        return answer.x, answer.y[:p], answer.y[p : p + m], answer.y[p + m :]


class Outside(Peer):
    """A solver as qpsolvers calls it, from a cold start; this package's by its own function."""

    def __init__(self, name: str) -> None:
        super().__init__(False)
        self.name = name

    def convert(self, qp: QP) -> qpsolvers.Problem:
        return qp.to_qpsolvers()

    def solve(self, given: qpsolvers.Problem) -> qpsolvers.Solution:
        if self.name == Network.name:
            return solve_problem(given, tol=TOL)
        return qpsolvers.solve_problem(given, self.name, **_OPTIONS[self.name])

    def point(self, qp: QP, answer: qpsolvers.Solution) -> Point:
        return answer.x, answer.y, answer.z, answer.z_box


_GAP = {"eps_duality_gap_abs": TOL, "eps_duality_gap_rel": 0.0}
_OPTIONS: dict[str, dict[str, Any]] = {
    "daqp": {"primal_tol": TOL, "dual_tol": TOL},
    "piqp": {"eps_abs": TOL, "eps_rel": 0.0, **_GAP},
    "proxqp": {"eps_abs": TOL, "eps_rel": 0.0, "check_duality_gap": True, **_GAP},
}
OUTSIDE = (Network.name, *_OPTIONS)
PEERS: tuple[type[Peer], ...] = (Network, Daqp, Piqp, Proxqp, Osqp)
