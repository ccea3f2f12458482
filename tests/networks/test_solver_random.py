"""The solver on many random programs: known by construction, and properties by hypothesis."""

import numpy as np
from hypothesis import given, settings, strategies as st

import programs
from iiwa_dnn import QP, DNNSolver

SEEDS = st.integers(0, 2**32 - 1)


@settings(max_examples=60)
@given(SEEDS)
def test_a_warm_start_from_anywhere_leads_to_the_same_answer(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n, m, p = int(rng.integers(2, 10)), int(rng.integers(1, 8)), 1
    solver, spread = DNNSolver(), 10.0 ** rng.uniform(-3, 3)
    for _ in range(3):
        made, x = programs.strictly_convex(rng, n, largest_condition=1e3)
        rows, active = rng.standard_normal((m, n)), rng.uniform(size=m) < 0.3
        row = rng.standard_normal((p, n))
        z, y = np.where(active, rng.exponential(size=m), 0.0), rng.standard_normal(p)
        q = -(made.P @ x + rows.T @ z + row.T @ y)
        qp = QP(made.P, q, rows, rows @ x + np.where(active, 0.0, 0.1), row, row @ x)
        solver.disturb(spread * rng.standard_normal(n))
        solution = solver.solve(qp)
        assert solution.found
        np.testing.assert_allclose(solution.x, x, atol=1e-5)
