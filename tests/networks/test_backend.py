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
    for names in (qpsolvers.available_solvers, qpsolvers.dense_solvers):
        assert names.count("iiwa_dnn") == 1
    for seed in range(20):
        qp, known = programs.strictly_convex(np.random.default_rng([41, seed]), None, 1e2)
        problem = qp.to_qpsolvers()
        options = {"solver": "iiwa_dnn", "eps_abs": 1e-8}
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


def test_tolerances_and_budget_are_options() -> None:
    iiwa_dnn.qp.register()
    qp, known = programs.strictly_convex(np.random.default_rng([42, 0]), 12, 1e2)
    for options in ({"eps_abs": 1e-8, "eps_rel": 1e-6}, {"eps_rel": 0.0, "max_iter": 500}):
        x = qpsolvers.solve_qp(*qp.to_qpsolvers().unpack(), solver="iiwa_dnn", **options)
        np.testing.assert_allclose(x, known, atol=1e-5)
    few = qpsolvers.solve_problem(qp.to_qpsolvers(), "iiwa_dnn", max_iter=2)
    assert not few.found
    assert few.extras["iterations"] == 2
