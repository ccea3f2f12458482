"""The cross-check has to agree with right answers, see wrong ones, and distrust references."""

import warnings
from collections.abc import Callable

import numpy as np
import pytest
import qpsolvers

import iiwa_dnn as d
from helpers_qp import known_qp
from helpers_simulation import run
from iiwa_dnn.qp import QP, Solution, crosscheck, proof
from iiwa_dnn.qp.crosscheck import CrossCheck
from iiwa_dnn.qp.layout import Sizes

SOLVERS = ("proxqp", "osqp")
BOTH = CrossCheck(SOLVERS)
EACH = [CrossCheck((name,)) for name in SOLVERS]


def nothing_proven(qp: QP, point: np.ndarray) -> tuple[np.ndarray, float, None, str]:
    return point[: qp.q.size], np.inf, None, "nothing proven"


def value(qp: QP, x: np.ndarray) -> float:
    return 0.5 * x @ qp.P @ x + qp.q @ x


def test_gaps_are_those_to_the_known_solution() -> None:
    rng = np.random.default_rng(53)
    for active in range(6):
        qp, best = known_qp(rng, 7, 2, active, inequalities=4 * (active % 2))
        x = best + 0.1 * rng.standard_normal(7)
        agreement = BOTH.check(qp, x)
        np.testing.assert_allclose(agreement.solution_gap, np.abs(x - best).max(), atol=1e-7)
        size = np.abs(x)
        terms = max(1.0, 0.5 * size @ np.abs(qp.P) @ size, np.abs(qp.q) @ size)
        expected = abs(value(qp, x) - value(qp, best)) / terms
        np.testing.assert_allclose(agreement.objective_gap, expected, rtol=0, atol=1e-6)
        one = np.abs(BOTH.check(qp, best + 1e-5 * np.eye(7)[active]).solution_gap)
        np.testing.assert_allclose(one, 1e-5, rtol=2e-2)
        assert (one > BOTH.tolerance).all()
        assert np.isnan(BOTH.check(qp, np.nan * best).solution_gap).all()


def test_a_block_of_programs_is_judged_one_by_one() -> None:
    rng = np.random.default_rng(57)
    known = [known_qp(rng, 7, 3, active) for active in range(5)]
    x = np.stack([best for _, best in known])
    x[3, 2] += 1e-5
    block = BOTH.check_block(np.stack([qp.data for qp, _ in known]), known[0][0].sizes, x)
    assert [array.shape for array in block] == [(5, 2)] * 5
    assert ((block.solution_gap > 1e-6) == (np.arange(5) == 3)[:, np.newaxis]).all()
    for i, (qp, _) in enumerate(known):
        for together, alone in zip(block, BOTH.check(qp, x[i]), strict=True):
            np.testing.assert_allclose(together[i], alone[0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("check", EACH, ids=SOLVERS)
def test_an_infeasible_program_has_no_reference(check: CrossCheck) -> None:
    qp = QP(np.eye(3), np.zeros(3), A=[[1.0, 1.0, 0.0]] * 2, b=[0.0, 1.0])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        agreement = check.check(qp, np.zeros(3))
    assert np.isnan(agreement.solution_gap).all()
    assert np.isnan(agreement.objective_gap).all()
    np.testing.assert_array_equal(agreement.reference_residual, [[np.inf]])


@pytest.mark.parametrize(("first", "second"), [SOLVERS, SOLVERS[::-1], ("daqp", "proxqp")])
def test_a_second_solver_judges_where_the_first_has_no_answer(first, second, monkeypatch) -> None:
    reference_solver = crosscheck.reference_solver
    finite = []
    known = [known_qp(np.random.default_rng([58, k]), 7, 3, k) for k in range(4)]

    def fail(name: str, sizes: Sizes) -> Callable[[QP], np.ndarray]:
        solve = reference_solver(name, sizes)

        def solve_one(qp: QP) -> np.ndarray:
            finite.append(np.isfinite(qp.data).all())
            if name == first and not np.array_equal(qp.data, known[1][0].data):
                raise qpsolvers.exceptions.SolverError("out of order")
            return solve(qp)

        return solve_one

    monkeypatch.setattr(crosscheck, "reference_solver", fail)
    x = np.stack([best for _, best in known])
    programs = np.stack([qp.data for qp, _ in known])
    programs[3, 0] = np.nan
    check = CrossCheck((first,))
    agreement = check.check_block(programs, known[0][0].sizes, x)
    assert agreement.solution_gap[:3].max() <= 1e-7
    assert agreement.reference_residual[:3].max() <= 1e-8
    assert np.isnan(agreement.solution_gap[3]).all()
    np.testing.assert_array_equal(agreement.judge[:, 0], [1, 0, 1, -1])
    assert all(finite)  # ProxQP takes minutes over one NaN
    assert check.settings()["second"] == [second]


def test_programs_with_narrow_bounds_are_judged_by_proxqp_itself() -> None:
    # Acceleration and jerk limits leave bounds 1e-3 apart. ProxQP's own tolerance of infeasibility
    # calls half of these infeasible, feasible though they are.
    rng = np.random.default_rng(61)
    judged = []
    for _ in range(100):
        x = rng.uniform(-0.2, 0.2, 7)
        A = rng.standard_normal((6, 7))
        lb = x - rng.uniform(0.0, 1e-3, 7)
        lb[0] = x[0]
        qp = QP(np.eye(7), A.T @ rng.standard_normal(6) - x + np.eye(7)[0], None, None,
                A, A @ x, lb, lb + 1e-3)  # fmt: skip
        judged.append(CrossCheck().check(qp, d.DNNSolver().solve(qp).x).judge[0, 0])
    assert judged.count(0) >= 99


@pytest.mark.parametrize("name", ["clarabel", "daqp", "piqp", "quadprog"])
def test_any_solver_of_qpsolvers_judges(name: str) -> None:
    rng = np.random.default_rng(60)
    for active in range(4):
        qp, x = known_qp(rng, 7, 3, active, inequalities=4)
        agreement = CrossCheck((name,)).check(qp, x)
        assert agreement.solution_gap.max() < 1e-7
        np.testing.assert_array_equal(agreement.judge, [[0]])


def test_a_solver_that_is_not_installed_is_refused_with_those_that_are() -> None:
    with pytest.raises(d.InvalidInputError, match=r"daqp.*proof, not 'gurobi'"):
        CrossCheck(("gurobi",))
    d.qp.register()
    for wrong in (("iiwa_dnn",), "proxqp", 3):  # a text is a sequence too
        with pytest.raises(d.InvalidInputError, match=r"^solvers\b"):
            CrossCheck(wrong)


@pytest.mark.parametrize(
    ("spoilt", "residual"), [(0, np.inf), (1, np.nan), (3, np.nan), (None, 1.0)]
)
def test_a_reference_is_judged_by_its_own_residual(spoilt, residual, monkeypatch) -> None:
    # Zero is stationary and leaves no gap, and lies outside the bound by one.
    qp = QP(np.eye(1), np.zeros(1), A=[[0.0]], b=[0.0], G=[[0.0]], h=[0.0], lb=[1.0])
    point = np.zeros(4)
    if spoilt is not None:
        point[spoilt] = np.nan
    monkeypatch.setattr(crosscheck, "reference_solver", lambda *_: lambda qp: point)
    monkeypatch.setattr(crosscheck, "enclose_solution", nothing_proven)
    agreement = BOTH.check(qp, np.zeros(1))
    np.testing.assert_array_equal(agreement.reference_residual, [[residual, residual]])
    assert np.isnan(agreement.solution_gap).all()
    np.testing.assert_array_equal(agreement.judge, [[-1, -1]])


def test_a_reference_is_not_blamed_for_rounding(monkeypatch) -> None:
    x = 1e9 * np.random.default_rng(62).standard_normal(5)
    A = np.array([[0.1, 0.2, 0.3, 0.4, 0.5]])
    qp = QP(np.eye(5), -x, A=A, b=A @ x + 5e-7)  # a digit or two of 1e9
    point = np.concatenate([x, np.zeros(6)])
    monkeypatch.setattr(crosscheck, "reference_solver", lambda *_: lambda qp: point)
    monkeypatch.setattr(crosscheck, "enclose_solution", nothing_proven)
    assert qp.residuals(point).largest > 1e-7
    agreement = CrossCheck().check(qp, x)
    assert (agreement.judge[0, 0], agreement.largest[0, 0] < 1e-6) == (0, True)
    assert agreement.reference_residual == CrossCheck().reference_tolerance
    wrong = point + np.arange(11) / 10.0
    monkeypatch.setattr(crosscheck, "reference_solver", lambda *_: lambda qp: wrong)
    assert CrossCheck().check(qp, x).judge == -1
    monkeypatch.setattr(crosscheck, "enclose_solution", proof.enclose_solution)
    assert CrossCheck().check(qp, x).judge == 2


class Liar(d.DNNSolver):
    """Claims to have solved everything, and has not at one call."""

    def __init__(self, wrong_at: int, size: float = 1e-5) -> None:
        super().__init__()
        self.calls, self.wrong_at, self.size = 0, wrong_at, size

    def solve(self, qp: QP) -> Solution:
        solution = super().solve(qp)
        self.calls += 1
        if self.calls - 1 != self.wrong_at:
            return solution
        point = solution.point.copy()
        point[2] += self.size
        return solution._replace(point=point)


@pytest.mark.parametrize("check", [*EACH, BOTH], ids=[*SOLVERS, "both"])
def test_a_run_with_one_wrong_answer_names_step_and_solver(check: CrossCheck) -> None:
    record = run(solver=Liar(wrong_at=17), check=check, duration=0.03)
    assert np.flatnonzero(record.crosscheck_gap > 1e-6).tolist() == [17]
    np.testing.assert_allclose(record.solution_gap[17], 1e-5, rtol=1e-2)
    crosscheck = d.compute_metrics(record)["crosscheck"]
    assert crosscheck["disagreements"] == 1
    assert crosscheck["steps_checked"] == 30
    assert crosscheck["reference_failures"] == 0
    assert crosscheck["max_solution_gap"] == pytest.approx(1e-5, rel=1e-2)
    assert crosscheck["first_disagreement"]["step"] == 17
    (reason,) = d.failures(record)
    assert "step 17 " in reason
    assert any(name in reason for name in check.solvers)
    assert "1e-05" in reason


def test_verdicts_keep_their_step_over_the_blocks_of_a_long_run() -> None:
    record = run(solver=Liar(wrong_at=2 * 730 + 1), check=EACH[0], duration=1.1, motion="midpoint")
    assert np.flatnonzero(record.crosscheck_gap > 1e-6).tolist() == [730]
    assert (record.reference_residual <= 1e-8).all()
