"""Large sparse programs."""

import numpy as np
import pytest
import scipy.sparse as spa

import iiwa_dnn
from iiwa_dnn import QP


def blend(seed: int, n: int = 200, size: float = 1.0) -> tuple[QP, np.ndarray]:
    """Make a sparse program of balances and capacities from its solution, which is unique.

    Some variables are fixed, some rows are limits from both sides, and q follows from the KKT
    conditions with multipliers of 1e2 times `size`.
    """
    rng = np.random.default_rng([91, seed])
    m, p = n // 4, n // 2
    A, G = (spa.random(k, n, 0.02, random_state=rng).toarray() for k in (p, m))
    A[np.arange(p), rng.permutation(n)[:p]] = 1.0
    x = np.round(size * rng.uniform(0.0, 100.0, n) * (rng.uniform(size=n) < 0.7), 3)
    P = np.diag(rng.uniform(0.1, 1.0, n))
    lb, ub = np.where(rng.uniform(size=n) < 0.9, 0.0, -np.inf), np.full(n, np.inf)
    fixed = rng.uniform(size=n) < 0.1
    lb[fixed] = ub[fixed] = x[fixed]
    h, active = G @ x + 1.0, np.arange(m) % 2 == 0
    h[active] -= 1.0
    z = np.where(active, rng.uniform(1.0, 100.0, m), 0.0) * size
    y, at_zero = size * rng.uniform(-100.0, 100.0, p), (x == lb) & ~fixed
    z_box = np.where(at_zero, -size * rng.uniform(1.0, 100.0, n), 0.0)
    q = -(P @ x + A.T @ y + G.T @ z + z_box)
    G, h = np.vstack([G, -G[active]]), np.concatenate([h, 10.0 - h[active]])
    return QP(P, q, G, h, A, A @ x, lb, ub), x


@pytest.mark.long
def test_sparse_programs_of_known_solution_are_solved() -> None:
    """Terms of the gap are near 1e6, where 1e-9 is the last digit."""
    for seed in range(4):
        qp, x = blend(seed)
        solution = iiwa_dnn.solve_problem(qp.to_qpsolvers())
        assert solution.found
        assert solution.is_optimal(2e-9)
        # No eigenvalue of P is below 0.1, and half of it times |dx|^2 is at most the gap.
        np.testing.assert_allclose(solution.x, x, atol=np.sqrt(2e-9 / 0.1))
