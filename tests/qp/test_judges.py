"""The check, judged by programs of whole numbers times powers of two: no number in them is rounded.

So the point from which a program is made is its solution, and the only one, to the last bit,
however slight a curvature and whatever the units.
"""

import sys
from collections import Counter

import numpy as np
import pytest
import qpsolvers

import iiwa_dnn as d
from iiwa_dnn import QP, CrossCheck

KINDS = ("plain", "curvature", "slighter", "rows", "cost", "columns", "vertex", "both")


def draw(rng: np.random.Generator, kind: str) -> tuple[QP, np.ndarray, np.ndarray]:
    """A program of a kind, its solution (n,), and the rows that are met there, (k, n)."""
    while True:
        n = int(rng.integers(2, 8))
        strong = n if kind == "vertex" else int(rng.integers(0, n + 1))
        weak = int(rng.integers(0, 2))
        p = int(rng.integers(0, min(strong, 2) + 1))
        m = int(rng.integers(0, 5))
        rank = 0 if kind == "vertex" else n
        V = rng.integers(-4, 5, (rank, n)).astype(float)
        x = rng.integers(-4, 5, n).astype(float)
        C = np.vstack([rng.integers(-4, 5, (p + m, n)), np.eye(n), -np.eye(n)])
        may_be_met = np.concatenate([np.arange(m), m + np.arange(n) + n * rng.integers(0, 2, n)])
        more = p + rng.permutation(may_be_met)[: strong - p + weak]
        met = np.concatenate([np.arange(p), more]).astype(int)
        fixed = np.vstack([V, C[met[:strong]]])
        if len(met) == strong + weak and np.linalg.matrix_rank(fixed) == n:
            break
    exponents = {"curvature": [24], "slighter": [28, 32, 36], "both": [24]}.get(kind, [0])
    slight = (rng.random(rank) < 0.4) | (np.arange(rank) == 0)
    P = (V.T * np.where(slight, 2.0 ** -rng.choice(exponents, rank), 1.0)) @ V
    slack = rng.integers(1, 9, len(C)).astype(float)
    slack[met] = 0.0
    force = np.zeros(len(C))
    force[met[:strong]] = rng.integers(1, 9, strong)
    force[:p] = rng.integers(-4, 5, p)
    limits = C @ x + slack
    q = -(P @ x + C.T @ force)
    scales = 2.0 ** np.array([-26, 0, 26])
    of_rows = rng.choice(scales if kind in ("rows", "both") else [1.0], p + m)
    of_x = rng.choice([1.0, rng.choice(scales) if kind == "columns" else 1.0], n)
    cost = rng.choice(scales if kind == "cost" else [1.0])
    rows = of_rows[:, np.newaxis] * C[: p + m] * of_x
    sides = of_rows * limits[: p + m]
    upper, lower = np.split(limits[p + m :] / np.tile(of_x, 2), 2)
    qp = QP(cost * P * of_x * of_x[:, np.newaxis], cost * q * of_x,
            rows[p:], sides[p:], rows[:p], sides[:p], -lower, upper)  # fmt: skip
    return qp, x / of_x, C[met] * of_x


def wrong(rng: np.random.Generator, qp: QP, x: np.ndarray, met: np.ndarray) -> np.ndarray:
    """A point that is off: anywhere, along the slightest curvature, or along the rows met."""
    directions = [rng.standard_normal(x.size), np.linalg.eigh(qp.P)[1][:, 0]]
    along = np.linalg.svd(np.vstack([met, np.zeros((1, x.size))]))[2][len(met) :]
    directions += [along.T @ rng.standard_normal(len(along))] if len(along) else []
    step = directions[rng.integers(len(directions))]
    return x + 10.0 ** rng.uniform(-5.0, 1.0) * step / np.abs(step).max()


def verdict(check: CrossCheck, qp: QP, x: np.ndarray) -> str:
    found = check.check(qp, x)
    if found.judge[0, 0] < 0:
        return "undecided"
    return "agrees" if found.largest[0, 0] <= check.tolerance else "blamed"


def count(programs: int, solver: str, seed: int = 70) -> Counter[tuple[str, str]]:
    """Count verdicts on right and wrong answers; ten right ones for each wrong one."""
    check = CrossCheck((solver,))
    counts: Counter[tuple[str, str]] = Counter()
    for k in range(programs):
        rng = np.random.default_rng([seed, k])
        kind = KINDS[rng.integers(len(KINDS))]
        qp, x, met = draw(rng, kind)
        if k % 10 == 0:
            counts["wrong", verdict(check, qp, wrong(rng, qp, x, met))] += 1
        off = 0.0 if kind == "columns" else 1e-9 * rng.uniform(-1.0, 1.0, x.size)
        counts["right", verdict(check, qp, x + off)] += 1
    return counts


@pytest.mark.parametrize("solver", ["proxqp", "osqp", "daqp"])
def test_no_right_answer_is_blamed_and_no_wrong_one_agreed_with(solver: str) -> None:
    counts = count(400, solver)
    assert counts["right", "blamed"] == 0
    assert counts["wrong", "agrees"] == 0
    assert counts["right", "undecided"] <= 8
    assert counts["wrong", "undecided"] <= 2


@pytest.mark.parametrize("curvature", [1e-6, 1e-8, 1e-9, 1e-11])
def test_a_wrong_answer_along_a_slight_curvature_is_a_disagreement(curvature: float) -> None:
    qp = QP(np.diag([1.0, curvature]), [-1.0, -curvature], lb=[-5.0, -5.0], ub=[5.0, 5.0])
    for solver in ("proxqp", "osqp", "daqp"):
        check = CrossCheck((solver,))
        for x in ([1.0, 3.0], [1.0, 0.0], [1.0, 1.00001]):
            gap = check.check(qp, np.array(x)).solution_gap[0, 0]
            assert gap == pytest.approx(abs(x[1] - 1.0), rel=1e-6)
        assert verdict(check, qp, np.array([1.0, 1.0])) == "agrees"


def test_a_right_answer_that_a_reference_is_far_from_is_cleared_by_a_proof_of_its_own() -> None:
    """A reference with a residual of 4e-12 blamed it by 1.6: multipliers of 2^-31 of the cost."""
    heavy = np.array(
        [
            [230, 141, -217, -76, 101, 185, -188],
            [141, 695, -81, 399, 293, -202, 46],
            [-217, -81, 508, -66, 12, -212, 270],
            [-76, 399, -66, 498, 193, -339, 40],
            [101, 293, 12, 193, 451, -112, -204],
            [185, -202, -212, -339, -112, 579, -26],
            [-188, 46, 270, 40, -204, -26, 467],
        ]
    )  # of rank 5
    x = np.array([-8, -11, -21, -1, 8, 3, 3]) / 16.0
    lower = np.array([-48, -82, -52, -22, -53, -20, 3]) / 16.0
    upper = np.array([-8, 20, 14, 21, 42, 51, 41]) / 16.0
    P = 2.0**21 * heavy + 0.25 * np.eye(7)
    q = -P @ x - np.array([0.5, 0.0, 0.0, 0.0, 0.0, 0.0, -0.1875])
    G = np.array([[-1, -2, 3, 4, 1, -3, 4]]) / 4.0
    qp = QP(P, q, G=G, h=[0.34375], lb=lower, ub=upper)
    check = CrossCheck()
    assert verdict(check, qp, x) == "agrees"
    assert check.check(qp, x).judge[0, 0] == 2


@pytest.mark.parametrize("solver", ["proxqp", "osqp", "daqp"])
def test_a_right_answer_in_units_that_are_far_apart_is_not_blamed(solver: str) -> None:
    """All numbers are whole times powers of two, so the answer is exact, and the only one."""
    check = CrossCheck((solver,))
    counts: Counter[str] = Counter()
    for k in range(100):
        rng = np.random.default_rng(k)
        root = rng.integers(-3, 4, (3, 3)).astype(float)
        x = rng.integers(-5, 6, 3).astype(float)
        met = rng.random(3) < 0.4
        if np.linalg.matrix_rank(root) == 3:
            P = root.T @ root
            unit = 2.0 ** np.array([26, 0, -26])
            q = (-P @ x - 3.0 * met) * unit
            ends = {"lb": (x - 3.0) / unit, "ub": (x + np.where(met, 0.0, 4.0)) / unit}
            qp = QP(P * unit * unit[:, np.newaxis], q, **ends)
            counts[verdict(check, qp, x / unit)] += 1
    assert counts["blamed"] == 0
    assert counts.total() > 80


def answers(monkeypatch: pytest.MonkeyPatch, **parts: object) -> QP:
    """Let a solver answer with these parts; return a program of two variables."""

    def solve(problem: qpsolvers.Problem, *_: object, **__: object) -> qpsolvers.Solution:
        return qpsolvers.Solution(problem, found=True, **parts)  # type: ignore[arg-type]

    monkeypatch.setattr(qpsolvers, "solve_problem", solve)
    return QP(np.eye(2), [-1.0, -1.0], A=[[1.0, 1.0]], b=[2.0])


@pytest.mark.parametrize(
    "parts", [{"x": np.zeros(0)}, {"x": np.ones(3)}, {"x": np.ones(2), "y": np.ones(2)}]
)
def test_a_reference_that_returns_another_size_is_named(monkeypatch, parts) -> None:
    qp = answers(monkeypatch, **parts)
    with pytest.raises(d.InvalidInputError, match=r"answer of daqp: .*has shape"):
        CrossCheck(("daqp",)).check(qp, np.ones(2))


def test_a_reference_without_a_point_has_no_answer(monkeypatch) -> None:
    qp = answers(monkeypatch, x=None)
    assert CrossCheck(("daqp",)).check(qp, np.ones(2)).judge[0, 0] == 1  # of ProxQP


def test_a_reference_that_cannot_be_imported_is_named(monkeypatch) -> None:
    qp = QP(np.eye(2), [-1.0, -1.0])
    monkeypatch.setattr(qpsolvers, "available_solvers", ["daqp"])
    with pytest.raises(d.MissingDependencyError, match=r"osqp.* is missing: pip install"):
        CrossCheck(("osqp",)).check(qp, np.ones(2))
    monkeypatch.setitem(sys.modules, "proxsuite", None)
    with pytest.raises(d.MissingDependencyError, match="proxsuite is missing: pip install"):
        CrossCheck().check(qp, np.ones(2))
