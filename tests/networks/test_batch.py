"""Many programs at once: the same answers as one by one, and faults that name the program."""

import numpy as np
import pytest

from helpers_qp import known_qp
from iiwa_dnn import QP, DNNSolver, InvalidInputError, solve_batch
from iiwa_dnn.qp.program import FIELDS


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
        for name in ("x", "y", "z", "z_box", "residuals"):
            np.testing.assert_array_equal(getattr(batch, name)[k], getattr(single, name))
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
    np.testing.assert_allclose(solve_batch(np.eye(2), [1.0, 2.0]).x, [[-1.0, -2.0]], atol=1e-9)


@pytest.mark.parametrize(
    ("name", "value"), [("P", np.diag([1.0, 1.0, -1e-3])), *[(name, np.nan) for name in FIELDS]]
)
def test_a_bad_program_is_never_found_and_spoils_no_other(name: str, value: object) -> None:
    rng = np.random.default_rng(2)
    arrays = stacked([known_qp(rng, 3, 1, 1, inequalities=2)[0] for _ in range(300)])
    good = solve_batch(**arrays)
    assert good.found.all()
    arrays[name][211] = value
    batch = solve_batch(**arrays)
    assert np.flatnonzero(~batch.found).tolist() == [211]
    bad = "not convex" if np.ndim(value) else "not finite"
    assert set(batch.status) == {"solved", batch.status[211]} == {"solved", bad}
    others = np.arange(300) != 211
    np.testing.assert_array_equal(batch.x[others], good.x[others])


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("P", np.ones((4, 4)), "shape"),
        ("P", None, "shape"),
        ("q", np.zeros((0, 3)), "programs"),
        ("G", np.zeros((19, 2, 3)), "shape"),
        ("tol", -1.0, "above 0"),
    ],
)
def test_bad_input_is_refused(name: str, value: object, message: str) -> None:
    rng = np.random.default_rng(2)
    arrays = stacked([known_qp(rng, 3, 1, 1, inequalities=2)[0] for _ in range(20)])
    with pytest.raises(InvalidInputError, match=message):
        solve_batch(**{**arrays, name: value})
