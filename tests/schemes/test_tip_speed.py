"""Limit of the tip's speed: bounds beside finite differences, and the speed in closed loops."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import iiwa_dnn as d
from helpers_kinematics import Array
from helpers_simulation import driven, paper_robot, paper_start, rows_of

DT = 2e-3
QUICKER = np.array([-0.3, 0.2, -0.1, -0.4, 0.3, -0.2, -0.5])  # by the change of the posture alone
SLOWER = -QUICKER


def tip_speed(q: Array, dq: Array) -> float:
    return float(np.linalg.norm(d.Configuration(paper_robot(), q).jacobian[:3] @ dq))


@pytest.mark.parametrize("last", [QUICKER, SLOWER], ids=["quicker", "slower"])
@pytest.mark.parametrize("fraction", [0.5, 2.0])
def test_each_joint_may_add_an_equal_part_of_what_is_left(fraction: float, last: Array) -> None:
    start = paper_start()
    jacobian = start.jacobian[:3]
    speed = tip_speed(start.q, last)
    along = jacobian.T @ jacobian @ last / speed
    ahead, behind = (tip_speed(start.q + step * last, last) for step in (1e-5, -1e-5))
    change = (ahead - behind) / 2e-5
    assert (change > 0.0) == (last is QUICKER)
    qp = rows_of(d.TipSpeedLimit(fraction * speed, gain=50.0), start, dt=DT, dq=last)
    # At their bounds the joints close the gain's part of the gap in one step.
    growth = DT * (50.0 * (fraction - 1.0) * speed - max(change, 0.0)) / np.abs(along).sum()
    moves = np.abs(along) > 1e-12
    expected = last + np.sign(along) * growth
    assert_allclose(qp.ub, np.where(moves & (along > 0.0), expected, np.inf), rtol=1e-8)
    assert_allclose(qp.lb, np.where(moves & (along < 0.0), expected, -np.inf), rtol=1e-8)


@pytest.mark.parametrize("dq", [np.zeros(7), np.eye(7)[6]])
def test_a_tip_at_rest_has_no_bounds(dq: Array) -> None:
    qp = rows_of(d.TipSpeedLimit(0.1), d.Configuration(paper_robot(), np.zeros(7)), dt=DT, dq=dq)
    assert np.isinf([qp.lb, qp.ub]).all()


def fastest(path: Array, robot: d.Robot, dt: float) -> float:
    """The largest speed of the tip along joint positions that are dt apart [m/s]."""
    tip = [d.Configuration(robot, q).position for q in path]
    return float(np.linalg.norm(np.diff(tip, axis=0), axis=1).max()) / dt


def test_the_tip_is_no_quicker_where_its_target_jumps() -> None:
    # Without its limit it reaches 0.6 m/s.
    extra = (d.AccelerationLimits(10.0), d.JerkLimits(1000.0), d.TipSpeedLimit(0.4))
    scheme = d.DoubleIndicator(position_gain=50.0, orientation_gain=50.0, extra_limits=extra)
    controller = d.Controller(paper_robot(), scheme, dt=DT)
    start = paper_start()

    def jumping(t: float) -> d.Target:
        side = 0.3 if round(t / DT) % 150 < 75 else -0.3
        return d.Target(start.position + [side, 0.0, 0.1], start.rotation)

    path, _ = driven(controller, start.q, 300, jumping)
    assert 0.36 < fastest(path, paper_robot(), DT) < 0.4


def test_the_posture_may_change_and_the_tip_is_no_quicker() -> None:
    # 2.514 m/s where the bounds leave out what the change of the posture adds.
    robot = d.load_robot("panda")
    shield = d.Shield(robot, dt=1e-3)
    shield.limits += (d.TipSpeedLimit(2.5),)
    random = np.random.default_rng(0)
    path = [robot.start_posture()]
    for k in range(3000):
        if k % 200 == 0:
            request = robot.dq_max * random.choice([-1.0, 1.0, 0.0, 0.5], robot.dof)
        path.append(shield.step(path[-1], request).next_q)
    assert 2.4 < fastest(path, robot, 1e-3) < 2.5
