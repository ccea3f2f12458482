"""Clipped commands: the nearest velocity within the bounds and the inequality rows."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.optimize import linprog

import iiwa_dnn as d
from iiwa_dnn.qp import QP
from iiwa_dnn.simulation.clipping import clip_command
from iiwa_dnn.step.fallback import Yielding


def settling(tol: float = 1e-9) -> Yielding:
    """What a controller knows of how its network converges."""
    own = d.Controller(d.load_robot("ur5"), d.DoubleIndicator()).control_layout.plan.yielding
    return own._replace(tolerance=tol)


def limited(G: object = None, h: object = None, n: int = 3) -> QP:
    """A program whose cost and linear term must not matter: bounds -1, -2, ... and 1, 2, ..."""
    ub = np.arange(1.0, n + 1.0)
    return QP(3.0 * np.eye(n), np.full(n, 7.0), G=G, h=h, lb=-ub, ub=ub)


@pytest.mark.parametrize(("speed", "most"), [(np.nan, 0.5), (1.0, -99.0)])
def test_without_a_number_or_an_answer_it_is_the_bound_nearest_to_rest(speed, most) -> None:
    qp = limited(G=[[1.0, 1.0, 1.0]], h=[most])
    qp.lb[1] = 0.5
    qp.ub[2] = -0.25
    clipped, which = clip_command(qp, np.full(3, speed), settling())
    assert_array_equal(clipped, [0.0, 0.5, -0.25])
    assert_array_equal(which, [1, 1, 1])


@pytest.mark.parametrize("count", [0, 1])
def test_a_bound_counts_beyond_rounding_and_a_row_beyond_the_networks_tolerance(count) -> None:
    qp = limited(G=[[0.0, 1.0, 0.0]], h=[0.5])
    dq = np.array([1.0 + (5e-13, 5e-12)[count], 0.5 + (5e-10, 5e-9)[count], 0.0])
    clipped, which = clip_command(qp, dq, settling(1e-12))
    assert_array_equal(which, [count, count, 0])
    assert clipped[0] == (pytest.approx(1.0, abs=1e-11) if count else 1.0)
    assert clipped[1] == (pytest.approx(0.5, abs=1e-11) if count else dq[1])


def test_beyond_rows_the_velocity_is_the_nearest() -> None:
    # A projection y of a has (a - y)(v - y) <= 0 for all v within; the largest by linear program.
    rng = np.random.default_rng(41)
    changed = 0
    for _ in range(20):
        qp = limited(G=rng.normal(size=(2, 4)), h=rng.uniform(0.1, 0.5, 2), n=4)
        dq = 2.0 * rng.normal(size=4)
        clipped, which = clip_command(qp, dq, settling())
        away = np.clip(dq, qp.lb, qp.ub) - clipped
        assert (qp.G @ clipped <= qp.h + 1e-9).all()
        assert ((qp.lb - 1e-9 <= clipped) & (clipped <= qp.ub + 1e-9)).all()
        bounds = np.column_stack([qp.lb, qp.ub])
        assert -linprog(-away, qp.G, qp.h, bounds=bounds).fun <= away @ clipped + 1e-7
        assert_array_equal(which, np.abs(clipped - dq) > 1e-12)
        changed += int(away.any())
    assert changed >= 5


def test_rows_on_slack_variables_are_left_to_the_scheme() -> None:
    # Three joints, one slack variable: the first row is relaxed by it, the second is not.
    qp = limited(G=[[1.0, 0.0, 0.0, -1.0], [0.0, 1.0, 0.0, 0.0]], h=[0.1, 0.1], n=4)
    clipped, which = clip_command(qp, np.array([0.9, 0.9, 0.9]), settling())
    assert_allclose(clipped, [0.9, 0.1, 0.9], rtol=0, atol=1e-8)
    assert which[1] == 1
    clipped, which = clip_command(qp, np.array([0.9, 0.05, 0.9]), settling())
    assert_array_equal(clipped, [0.9, 0.05, 0.9])
    assert_array_equal(which, [0, 0, 0])
