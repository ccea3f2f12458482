"""The limit of the tip's speed: its bounds by their formula, and a run that would be quicker."""

import numpy as np
import pytest

import iiwa_dnn
from helpers_simulation import paper_robot, paper_start, rows_of

DT = 2e-3
LAST = np.array([0.3, -0.2, 0.1, 0.4, -0.3, 0.2, 0.5])


def test_each_joint_may_add_an_equal_part_of_what_is_left() -> None:
    jacobian = paper_start().jacobian[:3]
    speed = np.linalg.norm(jacobian @ LAST)
    along = jacobian.T @ jacobian @ LAST / speed
    for limit in (0.5 * speed, 2.0 * speed):
        limited = iiwa_dnn.TipSpeedLimit(limit, gain=50.0)
        qp = rows_of(limited, paper_start(), dt=DT, dq=LAST)
        lb, ub = qp.lb, qp.ub
        growth = 50.0 * DT * (limit - speed) / np.abs(along).sum()
        moves = np.abs(along) > 1e-12
        assert np.isinf(lb[(along > 0.0) | ~moves]).all()
        assert np.isinf(ub[(along < 0.0) | ~moves]).all()
        bound = np.where(along > 0.0, ub, lb)[moves]
        expected = (LAST + np.sign(along) * growth)[moves]
        np.testing.assert_allclose(bound, expected, rtol=1e-12)
        # A command at the bounds closes the gain's part of the gap in one step.
        command = np.where(moves, LAST + np.sign(along) * growth, LAST)
        reached = along @ command
        assert reached == pytest.approx(speed + 50.0 * DT * (limit - speed), rel=1e-12)


@pytest.mark.parametrize("dq", [np.zeros(7), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]])
def test_a_tip_at_rest_has_no_bounds(dq: np.ndarray) -> None:
    conf = iiwa_dnn.Configuration(paper_robot(), np.zeros(7))
    qp = rows_of(iiwa_dnn.TipSpeedLimit(0.1), conf, dt=DT, dq=dq)
    assert np.isinf([qp.lb, qp.ub]).all()


@pytest.mark.parametrize("wanted", [None, 0.4])
def test_the_tip_is_no_quicker_where_its_target_jumps(wanted: float | None) -> None:
    limits = [iiwa_dnn.AccelerationLimits(10.0), iiwa_dnn.JerkLimits(1000.0)]
    if wanted is not None:
        limits.append(iiwa_dnn.TipSpeedLimit(wanted))
    scheme = iiwa_dnn.DoubleIndicator(
        position_gain=50.0, orientation_gain=50.0, extra_limits=tuple(limits)
    )
    controller = iiwa_dnn.Controller(paper_robot(), scheme, dt=DT)
    q = np.array(paper_start().q)
    tip = [paper_start().position]
    for k in range(300):
        side = 0.3 if k % 150 < 75 else -0.3
        target = iiwa_dnn.Target(paper_start().position + [side, 0.0, 0.1], paper_start().rotation)
        q = q + DT * controller.step(q, k * DT, target).dq
        tip.append(iiwa_dnn.Configuration(paper_robot(), q).position)
    fastest = np.linalg.norm(np.diff(tip, axis=0), axis=1).max() / DT
    if wanted is None:
        assert fastest > 0.6
    else:
        assert 0.36 < fastest < 0.44
