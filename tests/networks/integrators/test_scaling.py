"""Programs in other units: solved and right by construction, whatever the sizes of numbers."""

from collections import Counter

import numpy as np
import pytest

import programs
from iiwa_dnn import QP, DNNSolver, ImplicitEuler, Status
from iiwa_dnn.networks.integrators.scaling import scaled
from iiwa_dnn.qp.certificates import certified


def error(qp: QP, x: np.ndarray, known: np.ndarray) -> float:
    """Largest violation of a row, and the error of the objective, relative to their terms."""
    rows = np.vstack([qp.A, qp.G])
    limits = np.concatenate([qp.b, qp.h])
    excess = rows @ x - limits
    excess[: qp.b.size] = np.abs(excess[: qp.b.size])
    terms = np.abs(rows) @ np.abs(x) + np.abs(limits)
    outside = np.maximum(np.maximum(qp.lb - x, x - qp.ub), 0.0)
    change = 0.5 * (x - known) @ qp.P @ (x + known) + qp.q @ (x - known)
    size = 0.5 * np.abs(known) @ np.abs(qp.P) @ np.abs(known) + np.abs(qp.q) @ np.abs(known)
    wrong = (excess / np.maximum(terms, 1e-300)).max(initial=0.0)
    return max(wrong, (outside / np.abs(known)).max(), abs(change) / size)


@pytest.mark.parametrize("flat", [False, True], ids=["curved", "linear"])
@pytest.mark.parametrize("what", ["cost", "rows", "units", "all"])
def test_programs_in_other_units_are_solved_and_right(what: str, flat: bool) -> None:
    found: Counter[Status] = Counter()
    for seed in range(60):
        rng = np.random.default_rng([21, flat, seed])
        plain, point = programs.with_point(rng, flat)
        n, m, p = plain.sizes
        decades = 3.0 if what == "all" else 8.0
        cost, rows, units = (10.0 ** rng.uniform(-decades, decades, k) for k in (1, p + m, n))
        # Eight decades between two variables are no units: four then.
        units = np.sqrt(units) if what == "units" else units
        qp, known = programs.in_other_units(
            plain,
            point,
            units if what in ("units", "all") else np.ones(n),
            rows if what in ("rows", "all") else np.ones(p + m),
            float(cost[0]) if what in ("cost", "all") else 1.0,
        )
        solution = DNNSolver(solve_integrator=ImplicitEuler(max_steps=400)).solve(qp)
        found[solution.status] += 1
        assert solution.status in (Status.SOLVED, Status.NOT_CONVERGED), seed
        assert not solution.found or error(qp, solution.x, known[:n]) < 1e-6, seed
    assert found[Status.SOLVED] >= 59


@pytest.mark.parametrize("flat", [False, True], ids=["curved", "linear"])
def test_tiny_feasible_sets(flat: bool) -> None:
    for seed in range(60):
        rng = np.random.default_rng([25, flat, seed])
        qp, point = programs.with_point(rng, flat, room=10.0 ** rng.uniform(-12.0, -3.0))
        solution = DNNSolver(solve_integrator=ImplicitEuler(max_steps=400)).solve(qp)
        assert solution.found, seed
        assert error(qp, solution.x, point[: qp.q.size]) < 1e-6


def test_contradictions_in_other_units_are_seen() -> None:
    for seed in range(40):
        rng = np.random.default_rng([27, seed])
        plain = programs.infeasible(rng)
        n, m, p = plain.sizes
        rows = 10.0 ** rng.uniform(-6.0, 6.0, p + m)
        qp, _ = programs.in_other_units(plain, np.zeros(2 * n + m + p), np.ones(n), rows, 1.0)
        solution = DNNSolver().solve(qp)
        assert solution.status in (Status.PRIMAL_INFEASIBLE, Status.NONE_FEASIBLE_NEAR)
        assert certified(qp, solution.certificate) is solution.status


@pytest.mark.parametrize("limit", [0.0, 1e-9, 1e9])
def test_rows_of_zeros_are_no_obstacle(limit: float) -> None:
    zeros = [[0.0, 0.0]]
    qp = QP(1e6 * np.eye(2), [1e6, -1e6], zeros, [limit], zeros, [0.0])
    solution = DNNSolver().solve(qp)
    assert solution.found
    np.testing.assert_allclose(solution.x, [-1.0, 1.0], rtol=1e-9)


def test_an_exact_point_ends_the_steps() -> None:
    """Its rates are zero, and no step is better: the gap is rounding, the tolerance below that."""
    for seed in range(200):
        rng = np.random.default_rng([28, seed])
        plain, point = programs.with_point(rng)
        n, m, p = plain.sizes
        cost = 10.0 ** rng.uniform(4.0, 8.0)
        qp, _ = programs.in_other_units(plain, point, np.ones(n), np.ones(m + p), cost)
        solution = DNNSolver().solve(qp)
        assert solution.found
        assert solution.iterations < 200, seed


def test_scaled_units_round_nothing() -> None:
    """The factors are powers of two: the program can be had back to the bit, and its residuals."""
    for seed in range(20):
        rng = np.random.default_rng([23, seed])
        plain, point = programs.with_point(rng)
        n, m, p = plain.sizes
        units = 10.0 ** rng.uniform(-4.0, 4.0, n)
        qp, point = programs.in_other_units(plain, point, units, np.ones(m + p), 1e-5)
        scaling = scaled(qp, 1e3)
        factors = scaling.of_point
        assert (np.frexp(factors)[0] == 0.5).all()
        x, box = factors[:n], factors[-n:]
        np.testing.assert_array_equal(scaling.qp.P * np.outer(box, 1.0 / x), qp.P)
        np.testing.assert_array_equal(scaling.qp.lb * x, qp.lb)
        np.testing.assert_array_equal(
            scaling.qp.accepts(point / factors, 0.0), qp.accepts(point, 0.0)
        )
        largest = np.abs(np.vstack([scaling.qp.A, scaling.qp.G])).max(axis=1, initial=0.0)
        assert (largest <= 4.0).all()
        assert (largest >= 0.05).all()


def test_the_budget_counts_the_linear_solves_of_all_attempts() -> None:
    for seed in range(20):
        rng = np.random.default_rng([24, seed])
        qp = programs.infeasible(rng) if seed % 2 else programs.strictly_convex(rng)[0]
        for most in (1, 7, 40):
            solver = DNNSolver(solve_integrator=ImplicitEuler(max_steps=most))
            solution = solver.solve(qp)
            assert 0 < solution.iterations <= most
            assert solver.solve_cold(qp, sharpen=True).iterations <= most
