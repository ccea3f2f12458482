"""The solver on many random programs: known by construction, and properties by hypothesis."""

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st

import iiwa_dnn
import programs
from iiwa_dnn import QP, DNNSolver, InvalidInputError

SEEDS = st.integers(0, 2**32 - 1)


def kkt_violation(qp: QP, x: np.ndarray, y: np.ndarray, z: np.ndarray, box: np.ndarray) -> float:
    """Largest violation of the KKT conditions, complementarity row by row, with numpy alone."""
    upper, lower = np.maximum(box, 0.0), np.maximum(-box, 0.0)
    at_upper, at_lower = np.isfinite(qp.ub), np.isfinite(qp.lb)
    parts = [
        np.abs(qp.P @ x + qp.q + qp.A.T @ y + qp.G.T @ z + box),
        np.abs(qp.A @ x - qp.b),
        qp.G @ x - qp.h,
        x - qp.ub,
        qp.lb - x,
        -z,
        np.abs(z * (qp.G @ x - qp.h)),
        np.abs(upper * np.where(at_upper, qp.ub - x, 1.0)),
        np.abs(lower * np.where(at_lower, x - qp.lb, 1.0)),
    ]
    return float(np.concatenate(parts).max())


@pytest.mark.long
def test_ten_thousand_random_programs() -> None:
    solver = DNNSolver()
    for seed in range(10_000):
        qp, x = programs.strictly_convex(np.random.default_rng([1, seed]))
        solver.reset()
        solution = solver.solve(qp)
        assert solution.found, seed
        assert qp.residuals(solution.x, solution.y, solution.z, solution.z_box).largest <= 1e-8
        assert np.abs(solution.x - x).max() < 1e-5, seed


@settings(max_examples=60)
@given(SEEDS)
def test_answers_are_kkt_points(seed: int) -> None:
    qp, _ = programs.strictly_convex(np.random.default_rng(seed))
    solution = iiwa_dnn.solve_problem(qp.to_qpsolvers())
    assert solution.found
    n, m, p = qp.sizes
    y = np.zeros(p) if solution.y is None else solution.y
    z = np.zeros(m) if solution.z is None else solution.z
    box = np.zeros(n) if solution.z_box is None else solution.z_box
    assert kkt_violation(qp, solution.x, y, z, box) < 1e-7


@settings(max_examples=60)
@given(SEEDS, st.floats(-3.0, 3.0))
def test_scaling_or_permuting_rows_changes_nothing(seed: int, exponent: float) -> None:
    rng = np.random.default_rng(seed)
    qp, x = programs.strictly_convex(rng, int(rng.integers(2, 16)), largest_condition=1e3)
    _, m, p = qp.sizes
    rows, more = 10.0 ** (exponent * rng.uniform(size=m)), 10.0 ** (exponent * rng.uniform(size=p))
    order, other = rng.permutation(m), rng.permutation(p)
    same = QP(
        qp.P, qp.q, (rows[:, None] * qp.G)[order], (rows * qp.h)[order],
        (more[:, None] * qp.A)[other], (more * qp.b)[other], qp.lb, qp.ub,
    )  # fmt: skip
    solution = DNNSolver().solve(same)
    assert solution.found
    np.testing.assert_allclose(solution.x, x, atol=1e-5)


@settings(max_examples=60)
@given(SEEDS, st.sampled_from([1e-1, 1e-4, 1e-9, 1e-13, 1e-16]), st.integers(1, 40))
def test_found_means_that_the_residuals_are_below_the_tolerance(
    seed: int, tol: float, budget: int
) -> None:
    qp, _ = programs.strictly_convex(np.random.default_rng(seed))
    solver = DNNSolver(tol=tol, settler=iiwa_dnn.ImplicitEuler(max_steps=budget))
    solution = solver.solve(qp)
    residuals = qp.residuals(solution.x, solution.y, solution.z, solution.z_box)
    assert solution.residuals == residuals
    assert solution.found == (residuals.largest <= tol)
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


@settings(max_examples=60)
@given(SEEDS, st.sampled_from(["P", "q", "G", "h", "A", "b", "lb", "ub"]))
def test_a_nan_anywhere_names_its_argument(seed: int, name: str) -> None:
    rng = np.random.default_rng(seed)
    qp, _ = programs.strictly_convex(rng, 6)
    fields = {field: getattr(qp, field) for field in ("P", "q", "G", "h", "A", "b", "lb", "ub")}
    fields["G"], fields["h"] = rng.standard_normal((2, 6)), np.ones(2)
    fields["A"], fields["b"] = rng.standard_normal((1, 6)), np.ones(1)
    spoilt = fields[name].copy()
    spoilt.flat[int(rng.integers(spoilt.size))] = np.nan
    with pytest.raises(InvalidInputError) as caught:
        iiwa_dnn.solve_problem(QP(**{**fields, name: spoilt}))
    assert caught.value.argument == name
