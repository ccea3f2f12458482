"""The solver on many random programs: known by construction, and properties by hypothesis."""

import numpy as np
from hypothesis import given, settings, strategies as st

import iiwa_dnn
import programs
from iiwa_dnn import QP, DNNSolver

SEEDS = st.integers(0, 2**32 - 1)


@settings(max_examples=60)
@given(SEEDS, st.sampled_from([1e-1, 1e-4, 1e-9, 1e-13, 1e-16]), st.integers(1, 40))
def test_found_means_that_the_residuals_are_below_the_tolerance(seed, tol, budget) -> None:
    qp, _ = programs.strictly_convex(np.random.default_rng(seed))
    solver = DNNSolver(tol=tol, solve_integrator=iiwa_dnn.ImplicitEuler(max_steps=budget))
    solution = solver.solve(qp)
    residuals = qp.residuals(solution.point)
    assert solution.residuals == residuals
    assert solution.found == qp.accepts(solution.point, tol)
    assert solution.found or not residuals.largest <= tol
    assert solution.iterations <= budget


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
