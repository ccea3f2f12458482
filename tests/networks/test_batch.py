"""Many programs at once: the same answers as one by one, and faults that name the program."""

from concurrent.futures import ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest

from helpers_qp import known_qp
from iiwa_dnn import QP, DNNSolver, InvalidInputError, solve_batch

FIELDS = ("P", "q", "G", "h", "A", "b", "lb", "ub")


def stacked(qps: list[QP]) -> dict[str, np.ndarray]:
    return {name: np.stack([getattr(qp, name) for qp in qps]) for name in FIELDS}


def test_answers_are_those_of_one_by_one() -> None:
    rng = np.random.default_rng(0)
    made = [known_qp(rng, 7, 4, k % 5, dependent=k % 2 == 0, inequalities=3) for k in range(700)]
    qps, known = [qp for qp, _ in made], np.array([x for _, x in made])
    batch = solve_batch(**stacked(qps))
    assert batch.found.all()
    assert batch.residuals.max() <= 1e-9
    np.testing.assert_allclose(batch.x, known, atol=1e-6)
    for k in range(0, 700, 7):
        single = DNNSolver().solve(qps[k])
        np.testing.assert_array_equal(batch.x[k], single.x)
        np.testing.assert_array_equal(batch.y[k], single.y)
        np.testing.assert_array_equal(batch.z[k], single.z)
        np.testing.assert_array_equal(batch.z_box[k], single.z_box)
        np.testing.assert_array_equal(batch.residuals[k], single.residuals)
        assert batch.iterations[k] == single.iterations


def test_what_lacks_the_leading_axis_is_shared() -> None:
    rng = np.random.default_rng(1)
    qp, _ = known_qp(rng, 5, 2, 1, inequalities=2)
    q = rng.standard_normal((20, 5))
    q.setflags(write=False)
    batch = solve_batch(qp.P, q, qp.G, qp.h, qp.A, qp.b, qp.lb, qp.ub)
    assert batch.x.shape == (20, 5)
    for k in range(20):
        one = DNNSolver().solve(QP(qp.P, q[k], qp.G, qp.h, qp.A, qp.b, qp.lb, qp.ub))
        np.testing.assert_array_equal(batch.x[k], one.x)
    # A batch of one, and one without any constraint.
    np.testing.assert_allclose(solve_batch(np.eye(2), [1.0, 2.0]).x, [[-1.0, -2.0]], atol=1e-9)


def test_a_program_without_a_solution_is_not_found_and_spoils_no_other() -> None:
    A = np.ones((2, 3))
    b = np.array([[1.0, 1.0], [1.0, 2.0], [2.0, 2.0]])
    batch = solve_batch(np.eye(3), np.zeros(3), A=A, b=b)
    assert batch.found.tolist() == [True, False, True]
    np.testing.assert_allclose(batch.x[[0, 2]], [[1 / 3] * 3, [2 / 3] * 3], atol=1e-9)
    assert (batch.iterations <= 1000).all()


@cache
def sound(count: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(2)
    return stacked([known_qp(rng, 3, 1, 1, inequalities=2)[0] for _ in range(count)])


def spoil(name: str, value: np.ndarray, count: int = 300) -> dict[str, np.ndarray]:
    return {**{field: array.copy() for field, array in sound(count).items()}, name: value}


@pytest.mark.parametrize("name", FIELDS)
def test_a_bad_value_is_named_and_spoils_no_other_program(name: str) -> None:
    arrays = spoil("q", np.zeros((300, 3)))
    good = solve_batch(**arrays)
    arrays[name] = arrays[name].copy()
    arrays[name][211].flat[-1] = np.nan
    batch = solve_batch(**arrays)
    assert good.found.all()
    assert np.flatnonzero(~batch.found).tolist() == [211]
    assert list(batch.faults) == [211]
    assert batch.faults[211].argument == name
    assert np.isnan(batch.x[211]).all()
    assert (batch.residuals[211] == np.inf).all()
    others = np.arange(300) != 211
    np.testing.assert_array_equal(batch.x[others], good.x[others])
    # One that all programs share spoils them all.
    with pytest.raises(InvalidInputError, match=rf"^{name}: "):
        solve_batch(**{**arrays, name: arrays[name][211]})


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("P", [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "symmetric"),
        ("P", np.diag([1.0, 1.0, -1e-3]), "semidefinite"),
        ("P", np.ones((4, 4)), "shape"),
        ("q", np.zeros((20, 0)), "empty"),
        ("q", "text", "numbers"),
        ("G", None, "missing"),
        ("b", None, "missing"),
        ("h", np.zeros((19, 2)), "19 programs"),
        ("G", np.zeros((20, 2, 4)), "shape"),
        ("G", np.zeros(3), "shape"),
        ("h", np.zeros((20, 3)), "shape"),
        ("A", np.zeros((20, 1, 2)), "shape"),
        ("b", np.zeros((20, 2)), "shape"),
        ("lb", np.full(3, 1e3), "exceeds"),
        ("lb", np.full(3, np.inf), "NaN or inf"),
        ("ub", np.full(3, -np.inf), "NaN or -inf"),
        ("h", np.full(2, -np.inf), "NaN or -inf"),
        ("tol", -1.0, "above 0"),
        ("q", np.zeros((0, 3)), "no program"),
    ],
)
def test_bad_input_names_the_argument(name: str, value: object, message: str) -> None:
    with pytest.raises(InvalidInputError, match=message) as caught:
        solve_batch(**spoil(name, value, 20))
    assert caught.value.argument == name


@pytest.mark.parametrize("k", [0, 7, 299])
@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("P", [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], "symmetric"),
        ("P", np.diag([1.0, 1.0, -1e-3]), "semidefinite"),
        ("lb", np.full(3, 1e3), "exceeds ub at 0"),
    ],
)
def test_a_program_that_is_not_convex_is_never_found(
    k: int, name: str, value: object, message: str
) -> None:
    arrays = spoil("q", np.zeros((300, 3)))
    arrays[name][k] = value
    batch = solve_batch(**arrays)
    assert np.flatnonzero(~batch.found).tolist() == [k]
    assert message in str(batch.faults[k])


def test_threads_may_share_the_batch_solver() -> None:
    arrays = spoil("q", np.zeros((300, 3)))
    expected = solve_batch(**arrays).x
    with ThreadPoolExecutor(4) as pool:
        for batch in pool.map(lambda _: solve_batch(**arrays), range(20)):
            np.testing.assert_array_equal(batch.x, expected)


def test_what_is_absent_or_singular_is_sound() -> None:
    batch = solve_batch(
        np.zeros((2, 2)),
        [[1.0, 1.0], [1.0, -1.0]],
        [[1.0, 1.0]],
        [np.inf],
        lb=[0.0, -1.0],
        ub=[1, 2],
    )
    assert batch.found.all()
    np.testing.assert_allclose(batch.x, [[0.0, -1.0], [0.0, 2.0]], atol=1e-8)


@pytest.mark.parametrize("limited", [False, True])
def test_company_does_not_change_an_answer(limited: bool) -> None:
    rng, count, n, p = np.random.default_rng(9), 21, 5, 2
    roots = rng.standard_normal((count, n, n))
    P, q = roots @ np.swapaxes(roots, 1, 2) + np.eye(n), rng.standard_normal((count, n))
    A, b = rng.standard_normal((count, p, n)), rng.standard_normal((count, p))
    ub = np.where(rng.uniform(size=(count, n)) < 0.2 * limited, 0.1, 50.0)
    P[7, 1, 1] = np.nan  # a program beside it that is none
    together = solve_batch(P, q, A=A, b=b, ub=ub)
    assert list(together.faults) == [7]
    for k in set(range(count)) - {7}:
        alone = solve_batch(P[k], q[k], A=A[k], b=b[k], ub=ub[k])
        np.testing.assert_array_equal(together.x[k], alone.x[0])
        np.testing.assert_array_equal(together.residuals[k], alone.residuals[0])
        kkt = np.block([[P[k], A[k].T], [A[k], np.zeros((p, p))]])
        free = np.linalg.solve(kkt, np.concatenate([-q[k], b[k]]))
        if (free[:n] <= ub[k]).all():
            np.testing.assert_allclose(together.x[k], free[:n], rtol=0, atol=1e-9)
            np.testing.assert_allclose(together.y[k], free[n:], rtol=0, atol=1e-9)
    assert together.found.sum() == count - 1


def test_members_without_a_choice_spoil_no_other() -> None:
    eye, one = np.eye(2), np.ones(2)
    batch = solve_batch(
        eye, np.ones((3, 2)), A=[[1.0, 1.0]], b=[[2.0], [2.0], [5.0]], lb=one, ub=one
    )
    assert batch.found.tolist() == [True, True, False]
