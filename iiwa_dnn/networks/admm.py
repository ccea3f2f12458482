"""A yardstick that is no network: OSQP's alternating direction method, some iterations a program.

Each iteration is one backward substitution with a matrix that is factorised once a program.

Source: B. Stellato, G. Banjac, P. Goulart, A. Bemporad, S. Boyd, "OSQP: an operator splitting
solver for quadratic programs", Mathematical Programming Computation 12 (2020).
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from iiwa_dnn.networks.base import Network
from iiwa_dnn.networks.primal_dual import PrimalDualNetwork
from iiwa_dnn.networks.solver import DNNSolver
from iiwa_dnn.qp.layout import Sizes
from iiwa_dnn.qp.program import QP
from iiwa_dnn.qp.solution import Solution

_BARE = {
    "verbose": False,
    "scaling": 0,
    "check_termination": 0,
    "adaptive_rho": False,
    "polishing": False,
}
"""Settings of OSQP without what is not a part of the method."""


@dataclass(frozen=True)
class AdmmSolver(DNNSolver):
    """OSQP, stopped after so many iterations and gone on with from there at the next program.

    Its own iterates are the warm start: what is added to `warm_state`, [x | y | z], has no effect.

    Attributes:
        substeps: Iterations in each `advance`.
    """

    network: Network = field(default_factory=PrimalDualNetwork)
    substeps: int = 1
    _osqp: dict[Sizes, Any] = field(default_factory=dict, init=False, repr=False)

    def reset(self) -> None:
        """Forget the warm start, OSQP's own iterates too."""
        super().reset()
        self._osqp.clear()

    def advance(self, qp: QP, duration: float) -> Solution:
        """Take the iterations for this program; the duration [s] is not used."""
        import osqp
        from scipy import sparse

        n, m, p = qp.sizes
        triangle = sparse.csc_matrix(np.triu(np.ones((n, n))))
        rows = np.vstack([qp.A, qp.G, np.eye(n)])
        if qp.sizes not in self._osqp:
            # Every entry has a place, also those that are zero now.
            pattern = sparse.csc_matrix(np.ones(rows.shape))
            limits = np.ones(len(rows))
            self._osqp[qp.sizes] = osqp.OSQP()
            self._osqp[qp.sizes].setup(
                triangle, qp.q, pattern, -limits, limits, max_iter=self.substeps, **_BARE
            )
        solver = self._osqp[qp.sizes]
        solver.update(
            q=qp.q,
            l=np.concatenate([qp.b, np.full(m, -np.inf), qp.lb]),
            u=np.concatenate([qp.b, qp.h, qp.ub]),
            Px=qp.P.T[np.tril_indices(n)],
            Ax=rows.T.ravel(),
        )
        result = solver.solve(raise_error=False)
        state = np.concatenate([result.x, result.y[: p + m]])
        return self._advanced(qp, state, self.substeps, 0.0)
