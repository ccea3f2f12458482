"""Degenerate, badly scaled and large programs, each judged by qpsolvers' residuals."""

import multiprocessing
import os
import signal
import sys

import numpy as np
import pytest
import qpsolvers

import iiwa_dnn
from benchmarks import programs
from iiwa_dnn import QP, DNNSolver
from iiwa_dnn.networks.integrators.equilibration import settle_equilibrated


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


def test_a_second_start_ends_where_the_programs_own_tolerance_is_reached() -> None:
    """One below rounding in its coordinates let the state wander away from the answer again."""
    for seed in range(10):
        qp = programs.badly_scaled(np.random.default_rng([8, seed]), "cost times 1e6")
        n, m, p = qp.sizes
        state = np.zeros(3 * n + m + p)
        point = np.empty(2 * n + m + p)
        systems, _, *residuals = settle_equilibrated(qp, state, point, 1e-6, 1000)
        assert max(residuals) <= 1e-6
        assert systems < 300


# The cost is 1e8 and more: gaps of 1e-8 and 1e-6 are one rounding.
@pytest.mark.parametrize(("P", "G", "h"), [(1e8, -1.0, -1.0), (1.0, -1e-5, -1.0)])
def test_one_variable_and_one_row_of_another_scale(P: float, G: float, h: float) -> None:
    solution = DNNSolver(tol=1e-5).solve(QP([[P]], [0.0], [[G]], [h]))
    assert solution.found
    assert solution.x[0] == pytest.approx(h / G, rel=1e-12)
    assert solution.z[0] == pytest.approx(-P * h / G / G, rel=1e-9)


def test_the_second_start_finds_what_is_known_by_construction() -> None:
    for seed in range(30):
        qp, known = programs.strictly_convex(np.random.default_rng([43, seed]), None, 1e2)
        n, m, p = qp.sizes
        state, point = np.zeros(3 * n + m + p), np.empty(2 * n + m + p)
        residuals = settle_equilibrated(qp, state, point, 1e-9, 1000)[2:]
        assert max(residuals) <= 1e-9, seed
        assert qp.residuals(*np.split(point, [n, n + p, n + p + m])).largest <= 1e-9
        # No eigenvalue of P is below 0.1, and half of it times |dx|^2 is at most the gap.
        np.testing.assert_allclose(point[:n], known, atol=np.sqrt(2e-9 / 0.1))


def test_a_large_cold_program_settles() -> None:
    qp, known = programs.strictly_convex(np.random.default_rng(44), 160, 1e2, spoilt=False)
    solution = DNNSolver().solve(qp)
    assert solution.found
    np.testing.assert_allclose(solution.x, known, atol=1e-6)


def test_a_batch_leaves_no_degenerate_member_behind() -> None:
    qp = programs.badly_scaled(np.random.default_rng([8, 0]), "rows times 1e-6 to 1e6")
    batch = iiwa_dnn.solve_batch(
        qp.P, np.stack([qp.q, 2.0 * qp.q]), qp.G, qp.h, qp.A, qp.b, tol=1e-6
    )
    assert batch.found.all()


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


FORK = multiprocessing.get_context("fork")


@pytest.mark.skipif(sys.platform != "linux", reason="fork")
def test_a_forked_child_may_use_the_batch_solver_too() -> None:
    P, q = np.eye(3), np.random.default_rng(0).standard_normal((1000, 3))

    def solve() -> None:
        assert iiwa_dnn.solve_batch(P, q).found.all()

    solve()
    child = FORK.Process(target=solve, daemon=True)
    child.start()
    child.join(60.0)
    assert child.exitcode == 0


@pytest.mark.skipif(sys.platform != "linux", reason="signals")
def test_an_interrupt_ends_a_long_settle() -> None:
    # A tolerance below rounding: the whole budget is used up, for minutes.
    n, rng, begun = 300, np.random.default_rng(0), FORK.Event()
    qp = QP(np.eye(n), rng.standard_normal(n), rng.standard_normal((2 * n, n)), np.ones(2 * n))

    def settle() -> None:
        signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job ignores it
        solver = DNNSolver(tol=1e-30, settler=iiwa_dnn.ImplicitEuler(max_steps=100_000))
        begun.set()
        with pytest.raises(KeyboardInterrupt):
            solver.solve(qp)

    DNNSolver().solve(QP(np.eye(2), np.ones(2)))  # compiled
    child = FORK.Process(target=settle, daemon=True)
    child.start()
    assert begun.wait(20.0)
    child.join(0.5)
    assert child.is_alive()
    assert child.pid is not None
    os.kill(child.pid, signal.SIGINT)
    child.join(20.0)
    assert child.exitcode == 0
