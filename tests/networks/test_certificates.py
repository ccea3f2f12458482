"""Programs without a solution: recognised, and the proof judged by numpy."""

from fractions import Fraction
from operator import mul

import numpy as np
import pytest

import programs
from iiwa_dnn import QP, DNNSolver, Status
from iiwa_dnn.qp import certificates


def assert_farkas(qp: QP, certificate: np.ndarray) -> None:
    """The multipliers contradict the constraints: by the lemma, with numpy alone."""
    n, m, p = qp.sizes
    y, z, z_box = np.split(certificate, [p, p + m])
    assert z_box.shape == (n,)
    assert (z >= 0.0).all()
    assert (qp.ub[z_box > 0.0] < np.inf).all()
    assert (qp.lb[z_box < 0.0] > -np.inf).all()
    assert (qp.h[z > 0.0] < np.inf).all()
    value = qp.b @ y + qp.h[z > 0.0] @ z[z > 0.0]
    value += qp.ub[z_box > 0.0] @ z_box[z_box > 0.0] + qp.lb[z_box < 0.0] @ z_box[z_box < 0.0]
    residual = np.abs(qp.A.T @ y + qp.G.T @ z + z_box).sum()
    assert value < -1e8 * residual
    assert value < -1e-9 * np.abs(certificate).max()


def assert_recession(qp: QP, direction: np.ndarray) -> None:
    """The cost falls along the direction, and no constraint ends it."""
    rows = np.vstack([qp.G, np.eye(qp.q.size), -np.eye(qp.q.size)])
    limited = np.isfinite(np.concatenate([qp.h, qp.ub, -qp.lb]))
    residual = np.abs(qp.P @ direction).max() + np.abs(qp.A @ direction).max(initial=0.0)
    residual += (rows[limited] @ direction).max(initial=0.0)
    assert qp.q @ direction < -1e7 * residual


@pytest.mark.long
@pytest.mark.parametrize(
    ("make", "count", "outright", "near", "judge", "least"),
    [
        # Outright where finite bounds carry all that the multipliers leave; of the others it is
        # shown that no point within 1e8 is feasible.
        (programs.infeasible, 1000, "PRIMAL_INFEASIBLE", "NONE_FEASIBLE_NEAR", assert_farkas, 50),
        (programs.unbounded, 200, "UNBOUNDED", "NONE_OPTIMAL_NEAR", assert_recession, 10),
    ],
)
def test_none_without_a_solution_lacks_a_proof(make, count, outright, near, judge, least) -> None:
    proven = 0
    for seed in range(count):
        qp = make(np.random.default_rng([2, seed]))
        solution = DNNSolver().solve(qp)
        assert solution.status in (Status[outright], Status[near]), seed
        proven += solution.status is Status[outright]
        assert not solution.found
        judge(qp, solution.certificate)
    assert proven > least


@pytest.mark.parametrize(
    ("qp", "x", "status"),
    [
        (QP([[1.0, 1.0 - 2.0**-40], [1.0 - 2.0**-40, 1.0]], [-0.125, 0.125]), 2.0**37,
         Status.NONE_OPTIMAL_NEAR),
        (QP(np.eye(2), [0.0, 0.0], A=[[1.0, 1.0], [1.0, 1.0 - 2.0**-30]], b=[0.0, 1.0]), 2.0**30,
         Status.NONE_FEASIBLE_NEAR),
        (QP([[1.0]], [0.0], A=[[1e-9]], b=[1.0], lb=[-1.0], ub=[1.0]), None,
         Status.PRIMAL_INFEASIBLE),
        (QP([[1.0]], [0.0], [[1.0], [-1.0]], [0.0, -1e-3], lb=[-9.0], ub=[9.0]), None,
         Status.PRIMAL_INFEASIBLE),
    ],
)  # fmt: skip
def test_a_status_says_what_was_shown(qp: QP, x: float | None, status: Status) -> None:
    solution = DNNSolver().solve(qp)
    assert solution.status is status
    # A program with a solution is not called infeasible or unbounded, only far.
    assert ("within 1e8" in status.value) is (x is not None)
    if x is not None:
        point = np.array([x, -x])
        multipliers = np.linalg.lstsq(qp.A.T, -(qp.P @ point + qp.q))[0]
        rest = np.abs(qp.P @ point + qp.q + qp.A.T @ multipliers).max()
        assert rest <= 1e-15 * np.abs(multipliers).max(initial=0.0)
        assert np.abs(qp.A @ point - qp.b).max(initial=0.0) == 0.0


def test_far_solutions_of_slight_rows_and_costs_are_found() -> None:
    """Not the absolute size of coefficients decides: in other units the same programs are plain."""
    for qp, x in (
        (QP([[1e-9]], [-0.2]), 2e8),
        (QP([[1.0]], [0.0], A=[[1e-9]], b=[1.0]), 1e9),
        (QP([[0.0]], [-1e-8], [[1e-10]], [1e-10]), 1.0),
    ):
        solution = DNNSolver().solve(qp)
        assert solution.found
        assert solution.x[0] == pytest.approx(x, rel=1e-12)


def test_textbook_contradictions_are_proven() -> None:
    """Whole numbers leave no residual: the certificates hold outright, without bounds too."""
    between = QP([[1.0]], [0.0], [[1.0], [-1.0]], [1.0, -2.0])
    thirds = QP(np.eye(2), np.ones(2), [[3.0, 5.0], [-1.0, 0.0], [0.0, -1.0]], [1.0, -2.0, -1.0])
    falling = QP(np.diag([1.0, 0.0, 0.0]), [0.0, -1.0, 0.0], [[1.0, 1.0, 1.0]], [1.0])
    for qp, status in (
        (between, Status.PRIMAL_INFEASIBLE),
        (thirds, Status.PRIMAL_INFEASIBLE),
        (falling, Status.UNBOUNDED),
    ):
        solution = DNNSolver().solve(qp)
        assert solution.status is status
        proof = [Fraction(value) for value in solution.certificate]
        exact = [[Fraction(v) for v in row] for row in (*qp.P, *qp.G)]
        if status is Status.UNBOUNDED:
            products = [sum(map(mul, row, proof)) for row in exact]
            assert products == [0, 0, 0, 0]
            assert sum(map(mul, map(Fraction, qp.q), proof)) < 0
        else:
            multipliers = proof[: qp.h.size]
            columns = zip(*exact[qp.q.size :], strict=True)
            assert [sum(map(mul, column, multipliers)) for column in columns] == [0] * qp.q.size
            assert sum(map(mul, map(Fraction, qp.h), multipliers)) < 0 <= min(multipliers)


@pytest.mark.parametrize("limit", [-1e-300, -1e-10, -1.0, -1e10])
def test_a_row_of_zeros_that_its_limit_contradicts_is_infeasible(limit: float) -> None:
    rng = np.random.default_rng(3)
    qp, _ = programs.strictly_convex(rng, 5, 1e3)
    G = np.vstack([qp.G, np.zeros(5)])
    rows = QP(qp.P, qp.q, G, np.append(qp.h, limit), qp.A, qp.b, qp.lb, qp.ub)
    A = np.vstack([qp.A, np.zeros(5)])
    equations = QP(qp.P, qp.q, qp.G, qp.h, A, np.append(qp.b, limit), qp.lb, qp.ub)
    for wrong, place in ((rows, qp.b.size + qp.h.size), (equations, qp.b.size)):
        solution = DNNSolver().solve(wrong)
        assert solution.status is Status.PRIMAL_INFEASIBLE
        assert np.flatnonzero(solution.certificate).tolist() == [place]
    for fine in (0.0, 1e-10, np.inf):
        rows.h[-1] = fine
        assert DNNSolver().solve(rows).found


def test_products_in_twice_the_precision_against_fractions() -> None:
    rng = np.random.default_rng(6)
    for _ in range(200):
        rows = rng.standard_normal((3, 6)) * 10.0 ** rng.integers(-8, 9, (3, 6))
        vector = rng.standard_normal(6)
        rows[0, -1] = -(rows[0, :-1] @ vector[:-1]) / vector[-1]  # cancels but for rounding
        rows[1] = rng.integers(-9, 10, 6)
        rows[2] *= rng.integers(0, 2, 6) * 1e-300
        whole = rng.integers(-9, 10, 6).astype(float)
        for x in (vector, whole):
            result = np.empty((2, 3))
            certificates.dot_twice(rows, x, *result)
            for row, value, bound in zip(rows, *result, strict=True):
                exact = sum(map(mul, map(Fraction, row), map(Fraction, x)))
                assert abs(Fraction(value) - exact) <= Fraction(bound)
        assert result[1, 1] == 0.0


def test_a_contradiction_below_rounding_is_none() -> None:
    for gap, proven in ((1e-3, True), (1e-12, True), (1e-17, False), (0.0, False), (-1.0, False)):
        rows = [[1.0 / 3.0], [-1.0 / 3.0]]
        qp = QP(np.eye(1), [0.0], rows, [1.0, -1.0 - gap], lb=[-10.0], ub=[10.0])
        radius = certificates.infeasibility_radius(qp, np.array([1.0, 1.0]))
        assert (radius == np.inf) is proven
    for k in range(2, 100):
        for x in range(1, 20):  # k x <= k x and x >= x, in whole numbers
            qp = QP(np.eye(1), [0.0], [[k], [-1.0]], [k * x, -x], lb=[-x], ub=[x])
            assert certificates.infeasibility_radius(qp, np.array([1.0 / k, 1.0])) <= x


def test_wrong_evidence_proves_nothing() -> None:
    # x0 = 0 and x0 <= -1, and x1 <= 0
    qp = QP(np.eye(2), np.zeros(2), [[1.0, 0.0]], [-1.0], [[1.0, 0.0]], [0.0], ub=[np.inf, 0.0])
    assert certificates.infeasibility_radius(qp, np.array([-1.0, 1.0])) > 1e12
    for wrong in ([1.0, -1.0], [1.0, 1.0], [0.0, 0.0], [np.nan, 1.0]):
        assert certificates.infeasibility_radius(qp, np.array(wrong)) < 10.0
    # the cost falls with x1, which nothing ends; x0 costs, and is not below zero
    qp = QP(np.diag([1.0, 0.0]), [0.0, -1.0], lb=[0.0, -np.inf])
    assert certificates.unboundedness_radius(qp, np.array([0.0, 1.0])) > 1e12
    for wrong in ([1.0, 1.0], [0.0, -1.0], [-1.0, 1.0], [0.0, 0.0], [np.inf, 1.0]):
        assert certificates.unboundedness_radius(qp, np.array(wrong)) < 10.0
    # P d = 0 is not enough where P is not symmetric, and nothing is where P d overflows
    slanted = QP([[0.0, 1e-5], [0.0, 1.0]], [1e-3, 0.0])
    assert certificates.unboundedness_radius(slanted, np.array([-1.0, 0.0])) == pytest.approx(200)
    steep = QP([[1e308, 1e308], [1e308, 1.5e308]], [-1.0, 0.0])
    assert not certificates.unboundedness_radius(steep, np.array([10.0, -10.0])) > 0.0
    bounded = QP(np.zeros((1, 1)), [-1.0], ub=[5.0])
    assert certificates.unboundedness_radius(bounded, np.ones(1)) <= 5.0


def test_the_radius_is_what_it_says() -> None:
    # x0 (1 + 1e-4) <= -1 and x0 >= -1 + 2e-4 contradict each other, and nearly do not.
    slope, bound = 1.0 + 1e-4, -1.0 + 2e-4
    rows = QP(np.eye(1), np.zeros(1), [[slope], [-1.0]], [-1.0, -bound])
    # Multipliers that ignore the slope leave a residual of 1e-4 and a value of -2e-4: radius 2.
    assert certificates.infeasibility_radius(rows, np.ones(2)) == pytest.approx(2.0)
    # What one row leaves, the bound takes; with another bound beside it, that proves it outright.
    for ub, least in ((np.inf, 1e8), (1e6, np.inf)):
        bounded = QP(np.eye(1), np.zeros(1), [[slope]], [-1.0], lb=[bound], ub=[ub])
        assert certificates.infeasibility_radius(bounded, np.ones(1)) >= least
    # x0 = -1 is feasible: no multipliers may claim a radius above 10.
    feasible = QP(np.eye(1), np.zeros(1), [[slope]], [-1.0], lb=[-10.0])
    assert certificates.infeasibility_radius(feasible, np.ones(1)) <= 10.0
