"""Proofs of answers, judged by exact solutions in whole numbers, which share no code with them."""

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
import qpsolvers

import exact
import programs
from exact import whole_numbers
from helpers_qp import known_qp
from iiwa_dnn import QP, CrossCheck, DNNSolver, InvalidInputError, Solution, Status, prove
from iiwa_dnn.qp.proof import DEPENDENT, FAR, NOT_CONVEX, WEAK, Proof


def answer(x: list[float], z_box: list[float] | None = None, **more: list[float]) -> object:
    """An answer of no solver in particular."""
    return SimpleNamespace(x=np.array(x), z_box=np.array(z_box or 0.0 * np.array(x)), **more)


def judged(qp: QP, solution: Solution) -> tuple[Proof, float]:
    """Prove an answer; also the bound over the true error, which is to be at least one."""
    proof = prove(qp, solution)
    if not proof.bound < np.inf:
        assert proof.reason
        return proof, np.inf
    solved = exact.exact_solution(qp, exact.face_of(qp, proof.active))
    assert solved is not None
    error = exact.distance(solution.x, solved)
    assert error <= Fraction(proof.bound)
    return proof, float(Fraction(proof.bound) / error) if error else np.inf


KINDS = {
    "whole numbers": whole_numbers,
    "strictly convex": lambda rng: programs.strictly_convex(rng, int(rng.integers(2, 6)))[0],
    "an arm's shape": lambda rng: known_qp(rng, 7, 6, int(rng.integers(0, 2)))[0],
    "rows badly scaled": programs.badly_scaled,
}


@pytest.mark.parametrize(("kind", "count", "fraction"), [
    ("whole numbers", 300, 0.3), ("strictly convex", 150, 0.4), ("an arm's shape", 40, 0.9),
    ("rows badly scaled", 3, 0.6),
])  # fmt: skip
def test_no_bound_is_below_the_true_error(kind: str, count: int, fraction: float) -> None:
    proven = 0
    for seed in range(count):
        rng = np.random.default_rng([26, seed])
        qp = KINDS[kind](rng)
        solution = DNNSolver().solve(qp)
        if seed % 3 == 2:  # an answer that is a little off, or far
            shift = 10.0 ** rng.uniform(-15.0, 0.0) * rng.standard_normal(solution.point.size)
            solution = solution._replace(point=solution.point + shift)
        proven += judged(qp, solution)[0].bound < np.inf
    assert proven >= fraction * count


def held(qp: QP, x: list[Fraction]) -> list[int]:
    """The rows and bounds that an exact point (n,) meets with equality, as in `Proof.active`."""
    found = []
    for value, lower, upper in zip(x, qp.lb, qp.ub, strict=True):
        found.append(1 if value == upper else -int(value == lower))
    for row, limit in zip(qp.G, qp.h, strict=True):
        reached = sum(Fraction(float(entry)) * value for entry, value in zip(row, x, strict=True))
        found.append(int(reached == limit))
    return found


def test_a_proven_active_set_has_all_rows_and_bounds_that_the_solution_meets() -> None:
    """Where a row is met with a multiplier of zero, no active set is proven."""
    proven = 0
    for seed in range(200):
        qp = whole_numbers(np.random.default_rng([30, seed]))
        proof = prove(qp, DNNSolver().solve(qp))
        if not proof.reason:
            solved = exact.exact_solution(qp, exact.face_of(qp, proof.active))
            assert solved is not None
            assert proof.active.tolist() == held(qp, solved)
            proven += 1
    assert proven > 50
    touching = prove(QP(np.eye(1), [0.0], ub=[0.0]), answer([0.0]))
    assert (touching.bound < 1e-12, touching.reason) == (True, WEAK)


def test_nothing_about_the_answer_is_trusted() -> None:
    qp, x = known_qp(np.random.default_rng(1), 5, 2, 2, inequalities=4)
    far = x + np.array([3.0, 0.0, 0.0, 0.0, 0.0])
    zeros = np.zeros(5)
    for multipliers in (None, zeros, 1e3 * np.ones(5), -1e3 * np.ones(5)):
        proof, _ = judged(qp, SimpleNamespace(x=far, z_box=multipliers))
        if proof.bound < np.inf:
            assert proof.bound == pytest.approx(3.0, abs=1e-9)
    # Another x takes the same multipliers to the same active set.
    solution = DNNSolver().solve(qp)
    for name in "xyz":
        moved = SimpleNamespace(**{part: getattr(solution, part) for part in ("x", "y", "z")})
        moved.z_box = solution.z_box
        setattr(moved, name, np.full(getattr(moved, name).size, np.nan))
        assert prove(qp, moved).bound == np.inf


@pytest.mark.parametrize(
    ("qp", "x", "bound", "reason"),
    [
        (QP(np.eye(1), [-1.0], ub=[0.5]), [0.25], 0.25, ""),
        (QP([[1e8]], [-1e8], ub=[0.5]), [0.25], 0.25, ""),
        (QP([[7e-151, 7e-151], [7e-151, 3e-151]], [0.0, 0.0], A=[[2.22e-162, 8.88e-163]], b=[0.0]),
         [0.0, 0.0], np.inf, NOT_CONVEX),  # A^T A underflows
        (QP(np.eye(1), [-1.0], ub=[1.0]), [1.0], 0.0, WEAK),  # a multiplier of zero
        (QP(np.zeros((1, 1)), [-1.0], ub=[2.0]), [2.0], np.inf, DEPENDENT),  # without multipliers
        (QP(np.zeros((1, 1)), [0.0], lb=[2.0], ub=[2.0]), [2.5], 0.5, ""),
        (QP(np.zeros((1, 1)), [0.0], lb=[0.0], ub=[2.0]), [1.0], np.inf, DEPENDENT),  # any x
        (QP(np.eye(2), [0.0, 0.0], A=[[0.0, 0.0]], b=[0.0]), [0.0, 0.0], 0.0, ""),  # 0 x = 0
        (QP(np.eye(2), [0.0, 0.0], A=[[1.0, 1.0], [1.0, 1.0]], b=[1.0, 1.0]), [0.5, 0.5], 0.0, ""),
        (QP(np.eye(2), [0.0, 0.0], A=[[1.0, 1.0], [1.0, 1.0]], b=[1.0, 2.0]), [0.5, 0.5], np.inf,
         DEPENDENT),
        (QP([[-1e-18]], [0.0], lb=[-1.0], ub=[1.0]), [0.0], np.inf, NOT_CONVEX),
        (QP([[1.0, 1.0], [1.0, 1.0 - 1e-15]], [0.0, 0.0]), [0.0, 0.0], np.inf, DEPENDENT),
        (QP([[1.0, 2.0], [2.0, 1.0]], [0.0, 0.0], A=[[1.0, -1.0]], b=[0.0]), [0.0, 0.0], 0.0, ""),
        (QP([[1.0, 2.0], [2.0, 1.0]], [0.0, 0.0], A=[[1.0, 1.0]], b=[0.0]), [0.0, 0.0], np.inf,
         NOT_CONVEX),
        (QP(np.diag([-1.0, 10.0, 0.0]), np.zeros(3), A=[[1.0, 0.0, -1.0]], b=[0.0]), [0.0] * 3,
         np.inf, NOT_CONVEX),
        (QP([[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0] * 3], np.zeros(3), A=[[1.0, -1.0, 0.0]],
            b=[0.0], lb=[-1.0, -1.0, 2.0], ub=[1.0, 1.0, 2.0]), [0.0, 0.0, 2.0], 0.0, ""),
        (QP([[1.0, 1e-6], [-1e-6, 1.0]], [-1.0, -1.0]), [1.0, 1.0], 0.0, ""),  # its symmetric part
        (QP(np.eye(1), [0.0]), [np.inf], np.inf, FAR),
        (QP(np.eye(1), [0.0], G=[[0.0]], h=[-1.0]), [0.0], np.inf, DEPENDENT),
    ],
)  # fmt: skip
def test_bounds_and_reasons(qp: QP, x: list[float], bound: float, reason: str) -> None:
    proof = prove(qp, SimpleNamespace(x=np.array(x)))
    assert proof.reason == reason
    assert bound <= proof.bound <= bound + 2e-14


def test_a_vertex_of_a_linear_program_is_proven_by_its_multipliers() -> None:
    qp = QP(np.zeros((2, 2)), [-1.0, -2.0], G=[[1.0, 1.0]], h=[3.0], lb=[0.0, 0.0], ub=[2.0, 2.0])
    proof, _ = judged(qp, DNNSolver().solve(qp))
    np.testing.assert_array_equal(proof.active, [0, 1, 1])
    assert (proof.reason, proof.bound < 1e-9) == ("", True)


def test_a_limit_that_the_answer_names_wrongly_is_released() -> None:
    # x = 1 is free; the multipliers hold it at the row, or at one of the bounds.
    qp = QP(np.eye(1), [-1.0], G=[[1.0]], h=[2.0], lb=[0.0], ub=[3.0])
    for z, z_box in ((5.0, 0.0), (0.0, 5.0), (0.0, -5.0)):
        proof = prove(qp, answer([1.0], [z_box], z=np.array([z])))
        assert (proof.reason, proof.bound < 1e-14) == ("", True)
        assert not proof.active.any()


@pytest.mark.parametrize("scale", [1e-8, 1e8])
def test_rows_in_another_unit_than_the_cost_are_no_obstacle(scale: float) -> None:
    a = np.array([1.0, 2.0, 3.0])
    A = scale * np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 1.0]])
    proof = prove(QP(np.outer(a, a), -6.0 * a, A=A, b=A.sum(axis=1)), answer([1.0, 1.0, 1.0]))
    assert (proof.reason, proof.bound < 1e-10) == ("", True)


def test_a_cost_that_lacks_less_than_rounding_to_be_convex_is_not_proven() -> None:
    assert Fraction(2.7) * Fraction(0.3) < Fraction(0.9) ** 2
    P = [[2.7, 0.9, 0.0], [0.9, 0.3, 0.0], [0.0, 0.0, 0.0]]
    qp = QP(P, [-5.0, -5.0, -5.0], ub=np.ones(3))
    proof = prove(qp, answer([1.0, 1.0, 1.0], [1.4, 3.8, 5.0]))
    assert (proof.reason, proof.bound) == (NOT_CONVEX, np.inf)


def test_answers_that_are_none_are_refused() -> None:
    qp = QP(np.eye(2), np.zeros(2), A=np.ones((1, 2)), b=[1.0])
    for wrong, problem in (
        (answer([1.0, 2.0, 3.0]), "^x: has shape \\(3,\\), not \\(2,\\)"),
        (answer([1.0, 2.0], y=np.zeros(2)), "^y: has shape \\(2,\\), not \\(1,\\)"),
        (answer([]), "^x: has shape \\(0,\\), not \\(2,\\)"),
        (answer([1.0, 2.0], certificate=np.ones(4)), "^certificate: has shape"),
    ):
        with pytest.raises(InvalidInputError, match=problem):
            prove(qp, wrong)
    for spoilt, problem in (
        (np.eye(2), r"must be a qpsolvers\.Problem or an iiwa_dnn\.QP"),
        (QP(np.nan * np.eye(2), np.zeros(2)), "^P: has a value that is nan"),
        (QP(np.eye(2), np.zeros(2), lb=[0.0, 1.0], ub=[0.0, 0.0]), "^lb: exceeds ub at 1"),
    ):
        with pytest.raises(InvalidInputError, match=problem):
            prove(spoilt, answer([1.0, 2.0]))


def test_a_certificate_is_proven_or_is_not() -> None:
    rows = [[-1.0, -1.0]]
    for limit, reason in ((-3.0, "proven: primal infeasible"), (-1.0, "")):
        qp = QP(np.eye(2), np.zeros(2), G=rows, h=[limit], lb=[-9.0] * 2, ub=[1.0, 1.0])
        proof = prove(qp, DNNSolver().solve(qp))
        assert proof.reason == reason
        assert (proof.bound < np.inf) is (reason == "")
        farkas = DNNSolver().solve(qp)._replace(certificate=np.ones(3))
        assert prove(qp, farkas).reason == reason
    falling = QP(np.diag([1.0, 0.0]), [1.0, 1.0], lb=[0.0, -np.inf])
    assert prove(falling, DNNSolver().solve(falling)).reason == "proven: " + Status.UNBOUNDED


@pytest.mark.parametrize("certificate", [[1.0], [-1.0], [np.nan], [np.inf], None])
def test_a_forged_certificate_proves_nothing(certificate: list[float] | None) -> None:
    problem = QP(np.eye(2), np.zeros(2), G=[[1.0, 1.0]], h=[-1.0]).to_qpsolvers()
    for found in (False, True):  # an answer without x is none, whatever it claims
        forged = qpsolvers.Solution(problem, {"status": "primal infeasible"}, found=found)
        if certificate is not None:
            forged.extras["certificate"] = np.array([*certificate, 0.0, 0.0])
        proof = prove(problem, forged)
        assert (proof.bound, "solve_problem looks for one" in proof.reason) == (np.inf, True)


def test_products_of_a_certificate_that_underflow_prove_nothing() -> None:
    qp = QP(np.eye(1), [0.0], G=[[1e-200]], h=[-1e-100])  # x = -1e100 is feasible
    proof = prove(qp, answer([0.0], certificate=np.array([1e-200, 0.0])))
    assert "proven" not in proof.reason


def test_a_check_hands_the_proof_on() -> None:
    known = [known_qp(np.random.default_rng([3, seed]), 5, 2, 1)[0] for seed in range(20)]
    points = np.stack([DNNSolver().solve(qp).point for qp in known])
    data = np.stack([qp.data for qp in known])
    points[7, 0] += 1e-5
    points[9, 0] = np.nan
    agreement = CrossCheck(("osqp", "proof")).check_block(data, known[0].sizes, points)
    bounds = agreement.solution_gap[:, 1]
    right = np.delete(np.arange(20), [7, 9])
    assert (bounds[right] < 1e-8).all()
    assert bounds[7] == pytest.approx(1e-5, rel=1e-3)
    assert bounds[9] == np.inf
    np.testing.assert_array_equal(
        agreement.reference_residual[:, 1], np.where(bounds < 1, 0, np.inf)
    )
    # The other solver's answers are no farther than both bounds allow.
    assert (agreement.solution_gap[right, 0] < 1e-7).all()
    # x alone will do where no multiplier has to be known.
    assert CrossCheck(("proof",)).check(known[0], points[0, :5]).solution_gap[0, 0] < 1e-7
