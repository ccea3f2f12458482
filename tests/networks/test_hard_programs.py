"""Degenerate, badly scaled and large programs, each judged by qpsolvers' residuals."""

import numpy as np
import pytest
import qpsolvers

import iiwa_dnn
import programs
from iiwa_dnn import QP, DNNSolver


def test_degenerate_vertices_settle() -> None:
    for seed in range(300):
        problem = programs.degenerate(np.random.default_rng([7, seed])).to_qpsolvers()
        solution = iiwa_dnn.solve_problem(problem)
        assert solution.found, seed
        assert solution.is_optimal(2e-9), seed


@pytest.mark.parametrize("kind", programs.SCALINGS)
def test_badly_scaled_programs_settle(kind: str) -> None:
    for seed in range(20):
        problem = programs.badly_scaled(np.random.default_rng([8, seed]), kind).to_qpsolvers()
        assert iiwa_dnn.solve_problem(problem, tol=1e-6).is_optimal(1.1e-6), seed


# The cost is 1e8 and more: gaps of 1e-8 and 1e-6 are one rounding.
@pytest.mark.parametrize(("P", "G", "h"), [(1e8, -1.0, -1.0), (1.0, -1e-5, -1.0)])
def test_one_variable_and_one_row_of_another_scale(P: float, G: float, h: float) -> None:
    solution = DNNSolver(tol=1e-5).solve(QP([[P]], [0.0], [[G]], [h]))
    assert solution.found
    assert solution.x[0] == pytest.approx(h / G, rel=1e-12)
    assert solution.z[0] == pytest.approx(-P * h / G / G, rel=1e-9)


def test_a_large_cold_program_settles() -> None:
    qp, known = programs.strictly_convex(np.random.default_rng(44), 160, 1e2, spoilt=False)
    solution = DNNSolver().solve(qp)
    assert solution.found
    np.testing.assert_allclose(solution.x, known, atol=1e-6)


@pytest.mark.parametrize("kind", ["asymmetric", "indefinite", "single precision"])
def test_rounding_of_single_precision_in_the_cost_is_no_error(kind: str) -> None:
    rng = np.random.default_rng(4)
    J = rng.standard_normal((4, 10)).astype(np.float32)
    P = {
        "asymmetric": np.eye(10) + 1e-9 * np.eye(10, k=1),
        "indefinite": np.diag([-1.5e-6, *np.ones(9)]),
        "single precision": (J.T @ J).astype(float),
    }[kind]
    bounds = np.full(10, 2.0)
    problem = qpsolvers.Problem(P, rng.standard_normal(10), lb=-bounds, ub=bounds)
    assert iiwa_dnn.solve_problem(problem, tol=1e-9).is_optimal(1e-9)
    with pytest.raises(iiwa_dnn.errors.InvalidInputError, match="semidefinite"):
        iiwa_dnn.solve_problem(qpsolvers.Problem(P - 2.0 * np.eye(10), problem.q))
