"""Right answers agree and wrong ones do not; both are known by construction."""

from collections import Counter
from typing import NamedTuple

import numpy as np
import pytest
from scipy.linalg import null_space

from iiwa_dnn import QP, Agreement, CrossCheck, DNNSolver, solve_problem
from iiwa_dnn.qp import crosscheck
from iiwa_dnn.qp.agreement import (
    feasibility_gaps,
    normalised,
    objective_gaps,
    stacked,
)

PROXQP = CrossCheck()
DAQP = CrossCheck(("daqp",))

N = 5
"""Variables of a program."""
M = 4
"""Inequality rows beside the bounds."""


def agrees(check: CrossCheck, qp: QP, x: np.ndarray) -> bool:
    agreement = check.check(qp, x)
    assert agreement.judge.min() >= 0
    return bool(agreement.largest.max() <= check.tolerance)


class Known(NamedTuple):
    """A program whose solutions are x + s, s in the null space of `fixed`, as far as feasible.

    Its constraints are ``C x = d`` for the first p rows and ``C x <= d`` for the others, bounds
    among them; those at the indices `met` are met at x.
    """

    qp: QP
    x: np.ndarray
    C: np.ndarray
    d: np.ndarray
    met: np.ndarray
    p: int
    fixed: np.ndarray


def known(rng: np.random.Generator, rank: int, strong: int, weak: int) -> Known:
    """A program of five variables with a cost of this rank.

    At x so many rows and bounds are met with a multiplier, up to two equalities among them, and so
    many without one. An equality may be two inequalities, a row come twice or have no limit.
    """
    p = int(rng.integers(0, min(strong, 2) + 1))
    Q = np.linalg.qr(rng.standard_normal((N, N)))[0][:, :rank]
    P = (Q * 10.0 ** rng.uniform(-1.0, 1.0, rank)) @ Q.T
    x = rng.standard_normal(N)
    C = np.vstack([rng.standard_normal((p + M, N)), np.eye(N), -np.eye(N)])
    # Of each variable one bound at most is met.
    may_be_met = np.concatenate([np.arange(M), M + np.arange(N) + N * rng.integers(0, 2, N)])
    met = np.concatenate([np.arange(p), p + rng.permutation(may_be_met)[: strong - p + weak]])
    slack = rng.uniform(0.1, 2.0, len(C))
    slack[met] = 0.0
    force = np.zeros(len(C))
    force[met[:strong]] = rng.exponential(size=strong) + 0.01
    force[:p] = rng.standard_normal(p)
    d = C @ x + slack
    q = -(P @ x + C.T @ force)
    A, b, G, h = C[:p], d[:p], C[p : p + M], d[p : p + M]
    if p and rng.random() < 0.5:
        G = np.vstack([G, A[:1], -A[:1], 2.0 * G[:1], G[1:2]])
        h = np.concatenate([h, b[:1], -b[:1], 2.0 * h[:1], [np.inf]])
        A, b = A[1:], b[1:]
    qp = QP(P, q, G, h, A, b, -d[p + M + N :], d[p + M : p + M + N])
    return Known(qp, x, C, d, met, p, np.vstack([P, C[met[:strong]]]))


def way(program: Known, x: np.ndarray, step: np.ndarray) -> float:
    """Longest feasible way along a step away from a feasible x."""
    rates = program.C @ step
    room = np.maximum(program.d - program.C @ x, 0.0)
    return float((room[rates > 1e-9] / rates[rates > 1e-9]).min())


def right_answers(rng: np.random.Generator, program: Known) -> list[np.ndarray]:
    """The solution, the solver's answer, and points on the boundary of the optimal face."""
    free = null_space(program.fixed)
    found = [program.x, solve_problem(program.qp, tol=1e-10, sharpen=True).x]
    for _ in range(2 * (free.size > 0)):
        step = free @ rng.standard_normal(free.shape[1])
        found.append(program.x + way(program, program.x, step) * step)
    return found


def wrong_answers(rng: np.random.Generator, program: Known) -> dict[str, np.ndarray]:
    """Answers by what is wrong with them."""
    qp, x, C, d, met, p, fixed = program
    found = {}
    row = int(rng.integers(len(C)))
    aim = d[row] + 2e-5 * (1.0 + np.abs(C[row]) @ np.abs(x) + abs(d[row]))
    found["infeasible"] = x + C[row] * (aim - C[row] @ x) / (C[row] @ C[row])
    # Along the rows that are met, where the cost is curved: only x tells.
    curved = null_space(np.vstack([C[met], null_space(fixed).T]))
    if curved.size:
        step = curved @ rng.standard_normal(curved.shape[1])
        step /= np.abs(step).max()
        sign = 1.0 if way(program, x, step) > way(program, x, -step) else -1.0
        found["off"] = x + 1e-3 * sign * step
        assert (C @ found["off"] <= d + 1e-12).all()
    if len(met) > p:
        rates = np.where(met < p, 0.0, -rng.uniform(0.5, 1.0, len(met)))
        step = np.linalg.lstsq(C[met], rates, rcond=None)[0]
        worse = x + rng.uniform(0.1, 1.0) * min(1.0, way(program, x, step)) * step
        middle = 0.5 * (x + worse)
        if (worse - x) @ (qp.P @ middle + qp.q) > 1e-3:
            found["worse"] = worse
    return found


CASES = [(0, 5, 0), (0, 4, 1), (0, 2, 0), (0, 1, 1), (2, 2, 0), (3, 0, 1), (3, 2, 0), (5, 1, 1)]


@pytest.mark.parametrize(("rank", "strong", "weak"), CASES)
def test_right_answers_agree_and_wrong_ones_do_not(rank: int, strong: int, weak: int) -> None:
    counts: Counter[str] = Counter()
    for seed in range(30):
        rng = np.random.default_rng([58, rank, strong, weak, seed])
        program = known(rng, rank, strong, weak)
        right = right_answers(rng, program)
        wrong = wrong_answers(rng, program)
        counts.update(wrong.keys())
        for check in (PROXQP, DAQP):
            assert all(agrees(check, program.qp, x) for x in right)
            assert not any(agrees(check, program.qp, x) for x in wrong.values())
    assert counts["infeasible"] == 30
    assert counts["off"] == 30 * (rank > 0)
    assert counts["worse"] > 10 * (strong > 0)


@pytest.mark.parametrize("solver", ["proxqp", "osqp", "daqp"])
def test_a_flat_cost_lets_no_wrong_answer_pass(solver: str) -> None:
    nothing = np.zeros((2, 2))
    vertex = QP(nothing, [1.0, 2.0], lb=[0.0, 0.0], ub=[1.0, 1.0])
    edge = QP(nothing, [1.0, 1.0], G=[[-1.0, -1.0]], h=[-1.0], lb=[0.0, 0.0], ub=[2.0, 3.0])
    half = QP(np.diag([1.0, 0.0]), [0.0, 1.0], lb=[-1.0, 0.0], ub=[1.0, 1.0])
    equal = QP(np.diag([1.0, 0.0, 0.0]), [0.0, 0.0, 1.0], A=[[0.0, 1.0, 1.0]], b=[1.0],
               lb=[-1.0, 0.0, 0.0], ub=[1.0, 9.0, 9.0])  # fmt: skip
    check = CrossCheck((solver,))
    for qp, x in ((vertex, [1.0, 1.0]), (vertex, [-500.0, 7.0]), (edge, [0.0, 0.0]),
                  (half, [0.0, 1.0]), (half, [0.0, -50.0]), (equal, [0.0, 8.0, 0.0])):  # fmt: skip
        assert not agrees(check, qp, np.array(x))
    for qp, x in ((vertex, [0.0, 0.0]), (edge, [1.0, 0.0]), (edge, [0.0, 1.0]), (edge, [0.3, 0.7]),
                  (half, [0.0, 0.0]), (equal, [0.0, 1.0, 0.0])):  # fmt: skip
        assert agrees(check, qp, np.array(x))


def test_an_equality_counts_without_a_multiplier() -> None:
    qp = QP(np.zeros((2, 2)), [0.0, 0.0], A=[[1.0, 1.0]], b=[1.0])
    for check in (PROXQP, DAQP):
        assert agrees(check, qp, np.array([-7.0, 8.0]))
        assert check.check(qp, np.array([-7.0, 9.0])).solution_gap == pytest.approx(0.5)


@pytest.mark.parametrize("cost", [1e-6, 1e6])
@pytest.mark.parametrize("row", [1e-6, 1e6])
def test_units_of_cost_and_rows_change_no_verdict(cost: float, row: float) -> None:
    for seed in range(20):
        rng = np.random.default_rng([59, seed])
        program = known(rng, (0, 3, 5)[seed % 3], (4, 2, 0)[seed % 3], 1)
        qp = program.qp
        units = row ** rng.integers(0, 2, len(qp.G))
        h = np.where(qp.h < np.inf, units * qp.h, np.inf)
        G = units[:, np.newaxis] * qp.G
        scaled = QP(cost * qp.P, cost * qp.q, G, h, row * qp.A, row * qp.b, qp.lb, qp.ub)
        for check in (PROXQP, DAQP):
            assert all(agrees(check, scaled, x) for x in right_answers(rng, program))
            assert not any(agrees(check, scaled, x) for x in wrong_answers(rng, program).values())


def test_what_is_normalised_is_the_same_program_to_the_last_bit() -> None:
    rng = np.random.default_rng(60)
    usual = known(rng, 3, 2, 1).qp
    (data,), factors = normalised(usual.data[np.newaxis], usual.sizes)
    np.testing.assert_array_equal(data, usual.data)
    np.testing.assert_array_equal(factors, 1.0)
    unit = np.array([1e-5, 1e4, 1.0, 0.0])
    G = unit[:, np.newaxis] * rng.uniform(0.5, 1.0, (4, 2))
    qp = QP(np.diag([0.0, 1e7]), [1.0, 0.0], G, [1.0, np.inf, 0.0, 1.0], [[1e-9, 0.0]], [1e-9])
    scaled = QP.from_data(normalised(qp.data[np.newaxis], qp.sizes)[0][0], qp.sizes)
    assert 1.0 <= np.abs(scaled.P).max() < 2.0
    units = np.append(qp.P[1, 1] / scaled.P[1, 1], qp.G[:3, 0] / scaled.G[:3, 0])
    np.testing.assert_array_equal(np.frexp(units)[0], 0.5)
    np.testing.assert_array_equal(scaled.q / scaled.P[1, 1], qp.q / qp.P[1, 1])
    assert ((np.abs(scaled.G).max(axis=1) >= 0.5) == [True, True, True, False]).all()
    np.testing.assert_array_equal(scaled.G[0] / scaled.h[0], qp.G[0] / qp.h[0])
    np.testing.assert_array_equal(scaled.h[1:], qp.h[1:])
    np.testing.assert_array_equal(scaled.A[0, 0] / scaled.b, [1.0])


def test_gaps_are_relative_to_their_terms() -> None:
    """Worked out by hand, for x = (10, 4) and the solution (10, 3)."""
    qp = QP(np.diag([2.0, 4.0]), [-20.0, -12.0], G=[[0.0, 0.0], [1.0, 2.0]], h=[-0.5, 15.0])
    slight = QP(1e-6 * qp.P, 1e-6 * qp.q, 1e-6 * qp.G, 1e-6 * qp.h)
    for program, least in ((qp, 1.0), (slight, 1e-6)):
        reference = np.array([[[0.0, 1.0]]])  # the step away from it
        block = stacked(program.data[np.newaxis], program.sizes)
        x = np.array([[10.0, 4.0]])
        # Terms: 1/2 (2 * 100 + 4 * 16) = 132 and 200 + 48; difference 2 (16 - 9) - 12.
        assert objective_gaps(block, x, reference) == pytest.approx(2.0 / 248.0)
        # A row of zeros, by 0.5 of 1; 18 > 15, by 3 of 18 + 15.
        expected = max(0.5 if least == 1.0 else 0.5e-6, 3.0 / 33.0)
        assert feasibility_gaps(block, x) == pytest.approx(expected)


def test_a_slight_row_or_cost_counts_by_its_own_size() -> None:
    row = QP(np.eye(1), [0.0], G=[[1e-7]], h=[-5e-7])
    cost = QP(np.zeros((1, 1)), [1e-9], lb=[0.0], ub=[1.0])
    for check in (PROXQP, DAQP):
        assert agrees(check, row, np.array([-5.0]))
        assert not agrees(check, row, np.array([0.0]))
        assert agrees(check, cost, np.array([0.0]))
        assert not agrees(check, cost, np.array([0.5]))


def test_a_reference_that_is_off_blames_no_right_answer(monkeypatch) -> None:
    """Curvature 1e-5: at a residual of 1e-9, the reference is 1e-4 from the solution (1, 1)."""
    qp = QP(np.diag([1.0, 1e-5]), [-1.0, -1e-5])
    point = np.array([1.0, 1.0001, 0.0, 0.0])
    monkeypatch.setattr(crosscheck, "reference_solver", lambda *_: lambda qp: point)
    assert agrees(PROXQP, qp, np.array([1.0, 1.0]))
    assert not agrees(PROXQP, qp, np.array([1.0, 1.00002]))
    off = np.array([1.00001, 1.0])
    assert PROXQP.check(qp, off).solution_gap == pytest.approx(1e-5, rel=1e-6)


def test_a_row_that_is_not_active_at_the_solution_may_be_at_the_reference(monkeypatch) -> None:
    """A row with a multiplier in the reference's answer that it has not in the solution (1, 1)."""
    qp = QP(np.eye(2), [-1.0, -1.0], G=[[1.0, 0.0]], h=[1.00002])
    reference = np.array([1.0, 1.0, 2e-9, 0.0, 0.0])
    monkeypatch.setattr(crosscheck, "reference_solver", lambda *_: lambda qp: reference)
    assert PROXQP.check(qp, np.array([1.0, 1.00001])).solution_gap == pytest.approx(1e-5)
    assert agrees(PROXQP, qp, np.array([1.0, 1.0]))


def test_the_objective_of_a_proven_answer_is_within_what_the_bound_allows() -> None:
    rng = np.random.default_rng(61)
    proven = 0
    for _ in range(20):
        qp, best = known(rng, 5, 2, 0)[:2]
        point = DNNSolver().solve(qp).point
        point[:N] = best + 1e-8 * rng.standard_normal(N)
        agreement = CrossCheck(("proof",)).check(qp, point)
        if agreement.judge[0, 0] < 0:  # where a row comes twice
            continue
        proven += 1
        x = np.abs(point[:N])
        terms = max(1.0, 0.5 * x @ np.abs(qp.P) @ x, np.abs(qp.q) @ x)
        change = abs((point[:N] - best) @ (0.5 * qp.P @ (point[:N] + best) + qp.q))
        assert change / terms <= agreement.objective_gap[0, 0] <= 1e-6
        assert agreement.feasibility_gap[0, 0] <= 1e-7
    assert proven > 10


def test_the_worst_of_the_stages_of_each_step() -> None:
    # Two steps of two stages, two references; NaN and inf where the second gave no answer.
    gap = np.array([[1.0, 5.0], [3.0, 4.0], [2.0, np.nan], [1.0, 1.0]])
    residual = np.array([[1e-9, 1e-10], [1e-10, 1e-9], [1e-9, np.inf], [1e-9, 1e-9]])
    judge = np.array([[0, 0], [1, 0], [0, -1], [0, 1]], dtype=np.int8)
    worst = Agreement(gap, 2.0 * gap, 3.0 * gap, residual, judge).worst_of(2)
    np.testing.assert_array_equal(worst.judge, [[1, 0], [0, -1]])
    np.testing.assert_array_equal(worst.solution_gap, [[3.0, 5.0], [2.0, np.nan]])
    np.testing.assert_array_equal(worst.objective_gap, [[6.0, 10.0], [4.0, np.nan]])
    np.testing.assert_array_equal(worst.largest, worst.feasibility_gap)
    np.testing.assert_array_equal(worst.feasibility_gap, [[9.0, 15.0], [6.0, np.nan]])
    np.testing.assert_array_equal(worst.reference_residual, [[1e-9, 1e-9], [1e-9, np.inf]])
