"""Degenerate, badly scaled and large programs, each judged by qpsolvers' residuals."""

import numpy as np
import pytest
import qpsolvers

import iiwa_dnn
import programs
from iiwa_dnn import QP, DNNSolver


def test_degenerate_vertices_converges() -> None:
    for seed in range(300):
        problem = programs.degenerate(np.random.default_rng([7, seed])).to_qpsolvers()
        assert iiwa_dnn.solve_problem(problem).is_optimal(2e-9), seed


def test_repeated_rows_beside_a_singular_cost_converge() -> None:
    for seed in range(60):
        rng = np.random.default_rng([61, seed])
        qp, known = programs.repeated_rows(rng)
        solution = DNNSolver().solve(qp)
        assert solution.found, seed
        change = 0.5 * (solution.x - known) @ qp.P @ (solution.x + known)
        assert abs(change + qp.q @ (solution.x - known)) < 1e-7, seed


def test_soft_tasks_of_any_weight_are_solved_within_few_steps() -> None:
    for seed in range(200):
        rng = np.random.default_rng([62, seed])
        qp, known = programs.heavy_task(rng)
        solution = DNNSolver().solve(qp)
        assert solution.found, seed
        assert solution.iterations < 60, seed
        rounding = 2e-16 * np.linalg.cond(qp.P)
        np.testing.assert_allclose(solution.x, known, atol=1e-7 + rounding, err_msg=str(seed))


# The cost is 1e8 and more: gaps of 1e-8 and 1e-6 are one rounding.
def test_a_large_cold_program_converges() -> None:
    qp, known = programs.strictly_convex(np.random.default_rng(44), 160, 1e2, spoilt=False)
    solution = DNNSolver().solve(qp)
    assert solution.found
    np.testing.assert_allclose(solution.x, known, atol=1e-6)


def test_rounding_in_the_cost_is_no_error_and_more_is() -> None:
    rng = np.random.default_rng(4)
    J = rng.standard_normal((4, 10))
    single = J.astype(np.float32).T @ J.astype(np.float32)
    q, bounds = rng.standard_normal(10), np.full(10, 2.0)
    for P in (np.eye(10) + 1e-9 * np.eye(10, k=1), J.T @ J, single + 1e-5 * np.eye(10)):
        problem = qpsolvers.Problem(P, q, lb=-bounds, ub=bounds)
        same = qpsolvers.Problem(0.5 * (P + P.T), q, lb=-bounds, ub=bounds)
        x = iiwa_dnn.solve_problem(problem).x
        np.testing.assert_array_equal(x, iiwa_dnn.solve_problem(same).x)
        assert iiwa_dnn.solve_problem(same).is_optimal(1e-9)
    for P in (single.astype(float), np.diag([-1e-12, *np.ones(9)]), np.diag([-1.0, *np.ones(9)])):
        qp = QP(P, q, lb=-bounds, ub=bounds)
        assert DNNSolver().solve(qp).status is iiwa_dnn.Status.NOT_CONVEX
        with pytest.raises(iiwa_dnn.InvalidInputError, match="semidefinite"):
            iiwa_dnn.solve_problem(qp)
    # Each pair is symmetric to 1e-5 in the unit of its own variables.
    unit = 10.0 ** rng.uniform(-3.0, 3.0, 10)
    QP(np.outer(unit, unit) * (np.eye(10) + 9e-6 * np.eye(10, k=1)), q).check_values()
    for side in (-1, 1):
        with pytest.raises(iiwa_dnn.InvalidInputError, match="is not symmetric"):
            QP(np.outer(unit, unit) * (np.eye(10) + 2e-5 * np.eye(10, k=side)), q).check_values()


@pytest.mark.parametrize("curvature", [1e-4, 1e-7, 1e-8, 1e-9, 1e-10])
def test_sharpened_answers_are_right_along_a_flat_direction(curvature: float) -> None:
    problem = qpsolvers.Problem(np.diag([1.0, curvature]), np.array([0.0, -curvature]))
    solution = iiwa_dnn.solve_problem(problem, sharpen=True)
    np.testing.assert_allclose(solution.x, [0.0, 1.0], atol=1e-5)
    assert solution.is_optimal(1e-14)
