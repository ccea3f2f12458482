"""The network as a solver: against known solutions, two other solvers, and its own promises."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
import qpsolvers
from qpsolvers import problems

import iiwa_dnn as d
import programs
from helpers_qp import known_qp
from iiwa_dnn.networks.integrators.base import enter_answer

DENSE = [name for name in dir(problems) if name.startswith("get_") and "sparse" not in name]


@pytest.mark.parametrize("name", DENSE)
def test_every_dense_problem_of_qpsolvers(name: str) -> None:
    made = getattr(problems, name)()
    problem = made if isinstance(made, qpsolvers.Problem) else made[0]
    assert d.solve_problem(problem).is_optimal(1e-8)


def test_warm_start_needs_fewer_linear_solves_and_reset_forgets() -> None:
    rng = np.random.default_rng(8)
    qp, _ = known_qp(rng, 7, 3, 3)
    solver = d.DNNSolver()
    cold = solver.solve(qp).iterations
    assert solver.solve(qp).iterations == 0
    solver.reset()
    assert solver.solve(qp).iterations == cold
    other, _ = known_qp(rng, 5, 1, 1)
    assert solver.solve(other).found  # another shape starts anew
    assert solver.state.size == 3 * 5 + 1


def test_advance_moves_by_the_time_given_and_says_how_far_it_is() -> None:
    qp, x = known_qp(np.random.default_rng(9), 5, 2, 1)
    solver = d.DNNSolver()
    first = solver.advance(qp, 1e-4)
    assert first.status is d.Status.ADVANCED
    assert not first.found
    assert first.network_time == pytest.approx(1e-4 / 9e-5)
    gaps = [np.abs(solver.advance(qp, 1e-4).x - x).max() for _ in range(3000)]
    assert gaps[-1] < 1e-3 < gaps[0]


def test_a_program_without_an_answer_does_not_spoil_the_next() -> None:
    good, x = known_qp(np.random.default_rng(11), 4, 2, 1)
    bounds = {"lb": good.lb, "ub": good.ub}
    rows = np.vstack([good.A[:1], good.A[:1]])
    infeasible = d.QP(good.P, good.q, A=rows, b=[0.0, 1.0], **bounds)
    spoilt = d.QP(good.P, np.full(4, np.nan), A=good.A, b=good.b, **bounds)
    solver = d.DNNSolver()
    bad = [(infeasible, d.Status.PRIMAL_INFEASIBLE), (spoilt, d.Status.NOT_FINITE)]
    for qp, status in 3 * bad:
        assert solver.solve(qp).status is status
        after = solver.solve(good)
        assert after.found
        assert np.abs(after.x - x).max() < 1e-6
    assert solver.advance(spoilt, 1e-4).status is d.Status.NOT_FINITE
    assert solver.solve(good).found


def test_settings_are_frozen_and_reach_the_compiled_answer() -> None:
    solver = d.DNNSolver(
        tol=1e-12,
        solve_integrator=d.ImplicitEuler(max_steps=7),
        advance_integrator=d.ExplicitEuler(substeps=9),
    )
    with pytest.raises(AttributeError):
        solver.tol = 1e-6
    answer = solver.compiled_answer((7, 0, 3), 1e-4)
    assert answer is not None
    own = answer.settings
    assert (own.tolerance, own.budget, own.substeps) == (1e-12, 7, 9)
    assert d.DNNSolver(d.DualNetwork()).compiled_answer((7, 0, 3)) is None
    compiled = d.DNNSolver().compiled_answer((1, 0, 0), 1e-3)
    for curvature, steps in ((1e2, 585), (1e9, 0)):  # 0: more than a million
        address, *own = compiled
        views = d.QP([[curvature]], [1.0]).views
        assert enter_answer(address, views, *own, np.zeros(3), np.empty(2))[0] == steps


def test_sharpened_answers_are_daqps_where_the_cost_is_nearly_flat() -> None:
    # The programs of an arm that follows its tip and hardly requests for a posture.
    rng, plain, sharp = np.random.default_rng(17), 0.0, 0.0
    for _ in range(200):
        J, request = rng.standard_normal((6, 7)), rng.standard_normal(7)
        P = J.T @ J + 1e-6 * np.eye(7)
        q = -J.T @ rng.standard_normal(6) - 1e-6 * request
        bound = rng.uniform(0.05, 3.0, 7)
        problem = qpsolvers.Problem(P, q, lb=-bound, ub=bound)
        expected = qpsolvers.solve_problem(problem, "daqp", primal_tol=1e-12, dual_tol=1e-12).x
        first, second = (d.solve_problem(problem, sharpen=s) for s in (False, True))
        assert second.is_optimal(1e-9)
        plain = max(plain, np.abs(first.x - expected).max())
        sharp = max(sharp, np.abs(second.x - expected).max())
    assert sharp < 1e-8 < plain


def test_a_sharpened_answer_is_never_worse() -> None:
    qp, _ = known_qp(np.random.default_rng(18), 8, 3, 2, inequalities=5)
    solver = d.DNNSolver(tol=1e-4)
    first, second = (solver.solve_cold(qp, sharpen=sharpen) for sharpen in (False, True))
    assert second.residuals.largest <= min(first.residuals.largest, 1e-14)
    other = d.DNNSolver(d.DualNetwork())  # has no steeper cost
    np.testing.assert_array_equal(other.solve_cold(qp).x, other.solve_cold(qp, sharpen=True).x)


@pytest.mark.parametrize("n", [2, 150])
def test_programs_without_a_choice_are_judged(n: int) -> None:
    one = np.ones(n)
    qp = d.QP(np.eye(n), -2.0 * one, A=one[np.newaxis], b=[float(n)], lb=one, ub=one)
    solution = d.DNNSolver().solve(qp)
    assert solution.found
    np.testing.assert_array_equal(solution.x, one)
    qp.b[0] += 1e-7
    assert not d.DNNSolver().solve(qp).found


@pytest.mark.parametrize("size", [1e-300, 1e-12, 1e-7, 1e-3])
def test_a_slight_cost_counts_as_any_other(size: float) -> None:
    """min size (x^2 / 2 - x) within [0, 0.5] lies at the upper bound, whatever the size."""
    bounds = {"lb": np.zeros(1), "ub": np.array([0.5])}
    qp = d.QP(size * np.eye(1), np.array([-size]), **bounds)
    solution = d.solve_problem(qp)
    assert solution.found
    batch = d.solve_batch(qp.P, qp.q, **bounds)
    np.testing.assert_array_equal([batch.x[0], batch.z_box[0]], [solution.x, solution.z_box])
    np.testing.assert_allclose(solution.x, [0.5], rtol=1e-9)
    np.testing.assert_allclose(solution.z_box, [0.5 * size], rtol=1e-6)
    nothing = d.solve_problem(d.QP(np.zeros((1, 1)), np.zeros(1), **bounds))
    assert nothing.found


def test_a_warm_state_that_is_no_number_costs_no_call() -> None:
    qp, x = known_qp(np.random.default_rng(25), 5, 2, 1)
    for network in (d.ProjectionNetwork(), d.DualNetwork()):
        for wrong in (np.nan, np.inf):
            solver = d.DNNSolver(network)
            assert solver.solve(qp).found
            solver.state_for(qp.sizes)[0] = wrong
            solution = solver.solve(qp)
            assert solution.found
            assert np.abs(solution.x - x).max() < 1e-6
            solver.state_for(qp.sizes)[0] = wrong
            assert solver.advance(qp, 1e-5).status is d.Status.ADVANCED
    huge = d.DNNSolver()
    huge.state_for(qp.sizes)[:] = 1e300
    assert huge.solve(qp).found


def test_a_relative_tolerance_takes_what_an_absolute_one_leaves() -> None:
    """A gap of 1e-9 is one rounding of a cost of 1e7; ten linear solves are too few for 1e-12."""
    problem = qpsolvers.Problem(
        np.diag([61.0, 2e9, 61.0, 2e9, 1000.0, 100.0]),
        np.zeros(6),
        A=np.array([[1.0, 0.0, 1.0, 0.0, 1.0, 0.0], [2.4, 0.0, -2.4, 0.0, 0.0, 1.0]]),
        b=np.array([5000.0, -800.0]),
        lb=np.array([-2e4, -0.35, -2e4, -0.35, -np.inf, -np.inf]),
        ub=np.array([2e4, 0.35, 2e4, 0.35, np.inf, np.inf]),
    )
    expected = qpsolvers.solve_problem(problem, "daqp").x
    np.testing.assert_allclose(d.solve_problem(problem).x, expected, rtol=1e-9, atol=1e-9)
    qp, x = known_qp(np.random.default_rng(26), 30, 5, 10, inequalities=20)
    fits = [
        d.solve_problem(qp, eps_rel=eps, max_iter=k) for eps in (0.0, 1e-3) for k in range(1, 30)
    ]
    first, loose = ([s.found for s in part].index(True) for part in (fits[:29], fits[29:]))
    assert loose < first
    assert np.abs(fits[29 + loose].x - x).max() < 0.1
    assert all(s.extras["iterations"] <= 1 + k % 29 for k, s in enumerate(fits))
    with pytest.raises(d.InvalidInputError, match="eps_rel"):
        d.solve_problem(qp, eps_rel=-1.0)


def test_a_network_that_diverges_says_so() -> None:
    """Explicit Euler by a step of 1.11 rho, as the paper's, where stability needs less."""
    qp, _ = known_qp(np.random.default_rng(27), 7, 3, 0)
    seen = []
    for network in (d.ProjectionNetwork(), d.PrimalDualNetwork()):
        unstable = d.DNNSolver(network, advance_integrator=d.ExplicitEuler(substeps=1))
        ends = [unstable.advance(qp, 2.5 * network.rho) for _ in range(400)]
        seen += [end.status for end in ends]
        for end in ends:
            if end.status is d.Status.ADVANCED:
                assert end.residuals.largest < 1e8 * np.abs(qp.data).max()
        stable = d.DNNSolver(network)
        assert {stable.advance(qp, 1e-4).status for _ in range(50)} == {d.Status.ADVANCED}
    assert d.Status.DIVERGED in seen
    assert not d.DNNSolver().advance(qp, 1e-5).found
    assert seen.index(d.Status.DIVERGED) < seen.index(d.Status.NOT_FINITE)


def test_solve_problem_starts_cold_whoever_shares_its_solver() -> None:
    made = [programs.strictly_convex(np.random.default_rng([59, k]), 7)[0] for k in range(20)]
    cold = [d.DNNSolver().solve(qp).x for qp in made]
    solver = d.DNNSolver()
    with ThreadPoolExecutor(4) as pool:  # all calls share the solver of the default settings
        shared = list(pool.map(lambda qp: d.solve_problem(qp).x, made * 5))
    own = [d.solve_problem(qp, solver=solver).x for qp in made]
    assert solver.state[:7] == pytest.approx(own[-1])
    np.testing.assert_array_equal(shared, cold * 5)
    np.testing.assert_array_equal(own, cold)


@pytest.mark.parametrize("setting", ["tol", "eps_rel", "max_iter"])
def test_solve_problem_refuses_settings_that_are_no_numbers(setting: str) -> None:
    qp = d.QP(np.eye(2), np.ones(2))
    for value in ([1e-9], np.ones(2), "1", None, True, -1):
        with pytest.raises(d.InvalidInputError):
            d.solve_problem(qp, **{setting: value})
