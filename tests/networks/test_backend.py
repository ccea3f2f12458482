"""The network as a solver of qpsolvers, judged by another solver and by qpsolvers' residuals."""

import numpy as np
import pytest
import qpsolvers

import iiwa_dnn
import programs


@pytest.mark.long
def test_qpsolvers_lists_the_network_once_and_solves_with_it() -> None:
    iiwa_dnn.qp.register()
    iiwa_dnn.qp.register()
    assert qpsolvers.available_solvers.count("iiwa_dnn") == 1
    assert qpsolvers.dense_solvers.count("iiwa_dnn") == 1
    for seed in range(20):
        qp, known = programs.strictly_convex(np.random.default_rng([41, seed]), None, 1e2)
        problem = qp.to_qpsolvers()
        options = {"solver": "iiwa_dnn", "eps_abs": 1e-8, "eps_rel": 1e-9}
        x = qpsolvers.solve_qp(*problem.unpack(), initvals=known, **options)
        np.testing.assert_allclose(x, known, atol=1e-5)
        solution = qpsolvers.solve_problem(problem, solver="iiwa_dnn")
        assert solution.is_optimal(2e-9)


def test_no_solution_and_bad_input_are_told_as_qpsolvers_does() -> None:
    iiwa_dnn.qp.register()
    one, zero = np.eye(1), np.zeros(1)
    none = qpsolvers.solve_qp(one, zero, -one, zero - 1, lb=zero - 1, ub=zero, solver="iiwa_dnn")
    assert none is None
    with pytest.raises(qpsolvers.ProblemError, match="not convex"):
        qpsolvers.solve_qp(-one, zero, solver="iiwa_dnn")
    with pytest.raises(TypeError, match="eps_bas"):
        qpsolvers.solve_qp(one, zero, solver="iiwa_dnn", eps_bas=1.0)


def test_a_relative_tolerance_is_added_to_the_absolute_one() -> None:
    # The objective is near 1e12: rounding alone leaves a gap far above 1e-9.
    A = np.array([[1.0, 2.0]])
    problem = qpsolvers.Problem(np.eye(2), np.array([1e6, -1e6]), A=A, b=np.array([0.3]))
    y = (-1e6 + 2e6 - 0.3) / 5.0
    x = -problem.q - A[0] * y
    assert not iiwa_dnn.solve_problem(problem).found
    solution = iiwa_dnn.solve_problem(problem, eps_rel=1e-12)
    np.testing.assert_allclose(solution.x, x, rtol=1e-12)
    iiwa_dnn.qp.register()
    options = {"solver": "iiwa_dnn", "eps_abs": 1e-9, "eps_rel": 1e-12}
    np.testing.assert_allclose(qpsolvers.solve_qp(*problem.unpack(), **options), x, rtol=1e-12)
    assert not iiwa_dnn.solve_problem(problem, eps_rel=1e-18).found
    with pytest.raises(iiwa_dnn.InvalidInputError, match=r"^eps_rel"):
        iiwa_dnn.solve_problem(problem, eps_rel=-1.0)


@pytest.mark.parametrize("make", [programs.infeasible, programs.unbounded])
def test_a_relative_tolerance_makes_no_solution_where_there_is_none(make) -> None:
    for seed in range(40):
        qp = make(np.random.default_rng([42, seed]))
        assert not iiwa_dnn.solve_problem(qp, eps_rel=1e-9).found
