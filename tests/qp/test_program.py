"""The program's container, its checks and its judgement of a solution."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import qpsolvers
import scipy.sparse as spa

import programs
from helpers_qp import known_qp
from iiwa_dnn import QP, DNNSolver, InvalidInputError, Residuals, Status, prove, solve_problem
from iiwa_dnn.qp.program import FIELDS
from iiwa_dnn.qp.residuals import kkt_point


def test_missing_parts_become_empty_rows_and_infinite_bounds() -> None:
    qp = QP(np.eye(3), np.zeros(3))
    assert qp.G.shape == qp.A.shape == (0, 3)
    assert (qp.lb == -np.inf).all()
    assert (qp.ub == np.inf).all()
    assert qp.to_qpsolvers().is_unconstrained


@pytest.mark.parametrize(
    "kind",
    [
        np.asfortranarray,
        np.ndarray.tolist,
        lambda a: np.repeat(a, 2, axis=-1)[..., ::2],
        lambda a: np.array(a, dtype=">f8"),
        lambda a: np.array(a, dtype=np.float32),
        lambda a: np.array(a, dtype=np.int8),
        lambda a: (a.setflags(write=False), a)[1],
    ],
)
def test_arrays_of_every_kind_make_the_same_program(kind: Callable[[np.ndarray], object]) -> None:
    rng = np.random.default_rng(0)
    shapes = ((3, 3), (3,), (4, 3), (4,), (2, 3), (2,), (3,), (3,))
    arrays = [rng.integers(-9, 9, shape).astype(float) for shape in shapes]
    expected = np.concatenate([array.ravel() for array in arrays])
    qp = QP(*[kind(array.copy()) for array in arrays])
    assert qp.sizes == (3, 4, 2)
    np.testing.assert_array_equal(qp.data, expected)


@pytest.mark.parametrize("given", [None, np.eye(3), "problem"])
def test_what_is_no_problem_is_refused(given: Any) -> None:
    with pytest.raises(InvalidInputError, match="problem: must be a qpsolvers"):
        solve_problem(given)


def test_fields_are_views_of_one_array_and_copies_of_what_was_given() -> None:
    qp, _ = known_qp(np.random.default_rng(0), 4, 2, 1, inequalities=3)
    arrays = [getattr(qp, name) for name in FIELDS]
    assert sum(array.size for array in arrays) == qp.data.size
    assert all(np.shares_memory(array, qp.data) for array in arrays)
    given = np.zeros(2)
    assert not np.shares_memory(QP(np.eye(2), given, lb=given).data, given)


REFUSED: list[tuple[str, dict[str, Any]]] = [
    ("q", {"q": []}), ("q", {"q": None}), ("q", {"q": "text"}), ("q", {"q": [1j, 2.0, 3.0]}),
    ("q", {"q": [0.0, np.inf, 0.0]}), ("q", {"q": [0.0, np.nan, 0.0]}),
    ("P", {"P": None}), ("P", {"P": np.eye(2)}), ("P", {"P": np.ones((2, 3))}),
    ("P", {"P": np.triu(np.ones((3, 3)))}), ("P", {"P": np.diag([1.0, -1e-3, 1.0])}),
    ("P", {"P": np.diag([1.0, np.nan, 1.0])}), ("P", {"P": np.eye(4)}),
    ("P", {"P": np.diag([np.nan, 1.0, 1.0])}), ("G", {"G": [[0.0, 0.0, np.inf]], "h": [1.0]}),
    ("G", {"G": np.ones((2, 4)), "h": np.ones(2)}), ("h", {"h": np.ones(1)}),
    ("h", {"G": np.ones((2, 3)), "h": np.ones(3)}), ("h", {"G": np.ones((2, 3)), "h": "text"}),
    ("h", {"G": np.ones((1, 3)), "h": [[1.0, 2.0]]}),
    ("h", {"G": np.ones((1, 3)), "h": np.array([np.nan])}),
    ("b", {"b": np.ones(1)}), ("A", {"A": np.ones((2, 2)), "b": np.ones(2)}),
    ("A", {"A": np.full((1, 3), np.inf), "b": np.zeros(1)}),
    ("b", {"A": np.ones((2, 3)), "b": np.ones(3)}), ("b", {"A": np.ones((1, 3))}),
    ("b", {"A": np.ones((1, 3)), "b": np.array([np.nan])}),
    ("lb", {"lb": np.zeros(2)}), ("lb", {"lb": np.full(3, 2.0), "ub": np.ones(3)}),
    ("lb", {"lb": [np.inf, 1.0, 1.0]}), ("ub", {"ub": "text"}), ("ub", {"ub": np.full(3, np.nan)}),
    ("ub", {"ub": [-np.inf, 1.0, 1.0]}), ("h", {"G": np.ones((1, 3)), "h": np.array([-np.inf])}),
]  # fmt: skip


@pytest.mark.parametrize(("name", "arguments"), REFUSED)
def test_a_wrong_program_is_refused_by_the_arguments_name(name, arguments) -> None:
    fields = {"P": np.eye(3), "q": np.zeros(3), **arguments}
    makers: list[Callable[..., Any]] = [QP]
    if all(isinstance(value, np.ndarray) for value in fields.values()):
        makers.append(qpsolvers.Problem)
    for make in makers:
        with pytest.raises(InvalidInputError) as caught:
            solve_problem(make(**fields))
        assert caught.value.argument == name
        assert str(caught.value).startswith(f"{name}: ")


def test_residuals_are_those_of_qpsolvers() -> None:
    rng = np.random.default_rng(1)
    for case in range(50):
        qp, _ = known_qp(rng, 6, 2, case % 6, inequalities=4)
        n, p, m = 6, 2, 4
        state = rng.standard_normal(n + p + m + 2 * n)  # nothing like a solution
        point = np.empty(n + p + m + n)
        ours = kkt_point(qp.views, state, point)
        outside = rng.standard_normal(point.size)  # nobody put it inside its bounds
        for residuals, judged in ((ours, point), (qp.residuals(outside), outside)):
            x, y, z, z_box = np.split(judged, [n, n + p, n + p + m])
            other = qpsolvers.Solution(qp.to_qpsolvers(), found=True, x=x, y=y, z=z, z_box=z_box)
            theirs = (other.primal_residual(), other.dual_residual(), other.duality_gap())
            np.testing.assert_allclose(residuals, theirs, rtol=1e-12, atol=1e-13)
        assert (point[:n] >= qp.lb).all()
        assert (point[:n] <= qp.ub).all()
        assert (point[n + p : n + p + m] >= 0).all()


def test_multipliers_of_absent_limits_leave_the_gap_alone() -> None:
    # An infinite bound or h under a multiplier counts in the dual residual, not as 0 times inf.
    qp = QP(
        np.eye(2), np.zeros(2), G=[[1.0, 0.0]], h=[np.inf], lb=[-np.inf, -4.0], ub=[4.0, np.inf]
    )
    for z_box, expected in (
        ([0.0, 0.0], (0.0, 0.0, 0.0)),
        ([-3.0, 0.0], (0.0, 3.0, 0.0)),
        ([0.0, 2.0], (0.0, 2.0, 0.0)),
        ([0.5, 0.0], (0.0, 0.5, 2.0)),
        ([0.0, -0.25], (0.0, 0.25, 1.0)),
    ):
        assert qp.residuals(np.array([0.0, 0.0, 0.0, *z_box])) == expected
    # The multiplier of a row that was active before it lost its limit.
    state = np.array([0.0, 0.0, 4e-129, *np.zeros(4)])
    assert kkt_point(qp.views, state, np.empty(5)) == (0.0, 0.0, 0.0)


def test_data_of_another_size_is_refused() -> None:
    qp, _ = known_qp(np.random.default_rng(3), 4, 2, 1, inequalities=3)
    for data, sizes in ((qp.data[:-1], qp.sizes), (qp.data, (4, 3, 3)), (qp.data, (5, 3, 2))):
        with pytest.raises(InvalidInputError, match="data"):
            QP.from_data(data, sizes)


def test_largest_residual_does_not_lose_a_nan() -> None:
    assert Residuals(1e-9, 3e-9, 2e-9).largest == 3e-9
    assert Residuals(0.0, 0.0, 0.0).largest == 0.0
    assert np.isnan(Residuals(1.0, float("nan"), 0.0).largest)


def test_a_solution_that_was_not_found_carries_no_x() -> None:
    qp, _ = known_qp(np.random.default_rng(2), 4, 1, 1)
    good = DNNSolver().solve(qp)
    bad = good._replace(status=Status.NOT_CONVERGED).to_qpsolvers(qp.to_qpsolvers())
    assert bad.found is False
    assert bad.x is None
    assert bad.primal_residual() == np.inf
    np.testing.assert_array_equal(bad.extras["last_x"], good.x)


def test_multipliers_without_constraints_are_empty_as_those_of_qpsolvers() -> None:
    eye, one = spa.eye(2, format="csc"), np.ones(2)
    row = {"G": spa.csc_matrix(np.ones((1, 2))), "h": np.array([1.0])}
    equal = {"A": spa.csc_matrix(np.ones((1, 2))), "b": np.array([1.0])}
    for arguments in ({}, row, equal, {"lb": -one}, {"ub": one}, {**row, **equal, "lb": -one}):
        problem = qpsolvers.Problem(eye, one, **arguments)
        ours = DNNSolver().solve(QP.from_qpsolvers(problem)).to_qpsolvers(problem)
        theirs = qpsolvers.solve_problem(problem, solver="osqp", raise_error=False)
        for name in ("x", "y", "z", "z_box"):
            assert getattr(ours, name).size == getattr(theirs, name).size, (name, arguments)
        assert ours.is_optimal(1e-8)


def test_a_point_is_accepted_by_the_rule() -> None:
    """The rule in numpy, max(eps_abs w, eps_rel s, 4e-15 n s) for each entry, at any scale."""
    verdicts = []
    for seed in range(400):
        rng = np.random.default_rng([5, seed])
        plain, point = programs.with_point(rng, flat=seed % 4 == 0)
        n, m, p = plain.sizes
        units = np.full(n, 10.0 ** rng.uniform(-3.0, 3.0))
        rows = 10.0 ** rng.uniform(-6.0, 2.0, p + m)
        cost = 10.0 ** rng.uniform(-6.0, 4.0)
        qp, point = programs.in_other_units(plain, point, units, rows, cost)
        point *= 1.0 + 10.0 ** rng.uniform(-16.0, -6.0) * rng.standard_normal(point.size)
        point[:n] = np.clip(point[:n], qp.lb, qp.ub)
        eps_abs, eps_rel = 10.0 ** rng.uniform(-12.0, -6.0), 10.0 ** rng.uniform(-16.0, -8.0)
        x, y, z, box = np.split(point, [n, n + p, n + p + m])
        both, limits = np.vstack([qp.A, qp.G]), np.concatenate([qp.b, qp.h])
        multipliers = np.concatenate([y, z])
        bound = np.where(box > 0.0, qp.ub, np.where(box < 0.0, qp.lb, 0.0))
        gradient = qp.P @ x + qp.q
        size = np.abs(qp.P) @ np.abs(x) + np.abs(qp.q)
        excess = both @ x - limits
        largest = max(np.abs(qp.P).max(), np.abs(qp.q).max())
        slight = largest if largest < 1e-3 else 1.0
        columns = np.abs(np.vstack([qp.P / slight, qp.q / slight, both])).max(axis=0)
        entries = [
            (np.where(np.arange(p + m) < p, np.abs(excess), excess),
             np.abs(both) @ np.abs(x) + np.abs(limits), np.abs(both).max(axis=1)),
            (np.abs(gradient + both.T @ multipliers + box),
             size + np.abs(both).T @ np.abs(multipliers) + np.abs(box), columns),
            (abs(gradient @ x + limits @ multipliers + bound @ box),
             size @ np.abs(x) + np.abs(limits) @ np.abs(multipliers) + np.abs(bound * box), 1.0),
        ]  # fmt: skip
        weights = [1.0, slight, slight]
        expected = all(
            np.all(r <= np.maximum(eps_abs * weight * np.where(w < 1e-3, w, 1.0),
                                   max(eps_rel, 4e-15 * n) * s))
            for (r, s, w), weight in zip(entries, weights, strict=True)
        )  # fmt: skip
        verdicts.append(expected)
        assert qp.accepts(point, eps_abs, eps_rel) == expected, seed
    assert 100 < sum(verdicts) < 300


def test_the_symmetric_part_of_a_cost_decides() -> None:
    skew = np.array([[0.0, -4e-6], [4e-6, 0.0]])
    flat = np.array([[1.0, 1.0 - 1e-6], [1.0 - 1e-6, 1.0]])
    q = np.array([-1.0, 1.0])
    qp = QP(flat + skew, q)
    np.testing.assert_allclose(qp.P, flat, rtol=0.0, atol=1e-16)
    assert (qp.P == qp.P.T).all()
    solution = solve_problem(qpsolvers.Problem(flat + skew, q), sharpen=True)
    np.testing.assert_allclose(solution.x, [1e6, -1e6], rtol=1e-8)
    assert prove(qpsolvers.Problem(flat + skew, q), solution).bound < 0.1
    # Its eigenvalue -5e-7 belongs to (1, -1): no minimum, in a box neither.
    indefinite = np.array([[1.0, 1.0 - 4e-6], [1.0 + 5e-6, 1.0]])
    for bound in (np.inf, 100.0):
        box = np.full(2, bound)
        with pytest.raises(InvalidInputError, match="eigenvalue -5e-07"):
            solve_problem(qpsolvers.Problem(indefinite, 1e-6 * q, lb=-box, ub=box))
    # A program whose data was written into, too.
    qp.P[:] = flat + skew
    np.testing.assert_allclose(solve_problem(qp, sharpen=True).x, [1e6, -1e6], rtol=1e-8)


def test_arrays_with_gaps_and_single_rows_are_packed_as_others() -> None:
    rng = np.random.default_rng(59)
    root = rng.standard_normal((5, 5))
    G = rng.standard_normal((1, 5))
    plain = QP(root @ root.T, rng.standard_normal(5), G, np.ones(1), 2.0 * G, np.ones(1))
    twice = [np.repeat(each, 2, axis=-1)[..., ::2] for each in (plain.P, plain.q, plain.A)]
    other = QP(np.asfortranarray(twice[0]), twice[1], G[0], [1], twice[2], np.ones((1, 1)))
    np.testing.assert_array_equal(other.data, plain.data)
