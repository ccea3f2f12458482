"""Many programs at once: the same answers as one by one, and faults that name the program."""

from concurrent.futures import ThreadPoolExecutor

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


def test_threads_may_share_the_batch_solver() -> None:
    arrays = stacked([known_qp(np.random.default_rng(k), 3, 1, 1)[0] for k in range(300)])
    expected = solve_batch(**arrays).x
    with ThreadPoolExecutor(4) as pool:
        for batch in pool.map(lambda _: solve_batch(**arrays), range(20)):
            np.testing.assert_array_equal(batch.x, expected)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("P", [[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        ("P", np.diag([1.0, 1.0, -1e-3])),
        ("lb", np.full(3, 1e3)),
        *[(name, np.nan) for name in FIELDS],
    ],
)
def test_a_bad_program_is_never_found_and_spoils_no_other(name: str, value: object) -> None:
    rng = np.random.default_rng(2)
    arrays = stacked([known_qp(rng, 3, 1, 1, inequalities=2)[0] for _ in range(300)])
    good = solve_batch(**arrays)
    assert good.found.all()
    arrays[name][211] = value
    batch = solve_batch(**arrays)
    assert np.flatnonzero(~batch.found).tolist() == [211]
    others = np.arange(300) != 211
    np.testing.assert_array_equal(batch.x[others], good.x[others])


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("P", np.ones((4, 4)), "shape"),
        ("P", None, "shape"),
        ("q", np.zeros((20, 0)), "empty"),
        ("q", np.zeros((0, 3)), "empty"),
        ("q", "text", "numbers"),
        ("G", None, "missing"),
        ("b", None, "missing"),
        ("G", np.zeros((19, 2, 3)), "shape"),
        ("h", np.zeros((20, 3)), "shape"),
        ("A", np.zeros((20, 1, 2)), "shape"),
        ("tol", -1.0, "above 0"),
    ],
)
def test_bad_input_is_refused(name: str, value: object, message: str) -> None:
    rng = np.random.default_rng(2)
    arrays = stacked([known_qp(rng, 3, 1, 1, inequalities=2)[0] for _ in range(20)])
    with pytest.raises(InvalidInputError, match=message):
        solve_batch(**{**arrays, name: value})
