"""Large sparse programs."""

import numpy as np
import pytest
import scipy.sparse as spa

import iiwa_dnn
from iiwa_dnn import QP
from iiwa_dnn.networks.integrators import barrier


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


def test_a_step_of_the_barrier_solves_the_whole_system() -> None:
    rng = np.random.default_rng(5)
    qp, _ = blend(0, 60)
    program = barrier.equilibrate(qp)
    P, _, A, _, omega, *_ = program
    delta, w = 1e-4, 10.0 ** rng.uniform(-3.0, 3.0, len(omega))
    right = [rng.standard_normal(len(v)) for v in (P, A, omega)]
    found = np.concatenate(barrier.System(program, w, delta).solve(*right))
    zeros = np.zeros((len(A), len(omega)))
    K = np.block(
        [
            [P, A.T, omega.T],
            [A, -delta * np.eye(len(A)), zeros],
            [omega, zeros.T, -np.diag(1.0 / w)],
        ]
    )
    known = np.linalg.solve(K, np.concatenate(right))
    np.testing.assert_allclose(found, known, rtol=1e-6, atol=1e-8 * np.abs(known).max())


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_sparse_programs_of_known_solution_settle(seed: int) -> None:
    qp, x = blend(seed)
    problem = qp.to_qpsolvers()
    solution = iiwa_dnn.solve_problem(problem)
    assert solution.found
    assert solution.is_optimal(1e-9)
    # No eigenvalue of P is below 0.1, and half of it times |dx|^2 is at most the gap.
    np.testing.assert_allclose(solution.x, x, atol=np.sqrt(2e-9 / 0.1))


def test_a_warm_start_from_the_barriers_state_is_at_rest() -> None:
    qp, _ = blend(1)
    solver = iiwa_dnn.DNNSolver()
    assert solver.solve(qp).found
    assert solver.solve(qp).iterations <= 2
